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

#include "Core/Basics/SortedIds.h"
#include "Core/Basics/Types.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdm
{
struct EdgeUse
{
  /** The two points, the smaller id first, as PackIds has them. */
  std::uint64_t Edge;
  Id Use;

  EdgeIds GetPoints() const { return UnpackIds(this->Edge); }
};

/** All uses, sorted by edge; the uses of an edge ascend. */
std::vector<EdgeUse> SortEdgeUses(
  const std::vector<TriangleIds>& triangles, std::size_t numberOfPoints);

/** Behind the last use of the edge whose first use is at begin. */
inline std::size_t FindEndOfEdge(const std::vector<EdgeUse>& sorted, std::size_t begin)
{
  std::size_t end = begin + 1;
  while (end < sorted.size() && sorted[end].Edge == sorted[begin].Edge)
  {
    ++end;
  }
  return end;
}
} // namespace cdm

#endif
