// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Measures.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "LayerSurfaces.h"
#include "RandomComplexes.h"
#include "SurfaceAngles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;

TriangleMesh Triangulate(const PolygonSoup& soup)
{
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output.Surface;
}

DelaunaySurfaceRefinerOutput Refine(const TriangleMesh& surface,
  const DelaunaySurfaceRefinerOptions& options = {}, const std::vector<Vec3>& meshPoints = {})
{
  DelaunaySurfaceRefinerInput input;
  input.Surface = &surface;
  input.MeshPoints = &meshPoints;
  DelaunaySurfaceRefinerOutput output;
  const Status status = RefineDelaunaySurface(input, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  EXPECT_TRUE(output.UnresolvedTriangles.empty());
  return output;
}

/** Meshes a refined surface and lets the checker judge it. */
MeshCertificate MeshAndCheck(const DelaunaySurfaceRefinerOutput& refined,
  const std::vector<Vec3>& meshPoints = {}, double volumeTolerance = 1e-10)
{
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &refined.Surface;
  input.MeshPoints = &meshPoints;
  AdvancingFrontTetrahedralizerOutput output;
  const Status status = TetrahedralizeByAdvancingFront(input, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  MeshCertificate report;
  EXPECT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, report).IsOk());
  EXPECT_TRUE(report.IsDelaunay(volumeTolerance)) << report.GetText();
  return report;
}

double GetShortestEdge(const TriangleMesh& surface)
{
  double shortest = Infinity;
  for (const TriangleIds& ids : surface.Triangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      shortest =
        std::min(shortest, Distance(surface.Points[ids[i]], surface.Points[ids[(i + 1) % 3]]));
    }
  }
  return shortest;
}

PolygonSoup MakeBox(const Vec3& size)
{
  return CellComplex(size).GetSoup();
}

/** A box with a plane through it for each height: layers along z. */
PolygonSoup MakeLayers(const std::vector<double>& heights, double angle = 0.0)
{
  CellComplex complex({ 1.0, 1.0, 1.0 });
  for (double height : heights)
  {
    EXPECT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, height, 1e-6));
  }
  PolygonSoup soup = complex.GetSoup();
  if (angle != 0.0)
  {
    Rotate(soup.Points, (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 }, angle);
  }
  return soup;
}

/**
 * A round plate of thickness 1 with a hole of radius 1, whose axis leans by so much. Both have so many
 * sides, turned by a part of one.
 */
TriangleMesh MakePlateWithObliqueHole(Id sides, double lean, double turn)
{
  TriangleMesh plate;
  for (const double radius : { 1.0, 4.0 })
  {
    for (const double z : { 0.0, 1.0 })
    {
      for (Id i = 0; i < sides; ++i)
      {
        const double angle =
          2.0 * Pi * (static_cast<double>(i) + turn) / static_cast<double>(sides);
        const double shift = radius == 1.0 ? lean * z : 0.0;
        plate.Points.push_back({ radius * std::cos(angle) + shift, radius * std::sin(angle), z });
      }
    }
  }
  // The rings: hole below and above, rim below and above.
  for (Id i = 0; i < sides; ++i)
  {
    const Id j = (i + 1) % sides;
    AddQuadrangle(plate, i, j, 2 * sides + j, 2 * sides + i);
    AddQuadrangle(plate, sides + i, 3 * sides + i, 3 * sides + j, sides + j);
    AddQuadrangle(plate, 2 * sides + i, 2 * sides + j, 3 * sides + j, 3 * sides + i);
    AddQuadrangle(plate, i, sides + i, sides + j, j);
  }
  plate.Labels.clear();
  return plate;
}

/** A torus around the z axis: so many prisms of so many corners, 1 and the radius wide. */
TriangleMesh MakeRing(Id sides, Id corners, double radius)
{
  TriangleMesh ring;
  for (Id i = 0; i < sides; ++i)
  {
    const double around = 2.0 * Pi * static_cast<double>(i) / static_cast<double>(sides);
    for (Id j = 0; j < corners; ++j)
    {
      const double angle = 2.0 * Pi * (static_cast<double>(j) + 0.5) / static_cast<double>(corners);
      const double distance = 1.0 + radius * std::cos(angle);
      ring.Points.push_back(
        { distance * std::cos(around), distance * std::sin(around), radius * std::sin(angle) });
      const Id next = (i + 1) % sides * corners;
      const Id above = (j + 1) % corners;
      AddQuadrangle(ring, i * corners + j, next + j, next + above, i * corners + above);
    }
  }
  ring.Labels.clear();
  return ring;
}

/** Prism over a triangle whose angle at the first edge is given in degrees. */
PolygonSoup MakeWedge(double degrees, double height)
{
  const double angle = degrees * Pi / 180.0;
  PolygonSoup soup;
  for (double z : { 0.0, height })
  {
    soup.Points.push_back({ 0.0, 0.0, z });
    soup.Points.push_back({ 1.0, 0.0, z });
    soup.Points.push_back({ std::cos(angle), std::sin(angle), z });
  }
  soup.Connectivity = { 0, 2, 1, 3, 4, 5, 0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5 };
  soup.Offsets = { 0, 3, 6, 10, 14, 18 };
  return soup;
}

double GetLongestEdge(const TriangleMesh& surface)
{
  double longest = 0.0;
  for (const TriangleIds& ids : surface.Triangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      longest =
        std::max(longest, Distance(surface.Points[ids[i]], surface.Points[ids[(i + 1) % 3]]));
    }
  }
  return longest;
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
} // namespace

TEST(DelaunaySurfaceRefiner, LeavesADelaunaySurfaceAlone)
{
  const TriangleMesh box = Triangulate(MakeBox({ 1.0, 1.0, 1.0 }));
  const DelaunaySurfaceRefinerOutput refined = Refine(box);
  EXPECT_EQ(refined.Surface.Triangles, box.Triangles);
  EXPECT_EQ(refined.Surface.Points, box.Points);
  EXPECT_EQ(refined.Surface.Labels, box.Labels);
  EXPECT_EQ(refined.StructuralEdges.size(), 12u);
  MeshAndCheck(refined);
}

TEST(DelaunaySurfaceRefiner, KeepsInputPointsAndExplainsNewOnes)
{
  DelaunaySurfaceRefinerOptions options;
  options.MaximumEdgeLength = 0.3;
  const TriangleMesh box = Triangulate(MakeBox({ 2.0, 1.0, 1.0 }));
  const DelaunaySurfaceRefinerOutput refined = Refine(box, options);
  ASSERT_EQ(refined.Surface.Points.size(), box.Points.size() + refined.NewPoints.size());
  EXPECT_TRUE(std::equal(box.Points.begin(), box.Points.end(), refined.Surface.Points.begin()));
  for (std::size_t i = 0; i < refined.NewPoints.size(); ++i)
  {
    const Id id = static_cast<Id>(box.Points.size() + i);
    Vec3 sum;
    for (int k = 0; k < 3; ++k)
    {
      const Id parent = refined.NewPoints[i].Ids[k];
      ASSERT_LT(parent, id);
      sum = parent == NoId ? sum
                           : sum + refined.NewPoints[i].Weights[k] * refined.Surface.Points[parent];
    }
    EXPECT_LT(Distance(sum, refined.Surface.Points[id]), 1e-14);
  }
  for (std::size_t t = 0; t < refined.Surface.Triangles.size(); ++t)
  {
    const Id source = refined.Surface.SourceCells[t];
    ASSERT_GE(source, 0);
    EXPECT_EQ(refined.Surface.Labels[t], box.Labels[source]);
  }
  EXPECT_LE(GetLongestEdge(refined.Surface), 0.3);
  EXPECT_NEAR(GetArea(refined.Surface), 10.0, 1e-12);
  MeshAndCheck(refined, {}, 1e-12);
}

TEST(DelaunaySurfaceRefiner, HonoursAreaAngleAndSizing)
{
  const TriangleMesh box = Triangulate(MakeBox({ 1.0, 1.0, 1.0 }));
  DelaunaySurfaceRefinerOptions options;
  options.MaximumArea = 0.01;
  options.MinimumAngle = 20.0;
  DelaunaySurfaceRefinerOutput refined = Refine(box, options);
  for (const TriangleIds& ids : refined.Surface.Triangles)
  {
    const std::vector<Vec3>& points = refined.Surface.Points;
    EXPECT_LE(GetTriangleArea(points[ids[0]], points[ids[1]], points[ids[2]]), 0.01);
  }
  EXPECT_GE(testing_core::GetSmallestAngle(refined.Surface), 20.0);
  MeshAndCheck(refined);

  DelaunaySurfaceRefinerInput input;
  input.Surface = &box;
  input.Sizing = [](const Vec3& p) { return 0.05 + 0.4 * p.X; };
  ASSERT_TRUE(RefineDelaunaySurface(input, {}, {}, refined).IsOk());
  for (const TriangleIds& ids : refined.Surface.Triangles)
  {
    const Vec3 center = (1.0 / 3.0) *
      (refined.Surface.Points[ids[0]] + refined.Surface.Points[ids[1]] +
        refined.Surface.Points[ids[2]]);
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_LE(Distance(refined.Surface.Points[ids[i]], refined.Surface.Points[ids[(i + 1) % 3]]),
        input.Sizing(center).GetLargest() * (1.0 + 1e-12));
    }
  }
  MeshAndCheck(refined);
}

TEST(DelaunaySurfaceRefiner, ExcusedTrianglesMayBeNarrow)
{
  const TriangleMesh bar = Triangulate(MakeBox({ 9.0, 1.0, 1.0 }));
  DelaunaySurfaceRefinerInput input;
  input.Surface = &bar;
  DelaunaySurfaceRefinerOptions options;
  options.MinimumAngle = 20.0;
  DelaunaySurfaceRefinerOutput refined;
  ASSERT_TRUE(RefineDelaunaySurface(input, options, {}, refined).IsOk());
  EXPECT_GE(testing_core::GetSmallestAngle(refined.Surface), 20.0);
  EXPECT_FALSE(refined.NewPoints.empty());

  input.ExcusedTriangles.assign(bar.Triangles.size(), 1);
  ASSERT_TRUE(RefineDelaunaySurface(input, options, {}, refined).IsOk());
  EXPECT_TRUE(refined.NewPoints.empty());

  // All but those of one side: points at its edges are all that it gets.
  const double top = 1.0;
  for (std::size_t t = 0; t < bar.Triangles.size(); ++t)
  {
    const TriangleIds& ids = bar.Triangles[t];
    input.ExcusedTriangles[t] =
      std::all_of(ids.begin(), ids.end(), [&](Id id) { return bar.Points[id].Z == top; }) ? 0 : 1;
  }
  ASSERT_TRUE(RefineDelaunaySurface(input, options, {}, refined).IsOk());
  TriangleMesh side = refined.Surface;
  side.Triangles.erase(std::remove_if(side.Triangles.begin(), side.Triangles.end(),
                         [&](const TriangleIds& ids) {
                           return !std::all_of(ids.begin(), ids.end(),
                             [&](Id id) { return side.Points[id].Z == top; });
                         }),
    side.Triangles.end());
  EXPECT_GE(testing_core::GetSmallestAngle(side), 20.0);
  EXPECT_LT(testing_core::GetSmallestAngle(refined.Surface), 20.0);
  MeshAndCheck(refined);
}

/** What can never end is not begun: it was five minutes of work, and no mesh. */
TEST(DelaunaySurfaceRefiner, RefusesSizesThatNeedTooManyPoints)
{
  const TriangleMesh box = Triangulate(MakeBox({ 1.0, 1.0, 1.0 }));
  DelaunaySurfaceRefinerInput input;
  input.Surface = &box;
  DelaunaySurfaceRefinerOptions options;
  DelaunaySurfaceRefinerOutput output;
  for (const double length : { 1e-5, 1e-160, 1e-300 })
  {
    options.MaximumEdgeLength = length;
    const Status status = RefineDelaunaySurface(input, options, {}, output);
    EXPECT_EQ(status.Code, StatusCode::LimitReached);
    EXPECT_NE(status.Message.find("points on the surface"), std::string::npos) << status.Message;
    EXPECT_TRUE(output.Surface.Points.empty());
  }
}

/** Many more flips than the few triangles of the input have need of. */
TEST(DelaunaySurfaceRefiner, RefinesFewLargeTrianglesToManySmallOnes)
{
  DelaunaySurfaceRefinerOptions options;
  options.MaximumEdgeLength = 0.012;
  const DelaunaySurfaceRefinerOutput output =
    Refine(Triangulate(MakeLayers({ 0.3, 0.31 }, 0.4)), options);
  EXPECT_GT(output.Report.Flips, 200000);
  // Not many more than equilateral triangles with such edges would be.
  EXPECT_LT(output.Surface.Triangles.size() * std::sqrt(0.1875) * 0.012 * 0.012,
    8.0 * GetArea(output.Surface));
}

TEST(DelaunaySurfaceRefiner, KeepsMeshPointsAndDropsThoseTooClose)
{
  const TriangleMesh box = Triangulate(MakeBox({ 1.0, 1.0, 1.0 }));
  const std::vector<Vec3> meshPoints{ { 0.5, 0.5, 0.5 }, { 0.5, 0.5, 1e-5 }, { 0.0, 0.0, 0.0 },
    { 0.5, 0.5, 0.5 }, { 0.3, 0.4, 0.02 }, { std::nan(""), 0.0, 0.0 } };
  DelaunaySurfaceRefinerOptions options;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  const DelaunaySurfaceRefinerOutput refined = Refine(box, options, meshPoints);
  EXPECT_EQ(refined.KeptMeshPoints, (std::vector<Id>{ 0, 4 }));
  EXPECT_EQ(refined.Report.DroppedMeshPoints, 4);
  EXPECT_FALSE(refined.NewPoints.empty());
  const MeshCertificate report = MeshAndCheck(refined, { meshPoints[0], meshPoints[4] }, 1e-12);
  EXPECT_EQ(report.UnusedPoints, 0);
  EXPECT_EQ(report.GetCount(MeshFault::FacetSphere), 0);
}

TEST(DelaunaySurfaceRefiner, MirrorsPointsThroughThinLayers)
{
  for (double thickness : { 0.02, 0.005, 0.001, 0.0001 })
  {
    for (double angle : { 0.0, 0.6 })
    {
      DelaunaySurfaceRefinerOptions options;
      options.MaximumEdgeLength = 0.2;
      options.Criterion = SurfaceCriterion::SmallestSphere;
      const TriangleMesh layers =
        Triangulate(MakeLayers({ 0.5, 0.5 + thickness, 0.5 + 2.0 * thickness }, angle));
      const DelaunaySurfaceRefinerOutput refined = Refine(layers, options);
      // Six faces of 25 squares and three layers: the count must not know the thickness.
      EXPECT_LT(refined.NewPoints.size(), 900u) << thickness << " " << angle;
      const MeshCertificate report = MeshAndCheck(refined);
      EXPECT_EQ(report.GetCount(MeshFault::FacetSphere), 0);
    }
  }
}

/**
 * A match lies as close to its point as the sheets do, also where no edge may be that short. Matches
 * that were refused for it left the circumcenters of both sheets to go on without end.
 */
TEST(DelaunaySurfaceRefiner, MatchesAcrossGapsThinnerThanTheShortestEdge)
{
  constexpr double thickness = 1e-4;
  PolygonSoup soup = MakeBox({ 1.0, 1.0, thickness });
  TriangleMesh surface = Triangulate(soup);
  // A point in the middle of the lower side.
  const Id point = static_cast<Id>(surface.Points.size());
  const Vec3 position{ 0.3, 0.4, 0.0 };
  surface.Points.push_back(position);
  for (std::size_t t = surface.Triangles.size(); t-- > 0;)
  {
    const TriangleIds ids = surface.Triangles[t];
    const auto& p = surface.Points;
    const Vec3 weights = GetBarycentricWeights(position, p[ids[0]], p[ids[1]], p[ids[2]]);
    if (std::all_of(ids.begin(), ids.end(), [&p](Id id) { return p[id].Z == 0.0; }) &&
      std::min({ weights.X, weights.Y, weights.Z }) > 0.0)
    {
      surface.Triangles[t] = { ids[0], ids[1], point };
      surface.Triangles.push_back({ ids[1], ids[2], point });
      surface.Triangles.push_back({ ids[2], ids[0], point });
      for (int i = 0; i < 2; ++i)
      {
        surface.Labels.push_back(surface.Labels[t]);
        surface.SourceCells.push_back(surface.SourceCells[t]);
      }
    }
  }
  DelaunaySurfaceRefinerOptions options;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  options.MinimumEdgeRatio = 1e-2;
  const DelaunaySurfaceRefinerOutput output = Refine(surface, options);
  // The match, and those on edges that either of the two encroaches on.
  EXPECT_EQ(output.Surface.Points.size(), surface.Points.size() + 5);
  EXPECT_TRUE(std::any_of(output.Surface.Points.begin(), output.Surface.Points.end(),
    [](const Vec3& p) {
      return Distance(p, { 0.3, 0.4, thickness }) < 1e-12;
    }));
  EXPECT_EQ(MeshAndCheck(output).GetCount(MeshFault::FacetSphere), 0);
}

TEST(DelaunaySurfaceRefiner, EndsAtSharpAngles)
{
  for (double degrees : { 60.0, 10.0, 1.0, 0.1 })
  {
    for (SurfaceCriterion criterion : { SurfaceCriterion::Delaunay,
           SurfaceCriterion::SmallestSphere, SurfaceCriterion::SmallestSphereAndEdges })
    {
      DelaunaySurfaceRefinerOptions options;
      options.Criterion = criterion;
      options.MaximumEdgeLength = 0.25;
      const DelaunaySurfaceRefinerOutput refined =
        Refine(Triangulate(MakeWedge(degrees, 0.7)), options);
      EXPECT_LT(refined.NewPoints.size(), 500u) << degrees;
      const MeshCertificate report = MeshAndCheck(refined);
      if (criterion != SurfaceCriterion::Delaunay)
      {
        EXPECT_EQ(report.GetCount(MeshFault::FacetSphere), 0);
      }
    }
  }
}

TEST(DelaunaySurfaceRefiner, KeepsItsCountWhenTheDeviceTurns)
{
  DelaunaySurfaceRefinerOptions options;
  options.MaximumEdgeLength = 0.1;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  std::vector<double> counts;
  for (double angle : { 0.0, 0.17, 0.58, 1.34 })
  {
    const DelaunaySurfaceRefinerOutput refined =
      Refine(Triangulate(MakeLayers({ 0.5, 0.52 }, angle)), options);
    counts.push_back(static_cast<double>(refined.Surface.Points.size()));
    MeshAndCheck(refined);
  }
  for (double count : counts)
  {
    EXPECT_NEAR(count, counts.front(), 0.05 * counts.front());
  }
}

// Points of the hole's ridges have two facets, both of which share an edge with the plate's faces.
// Those were matched about the nearest line; a second match came as close as 0.009 to the first.
TEST(DelaunaySurfaceRefiner, MatchesAboutTheNearestEdge)
{
  DelaunaySurfaceRefinerOptions options;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  for (const double lean : { 0.6, 1.0 })
  {
    for (const double turn : { 0.0, 0.3 })
    {
      const TriangleMesh plate = MakePlateWithObliqueHole(30, lean, turn);
      const auto count = static_cast<Id>(plate.Points.size());
      const std::vector<Vec3> points = Refine(plate, options).Surface.Points;
      double nearest = Infinity;
      for (Id p = count; p < static_cast<Id>(points.size()); ++p)
      {
        for (Id q = 0; q < p; ++q)
        {
          const bool isInFace = points[p].Z == points[q].Z && std::abs(points[p].Z - 0.5) == 0.5;
          nearest = isInFace ? std::min(nearest, Distance(points[p], points[q])) : nearest;
        }
      }
      // Sides of the hole are 0.21 long.
      EXPECT_GT(nearest, 0.06) << lean << " " << turn;
      EXPECT_LT(nearest, Infinity) << lean << " " << turn;
    }
  }
}

// In facets of rounded points matches are not exact: the same point was matched twice, 1e-11 apart, and
// points above the ends of edges, but for rounding, were matched 1e-9 beside them.
TEST(DelaunaySurfaceRefiner, RoundedFacetsAreNotMatchedTwice)
{
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> random(0.0, 1.0);
  DelaunaySurfaceRefinerOptions options;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  for (int i = 0; i < 200; ++i)
  {
    // A ring above another one, or within it.
    const Id sides = 5 + i % 10;
    const Id corners = 4 + i % 7 % 5;
    const bool isWithin = i % 3 == 0;
    TriangleMesh rings = MakeRing(sides, corners, 0.3);
    const auto count = static_cast<Id>(rings.Points.size());
    const double radius = isWithin ? 0.15 + 0.13 * random(generator) : 0.15;
    const double height = isWithin ? 0.0 : 0.46 + 0.14 * random(generator);
    for (const Vec3& p : MakeRing(sides, corners, radius).Points)
    {
      rings.Points.push_back(p + Vec3{ 0.0, 0.0, height });
    }
    for (const TriangleIds& ids : std::vector<TriangleIds>(rings.Triangles))
    {
      rings.Triangles.push_back({ ids[0] + count, ids[1] + count, ids[2] + count });
    }
    Rotate(rings.Points, MakeRandomDirection(generator), 1.0);
    RoundToSinglePrecision(rings.Points);
    options.MaximumEdgeLength = 0.15 + 0.65 * random(generator);
    SCOPED_TRACE(std::to_string(i));
    EXPECT_GT(GetShortestEdge(Refine(rings, options).Surface), 1e-5);
  }
}

// Triangles around corners of a remeshed model, with edges of 0.03 or more. Where a point has its match
// at the end of an edge, for another reason the edge was split as far from that end as the point is from
// the edge: close to the other end, a corner, and so on with an edge of 1.6e-5 in the end.
TEST(DelaunaySurfaceRefiner, DoesNotComeEverCloserToACorner)
{
  TriangleMesh surface;
  surface.Points = { { 0.4, 0.0, -0.1 }, { 0.0, 0.0, 0.0 }, { 0.0, 0.0, -0.04 },
    { 0.01, 0.0, -0.07 }, { 0.03, 0.0, -0.1 }, { 0.05, 0.0, -0.13 }, { 0.07, 0.0, -0.16 },
    { 0.1, 0.0, -0.18 }, { -0.44, 0.0, 0.12 }, { 0.24, 0.0, -0.2 }, { 0.29, -0.02, -0.18 },
    { 0.14, -0.1, 0.19 }, { 0.14, 0.0, -0.19 }, { 0.18, 0.0, -0.21 }, { 0.2, -1.2, -0.2 },
    { 0.01, -1.46, -0.02 }, { 0.401, -0.829, 0.045 } };
  surface.Triangles = { { 11, 1, 8 }, { 10, 9, 13 }, { 5, 15, 6 }, { 7, 15, 12 }, { 10, 14, 0 },
    { 14, 10, 13 }, { 3, 15, 4 }, { 1, 15, 2 }, { 11, 16, 1 } };
  DelaunaySurfaceRefinerOptions options;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  EXPECT_GT(GetShortestEdge(Refine(surface, options).Surface), 1e-4);
}

/**
 * A point close below the top of a box. An empty sphere of the top's triangles lies above them. When
 * the box turns, rounding folds the top along its diagonal: as a valley, it left no empty sphere.
 */
TEST(DelaunaySurfaceRefiner, RoundedRectanglesNeedNoPoints)
{
  for (int degrees = 0; degrees < 90; degrees += 3)
  {
    PolygonSoup soup = MakeBox({ 1.0, 1.0, 1.0 });
    std::vector<Vec3> meshPoints{ { 0.4, 0.5, 0.95 } };
    for (std::vector<Vec3>* points : { &soup.Points, &meshPoints })
    {
      Rotate(*points, (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 }, degrees * Pi / 180.0);
    }
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = SurfaceCriterion::Delaunay;
    const auto refined = Refine(Triangulate(soup), options, meshPoints);
    EXPECT_TRUE(refined.NewPoints.empty()) << degrees << " degrees";
  }
}

TEST(DelaunaySurfaceRefiner, DoesTheSameForAnyScale)
{
  DelaunaySurfaceRefinerOptions options;
  const PolygonSoup wedge = MakeWedge(7.0, 0.3);
  const std::size_t expected = Refine(Triangulate(wedge), options).Surface.Points.size();
  for (double scale : { 0x1p-30, 0x1p+20 })
  {
    PolygonSoup scaled = wedge;
    for (Vec3& p : scaled.Points)
    {
      p = scale * p;
    }
    const DelaunaySurfaceRefinerOutput refined = Refine(Triangulate(scaled), options);
    EXPECT_EQ(refined.Surface.Points.size(), expected);
    MeshAndCheck(refined);
  }
}

/** Boxes cut by random planes, some almost parallel, in random positions: every criterion ends. */
TEST(DelaunaySurfaceRefiner, EndsOnRandomComplexes)
{
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    CellComplex complex({ 1.0, 1.0, 1.0 });
    const Vec3 common = MakeRandomDirection(generator);
    for (std::uint64_t cut = 0; cut <= seed % 6; ++cut)
    {
      Vec3 direction = MakeRandomDirection(generator);
      if (seed % 3 == 0)
      {
        direction = common + 0.02 * direction;
        direction = (1.0 / Norm(direction)) * direction;
      }
      const Vec3 inside{ uniform(generator), uniform(generator), uniform(generator) };
      complex.Cut(direction, Dot(direction, inside), 1e-4);
    }
    PolygonSoup soup = complex.GetSoup();
    Rotate(soup.Points, MakeRandomDirection(generator), uniform(generator));
    const TriangleMesh surface = Triangulate(soup);
    for (SurfaceCriterion criterion : { SurfaceCriterion::Delaunay,
           SurfaceCriterion::SmallestSphere, SurfaceCriterion::SmallestSphereAndEdges })
    {
      DelaunaySurfaceRefinerOptions options;
      options.Criterion = criterion;
      options.MaximumNewPoints = 20000;
      const MeshCertificate report = MeshAndCheck(Refine(surface, options));
      if (criterion != SurfaceCriterion::Delaunay)
      {
        EXPECT_EQ(report.GetCount(MeshFault::FacetSphere), 0);
      }
    }
  }
}

/**
 * Two tetrahedra that share an edge. Points in facets that were answered by their feet on edges,
 * and these by points as far from the corner, went around the corner (4, 3, 3) for ever.
 */
TEST(DelaunaySurfaceRefiner, EndsWhereTetrahedraShareAnEdge)
{
  TriangleMesh surface;
  surface.Points = { { 0, 0, 3 }, { 3, 0, 2 }, { 3, 3, 2 }, { 4, 3, 3 }, { 5, 2, 1 }, { 5, 2, 3 } };
  surface.Triangles = { { 2, 4, 3 }, { 3, 0, 1 }, { 5, 3, 4 }, { 2, 5, 4 }, { 5, 3, 2 },
    { 5, 3, 1 }, { 5, 0, 1 }, { 5, 3, 0 } };
  const RegionPair outward{ OutsideRegion, 0 };
  const RegionPair inward{ 0, OutsideRegion };
  surface.Labels = { inward, inward, inward, inward, outward, inward, outward, outward };
  for (SurfaceCriterion criterion : { SurfaceCriterion::Delaunay, SurfaceCriterion::SmallestSphere,
         SurfaceCriterion::SmallestSphereAndEdges })
  {
    SCOPED_TRACE(static_cast<int>(criterion));
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = criterion;
    const DelaunaySurfaceRefinerOutput refined = Refine(surface, options);
    MeshAndCheck(refined);
    EXPECT_LT(refined.NewPoints.size(), 100u);
  }
}

TEST(DelaunaySurfaceRefiner, IsDeterministic)
{
  DelaunaySurfaceRefinerOptions options;
  options.MaximumEdgeLength = 0.2;
  const TriangleMesh surface = Triangulate(MakeLayers({ 0.3, 0.31 }, 0.4));
  const DelaunaySurfaceRefinerOutput first = Refine(surface, options);
  const DelaunaySurfaceRefinerOutput second = Refine(surface, options);
  EXPECT_EQ(first.Surface.Points, second.Surface.Points);
  EXPECT_EQ(first.Surface.Triangles, second.Surface.Triangles);
}

TEST(DelaunaySurfaceRefiner, NamesWhatIsWrong)
{
  DelaunaySurfaceRefinerInput input;
  DelaunaySurfaceRefinerOutput output;
  TriangleMesh surface;
  input.Surface = &surface;
  EXPECT_EQ(RefineDelaunaySurface(input, {}, {}, output).Code, StatusCode::InvalidInput);

  surface.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 } };
  surface.Triangles = { { 0, 1, 2 }, { 0, 1, 3 } };
  Status status = RefineDelaunaySurface(input, {}, {}, output);
  EXPECT_EQ(status.Cells, (std::vector<Id>{ 1 }));
  EXPECT_TRUE(output.Surface.Triangles.empty());

  surface.Points[3] = { 0, 1, 0 };
  status = RefineDelaunaySurface(input, {}, {}, output);
  EXPECT_EQ(status.Points, (std::vector<Id>{ 2, 3 }));

  surface.Points[3].Y = std::nan("");
  status = RefineDelaunaySurface(input, {}, {}, output);
  EXPECT_EQ(status.Points, (std::vector<Id>{ 3 }));
}

TEST(DelaunaySurfaceRefiner, StopsAtItsLimitAndSaysSo)
{
  DelaunaySurfaceRefinerOptions options;
  options.MaximumNewPoints = 3;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  CellComplex complex({ 1.0, 1.0, 1.0 });
  ASSERT_TRUE(complex.Cut({ 0.36, 0.48, 0.8 }, 0.9, 1e-4));
  ASSERT_TRUE(complex.Cut({ 0.6, 0.0, 0.8 }, 0.72, 1e-4));
  const TriangleMesh surface = Triangulate(complex.GetSoup());
  DelaunaySurfaceRefinerInput input;
  input.Surface = &surface;
  DelaunaySurfaceRefinerOutput output;
  ASSERT_TRUE(RefineDelaunaySurface(input, options, {}, output).IsOk());
  EXPECT_FALSE(output.UnresolvedTriangles.empty());
  // By the criterion Delaunay it can be meshed all the same.
  EXPECT_TRUE(output.NonDelaunayTriangles.empty());
  EXPECT_FALSE(output.WeakTriangles.empty());
  MeshAndCheck(output);
  DelaunaySurfaceRefinerOptions weaker;
  EXPECT_EQ(output.NewPoints.size(), Refine(surface, weaker).NewPoints.size());
}

TEST(DelaunaySurfaceRefiner, ReportsProgressAndAborts)
{
  DelaunaySurfaceRefinerOptions options;
  options.MaximumEdgeLength = 0.02;
  const TriangleMesh surface = Triangulate(MakeBox({ 1.0, 1.0, 1.0 }));
  DelaunaySurfaceRefinerInput input;
  input.Surface = &surface;
  DelaunaySurfaceRefinerOutput output;
  double last = 0.0;
  const ExecutionContext context(
    [&last](double fraction, const char*) { last = fraction; }, [&last]() { return last > 0.5; });
  EXPECT_TRUE(RefineDelaunaySurface(input, options, context, output).IsAborted());
  EXPECT_GT(last, 0.5);
  EXPECT_TRUE(output.Surface.Triangles.empty());
}
