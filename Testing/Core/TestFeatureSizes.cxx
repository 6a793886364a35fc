// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/FeatureSizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <random>

using namespace cdm;

namespace
{
StructuralEdge MakeEdge(Id a, Id b)
{
  StructuralEdge edge;
  edge.Points = { a, b };
  return edge;
}

/**
 * By sampling: an upper bound of the distance, good to the square of the spacing of the samples.
 */
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
  const FeatureSizes sizes(points, { MakeEdge(0, 1), MakeEdge(2, 3) });
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
  const FeatureSizes fan(points, { MakeEdge(0, 1), MakeEdge(0, 2) });
  EXPECT_DOUBLE_EQ(fan.Find({ 5.0, 0.0, 0.0 }, 100.0), 100.0);
  // The chain goes on from 1 to 3, which does not touch the edge from 0 to 2.
  const FeatureSizes chain(points, { MakeEdge(0, 1), MakeEdge(0, 2), MakeEdge(1, 3) });
  EXPECT_DOUBLE_EQ(chain.Find({ 5.0, 0.0, 0.0 }, 100.0), 5.0);
  EXPECT_DOUBLE_EQ(FeatureSizes({}, {}).Find({ 0.0, 0.0, 0.0 }, 2.0), 2.0);
}

TEST(FeatureSizes, LikeAllPairs)
{
  const auto seed = std::random_device{}();
  std::cout << "seed " << seed << "\n";
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
          edges.push_back(MakeEdge(a, b));
        }
      }
    }
    const FeatureSizes sizes(points, edges);
    const Vec3 position = makePoint();
    double smallest = 3.0;
    for (const StructuralEdge& first : edges)
    {
      for (const StructuralEdge& second : edges)
      {
        const bool areDisjoint = first.Points[0] != second.Points[0] &&
          first.Points[0] != second.Points[1] && first.Points[1] != second.Points[0] &&
          first.Points[1] != second.Points[1];
        if (areDisjoint)
        {
          smallest = std::min(smallest,
            std::max(SampleDistance(position, points[first.Points[0]], points[first.Points[1]]),
              SampleDistance(position, points[second.Points[0]], points[second.Points[1]])));
        }
      }
    }
    const double found = sizes.Find(position, 3.0);
    EXPECT_LE(found, smallest + 1e-12);
    EXPECT_GE(found, smallest - 1e-3);
  }
}
