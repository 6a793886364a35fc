// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/ThreadTeam.h"

namespace cdm
{
namespace
{
/** How often a thread looks for what it waits for before it falls asleep. */
constexpr int Looks = 100;

template <typename Condition>
bool LookFor(const Condition& condition)
{
  for (int i = 0; i < Looks; ++i)
  {
    if (condition())
    {
      return true;
    }
    std::this_thread::yield();
  }
  return false;
}
} // namespace

ThreadTeam::~ThreadTeam()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->IsEnding = true;
  }
  this->HasTask.notify_all();
  for (std::thread& thread : this->Threads)
  {
    thread.join();
  }
}

void ThreadTeam::RunGuarded(const Task& task, int i)
{
  try
  {
    task.Call(task.What, i);
  }
  catch (...)
  {
    this->Exceptions[static_cast<std::size_t>(i)] = std::current_exception();
  }
}

void ThreadTeam::RunTask(const Task& task)
{
  if (task.Count < 1)
  {
    return;
  }
  this->Exceptions.assign(static_cast<std::size_t>(task.Count), nullptr);
  if (task.Count > 1)
  {
    // New threads are in none of the tasks so far: these had fewer.
    while (static_cast<int>(this->Threads.size()) + 1 < task.Count)
    {
      const int i = static_cast<int>(this->Threads.size()) + 1;
      this->Threads.emplace_back([this, i] { this->Serve(i); });
    }
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Current = task;
      this->Open = task.Count - 1;
      ++this->Number;
    }
    this->HasTask.notify_all();
  }
  this->RunGuarded(task, 0);
  const auto isDone = [this] { return this->Open == 0; };
  if (task.Count > 1 && !LookFor(isDone))
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->IsDone.wait(lock, isDone);
  }
  for (const std::exception_ptr& exception : this->Exceptions)
  {
    if (exception)
    {
      std::rethrow_exception(exception);
    }
  }
}

void ThreadTeam::Serve(int i)
{
  std::uint64_t last = 0;
  const auto isAwaited = [this, &last] { return this->IsEnding || this->Number != last; };
  for (;;)
  {
    LookFor(isAwaited);
    Task task;
    {
      std::unique_lock<std::mutex> lock(this->Mutex);
      this->HasTask.wait(lock, isAwaited);
      if (this->IsEnding)
      {
        return;
      }
      task = this->Current;
      last = this->Number;
    }
    if (i < task.Count)
    {
      this->RunGuarded(task, i);
      if (--this->Open == 0)
      {
        // With the lock: the caller must not fall asleep between its last look and this.
        const std::lock_guard<std::mutex> lock(this->Mutex);
        this->IsDone.notify_one();
      }
    }
  }
}
} // namespace cdm
