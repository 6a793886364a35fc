// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExecutionContext.h
 * @brief What a running stage has from its caller: progress, abort, and how many threads it may use.
 */
#ifndef cdmExecutionContext_h
#define cdmExecutionContext_h

#include "Core/Basics/ThreadTeam.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace cdm
{
/** Loops of steps of some microseconds, or less, call Continue() once in so many. */
constexpr std::size_t StepsBetweenChecks = 1024;

/**
 * Stages call Continue() in every loop that can last longer than 50 ms. A default constructed
 * context neither reports nor aborts, and has one thread. Continue() belongs on the thread that
 * called the stage. No result depends on the number of threads.
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
  std::shared_ptr<ThreadTeam> Threads;
};
} // namespace cdm

#endif
