// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/EdgeUses.h"

#include <algorithm>

namespace cdm
{
std::vector<EdgeUse> SortEdgeUses(
  const std::vector<TriangleIds>& triangles, std::size_t numberOfPoints)
{
  // Into one bin for each smaller point first; few uses are left to compare.
  std::vector<Id> begin(numberOfPoints + 1, 0);
  for (const TriangleIds& ids : triangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      ++begin[std::min(ids[i], ids[(i + 1) % 3]) + 1];
    }
  }
  for (std::size_t i = 0; i < numberOfPoints; ++i)
  {
    begin[i + 1] += begin[i];
  }
  std::vector<EdgeUse> uses(3 * triangles.size());
  std::vector<Id> next(begin.begin(), begin.end() - 1);
  Id use = 0;
  for (const TriangleIds& ids : triangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      const EdgeIds edge = MakeEdge(ids[i], ids[(i + 1) % 3]);
      uses[next[edge[0]]++] = { PackIds(edge), use++ };
    }
  }
  for (std::size_t i = 0; i < numberOfPoints; ++i)
  {
    std::sort(uses.begin() + begin[i], uses.begin() + begin[i + 1],
      [](const EdgeUse& x, const EdgeUse& y)
      { return x.Edge != y.Edge ? x.Edge < y.Edge : x.Use < y.Use; });
  }
  return uses;
}
} // namespace cdm
