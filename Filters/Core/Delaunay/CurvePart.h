// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvePart.h
 * @brief The part of the closed space-filling curve that one thread works on alone.
 */
#ifndef cdmCurvePart_h
#define cdmCurvePart_h

#include "Core/Basics/Types.h"

#include <algorithm>
#include <cstdint>

namespace cdm
{
/**
 * Count vertices from First on, wrapped around the end of the curve; and the vertex at infinity.
 */
class CurvePart
{
public:
  CurvePart() = default;
  CurvePart(Id first, Id count, Id infinite)
    : First(first < infinite ? first : first - infinite), Count(std::max(0, count)),
      BeforeEnd(std::min(this->Count, infinite - this->First)), Infinite(infinite)
  {
  }

  /** Index of the vertex along the part, or beyond it. */
  Id GetPlace(Id vertex) const
  {
    const Id place = vertex - this->First;
    return place >= 0 ? place : place + this->Infinite;
  }
  /** Called very often; the first comparison answers most calls. */
  bool Has(Id vertex) const
  {
    return static_cast<std::uint32_t>(vertex - this->First) <
      static_cast<std::uint32_t>(this->BeforeEnd) ||
      vertex < this->Count - this->BeforeEnd || vertex == this->Infinite;
  }
  /** The part up to an index. */
  CurvePart GetBegin(Id place) const { return { this->First, place, this->Infinite }; }
  /** The part from one of its vertices on. */
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
