// SPDX-License-Identifier: BSD-3-Clause
#include "PointOctree.h"

namespace cdm
{
void PointOctree::Insert(const std::vector<Vec3>& points)
{
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    this->Insert(static_cast<Id>(i), points[i]);
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

void PointOctree::Split(Id index)
{
  const Id firstChild = static_cast<Id>(this->Nodes.size());
  this->Nodes.resize(this->Nodes.size() + 8);
  Node& node = this->Nodes[index];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = node.Bounds.Low[axis];
    const double high = node.Bounds.High[axis];
    const double center = low + 0.5 * (high - low);
    // Between neighbouring doubles there is no center: the upper one still separates them.
    node.Center[axis] = center > low ? center : high;
  }
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
}
