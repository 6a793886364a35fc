// SPDX-License-Identifier: BSD-3-Clause
// Plane facets whose points were rounded in a file, and curved facets that bend as little.
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Meshes/SurfacePolygons.h"
#include "Core/Pipeline/ConformingMesher.h"
#include "Core/Pipeline/RegionVolumes.h"
#include "Core/Surface/FlatFacets.h"
#include "Core/Surface/StructuralEdges.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
/** A box of 3 x 2 x 1 with n x n rectangles of two triangles on each side, moved within sides. */
TriangleMesh MakeBox(int n, std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  TriangleMesh box;
  std::map<std::array<int, 3>, Id> ids;
  const auto getPoint = [&](const std::array<int, 3>& place, int fixed)
  {
    const auto [found, isNew] = ids.try_emplace(place, static_cast<Id>(box.Points.size()));
    if (isNew)
    {
      Vec3 point;
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool isInside = place[(fixed + 1) % 3] % n != 0 && place[(fixed + 2) % 3] % n != 0;
        const double moved = axis != fixed && isInside ? shift(generator) : 0.0;
        point[axis] = (3.0 - axis) * (place[axis] + moved) / n;
      }
      box.Points.push_back(point);
    }
    return found->second;
  };
  for (int fixed = 0; fixed < 3; ++fixed)
  {
    for (int side : { 0, n })
    {
      for (int i = 0; i < n * n; ++i)
      {
        std::array<Id, 4> corners{};
        for (int corner = 0; corner < 4; ++corner)
        {
          std::array<int, 3> place{};
          place[fixed] = side;
          place[(fixed + 1) % 3] = i % n + (corner == 1 || corner == 2 ? 1 : 0);
          place[(fixed + 2) % 3] = i / n + corner / 2;
          corners[corner] = getPoint(place, fixed);
        }
        const auto [a, b, c, d] = corners;
        box.Triangles.push_back(side == 0 ? TriangleIds{ a, c, b } : TriangleIds{ a, b, c });
        box.Triangles.push_back(side == 0 ? TriangleIds{ a, d, c } : TriangleIds{ a, c, d });
      }
    }
  }
  return box;
}

void RoundPointsToDigits(TriangleMesh& surface, double unit)
{
  for (Vec3& point : surface.Points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] = unit * std::round(point[axis] / unit);
    }
  }
}

std::vector<StructuralEdge> Extract(
  const TriangleMesh& surface, const StructuralEdgeOptions& options = {})
{
  StructuralEdgesOutput output;
  const Status status = ExtractStructuralEdges(surface, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output.Edges;
}

std::vector<Id> GetFacets(const TriangleMesh& surface)
{
  return NumberFacets(SortEdgeUses(surface.Triangles, surface.Points.size()), Extract(surface));
}

Id CountFacets(const TriangleMesh& surface)
{
  const std::vector<Id> facets = GetFacets(surface);
  return *std::max_element(facets.begin(), facets.end()) + 1;
}

/** The mesh of a surface all triangles of which stay, without any size. */
ConformingMesherOutput Mesh(const TriangleMesh& surface, ConformingMesherOptions options)
{
  PolygonSoup soup = MakePolygonSoup(surface);
  soup.Labels.clear();
  ConformingMesherInput input;
  input.Polygons = &soup;
  options.Choices.MaximumEdgeLength = 0.0;
  options.MaximumDeviation = 0.0;
  ConformingMesherOutput output;
  const Status status = MeshPolygons(input, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}

/** A ball of triangles that bend by about 180 / n degrees. */
TriangleMesh MakeBall(int n, double radius)
{
  TriangleMesh ball;
  const double pi = std::acos(-1.0);
  for (int i = 1; i < n; ++i)
  {
    for (int j = 0; j < 2 * n; ++j)
    {
      const double sine = std::sin(i * pi / n);
      ball.Points.push_back({ radius * sine * std::cos(j * pi / n),
        radius * sine * std::sin(j * pi / n), radius * std::cos(i * pi / n) });
    }
  }
  const Id top = static_cast<Id>(ball.Points.size());
  ball.Points.push_back({ 0.0, 0.0, radius });
  ball.Points.push_back({ 0.0, 0.0, -radius });
  for (int i = 1; i < n; ++i)
  {
    for (int j = 0; j < 2 * n; ++j)
    {
      const int next = (j + 1) % (2 * n);
      const auto get = [n](int row, int column) { return (row - 1) * 2 * n + column; };
      if (i == 1)
      {
        ball.Triangles.push_back({ top, get(1, j), get(1, next) });
      }
      if (i + 1 == n)
      {
        ball.Triangles.push_back({ top + 1, get(i, next), get(i, j) });
        continue;
      }
      ball.Triangles.push_back({ get(i, j), get(i + 1, j), get(i + 1, next) });
      ball.Triangles.push_back({ get(i, j), get(i + 1, next), get(i, next) });
    }
  }
  return ball;
}
} // namespace

TEST(FlatFacets, RoundedBoxesHaveSixFacets)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    TriangleMesh box = MakeBox(8, generator);
    Rotate(box.Points, MakeRandomDirection(generator), 0.1 * seed);
    RoundToSinglePrecision(box.Points);
    // Which way triangles look does not matter.
    for (TriangleIds& ids : box.Triangles)
    {
      if (generator() % 2 == 0)
      {
        std::swap(ids[0], ids[1]);
      }
    }
    EXPECT_EQ(CountFacets(box), 6);
    StructuralEdgeOptions strict;
    strict.FlatnessRatio = RoundedFlatnessRatio;
    EXPECT_GT(Extract(box, strict).size(), 4 * Extract(box).size());
  }
}

/**
 * A strip between two rows of points that are off by a third of the tolerance, as six digits leave them. The
 * plane of a narrow triangle leaves the next one's points by more than the tolerance.
 */
TEST(FlatFacets, ARoundedStripIsOneFacet)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> place(0.1, 0.9);
    TriangleMesh strip;
    for (Id i = 0; i < 100; ++i)
    {
      strip.Points.push_back({ 0.03 * (i + place(generator)), i % 2 == 0 ? 0.0 : 0.02, 0.0 });
      if (i >= 2)
      {
        strip.Triangles.push_back({ i - 2, i - 1, i });
      }
    }
    Rotate(strip.Points, MakeRandomDirection(generator), 0.1 * seed);
    RoundPointsToDigits(strip, 1e-6);
    EXPECT_EQ(CountFacets(strip), 1);
  }
}

TEST(FlatFacets, ACurvedFacetIsNotPlaneHoweverLittleItBends)
{
  // Beside a point far away each edge of the ball bends by less than the tolerance.
  for (const double radius : { 1e-2, 1e-3, 1e-4 })
  {
    SCOPED_TRACE(radius);
    TriangleMesh ball = MakeBall(200, radius);
    const Id triangles = static_cast<Id>(ball.Triangles.size());
    ball.Points.insert(ball.Points.end(), { { 10, 0, 0 }, { 10, 1, 0 }, { 10, 0, 1 } });
    const Id last = static_cast<Id>(ball.Points.size()) - 1;
    ball.Triangles.push_back({ last - 2, last - 1, last });
    const double tolerance = GetFlatness(StructuralEdgeOptions().FlatnessRatio, ball.Points);
    const std::vector<Id> facets = GetFacets(ball);
    std::map<Id, std::vector<Id>> members;
    for (Id t = 0; t < triangles; ++t)
    {
      members[facets[t]].push_back(t);
    }
    for (const auto& [facet, list] : members)
    {
      Vec3 normal;
      for (Id t : list)
      {
        const TriangleIds& ids = ball.Triangles[t];
        normal = normal +
          Cross(
            ball.Points[ids[1]] - ball.Points[ids[0]], ball.Points[ids[2]] - ball.Points[ids[0]]);
      }
      double lowest = 1.0;
      double highest = -1.0;
      for (Id t : list)
      {
        for (Id id : ball.Triangles[t])
        {
          const double height = Dot(ball.Points[id], normal) / Norm(normal);
          lowest = std::min(lowest, height);
          highest = std::max(highest, height);
        }
      }
      EXPECT_LE(highest - lowest, 2.0 * tolerance * (1.0 + 1e-9)) << facet;
    }
    EXPECT_GT(members.size(), 50u);
  }
}

TEST(FlatFacets, LowStepsStay)
{
  // A step as high as a tenth of the tolerance, between two wide sheets.
  TriangleMesh step;
  const double height = 1e-7;
  for (const double y : { 0.0, 1.0 })
  {
    step.Points.insert(step.Points.end(),
      { { 0.0, y, 0.0 }, { 0.5, y, 0.0 }, { 0.5, y, height }, { 1.0, y, height } });
  }
  for (Id i = 0; i < 3; ++i)
  {
    step.Triangles.push_back({ i, i + 1, i + 5 });
    step.Triangles.push_back({ i, i + 5, i + 4 });
  }
  EXPECT_EQ(CountFacets(step), 3);
}

TEST(FlatFacets, ExactTrianglesKeepTheirEdges)
{
  std::mt19937_64 generator(3);
  TriangleMesh box = MakeBox(4, generator);
  Rotate(box.Points, MakeRandomDirection(generator), 1.0);
  RoundToSinglePrecision(box.Points);
  StructuralEdgeOptions options;
  options.IsExact.assign(box.Triangles.size(), 1);
  StructuralEdgeOptions strict;
  strict.FlatnessRatio = ExactFlatnessRatio;
  EXPECT_EQ(Extract(box, options).size(), Extract(box, strict).size());
}

/** A refined surface has the facets of the surface before, and so have later ones. */
TEST(FlatFacets, StayWhenTheSurfaceIsRefined)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    TriangleMesh box = MakeBox(6, generator);
    Rotate(box.Points, MakeRandomDirection(generator), 0.2 * seed);
    RoundToSinglePrecision(box.Points);
    const std::vector<Id> facets = GetFacets(box);
    DelaunaySurfaceRefinerInput input;
    input.Surface = &box;
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = SurfaceCriterion::SmallestSphere;
    options.MaximumEdgeLength = 0.1;
    DelaunaySurfaceRefinerOutput refined;
    ASSERT_TRUE(RefineDelaunaySurface(input, options, {}, refined).IsOk());
    EXPECT_GT(refined.Surface.Triangles.size(), 4 * box.Triangles.size());
    EXPECT_EQ(CountFacets(refined.Surface), 6);
    StructuralEdgeOptions known;
    for (Id source : refined.Surface.SourceCells)
    {
      known.Facets.push_back(facets[source]);
    }
    const std::vector<StructuralEdge> edges = Extract(refined.Surface, known);
    ASSERT_EQ(edges.size(), refined.StructuralEdges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      EXPECT_EQ(edges[e].Points, refined.StructuralEdges[e].Points);
    }
  }
}

/**
 * A square 200 million times its size away from the origin, refined by a point on one side. Rounding has
 * lifted that by one unit in the last place, so that one triangle is upright. Its facet is known.
 */
TEST(FlatFacets, RoundingMayTurnTrianglesOfKnownFacets)
{
  const double unit = std::ldexp(1.0, -25);
  const double place = 2e8;
  TriangleMesh square;
  square.Points = { { place, place, place }, { place + 1.0, place, place },
    { place + 1.0, place + 1.0, place }, { place, place + 1.0, place },
    { place + 0.5, place, place + unit } };
  square.Triangles = { { 0, 1, 4 }, { 0, 4, 3 }, { 4, 1, 2 }, { 4, 2, 3 } };
  EXPECT_EQ(GetAreaVector(square, square.Triangles[0]).Z, 0.0);
  StructuralEdgeOptions known;
  known.Facets.assign(square.Triangles.size(), 0);
  EXPECT_EQ(Extract(square, known).size(), 4u);
}

/** What rounding costs: no sliver, and few more tetrahedra than the box has as it was drawn. */
TEST(FlatFacets, RoundedBoxesAreMeshedLikeThePlaneOnes)
{
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    TriangleMesh box = MakeBox(6, generator);
    std::array<std::size_t, 3> counts{};
    for (std::size_t i = 0; i < counts.size(); ++i)
    {
      if (i == 1)
      {
        Rotate(box.Points, MakeRandomDirection(generator), 0.3 * seed);
        RoundToSinglePrecision(box.Points);
      }
      if (i == 2)
      {
        RoundPointsToDigits(box, 2e-6);
      }
      ConformingMesherOptions options;
      options.Choices.Criterion = SurfaceCriterion::SmallestSphere;
      options.Choices.AddsSteinerPoints = true;
      const ConformingMesherOutput output = Mesh(box, options);
      counts[i] = output.Mesh.Tetrahedra.size();
      EXPECT_TRUE(output.Warnings.empty()) << output.Warnings.front().Message;
    }
    EXPECT_LT(counts[1], 1.3 * counts[0]);
    EXPECT_LT(counts[2], 1.3 * counts[0]);
  }
}

/** The lid of a box is plane to the tolerance, but not to a small part of the volume. */
TEST(FlatFacets, VolumesOfThinRegionsStay)
{
  for (const double height : { 1e-3, 1.0 })
  {
    SCOPED_TRACE(height);
    std::mt19937_64 generator(7);
    std::uniform_real_distribution<double> shift(-5e-7, 5e-7);
    TriangleMesh box = MakeBox(6, generator);
    double volume = 0.0;
    for (Vec3& point : box.Points)
    {
      point.Z = height * point.Z + (point.Z == 1.0 ? shift(generator) : 0.0);
    }
    for (const TriangleIds& ids : box.Triangles)
    {
      volume += Dot(box.Points[ids[0]], Cross(box.Points[ids[1]], box.Points[ids[2]])) / 6.0;
    }
    ConformingMesherOptions options;
    options.Choices.Criterion = SurfaceCriterion::Delaunay;
    options.Choices.AddsSteinerPoints = false;
    const ConformingMesherOutput output = Mesh(box, options);
    double meshed = 0.0;
    for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
    {
      const std::vector<Vec3>& points = output.Mesh.Points;
      meshed += GetSignedVolume(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]]);
    }
    EXPECT_NEAR(meshed, std::abs(volume), 5.1e-7 * std::abs(volume));
  }
}

/** The convex hull, which closes the mesh of an open surface, comes from no triangle of it. */
TEST(FlatFacets, OpenRoundedSurfacesAreClosed)
{
  std::mt19937_64 generator(5);
  TriangleMesh box = MakeBox(6, generator);
  Rotate(box.Points, MakeRandomDirection(generator), 0.7);
  RoundToSinglePrecision(box.Points);
  box.Triangles.pop_back();
  ConformingMesherOptions options;
  options.Choices.Criterion = SurfaceCriterion::Delaunay;
  options.Choices.AddsSteinerPoints = false;
  options.CloseOpenBoundary = true;
  const ConformingMesherOutput output = Mesh(box, options);
  EXPECT_FALSE(output.Mesh.Tetrahedra.empty());
  EXPECT_EQ(output.Certificate.GetCount(MeshFault::NonDelaunayFacet), 0);
  const std::vector<Id>& sources = output.Boundary.SourceCells;
  EXPECT_GT(std::count(sources.begin(), sources.end(), NoId), 0);
}

TEST(FlatFacets, RegionsWhoseVolumeHasChangedAreFound)
{
  // Two boxes; the second one's lid has another diagonal, and one corner is higher.
  TriangleMesh before;
  TriangleMesh after;
  for (int box = 0; box < 2; ++box)
  {
    const Id first = 8 * box;
    for (int i = 0; i < 8; ++i)
    {
      before.Points.push_back(
        { 2.0 * box + (i & 1), double((i >> 1) & 1), (i >> 2) + (i == 7 ? 0.003 : 0.0) });
    }
    for (const TriangleIds& ids :
      std::vector<TriangleIds>{ { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 },
        { 0, 5, 4 }, { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } })
    {
      before.Triangles.push_back({ first + ids[0], first + ids[1], first + ids[2] });
      after.Labels.push_back({ OutsideRegion, 5 + box });
      after.SourceCells.push_back(static_cast<Id>(after.SourceCells.size()));
    }
  }
  after.Points = before.Points;
  after.Triangles = before.Triangles;
  after.Triangles[14] = { 12, 13, 14 };
  after.Triangles[15] = { 13, 15, 14 };
  // The tetrahedron between the diagonals has the volume 0.003 / 6.
  EXPECT_TRUE(FindChangedRegions(before, after, 0.0006).empty());
  std::vector<Id> changed(12);
  std::iota(changed.begin(), changed.end(), Id(12));
  EXPECT_EQ(FindChangedRegions(before, after, 0.0004), changed);
  // Triangles of the surface before may look to any side.
  for (TriangleIds& ids : before.Triangles)
  {
    std::swap(ids[0], ids[1]);
  }
  EXPECT_EQ(FindChangedRegions(before, after, 0.0004), changed);
  // What closes an open surface comes from no triangle of it, and its volume counts before, too.
  for (const bool isChanged : { false, true })
  {
    TriangleMesh closed = after;
    const std::size_t missing = isChanged ? 23 : 11;
    closed.SourceCells[missing] = NoId;
    EXPECT_FALSE(FindChangedRegions(before, closed, 0.0004).empty());
    EXPECT_TRUE(FindChangedRegions(before, closed, 0.0006).empty()) << missing;
  }
}
