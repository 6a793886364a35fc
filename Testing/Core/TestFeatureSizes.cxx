// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/FeatureSizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <utility>

using namespace cdm;

namespace
{
StructuralEdge MakeStructuralEdge(Id a, Id b)
{
  StructuralEdge edge;
  edge.Points = { a, b };
  return edge;
}

/** Distance by sampling: an upper bound, good to the square of the spacing of the samples. */
double SampleDistance(const Vec3& position, const Vec3& a, const Vec3& b)
{
  double distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 1000; ++i)
  {
    distance = std::min(distance, Distance(position, a + 1e-3 * i * (b - a)));
  }
  return distance;
}
} // namespace

TEST(FeatureSizes, OfParallelEdges)
{
  const std::vector<Vec3> points{ { 0.0, 0.0, 0.0 }, { 10.0, 0.0, 0.0 }, { 0.0, 0.5, 0.0 },
    { 10.0, 0.5, 0.0 } };
  const FeatureSizes sizes(points, {}, {}, { MakeStructuralEdge(0, 1), MakeStructuralEdge(2, 3) });
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 0.0, 0.0 }, 10.0), 0.5);
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 0.25, 0.0 }, 10.0), 0.25);
  EXPECT_DOUBLE_EQ(sizes.Find({ 13.0, -3.5, 0.0 }, 10.0), 5.0);
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 0.0, 0.0 }, 0.3), 0.3);
  EXPECT_DOUBLE_EQ(sizes.Find({ 50.0, 50.0, 50.0 }, 0.3), 0.3);
}

TEST(FeatureSizes, EdgesWithACommonEndDoNotCount)
{
  const std::vector<Vec3> points{ { 0.0, 0.0, 0.0 }, { 10.0, 0.0, 0.0 }, { 10.0, 0.1, 0.0 },
    { 20.0, 0.0, 0.0 } };
  const FeatureSizes fan(points, {}, {}, { MakeStructuralEdge(0, 1), MakeStructuralEdge(0, 2) });
  EXPECT_DOUBLE_EQ(fan.Find({ 5.0, 0.0, 0.0 }, 100.0), 100.0);
  // The chain goes on from 1 to 3, which does not touch the edge from 0 to 2.
  const FeatureSizes chain(points, {}, {},
    { MakeStructuralEdge(0, 1), MakeStructuralEdge(0, 2), MakeStructuralEdge(1, 3) });
  EXPECT_DOUBLE_EQ(chain.Find({ 5.0, 0.0, 0.0 }, 100.0), 5.0);
  EXPECT_DOUBLE_EQ(FeatureSizes({}, {}, {}, {}).Find({ 0.0, 0.0, 0.0 }, 2.0), 2.0);
}

TEST(FeatureSizes, OfALayerItsThickness)
{
  // A plate, 10 by 10 by 0.5: two triangles on each of its six sides.
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.push_back({ i % 2 * 10.0, i / 2 % 2 * 10.0, i / 4 * 0.5 });
  }
  const int sides[6][4] = { { 0, 1, 3, 2 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 3, 7, 6 },
    { 0, 2, 6, 4 }, { 1, 3, 7, 5 } };
  std::vector<TriangleIds> triangles;
  std::vector<Id> facets;
  std::vector<StructuralEdge> edges;
  for (int side = 0; side < 6; ++side)
  {
    const int(&ids)[4] = sides[side];
    triangles.push_back({ ids[0], ids[1], ids[2] });
    triangles.push_back({ ids[0], ids[2], ids[3] });
    facets.insert(facets.end(), { side, side });
  }
  for (Id a = 0; a < 8; ++a)
  {
    for (Id axis : { 1, 2, 4 })
    {
      if ((a & axis) == 0)
      {
        edges.push_back(MakeStructuralEdge(a, a + axis));
      }
    }
  }
  const FeatureSizes sizes(points, triangles, facets, edges);
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 5.0, 0.0 }, 4.0), 0.5);
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 5.0, 0.25 }, 4.0), 0.25);
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 5.0, 1.5 }, 4.0), 1.5);
  // A side and the two that it touches are not far from each other: that is no size.
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 0.1, 0.0 }, 4.0), 0.5);
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 0.1, 0.0 }, 0.4), 0.4);
  // What is closer than a hundredth of the limit is not to be filled with well shaped elements.
  EXPECT_DOUBLE_EQ(sizes.Find({ 5.0, 5.0, 0.0 }, 60.0), 5.0);
}

/** Time and memory do not grow with the square of the facets at a point. */
TEST(FeatureSizes, ManyFacetsAtOnePoint)
{
  constexpr Id count = 100000;
  std::vector<Vec3> points{ { 0.0, 0.0, 1.0 } };
  std::vector<TriangleIds> triangles;
  std::vector<Id> facets;
  for (Id i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * i / count;
    points.push_back({ std::cos(angle), std::sin(angle), 0.0 });
    triangles.push_back({ 0, i + 1, (i + 1) % count + 1 });
    facets.push_back(i);
  }
  const FeatureSizes sizes(points, triangles, facets, {});
  EXPECT_DOUBLE_EQ(sizes.Find({ 0.0, 0.0, 1.0 }, 0.5), 0.5);
  EXPECT_DOUBLE_EQ(sizes.Find({ 0.01, 0.0, 1.0 }, 0.5), 0.5);
}

namespace
{
/** Compares with what all pairs of random features give. */
void CompareWithAllPairs(std::uint64_t seed)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  const auto makePoint = [&] {
    return Vec3{ coordinate(generator), coordinate(generator), coordinate(generator) };
  };
  for (int repetition = 0; repetition < 20; ++repetition)
  {
    std::vector<Vec3> points(12);
    std::generate(points.begin(), points.end(), makePoint);
    std::vector<StructuralEdge> edges;
    for (Id a = 0; a < 12; ++a)
    {
      for (Id b = a + 1; b < 12; ++b)
      {
        if (coordinate(generator) < 0.2)
        {
          edges.push_back(MakeStructuralEdge(a, b));
        }
      }
    }
    // Triangles of four facets, which may be in pieces.
    std::vector<TriangleIds> triangles;
    std::vector<Id> facets;
    for (Id t = 0; t < 6; ++t)
    {
      std::array<Id, 12> order;
      std::iota(order.begin(), order.end(), 0);
      std::shuffle(order.begin(), order.end(), generator);
      triangles.push_back({ order[0], order[1], order[2] });
      facets.push_back(t % 4);
    }
    const FeatureSizes sizes(points, triangles, facets, edges);
    const Vec3 position = makePoint();
    // Of edges and facets: their points, and how far away they are.
    std::vector<std::pair<std::set<Id>, double>> features(4, { {}, 9.0 });
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      auto& [ids, distance] = features[facets[t]];
      const TriangleIds& corners = triangles[t];
      ids.insert(corners.begin(), corners.end());
      distance = std::min(distance,
        GetDistanceToTriangle(
          position, points[corners[0]], points[corners[1]], points[corners[2]]));
    }
    for (const StructuralEdge& edge : edges)
    {
      const EdgeIds& ends = edge.Points;
      features.push_back(
        { { ends[0], ends[1] }, SampleDistance(position, points[ends[0]], points[ends[1]]) });
    }
    // What is closer than a hundredth of the limit is left out; sampled distances are true to
    // 0.001.
    constexpr double limit = 3.0;
    constexpr double precision = 1e-3;
    double smallest = limit;
    double smallestForSure = limit;
    for (const auto& [first, firstDistance] : features)
    {
      for (const auto& [second, secondDistance] : features)
      {
        if (std::none_of(
              first.begin(), first.end(), [&ids = second](Id id) { return ids.count(id) > 0; }))
        {
          const double distance = std::max(firstDistance, secondDistance);
          smallest = distance > 0.01 * limit - precision ? std::min(smallest, distance) : smallest;
          smallestForSure = distance > 0.01 * limit + precision
            ? std::min(smallestForSure, distance)
            : smallestForSure;
        }
      }
    }
    const double found = sizes.Find(position, limit);
    EXPECT_LE(found, smallestForSure + 1e-12);
    EXPECT_GE(found, smallest - precision);
  }
}
} // namespace

TEST(FeatureSizes, LikeAllPairs)
{
  const auto seed = std::random_device{}();
  std::cout << "seed " << seed << "\n";
  CompareWithAllPairs(seed);
}

/** An edge and a facet 0.0229 away, which is less than a hundredth of the limit. */
TEST(FeatureSizes, LikeAllPairsThatAreNotTooClose)
{
  CompareWithAllPairs(2741799773);
}
