// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/BoxOctree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <set>
#include <vector>

using namespace cdm;

TEST(BoxOctree, FindsWhatASearchOfAllFinds)
{
  const auto seed = std::random_device{}();
  std::cout << "seed " << seed << "\n";
  RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto makeBox = [&]
  {
    // From points to boxes as large as the whole.
    const double size = std::pow(10.0, -6.0 * uniform(generator));
    Box box;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double extent = uniform(generator) < 0.2 ? 0.0 : size * uniform(generator);
      box.Low[axis] = (1.0 - extent) * uniform(generator);
      box.High[axis] = box.Low[axis] + extent;
    }
    return box;
  };
  constexpr Id capacity = 500;
  BoxOctree octree({ { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 } }, capacity);
  std::set<Id> present;
  std::vector<Id> found;
  for (int round = 0; round < 5000; ++round)
  {
    const Id id = std::uniform_int_distribution<Id>(0, capacity - 1)(generator);
    if (present.erase(id) > 0)
    {
      octree.Remove(id);
    }
    else
    {
      octree.Add(id, makeBox());
      present.insert(id);
    }
    const Box query = makeBox();
    std::vector<Id> expected;
    for (const Id other : present)
    {
      if (octree.GetBox(other).Overlaps(query))
      {
        expected.push_back(other);
      }
    }
    octree.Find(query, found);
    ASSERT_EQ(found, expected) << "round " << round;
  }
}

TEST(BoxOctree, BoxesAreClosed)
{
  BoxOctree octree({ { 0.0, 0.0, 0.0 }, { 4.0, 4.0, 4.0 } }, 3);
  octree.Add(0, { { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 } });
  octree.Add(1, { { 2.0, 2.0, 2.0 }, { 2.0, 2.0, 2.0 } });
  octree.Add(2, { { 0.0, 0.0, 0.0 }, { 4.0, 4.0, 4.0 } });
  std::vector<Id> found;
  octree.Find({ { 1.0, 1.0, 1.0 }, { 2.0, 2.0, 2.0 } }, found);
  EXPECT_EQ(found, (std::vector<Id>{ 0, 1, 2 }));
  octree.Find({ { 1.5, 1.5, 1.5 }, { 1.9, 1.9, 1.9 } }, found);
  EXPECT_EQ(found, (std::vector<Id>{ 2 }));
}
