// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Status.h
 * @brief How a stage of the engine ended, and what it holds against its input.
 *
 * The engine never prints, throws across its boundary, or exits: it returns a Status. The message
 * says what is wrong and what to do; Cells and Points say where, in ids of the stage's input.
 */
#ifndef cdmStatus_h
#define cdmStatus_h

#include "Core/Basics/Types.h"

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
  /** The input breaks a requirement; Message, Cells and Points name it. */
  InvalidInput,
  /** A promise of the engine was broken: a bug worth reporting, never the user's fault. */
  InternalError
};

struct Status
{
  StatusCode Code = StatusCode::Ok;
  std::string Message;
  /** Offending input cells, ascending, without repetition. */
  std::vector<Id> Cells;
  /** Offending input points, ascending, without repetition. */
  std::vector<Id> Points;

  bool IsOk() const { return this->Code == StatusCode::Ok; }
  bool IsAborted() const { return this->Code == StatusCode::Aborted; }

  static Status Aborted() { return { StatusCode::Aborted, "Aborted on request.", {}, {} }; }
  static Status InvalidInput(
    std::string message, std::vector<Id> cells = {}, std::vector<Id> points = {})
  {
    return { StatusCode::InvalidInput, std::move(message), std::move(cells), std::move(points) };
  }
  static Status InternalError(
    std::string message, std::vector<Id> cells = {}, std::vector<Id> points = {})
  {
    return { StatusCode::InternalError, std::move(message), std::move(cells), std::move(points) };
  }
};
} // namespace cdm

#endif
