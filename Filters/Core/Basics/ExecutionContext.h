// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExecutionContext.h
 * @brief Progress and abort: the one way in which a running stage talks to its caller.
 */
#ifndef cdmExecutionContext_h
#define cdmExecutionContext_h

#include <functional>
#include <utility>

namespace cdm
{
/**
 * Stages call Continue() in every loop that can last longer than 50 ms. A default constructed
 * context neither reports nor aborts. Continue() belongs on the thread that called the stage.
 */
class ExecutionContext
{
public:
  /** Called with the finished fraction, from 0 to 1, and a short text: what is being done. */
  using ProgressFunction = std::function<void(double fraction, const char* activity)>;
  /** Returns true if the stage is to stop as soon as possible. */
  using AbortFunction = std::function<bool()>;

  ExecutionContext() = default;
  ExecutionContext(ProgressFunction progress, AbortFunction abort)
    : Progress(std::move(progress))
    , Abort(std::move(abort))
  {
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

private:
  ProgressFunction Progress;
  AbortFunction Abort;
  double Begin = 0.0;
  double End = 1.0;
};
}

#endif
