// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/EmptySphereSearch.h"

#include "Core/Basics/ParallelLoop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cdm
{
namespace
{
constexpr Id LeafSize = 12;
/** Up to this many points one thread builds the tree. */
constexpr Id FewPoints = 1 << 14;
} // namespace

EmptySphereSearch::EmptySphereSearch(const std::vector<Vec3>& points, int numberOfThreads)
  : Order(points.size()), Positions(points.size())
{
  if (points.empty())
  {
    return;
  }
  std::iota(this->Order.begin(), this->Order.end(), 0);
  const auto count = static_cast<Id>(points.size());
  this->Nodes.resize(CountNodes(count));
  // The upper levels one after the other, the trees below them each by itself.
  constexpr std::size_t numberOfSubtrees = 64;
  std::vector<Subtree> subtrees{ { 0, count, 0 } };
  while (subtrees.size() < numberOfSubtrees && count > FewPoints)
  {
    std::vector<Subtree> halves(2 * subtrees.size());
    const auto split = [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Id middle = this->Split(points, subtrees[i]);
        const Id right = subtrees[i].Node + 1 + CountNodes(middle - subtrees[i].Begin);
        this->Nodes[subtrees[i].Node].Right = right;
        halves[2 * i] = { subtrees[i].Begin, middle, subtrees[i].Node + 1 };
        halves[2 * i + 1] = { middle, subtrees[i].End, right };
      }
    };
    ParallelLoop(subtrees.size(), { numberOfThreads, 1 }, {}, "", split);
    subtrees.swap(halves);
  }
  const auto build = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      this->Build(points, subtrees[i]);
      for (Id place = subtrees[i].Begin; place < subtrees[i].End; ++place)
      {
        this->Positions[place] = points[this->Order[place]];
      }
    }
  };
  ParallelLoop(subtrees.size(), { numberOfThreads, 1 }, {}, "", build);
}

Id EmptySphereSearch::CountNodes(Id numberOfPoints)
{
  return numberOfPoints <= LeafSize
    ? 1
    : 1 + CountNodes(numberOfPoints / 2) + CountNodes(numberOfPoints - numberOfPoints / 2);
}

Id EmptySphereSearch::Split(const std::vector<Vec3>& points, const Subtree& subtree)
{
  Node& node = this->Nodes[subtree.Node];
  node.Begin = subtree.Begin;
  node.End = subtree.End;
  node.Lower = points[this->Order[subtree.Begin]];
  node.Upper = node.Lower;
  for (Id i = subtree.Begin + 1; i < subtree.End; ++i)
  {
    const Vec3& point = points[this->Order[i]];
    for (int axis = 0; axis < 3; ++axis)
    {
      node.Lower[axis] = std::min(node.Lower[axis], point[axis]);
      node.Upper[axis] = std::max(node.Upper[axis], point[axis]);
    }
  }
  if (subtree.End - subtree.Begin <= LeafSize)
  {
    return NoId;
  }
  const Vec3 extent = node.Upper - node.Lower;
  const int axis = extent.X >= extent.Y && extent.X >= extent.Z ? 0 : extent.Y >= extent.Z ? 1 : 2;
  const Id middle = subtree.Begin + (subtree.End - subtree.Begin) / 2;
  std::nth_element(this->Order.begin() + subtree.Begin, this->Order.begin() + middle,
    this->Order.begin() + subtree.End,
    [&](Id a, Id b) { return points[a][axis] < points[b][axis]; });
  return middle;
}

Id EmptySphereSearch::Build(const std::vector<Vec3>& points, const Subtree& subtree)
{
  const Id middle = this->Split(points, subtree);
  if (middle == NoId)
  {
    return subtree.Node + 1;
  }
  const Id right = this->Build(points, { subtree.Begin, middle, subtree.Node + 1 });
  this->Nodes[subtree.Node].Right = right;
  return this->Build(points, { middle, subtree.End, right });
}
} // namespace cdm
