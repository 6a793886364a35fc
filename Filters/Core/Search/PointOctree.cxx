// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/PointOctree.h"

#include <numeric>

namespace cdm
{
void PointOctree::Insert(const std::vector<Vec3>& points)
{
  if (!this->Nodes.empty())
  {
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      this->Insert(static_cast<Id>(i), points[i]);
    }
    return;
  }
  if (points.empty())
  {
    return;
  }
  std::vector<Id> ids(points.size());
  std::iota(ids.begin(), ids.end(), 0);
  this->Nodes.emplace_back();
  this->Build(0, points, ids.data(), ids.data() + ids.size());
}

/** Nodes follow those of their older siblings: what is near in space is near in memory. */
void PointOctree::Build(Id index, const std::vector<Vec3>& points, Id* begin, Id* end)
{
  Box bounds;
  for (const Id* id = begin; id != end; ++id)
  {
    bounds.Add(points[*id]);
  }
  this->Nodes[index].Bounds = bounds;
  if (end - begin <= LeafCapacity)
  {
    this->Nodes[index].Leaf = static_cast<Id>(this->Leaves.size());
    this->Leaves.emplace_back();
    LeafPoints& leaf = this->Leaves.back();
    for (; begin != end; ++begin)
    {
      leaf.Ids[leaf.Count] = *begin;
      leaf.Positions[leaf.Count++] = points[*begin];
    }
    return;
  }
  const Vec3 center = GetCenter(bounds);
  const Id firstChild = static_cast<Id>(this->Nodes.size());
  this->Nodes[index].Center = center;
  this->Nodes[index].FirstChild = firstChild;
  this->Nodes.resize(this->Nodes.size() + 8);
  // Halves along z, their halves along y, and those along x: the order of GetChild().
  Id* limits[9] = { begin, end, end, end, end, end, end, end, end };
  for (int axis = 2, step = 4; axis >= 0; --axis, step /= 2)
  {
    for (int child = 0; child < 8; child += 2 * step)
    {
      limits[child + step] = std::partition(limits[child], limits[child + 2 * step],
        [&points, &center, axis](Id id) { return points[id][axis] < center[axis]; });
    }
  }
  for (int child = 0; child < 8; ++child)
  {
    if (limits[child] != limits[child + 1])
    {
      this->Build(firstChild + child, points, limits[child], limits[child + 1]);
    }
  }
}

void PointOctree::Insert(Id id, const Vec3& position)
{
  if (this->Nodes.empty())
  {
    this->Nodes.emplace_back();
  }
  Id current = 0;
  for (;;)
  {
    Node& node = this->Nodes[current];
    node.Bounds.Add(position);
    if (node.FirstChild != NoId)
    {
      current = node.FirstChild + GetChild(node, position);
      continue;
    }
    if (node.Leaf == NoId)
    {
      node.Leaf = static_cast<Id>(this->Leaves.size());
      this->Leaves.emplace_back();
    }
    LeafPoints& leaf = this->Leaves[node.Leaf];
    if (leaf.Count < LeafCapacity)
    {
      leaf.Ids[leaf.Count] = id;
      leaf.Positions[leaf.Count] = position;
      ++leaf.Count;
      return;
    }
    this->Split(current);
  }
}

void PointOctree::Remove(Id id, const Vec3& position)
{
  Id current = 0;
  while (this->Nodes[current].FirstChild != NoId)
  {
    current = this->Nodes[current].FirstChild + GetChild(this->Nodes[current], position);
  }
  LeafPoints& leaf = this->Leaves[this->Nodes[current].Leaf];
  const auto place = std::find(leaf.Ids, leaf.Ids + leaf.Count, id) - leaf.Ids;
  --leaf.Count;
  leaf.Ids[place] = leaf.Ids[leaf.Count];
  leaf.Positions[place] = leaf.Positions[leaf.Count];
}

Vec3 PointOctree::GetCenter(const Box& bounds)
{
  Vec3 center;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = bounds.Low[axis];
    const double high = bounds.High[axis];
    const double middle = low + 0.5 * (high - low);
    // Between neighbouring doubles there is no center: the upper one still separates them.
    center[axis] = middle > low ? middle : high;
  }
  return center;
}

void PointOctree::Split(Id index)
{
  const Id firstChild = static_cast<Id>(this->Nodes.size());
  this->Nodes.resize(this->Nodes.size() + 8);
  Node& node = this->Nodes[index];
  node.Center = GetCenter(node.Bounds);
  node.FirstChild = firstChild;
  const LeafPoints points = this->Leaves[node.Leaf];
  Id freeLeaf = node.Leaf;
  node.Leaf = NoId;
  for (int i = 0; i < points.Count; ++i)
  {
    Node& child = this->Nodes[firstChild + GetChild(node, points.Positions[i])];
    if (child.Leaf == NoId)
    {
      if (freeLeaf == NoId)
      {
        freeLeaf = static_cast<Id>(this->Leaves.size());
        this->Leaves.emplace_back();
      }
      child.Leaf = freeLeaf;
      freeLeaf = NoId;
      this->Leaves[child.Leaf].Count = 0;
    }
    LeafPoints& leaf = this->Leaves[child.Leaf];
    leaf.Ids[leaf.Count] = points.Ids[i];
    leaf.Positions[leaf.Count] = points.Positions[i];
    ++leaf.Count;
    child.Bounds.Add(points.Positions[i]);
  }
}
} // namespace cdm
