// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/PolygonOutlines.h"

#include <algorithm>
#include <numeric>

namespace cdm
{
namespace
{
/** Lowest common form of a cycle of ids over all starts and both directions. */
std::vector<Id> MakeCanonical(const std::vector<Id>& outline, bool& reversed)
{
  const std::size_t n = outline.size();
  const Id lowest = *std::min_element(outline.begin(), outline.end());
  std::vector<Id> best;
  std::vector<Id> candidate(n);
  for (const bool backward : { false, true })
  {
    for (std::size_t start = 0; start < n; ++start)
    {
      if (outline[start] != lowest)
      {
        continue;
      }
      for (std::size_t i = 0; i < n; ++i)
      {
        candidate[i] = outline[(backward ? start + n - i : start + i) % n];
      }
      if (best.empty() || candidate < best)
      {
        best = candidate;
        reversed = backward;
      }
    }
  }
  return best;
}
} // namespace

std::vector<DuplicateOutline> FindDuplicateOutlines(const PolygonOutlines& outlines)
{
  const Id n = outlines.GetSize();
  PolygonOutlines cycles;
  std::vector<char> reversed(n);
  std::vector<Id> outline;
  for (Id k = 0; k < n; ++k)
  {
    bool isReversed = false;
    outlines.Get(k, outline);
    cycles.Add(k, MakeCanonical(outline, isReversed));
    reversed[k] = isReversed;
  }
  const auto begin = [&cycles](Id k) { return cycles.Vertices.begin() + cycles.Offsets[k]; };
  std::vector<Id> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&begin](Id a, Id b)
    {
      if (std::lexicographical_compare(begin(a), begin(a + 1), begin(b), begin(b + 1)))
      {
        return true;
      }
      return a < b && std::equal(begin(a), begin(a + 1), begin(b), begin(b + 1));
    });
  std::vector<DuplicateOutline> duplicates;
  Id first = n > 0 ? order[0] : NoId;
  for (Id i = 1; i < n; ++i)
  {
    const Id copy = order[i];
    if (std::equal(begin(copy), begin(copy + 1), begin(first), begin(first + 1)))
    {
      duplicates.push_back({ copy, first, reversed[first] != reversed[copy] });
    }
    else
    {
      first = copy;
    }
  }
  return duplicates;
}
} // namespace cdm
