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

/** Threads that come too late are left out; all blocks are done when the call returns. */
TEST(ThreadTeam, BlocksAreDoneOnce)
{
  std::mt19937_64 generator(2);
  ThreadTeam team(4);
  for (int task = 0; task < 5000; ++task)
  {
    const int threads = 1 + static_cast<int>(generator() % 4);
    const std::size_t size = generator() % 20;
    const std::size_t blockSize = 1 + generator() % 3;
    std::vector<int> done(20, 0);
    std::vector<std::thread::id> ids(4);
    std::atomic<int> wrong{ 0 };
    team.RunBlocks(threads, size, blockSize,
      [&](std::size_t begin, std::size_t end, int thread)
      {
        wrong += thread < 0 || thread >= threads || begin >= end || end - begin > blockSize ||
          begin % blockSize != 0;
        // No two threads have the same number.
        std::thread::id& id = ids[static_cast<std::size_t>(thread)];
        wrong += id != std::thread::id() && id != std::this_thread::get_id();
        id = std::this_thread::get_id();
        for (std::size_t i = begin; i < end; ++i)
        {
          ++done[i];
        }
      });
    EXPECT_EQ(wrong, 0);
    for (std::size_t i = 0; i < 20; ++i)
    {
      EXPECT_EQ(done[i], i < size ? 1 : 0);
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

/** A second thread was started where one was asked for, and took processor time while it waited. */
TEST(ThreadTeam, BlocksUseNoMoreThreadsThanTheTeamHas)
{
  ThreadTeam team(1);
  const std::thread::id caller = std::this_thread::get_id();
  for (int run = 0; run < 100; ++run)
  {
    team.RunBlocks(2, 2, 1,
      [&](std::size_t, std::size_t, int thread)
      {
        EXPECT_EQ(thread, 0);
        EXPECT_EQ(std::this_thread::get_id(), caller);
        std::this_thread::sleep_for(std::chrono::microseconds(50));
      });
  }
}

/** The calling thread does both where the other one is late, or where there is none. */
TEST(ThreadTeam, BothAreDoneOnce)
{
  std::mt19937_64 generator(1);
  const std::thread::id caller = std::this_thread::get_id();
  for (const int threads : { 1, 2, 4 })
  {
    ThreadTeam team(threads);
    for (int run = 0; run < 1000; ++run)
    {
      int first = 0;
      int second = 0;
      team.RunBoth(
        [&]
        {
          EXPECT_EQ(std::this_thread::get_id(), caller);
          ++first;
        },
        [&]
        {
          EXPECT_TRUE(threads > 1 || std::this_thread::get_id() == caller);
          ++second;
        });
      EXPECT_EQ(first, 1);
      EXPECT_EQ(second, 1);
      if (generator() % 100 == 0)
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  }
}
