// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/PolygonOutlines.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

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

/**
 * Outlines that share their lowest point and the sum of their points with another one, ascending: all
 * that can have a duplicate. The others, nearly all, need no common form.
 */
std::vector<Id> FindCandidates(const PolygonOutlines& outlines)
{
  const Id n = outlines.GetSize();
  std::vector<std::pair<std::uint64_t, Id>> keys;
  keys.reserve(n);
  for (Id k = 0; k < n; ++k)
  {
    const Id* const begin = outlines.Vertices.data() + outlines.Offsets[k];
    const Id* const end = outlines.Vertices.data() + outlines.Offsets[k + 1];
    std::uint32_t sum = 0;
    for (const Id* point = begin; point != end; ++point)
    {
      sum += static_cast<std::uint32_t>(*point);
    }
    keys.emplace_back(PackIds(*std::min_element(begin, end), static_cast<Id>(sum)), k);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Id> candidates;
  for (auto begin = keys.begin(), end = begin; begin != keys.end(); begin = end)
  {
    end =
      std::find_if(begin, keys.end(), [&](const auto& key) { return key.first != begin->first; });
    for (auto outline = begin; end - begin > 1 && outline != end; ++outline)
    {
      candidates.push_back(outline->second);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}
} // namespace

std::vector<DuplicateOutline> FindDuplicateOutlines(const PolygonOutlines& outlines)
{
  const std::vector<Id> candidates = FindCandidates(outlines);
  const Id n = static_cast<Id>(candidates.size());
  PolygonOutlines cycles;
  std::vector<char> reversed(n);
  std::vector<Id> outline;
  for (Id i = 0; i < n; ++i)
  {
    bool isReversed = false;
    outlines.Get(candidates[i], outline);
    cycles.Add(candidates[i], MakeCanonical(outline, isReversed));
    reversed[i] = isReversed;
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
      duplicates.push_back(
        { candidates[copy], candidates[first], reversed[first] != reversed[copy] });
    }
    else
    {
      first = copy;
    }
  }
  return duplicates;
}
} // namespace cdm
