// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/HandOver.h"

#include <gtest/gtest.h>

#include <chrono>
#include <new>
#include <random>
#include <thread>
#include <vector>

using namespace cdm;

namespace
{
/** Numbers below count, with pauses of either thread at random. */
std::vector<int> HandOverNumbers(ThreadTeam* team, int count, unsigned seed)
{
  std::vector<int> used;
  std::mt19937 making(seed);
  std::mt19937 taking(seed + 1);
  const auto pause = [](std::mt19937& generator)
  {
    if (generator() % 50 == 0)
    {
      std::this_thread::sleep_for(std::chrono::microseconds(generator() % 300));
    }
  };
  HandOver<int>(
    team,
    [&](const auto& put)
    {
      for (int i = 0; i < count; ++i)
      {
        pause(making);
        EXPECT_TRUE(put(i));
      }
    },
    [&](int i)
    {
      pause(taking);
      used.push_back(i);
      return true;
    });
  return used;
}
} // namespace

TEST(HandOver, ItemsAreUsedInTheirOrder)
{
  ThreadTeam one(1);
  ThreadTeam three(3);
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    const int count = static_cast<int>(seed % 4) * 300;
    std::vector<int> expected;
    for (int i = 0; i < count; ++i)
    {
      expected.push_back(i);
    }
    for (ThreadTeam* const team : { static_cast<ThreadTeam*>(nullptr), &one, &three })
    {
      EXPECT_EQ(HandOverNumbers(team, count, seed), expected) << "seed " << seed;
    }
  }
}

TEST(HandOver, ItemsAreMadeOnTheCallingThread)
{
  ThreadTeam team(2);
  const std::thread::id caller = std::this_thread::get_id();
  HandOver<int>(
    &team,
    [&](const auto& put)
    {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      put(1);
    },
    [](int) { return true; });
}

TEST(HandOver, EndsWhenAnItemCannotBeUsed)
{
  ThreadTeam team(2);
  for (ThreadTeam* const threads : { static_cast<ThreadTeam*>(nullptr), &team })
  {
    int used = 0;
    bool isGoingOn = true;
    HandOver<int>(
      threads,
      [&](const auto& put)
      {
        while (isGoingOn)
        {
          isGoingOn = put(0);
        }
      },
      [&](int) { return ++used < 7; });
    EXPECT_EQ(used, 7);
  }
}

TEST(HandOver, ThrowsWhatEitherThreadThrows)
{
  ThreadTeam team(2);
  for (const bool isMaking : { true, false })
  {
    int used = 0;
    const auto run = [&]
    {
      HandOver<int>(
        &team,
        [&](const auto& put)
        {
          for (int i = 0; put(i); ++i)
          {
            if (isMaking && i == 100)
            {
              throw std::bad_alloc();
            }
          }
        },
        [&](int i)
        {
          ++used;
          if (!isMaking && i == 100)
          {
            throw std::bad_alloc();
          }
          return true;
        });
    };
    EXPECT_THROW(run(), std::bad_alloc);
    // If making fails before the second thread has begun, nothing is used.
    EXPECT_LE(used, 101);
    EXPECT_TRUE(isMaking || used == 101);
  }
}
