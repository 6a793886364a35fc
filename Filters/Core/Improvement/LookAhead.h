// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LookAhead.h
 * @brief Threads that search what is to be done about the next items of a list, before their turn
 *   comes: slivers, or tetrahedra that break a limit.
 *
 * They are mended one after the other, as each change of the mesh matters for those that follow.
 * But a search sees some ten or hundred tetrahedra only, and few of these are replaced before it is
 * the item's turn.
 *
 * Method:
 *  1. when it is the turn of an item of which nothing is known, it is searched, and at the same time
 *     some of those that follow, each by one thread, in the mesh as it is. The searches note which
 *     tetrahedra they have seen;
 *  2. in its turn, the change of an item is what was found, if all of these tetrahedra are still
 *     there; if not, the item is searched again, as in 1;
 *  3. an item is not searched ahead if it has two points in common with those that come before it and
 *     are still to be mended: their changes would likely spoil what is found, or mend it, too. Two
 *     threads made 57,600 searches for limits without this rule, 49,500 with it, and one 49,000.
 *
 * Guarantees: the changes are those of one thread, in the same order, whatever the number of
 * threads.
 */
#ifndef cdmLookAhead_h
#define cdmLookAhead_h

#include "Core/Improvement/RefinedMesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
/** @tparam Change what a search finds; a default constructed one is none */
template <typename Change>
class LookAhead
{
public:
  struct alignas(SeparateLines) Found
  {
    Change What;
    /** Tetrahedra that the search has seen. */
    std::vector<Id> Visited;
  };

  /**
   * @param itemsPerThread at least so many if there are more than two threads: with fewer, 16 threads
   *   were slower than 4. Two threads share four items or more
   * @param tetrahedraPerItem one item is searched ahead at once for so many tetrahedra of the mesh:
   *   the closer items are, and the more of the mesh each of them sees, the more searches are late
   */
  LookAhead(const RefinedMesh& mesh, std::size_t itemsPerThread, std::size_t tetrahedraPerItem)
    : Mesh(mesh), ItemsPerThread(itemsPerThread), TetrahedraPerItem(tetrahedraPerItem)
  {
  }

  /** Forgets what was found: another list begins. */
  void Clear()
  {
    this->First = 0;
    this->Stamps.clear();
  }

  /**
   * The change of item i: what was found ahead, or else what is found now. It stays until the next
   * call, which is for an item that comes later. Item i has to be worth a search.
   * @param count number of items of the list
   * @param getOpen (i): the tetrahedron of an item, or NoId if it is not worth a search
   * @param find (thread, i, found): finds the change of an item, in the mesh as it is; called on
   *   threads. What found holds is of another item: its memory may be used again
   * @param holds (change): whether a change that was found ahead may still be made, as far as that
   *   does not depend on the tetrahedra
   */
  template <typename GetOpen, typename Find, typename Holds>
  const Change& Get(std::size_t i, std::size_t count, GetOpen&& getOpen, Find&& find, Holds&& holds)
  {
    const int threads = this->Mesh.GetThreads().GetNumberOfThreads();
    if (threads < 2)
    {
      this->Ahead.resize(1);
      find(0, i, this->Ahead[0]);
      return this->Ahead[0].What;
    }
    if (i - this->First >= this->Stamps.size())
    {
      this->StartAt(i, count);
    }
    const std::size_t k = i - this->First;
    if (!this->IsKnown(k) || !holds(this->Ahead[k].What))
    {
      this->CollectFrom(k, getOpen);
      this->FindCollected(find);
    }
    return this->Ahead[k].What;
  }
  template <typename GetOpen, typename Find>
  const Change& Get(std::size_t i, std::size_t count, GetOpen&& getOpen, Find&& find)
  {
    return this->Get(i, count, getOpen, find, [](const Change&) { return true; });
  }

private:
  /** So many items may be searched at once, but no more than so many for each thread. */
  static constexpr std::size_t FewestItems = 8;
  static constexpr std::size_t MostPerThread = 8;
  /** They are looked for among so many times as many. */
  static constexpr std::size_t ItemsToChooseFrom = 4;
  /** Two threads wait for each other for some microseconds; a search takes some 20. */
  static constexpr std::size_t FewestForTwo = 4;
  /** The stamp of an item that has not been searched: all tetrahedra are younger. */
  static constexpr std::int64_t Unknown = -1;

  std::size_t GetMostAtOnce() const
  {
    const auto threads = static_cast<std::size_t>(this->Mesh.GetThreads().GetNumberOfThreads());
    return std::clamp(this->Mesh.GetMesh().Tetrahedra.size() / this->TetrahedraPerItem, FewestItems,
      MostPerThread * threads);
  }

  /** Forgets what was found; from now on it is about items from one on. */
  void StartAt(std::size_t first, std::size_t count)
  {
    constexpr std::size_t rounds = 16;
    const std::size_t size =
      std::min(count - first, rounds * ItemsToChooseFrom * this->GetMostAtOnce());
    this->First = first;
    this->Stamps.assign(size, Unknown);
    this->Ahead.resize(std::max(this->Ahead.size(), size));
  }

  /** Whether the change of an item is known, and all tetrahedra that were seen are still there. */
  bool IsKnown(std::size_t k) const
  {
    const DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
    const std::vector<Id>& visited = this->Ahead[k].Visited;
    return this->Stamps[k] != Unknown &&
      std::all_of(
        visited.begin(), visited.end(), [&](Id t) { return mesh.GetStamp(t) < this->Stamps[k]; });
  }

  /** Collects an item, and those that follow and are searched at the same time. */
  template <typename GetOpen>
  void CollectFrom(std::size_t first, GetOpen&& getOpen)
  {
    const std::size_t most = this->GetMostAtOnce();
    const std::size_t end = std::min(this->Stamps.size(), first + ItemsToChooseFrom * most);
    this->Marks.resize(static_cast<std::size_t>(this->Mesh.GetTetrahedra().GetNumberOfPoints()), 0);
    ++this->LastMark;
    this->Collected.clear();
    for (std::size_t k = first; k < end && this->Collected.size() < most; ++k)
    {
      const Id tetrahedron = getOpen(this->First + k);
      if (tetrahedron == NoId)
      {
        continue;
      }
      int common = 0;
      for (const Id point : this->Mesh.GetMesh().Tetrahedra[tetrahedron])
      {
        common += std::exchange(this->Marks[point], this->LastMark) == this->LastMark ? 1 : 0;
      }
      if (k == first || (common < 2 && !this->IsKnown(k)))
      {
        this->Collected.push_back(k);
      }
    }
  }

  /** Searches all that were collected, at the same time. */
  template <typename Find>
  void FindCollected(Find&& find)
  {
    const std::size_t count = this->Collected.size();
    for (const std::size_t k : this->Collected)
    {
      this->Stamps[k] = this->Mesh.GetTetrahedra().GetNextStamp();
    }
    const bool isAlone = count < FewestForTwo;
    const auto threads =
      static_cast<int>(std::max<std::size_t>(count / this->ItemsPerThread, isAlone ? 1 : 2));
    this->Mesh.Freeze(true);
    this->Mesh.GetThreads().RunBlocks(threads, count, 1,
      [&](std::size_t i, std::size_t, int thread)
      {
        const std::size_t k = this->Collected[i];
        find(thread, this->First + k, this->Ahead[k]);
      });
    this->Mesh.Freeze(false);
  }

  const RefinedMesh& Mesh;
  const std::size_t ItemsPerThread;
  const std::size_t TetrahedraPerItem;
  /** The first item of the following, and what was found for each. */
  std::size_t First = 0;
  std::vector<Found> Ahead;
  /** Tetrahedra with this stamp or a later one were made after the search for the item. */
  std::vector<std::int64_t> Stamps;
  /** Work space: the items that are searched, less the first one; marks of points. */
  std::vector<std::size_t> Collected;
  std::vector<std::uint32_t> Marks;
  std::uint32_t LastMark = 0;
};
} // namespace cdm

#endif
