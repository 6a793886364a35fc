// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExecutionContext.h
 * @brief What a running stage has from its caller: progress, abort, time and threads.
 */
#ifndef cdmExecutionContext_h
#define cdmExecutionContext_h

#include "Core/Basics/ThreadTeam.h"

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace cdm
{
/** Loops of steps of some microseconds, or less, call Continue() once in so many. */
constexpr std::size_t StepsBetweenChecks = 1024;

/** A time that may be set: the earliest one counts. */
class Deadline
{
public:
  /** @param seconds from now on; 0: none */
  void SetAfter(double seconds)
  {
    if (seconds > 0.0)
    {
      // Longer than a century is for ever, and would not fit.
      constexpr double longest = 3e9;
      const std::chrono::duration<double> span(seconds < longest ? seconds : longest);
      const Clock::time_point time =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(span);
      this->Time = this->Time < time ? this->Time : time;
    }
  }
  bool IsOver() const { return this->Time != Never && Clock::now() >= this->Time; }

private:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::time_point Never = Clock::time_point::max();
  Clock::time_point Time = Never;
};

/**
 * Stages call Continue() in every loop that can last longer than 50 ms. A default constructed
 * context neither reports nor aborts, and has one thread. Continue() belongs on the thread that
 * called the stage. No result depends on the number of threads.
 *
 * A context may have a time limit. Refinements that find it over end with what they have; all else
 * goes on, so that there is a result.
 */
class ExecutionContext
{
public:
  /** Called with the finished fraction, from 0 to 1, and a short text: what is being done. */
  using ProgressFunction = std::function<void(double fraction, const char* activity)>;
  /** Returns true if the stage is to stop as soon as possible. */
  using AbortFunction = std::function<bool()>;

  ExecutionContext() = default;
  ExecutionContext(ProgressFunction progress, AbortFunction abort, int numberOfThreads = 1)
    : Progress(std::move(progress)), Abort(std::move(abort))
  {
    const int count = static_cast<int>(cdm::GetNumberOfThreads(numberOfThreads));
    this->Threads = count > 1 ? std::make_shared<ThreadTeam>(count) : nullptr;
  }
  /** A silent context that cannot be aborted. Threads: 0: one for each processor core. */
  explicit ExecutionContext(int numberOfThreads) : ExecutionContext({}, {}, numberOfThreads) {}

  /** At least 1. */
  int GetNumberOfThreads() const { return this->Threads ? this->Threads->GetNumberOfThreads() : 1; }
  /**
   * Threads for short pieces of work, shared by the contexts of all parts; null: the calling thread
   * is the only one.
   */
  const std::shared_ptr<ThreadTeam>& GetThreads() const { return this->Threads; }
  /** The same, but without threads a new team of the calling one. */
  std::shared_ptr<ThreadTeam> GetTeam() const
  {
    return this->Threads ? this->Threads : std::make_shared<ThreadTeam>(1);
  }

  const Deadline& GetDeadline() const { return this->TimeLimit; }
  /** Whether the time limit is over, if there is one. */
  bool IsLate() const { return this->TimeLimit.IsOver(); }
  /** The same context, with a time limit from now on unless there is an earlier one. 0: none. */
  ExecutionContext WithTimeLimit(double seconds) const
  {
    ExecutionContext limited(*this);
    limited.TimeLimit.SetAfter(seconds);
    return limited;
  }
  /** The same threads and time limit, with other functions; a whole, not a part. */
  ExecutionContext WithFunctions(ProgressFunction progress, AbortFunction abort) const
  {
    ExecutionContext other(*this);
    other.Progress = std::move(progress);
    other.Abort = std::move(abort);
    other.Begin = 0.0;
    other.End = 1.0;
    return other;
  }

  /** Report progress within this context's share; false if the stage has to return Aborted. */
  bool Continue(double fraction, const char* activity) const
  {
    if (this->Progress)
    {
      const double inside = fraction < 0.0 ? 0.0 : fraction > 1.0 ? 1.0 : fraction;
      this->Progress(this->Begin + (this->End - this->Begin) * inside, activity);
    }
    return !(this->Abort && this->Abort());
  }

  /** A context for a part of the work, which is [begin, end] of this one's. */
  ExecutionContext Part(double begin, double end) const
  {
    ExecutionContext part(*this);
    part.Begin = this->Begin + (this->End - this->Begin) * begin;
    part.End = this->Begin + (this->End - this->Begin) * end;
    return part;
  }

  /** The same context, which says "name: activity". */
  ExecutionContext Named(const std::string& name) const
  {
    ExecutionContext named(*this);
    if (this->Progress)
    {
      named.Progress = [progress = this->Progress, name](double fraction, const char* activity)
      { progress(fraction, *activity == 0 ? name.c_str() : (name + ": " + activity).c_str()); };
    }
    return named;
  }

private:
  ProgressFunction Progress;
  AbortFunction Abort;
  double Begin = 0.0;
  double End = 1.0;
  Deadline TimeLimit;
  std::shared_ptr<ThreadTeam> Threads;
};
} // namespace cdm

#endif
