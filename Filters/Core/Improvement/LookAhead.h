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
 *  1. the next items are searched at the same time, each by one thread, in the mesh as it is; the
 *     search notes which tetrahedra it has seen;
 *  2. in its turn, the change of an item is what was found, if all of these tetrahedra are still
 *     there; if not, it is searched again.
 *
 * Guarantees: the changes are those of one thread, in the same order, whatever the number of
 * threads. Cost: in a mesh of 186,000 tetrahedra one search for a sliver in fourteen is repeated,
 * and one for a limit in thirteen.
 */
#ifndef cdmLookAhead_h
#define cdmLookAhead_h

#include "Core/Improvement/RefinedMesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdm
{
/** @tparam Change what a search finds; a default constructed one is none */
template <typename Change>
class LookAhead
{
public:
  struct Found
  {
    Change What;
    /** Tetrahedra that the search has seen. */
    std::vector<Id> Visited;
  };

  /**
   * @param itemsPerThread at least so many: threads with fewer would hardly have started before the
   *   others are done
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
    this->Searched.clear();
    this->End = 0;
  }

  /**
   * The change of item i: what was found ahead, or else what is found now on the calling thread. It
   * stays until the next call.
   * @param count number of items of the list
   * @param isOpen (i): whether an item is worth a search
   * @param find (thread, i, found): finds the change of an item, in the mesh as it is; called on
   *   threads. What found holds is of another item: its memory may be used again
   * @param holds (change): whether a change that was found ahead may still be made, as far as that
   *   does not depend on the tetrahedra
   */
  template <typename IsOpen, typename Find, typename Holds>
  const Change& Get(std::size_t i, std::size_t count, IsOpen&& isOpen, Find&& find, Holds&& holds)
  {
    if (this->HasThreads() && i >= this->End)
    {
      this->Search(i, count, isOpen, find);
    }
    const auto place = std::lower_bound(this->Searched.begin(), this->Searched.end(), i);
    if (place != this->Searched.end() && *place == i)
    {
      const Found& found = this->Ahead[place - this->Searched.begin()];
      if (this->IsUnchanged(found.Visited) && holds(found.What))
      {
        return found.What;
      }
    }
    find(0, i, this->Now);
    return this->Now.What;
  }
  template <typename IsOpen, typename Find>
  const Change& Get(std::size_t i, std::size_t count, IsOpen&& isOpen, Find&& find)
  {
    return this->Get(i, count, isOpen, find, [](const Change&) { return true; });
  }

private:
  static constexpr std::size_t FewestItems = 8;
  static constexpr std::size_t MostItems = 256;

  bool HasThreads() const { return this->Mesh.GetThreads().GetNumberOfThreads() > 1; }

  template <typename IsOpen, typename Find>
  void Search(std::size_t first, std::size_t count, IsOpen&& isOpen, Find&& find)
  {
    const std::size_t most = std::clamp(
      this->Mesh.GetMesh().Tetrahedra.size() / this->TetrahedraPerItem, FewestItems, MostItems);
    this->NextStamp = this->Mesh.GetTetrahedra().GetNextStamp();
    this->Searched.clear();
    for (this->End = first; this->End < count && this->Searched.size() < most; ++this->End)
    {
      if (isOpen(this->End))
      {
        this->Searched.push_back(this->End);
      }
    }
    ThreadTeam& team = this->Mesh.GetThreads();
    const int threads = std::min(
      team.GetNumberOfThreads(), static_cast<int>(this->Searched.size() / this->ItemsPerThread));
    if (threads < 2)
    {
      this->Searched.clear();
      return;
    }
    this->Ahead.resize(std::max(this->Ahead.size(), this->Searched.size()));
    this->Mesh.Freeze(true);
    team.RunBlocks(threads, this->Searched.size(), 1,
      [&](std::size_t k, std::size_t, int thread)
      { find(thread, this->Searched[k], this->Ahead[k]); });
    this->Mesh.Freeze(false);
  }

  bool IsUnchanged(const std::vector<Id>& tetrahedra) const
  {
    const DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
    return std::all_of(tetrahedra.begin(), tetrahedra.end(),
      [&](Id t) { return mesh.GetStamp(t) < this->NextStamp; });
  }

  const RefinedMesh& Mesh;
  const std::size_t ItemsPerThread;
  const std::size_t TetrahedraPerItem;
  /** The items before End that have been searched ahead, ascending, and what was found for each. */
  std::vector<std::size_t> Searched;
  std::vector<Found> Ahead;
  std::size_t End = 0;
  /** What was found for an item in its turn. */
  Found Now;
  /** Tetrahedra with this stamp or a later one have been made since the searches. */
  std::int64_t NextStamp = 0;
};
} // namespace cdm

#endif
