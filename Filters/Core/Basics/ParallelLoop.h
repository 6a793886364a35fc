// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelLoop.h
 * @brief A loop over independent items on several threads, with progress and abort.
 *
 * The items are cut into blocks of equal size, whatever the number of threads; each thread takes
 * the next block until none is left. The calling thread works too, and alone reports progress and
 * asks for aborts. Results are the same for any number of threads if what a block writes depends on
 * its items only, and no two blocks write to the same place.
 *
 * ForAll(), ForEach() and HoldForAll() are for loops too short to report progress or to be aborted.
 */
#ifndef cdmParallelLoop_h
#define cdmParallelLoop_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/ThreadTeam.h"

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace cdm
{
struct ParallelLoopOptions
{
  /** 0: one for each processor core. */
  int NumberOfThreads = 1;
  /** Items in a block. At least 1. */
  std::size_t BlockSize = 2048;
};

inline std::size_t GetNumberOfBlocks(std::size_t count, const ParallelLoopOptions& options)
{
  return (count + options.BlockSize - 1) / options.BlockSize;
}

/**
 * Calls body(begin, end, block) for every block of [0, count); false if aborted. An exception of
 * the body ends the loop and is thrown again from here.
 */
template <typename Body>
bool ParallelLoop(std::size_t count, const ParallelLoopOptions& options,
  const ExecutionContext& context, const char* activity, Body&& body)
{
  const std::size_t numberOfBlocks = GetNumberOfBlocks(count, options);
  std::atomic<std::size_t> next{ 0 };
  std::atomic<bool> isStopped{ false };
  bool isAborted = false;
  const std::size_t wanted = std::min(GetNumberOfThreads(options.NumberOfThreads), numberOfBlocks);
  RunOnThreads(static_cast<int>(std::max<std::size_t>(1, wanted)),
    [&](int thread)
    {
      for (;;)
      {
        const std::size_t block = next++;
        if (thread == 0)
        {
          const double done = static_cast<double>(std::min(block, numberOfBlocks));
          if (!context.Continue(numberOfBlocks == 0 ? 1.0 : done / numberOfBlocks, activity))
          {
            isAborted = true;
            isStopped = true;
          }
        }
        if (block >= numberOfBlocks || isStopped)
        {
          return;
        }
        const std::size_t begin = block * options.BlockSize;
        try
        {
          body(begin, std::min(begin + options.BlockSize, count), block);
        }
        catch (...)
        {
          isStopped = true;
          throw;
        }
      }
    });
  return !isAborted;
}

/**
 * Large blocks of the numbers below size, because threads that write close to each other in memory
 * wait for each other.
 */
inline ParallelLoopOptions MakeLargeBlocks(std::size_t size, int numberOfThreads)
{
  return { numberOfThreads,
    std::max(std::size_t(1) << 15, size / (8 * GetNumberOfThreads(numberOfThreads)) + 1) };
}

/** Calls work(begin, end) for large blocks of the numbers below size. */
template <typename Work>
void ForAll(std::size_t size, int numberOfThreads, const Work& work)
{
  ParallelLoop(size, MakeLargeBlocks(size, numberOfThreads), {}, "",
    [&work](std::size_t begin, std::size_t end, std::size_t) { work(begin, end); });
}

/** Calls work(i) for all numbers below size. */
template <typename Work>
void ForEach(std::size_t size, int numberOfThreads, const Work& work)
{
  ForAll(size, numberOfThreads,
    [&work](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        work(i);
      }
    });
}

/** Whether a condition holds for all numbers below size. */
template <typename Condition>
bool HoldForAll(std::size_t size, int numberOfThreads, const Condition& condition)
{
  std::atomic<bool> isTrue{ true };
  ForAll(size, numberOfThreads,
    [&](std::size_t begin, std::size_t end)
    {
      bool isTrueHere = true;
      for (std::size_t i = begin; i < end && isTrueHere; ++i)
      {
        isTrueHere = condition(i);
      }
      if (!isTrueHere)
      {
        isTrue = false;
      }
    });
  return isTrue;
}
} // namespace cdm

#endif
