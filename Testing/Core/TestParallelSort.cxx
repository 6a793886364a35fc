// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/ParallelSort.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

using namespace cdm;

TEST(ParallelSort, DoesWhatStdSortDoes)
{
  std::mt19937_64 random(1);
  for (const std::size_t size : { 0u, 1u, 1000u, 32768u, 300000u })
  {
    // Many equal items, few, only one kind, and some that are in order.
    for (const std::uint64_t range : { std::uint64_t(5), std::uint64_t(1) << 40, std::uint64_t(1) })
    {
      for (const bool isOrdered : { false, true })
      {
        std::vector<std::uint64_t> items(size);
        for (std::size_t i = 0; i < size; ++i)
        {
          items[i] = isOrdered ? i * range / 1000 : random() % range;
        }
        std::vector<std::uint64_t> expected = items;
        std::sort(expected.begin(), expected.end());
        for (const int threads : { 1, 2, 3, 8 })
        {
          std::vector<std::uint64_t> sorted = items;
          ASSERT_TRUE(ParallelSort(sorted, threads, {}, "", std::less<>()));
          ASSERT_EQ(sorted, expected) << size << " items, " << threads << " threads";
        }
      }
    }
  }
}

TEST(ParallelSort, Aborts)
{
  std::vector<int> items(1000000, 3);
  const ExecutionContext context([](double, const char*) {}, [] { return true; });
  for (const int threads : { 1, 2 })
  {
    EXPECT_FALSE(ParallelSort(items, threads, context, "Sorting", std::less<>()));
  }
}
