// SPDX-License-Identifier: BSD-3-Clause
#include "DuplicateTriangles.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cdm
{
std::vector<DuplicateTriangle> FindDuplicateTriangles(const std::vector<TriangleIds>& triangles)
{
  std::vector<TriangleIds> sorted = triangles;
  for (TriangleIds& t : sorted)
  {
    std::sort(t.begin(), t.end());
  }
  std::vector<Id> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&sorted](Id a, Id b) { return sorted[a] != sorted[b] ? sorted[a] < sorted[b] : a < b; });
  std::vector<DuplicateTriangle> duplicates;
  Id first = NoId;
  for (const Id t : order)
  {
    if (first == NoId || sorted[first] != sorted[t])
    {
      first = t;
      continue;
    }
    const TriangleIds& copy = triangles[t];
    const TriangleIds& original = triangles[first];
    const auto position = std::find(copy.begin(), copy.end(), original[0]) - copy.begin();
    duplicates.push_back({ t, first, copy[(position + 1) % 3] != original[1] });
  }
  return duplicates;
}

bool UniteLabels(RegionPair& labels, RegionPair copy, bool isReversed)
{
  if (isReversed)
  {
    std::swap(copy.Front, copy.Back);
  }
  const auto unite = [](Id& region, Id other)
  {
    const bool agree = region < 0 || other < 0 || region == other;
    region = region < 0 ? other : region;
    return agree;
  };
  const bool front = unite(labels.Front, copy.Front);
  const bool back = unite(labels.Back, copy.Back);
  return front && back;
}
} // namespace cdm
