// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/ThreadTeam.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <new>
#include <random>
#include <thread>
#include <vector>

using namespace cdm;

TEST(ThreadTeam, EachNumberIsCalledOnce)
{
  ThreadTeam team(5);
  EXPECT_EQ(team.GetNumberOfThreads(), 5);
  for (const int count : { 0, 1, 2, 5, 3, 1, 4, 5 })
  {
    std::vector<std::atomic<int>> calls(5);
    team.Run(count, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
    for (int i = 0; i < 5; ++i)
    {
      EXPECT_EQ(calls[static_cast<std::size_t>(i)], i < count ? 1 : 0) << i << " of " << count;
    }
  }
}

TEST(ThreadTeam, FirstNumberIsOnTheCallingThread)
{
  ThreadTeam team(2);
  std::vector<std::thread::id> ids(2);
  team.Run(2, [&](int i) { ids[static_cast<std::size_t>(i)] = std::this_thread::get_id(); });
  EXPECT_EQ(ids[0], std::this_thread::get_id());
  EXPECT_NE(ids[1], std::this_thread::get_id());
}

/** Some tasks come while the threads are still awake, some when they have fallen asleep. */
TEST(ThreadTeam, TasksFollowEachOther)
{
  std::mt19937_64 generator(1);
  ThreadTeam team(4);
  int expected = 0;
  std::atomic<int> sum{ 0 };
  for (int task = 0; task < 5000; ++task)
  {
    const int count = static_cast<int>(generator() % 5);
    expected += count * task;
    team.Run(count, [&](int) { sum += task; });
    EXPECT_EQ(sum, expected);
    if (generator() % 100 == 0)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

/** Threads that come too late are left out; all pieces are done when the call returns. */
TEST(ThreadTeam, SharedWorkIsDone)
{
  std::mt19937_64 generator(2);
  ThreadTeam team(4);
  for (int task = 0; task < 5000; ++task)
  {
    const int count = 1 + static_cast<int>(generator() % 4);
    const int pieces = static_cast<int>(generator() % 20);
    std::vector<int> done(20, 0);
    std::vector<std::atomic<int>> calls(4);
    std::atomic<int> next{ 0 };
    team.RunShared(count,
      [&](int i)
      {
        ++calls[static_cast<std::size_t>(i)];
        for (int piece = next++; piece < pieces; piece = next++)
        {
          ++done[static_cast<std::size_t>(piece)];
        }
      });
    for (int piece = 0; piece < 20; ++piece)
    {
      EXPECT_EQ(done[static_cast<std::size_t>(piece)], piece < pieces ? 1 : 0);
    }
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_LE(calls[static_cast<std::size_t>(i)], i < count ? 1 : 0);
    }
  }
}

TEST(ThreadTeam, ExceptionsReachTheCaller)
{
  ThreadTeam team(3);
  for (const int thrower : { 0, 1, 2 })
  {
    std::atomic<int> calls{ 0 };
    const auto work = [&](int i)
    {
      ++calls;
      if (i == thrower)
      {
        throw std::bad_alloc();
      }
    };
    EXPECT_THROW(team.Run(3, work), std::bad_alloc);
    EXPECT_EQ(calls, 3);
  }
  int calls = 0;
  team.Run(1, [&](int) { ++calls; });
  EXPECT_EQ(calls, 1);
}
