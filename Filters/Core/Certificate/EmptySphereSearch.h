// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EmptySphereSearch.h
 * @brief Finds points that may lie inside of a sphere: the search behind SphereCriteria.h.
 *
 * Method: boxes of a k-d tree that the sphere surely does not touch are left out (SphereForm.h, or
 * EnclosingBall.h).
 *
 * Guarantees: no point strictly inside or on the sphere is left out (up to overflow, where
 * nothing is left out).
 * Cost: O(n log n) to build; 28 bytes per point, and 10 to 22 in the nodes.
 */
#ifndef cdmEmptySphereSearch_h
#define cdmEmptySphereSearch_h

#include "Core/Basics/SortedIds.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <algorithm>
#include <array>
#include <vector>

namespace cdm
{
class EmptySphereSearch
{
public:
  /** The points have to be finite. Threads: 0: one for each processor core. */
  explicit EmptySphereSearch(const std::vector<Vec3>& points, int numberOfThreads = 1);

  /**
   * Calls isInside(id) for every point that may lie in the sphere, until it returns true; returns
   * whether it did. The simplex's own vertices are passed over.
   * @param sphere has MayTouch() and MayHold() as SphereForm does
   */
  template <typename Sphere, typename Simplex, typename Predicate>
  bool FindInside(const Sphere& sphere, const Simplex& simplex, Predicate&& isInside) const
  {
    // Every level of the tree leaves at most one node behind.
    std::array<Id, 64> stack;
    int size = 0;
    Id index = this->Nodes.empty() ? NoId : 0;
    while (index != NoId)
    {
      const Node& node = this->Nodes[index];
      if (node.Right == NoId)
      {
        if (this->IsAnyInside(node, sphere, simplex, isInside))
        {
          return true;
        }
      }
      else
      {
        // Both children at once: a node that comes from the stack need not be tested any more.
        const bool isLeft = this->MayTouch(sphere, index + 1);
        const bool isRight = this->MayTouch(sphere, node.Right);
        if (isLeft && isRight)
        {
          stack[size++] = node.Right;
        }
        if (isLeft || isRight)
        {
          index = isLeft ? index + 1 : node.Right;
          continue;
        }
      }
      index = size > 0 ? stack[--size] : NoId;
    }
    return false;
  }

private:
  /** The left child follows its parent. */
  struct Node
  {
    Vec3 Lower;
    Vec3 Upper;
    Id Begin = 0;
    Id End = 0;
    /** NoId: a leaf. */
    Id Right = NoId;
  };

  /** A range of points [Begin, End) in the order, and the index of its root node. */
  struct Subtree
  {
    Id Begin;
    Id End;
    Id Node;
  };

  template <typename Sphere>
  bool MayTouch(const Sphere& sphere, Id node) const
  {
    return sphere.MayTouch(this->Nodes[node].Lower, this->Nodes[node].Upper);
  }
  template <typename Sphere, typename Simplex, typename Predicate>
  bool IsAnyInside(
    const Node& leaf, const Sphere& sphere, const Simplex& simplex, Predicate&& isInside) const
  {
    for (Id i = leaf.Begin; i < leaf.End; ++i)
    {
      if (sphere.MayHold(this->Positions[i]) && !Contains(simplex, this->Order[i]) &&
        isInside(this->Order[i]))
      {
        return true;
      }
    }
    return false;
  }
  static Id CountNodes(Id numberOfPoints);
  /** Makes the root only. Returns the first point of its right child, or NoId if it is a leaf. */
  Id Split(const std::vector<Vec3>& points, const Subtree& subtree);
  /** Builds all nodes; returns the index after the last one. */
  Id Build(const std::vector<Vec3>& points, const Subtree& subtree);

  std::vector<Node> Nodes;
  std::vector<Id> Order;
  /** The points in that order. */
  std::vector<Vec3> Positions;
};
} // namespace cdm

#endif
