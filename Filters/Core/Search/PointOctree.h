// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointOctree.h
 * @brief Non-uniform point bucket octree (thesis 6.4.2) with tight boxes; points come and go.
 *
 * A leaf holds up to LeafCapacity points with their coordinates side by side. A full leaf is split
 * at the center of the box of its points, which separates at least two of them, so that any
 * distribution of distinct points works: graded 1:10000, on surfaces, in clusters.
 *
 * Invariants: the box of a node is the tight box of the points that have been added below it; a
 * node has either eight children, stored next to each other, or a leaf. Points are distinct.
 *
 * Cost: O(log n) for usual distributions to add or remove a point; about 60 bytes per point.
 */
#ifndef cdmPointOctree_h
#define cdmPointOctree_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Box.h"

#include <algorithm>
#include <vector>

namespace cdm
{
class PointOctree
{
public:
  static constexpr int LeafCapacity = 8;

  /** Add a point that differs from all points added before. */
  void Insert(Id id, const Vec3& position);

  /** Remove a point that was added with this id and position. */
  void Remove(Id id, const Vec3& position);

  /** Add all points, with their index as id; into an empty octree much faster than one by one. */
  void Insert(const std::vector<Vec3>& points);

  /**
   * Visit the points of all nodes that matter to the search, depth first. Search has to have
   *   double Order(const Box&)       among the children of a node those with a smaller value are
   *                                  visited first; a node for which it is infinite, now or when
   *                                  its turn comes, is left out;
   *   void Visit(Id, const Vec3&)    a point.
   * Points outside of the reach need not be visited: to know it saves looking at most of the nodes
   * on the way down.
   */
  template <typename Search>
  void Visit(Search& search, const Box& reach = Box::MakeInfinite()) const
  {
    if (!this->Nodes.empty())
    {
      this->VisitNode(0, search, reach);
    }
  }

private:
  struct Node
  {
    Box Bounds;
    Vec3 Center;
    /** Index of the first of eight children, or NoId for a leaf. */
    Id FirstChild = NoId;
    /** Index of the leaf, or NoId if the node is empty or has children. */
    Id Leaf = NoId;
  };

  struct LeafPoints
  {
    int Count = 0;
    Id Ids[LeafCapacity];
    Vec3 Positions[LeafCapacity];
  };

  static Vec3 GetCenter(const Box& bounds);
  static int GetChild(const Node& node, const Vec3& p)
  {
    return (p.X >= node.Center.X ? 1 : 0) | (p.Y >= node.Center.Y ? 2 : 0) |
      (p.Z >= node.Center.Z ? 4 : 0);
  }

  void Split(Id node);
  void Build(Id node, const std::vector<Vec3>& points, Id* begin, Id* end);

  template <typename Search>
  void VisitLeaf(const Node& node, Search& search) const
  {
    if (node.Leaf != NoId)
    {
      const LeafPoints& leaf = this->Leaves[node.Leaf];
      for (int i = 0; i < leaf.Count; ++i)
      {
        search.Visit(leaf.Ids[i], leaf.Positions[i]);
      }
    }
  }

  template <typename Search>
  void VisitNode(Id index, Search& search, const Box& reach) const
  {
    // As long as all of the reach is within one child, only centers are looked at.
    int lowest = GetChild(this->Nodes[index], reach.Low);
    int highest = GetChild(this->Nodes[index], reach.High);
    while (lowest == highest && this->Nodes[index].FirstChild != NoId)
    {
      index = this->Nodes[index].FirstChild + lowest;
      lowest = GetChild(this->Nodes[index], reach.Low);
      highest = GetChild(this->Nodes[index], reach.High);
    }
    const Node& node = this->Nodes[index];
    if (node.FirstChild == NoId)
    {
      this->VisitLeaf(node, search);
      return;
    }
    double orders[8];
    Id children[8];
    int count = 0;
    for (int i = 0; i < 8; ++i)
    {
      // On each axis the children in reach lie between the two.
      if ((i & ~highest) != 0 || (lowest & ~i) != 0)
      {
        continue;
      }
      const Id child = node.FirstChild + i;
      const Box& bounds = this->Nodes[child].Bounds;
      if (bounds.IsEmpty())
      {
        continue;
      }
      const double order = search.Order(bounds);
      if (order == Infinity)
      {
        continue;
      }
      int place = count++;
      for (; place > 0 && orders[place - 1] > order; --place)
      {
        orders[place] = orders[place - 1];
        children[place] = children[place - 1];
      }
      orders[place] = order;
      children[place] = child;
    }
    for (int i = 0; i < count; ++i)
    {
      // What has been found among the nearer children may rule this one out by now.
      if (i == 0 || search.Order(this->Nodes[children[i]].Bounds) != Infinity)
      {
        this->VisitNode(children[i], search, reach);
      }
    }
  }

  std::vector<Node> Nodes;
  std::vector<LeafPoints> Leaves;
};
} // namespace cdm

#endif
