// SPDX-License-Identifier: BSD-3-Clause
// Remeshed surfaces stay what they are: place in both directions, topology, labels, corners. What
// the engine proves is sampled here, by distances that share no code with it.
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Search/BoxTree.h"
#include "Core/Surface/CurvatureLengths.h"
#include "Core/Surface/SurfaceRemesher.h"
#include "EnclosedVolumes.h"
#include "LayerSurfaces.h"
#include "SurfaceAngles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>

using namespace cdm;

namespace
{
using Shape = std::function<Vec3(double, double)>;

/** Makes surfaces of patches, whose points of equal coordinates are one. */
class SurfaceBuilder
{
public:
  Id Add(const Vec3& p)
  {
    const auto [place, isNew] = this->Ids.emplace(p, static_cast<Id>(this->Surface.Points.size()));
    if (isNew)
    {
      this->Surface.Points.push_back(p);
    }
    return place->second;
  }

  void AddTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const RegionPair& labels)
  {
    const TriangleIds ids{ this->Add(a), this->Add(b), this->Add(c) };
    if (ids[0] != ids[1] && ids[1] != ids[2] && ids[2] != ids[0])
    {
      this->Surface.Triangles.push_back(ids);
      this->Surface.Labels.push_back(labels);
    }
  }

  /** u and v from 0 to 1; the front is where u x v points to. */
  void AddPatch(const Shape& shape, int sizeU, int sizeV, const RegionPair& labels)
  {
    const auto get = [&](int i, int j)
    { return shape(static_cast<double>(i) / sizeU, static_cast<double>(j) / sizeV); };
    for (int i = 0; i < sizeU; ++i)
    {
      for (int j = 0; j < sizeV; ++j)
      {
        this->AddTriangle(get(i, j), get(i + 1, j), get(i + 1, j + 1), labels);
        this->AddTriangle(get(i, j), get(i + 1, j + 1), get(i, j + 1), labels);
      }
    }
  }

  /** The sphere as a bulged cube of 12 n^2 triangles. */
  void AddSphere(double radius, int n, const RegionPair& labels)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const double side : { -1.0, 1.0 })
      {
        this->AddPatch(
          [&](double u, double v)
          {
            Vec3 p;
            p[axis] = side;
            p[(axis + 1) % 3] = 2.0 * (side > 0.0 ? u : v) - 1.0;
            p[(axis + 2) % 3] = 2.0 * (side > 0.0 ? v : u) - 1.0;
            return (radius / Norm(p)) * p;
          },
          n, n, labels);
      }
    }
  }

  TriangleMesh Surface;

private:
  std::map<Vec3, Id> Ids;
};

const RegionPair Outer{ OutsideRegion, 0 };

/** Numbers rounded so that both ends of a period are one point. */
double Turn(double (*function)(double), double part)
{
  return std::round(function(2.0 * M_PI * part) * 1e12) * 1e-12;
}

TriangleMesh MakeTorus(int n, int m)
{
  SurfaceBuilder builder;
  builder.AddPatch(
    [](double u, double v)
    {
      const double radius = 3.0 + Turn(std::cos, v);
      return Vec3{ radius * Turn(std::cos, u), radius * Turn(std::sin, u), Turn(std::sin, v) };
    },
    n, m, Outer);
  return builder.Surface;
}

/**
 * The unit box, with each face n x n squares, n a power of two; below a wavy interface region 0, above it
 * region 1.
 */
TriangleMesh MakeTwoRegions(int n, double wave)
{
  SurfaceBuilder builder;
  const auto middle = [wave](double x, double y)
  { return 0.5 + wave * std::sin(5.0 * x) * std::cos(4.0 * y); };
  const auto addWalls = [&](Id region, const std::function<double(double, double, double)>& height)
  {
    const RegionPair labels{ OutsideRegion, region };
    const int h = n / 2;
    builder.AddPatch(
      [&](double u, double v) {
        return Vec3{ u, 0.0, height(u, 0.0, v) };
      },
      n, h, labels);
    builder.AddPatch(
      [&](double u, double v) {
        return Vec3{ 1.0 - u, 1.0, height(1.0 - u, 1.0, v) };
      },
      n, h, labels);
    builder.AddPatch(
      [&](double u, double v) {
        return Vec3{ 0.0, 1.0 - u, height(0.0, 1.0 - u, v) };
      },
      n, h, labels);
    builder.AddPatch(
      [&](double u, double v) {
        return Vec3{ 1.0, u, height(1.0, u, v) };
      },
      n, h, labels);
  };
  addWalls(0, [&](double x, double y, double t) { return t * middle(x, y); });
  addWalls(
    1, [&](double x, double y, double t) { return t == 1.0 ? 1.0 : middle(x, y) * (1.0 - t) + t; });
  builder.AddPatch([&](double u, double v) { return Vec3{ v, u, 0.0 }; }, n, n, Outer);
  builder.AddPatch(
    [&](double u, double v) {
      return Vec3{ u, v, 1.0 };
    },
    n, n, { OutsideRegion, 1 });
  builder.AddPatch([&](double u, double v) { return Vec3{ u, v, middle(u, v) }; }, n, n, { 1, 0 });
  return builder.Surface;
}

/** A bumpy sphere of 12 n^2 triangles whose points are off by noise. */
TriangleMesh MakeBumpySphere(int n, double noise, std::mt19937& generator)
{
  SurfaceBuilder builder;
  builder.AddSphere(1.0, n, Outer);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vec3 waves{ 4.0 * uniform(generator), 4.0 * uniform(generator), 4.0 * uniform(generator) };
  for (Vec3& p : builder.Surface.Points)
  {
    const double bump = 1.0 + 0.2 * std::sin(Dot(waves, p)) + noise * uniform(generator);
    p = bump * p;
  }
  return builder.Surface;
}

/** Largest distance of samples of one surface from another one. */
double SampleDistance(const TriangleMesh& from, const TriangleMesh& to)
{
  std::vector<Box> boxes;
  Box bounds;
  for (const TriangleIds& ids : to.Triangles)
  {
    boxes.push_back(GetBox(to.Points, ids));
    bounds.Add(boxes.back());
  }
  const BoxTree tree(boxes);
  const double step = 0.01 * Distance(bounds.Low, bounds.High);
  const auto getDistance = [&](const Vec3& p)
  {
    for (double reach = step;; reach *= 2.0)
    {
      double distance = std::numeric_limits<double>::infinity();
      tree.VisitOverlaps(Box::MakeAround(p, reach),
        [&](Id t)
        {
          const TriangleIds& ids = to.Triangles[t];
          distance = std::min(distance,
            GetDistanceToTriangle(p, to.Points[ids[0]], to.Points[ids[1]], to.Points[ids[2]]));
        });
      if (distance <= reach)
      {
        return distance;
      }
    }
  };
  constexpr int Samples = 5;
  double largest = 0.0;
  for (const TriangleIds& ids : from.Triangles)
  {
    const Vec3& a = from.Points[ids[0]];
    const Vec3 b = (1.0 / Samples) * (from.Points[ids[1]] - a);
    const Vec3 c = (1.0 / Samples) * (from.Points[ids[2]] - a);
    for (int i = 0; i <= Samples; ++i)
    {
      for (int j = 0; i + j <= Samples; ++j)
      {
        largest = std::max(largest, getDistance(a + double(i) * b + double(j) * c));
      }
    }
  }
  return largest;
}

/** The triangles with certain labels. */
TriangleMesh Select(const TriangleMesh& surface, const RegionPair& labels)
{
  TriangleMesh selected;
  selected.Points = surface.Points;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    if (surface.Labels[t] == labels)
    {
      selected.Triangles.push_back(surface.Triangles[t]);
    }
  }
  return selected;
}

/** Points minus edges plus triangles, and how many edges have each number of triangles. */
std::map<int, Id> GetTopology(const TriangleMesh& surface)
{
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
  std::map<int, Id> topology;
  Id edges = 0;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end, ++edges)
  {
    while (end < uses.size() && uses[end].Edge == uses[begin].Edge)
    {
      ++end;
    }
    topology[static_cast<int>(end - begin)] = 1;
  }
  topology[0] =
    static_cast<Id>(surface.Points.size()) - edges + static_cast<Id>(surface.Triangles.size());
  return topology;
}

double GetArea(const TriangleMesh& surface)
{
  double area = 0.0;
  for (const TriangleIds& ids : surface.Triangles)
  {
    area += GetTriangleArea(surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]]);
  }
  return area;
}

double GetMedianEdge(const TriangleMesh& surface)
{
  std::vector<double> lengths;
  for (const TriangleIds& ids : surface.Triangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      lengths.push_back(Distance(surface.Points[ids[i]], surface.Points[ids[(i + 1) % 3]]));
    }
  }
  std::nth_element(lengths.begin(), lengths.begin() + lengths.size() / 2, lengths.end());
  return lengths[lengths.size() / 2];
}

/** All that has to be true of any remeshed surface. */
void Check(const TriangleMesh& input, const SurfaceRemesherOutput& output, double deviation)
{
  const TriangleMesh& surface = output.Surface;
  ASSERT_FALSE(surface.Triangles.empty());
  // Distances, for the triangles between each two regions by themselves.
  std::vector<RegionPair> kinds;
  for (const RegionPair& labels : input.Labels)
  {
    if (std::find(kinds.begin(), kinds.end(), labels) == kinds.end())
    {
      kinds.push_back(labels);
    }
  }
  for (const RegionPair& labels : kinds)
  {
    const TriangleMesh before = Select(input, labels);
    const TriangleMesh after = Select(surface, labels);
    ASSERT_FALSE(after.Triangles.empty());
    EXPECT_LE(SampleDistance(before, after), deviation * (1.0 + 1e-6));
    EXPECT_LE(SampleDistance(after, before), deviation * (1.0 + 1e-6));
  }
  EXPECT_EQ(GetTopology(surface), GetTopology(input));
  std::vector<TrianglePair> pairs;
  EXPECT_TRUE(FindIntersectingPairs(surface.Points, surface.Triangles, {}, {}, pairs));
  EXPECT_TRUE(pairs.empty());
  // Volumes differ by no more than a skin of the deviation: their sum of all regions at each side.
  const double skin = 6.0 * deviation * std::max(GetArea(input), GetArea(surface));
  const std::map<Id, double> before = testing_core::GetEnclosedSixVolumes(input);
  const std::map<Id, double> after = testing_core::GetEnclosedSixVolumes(surface);
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [region, volume] : before)
  {
    EXPECT_NEAR(after.at(region), volume, skin);
    EXPECT_GT(after.at(region) * volume, 0.0);
  }
  // Sources: labels are those of the triangle, kept points have their positions.
  ASSERT_EQ(surface.SourceCells.size(), surface.Triangles.size());
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    EXPECT_EQ(surface.Labels[t], input.Labels[surface.SourceCells[t]]);
  }
  ASSERT_EQ(output.PointSources.size() + output.NewPoints.size(), surface.Points.size());
  for (std::size_t i = 0; i < output.PointSources.size(); ++i)
  {
    EXPECT_EQ(surface.Points[i], input.Points[output.PointSources[i]]);
  }
  for (std::size_t i = 0; i < output.NewPoints.size(); ++i)
  {
    const PointParents& parents = output.NewPoints[i];
    Vec3 sum;
    for (int k = 0; k < 3; ++k)
    {
      sum = sum + parents.Weights[k] * input.Points[parents.Ids[k]];
    }
    EXPECT_LE(Distance(sum, surface.Points[output.PointSources.size() + i]), 1.01 * deviation);
  }
}

SurfaceRemesherOutput Remesh(const TriangleMesh& surface, double length, double deviation,
  const std::vector<Id>& facets = {}, int numberOfThreads = 1)
{
  SurfaceRemesherInput input;
  input.Surface = &surface;
  input.Facets = facets;
  SurfaceRemesherOptions options;
  options.EdgeLength = length;
  options.MaximumDeviation = deviation;
  SurfaceRemesherOutput output;
  const ExecutionContext context(numberOfThreads);
  const Status status = RemeshSurface(input, options, context, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}

/** Edges are no longer where curvature says so, and triangles have no small angles. */
TEST(SurfaceRemesher, KeepsThinLimbsEven)
{
  const double deviation = 0.15;
  const TriangleMesh torus = MakeTorus(192, 64);
  const SurfaceRemesherOutput output = Remesh(torus, 2.0, deviation);
  Check(torus, output, deviation);
  const double allowed = std::sqrt(6.0 * deviation - 3.0 * deviation * deviation);
  EXPECT_LT(GetMedianEdge(output.Surface), 1.2 * allowed);
  EXPECT_GT(GetMedianEdge(output.Surface), 0.8 * allowed);
  EXPECT_GT(testing_core::GetSmallestAngle(output.Surface), 20.0);
}

TEST(CurvatureLengths, ArePlainOnSpheresAndPlanes)
{
  for (const double radius : { 1e-6, 1.0, 1e6 })
  {
    SurfaceBuilder sphere;
    sphere.AddSphere(radius, 40, Outer);
    for (const double ratio : { 0.001, 0.1, 2.0 })
    {
      const double deviation = ratio * radius;
      const std::vector<double> lengths = GetCurvatureLengths(sphere.Surface, {},
        std::vector<double>(sphere.Surface.Points.size(), 0.3 * radius), deviation);
      const double larger = std::max(radius, deviation);
      const double wanted = std::sqrt(6.0 * deviation * larger - 3.0 * deviation * deviation);
      for (const double length : lengths)
      {
        EXPECT_NEAR(length, wanted, 0.05 * wanted);
      }
    }
  }
  SurfaceBuilder plane;
  plane.AddPatch([](double u, double v) { return Vec3{ u, v, u - v }; }, 20, 20, Outer);
  for (const double length : GetCurvatureLengths(
         plane.Surface, {}, std::vector<double>(plane.Surface.Points.size(), 0.5), 0.01))
  {
    EXPECT_GT(length, 1e3);
  }
}

/** The cap of a box knows nothing of its walls, whose normals chains keep apart. */
TEST(CurvatureLengths, EndAtChains)
{
  const TriangleMesh box = MakeTwoRegions(16, 0.0);
  StructuralEdgesOutput edges;
  ASSERT_TRUE(ExtractStructuralEdges(box, {}, {}, edges).IsOk());
  ASSERT_FALSE(edges.Edges.empty());
  for (const double length :
    GetCurvatureLengths(box, edges.Edges, std::vector<double>(box.Points.size(), 10.0), 0.01))
  {
    EXPECT_GT(length, 1e3);
  }
  double shortest = 1e3;
  for (const double length :
    GetCurvatureLengths(box, {}, std::vector<double>(box.Points.size(), 0.3), 0.01))
  {
    shortest = std::min(shortest, length);
  }
  EXPECT_LT(shortest, 0.3) << "without chains the edges of the box are curved";
}

TEST(SurfaceRemesher, EvensOutASphere)
{
  SurfaceBuilder builder;
  builder.AddSphere(1.0, 20, Outer);
  const SurfaceRemesherOutput output = Remesh(builder.Surface, 0.3, 0.03);
  Check(builder.Surface, output, 0.03);
  // A sphere of equilateral triangles of this size has 322.
  EXPECT_LT(output.Surface.Triangles.size(), 500u);
  EXPECT_NEAR(GetMedianEdge(output.Surface), 0.3, 0.06);
}

TEST(SurfaceRemesher, KeepsTheHoleOfATorus)
{
  const TriangleMesh torus = MakeTorus(96, 32);
  for (const double length : { 0.5, 1.0, 20.0 })
  {
    const SurfaceRemesherOutput output = Remesh(torus, length, 0.15);
    Check(torus, output, 0.15);
    EXPECT_LT(output.Surface.Triangles.size(), torus.Triangles.size() / 3);
  }
}

/** The narrow sides of a tube of 300 facets, along its axis. */
TEST(SurfaceRemesher, CollapsesStrips)
{
  const TriangleMesh tube = MakeTubeSurface(300, 0.2);
  EXPECT_TRUE(IsOfStrips(tube, std::vector<double>(tube.Points.size(), 0.3)));
  EXPECT_FALSE(IsOfStrips(tube, std::vector<double>(tube.Points.size(), 10.0)));
  EXPECT_FALSE(IsOfStrips(tube, std::vector<double>(tube.Points.size(), 0.02)));
  const SurfaceRemesherOutput output = Remesh(tube, 0.3, 0.02);
  Check(tube, output, 0.02);
  // Both walls in equilateral triangles of this size have 1,740.
  EXPECT_LT(output.Surface.Triangles.size(), 2400u);
  EXPECT_NEAR(GetMedianEdge(output.Surface), 0.3, 0.06);
}

TEST(SurfaceRemesher, FindsTheFacetsOfABox)
{
  const TriangleMesh box = MakeTwoRegions(16, 0.0);
  const SurfaceRemesherOutput output = Remesh(box, 10.0, 1e-3);
  Check(box, output, 1e-3);
  // Two boxes with a common face: two triangles on each of 11 faces.
  EXPECT_EQ(output.Surface.Triangles.size(), 22u);
  EXPECT_EQ(output.Surface.Points.size(), 12u);
  EXPECT_TRUE(output.NewPoints.empty());
  const std::map<Id, double> volumes = testing_core::GetEnclosedSixVolumes(output.Surface);
  EXPECT_DOUBLE_EQ(volumes.at(0), 3.0);
  EXPECT_DOUBLE_EQ(volumes.at(1), 3.0);
}

// A needle along an edge of a turned cube, which is flat but for rounding: its long side cannot be split.
// The other edges beside it were split time and again, as one of two is always long there.
TEST(SurfaceRemesher, EndsBesideEdgesThatCannotBeSplit)
{
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> random(0.0, 6.0);
  for (int i = 0; i < 5; ++i)
  {
    const double first = random(generator);
    const double second = random(generator);
    TriangleMesh cube;
    for (int j = 0; j < 9; ++j)
    {
      const Vec3 p =
        j < 8 ? Vec3{ double(j & 1), double(j >> 1 & 1), double(j >> 2) } : Vec3{ 0.375, 0.0, 0.0 };
      const Vec3 turned{ std::cos(first) * p.X - std::sin(first) * p.Y,
        std::sin(first) * p.X + std::cos(first) * p.Y, p.Z };
      cube.Points.push_back({ turned.X, std::cos(second) * turned.Y - std::sin(second) * turned.Z,
        std::sin(second) * turned.Y + std::cos(second) * turned.Z });
    }
    cube.Triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 0, 1, 8 }, { 0, 8, 4 }, { 8, 5, 4 }, { 8, 1, 5 },
      { 4, 5, 6 }, { 5, 7, 6 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 5 }, { 3, 7, 5 }, { 2, 6, 7 },
      { 2, 7, 3 } };
    cube.Labels.assign(cube.Triangles.size(), { OutsideRegion, 0 });
    const SurfaceRemesherOutput output = Remesh(cube, 0.1, 0.01);
    EXPECT_LT(output.Surface.Triangles.size(), 4000u) << i;
  }
}

TEST(SurfaceRemesher, KeepsTheInterfaceOfTwoRegions)
{
  for (const double wave : { 0.05, 0.4 })
  {
    SCOPED_TRACE(wave);
    const TriangleMesh surface = MakeTwoRegions(16, wave);
    const SurfaceRemesherOutput output = Remesh(surface, 0.2, 0.02);
    Check(surface, output, 0.02);
    EXPECT_LT(output.Surface.Triangles.size(), surface.Triangles.size() / 2);
    for (int corner = 0; corner < 8; ++corner)
    {
      const Vec3 p{ double(corner & 1), double((corner >> 1) & 1), double(corner >> 2) };
      EXPECT_EQ(std::count(output.Surface.Points.begin(), output.Surface.Points.end(), p), 1);
    }
  }
}

/** The sheets are closer than the bound, which alone would let them touch. */
TEST(SurfaceRemesher, KeepsTheSheetsOfAThinShellApart)
{
  SurfaceBuilder builder;
  builder.AddSphere(1.0, 16, Outer);
  builder.AddSphere(0.99, 16, { 0, OutsideRegion });
  const SurfaceRemesherOutput output = Remesh(builder.Surface, 0.4, 0.05);
  Check(builder.Surface, output, 0.05);
  EXPECT_LT(output.Surface.Triangles.size(), builder.Surface.Triangles.size() / 2);
}

/** A spike is far from any surface without it, though that is near to one with it. */
TEST(SurfaceRemesher, KeepsASpike)
{
  TriangleMesh surface = MakeTwoRegions(16, 0.0);
  const auto isMiddle = [](const Vec3& p) { return p == Vec3{ 0.5, 0.5, 1.0 }; };
  const auto tip = std::find_if(surface.Points.begin(), surface.Points.end(), isMiddle);
  ASSERT_NE(tip, surface.Points.end());
  tip->Z = 1.2;
  Check(surface, Remesh(surface, 0.5, 0.02), 0.02);
}

/** Contacts, say: borders on a plane that only numbers show. */
TEST(SurfaceRemesher, KeepsGivenFacets)
{
  const TriangleMesh surface = MakeTwoRegions(16, 0.0);
  std::vector<Id> facets;
  double area = 0.0;
  const auto isContact = [&](const TriangleMesh& mesh, std::size_t t)
  {
    const TriangleIds& ids = mesh.Triangles[t];
    return std::all_of(ids.begin(), ids.end(),
      [&](Id id)
      {
        const Vec3& p = mesh.Points[id];
        return p.Z == 1.0 && p.X >= 0.25 && p.X <= 0.5 && p.Y >= 0.25 && p.Y <= 0.75;
      });
  };
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    facets.push_back(isContact(surface, t) ? 7 : 3);
  }
  const SurfaceRemesherOutput output = Remesh(surface, 1.0, 0.01, facets);
  Check(surface, output, 0.01);
  for (std::size_t t = 0; t < output.Surface.Triangles.size(); ++t)
  {
    const bool isOfContact = facets[output.Surface.SourceCells[t]] == 7;
    EXPECT_EQ(isOfContact, isContact(output.Surface, t));
    const TriangleIds& ids = output.Surface.Triangles[t];
    area += isOfContact ? GetTriangleArea(output.Surface.Points[ids[0]],
                            output.Surface.Points[ids[1]], output.Surface.Points[ids[2]])
                        : 0.0;
  }
  EXPECT_NEAR(area, 0.125, 1e-15);
}

TEST(SurfaceRemesher, FollowsASizingField)
{
  SurfaceBuilder builder;
  builder.AddSphere(1.0, 24, Outer);
  SurfaceRemesherInput input;
  input.Surface = &builder.Surface;
  input.Sizing = [](const Vec3& p) { return LocalSpacing(p.Z > 0.0 ? 0.15 + 0.3 * p.Z : 0.15); };
  SurfaceRemesherOptions options;
  options.MaximumDeviation = 0.03;
  SurfaceRemesherOutput output;
  ASSERT_TRUE(RemeshSurface(input, options, {}, output).IsOk());
  Check(builder.Surface, output, 0.03);
  TriangleMesh halves[2];
  for (const TriangleIds& ids : output.Surface.Triangles)
  {
    const double z = output.Surface.Points[ids[0]].Z;
    halves[z > 0.5 ? 1 : 0].Triangles.push_back(ids);
    if (std::abs(z - 0.25) < 0.25)
    {
      halves[0].Triangles.pop_back();
    }
  }
  halves[0].Points = halves[1].Points = output.Surface.Points;
  EXPECT_NEAR(GetMedianEdge(halves[0]), 0.15, 0.03);
  EXPECT_GT(GetMedianEdge(halves[1]), 0.25);
}

/** Powers of two scale all of it exactly. */
TEST(SurfaceRemesher, DoesNotDependOnTheScale)
{
  std::mt19937 generator(4);
  const TriangleMesh surface = MakeBumpySphere(12, 0.01, generator);
  const SurfaceRemesherOutput first = Remesh(surface, 0.3, 0.03);
  for (const int exponent : { -30, 0, 30 })
  {
    const double scale = std::ldexp(1.0, exponent);
    TriangleMesh scaled = surface;
    for (Vec3& p : scaled.Points)
    {
      p = scale * p;
    }
    const SurfaceRemesherOutput output = Remesh(scaled, scale * 0.3, scale * 0.03);
    EXPECT_EQ(output.Surface.Triangles, first.Surface.Triangles);
    ASSERT_EQ(output.Surface.Points.size(), first.Surface.Points.size());
    for (std::size_t i = 0; i < first.Surface.Points.size(); ++i)
    {
      EXPECT_EQ(output.Surface.Points[i], scale * first.Surface.Points[i]);
    }
  }
}

TEST(SurfaceRemesher, IsTheSameForAnyNumberOfThreads)
{
  std::mt19937 generator(3);
  const TriangleMesh bumpy = MakeBumpySphere(12, 0.01, generator);
  const TriangleMesh plane = MakeTwoRegions(4, 0.0);
  for (const TriangleMesh* surface : { &bumpy, &plane })
  {
    const SurfaceRemesherOutput first = Remesh(*surface, 0.2, 0.02);
    for (const int threads : { 2, 5 })
    {
      const SurfaceRemesherOutput output = Remesh(*surface, 0.2, 0.02, {}, threads);
      EXPECT_EQ(output.Surface.Points, first.Surface.Points);
      EXPECT_EQ(output.Surface.Triangles, first.Surface.Triangles);
      EXPECT_EQ(output.Surface.SourceCells, first.Surface.SourceCells);
    }
  }
}

TEST(SurfaceRemesher, KeepsRandomSurfaces)
{
  for (unsigned seed = 0; seed < 8; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    TriangleMesh surface = MakeBumpySphere(10, 0.03 * uniform(generator), generator);
    const double scale = std::pow(10.0, -9.0 + 18.0 * uniform(generator));
    const Vec3 shift{ 10.0 * uniform(generator), -10.0 * uniform(generator), 0.0 };
    for (Vec3& p : surface.Points)
    {
      p = scale * (p + shift);
    }
    const double length = scale * (0.2 + uniform(generator));
    const double deviation = length * (0.01 + 0.2 * uniform(generator));
    Check(surface, Remesh(surface, length, deviation), deviation);
  }
}

TEST(SurfaceRemesher, SaysWhatIsWrong)
{
  const TriangleMesh surface = MakeTwoRegions(4, 0.0);
  SurfaceRemesherInput input;
  input.Surface = &surface;
  SurfaceRemesherOutput output;
  EXPECT_EQ(RemeshSurface(input, {}, {}, output).Code, StatusCode::InvalidOption);
  SurfaceRemesherOptions options;
  options.EdgeLength = 1.0;
  options.MaximumDeviation = 0.1;
  const ExecutionContext aborted({}, [] { return true; });
  EXPECT_TRUE(RemeshSurface(input, options, aborted, output).IsAborted());
  EXPECT_TRUE(output.Surface.Triangles.empty());
}
} // namespace
