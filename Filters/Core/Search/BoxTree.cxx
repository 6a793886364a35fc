// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/BoxTree.h"

#include <algorithm>
#include <numeric>

namespace cdm
{
namespace
{
constexpr Id LeafSize = 4;
}

BoxTree::BoxTree(const std::vector<Box>& boxes) : Order(boxes.size())
{
  std::iota(this->Order.begin(), this->Order.end(), 0);
  if (!this->Order.empty())
  {
    std::vector<Vec3> centers;
    centers.reserve(boxes.size());
    for (const Box& box : boxes)
    {
      // Halves first: the sum of large coordinates may overflow.
      centers.push_back(0.5 * box.Low + 0.5 * box.High);
    }
    this->Nodes.reserve(this->Order.size());
    this->Build(boxes, centers, 0, static_cast<Id>(this->Order.size()));
  }
  this->Boxes.reserve(boxes.size());
  for (const Id id : this->Order)
  {
    this->Boxes.push_back(boxes[id]);
  }
}

void BoxTree::Build(
  const std::vector<Box>& boxes, const std::vector<Vec3>& centers, Id begin, Id end)
{
  const std::size_t index = this->Nodes.size();
  this->Nodes.emplace_back();
  Node node;
  node.Begin = begin;
  node.End = end;
  for (Id i = begin; i < end; ++i)
  {
    node.Bounds.Add(boxes[this->Order[i]]);
  }
  if (end - begin > LeafSize)
  {
    const Vec3 size = node.Bounds.High - node.Bounds.Low;
    const int axis = size.X >= size.Y && size.X >= size.Z ? 0 : size.Y >= size.Z ? 1 : 2;
    const Id middle = begin + (end - begin) / 2;
    std::nth_element(this->Order.begin() + begin, this->Order.begin() + middle,
      this->Order.begin() + end,
      [&centers, axis](Id a, Id b)
      {
        const double left = centers[a][axis];
        const double right = centers[b][axis];
        return left != right ? left < right : a < b;
      });
    this->Build(boxes, centers, begin, middle);
    node.Right = static_cast<Id>(this->Nodes.size());
    this->Build(boxes, centers, middle, end);
  }
  this->Nodes[index] = node;
}
} // namespace cdm
