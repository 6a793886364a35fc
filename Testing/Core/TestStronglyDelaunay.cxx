// SPDX-License-Identifier: BSD-3-Clause
// The double sphere test of triangles (SurfaceDelaunayTest.h) beside the definition, with the exact
// predicates on all points.
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/PointOctree.h"
#include "Core/Surface/SurfaceDelaunayTest.h"
#include "Core/Surface/TriangleProofs.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;

/** How the points of a test lie. */
enum class Shape : int
{
  Cube,
  /** Integer coordinates: many points on spheres, circles and planes. */
  Grid,
  /** The grid rotated and rounded: planes and circles hold up to the last digits only. */
  TurnedGrid,
  /** z = x^2 + y^2: spheres through narrow triangles hold most points, all of them on one side. */
  Paraboloid,
  /** A plane but for a millionth: spheres that are almost half spaces. */
  Sheet,
  /** A thicker sheet, and a few points on its other side. */
  TwoSheets,
  /** A line but for a hundred-thousandth: needles. */
  Line,
  NumberOfShapes
};

/** Rotates points by 77 degrees about (1, 2, 3): what was plane or round is so but for rounding. */
void Turn(std::vector<Vec3>& points)
{
  Rotate(points, (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 }, 77.0 * Pi / 180.0);
}

std::vector<Vec3> MakePoints(Shape shape, int count, std::mt19937& random)
{
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> step(0, 6);
  std::set<std::tuple<double, double, double>> points;
  while (static_cast<int>(points.size()) < count)
  {
    const double x = unit(random);
    const double y = unit(random);
    const double z = unit(random);
    switch (shape)
    {
      case Shape::Grid:
        points.insert({ step(random), step(random), step(random) });
        break;
      case Shape::TurnedGrid:
        points.insert({ step(random), step(random), 0.25 * step(random) });
        break;
      case Shape::Paraboloid:
        points.insert({ x, y, x * x + y * y });
        break;
      case Shape::Sheet:
        points.insert({ x, y, 1e-6 * z });
        break;
      case Shape::TwoSheets:
        points.insert({ x, y, points.size() < 5 ? -0.1 : 1e-3 * z });
        break;
      case Shape::Line:
        points.insert({ x, 1e-5 * y, 1e-5 * z });
        break;
      default:
        points.insert({ x, y, z });
        break;
    }
  }
  std::vector<Vec3> list;
  for (const auto& [x, y, z] : points)
  {
    list.push_back({ x, y, z });
  }
  if (shape == Shape::TurnedGrid)
  {
    Turn(list);
  }
  std::shuffle(list.begin(), list.end(), random);
  return list;
}

/** The definition, cocircular points left aside. */
bool IsStronglyDelaunay(const std::vector<Vec3>& points, const TriangleIds& t)
{
  const Vec3& a = points[t[0]];
  const Vec3& b = points[t[1]];
  const Vec3& c = points[t[2]];
  Id front = NoId;
  for (Id id = 0; id < static_cast<Id>(points.size()); ++id)
  {
    const int side = Orientation(a, b, c, points[id]);
    if (side == 0 && id != t[0] && id != t[1] && id != t[2] &&
      InEquatorialSphere(a, b, c, points[id]) > 0)
    {
      return false;
    }
    if (side > 0 && (front == NoId || InSphere(a, b, c, points[front], points[id]) > 0))
    {
      front = id;
    }
  }
  return front == NoId ||
    std::none_of(points.begin(), points.end(),
      [&](const Vec3& q)
      { return Orientation(a, b, c, q) < 0 && InSphere(a, b, c, points[front], q) >= 0; });
}

/** A triangle stays strongly Delaunay where the proof says so. Returns whether its ball is loose. */
bool CheckProof(const std::vector<Vec3>& points, const TriangleIds& t,
  const SurfaceDelaunayTest::SphereProof& proof, std::mt19937& random)
{
  const Vec3& a = points[t[0]];
  const Vec3& b = points[t[1]];
  const Vec3& c = points[t[2]];
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const double height : { 1.0, 1e-3, 1e-6, 0.0 })
  {
    std::vector<Vec3> more = points;
    const double x = unit(random);
    const double y = unit(random);
    more.push_back(a + x * (b - a) + y * (c - a) + height * unit(random) * Cross(b - a, c - a));
    TriangleProofs proofs(more);
    proofs.Set(0, t, proof);
    std::vector<Id> endangered;
    proofs.Find(more.back(), endangered);
    EXPECT_TRUE(!endangered.empty() || IsStronglyDelaunay(more, t));
  }
  return proof.IsLoose;
}

/** What the test says of one triangle, beside the definition. Returns the points in its sphere. */
std::size_t CheckTriangle(const std::vector<Vec3>& points, const SurfaceDelaunayTest& test,
  const TriangleIds& t, SurfaceDelaunayTest::Result& found)
{
  std::vector<Id> inside;
  for (Id id = 0; id < static_cast<Id>(points.size()); ++id)
  {
    if (id != t[0] && id != t[1] && id != t[2] &&
      InEquatorialSphere(points[t[0]], points[t[1]], points[t[2]], points[id]) > 0)
    {
      inside.push_back(id);
    }
  }
  test.Run(t, found, true);
  EXPECT_EQ(found.IsDelaunay, inside.empty() && IsStronglyDelaunay(points, t));
  test.Run(t, found);
  EXPECT_EQ(found.IsDelaunay, IsStronglyDelaunay(points, t));
  EXPECT_EQ(found.InsideSmallestSphere.empty(), inside.empty());
  std::vector<Id> listed = found.InsideSmallestSphere;
  std::sort(listed.begin(), listed.end());
  EXPECT_TRUE(std::includes(inside.begin(), inside.end(), listed.begin(), listed.end()));
  EXPECT_EQ(std::adjacent_find(listed.begin(), listed.end()), listed.end());
  if (inside.size() < 64)
  {
    EXPECT_EQ(listed, inside);
  }
  return inside.size();
}
} // namespace

TEST(StronglyDelaunay, IsWhatTheDefinitionSays)
{
  for (int shape = 0; shape < static_cast<int>(Shape::NumberOfShapes); ++shape)
  {
    int numberOfGood = 0;
    int numberOfLarge = 0;
    int numberOfLoose = 0;
    for (unsigned seed = 1; seed <= 6; ++seed)
    {
      SCOPED_TRACE("shape " + std::to_string(shape) + ", seed " + std::to_string(seed));
      std::mt19937 random(seed);
      const std::vector<Vec3> points =
        MakePoints(static_cast<Shape>(shape), seed % 2 == 0 ? 300 : 60, random);
      PointOctree octree;
      octree.Insert(points);
      const SurfaceDelaunayTest test(points, octree);
      SurfaceDelaunayTest::Result found;
      // Every second triangle has points that are near to each other: some of these are Delaunay.
      std::vector<Id> nearest(points.size());
      for (int i = 0; i < 400; ++i)
      {
        std::iota(nearest.begin(), nearest.end(), 0);
        const Vec3 center = points[random() % points.size()];
        const std::size_t reach = i % 2 == 0 ? 5 : points.size();
        std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(reach),
          nearest.end(),
          [&](Id p, Id q)
          { return SquaredNorm(points[p] - center) < SquaredNorm(points[q] - center); });
        std::shuffle(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(reach), random);
        const TriangleIds t{ nearest[0], nearest[1], nearest[2] };
        if (AreCollinear(points[t[0]], points[t[1]], points[t[2]]))
        {
          continue;
        }
        numberOfLarge += CheckTriangle(points, test, t, found) >= 64 ? 1 : 0;
        numberOfGood += found.IsDelaunay ? 1 : 0;
        numberOfLoose += found.IsDelaunay && CheckProof(points, t, found.Proof, random) ? 1 : 0;
      }
    }
    EXPECT_GT(numberOfGood, 0) << "shape " << shape;
    EXPECT_GT(numberOfLarge, 0) << "shape " << shape;
    const bool isNarrow =
      shape == static_cast<int>(Shape::Sheet) || shape == static_cast<int>(Shape::Line);
    EXPECT_TRUE(numberOfLoose > 0 || !isNarrow);
    std::printf("shape %d: %d triangles are strongly Delaunay, %d by loose balls, %d hold 64 "
                "points or more\n",
      shape, numberOfGood, numberOfLoose, numberOfLarge);
  }
}

/** All points lie on one side, and most of them in the smallest sphere. */
TEST(StronglyDelaunay, TrianglesOfAHullWithLargeSpheres)
{
  std::mt19937 random(1);
  std::vector<Vec3> points = MakePoints(Shape::Cube, 2000, random);
  // Three points near a line below all others.
  const auto first = static_cast<Id>(points.size());
  points.insert(points.end(), { { -3.0, 0.0, -2.0 }, { 0.0, 0.01, -2.0 }, { 3.0, 0.0, -2.0 } });
  PointOctree octree;
  octree.Insert(points);
  const SurfaceDelaunayTest test(points, octree);
  SurfaceDelaunayTest::Result found;
  EXPECT_GT(CheckTriangle(points, test, { first, first + 1, first + 2 }, found), 900u);
  EXPECT_TRUE(found.IsDelaunay);
  EXPECT_LT(found.InsideSmallestSphere.size(), 200u);
  EXPECT_GT(CheckTriangle(points, test, { first + 2, first + 1, first }, found), 900u);
  EXPECT_TRUE(found.IsDelaunay);
}

/** A quadrilateral that rounding folds: what is in front may only show in the exact predicates. */
TEST(StronglyDelaunay, FoldedQuadrilaterals)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int numberOfGood = 0;
  for (int sample = 0; sample < 4000; ++sample)
  {
    SCOPED_TRACE("sample " + std::to_string(sample));
    std::vector<Vec3> points;
    for (int i = 0; i < 4; ++i)
    {
      const double angle = 3.0 * unit(random);
      points.push_back({ std::cos(angle), std::sin(angle), 0.0 });
    }
    for (int i = 0; i < 6; ++i)
    {
      points.push_back({ 2.0 * unit(random), 2.0 * unit(random), -1.0 + unit(random) });
    }
    Turn(points);
    PointOctree octree;
    octree.Insert(points);
    const SurfaceDelaunayTest test(points, octree);
    SurfaceDelaunayTest::Result found;
    CheckTriangle(points, test, { 0, 2, 1 }, found);
    CheckTriangle(points, test, { 0, 1, 2 }, found);
    if (found.IsDelaunay)
    {
      ++numberOfGood;
      CheckProof(points, { 0, 1, 2 }, found.Proof, random);
    }
  }
  EXPECT_GT(numberOfGood, 100);
  EXPECT_LT(numberOfGood, 3900);
}

/** Corners on a line but for rounding, whose triangle may have no normal and no center in doubles. */
TEST(StronglyDelaunay, CornersOnALineButForRounding)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> step(-3, 3);
  int numberOfTriangles = 0;
  for (int sample = 0; sample < 2000; ++sample)
  {
    SCOPED_TRACE("sample " + std::to_string(sample));
    const Vec3 direction{ 4.0 + step(random), 1.0 * step(random), 0.25 * step(random) };
    std::vector<Vec3> points{ { 0.0, 1.0, 2.0 } };
    points.push_back(points[0] + direction);
    points.push_back(points[0] + 3.0 * direction);
    for (int i = 0; i < 40; ++i)
    {
      points.push_back({ 9.0 * unit(random), 9.0 * unit(random), 9.0 * unit(random) });
    }
    Turn(points);
    if (AreCollinear(points[0], points[1], points[2]))
    {
      continue;
    }
    ++numberOfTriangles;
    PointOctree octree;
    octree.Insert(points);
    const SurfaceDelaunayTest test(points, octree);
    SurfaceDelaunayTest::Result found;
    CheckTriangle(points, test, { 0, 1, 2 }, found);
  }
  EXPECT_GT(numberOfTriangles, 1000);
}
