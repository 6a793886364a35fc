// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CollectItems.h
 * @brief Several threads look through something and list what they find, in the order of one thread.
 */
#ifndef cdmCollectItems_h
#define cdmCollectItems_h

#include "Core/Basics/ThreadTeam.h"

#include <cstddef>
#include <vector>

namespace cdm
{
/**
 * Calls work(begin, end, found) on threads for blocks of the numbers below size. Returns what these
 * calls have added to found, one block after the other.
 */
template <typename Item, typename Work>
std::vector<Item> CollectItems(
  ThreadTeam& team, std::size_t size, std::size_t blockSize, const Work& work)
{
  std::vector<std::vector<Item>> parts((size + blockSize - 1) / blockSize);
  team.RunBlocks(team.GetNumberOfThreads(), size, blockSize,
    [&](std::size_t begin, std::size_t end, int) { work(begin, end, parts[begin / blockSize]); });
  std::vector<Item> all;
  for (const std::vector<Item>& part : parts)
  {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}
} // namespace cdm

#endif
