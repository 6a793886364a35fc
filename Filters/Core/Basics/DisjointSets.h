// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DisjointSets.h
 * @brief Sets of numbers that are united pair by pair (union-find).
 *
 * Cost: O(log n) for an operation, less on average; 4 bytes per number.
 */
#ifndef cdmDisjointSets_h
#define cdmDisjointSets_h

#include "Core/Basics/Types.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace cdm
{
class DisjointSets
{
public:
  explicit DisjointSets(std::size_t size) : Parents(size)
  {
    std::iota(this->Parents.begin(), this->Parents.end(), 0);
  }

  /** The smallest number of the set. */
  Id Find(Id i)
  {
    while (this->Parents[i] != i)
    {
      this->Parents[i] = this->Parents[this->Parents[i]];
      i = this->Parents[i];
    }
    return i;
  }

  void Unite(Id i, Id j)
  {
    i = this->Find(i);
    j = this->Find(j);
    this->Parents[std::max(i, j)] = std::min(i, j);
  }

  /** For each number the smallest of its set. Ends the use of the object. */
  std::vector<Id> TakeNames()
  {
    // A parent is smaller than its children.
    for (Id& parent : this->Parents)
    {
      parent = this->Parents[parent];
    }
    return std::move(this->Parents);
  }

private:
  std::vector<Id> Parents;
};
} // namespace cdm

#endif
