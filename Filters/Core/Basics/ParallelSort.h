// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelSort.h
 * @brief Sorts many items on several threads.
 *
 * Method: a sorted sample cuts the items into ranges of values; blocks of items are counted and
 * moved to their ranges, then each range is sorted by itself.
 *
 * Items that compare equal may come in any order, as with std::sort, but the result is the same for
 * any number of threads only if they are equal in all that matters.
 * Cost: O(n log n); a copy of the items, and a byte for each.
 */
#ifndef cdmParallelSort_h
#define cdmParallelSort_h

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/RawVector.h"

#include <algorithm>
#include <vector>

namespace cdm
{
/** False if aborted: then the items are in no order. */
template <typename Vector, typename Less>
bool ParallelSort(Vector& items, int numberOfThreads, const ExecutionContext& context,
  const char* activity, const Less& isLess)
{
  using Item = typename Vector::value_type;
  constexpr std::size_t numberOfRanges = 256;
  constexpr std::size_t samplesOfRange = 16;
  constexpr std::size_t fewItems = 1 << 15;
  if (items.size() < fewItems || numberOfThreads == 1)
  {
    std::sort(items.begin(), items.end(), isLess);
    return context.Continue(1.0, activity);
  }
  std::vector<Item> sample;
  const std::size_t step = items.size() / (numberOfRanges * samplesOfRange) + 1;
  for (std::size_t i = 0; i < items.size(); i += step)
  {
    sample.push_back(items[i]);
  }
  std::sort(sample.begin(), sample.end(), isLess);
  std::vector<Item> splitters;
  for (std::size_t range = 1; range < numberOfRanges; ++range)
  {
    splitters.push_back(sample[range * sample.size() / numberOfRanges]);
  }

  const ParallelLoopOptions blocks{ numberOfThreads, fewItems };
  RawVector<unsigned char> ranges(items.size());
  std::vector<std::vector<std::size_t>> places(GetNumberOfBlocks(items.size(), blocks));
  const auto count = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    places[block].assign(numberOfRanges, 0);
    for (std::size_t i = begin; i < end; ++i)
    {
      const auto range = std::upper_bound(splitters.begin(), splitters.end(), items[i], isLess);
      ranges[i] = static_cast<unsigned char>(range - splitters.begin());
      ++places[block][ranges[i]];
    }
  };
  if (!ParallelLoop(items.size(), blocks, context.Part(0.0, 0.3), activity, count))
  {
    return false;
  }
  std::vector<std::size_t> begins(1, 0);
  std::size_t sum = 0;
  for (std::size_t range = 0; range < numberOfRanges; ++range)
  {
    for (std::vector<std::size_t>& ofBlock : places)
    {
      sum += ofBlock[range];
      ofBlock[range] = sum - ofBlock[range];
    }
    begins.push_back(sum);
  }
  Vector sorted(items.size());
  const auto move = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      sorted[places[block][ranges[i]]++] = items[i];
    }
  };
  const auto sort = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t range = begin; range < end; ++range)
    {
      std::sort(sorted.begin() + begins[range], sorted.begin() + begins[range + 1], isLess);
    }
  };
  if (!ParallelLoop(items.size(), blocks, context.Part(0.3, 0.4), activity, move) ||
    !ParallelLoop(numberOfRanges, { numberOfThreads, 1 }, context.Part(0.4, 1.0), activity, sort))
  {
    return false;
  }
  items.swap(sorted);
  return true;
}
} // namespace cdm

#endif
