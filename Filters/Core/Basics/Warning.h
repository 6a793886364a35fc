// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Warning.h
 * @brief What a stage that has succeeded did not do as asked, or left out of its input.
 */
#ifndef cdmWarning_h
#define cdmWarning_h

#include "Core/Basics/Types.h"

#include <string>
#include <vector>

namespace cdm
{
struct Warning
{
  /** Sentences: what it is, and what can be done. */
  std::string Message;
  /** Cells of the stage's input that it is about, in any order; NoId is none of them. */
  std::vector<Id> Cells = {};
};
} // namespace cdm

#endif
