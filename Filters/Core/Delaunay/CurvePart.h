// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvePart.h
 * @brief A part of a closed curve that vertices lie on, which a thread has for itself.
 */
#ifndef cdmCurvePart_h
#define cdmCurvePart_h

#include "Core/Basics/Types.h"

#include <algorithm>
#include <cstdint>

namespace cdm
{
/** The vertices from First on, Count of them, around the end of the curve; and infinity. */
class CurvePart
{
public:
  CurvePart() = default;
  CurvePart(Id first, Id count, Id infinite)
    : First(first < infinite ? first : first - infinite), Count(std::max(0, count)),
      BeforeEnd(std::min(this->Count, infinite - this->First)), Infinite(infinite)
  {
  }

  /** How far along the part, or beyond it. */
  Id GetPlace(Id vertex) const
  {
    const Id place = vertex - this->First;
    return place >= 0 ? place : place + this->Infinite;
  }
  /** Asked all the time, and mostly answered by the first comparison. */
  bool Has(Id vertex) const
  {
    return static_cast<std::uint32_t>(vertex - this->First) <
      static_cast<std::uint32_t>(this->BeforeEnd) ||
      vertex < this->Count - this->BeforeEnd || vertex == this->Infinite;
  }
  /** Without what is from a place on. */
  CurvePart GetBegin(Id place) const { return { this->First, place, this->Infinite }; }
  /** From a vertex of it on. */
  CurvePart GetEnd(Id vertex) const
  {
    return { vertex, this->Count - this->GetPlace(vertex), this->Infinite };
  }

private:
  Id First = 0;
  Id Count = 0;
  Id BeforeEnd = 0;
  Id Infinite = 0;
};
} // namespace cdm

#endif
