// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelLoop.h
 * @brief A loop over independent items on several threads, with progress and abort.
 *
 * The items are cut into blocks of equal size, whatever the number of threads; each thread takes the
 * next block until none is left. The calling thread works too, and alone reports progress and asks
 * for aborts. Results are the same for any number of threads if what a block writes depends on its
 * items only, and no two blocks write to the same place.
 */
#ifndef cdmParallelLoop_h
#define cdmParallelLoop_h

#include "ExecutionContext.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace cdm
{
struct ParallelLoopOptions
{
  /** 0: one for each processor core. */
  int NumberOfThreads = 0;
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
  std::exception_ptr failure;
  std::mutex failureMutex;

  const auto runBlock = [&]
  {
    const std::size_t block = next++;
    if (block >= numberOfBlocks || isStopped)
    {
      return false;
    }
    try
    {
      const std::size_t begin = block * options.BlockSize;
      body(begin, std::min(begin + options.BlockSize, count), block);
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(failureMutex);
      failure = std::current_exception();
      isStopped = true;
    }
    return true;
  };

  const std::size_t wanted = options.NumberOfThreads > 0
    ? static_cast<std::size_t>(options.NumberOfThreads)
    : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::thread> threads;
  const auto join = [&threads]
  {
    for (std::thread& thread : threads)
    {
      thread.join();
    }
  };
  bool isAborted = false;
  try
  {
    for (std::size_t i = 1; i < std::min(wanted, numberOfBlocks); ++i)
    {
      threads.emplace_back(
        [&runBlock]
        {
          while (runBlock())
            ;
        });
    }
    do
    {
      const std::size_t done = std::min(next.load(), numberOfBlocks);
      if (!context.Continue(numberOfBlocks == 0 ? 1.0 : double(done) / numberOfBlocks, activity))
      {
        isAborted = true;
        isStopped = true;
      }
    } while (runBlock());
  }
  catch (...)
  {
    isStopped = true;
    join();
    throw;
  }
  join();
  if (failure)
  {
    std::rethrow_exception(failure);
  }
  return !isAborted;
}
} // namespace cdm

#endif
