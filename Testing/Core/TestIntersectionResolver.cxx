// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SurfaceSides.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Repair/IntersectionResolver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;

/** A linear map and a shift. */
struct Transform
{
  Vec3 Columns[3]{ { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  Vec3 Shift;

  Vec3 operator()(const Vec3& p) const
  {
    return this->Shift + p.X * this->Columns[0] + p.Y * this->Columns[1] + p.Z * this->Columns[2];
  }

  static Transform Scale(double factor, const Vec3& shift = {})
  {
    Transform t;
    for (int i = 0; i < 3; ++i)
    {
      t.Columns[i] = factor * t.Columns[i];
    }
    t.Shift = shift;
    return t;
  }

  template <class Random>
  static Transform Rotation(Random& random)
  {
    std::normal_distribution<double> normal;
    double q[4];
    double length = 0.0;
    for (double& x : q)
    {
      x = normal(random);
      length += x * x;
    }
    for (double& x : q)
    {
      x /= std::sqrt(length);
    }
    const double w = q[0];
    const double x = q[1];
    const double y = q[2];
    const double z = q[3];
    Transform t;
    t.Columns[0] = { 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y) };
    t.Columns[1] = { 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x) };
    t.Columns[2] = { 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y) };
    return t;
  }
};

struct Soup : PolygonSoup
{
  void Add(const std::vector<Vec3>& corners)
  {
    for (const Vec3& p : corners)
    {
      this->Connectivity.push_back(static_cast<Id>(this->Points.size()));
      this->Points.push_back(p);
    }
    this->Offsets.push_back(static_cast<Id>(this->Connectivity.size()));
  }

  /** Six quadrilaterals with the normals outwards. */
  void AddBox(const Vec3& low, const Vec3& high)
  {
    const Id first = static_cast<Id>(this->Points.size());
    for (int i = 0; i < 8; ++i)
    {
      this->Points.push_back(
        { i & 1 ? high.X : low.X, i & 2 ? high.Y : low.Y, i & 4 ? high.Z : low.Z });
    }
    for (const std::vector<Id>& face : std::vector<std::vector<Id>>{ { 0, 2, 3, 1 }, { 4, 5, 7, 6 },
           { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
    {
      for (const Id id : face)
      {
        this->Connectivity.push_back(first + id);
      }
      this->Offsets.push_back(static_cast<Id>(this->Connectivity.size()));
    }
  }

  void Apply(const Transform& transform)
  {
    for (Vec3& p : this->Points)
    {
      p = transform(p);
    }
  }
};

double GetSize(const PolygonSoup& soup)
{
  double size = 0.0;
  for (const Vec3& p : soup.Points)
  {
    size = std::max(size, Distance(p, soup.Points[0]));
  }
  return size;
}

/** The promises of the output: clean, and each point known by its parents. */
void ExpectClean(const BoundaryTriangulatorOutput& output, const PolygonSoup& input)
{
  const TriangleMesh& surface = output.Surface;
  EXPECT_EQ(
    surface.Points.size(), std::set<Vec3>(surface.Points.begin(), surface.Points.end()).size());
  EXPECT_EQ(surface.Triangles.size(), surface.SourceCells.size());
  EXPECT_EQ(input.Labels.empty() ? 0u : surface.Triangles.size(), surface.Labels.size());
  std::set<TriangleIds> known;
  std::vector<char> used(surface.Points.size(), 0);
  for (TriangleIds t : surface.Triangles)
  {
    EXPECT_FALSE(AreCollinear(surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]]));
    used[t[0]] = used[t[1]] = used[t[2]] = 1;
    std::sort(t.begin(), t.end());
    EXPECT_TRUE(known.insert(t).second);
  }
  EXPECT_EQ(0, std::count(used.begin(), used.end(), 0));
  std::vector<TrianglePair> pairs;
  FindIntersectingPairs(surface.Points, surface.Triangles, {}, {}, pairs);
  EXPECT_TRUE(pairs.empty()) << pairs.size() << " pairs";

  const std::size_t numberOfOld = output.PointSources.size();
  ASSERT_EQ(surface.Points.size(), numberOfOld + output.NewPoints.size());
  for (std::size_t i = 0; i < numberOfOld; ++i)
  {
    EXPECT_EQ(input.Points[output.PointSources[i]], surface.Points[i]);
  }
  for (std::size_t i = 0; i < output.NewPoints.size(); ++i)
  {
    const PointParents& parents = output.NewPoints[i];
    Vec3 p;
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      ASSERT_LE(0, parents.Ids[k]);
      ASSERT_GT(input.Points.size(), static_cast<std::size_t>(parents.Ids[k]));
      EXPECT_LE(0.0, parents.Weights[k]);
      sum += parents.Weights[k];
      p = p + parents.Weights[k] * input.Points[parents.Ids[k]];
    }
    EXPECT_NEAR(1.0, sum, 1e-14);
    EXPECT_LE(Distance(p, surface.Points[numberOfOld + i]), 2e-9 * GetSize(input));
  }
}

BoundaryTriangulatorOutput Resolve(
  const PolygonSoup& soup, ResolvedPieces pieces = ResolvedPieces::OutsideOnly)
{
  BoundaryTriangulatorOptions options;
  options.ResolveSelfIntersections = true;
  options.Pieces = pieces;
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  ExpectClean(output, soup);
  return output;
}

/** Six times the volume enclosed. */
double GetVolume(const TriangleMesh& surface)
{
  double volume = 0.0;
  const Vec3 origin = surface.Points[0];
  for (const TriangleIds& t : surface.Triangles)
  {
    volume += Dot(surface.Points[t[0]] - origin,
      Cross(surface.Points[t[1]] - origin, surface.Points[t[2]] - origin));
  }
  return volume;
}

double GetArea(const TriangleMesh& surface)
{
  double area = 0.0;
  for (const TriangleIds& t : surface.Triangles)
  {
    area += 0.5 *
      Norm(Cross(
        surface.Points[t[1]] - surface.Points[t[0]], surface.Points[t[2]] - surface.Points[t[0]]));
  }
  return area;
}

/** Enclosed segments of space. */
std::ptrdiff_t CountSegments(const TriangleMesh& surface)
{
  const SurfaceSides sides = FindSurfaceSides(surface);
  return std::count(sides.IsOuter.begin(), sides.IsOuter.end(), 0);
}
} // namespace

TEST(IntersectionResolver, TwoCrossingQuadrilaterals)
{
  Soup soup;
  soup.Add({ { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } });
  soup.Add({ { -0.5, 0, -1 }, { 0.5, 0, -1 }, { 0.5, 0, 1 }, { -0.5, 0, 1 } });
  const BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_DOUBLE_EQ(6.0, GetArea(output.Surface));
  // The quadrilaterals are two triangles each, so that the chain also has the crossings with the
  // diagonals, which are one and the same point.
  EXPECT_EQ(3u, output.NewPoints.size());
  EXPECT_EQ(2, output.Report.NonManifoldEdges);
  EXPECT_EQ(8, output.Report.OpenEdges - 2);
  EXPECT_LT(0, output.Report.SelfIntersections);
  EXPECT_EQ(4, output.Report.Resolution.CutTriangles);
  EXPECT_EQ(1, output.Report.Resolution.Rounds);
}

TEST(IntersectionResolver, NothingToDoChangesNothing)
{
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  const BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_EQ(12u, output.Surface.Triangles.size());
  EXPECT_EQ(0, output.Report.Resolution.Rounds);
  EXPECT_TRUE(output.NewPoints.empty());
}

TEST(IntersectionResolver, OverlappingCubes)
{
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.AddBox({ 0.5, 0.5, 0.5 }, { 1.5, 1.5, 1.5 });
  BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_DOUBLE_EQ(6.0 * 1.875, GetVolume(output.Surface));
  EXPECT_DOUBLE_EQ(10.5, GetArea(output.Surface));
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_EQ(0, output.Report.NonManifoldEdges);
  EXPECT_EQ(1, CountSegments(output.Surface));
  EXPECT_LT(0, output.Report.Resolution.InternalTriangles);

  output = Resolve(soup, ResolvedPieces::All);
  EXPECT_DOUBLE_EQ(12.0, GetArea(output.Surface));
  EXPECT_EQ(3, CountSegments(output.Surface));
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_EQ(0, output.Report.Resolution.InternalTriangles);
}

TEST(IntersectionResolver, CubesWithCoplanarFaces)
{
  // Four faces of each lie in those of the other.
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.AddBox({ 0.5, 0, 0 }, { 1.5, 1, 1 });
  BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_DOUBLE_EQ(6.0 * 1.5, GetVolume(output.Surface));
  EXPECT_DOUBLE_EQ(8.0, GetArea(output.Surface));
  EXPECT_EQ(0, output.Report.NonManifoldEdges);
  output = Resolve(soup, ResolvedPieces::All);
  EXPECT_DOUBLE_EQ(10.0, GetArea(output.Surface));
  EXPECT_EQ(3, CountSegments(output.Surface));
}

TEST(IntersectionResolver, CubesThatTouchOrAreNested)
{
  // A small cube on a large one: their common face is no outside.
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 2, 2, 2 });
  soup.AddBox({ 0.5, 0.25, 2 }, { 1.5, 1.25, 3 });
  BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_DOUBLE_EQ(6.0 * 9.0, GetVolume(output.Surface));
  EXPECT_DOUBLE_EQ(28.0, GetArea(output.Surface));
  EXPECT_DOUBLE_EQ(29.0, GetArea(Resolve(soup, ResolvedPieces::All).Surface));

  // A part without intersections is left alone, even inside another one.
  soup.AddBox({ 0.5, 0.5, 0.5 }, { 1, 1, 1 });
  EXPECT_DOUBLE_EQ(29.5, GetArea(Resolve(soup).Surface));
}

TEST(IntersectionResolver, ScrapsGoAndSheetsStay)
{
  // A triangle through a wall: one half lies inside, the other one bounds nothing.
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.Add({ { 0.5, 0.25, 0.5 }, { 2.5, 0.25, 0.5 }, { 2.5, 0.75, 0.5 } });
  EXPECT_DOUBLE_EQ(6.0, GetArea(Resolve(soup).Surface));
  EXPECT_DOUBLE_EQ(6.5, GetArea(Resolve(soup, ResolvedPieces::All).Surface));
  // With a triangle behind it that is not cut it may be a part of the model.
  soup.Add({ { 2.5, 0.25, 0.5 }, { 3.5, 0.25, 0.5 }, { 2.5, 0.75, 0.5 } });
  BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_LT(6.5, GetArea(output.Surface));
  EXPECT_LT(0, output.Report.OpenEdges);
}

TEST(IntersectionResolver, CavitiesStayEmpty)
{
  // Two bars and two beams make a frame around nothing.
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 4, 1 });
  soup.AddBox({ 3, 0, 0 }, { 4, 4, 1 });
  soup.AddBox({ -1, 0.5, 0.25 }, { 5, 1, 0.75 });
  soup.AddBox({ -1, 3, 0.25 }, { 5, 3.5, 0.75 });
  const double volume = 6.0 * (2 * 4 + 2 * 0.25 * (6 - 2));
  EXPECT_NEAR(volume, GetVolume(Resolve(soup).Surface), 1e-12);
  // A closed box of six plates around a void.
  Soup plates;
  plates.AddBox({ 0, 0, 0 }, { 5, 5, 1 });
  plates.AddBox({ 0, 0, 4 }, { 5, 5, 5 });
  plates.AddBox({ 0.25, 0.25, 0.5 }, { 1.25, 4.75, 4.5 });
  plates.AddBox({ 3.75, 0.25, 0.5 }, { 4.75, 4.75, 4.5 });
  plates.AddBox({ 1, 0.5, 0.5 }, { 4, 1.5, 4.5 });
  plates.AddBox({ 1, 3.5, 0.5 }, { 4, 4.5, 4.5 });
  const BoundaryTriangulatorOutput output = Resolve(plates);
  const double walls = 2 * 4.5 * 3 + 2 * 2.5 * 3;
  EXPECT_NEAR(6.0 * (50.0 + walls), GetVolume(output.Surface), 1e-12);
  EXPECT_EQ(2, CountSegments(output.Surface));
}

TEST(IntersectionResolver, WithoutAnOrientationTheOuterShellStays)
{
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.AddBox({ 0.5, 0.5, 0.5 }, { 1.5, 1.5, 1.5 });
  for (const Id face : { 1, 6, 9 })
  {
    std::reverse(soup.Connectivity.begin() + 4 * face, soup.Connectivity.begin() + 4 * face + 4);
  }
  const BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_DOUBLE_EQ(10.5, GetArea(output.Surface));
  // Stage 0 turns the three faces over afterwards.
  EXPECT_DOUBLE_EQ(6.0 * 1.875, GetVolume(output.Surface));
  EXPECT_EQ(3, output.Report.ReversedPolygons);
}

TEST(IntersectionResolver, CoplanarTriangles)
{
  Soup soup;
  soup.Add({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } });
  soup.Add({ { 1, 1, 0 }, { 5, 1, 0 }, { 1, 5, 0 } });
  BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_DOUBLE_EQ(8.0 + 8.0 - 2.0, GetArea(output.Surface));
  EXPECT_EQ(0, output.Report.NonManifoldEdges);
  EXPECT_EQ(2u, output.NewPoints.size());

  // One inside the other, a star, and a copy with a common edge and one with a common vertex.
  soup = {};
  soup.Add({ { 0, 0, 0 }, { 8, 0, 0 }, { 0, 8, 0 } });
  soup.Add({ { 1, 1, 0 }, { 3, 1, 0 }, { 1, 3, 0 } });
  EXPECT_DOUBLE_EQ(32.0, GetArea(Resolve(soup).Surface));
  soup.Add({ { 0, 0, 0 }, { 8, 0, 0 }, { 2, 5, 0 } });
  EXPECT_DOUBLE_EQ(32.0, GetArea(Resolve(soup).Surface));
  soup.Add({ { 8, 0, 0 }, { 0, 3, 0 }, { 0, 1, 0 } });
  EXPECT_DOUBLE_EQ(32.0, GetArea(Resolve(soup).Surface));
  soup = {};
  soup.Add({ { 0, 0, 0 }, { 6, 0, 0 }, { 3, 6, 0 } });
  soup.Add({ { 0, 4, 0 }, { 6, 4, 0 }, { 3, -2, 0 } });
  output = Resolve(soup);
  EXPECT_EQ(6u, output.NewPoints.size());
  EXPECT_DOUBLE_EQ(24.0, GetArea(output.Surface));
}

TEST(IntersectionResolver, Touches)
{
  Soup soup;
  soup.Add({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } });
  // A vertex on the triangle, an edge on it, an edge across its edge, a vertex on its edge.
  soup.Add({ { 1, 1, 0 }, { 1, 2, 3 }, { 2, 1, 3 } });
  soup.Add({ { 0.5, 0.5, 0 }, { 0.5, 1.5, 0 }, { 0.25, 1, -2 } });
  soup.Add({ { 3, 0, -1 }, { 3, 0, 1 }, { 3, -1, 0 } });
  soup.Add({ { 2, 2, 0 }, { 3, 3, 1 }, { 3, 3, -1 } });
  const BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_EQ(1u, output.NewPoints.size());
  EXPECT_EQ((Vec3{ 3, 0, 0 }), output.Surface.Points.back());
}

TEST(IntersectionResolver, ThreePlanesMeetInOnePoint)
{
  Soup soup;
  soup.Add({ { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } });
  soup.Add({ { -1, 0, -1 }, { 1, 0, -1 }, { 1, 0, 1 }, { -1, 0, 1 } });
  soup.Add({ { 0, -1, -1 }, { 0, 1, -1 }, { 0, 1, 1 }, { 0, -1, 1 } });
  std::mt19937 random(7);
  for (int i = 0; i < 10; ++i)
  {
    SCOPED_TRACE("rotation " + std::to_string(i) + " of seed 7");
    Soup rotated = soup;
    const Transform rotation = Transform::Rotation(random);
    if (i > 0)
    {
      rotated.Apply(rotation);
    }
    const BoundaryTriangulatorOutput output = Resolve(rotated);
    EXPECT_NEAR(12.0, GetArea(output.Surface), 1e-9);
    // Six ends of the common lines, and the common point.
    EXPECT_EQ(7u, output.NewPoints.size());
    EXPECT_EQ(6, output.Report.NonManifoldEdges);
  }
}

TEST(IntersectionResolver, RotatedCubes)
{
  constexpr unsigned seed = 11;
  std::mt19937 random(seed);
  for (int i = 0; i < 40; ++i)
  {
    SCOPED_TRACE("case " + std::to_string(i) + " of seed " + std::to_string(seed));
    // Each rotated by itself; then together, where faces are coplanar but for rounding errors.
    Soup soup;
    soup.AddBox({ -1, -1, -1 }, { 1, 1, 1 });
    Soup other;
    other.AddBox({ -1, -1, -1 }, { 1, 1, 1 });
    other.Apply(Transform::Rotation(random));
    other.Apply(Transform::Scale(1.0, { 0.3, 0.4, 0.5 }));
    for (Id face = 0; face < 6; ++face)
    {
      const Id* polygon = other.GetPolygon(face);
      soup.Add({ other.Points[polygon[0]], other.Points[polygon[1]], other.Points[polygon[2]],
        other.Points[polygon[3]] });
    }
    BoundaryTriangulatorOutput output = Resolve(soup);
    EXPECT_EQ(0, output.Report.OpenEdges);
    EXPECT_EQ(1, CountSegments(output.Surface));
    EXPECT_LT(48.0, GetVolume(output.Surface));
    EXPECT_GT(96.0, GetVolume(output.Surface));

    const Transform rotation = Transform::Rotation(random);
    for (const bool isShifted : { false, true })
    {
      Soup flush;
      flush.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
      flush.AddBox({ 0.5, isShifted ? 0.25 : 0.0, 0 }, { 1.5, isShifted ? 1.25 : 1.0, 1 });
      flush.Apply(rotation);
      output = Resolve(flush);
      EXPECT_NEAR(6.0 * (isShifted ? 1.625 : 1.5), GetVolume(output.Surface), 1e-9);
      EXPECT_NEAR(isShifted ? 2.0 * 1.625 + 5.5 : 8.0, GetArea(output.Surface), 1e-9);
      EXPECT_EQ(0, output.Report.OpenEdges);
    }
  }
}

TEST(IntersectionResolver, RandomTriangles)
{
  constexpr unsigned seed = 2026;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 24; ++i)
  {
    SCOPED_TRACE("soup " + std::to_string(i) + " of seed " + std::to_string(seed));
    Soup soup;
    const int size = 5 + 2 * i;
    for (int k = 0; k < size; ++k)
    {
      std::vector<Vec3> corners;
      for (int c = 0; c < 3; ++c)
      {
        corners.push_back({ uniform(random), uniform(random), uniform(random) });
        if (i % 2 == 1)
        {
          // On a coarse grid: touches, overlaps and common lines of all kinds.
          for (int axis = 0; axis < 3; ++axis)
          {
            corners.back()[axis] = std::floor(5.0 * corners.back()[axis]);
          }
        }
      }
      soup.Add(corners);
    }
    const Transform rotation = Transform::Rotation(random);
    if (i % 4 == 3)
    {
      soup.Apply(rotation);
    }
    const BoundaryTriangulatorOutput all = Resolve(soup, ResolvedPieces::All);
    const BoundaryTriangulatorOutput outside = Resolve(soup);
    EXPECT_GE(GetArea(all.Surface), GetArea(outside.Surface));
  }
}

TEST(IntersectionResolver, AllScalesAndPlaces)
{
  for (const double scale : { 1e-9, 1e-6, 1.0 / 3.0, 1e3, 1e6 })
  {
    for (const double shift : { 0.0, 100.0 })
    {
      SCOPED_TRACE("scale " + std::to_string(scale) + " shift " + std::to_string(shift));
      Soup soup;
      soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
      soup.AddBox({ 0.5, 0.3, 0 }, { 1.5, 1.3, 1 });
      std::mt19937 random(3);
      soup.Apply(Transform::Rotation(random));
      soup.Apply(Transform::Scale(scale, { shift * scale, -shift * scale, shift * scale }));
      const BoundaryTriangulatorOutput output = Resolve(soup);
      EXPECT_NEAR(6.0 * 1.65, GetVolume(output.Surface) / scale / scale / scale, 1e-8);
      EXPECT_EQ(0, output.Report.OpenEdges);
      EXPECT_EQ(1, CountSegments(output.Surface));
    }
  }
}

TEST(IntersectionResolver, LabelsAreKept)
{
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.AddBox({ 0.5, 0.5, 0.5 }, { 1.5, 1.5, 1.5 });
  soup.Labels.assign(6, RegionPair{ OutsideRegion, 4 });
  soup.Labels.resize(12, RegionPair{ OutsideRegion, 9 });
  const BoundaryTriangulatorOutput output = Resolve(soup);
  EXPECT_DOUBLE_EQ(12.0, GetArea(output.Surface));
  for (std::size_t t = 0; t < output.Surface.Triangles.size(); ++t)
  {
    EXPECT_EQ(soup.Labels[output.Surface.SourceCells[t]], output.Surface.Labels[t]);
  }

  // Back to back they make an interface of a part of a face.
  soup = {};
  soup.AddBox({ 0, 0, 0 }, { 2, 2, 2 });
  soup.AddBox({ 0.5, 0.25, 2 }, { 1.5, 1.25, 3 });
  soup.Labels.assign(6, RegionPair{ OutsideRegion, 4 });
  soup.Labels.resize(12, RegionPair{ OutsideRegion, 9 });
  TriangleMesh surface = Resolve(soup).Surface;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    if (surface.Labels[t].Front >= 0 && surface.Labels[t].Back >= 0)
    {
      surface.Triangles[kept++] = surface.Triangles[t];
    }
  }
  surface.Triangles.resize(kept);
  EXPECT_DOUBLE_EQ(1.0, GetArea(surface));

  // Both claim the same side of the overlap.
  soup = {};
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.AddBox({ 0.5, 0, 0.25 }, { 1.5, 1, 0.75 });
  soup.Labels.assign(6, RegionPair{ OutsideRegion, 4 });
  soup.Labels.resize(12, RegionPair{ OutsideRegion, 9 });
  BoundaryTriangulatorOptions options;
  options.ResolveSelfIntersections = true;
  BoundaryTriangulatorOutput failed;
  const Status status = TriangulateBoundary(soup, options, {}, failed);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ((std::vector<Id>{ 2, 3, 8, 9 }), status.Cells);
  EXPECT_TRUE(failed.Surface.Triangles.empty());
  EXPECT_TRUE(failed.NewPoints.empty());
}

TEST(IntersectionResolver, PatchesMayCrossTheSurface)
{
  // A box without lid, and a rod that comes out of it.
  Soup soup;
  soup.AddBox({ 0.25, 0.25, 0.5 }, { 0.75, 0.75, 1.5 });
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.Offsets.erase(soup.Offsets.begin() + 8);
  soup.Connectivity.erase(soup.Connectivity.begin() + 28, soup.Connectivity.begin() + 32);
  for (std::size_t i = 8; i < soup.Offsets.size(); ++i)
  {
    soup.Offsets[i] -= 4;
  }
  soup.Offsets.resize(12);
  soup.Offsets.back() = static_cast<Id>(soup.Connectivity.size());
  BoundaryTriangulatorOptions options;
  options.ResolveSelfIntersections = true;
  options.MaximumGapEdges = 4;
  BoundaryTriangulatorOutput output;
  ASSERT_TRUE(TriangulateBoundary(soup, options, {}, output).IsOk());
  ExpectClean(output, soup);
  EXPECT_EQ(1, output.Report.PatchedRings);
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_DOUBLE_EQ(6.0 * 1.125, GetVolume(output.Surface));
}

TEST(IntersectionResolver, NeedlesAndNearMisses)
{
  // A needle narrower than the tolerance across a triangle, and vertices a hair beside a plane.
  Soup soup;
  soup.Add({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } });
  soup.Add({ { 1, 1, -1 }, { 1, 1, 1 }, { 1 + 1e-13, 1, 0.3 } });
  soup.Add({ { 2, 1, 1e-13 }, { 2, 1.5, -1e-13 }, { 2, 1, 1 } });
  soup.Add({ { 0.5, 0.5, 1e-14 }, { 0.5, 1.5, -1e-14 }, { 0.75, 1, -1e-14 } });
  Resolve(soup);
}

TEST(IntersectionResolver, BadOptionsAndTooFewRounds)
{
  TriangleMesh surface;
  surface.Points = { { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 }, { 1, 1, -1 }, { 1, 1, 1 },
    { 9, 9, 1 } };
  surface.Triangles = { { 0, 1, 2 }, { 3, 4, 5 } };
  surface.SourceCells = { 7, 5 };
  IntersectionResolverOptions options;
  IntersectionResolverReport report;
  std::vector<PointParents> newPoints;
  options.MaximumRounds = 0;
  EXPECT_EQ(
    StatusCode::InvalidOption, ResolveIntersections(options, {}, surface, newPoints, report).Code);
  options = {};
  options.Tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(
    StatusCode::InvalidOption, ResolveIntersections(options, {}, surface, newPoints, report).Code);

  // Vertices nearer than the tolerance are merged first, which takes the only round.
  options = {};
  options.Tolerance = 0.01;
  options.MaximumRounds = 1;
  surface.Points.insert(
    surface.Points.end(), { { 1, 1.5, 0.004 }, { 1, 1.5, -0.004 }, { 5, 5, 5 } });
  surface.Triangles.push_back({ 6, 7, 8 });
  surface.SourceCells.push_back(3);
  const TriangleMesh before = surface;
  const Status status = ResolveIntersections(options, {}, surface, newPoints, report);
  EXPECT_EQ(StatusCode::SelfIntersecting, status.Code);
  EXPECT_EQ((std::vector<Id>{ 5, 7 }), status.Cells);
  EXPECT_EQ(before.Triangles, surface.Triangles);
  options.MaximumRounds = 2;
  EXPECT_TRUE(ResolveIntersections(options, {}, surface, newPoints, report).IsOk());
  EXPECT_EQ(1, report.MergedPoints);
}

TEST(IntersectionResolver, AbortLeavesNothing)
{
  Soup soup;
  soup.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  soup.AddBox({ 0.5, 0.5, 0.5 }, { 1.5, 1.5, 1.5 });
  double last = 0.0;
  int calls = 0;
  int limit = std::numeric_limits<int>::max();
  const ExecutionContext context(
    [&](double fraction, const char*)
    {
      EXPECT_LE(last, fraction);
      last = fraction;
      ++calls;
    },
    [&] { return calls >= limit; });
  BoundaryTriangulatorOptions options;
  options.ResolveSelfIntersections = true;
  BoundaryTriangulatorOutput output;
  ASSERT_TRUE(TriangulateBoundary(soup, options, context, output).IsOk());
  const int all = calls;
  for (limit = 1; limit <= all; ++limit)
  {
    last = 0.0;
    calls = 0;
    EXPECT_TRUE(TriangulateBoundary(soup, options, context, output).IsAborted());
    EXPECT_TRUE(output.Surface.Triangles.empty());
    EXPECT_TRUE(output.NewPoints.empty());
  }
}

/** What a T-junction leaves in a file whose coordinates are rounded: a triangle of no width. */
TEST(IntersectionResolver, ClosesNeedlesOfTheInput)
{
  TriangleMesh surface;
  surface.Points = { { -0.19253, 5.75, 2.364 }, { -0.19761, 5.72, 2.3706 }, { 0.3, 5.8, 2.2 },
    { 0.1, 6.2, 2.5 }, { -0.19507, 5.735, 2.3673 } };
  // A tetrahedron; facet (0, 1, 3) is divided at the middle of edge (0, 1), facet (0, 2, 1) is not.
  surface.Triangles = { { 0, 2, 1 }, { 0, 4, 3 }, { 4, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 },
    { 0, 1, 4 } };
  surface.SourceCells = { 0, 1, 2, 3, 4, 5 };
  ASSERT_FALSE(AreCollinear(surface.Points[0], surface.Points[1], surface.Points[4]));
  std::vector<PointParents> newPoints;
  IntersectionResolverReport report;
  ASSERT_TRUE(ResolveIntersections({}, {}, surface, newPoints, report).IsOk());
  EXPECT_TRUE(newPoints.empty());
  std::set<TriangleIds> triangles;
  for (TriangleIds ids : surface.Triangles)
  {
    std::sort(ids.begin(), ids.end());
    triangles.insert(ids);
  }
  EXPECT_EQ(triangles,
    (std::set<TriangleIds>{
      { 0, 2, 4 }, { 1, 2, 4 }, { 0, 3, 4 }, { 1, 3, 4 }, { 1, 2, 3 }, { 0, 2, 3 } }));
}
