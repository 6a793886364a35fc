// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Status.h
 * @brief How a stage of the engine ended, and what is wrong with its input.
 *
 * The engine never prints, throws across its boundary, or exits: it returns a Status. The message
 * says what is wrong and what to do; Cells and Points say where, in ids of the stage's input. The
 * code says what a program can do about it.
 */
#ifndef cdmStatus_h
#define cdmStatus_h

#include "Core/Basics/FloatingPointEnvironment.h"
#include "Core/Basics/Types.h"

#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cdm
{
enum class StatusCode
{
  Ok,
  /** The abort function of the ExecutionContext asked to stop. */
  Aborted,
  /** The input breaks a requirement that has no code of its own here. */
  InvalidInput,
  /** An option is out of its range, or asks for something that is not there. */
  InvalidOption,
  /** A region is open, or its labels contradict each other: close the surface. */
  NotClosed,
  /** Triangles cross, overlap or touch: resolve or repair the intersections. */
  SelfIntersecting,
  /** Triangles are not strongly Delaunay: refine the surface. */
  NotDelaunay,
  /** More points, leaves or tetrahedra than an option or 32-bit ids allow: ask for less. */
  LimitReached,
  /** The memory of the machine does not suffice: ask for less. */
  OutOfMemory,
  /** A promise of the engine was broken: a bug worth reporting, never the user's fault. */
  InternalError
};

struct [[nodiscard]] Status
{
  StatusCode Code = StatusCode::Ok;
  std::string Message;
  /** Offending input cells, ascending, without repetition. */
  std::vector<Id> Cells;
  /** Offending input points, ascending, without repetition. */
  std::vector<Id> Points;

  bool IsOk() const { return this->Code == StatusCode::Ok; }
  bool IsAborted() const { return this->Code == StatusCode::Aborted; }

  /** Chains steps: calls the next one, which returns a Status, unless this one has failed. */
  template <typename Step>
  Status Then(const Step& next) &&
  {
    return this->IsOk() ? next() : std::move(*this);
  }

  static Status Aborted() { return { StatusCode::Aborted, "Aborted on request.", {}, {} }; }
  static Status Failure(
    StatusCode code, std::string message, std::vector<Id> cells = {}, std::vector<Id> points = {})
  {
    return { code, std::move(message), std::move(cells), std::move(points) };
  }
  static Status InvalidInput(
    std::string message, std::vector<Id> cells = {}, std::vector<Id> points = {})
  {
    return { StatusCode::InvalidInput, std::move(message), std::move(cells), std::move(points) };
  }
  static Status OutOfMemory()
  {
    return { StatusCode::OutOfMemory, "There is not enough memory for this input.", {}, {} };
  }
  static Status InternalError(
    std::string message, std::vector<Id> cells = {}, std::vector<Id> points = {})
  {
    return { StatusCode::InternalError, std::move(message), std::move(cells), std::move(points) };
  }
};

/**
 * Runs a stage; no exception leaves it: running out of memory becomes a Status. Arithmetic in it is
 * that of FloatingPointEnvironment.h.
 */
template <typename Function>
Status RunGuarded(const Function& function)
{
  const FloatingPointEnvironment environment;
  try
  {
    return function();
  }
  catch (const std::bad_alloc&)
  {
    return Status::OutOfMemory();
  }
  catch (const std::length_error&)
  {
    return Status::OutOfMemory();
  }
}
} // namespace cdm

#endif
