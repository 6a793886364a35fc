// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Threads.h
 * @brief Runs the same work on some threads. For loops there is ParallelLoop.h.
 *
 * Callers split their work so that results do not depend on the number of threads. Exceptions (only
 * std::bad_alloc can come) are thrown again on the calling thread when all threads have ended.
 */
#ifndef cdmThreads_h
#define cdmThreads_h

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace cdm
{
/** Number of threads that an option asks for; 0: one for each processor core. */
inline std::size_t GetNumberOfThreads(int option)
{
  return option > 0 ? static_cast<std::size_t>(option)
                    : std::max(1U, std::thread::hardware_concurrency());
}

/** Calls work(i) for i = 0 to count - 1 at the same time, i = 0 on the calling thread. */
template <typename Work>
void RunOnThreads(int count, const Work& work)
{
  std::vector<std::exception_ptr> exceptions(static_cast<std::size_t>(count));
  const auto guarded = [&work, &exceptions](int i)
  {
    try
    {
      work(i);
    }
    catch (...)
    {
      exceptions[static_cast<std::size_t>(i)] = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < count; ++i)
  {
    threads.emplace_back(guarded, i);
  }
  guarded(0);
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  for (const std::exception_ptr& exception : exceptions)
  {
    if (exception)
    {
      std::rethrow_exception(exception);
    }
  }
}
} // namespace cdm

#endif
