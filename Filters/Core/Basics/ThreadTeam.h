// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThreadTeam.h
 * @brief Threads that stay, for stages with thousands of short pieces of parallel work.
 *
 * A new thread takes some 30 microseconds. Those of a team wait for the next piece of work: for half
 * a millisecond awake, then asleep (LookFor.h). They start with the first piece of work and end with
 * the team.
 *
 * Exceptions (only std::bad_alloc can come) are thrown again on the calling thread when all threads
 * are done.
 */
#ifndef cdmThreadTeam_h
#define cdmThreadTeam_h

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
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

/**
 * What different threads write to lies so many bytes apart: processors fetch lines of memory in
 * pairs, and where two share a line each waits for what the other one writes. Searches for slivers
 * that lay side by side in a list took 8 % longer.
 */
constexpr std::size_t SeparateLines = 128;

class ThreadTeam
{
public:
  /** @param numberOfThreads at least 1: the calling thread is one of them */
  explicit ThreadTeam(int numberOfThreads) : NumberOfThreads(numberOfThreads) {}
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int GetNumberOfThreads() const { return this->NumberOfThreads; }

  /**
   * Calls work(i) for i = 0 to count - 1 at the same time, i = 0 on the calling thread. Work must
   * not use the team itself.
   * @param count at most the number of threads
   */
  template <typename Work>
  void Run(int count, const Work& work)
  {
    this->RunTask(MakeTask(count, work), false);
  }
  /**
   * Calls work(begin, end, thread) for blocks of the numbers below size; each thread takes the next
   * block until none is left. Threads that have not begun by then are not waited for: on a busy
   * machine they may wake milliseconds later.
   * @param most threads work at the same time, and no more than the team has
   */
  template <typename Work>
  void RunBlocks(int most, std::size_t size, std::size_t blockSize, const Work& work)
  {
    const std::size_t count = (size + blockSize - 1) / blockSize;
    std::atomic<std::size_t> next{ 0 };
    const auto takeBlocks = [&](int thread)
    {
      for (std::size_t block = next++; block < count; block = next++)
      {
        work(block * blockSize, std::min(size, (block + 1) * blockSize), thread);
      }
    };
    const int allowed = std::min(most, this->NumberOfThreads);
    const auto threads = std::min<std::size_t>(static_cast<std::size_t>(allowed), count);
    this->RunTask(MakeTask(static_cast<int>(threads), takeBlocks), true);
  }
  /**
   * Calls first() on the calling thread, and second() at the same time on another one. If no other
   * thread has begun when first() is done, the calling thread does both. Neither may use the team
   * itself.
   */
  template <typename First, typename Second>
  void RunBoth(const First& first, const Second& second)
  {
    std::atomic<bool> hasBegun{ false };
    const auto work = [&](int thread)
    {
      if (thread == 0)
      {
        first();
      }
      if (!hasBegun.exchange(true))
      {
        second();
      }
    };
    this->RunTask(MakeTask(std::min(2, this->NumberOfThreads), work), true);
  }

private:
  struct Task
  {
    int Count;
    void (*Call)(const void* what, int i);
    const void* What;
  };
  template <typename Work>
  static Task MakeTask(int count, const Work& work)
  {
    return { count, [](const void* what, int i) { (*static_cast<const Work*>(what))(i); }, &work };
  }

  /** A thread, and what it waits for: only those are woken that have something to do. */
  struct Member
  {
    std::thread Thread;
    std::condition_variable HasTask;
    /** Whether it has been given the current task, and has not begun. Changes with the lock only. */
    std::atomic<bool> IsGiven{ false };
  };
  /** @param mayBeLate whether threads that have not begun when the caller is done are left out */
  void RunTask(const Task& task, bool mayBeLate);
  void RunGuarded(const Task& task, int i);
  void Serve(Member& member, int i);

  const int NumberOfThreads;
  /** Thread i is member i - 1. */
  std::vector<std::unique_ptr<Member>> Members;
  std::vector<std::exception_ptr> Exceptions;
  std::mutex Mutex;
  std::condition_variable IsDone;
  Task Current{};
  /** Threads that have not finished it. */
  std::atomic<int> Open{ 0 };
  std::atomic<bool> IsEnding{ false };
};

/**
 * Does what ThreadTeam::Run() does, with threads that end with the work. For loops there is
 * ParallelLoop.h.
 */
template <typename Work>
void RunOnThreads(int count, const Work& work)
{
  ThreadTeam(count).Run(count, work);
}
} // namespace cdm

#endif
