// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/BoundaryTriangulator.h"

#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/TriangleIntersection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

using namespace cdm;

namespace
{
PolygonSoup MakeSoup(const std::vector<Vec3>& points, const std::vector<std::vector<Id>>& polygons,
  const std::vector<RegionPair>& labels = {})
{
  PolygonSoup soup;
  soup.Points = points;
  for (const std::vector<Id>& polygon : polygons)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), polygon.begin(), polygon.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  soup.Labels = labels;
  return soup;
}

std::vector<Vec3> MakeCubePoints()
{
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.push_back({ double(i & 1), double(i >> 1 & 1), double(i >> 2) });
  }
  return points;
}

/** Normals point outwards. */
const std::vector<std::vector<Id>> CubeFaces{ { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
  { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };

/** The invariants of TriangleMesh.h. */
void ExpectInvariants(const BoundaryTriangulatorOutput& output, const PolygonSoup& input)
{
  const TriangleMesh& surface = output.Surface;
  EXPECT_EQ(
    surface.Points.size(), std::set<Vec3>(surface.Points.begin(), surface.Points.end()).size());
  ASSERT_EQ(surface.Points.size(), output.PointSources.size());
  for (std::size_t i = 0; i < surface.Points.size(); ++i)
  {
    EXPECT_EQ(input.Points[output.PointSources[i]], surface.Points[i]);
    EXPECT_TRUE(i == 0 || output.PointSources[i - 1] < output.PointSources[i]);
  }
  ASSERT_EQ(surface.Triangles.size(), surface.SourceCells.size());
  ASSERT_EQ(input.Labels.empty() ? 0u : surface.Triangles.size(), surface.Labels.size());
  for (std::size_t i = 0; i < surface.Triangles.size(); ++i)
  {
    const TriangleIds& s = surface.Triangles[i];
    EXPECT_FALSE(AreCollinear(surface.Points[s[0]], surface.Points[s[1]], surface.Points[s[2]]));
    for (std::size_t j = i + 1; j < surface.Triangles.size(); ++j)
    {
      EXPECT_NE(
        TriangleContact::Intersection, ClassifyTriangles(surface.Points, s, surface.Triangles[j]));
    }
  }
}

BoundaryTriangulatorOutput ExpectOk(
  const PolygonSoup& soup, const BoundaryTriangulatorOptions& options = {})
{
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  ExpectInvariants(output, soup);
  return output;
}

Status ExpectInvalid(const PolygonSoup& soup, BoundaryTriangulatorOutput& output,
  StatusCode code = StatusCode::InvalidInput, const BoundaryTriangulatorOptions& options = {})
{
  const Status status = TriangulateBoundary(soup, options, {}, output);
  EXPECT_EQ(code, status.Code);
  EXPECT_FALSE(status.Message.empty());
  EXPECT_TRUE(output.Surface.Points.empty());
  EXPECT_TRUE(output.Surface.Triangles.empty());
  EXPECT_TRUE(output.PointSources.empty());
  return status;
}

Status ExpectInvalid(const PolygonSoup& soup, StatusCode code = StatusCode::InvalidInput,
  const BoundaryTriangulatorOptions& options = {})
{
  BoundaryTriangulatorOutput output;
  return ExpectInvalid(soup, output, code, options);
}

Id CountProblems(const BoundaryTriangulatorOutput& output, SurfaceProblemKind kind)
{
  return static_cast<Id>(std::count_if(output.Problems.begin(), output.Problems.end(),
    [kind](const SurfaceProblem& problem) { return problem.Kind == kind; }));
}

/** Six times the volume enclosed by a surface whose normals point outwards. */
double GetVolume(const TriangleMesh& surface)
{
  double volume = 0.0;
  for (const TriangleIds& t : surface.Triangles)
  {
    volume += Dot(surface.Points[t[0]], Cross(surface.Points[t[1]], surface.Points[t[2]]));
  }
  return volume;
}
} // namespace

TEST(BoundaryTriangulator, Cube)
{
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(MakeCubePoints(), CubeFaces));
  EXPECT_EQ(12u, output.Surface.Triangles.size());
  EXPECT_EQ(6.0, GetVolume(output.Surface));
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_TRUE(output.Problems.empty());
}

TEST(BoundaryTriangulator, PolygonsWithPointsOfTheirOwn)
{
  // Every face has its own four points; zeros of either sign are equal.
  const std::vector<Vec3> cube = MakeCubePoints();
  std::vector<Vec3> points{ { 9, 9, 9 } };
  std::vector<std::vector<Id>> faces;
  for (const std::vector<Id>& face : CubeFaces)
  {
    faces.emplace_back();
    for (const Id id : face)
    {
      faces.back().push_back(static_cast<Id>(points.size()));
      const double sign = points.size() % 2 == 0 ? 1.0 : -1.0;
      const Vec3& p = cube[id];
      points.push_back({ p.X == 0 ? sign * 0.0 : p.X, p.Y == 0 ? sign * 0.0 : p.Y, p.Z });
    }
  }
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces));
  EXPECT_EQ(8u, output.Surface.Points.size());
  EXPECT_EQ((std::vector<Id>{ 1, 2, 3, 4, 5, 6, 7, 8 }), output.PointSources);
  EXPECT_EQ(16, output.Report.MergedPoints);
  EXPECT_EQ(1, output.Report.UnusedPoints);
  EXPECT_EQ(0, output.Report.OpenEdges);
}

TEST(BoundaryTriangulator, TolerantMerging)
{
  std::vector<Vec3> points = MakeCubePoints();
  std::vector<std::vector<Id>> faces = CubeFaces;
  points.push_back({ 1e-4, 1e-4, 0 });
  faces[0][0] = 8;
  BoundaryTriangulatorOptions options;
  EXPECT_LT(0, ExpectOk(MakeSoup(points, faces), options).Report.OpenEdges);
  options.MergeTolerance = 1e-3;
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces), options);
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_EQ(1, output.Report.MergedPoints);
  EXPECT_EQ((std::vector<Id>{ 0, 1, 2, 3, 4, 5, 6, 7 }), output.PointSources);
}

TEST(BoundaryTriangulator, RepeatedVerticesAreDropped)
{
  std::vector<std::vector<Id>> faces = CubeFaces;
  faces[0] = { 0, 0, 2, 2, 2, 3, 1, 0 };
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(MakeCubePoints(), faces));
  EXPECT_EQ(12u, output.Surface.Triangles.size());
  EXPECT_EQ(4, output.Report.RepeatedVertices);
}

TEST(BoundaryTriangulator, DegeneratePolygonsAreDroppedAndTheirGapIsMended)
{
  // A point in the middle of the edge 0-1 is known to one face, and to a triangle without area.
  std::vector<Vec3> points = MakeCubePoints();
  points.push_back({ 0.5, 0, 0 });
  std::vector<std::vector<Id>> faces = CubeFaces;
  faces[2] = { 0, 8, 1, 5, 4 };
  faces.push_back({ 0, 1, 8 });
  faces.push_back({ 3, 3, 7 });
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces));
  EXPECT_EQ(2, output.Report.DegeneratePolygons);
  EXPECT_EQ(2, CountProblems(output, SurfaceProblemKind::DegeneratePolygon));
  EXPECT_EQ(1, output.Report.TJunctions);
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_EQ(14u, output.Surface.Triangles.size());
  EXPECT_EQ(6.0, GetVolume(output.Surface));
}

TEST(BoundaryTriangulator, TJunctions)
{
  // One face is cut into two strips.
  std::vector<Vec3> points = MakeCubePoints();
  points.insert(points.end(), { { 0.25, 0, 0 }, { 0.25, 1, 0 }, { 0.75, 0, 0 }, { 0.75, 1, 0 } });
  std::vector<std::vector<Id>> faces = CubeFaces;
  faces[0] = { 0, 2, 9, 8 };
  faces.push_back({ 8, 9, 11, 10 });
  faces.push_back({ 10, 11, 3, 1 });
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces));
  EXPECT_EQ(4, output.Report.TJunctions);
  EXPECT_EQ(4, CountProblems(output, SurfaceProblemKind::TJunction));
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_EQ(20u, output.Surface.Triangles.size());
  EXPECT_EQ(6.0, GetVolume(output.Surface));
}

TEST(BoundaryTriangulator, TJunctionsWithinTheTolerance)
{
  // A tetrahedron, one edge of which another facet splits at a rounded position.
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 1, 0.1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
    { 1.0 / 3.0, 0.1 / 3.0 - 1e-12, 0 } };
  const PolygonSoup soup =
    MakeSoup(points, { { 0, 2, 1 }, { 0, 4, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 } });
  BoundaryTriangulatorOptions options;
  EXPECT_EQ(3, ExpectOk(soup, options).Report.OpenEdges);
  options.MergeTolerance = 1e-9;
  EXPECT_EQ(0, ExpectOk(soup, options).Report.OpenEdges);
}

TEST(BoundaryTriangulator, DuplicatePolygonsUniteTheirLabels)
{
  // Two cubes, each given with all of its faces and its own region.
  std::vector<Vec3> points = MakeCubePoints();
  points.insert(points.end(), { { 2, 0, 0 }, { 2, 1, 0 }, { 2, 0, 1 }, { 2, 1, 1 } });
  std::vector<std::vector<Id>> faces = CubeFaces;
  std::vector<RegionPair> labels(6, RegionPair{ OutsideRegion, 5 });
  const Id second[8] = { 1, 8, 3, 9, 5, 10, 7, 11 };
  for (const std::vector<Id>& face : CubeFaces)
  {
    faces.emplace_back();
    for (const Id id : face)
    {
      faces.back().push_back(second[id]);
    }
    labels.push_back({ OutsideRegion, 7 });
  }
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces, labels));
  EXPECT_EQ(22u, output.Surface.Triangles.size());
  EXPECT_EQ(1, output.Report.DuplicatePolygons);
  EXPECT_EQ(4, output.Report.NonManifoldEdges);
  EXPECT_EQ(2,
    std::count(output.Surface.Labels.begin(), output.Surface.Labels.end(), (RegionPair{ 7, 5 })));

  // The same region claimed on the same side again is no contradiction, another one is.
  faces.push_back({ 1, 3, 7, 5 });
  labels.push_back({ 7, OutsideRegion });
  EXPECT_EQ(2, ExpectOk(MakeSoup(points, faces, labels)).Report.DuplicatePolygons);
  labels.back().Front = 6;
  EXPECT_EQ((std::vector<Id>{ 5, 12 }), ExpectInvalid(MakeSoup(points, faces, labels)).Cells);
}

TEST(BoundaryTriangulator, TrianglesInCommonAreMadeOnce)
{
  const std::vector<Vec3> points = MakeCubePoints();
  std::vector<std::vector<Id>> faces = CubeFaces;
  // Half of the first face again, cut as the face is (between its lowest points), seen from inside.
  faces.push_back({ 0, 1, 3 });
  const std::vector<RegionPair> labels(faces.size(), RegionPair{ OutsideRegion, 0 });
  BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces));
  EXPECT_EQ(12u, output.Surface.Triangles.size());
  EXPECT_EQ(1, output.Report.DuplicateTriangles);
  output = ExpectOk(MakeSoup(points, faces, labels));
  EXPECT_EQ(1,
    std::count(output.Surface.Labels.begin(), output.Surface.Labels.end(), (RegionPair{ 0, 0 })));
}

TEST(BoundaryTriangulator, OpenEdgesAreReported)
{
  std::vector<std::vector<Id>> faces = CubeFaces;
  faces.pop_back();
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(MakeCubePoints(), faces));
  EXPECT_EQ(4, output.Report.OpenEdges);
  EXPECT_EQ(4, CountProblems(output, SurfaceProblemKind::OpenEdge));
  EXPECT_EQ(10u, output.Surface.Triangles.size());
}

TEST(BoundaryTriangulator, GapsArePatched)
{
  std::vector<std::vector<Id>> faces = CubeFaces;
  faces.erase(faces.begin() + 5);
  faces.erase(faces.begin() + 4);
  const std::vector<RegionPair> labels(4, RegionPair{ OutsideRegion, 3 });
  BoundaryTriangulatorOptions options;
  options.MaximumGapEdges = 3;
  EXPECT_EQ(0, ExpectOk(MakeSoup(MakeCubePoints(), faces, labels), options).Report.PatchedRings);
  options.MaximumGapEdges = 4;
  const BoundaryTriangulatorOutput output =
    ExpectOk(MakeSoup(MakeCubePoints(), faces, labels), options);
  EXPECT_EQ(2, output.Report.PatchedRings);
  EXPECT_EQ(8, CountProblems(output, SurfaceProblemKind::PatchedGap));
  EXPECT_EQ(0, output.Report.OpenEdges);
  EXPECT_EQ(6.0, GetVolume(output.Surface));
  for (const RegionPair& pair : output.Surface.Labels)
  {
    EXPECT_EQ((RegionPair{ OutsideRegion, 3 }), pair);
  }
}

TEST(BoundaryTriangulator, GapsThatTouchArePatched)
{
  // A 4 x 4 grid on top of a box, two fields that share a corner missing.
  std::vector<Vec3> points;
  std::vector<std::vector<Id>> faces;
  for (int j = 0; j < 5; ++j)
  {
    for (int i = 0; i < 5; ++i)
    {
      points.push_back({ double(i), double(j), 0.1 * i * j });
      if (i < 4 && j < 4 && !(i == 1 && j == 1) && !(i == 2 && j == 2))
      {
        const Id first = 5 * j + i;
        faces.push_back({ first, first + 1, first + 6, first + 5 });
      }
    }
  }
  BoundaryTriangulatorOptions options;
  options.MaximumGapEdges = 8;
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces), options);
  EXPECT_EQ(2, output.Report.PatchedRings);
  // The outline of the grid is longer than the limit.
  EXPECT_EQ(16, output.Report.OpenEdges);
}

TEST(BoundaryTriangulator, ALoneTriangleIsNoGap)
{
  BoundaryTriangulatorOptions options;
  options.MaximumGapEdges = 100;
  const BoundaryTriangulatorOutput output =
    ExpectOk(MakeSoup({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } }), options);
  EXPECT_EQ(0, output.Report.PatchedRings);
  EXPECT_EQ(3, output.Report.OpenEdges);
}

TEST(BoundaryTriangulator, SelfIntersectionsAreRefusedOrReported)
{
  std::vector<Vec3> points = MakeCubePoints();
  points.insert(points.end(), { { 0.5, 0.5, 0.5 }, { 0.5, 0.7, 0.5 }, { 3, 0.5, 0.5 } });
  std::vector<std::vector<Id>> faces = CubeFaces;
  faces.push_back({ 8, 9, 10 });
  const PolygonSoup soup = MakeSoup(points, faces);
  BoundaryTriangulatorOutput output;
  const Status status = ExpectInvalid(soup, output, StatusCode::SelfIntersecting);
  EXPECT_EQ((std::vector<Id>{ 5, 6 }), status.Cells);
  // The triangle crosses one or both halves of the face.
  const Id pairs = CountProblems(output, SurfaceProblemKind::SelfIntersection);
  EXPECT_TRUE(pairs == 1 || pairs == 2);
  EXPECT_EQ(pairs, output.Report.SelfIntersections);
  for (const SurfaceProblem& problem : output.Problems)
  {
    if (problem.Kind == SurfaceProblemKind::SelfIntersection)
    {
      EXPECT_NEAR(1.0, problem.SegmentBegin.X, 1e-15);
      EXPECT_NEAR(1.0, problem.SegmentEnd.X, 1e-15);
      EXPECT_EQ(5, problem.Cell);
      EXPECT_EQ(6, problem.OtherCell);
    }
  }
  BoundaryTriangulatorOptions options;
  options.RefuseSelfIntersections = false;
  EXPECT_TRUE(TriangulateBoundary(soup, options, {}, output).IsOk());
  EXPECT_EQ(13u, output.Surface.Triangles.size());
  EXPECT_EQ(pairs, CountProblems(output, SurfaceProblemKind::SelfIntersection));
}

TEST(BoundaryTriangulator, OverlappingCoplanarPolygonsIntersect)
{
  const PolygonSoup soup =
    MakeSoup({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 }, { 1, 1, 0 }, { 5, 1, 0 }, { 1, 5, 0 } },
      { { 0, 1, 2 }, { 3, 4, 5 } });
  EXPECT_EQ((std::vector<Id>{ 0, 1 }), ExpectInvalid(soup, StatusCode::SelfIntersecting).Cells);
}

TEST(BoundaryTriangulator, InvalidOutlines)
{
  BoundaryTriangulatorOutput output;
  const PolygonSoup soup = MakeSoup(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } }, { { 0, 1, 3 }, { 0, 1, 2, 3 } });
  EXPECT_EQ((std::vector<Id>{ 1 }), ExpectInvalid(soup, output).Cells);
  EXPECT_EQ(1, CountProblems(output, SurfaceProblemKind::InvalidOutline));
}

TEST(BoundaryTriangulator, BadInputIsRefused)
{
  EXPECT_EQ(StatusCode::InvalidInput, ExpectInvalid(PolygonSoup()).Code);

  std::vector<Vec3> points = MakeCubePoints();
  points[3].Y = std::numeric_limits<double>::quiet_NaN();
  points[6].X = -std::numeric_limits<double>::infinity();
  EXPECT_EQ((std::vector<Id>{ 3, 6 }), ExpectInvalid(MakeSoup(points, CubeFaces)).Points);

  std::vector<std::vector<Id>> faces = CubeFaces;
  faces[2][0] = 8;
  faces[4][3] = -1;
  EXPECT_EQ((std::vector<Id>{ 2, 4 }), ExpectInvalid(MakeSoup(MakeCubePoints(), faces)).Cells);

  EXPECT_EQ((std::vector<Id>{ 0, 1 }),
    ExpectInvalid(
      MakeSoup({ { 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 } }, { { 0, 1, 2 }, { 0, 1, 0, 1 } }))
      .Cells);

  PolygonSoup soup = MakeSoup(MakeCubePoints(), CubeFaces);
  soup.Labels.resize(5);
  EXPECT_FALSE(ExpectInvalid(soup).IsOk());
  soup.Labels.clear();
  BoundaryTriangulatorOptions options;
  options.MergeTolerance = -1.0;
  EXPECT_FALSE(ExpectInvalid(soup, StatusCode::InvalidOption, options).IsOk());
  options.MergeTolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(ExpectInvalid(soup, StatusCode::InvalidOption, options).IsOk());
}

TEST(BoundaryTriangulator, NonPlanarPolygonsAreCounted)
{
  std::vector<Vec3> points = MakeCubePoints();
  points[7] = { 1.25, 1.25, 1.25 };
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, CubeFaces));
  EXPECT_EQ(3, output.Report.NonPlanarPolygons);
  EXPECT_EQ(0, output.Report.OpenEdges);
}

TEST(BoundaryTriangulator, AllScales)
{
  // T-junctions, a gap, a duplicate and a tolerance that has the unit of the coordinates.
  for (const double scale : { 1e-9, 1e-6, 1.0 / 3.0, 1.0, 1e3, 1e6 })
  {
    SCOPED_TRACE(scale);
    std::vector<Vec3> points = MakeCubePoints();
    points.insert(points.end(), { { 0.3, 0, 0 }, { 0.3, 1, 0 }, { 0.7, 1e-7, 0 }, { 0.7, 1, 0 } });
    std::vector<std::vector<Id>> faces = CubeFaces;
    faces[0] = { 0, 2, 9, 8 };
    faces.push_back({ 8, 9, 11, 10 });
    faces.push_back({ 10, 11, 3, 1 });
    faces.push_back({ 1, 3, 11, 10 });
    faces[1] = { 4, 5, 7 };
    for (Vec3& p : points)
    {
      p = scale * p;
    }
    BoundaryTriangulatorOptions options;
    options.MaximumGapEdges = 3;
    EXPECT_EQ(3, ExpectOk(MakeSoup(points, faces)).Report.TJunctions);
    options.MergeTolerance = 1e-6 * scale;
    const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces), options);
    EXPECT_EQ(4, output.Report.TJunctions);
    EXPECT_EQ(1, output.Report.DuplicatePolygons);
    EXPECT_EQ(1, output.Report.PatchedRings);
    EXPECT_EQ(0, output.Report.OpenEdges);
    EXPECT_NEAR(6.0, GetVolume(output.Surface) / scale / scale / scale, 1e-5);
  }
}

TEST(BoundaryTriangulator, TheBorderOfAMoebiusStripIsNoGap)
{
  // 12 quadrilaterals that turn over once on their way round: a patch would cross the strip.
  std::vector<Vec3> points;
  std::vector<std::vector<Id>> faces;
  constexpr int n = 12;
  for (int i = 0; i < n; ++i)
  {
    const double angle = 2.0 * 3.14159265358979323846 * i / n;
    for (const double side : { -1.0, 1.0 })
    {
      const double r = 3.0 + side * std::cos(0.5 * angle);
      points.push_back({ r * std::cos(angle), r * std::sin(angle), side * std::sin(0.5 * angle) });
    }
    const Id a = 2 * i;
    const bool isLast = i == n - 1;
    faces.push_back({ a, a + 1, isLast ? 0 : a + 3, isLast ? 1 : a + 2 });
  }
  BoundaryTriangulatorOptions options;
  options.MaximumGapEdges = 100;
  const BoundaryTriangulatorOutput output = ExpectOk(MakeSoup(points, faces), options);
  EXPECT_EQ(0, output.Report.PatchedRings);
  EXPECT_EQ(2 * n, output.Report.OpenEdges);
}

TEST(BoundaryTriangulator, ProgressRisesAndAbortLeavesNothing)
{
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
  const PolygonSoup soup = MakeSoup(MakeCubePoints(), CubeFaces);
  BoundaryTriangulatorOutput output;
  ASSERT_TRUE(TriangulateBoundary(soup, {}, context, output).IsOk());
  const int all = calls;
  EXPECT_LT(3, all);
  for (limit = 1; limit <= all; ++limit)
  {
    last = 0.0;
    calls = 0;
    EXPECT_TRUE(TriangulateBoundary(soup, {}, context, output).IsAborted());
    EXPECT_TRUE(output.Surface.Triangles.empty());
    EXPECT_TRUE(output.Problems.empty());
  }
}
