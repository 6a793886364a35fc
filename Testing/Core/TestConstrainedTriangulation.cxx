// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/ConstrainedTriangulation.h"

#include "Core/Geometry/Predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
const std::vector<Vec3> Square{ { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 } };

std::vector<Vec3> MakePoints(const std::vector<Vec3>& more)
{
  std::vector<Vec3> points = Square;
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

bool HasEdge(const ConstrainedTriangulation& patch, Id a, Id b)
{
  return std::any_of(patch.GetTriangles().begin(), patch.GetTriangles().end(),
    [&](const TriangleIds& t)
    {
      return std::find(t.begin(), t.end(), a) != t.end() &&
        std::find(t.begin(), t.end(), b) != t.end();
    });
}

/** All triangles are positive and cover the square. */
void ExpectValid(const ConstrainedTriangulation& patch, const std::vector<Vec3>& points)
{
  double area = 0.0;
  for (const TriangleIds& t : patch.GetTriangles())
  {
    EXPECT_EQ(1, ProjectedOrientation(2, points[t[0]], points[t[1]], points[t[2]]));
    area += 0.5 * Cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]).Z;
  }
  EXPECT_NEAR(16.0, area, 1e-12);
}
} // namespace

TEST(ConstrainedTriangulation, PointsInsideOnEdgesAndOutside)
{
  const std::vector<Vec3> points =
    MakePoints({ { 1, 2, 0 }, { 2, 2, 0.1 }, { 5, 5, 0 }, { 4, 2, 0 }, { 1, 2, 3 } });
  ConstrainedTriangulation patch(points, 2, 1);
  EXPECT_FALSE(patch.AddOutline({ 0, 3, 2, 1 }));
  EXPECT_TRUE(patch.AddOutline({ 0, 1, 2, 3 }));
  EXPECT_TRUE(patch.AddPoint(4));
  EXPECT_TRUE(patch.AddPoint(4));
  // On the diagonal, in the projection.
  EXPECT_TRUE(patch.AddPoint(5));
  // Outside, on the outline, and above another point.
  EXPECT_FALSE(patch.AddPoint(6));
  EXPECT_FALSE(patch.AddPoint(7));
  EXPECT_FALSE(patch.AddPoint(8));
  EXPECT_EQ(6u, patch.GetTriangles().size());
  ExpectValid(patch, points);
}

TEST(ConstrainedTriangulation, Segments)
{
  // Across a lattice, through some of its points.
  std::vector<Vec3> more;
  for (int i = 1; i < 8; ++i)
  {
    for (int j = 1; j < 8; ++j)
    {
      more.push_back({ 0.5 * i, 0.5 * j, 0.0 });
    }
  }
  const std::vector<Vec3> points = MakePoints(more);
  ConstrainedTriangulation patch(points, 2, 1);
  ASSERT_TRUE(patch.AddOutline({ 0, 1, 2, 3 }));
  for (std::size_t i = 4; i < points.size(); ++i)
  {
    EXPECT_TRUE(patch.AddPoint(static_cast<Id>(i)));
  }
  const auto at = [](int i, int j) { return static_cast<Id>(4 + 7 * (i - 1) + j - 1); };
  EXPECT_TRUE(patch.AddSegment(at(1, 1), at(7, 5)));
  EXPECT_TRUE(HasEdge(patch, at(1, 1), at(4, 3)));
  EXPECT_TRUE(HasEdge(patch, at(4, 3), at(7, 5)));
  EXPECT_TRUE(patch.AddSegment(at(1, 2), at(6, 7)));
  EXPECT_TRUE(patch.AddSegment(at(2, 1), at(7, 4)));
  EXPECT_TRUE(HasEdge(patch, at(2, 1), at(4, 2)));
  // Another segment is in the way; an end is missing.
  EXPECT_FALSE(patch.AddSegment(at(1, 7), at(7, 1)));
  EXPECT_FALSE(patch.AddSegment(at(1, 7), 1000));
  patch.Improve();
  EXPECT_TRUE(HasEdge(patch, at(1, 1), at(4, 3)));
  EXPECT_TRUE(HasEdge(patch, at(2, 1), at(4, 2)));
  ExpectValid(patch, points);
}

TEST(ConstrainedTriangulation, TiesAreDecidedByIds)
{
  // The same lattice, points added in different order.
  std::vector<Vec3> more;
  for (int i = 1; i < 4; ++i)
  {
    for (int j = 1; j < 4; ++j)
    {
      more.push_back({ double(i), double(j), 0.0 });
    }
  }
  const std::vector<Vec3> points = MakePoints(more);
  std::vector<Id> order{ 4, 5, 6, 7, 8, 9, 10, 11, 12 };
  std::set<std::set<std::set<Id>>> results;
  std::mt19937 random(5);
  for (int k = 0; k < 20; ++k)
  {
    ConstrainedTriangulation patch(points, 2, 1);
    ASSERT_TRUE(patch.AddOutline({ 0, 1, 2, 3 }));
    for (const Id id : order)
    {
      EXPECT_TRUE(patch.AddPoint(id));
    }
    patch.Improve();
    ExpectValid(patch, points);
    std::set<std::set<Id>> result;
    for (const TriangleIds& t : patch.GetTriangles())
    {
      result.insert({ t.begin(), t.end() });
    }
    results.insert(result);
    std::shuffle(order.begin(), order.end(), random);
  }
  EXPECT_EQ(1u, results.size());
}

TEST(ConstrainedTriangulation, RandomPointsAndSegments)
{
  for (unsigned seed = 0; seed < 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.01, 3.99);
    std::vector<Vec3> more;
    for (int i = 0; i < 60; ++i)
    {
      more.push_back({ uniform(random), uniform(random), 0.0 });
    }
    const std::vector<Vec3> points = MakePoints(more);
    ConstrainedTriangulation patch(points, 2, 1);
    ASSERT_TRUE(patch.AddOutline({ 0, 1, 2, 3 }));
    for (Id i = 4; i < 64; ++i)
    {
      EXPECT_TRUE(patch.AddPoint(i));
    }
    std::vector<std::pair<Id, Id>> added;
    for (int i = 0; i < 40; ++i)
    {
      const Id a = static_cast<Id>(random() % 64);
      const Id b = static_cast<Id>(random() % 64);
      if (a != b && patch.AddSegment(a, b))
      {
        added.emplace_back(a, b);
      }
    }
    EXPECT_LT(5u, added.size());
    patch.Improve();
    for (const auto& segment : added)
    {
      EXPECT_TRUE(HasEdge(patch, segment.first, segment.second));
    }
    EXPECT_EQ(2u + 2u * 60u, patch.GetTriangles().size());
    ExpectValid(patch, points);
  }
}
