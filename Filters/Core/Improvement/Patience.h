// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Patience.h
 * @brief Gives up after a number of tries in a row that do not reduce a count.
 */
#ifndef cdmPatience_h
#define cdmPatience_h

#include "Core/Basics/Types.h"

#include <algorithm>
#include <cstddef>

namespace cdm
{
class Patience
{
public:
  /**
   * @param part a try counts as a success if the count is below this part of the smallest one so
   *   far
   */
  explicit Patience(int maximumTries, double part = 1.0) : MaximumTries(maximumTries), Part(part) {}

  bool IsOver(std::size_t number)
  {
    this->Tries = static_cast<double>(number) < this->Part * this->Fewest ? 0 : this->Tries;
    this->Fewest = std::min(this->Fewest, static_cast<double>(number));
    return this->Tries >= this->MaximumTries;
  }
  void NoteTry() { ++this->Tries; }
  void Renew() { *this = Patience(this->MaximumTries, this->Part); }

private:
  int MaximumTries;
  double Part;
  int Tries = 0;
  double Fewest = Infinity;
};
} // namespace cdm

#endif
