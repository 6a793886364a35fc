// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/RawVector.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <numeric>

using namespace cdm;

/** Where the range begins and ends within pages, the other elements of these stay. */
TEST(RawVector, ReleasesOnlyTheMemoryOfTheRange)
{
  for (const std::size_t size : { std::size_t(10), std::size_t(1) << 21 })
  {
    for (const std::size_t begin : { std::size_t(0), std::size_t(1), size / 3, size / 2 })
    {
      for (const std::size_t end : { begin, begin + 1, size - 1, size })
      {
        RawVector<int> items(size);
        std::iota(items.begin(), items.end(), 0);
        ReleaseMemory(items, begin, end);
        ASSERT_EQ(items.size(), size);
        for (std::size_t i = 0; i < size; ++i)
        {
          if (i < begin || i >= end)
          {
            ASSERT_EQ(items[i], static_cast<int>(i)) << size << ", " << begin << ", " << end;
          }
        }
        // It may be used again.
        std::iota(items.begin(), items.end(), 1);
        EXPECT_EQ(items[begin], static_cast<int>(begin) + 1);
      }
    }
  }
}
