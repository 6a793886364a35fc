// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoxOctree.h
 * @brief Finds those of many boxes that overlap a given one; boxes may come and go (in BoxTree.h
 *   they may not).
 *
 * A loose octree: a box lies in the cell of its center, on the deepest level where it is not larger
 * than the cell; so it reaches no further than half a cell beyond it. Boxes are closed: touching
 * counts.
 *
 * Cost: O(levels) to add or remove; a query visits cells that overlap the box and are not empty. 76
 * bytes per box, about as many for the cells.
 */
#ifndef cdmBoxOctree_h
#define cdmBoxOctree_h

#include "Core/Basics/Types.h"
#include "Core/Geometry/Box.h"

#include <array>
#include <vector>

namespace cdm
{
class BoxOctree
{
public:
  /** bounds holds all boxes that will come; room for the ids 0 to capacity - 1, which may grow. */
  BoxOctree(const Box& bounds, Id capacity);

  /** Adds a box under an id that is not in use. */
  void Add(Id id, const Box& box);

  void Remove(Id id);

  const Box& GetBox(Id id) const { return this->Entries[id].Bounds; }

  /** Ids of the boxes that overlap the given one, ascending. */
  void Find(const Box& box, std::vector<Id>& ids) const;

private:
  static constexpr int MaximumDepth = 24;

  struct Cell
  {
    std::array<Id, 8> Children;
    Vec3 Center;
    double HalfEdge;
    Id Parent;
    /** Boxes in this cell and below. */
    Id Count;
    /** The first box of this cell. */
    Id First;
  };
  struct Entry
  {
    Box Bounds;
    Id Cell = NoId;
    Id Previous = NoId;
    Id Next = NoId;
  };

  Id AddCell(const Vec3& center, double halfEdge, Id parent);

  std::vector<Cell> Cells;
  std::vector<Entry> Entries;
};
} // namespace cdm

#endif
