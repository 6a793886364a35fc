// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/ThreadTeam.h"

#include "Core/Basics/LookFor.h"

#include <utility>

namespace cdm
{
ThreadTeam::~ThreadTeam()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->IsEnding = true;
  }
  for (const std::unique_ptr<Member>& member : this->Members)
  {
    member->HasTask.notify_one();
  }
  for (const std::unique_ptr<Member>& member : this->Members)
  {
    member->Thread.join();
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

void ThreadTeam::RunTask(const Task& task, bool mayBeLate)
{
  if (task.Count < 1)
  {
    return;
  }
  this->Exceptions.assign(static_cast<std::size_t>(task.Count), nullptr);
  const auto others = static_cast<std::size_t>(task.Count - 1);
  while (this->Members.size() < others)
  {
    auto member = std::make_unique<Member>();
    const int i = static_cast<int>(this->Members.size()) + 1;
    member->Thread = std::thread([this, &own = *member, i] { this->Serve(own, i); });
    this->Members.push_back(std::move(member));
  }
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Current = task;
    this->Open = task.Count - 1;
    for (std::size_t i = 0; i < others; ++i)
    {
      this->Members[i]->IsGiven = true;
    }
  }
  for (std::size_t i = 0; i < others; ++i)
  {
    this->Members[i]->HasTask.notify_one();
  }
  this->RunGuarded(task, 0);
  if (mayBeLate)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    for (std::size_t i = 0; i < others; ++i)
    {
      if (this->Members[i]->IsGiven.exchange(false))
      {
        --this->Open;
      }
    }
  }
  const auto isDone = [this] { return this->Open == 0; };
  if (!LookFor(isDone))
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

void ThreadTeam::Serve(Member& member, int i)
{
  const auto isAwaited = [&] { return this->IsEnding || member.IsGiven; };
  for (;;)
  {
    LookFor(isAwaited);
    Task task;
    {
      std::unique_lock<std::mutex> lock(this->Mutex);
      member.HasTask.wait(lock, isAwaited);
      if (this->IsEnding)
      {
        return;
      }
      member.IsGiven = false;
      task = this->Current;
    }
    this->RunGuarded(task, i);
    if (--this->Open == 0)
    {
      // The lock keeps the caller from falling asleep between its last look at Open and this notice.
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->IsDone.notify_one();
    }
  }
}
} // namespace cdm
