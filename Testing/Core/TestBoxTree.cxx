// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/BoxTree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace cdm;

TEST(BoxTree, FindsTheNearest)
{
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto pick = [&] {
    return Vec3{ uniform(generator), uniform(generator), uniform(generator) };
  };
  std::vector<Vec3> points;
  std::vector<Box> boxes;
  for (int i = 0; i < 500; ++i)
  {
    points.push_back(pick());
    boxes.push_back(Box::MakeAround(points.back(), 0.0));
  }
  const BoxTree tree(boxes);
  for (int i = 0; i < 500; ++i)
  {
    const Vec3 p = pick();
    double expected = std::numeric_limits<double>::infinity();
    for (const Vec3& point : points)
    {
      expected = std::min(expected, Distance(p, point));
    }
    const auto getDistance = [&](Id id) { return Distance(p, points[id]); };
    EXPECT_EQ(tree.FindDistance(p, 2.0, getDistance), expected);
    EXPECT_EQ(tree.FindDistance(p, 0.5 * expected, getDistance), 0.5 * expected);
  }
  EXPECT_EQ(BoxTree({}).FindDistance({}, 0.5, [](Id) { return 0.0; }), 0.5);
}

TEST(BoxTree, VisitsEachPairOnce)
{
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const int count : { 0, 1, 4, 5, 300 })
  {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i)
    {
      // On a grid, so that many touch; a few are as large as the whole, one comes twice.
      const double size = i % 50 == 0 ? 1.0 : 0.1;
      Box box;
      for (int axis = 0; axis < 3; ++axis)
      {
        box.Low[axis] = 0.1 * std::floor(10.0 * uniform(generator));
        box.High[axis] = box.Low[axis] + size;
      }
      boxes.push_back(i == 7 ? boxes[3] : box);
    }
    std::vector<std::pair<Id, Id>> expected;
    for (Id i = 0; i < count; ++i)
    {
      for (Id j = i + 1; j < count; ++j)
      {
        if (boxes[i].Overlaps(boxes[j]))
        {
          expected.emplace_back(i, j);
        }
      }
    }
    std::vector<std::pair<Id, Id>> found;
    double last = 0.0;
    const bool isDone = BoxTree(boxes).VisitPairs([&](Id a, Id b)
      { found.emplace_back(std::min(a, b), std::max(a, b)); },
      [&](double progress)
      {
        EXPECT_GE(progress, last);
        EXPECT_LE(progress, 1.0);
        last = progress;
        return true;
      });
    EXPECT_TRUE(isDone);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(BoxTree, StopsVisitingPairsWhenToldSo)
{
  const BoxTree tree(std::vector<Box>(3000, Box::MakeAround({}, 1.0)));
  int visits = 0;
  int questions = 0;
  EXPECT_FALSE(tree.VisitPairs([&](Id, Id) { ++visits; }, [&](double) { return ++questions < 3; }));
  EXPECT_EQ(questions, 3);
  EXPECT_LT(visits, 3000 * 3000 / 4);
}
