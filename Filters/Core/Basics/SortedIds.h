// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SortedIds.h
 * @brief Ids in ascending order: those of a list, a simplex or an edge; two of them as one number;
 * and whether one is among others.
 */
#ifndef cdmSortedIds_h
#define cdmSortedIds_h

#include "Core/Basics/Types.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
/** The sorted ids of a triangle or tetrahedron, as a key. */
template <typename Ids>
Ids Sorted(Ids ids)
{
  std::sort(ids.begin(), ids.end());
  return ids;
}

/**
 * Whether an item is in a list, in any order. A loop, which compilers unroll for the few ids of a
 * simplex: std::find, which they do not, took one percent of the time of small meshes.
 */
template <typename List, typename Item>
bool Contains(const List& list, const Item& item)
{
  for (const auto& other : list)
  {
    if (other == item)
    {
      return true;
    }
  }
  return false;
}

/**
 * Two ids as one number, the first of them as the higher half. Such numbers are sorted in about half
 * the time of pairs, and sort like them if no id is negative.
 */
inline std::uint64_t PackIds(Id first, Id second)
{
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(first)) << 32 |
    static_cast<std::uint32_t>(second);
}

inline std::uint64_t PackIds(const EdgeIds& ids)
{
  return PackIds(ids[0], ids[1]);
}

inline EdgeIds UnpackIds(std::uint64_t packed)
{
  return { static_cast<Id>(packed >> 32), static_cast<Id>(packed & 0xffffffffu) };
}

/** Sorts a list and drops repetitions. Also for pairs and the like. */
template <typename T>
void SortUnique(std::vector<T>& ids)
{
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/** Sorts a list of edges and drops repetitions. Edges are compared as numbers, which is faster. */
inline void SortUnique(std::vector<EdgeIds>& edges)
{
  std::vector<std::uint64_t> numbers;
  numbers.reserve(edges.size());
  for (const EdgeIds& edge : edges)
  {
    numbers.push_back(PackIds(edge));
  }
  SortUnique(numbers);
  edges.clear();
  for (const std::uint64_t number : numbers)
  {
    edges.push_back(UnpackIds(number));
  }
}

/**
 * Calls visit(id) for each of the ids once, in ascending order: for many ids of a small range, which
 * SortUnique() takes longer for. Lists of new tetrahedra took two percent of small meshes' time so.
 * @param marks work space, one bit for each id; the same one again for the next call
 */
template <typename Iterator, typename Visitor>
void VisitAscending(
  Iterator begin, Iterator end, std::vector<std::uint64_t>& marks, Visitor&& visit)
{
  if (begin == end)
  {
    return;
  }
  const auto [lowest, highest] = std::minmax_element(begin, end);
  const std::size_t last = static_cast<std::size_t>(*highest) / 64;
  marks.resize(std::max(marks.size(), last + 1), 0);
  for (Iterator id = begin; id != end; ++id)
  {
    marks[static_cast<std::size_t>(*id) / 64] |= std::uint64_t(1) << (*id % 64);
  }
  for (std::size_t i = static_cast<std::size_t>(*lowest) / 64; i <= last; ++i)
  {
    for (std::uint64_t left = std::exchange(marks[i], 0); left != 0; left &= left - 1)
    {
      visit(static_cast<Id>(64 * i) + __builtin_ctzll(left));
    }
  }
}

/** The ends of an edge in ascending order, so that both directions give the same. */
inline EdgeIds MakeEdge(Id a, Id b)
{
  return a < b ? EdgeIds{ a, b } : EdgeIds{ b, a };
}
} // namespace cdm

#endif
