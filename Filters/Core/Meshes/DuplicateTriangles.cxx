// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/DuplicateTriangles.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>
#include <utility>

namespace cdm
{
std::vector<DuplicateTriangle> FindDuplicateTriangles(const std::vector<TriangleIds>& triangles)
{
  // Into one bin for each smallest point first; few triangles are left to compare.
  std::vector<TriangleIds> sorted = triangles;
  Id numberOfPoints = 0;
  for (TriangleIds& t : sorted)
  {
    std::sort(t.begin(), t.end());
    numberOfPoints = std::max(numberOfPoints, t[2] + 1);
  }
  std::vector<Id> begin(static_cast<std::size_t>(numberOfPoints) + 1, 0);
  for (const TriangleIds& t : sorted)
  {
    ++begin[t[0] + 1];
  }
  for (Id i = 0; i < numberOfPoints; ++i)
  {
    begin[i + 1] += begin[i];
  }
  std::vector<Id> order(triangles.size());
  std::vector<Id> next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < sorted.size(); ++t)
  {
    order[next[sorted[t][0]]++] = static_cast<Id>(t);
  }
  // The triangles in one bin differ in their other two points, which are compared as one number.
  const auto getOthers = [&sorted](Id t) { return PackIds(sorted[t][1], sorted[t][2]); };
  for (Id i = 0; i < numberOfPoints; ++i)
  {
    std::sort(order.begin() + begin[i], order.begin() + begin[i + 1],
      [&getOthers](Id a, Id b)
      { return getOthers(a) != getOthers(b) ? getOthers(a) < getOthers(b) : a < b; });
  }
  std::vector<DuplicateTriangle> duplicates;
  Id first = NoId;
  for (const Id t : order)
  {
    if (first == NoId || sorted[first][0] != sorted[t][0] || getOthers(first) != getOthers(t))
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
