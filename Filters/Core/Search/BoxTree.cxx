// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/BoxTree.h"

#include "Core/Basics/ParallelLoop.h"

#include <algorithm>
#include <numeric>

namespace cdm
{
namespace
{
constexpr Id LeafSize = 4;
/** A range of so many boxes, some half a millisecond, is worth another thread. */
constexpr Id FewestForThread = 4096;

/** The number of nodes of a tree of so many boxes. */
Id CountNodes(Id count)
{
  return count > LeafSize ? 1 + CountNodes(count / 2) + CountNodes(count - count / 2) : 1;
}
} // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes, int numberOfThreads) : Order(boxes.size())
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
    const Id count = static_cast<Id>(this->Order.size());
    this->Nodes.resize(CountNodes(count));
    this->Build(boxes, centers, 0, count, 0, static_cast<int>(GetNumberOfThreads(numberOfThreads)));
  }
  this->Boxes.reserve(boxes.size());
  for (const Id id : this->Order)
  {
    this->Boxes.push_back(boxes[id]);
  }
}

void BoxTree::Build(const std::vector<Box>& boxes, const std::vector<Vec3>& centers, Id begin,
  Id end, Id index, int numberOfThreads)
{
  Node& node = this->Nodes[index];
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
    node.Right = index + 1 + CountNodes(middle - begin);
    const int parts = end - begin < FewestForThread ? 1 : std::min(2, numberOfThreads);
    const auto buildChild = [&](bool isRight, int threads)
    {
      this->Build(boxes, centers, isRight ? middle : begin, isRight ? end : middle,
        isRight ? node.Right : index + 1, threads);
    };
    if (parts < 2)
    {
      buildChild(false, 1);
      buildChild(true, 1);
      return;
    }
    RunOnThreads(
      2, [&](int part) { buildChild(part == 1, (numberOfThreads + (part == 0 ? 1 : 0)) / 2); });
  }
}
} // namespace cdm
