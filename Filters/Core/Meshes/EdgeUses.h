// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EdgeUses.h
 * @brief The sides of triangles, those at one edge next to each other.
 *
 * Side i of triangle t runs from its vertex i to vertex i + 1; 3 * t + i is its use of that edge.
 *
 * Cost: O(n) for a bounded number of triangles at a point; 16 bytes per use.
 */
#ifndef cdmEdgeUses_h
#define cdmEdgeUses_h

#include "Core/Basics/Types.h"

#include <cstddef>
#include <vector>

namespace cdm
{
struct EdgeUse
{
  /** The two points in one number, of which the smaller id is the higher half. */
  std::uint64_t Edge;
  Id Use;

  EdgeIds GetPoints() const
  {
    return { static_cast<Id>(this->Edge >> 32), static_cast<Id>(this->Edge & 0xffffffffu) };
  }
};

/** All uses, sorted by edge; the uses of an edge ascend. */
std::vector<EdgeUse> SortEdgeUses(
  const std::vector<TriangleIds>& triangles, std::size_t numberOfPoints);
} // namespace cdm

#endif
