// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThreadTeam.h
 * @brief Threads that stay, for stages with thousands of short pieces of parallel work.
 *
 * A new thread takes some 30 microseconds. Those of a team wait for the next piece of work: for a
 * few microseconds awake, then asleep. They start with the first piece of work and end with the
 * team.
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
   * The same for work that takes its pieces from a common list: when none is left, threads that have not
   * begun are not waited for, and not called. On a busy machine they may wake milliseconds later.
   */
  template <typename Work>
  void RunShared(int count, const Work& work)
  {
    this->RunTask(MakeTask(count, work), true);
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
  void RunTask(const Task& task, bool isShared);
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

/** The same with threads that end when the work is done. For loops there is ParallelLoop.h. */
template <typename Work>
void RunOnThreads(int count, const Work& work)
{
  ThreadTeam(count).Run(count, work);
}
} // namespace cdm

#endif
