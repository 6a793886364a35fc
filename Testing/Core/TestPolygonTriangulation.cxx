// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/PolygonTriangulation.h"

#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

using namespace cdm;

namespace
{
std::vector<Id> MakeIds(std::size_t n)
{
  std::vector<Id> ids(n);
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

/** Twice the area in the plane z = 0. */
double GetArea(const std::vector<Vec3>& points, const std::vector<Id>& polygon)
{
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec3& a = points[polygon[i]];
    const Vec3& b = points[polygon[(i + 1) % polygon.size()]];
    area += a.X * b.Y - a.Y * b.X;
  }
  return area;
}

/** Checks all that a triangulation promises, for counter-clockwise polygons in the plane z = 0. */
void ExpectTriangulated(const std::vector<Vec3>& points, const std::vector<Id>& polygon)
{
  std::vector<TriangleIds> triangles;
  ASSERT_EQ(PolygonTriangulationResult::Ok, TriangulatePolygon(points, polygon, triangles));
  double area = 0.0;
  std::map<std::pair<Id, Id>, int> edges;
  for (const TriangleIds& t : triangles)
  {
    ASSERT_EQ(1, ProjectedOrientation(2, points[t[0]], points[t[1]], points[t[2]]));
    area += GetArea(points, { t[0], t[1], t[2] });
    for (int i = 0; i < 3; ++i)
    {
      ++edges[{ t[i], t[(i + 1) % 3] }];
    }
  }
  EXPECT_NEAR(GetArea(points, polygon), area, 1e-9 * area);
  // Every edge once in each direction, but the outline only in its own.
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    ++edges[{ polygon[(i + 1) % polygon.size()], polygon[i] }];
  }
  for (const auto& edge : edges)
  {
    const auto opposite = edges.find({ edge.first.second, edge.first.first });
    ASSERT_TRUE(opposite != edges.end() && opposite->second == edge.second);
  }
  if (triangles.size() > 200)
  {
    return;
  }
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    for (std::size_t j = i + 1; j < triangles.size(); ++j)
    {
      ASSERT_NE(
        TriangleContact::Intersection, ClassifyTriangles(points, triangles[i], triangles[j]));
    }
  }
}

void ExpectTriangulated(const std::vector<Vec3>& points)
{
  ExpectTriangulated(points, MakeIds(points.size()));
}
} // namespace

TEST(PolygonTriangulation, QuadrilateralGetsTheShorterDiagonal)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 3, 1, 0 }, { 3, 4, 0 }, { 0, 3, 0 } };
  std::vector<TriangleIds> triangles;
  ASSERT_EQ(PolygonTriangulationResult::Ok, TriangulatePolygon(points, MakeIds(4), triangles));
  EXPECT_EQ((std::vector<TriangleIds>{ { 1, 2, 3 }, { 1, 3, 0 } }), triangles);
}

TEST(PolygonTriangulation, NonConvexQuadrilateralGetsTheOnlyDiagonal)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 4, -9, 0 }, { 1, 0, 0 }, { 4, 9, 0 } };
  ExpectTriangulated(points);
}

TEST(PolygonTriangulation, CollinearVerticesBecomeCorners)
{
  ExpectTriangulated({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 } });
  ExpectTriangulated(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 3, 0, 0 }, { 3, 3, 0 }, { 2, 2, 0 }, { 1, 1, 0 } });
  std::vector<Vec3> points;
  for (int side = 0; side < 4; ++side)
  {
    for (int i = 0; i < 10; ++i)
    {
      points.push_back(side == 0 ? Vec3{ double(i), 0, 0 }
          : side == 1            ? Vec3{ 10, double(i), 0 }
          : side == 2            ? Vec3{ double(10 - i), 10, 0 }
                                 : Vec3{ 0, double(10 - i), 0 });
    }
  }
  ExpectTriangulated(points);
}

TEST(PolygonTriangulation, HolesBridgedToTheOutline)
{
  // A square with a square hole; the bridge joins 0 and 4.
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 9, 0, 0 }, { 9, 9, 0 }, { 0, 9, 0 }, { 3, 3, 0 },
    { 3, 6, 0 }, { 6, 6, 0 }, { 6, 3, 0 } };
  ExpectTriangulated(points, { 0, 1, 2, 3, 0, 4, 5, 6, 7, 4 });
  // The bridge drawn at other places of the cycle.
  ExpectTriangulated(points, { 4, 5, 6, 7, 4, 0, 1, 2, 3, 0 });
  ExpectTriangulated(points, { 6, 7, 4, 5, 6, 2, 3, 0, 1, 2 });
}

TEST(PolygonTriangulation, ManyHolesAtOneVertex)
{
  std::vector<Vec3> points{ { 0, 0, 0 }, { 100, 0, 0 }, { 100, 100, 0 }, { 0, 100, 0 } };
  std::vector<Id> polygon{ 1, 2, 3, 0 };
  // Small triangles on rays from vertex 0, bridged in the order in which the rays turn.
  for (int i = 9; i >= 1; --i)
  {
    const double angle = 0.157 * i;
    const double x = 70 * std::cos(angle);
    const double y = 70 * std::sin(angle);
    const Id first = static_cast<Id>(points.size());
    points.insert(points.end(), { { x, y, 0 }, { x, y + 3, 0 }, { x + 3, y + 1, 0 } });
    polygon.insert(polygon.end(), { first, first + 1, first + 2, first, 0 });
  }
  ExpectTriangulated(points, polygon);
}

TEST(PolygonTriangulation, ChainOfHoles)
{
  std::vector<Vec3> points{ { 0, 0, 0 }, { 100, 0, 0 }, { 100, 10, 0 }, { 0, 10, 0 } };
  std::vector<Id> polygon{ 0, 1, 2, 3, 0 };
  std::vector<Id> back;
  for (int i = 0; i < 9; ++i)
  {
    const Id first = static_cast<Id>(points.size());
    const double x = 5.0 + 10.0 * i;
    points.insert(points.end(), { { x, 5, 0 }, { x + 2, 7, 0 }, { x + 4, 5, 0 }, { x + 2, 3, 0 } });
    polygon.insert(polygon.end(), { first, first + 1, first + 2 });
    back.insert(back.begin(), { first + 2, first + 3, first });
  }
  // At the last hole the chain turns round: its last vertex is visited once.
  polygon.insert(polygon.end(), back.begin() + 1, back.end());
  ExpectTriangulated(points, polygon);
}

TEST(PolygonTriangulation, HoleThatTouchesTheOutlineInAVertex)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 4, 0, 0 }, { 8, 0, 0 }, { 8, 8, 0 }, { 0, 8, 0 },
    { 2, 4, 0 }, { 6, 4, 0 } };
  ExpectTriangulated(points, { 0, 1, 5, 6, 1, 2, 3, 4 });
}

TEST(PolygonTriangulation, LobesThatTouchInAVertex)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 2, 0, 0 }, { 1, 1, 0 }, { 2, 2, 0 }, { 0, 2, 0 } };
  ExpectTriangulated(points, { 0, 1, 2, 3, 4, 2 });
}

TEST(PolygonTriangulation, SpikesOutwardsAreCutOff)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 }, { 5, 5, 0 } };
  std::vector<TriangleIds> triangles;
  ASSERT_EQ(
    PolygonTriangulationResult::Ok, TriangulatePolygon(points, { 0, 1, 3, 1, 2 }, triangles));
  ASSERT_EQ(1u, triangles.size());
  EXPECT_EQ(4.0, GetArea(points, { triangles[0][0], triangles[0][1], triangles[0][2] }));
}

TEST(PolygonTriangulation, SpikesInwardsAreKept)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 9, 0, 0 }, { 9, 9, 0 }, { 0, 9, 0 }, { 4, 3, 0 } };
  ExpectTriangulated(points, { 0, 4, 0, 1, 2, 3 });
}

TEST(PolygonTriangulation, DegenerateAndInvalidOutlines)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 }, { 3, 3, 3 }, { 2, 0, 0 },
    { 0, 2, 0 }, { 2, 2, 0 } };
  std::vector<TriangleIds> triangles;
  EXPECT_EQ(
    PolygonTriangulationResult::Degenerate, TriangulatePolygon(points, { 0, 1 }, triangles));
  EXPECT_EQ(
    PolygonTriangulationResult::Degenerate, TriangulatePolygon(points, { 0, 2, 1, 3 }, triangles));
  // There and back on two lines.
  EXPECT_EQ(
    PolygonTriangulationResult::Degenerate, TriangulatePolygon(points, { 0, 4, 6, 4 }, triangles));
  // A bow tie.
  EXPECT_EQ(
    PolygonTriangulationResult::Invalid, TriangulatePolygon(points, { 0, 4, 5, 6 }, triangles));
  EXPECT_TRUE(triangles.empty());
}

TEST(PolygonTriangulation, KeepsTheOrientationInEveryPlane)
{
  const std::vector<Vec3> flat{ { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 2, 1, 0 }, { 0, 4, 0 } };
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<Vec3> points;
    for (const Vec3& p : flat)
    {
      Vec3 q;
      q[(axis + 1) % 3] = p.X;
      q[(axis + 2) % 3] = p.Y;
      // Slanted, with rounded coordinates.
      q[axis] = 0.1 * p.X + 0.3 * p.Y;
      points.push_back(q);
    }
    for (const bool isReversed : { false, true })
    {
      std::vector<Id> polygon = MakeIds(points.size());
      if (isReversed)
      {
        std::reverse(polygon.begin(), polygon.end());
      }
      std::vector<TriangleIds> triangles;
      ASSERT_EQ(PolygonTriangulationResult::Ok, TriangulatePolygon(points, polygon, triangles));
      ASSERT_EQ(3u, triangles.size());
      for (const TriangleIds& t : triangles)
      {
        EXPECT_EQ(isReversed ? -1 : 1,
          ProjectedOrientation(axis, points[t[0]], points[t[1]], points[t[2]]));
      }
    }
  }
}

TEST(PolygonTriangulation, ConvexPolygonsBecomeDelaunay)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> angles(40);
  std::generate(angles.begin(), angles.end(), [&] { return 6.28 * uniform(random); });
  std::sort(angles.begin(), angles.end());
  std::vector<Vec3> points;
  for (const double angle : angles)
  {
    points.push_back({ 3 * std::cos(angle), std::sin(angle), 0 });
  }
  std::vector<TriangleIds> triangles;
  ASSERT_EQ(
    PolygonTriangulationResult::Ok, TriangulatePolygon(points, MakeIds(points.size()), triangles));
  for (const TriangleIds& t : triangles)
  {
    for (const Vec3& p : points)
    {
      // The circumcircle is where a sphere through the triangle cuts the plane.
      EXPECT_GE(0, InSphere(points[t[0]], points[t[1]], points[t[2]], { 0, 0, 1 }, p));
    }
  }
}

TEST(PolygonTriangulation, RandomSimplePolygonsOnAGrid)
{
  std::mt19937 random(11);
  const auto cross = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
  {
    return ProjectedOrientation(2, a, b, c) * ProjectedOrientation(2, a, b, d) < 0 &&
      ProjectedOrientation(2, c, d, a) * ProjectedOrientation(2, c, d, b) < 0;
  };
  int tested = 0;
  for (int run = 0; run < 20000; ++run)
  {
    const std::size_t n = 4 + random() % 9;
    std::vector<Vec3> points;
    while (points.size() < n)
    {
      const Vec3 p{ double(random() % 7), double(random() % 7), 0 };
      if (std::find(points.begin(), points.end(), p) == points.end())
      {
        points.push_back(p);
      }
    }
    // Untangle crossing edges; each step makes the outline shorter.
    bool isTangled = true;
    while (isTangled)
    {
      isTangled = false;
      for (std::size_t i = 0; i < n; ++i)
      {
        for (std::size_t j = i + 2; j < n; ++j)
        {
          if (cross(points[i], points[i + 1], points[j], points[(j + 1) % n]))
          {
            std::reverse(points.begin() + i + 1, points.begin() + j + 1);
            isTangled = true;
          }
        }
      }
    }
    bool touches = false;
    for (std::size_t i = 0; i < n; ++i)
    {
      const Vec3& a = points[i];
      const Vec3& b = points[(i + 1) % n];
      for (const Vec3& p : points)
      {
        touches = touches || (p != a && p != b && AreCollinear(a, b, p) && Dot(p - a, p - b) < 0.0);
      }
    }
    if (touches)
    {
      continue;
    }
    ++tested;
    if (GetArea(points, MakeIds(n)) < 0.0)
    {
      std::reverse(points.begin(), points.end());
    }
    ExpectTriangulated(points);
    if (testing::Test::HasFatalFailure())
    {
      ADD_FAILURE() << "run " << run;
      return;
    }
  }
  EXPECT_GT(tested, 2000);
}

TEST(PolygonTriangulation, VerticesOnALineButForRoundingMakeNoNeedles)
{
  // A layer over two lines, as thick as these are high: ten vertices lie on one line, on both sides
  // of the layer, and turned in space none of them exactly.
  const double outline[][2] = { { 0.0, 0.15 }, { 0.02, 0.15 }, { 0.12, 0.35 }, { 0.28, 0.35 },
    { 0.38, 0.15 }, { 0.42, 0.15 }, { 0.52, 0.35 }, { 0.68, 0.35 }, { 0.78, 0.15 }, { 0.8, 0.15 },
    { 0.8, 0.35 }, { 0.78, 0.35 }, { 0.68, 0.55 }, { 0.52, 0.55 }, { 0.42, 0.35 }, { 0.38, 0.35 },
    { 0.28, 0.55 }, { 0.12, 0.55 }, { 0.02, 0.35 }, { 0.0, 0.35 } };
  std::vector<Vec3> flat;
  for (const auto& [x, y] : outline)
  {
    flat.push_back({ x, y, 0.0 });
  }
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> angle(0.0, 3.0);
  for (int turn = 0; turn < 1000; ++turn)
  {
    std::vector<Vec3> points = flat;
    Rotate(points, MakeRandomDirection(generator), angle(generator));
    std::vector<TriangleIds> triangles;
    ASSERT_EQ(PolygonTriangulationResult::Ok,
      TriangulatePolygon(points, MakeIds(points.size()), triangles));
    EXPECT_EQ(triangles.size(), points.size() - 2);
    for (const TriangleIds& t : triangles)
    {
      const Vec3 normal = Cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
      EXPECT_GT(Norm(normal), 1e-4) << turn;
    }
  }
}

TEST(PolygonTriangulation, ThousandsOfVertices)
{
  // A comb, whose teeth leave few ears.
  std::vector<Vec3> points{ { 0, 0, 0 }, { 4000, 0, 0 } };
  for (int i = 1000; i > 0; --i)
  {
    points.insert(points.end(), { { 4.0 * i, 50, 0 }, { 4.0 * i - 2, 1, 0 } });
  }
  points.push_back({ 0, 50, 0 });
  ExpectTriangulated(points);
}

TEST(PolygonTriangulation, NonPlanarity)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0.4 } };
  EXPECT_EQ(0.0, GetPolygonNonPlanarityRatio(points, { 0, 1, 2 }));
  EXPECT_NEAR(0.05, GetPolygonNonPlanarityRatio(points, { 0, 1, 2, 3 }), 0.01);
}
