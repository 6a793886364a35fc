// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LookAhead.h
 * @brief Threads that search what is to be done about the next slivers of a list, before their turn
 *   comes.
 *
 * Slivers are mended one after the other, as each change of the mesh matters for those that follow.
 * But a search sees some hundred tetrahedra only, and few of these are replaced before it is the
 * sliver's turn.
 *
 * Method:
 *  1. the next slivers are searched at the same time, each by one thread, in the mesh as it is;
 *     the search notes which tetrahedra it has seen;
 *  2. in its turn, the change of a sliver is what was found, if all of these tetrahedra are still
 *     there; if not, the caller searches again.
 *
 * Guarantees: the changes are those of one thread, in the same order, whatever the number of
 * threads. Cost: one search in fourteen is repeated, in a mesh of 186,000 tetrahedra.
 */
#ifndef cdmLookAhead_h
#define cdmLookAhead_h

#include "Core/Basics/Threads.h"
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

  explicit LookAhead(const RefinedMesh& mesh) : Mesh(mesh) {}

  /** Forgets what was found: another list begins. */
  void Clear() { this->Ahead.clear(); }

  /**
   * The change of item i, or null if it has to be searched.
   * @param count number of items of the list
   * @param numberOfThreads 1: nothing is searched ahead
   * @param isOpen (i): whether an item is worth a search
   * @param find (thread, i): the Found of an item, in the mesh as it is; called on threads
   */
  template <typename IsOpen, typename Find>
  const Change* Get(
    std::size_t i, std::size_t count, int numberOfThreads, IsOpen&& isOpen, Find&& find)
  {
    if (numberOfThreads < 2)
    {
      return nullptr;
    }
    if (this->Ahead.empty() || i >= this->First + this->Ahead.size())
    {
      this->Search(i, count, numberOfThreads, isOpen, find);
    }
    const Foreseen& foreseen = this->Ahead[i - this->First];
    return foreseen.IsKnown && this->IsUnchanged(foreseen.Result.Visited) ? &foreseen.Result.What
                                                                          : nullptr;
  }

private:
  struct Foreseen
  {
    bool IsKnown = false;
    Found Result;
  };
  /** One sliver for so many tetrahedra is searched ahead: the closer, the more searches are late. */
  static constexpr std::size_t TetrahedraPerItem = 4000;
  static constexpr std::size_t FewestItems = 8;
  static constexpr std::size_t MostItems = 256;

  template <typename IsOpen, typename Find>
  void Search(
    std::size_t first, std::size_t count, int numberOfThreads, IsOpen&& isOpen, Find&& find)
  {
    const std::size_t most = std::clamp(
      this->Mesh.GetMesh().Tetrahedra.size() / TetrahedraPerItem, FewestItems, MostItems);
    this->First = first;
    this->NextStamp = this->Mesh.GetTetrahedra().GetNextStamp();
    this->Ahead.clear();
    std::vector<std::size_t> open;
    for (std::size_t i = first; i < count && open.size() < most; ++i)
    {
      this->Ahead.emplace_back();
      if (isOpen(i))
      {
        open.push_back(i);
      }
    }
    const int threads = static_cast<int>(
      std::min<std::size_t>(static_cast<std::size_t>(numberOfThreads), open.size()));
    if (threads < 2)
    {
      return;
    }
    std::atomic<std::size_t> next{ 0 };
    this->Mesh.Freeze(true);
    RunOnThreads(threads,
      [&](int thread)
      {
        for (std::size_t k = next++; k < open.size(); k = next++)
        {
          this->Ahead[open[k] - first] = { true, find(thread, open[k]) };
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
  /** For the items from First on, and the stamp of the first tetrahedron made since then. */
  std::vector<Foreseen> Ahead;
  std::size_t First = 0;
  std::int64_t NextStamp = 0;
};
} // namespace cdm

#endif
