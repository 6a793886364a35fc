// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoxTree.h
 * @brief Finds those of many fixed boxes that overlap a given one, or each other, or what is nearest
 *   to a point: a static bounding volume hierarchy.
 *
 * Boxes are closed: touching counts. Built once, by splitting at the median of the centers along
 * the longest side. Queries are const and thread safe; they visit boxes in an order that depends on
 * the boxes only, but not in the order of their ids.
 *
 * Cost: O(n log n) to build, on several threads if asked for, with the same result; 48 bytes per box
 * and about 28 for the nodes.
 */
#ifndef cdmBoxTree_h
#define cdmBoxTree_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Box.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace cdm
{
class BoxTree
{
public:
  /** @param numberOfThreads 0: one for each processor core */
  explicit BoxTree(const std::vector<Box>& boxes, int numberOfThreads = 1);

  /** Calls visit(id) for each box that overlaps the given one. */
  template <class Function>
  void VisitOverlaps(const Box& box, Function&& visit) const
  {
    this->Visit([&box](const Box& bounds) { return bounds.Overlaps(box); }, visit);
  }
  /** Calls visit(id) for each box nearer to the point than the distance. */
  template <class Function>
  void VisitNear(const Vec3& point, double distance, Function&& visit) const
  {
    this->Visit([&point, square = distance * distance](const Box& bounds)
      { return bounds.GetSquaredDistance(point) < square; },
      visit);
  }

  /**
   * Calls visit(a, b) once for each two boxes that overlap. mayGoOn(progress), with a progress from
   * 0 to 1, is asked now and then; false if it says so, and then pairs are missing.
   */
  template <class Function, class Condition>
  bool VisitPairs(Function&& visit, const Condition& mayGoOn) const;

  /**
   * The smallest getDistance(id) of what is in the boxes, or the limit if that is smaller. No
   * distance is smaller than that of the box.
   */
  template <class Function>
  double FindDistance(const Vec3& point, double limit, Function&& getDistance) const;

private:
  // Nodes in depth-first order: the left child of an inner node follows it.
  struct Node
  {
    Box Bounds;
    /** Leaf: range of Order. */
    Id Begin = 0;
    Id End = 0;
    /** Inner node: the right child; leaf: NoId. */
    Id Right = NoId;
  };

  /** Builds the node of a range of Order, and all below it, from an index on. */
  void Build(const std::vector<Box>& boxes, const std::vector<Vec3>& centers, Id begin, Id end,
    Id index, int numberOfThreads);
  template <class Function>
  void VisitPairsOfLeaves(const Node& a, const Node& b, Function&& visit) const;
  template <class Condition, class Function>
  void Visit(const Condition& isWanted, Function&& visit) const;

  std::vector<Id> Order;
  /** The boxes in that order. */
  std::vector<Box> Boxes;
  std::vector<Node> Nodes;
};

/** Calls visit(id) for each box that is wanted; then all boxes that contain it are. */
template <class Condition, class Function>
void BoxTree::Visit(const Condition& isWanted, Function&& visit) const
{
  // The depth of a tree split at medians is below the number of bits of an Id.
  Id stack[64];
  int size = 0;
  Id index = this->Nodes.empty() ? NoId : 0;
  while (index != NoId)
  {
    const Node& node = this->Nodes[index];
    if (node.Right == NoId)
    {
      for (Id i = node.Begin; i < node.End; ++i)
      {
        if (isWanted(this->Boxes[i]))
        {
          visit(this->Order[i]);
        }
      }
    }
    else
    {
      // Both children at once: a node that comes from the stack need not be tested any more.
      const bool isLeft = isWanted(this->Nodes[index + 1].Bounds);
      const bool isRight = isWanted(this->Nodes[node.Right].Bounds);
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
}

template <class Function, class Condition>
bool BoxTree::VisitPairs(Function&& visit, const Condition& mayGoOn) const
{
  constexpr std::size_t StepsBetweenQuestions = 1024;
  std::size_t steps = 0;
  Id done = 0;
  // Pairs of nodes that overlap, or twice the same one.
  std::vector<std::pair<Id, Id>> stack;
  if (!this->Nodes.empty())
  {
    stack.emplace_back(0, 0);
  }
  while (!stack.empty())
  {
    const auto [first, second] = stack.back();
    stack.pop_back();
    const Node& a = this->Nodes[first];
    const Node& b = this->Nodes[second];
    if (steps++ % StepsBetweenQuestions == 0 &&
      !mayGoOn(static_cast<double>(done) / this->Order.size()))
    {
      return false;
    }
    const auto push = [&](Id left, Id right)
    {
      if (this->Nodes[left].Bounds.Overlaps(this->Nodes[right].Bounds))
      {
        stack.emplace_back(left, right);
      }
    };
    if (a.Right == NoId && b.Right == NoId)
    {
      this->VisitPairsOfLeaves(a, b, visit);
      done = std::max(done, a.End);
    }
    else if (first == second)
    {
      stack.emplace_back(a.Right, a.Right);
      push(first + 1, a.Right);
      stack.emplace_back(first + 1, first + 1);
    }
    else if (b.Right == NoId || (a.Right != NoId && a.End - a.Begin >= b.End - b.Begin))
    {
      push(a.Right, second);
      push(first + 1, second);
    }
    else
    {
      push(first, b.Right);
      push(first, second + 1);
    }
  }
  return true;
}

template <class Function>
void BoxTree::VisitPairsOfLeaves(const Node& a, const Node& b, Function&& visit) const
{
  for (Id i = a.Begin; i < a.End; ++i)
  {
    for (Id j = &a == &b ? i + 1 : b.Begin; j < b.End; ++j)
    {
      if (this->Boxes[i].Overlaps(this->Boxes[j]))
      {
        visit(this->Order[i], this->Order[j]);
      }
    }
  }
}

template <class Function>
double BoxTree::FindDistance(const Vec3& point, double limit, Function&& getDistance) const
{
  Id stack[64];
  int size = 0;
  if (!this->Nodes.empty())
  {
    stack[size++] = 0;
  }
  while (size > 0)
  {
    const Id index = stack[--size];
    const Node& node = this->Nodes[index];
    if (!(node.Bounds.GetSquaredDistance(point) < limit * limit))
    {
      continue;
    }
    if (node.Right != NoId)
    {
      // The nearer child comes first: it leaves less of the other one.
      Id children[2] = { index + 1, node.Right };
      if (this->Nodes[children[1]].Bounds.GetSquaredDistance(point) <
        this->Nodes[children[0]].Bounds.GetSquaredDistance(point))
      {
        std::swap(children[0], children[1]);
      }
      stack[size++] = children[1];
      stack[size++] = children[0];
      continue;
    }
    for (Id i = node.Begin; i < node.End; ++i)
    {
      if (this->Boxes[i].GetSquaredDistance(point) < limit * limit)
      {
        limit = std::min(limit, static_cast<double>(getDistance(this->Order[i])));
      }
    }
  }
  return limit;
}
} // namespace cdm

#endif
