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
 *     there; if not, the caller searches again.
 *
 * Guarantees: the changes are those of one thread, in the same order, whatever the number of
 * threads. Cost: one search for a sliver in fourteen is repeated, in a mesh of 186,000 tetrahedra.
 */
#ifndef cdmLookAhead_h
#define cdmLookAhead_h

#include "Core/Improvement/RefinedMesh.h"

#include <algorithm>
#include <atomic>
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
  struct Found
  {
    Change What;
    /** Tetrahedra that the search has seen. */
    std::vector<Id> Visited;
  };

  /**
   * @param itemsPerThread at least so many: threads with fewer would hardly have started before the
   *   others are done
   */
  LookAhead(const RefinedMesh& mesh, std::size_t itemsPerThread)
    : Mesh(mesh), ItemsPerThread(itemsPerThread)
  {
  }

  /** So many items are searched ahead at once: the closer they are, the more searches are late. */
  std::size_t GetBatchSize() const
  {
    const std::size_t size = this->Mesh.GetMesh().Tetrahedra.size();
    return this->HasThreads() ? std::clamp(size / TetrahedraPerItem, FewestItems, MostItems) : 1;
  }

  /** Forgets what was found: another list begins. */
  void Clear() { this->End = 0; }

  /**
   * The change of item i, or null if it has to be searched.
   * @param count number of items of the list
   * @param isOpen (i): whether an item is worth a search
   * @param find (thread, i, found): finds the change of an item, in the mesh as it is; called on
   *   threads. What found holds is of another item: its memory may be used again
   */
  template <typename IsOpen, typename Find>
  const Change* Get(std::size_t i, std::size_t count, IsOpen&& isOpen, Find&& find)
  {
    if (!this->HasThreads())
    {
      return nullptr;
    }
    if (i >= this->End)
    {
      this->Search(i, count, isOpen, find);
    }
    const auto open = std::lower_bound(this->Open.begin(), this->Open.end(), i);
    if (!this->IsSearched || open == this->Open.end() || *open != i)
    {
      return nullptr;
    }
    const Found& found = this->Ahead[open - this->Open.begin()];
    return this->IsUnchanged(found.Visited) ? &found.What : nullptr;
  }

private:
  static constexpr std::size_t TetrahedraPerItem = 4000;
  static constexpr std::size_t FewestItems = 8;
  static constexpr std::size_t MostItems = 256;

  bool HasThreads() const { return this->Mesh.GetThreads().GetNumberOfThreads() > 1; }

  template <typename IsOpen, typename Find>
  void Search(std::size_t first, std::size_t count, IsOpen&& isOpen, Find&& find)
  {
    const std::size_t most = this->GetBatchSize();
    this->NextStamp = this->Mesh.GetTetrahedra().GetNextStamp();
    this->Open.clear();
    for (this->End = first; this->End < count && this->Open.size() < most; ++this->End)
    {
      if (isOpen(this->End))
      {
        this->Open.push_back(this->End);
      }
    }
    this->Ahead.resize(std::max(this->Ahead.size(), this->Open.size()));
    ThreadTeam& team = this->Mesh.GetThreads();
    const int threads = std::min(
      team.GetNumberOfThreads(), static_cast<int>(this->Open.size() / this->ItemsPerThread));
    this->IsSearched = threads > 1;
    if (!this->IsSearched)
    {
      return;
    }
    std::atomic<std::size_t> next{ 0 };
    this->Mesh.Freeze(true);
    team.RunShared(threads,
      [&](int thread)
      {
        for (std::size_t k = next++; k < this->Open.size(); k = next++)
        {
          find(thread, this->Open[k], this->Ahead[k]);
        }
      });
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
  /** The items before End that are searched, unless that is not worth while, and what was found. */
  std::vector<std::size_t> Open;
  bool IsSearched = false;
  std::vector<Found> Ahead;
  std::size_t End = 0;
  /** The stamp of the first tetrahedron made since then. */
  std::int64_t NextStamp = 0;
};
} // namespace cdm

#endif
