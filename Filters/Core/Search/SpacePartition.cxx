// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/SpacePartition.h"

#include <algorithm>

namespace cdm
{
SpacePartition::SpacePartition(std::vector<Vec3> sample, int numberOfParts)
  : Cells(static_cast<std::size_t>(numberOfParts))
{
  const Box nothing;
  this->Root = this->Build(
    sample.data(), sample.data() + sample.size(), 0, numberOfParts, { nothing.High, nothing.Low });
}

int SpacePartition::GetPart(const Vec3& position) const
{
  int node = this->Root;
  while (node >= 0)
  {
    const Node& cut = this->Nodes[static_cast<std::size_t>(node)];
    node = position[cut.Axis] < cut.Cut ? cut.Below : cut.Above;
  }
  return -1 - node;
}

int SpacePartition::Build(Vec3* begin, Vec3* end, int firstPart, int numberOfParts, const Box& cell)
{
  if (numberOfParts == 1)
  {
    this->Cells[static_cast<std::size_t>(firstPart)] = cell;
    return -1 - firstPart;
  }
  Box bounds;
  std::for_each(begin, end, [&bounds](const Vec3& p) { bounds.Add(p); });
  int axis = 0;
  for (int other = 1; other < 3; ++other)
  {
    axis =
      bounds.High[other] - bounds.Low[other] > bounds.High[axis] - bounds.Low[axis] ? other : axis;
  }
  const int below = numberOfParts / 2;
  Vec3* middle = begin + (end - begin) * below / numberOfParts;
  std::nth_element(
    begin, middle, end, [axis](const Vec3& p, const Vec3& q) { return p[axis] < q[axis]; });
  const double cut = begin != end ? (*middle)[axis] : 0.0;
  middle = std::partition(begin, end, [&](const Vec3& p) { return p[axis] < cut; });
  const std::size_t index = this->Nodes.size();
  Box lowCell = cell;
  Box highCell = cell;
  lowCell.High[axis] = std::min(cut, cell.High[axis]);
  highCell.Low[axis] = std::max(cut, cell.Low[axis]);
  this->Nodes.push_back({ axis, cut, 0, 0 });
  const int low = this->Build(begin, middle, firstPart, below, lowCell);
  const int high = this->Build(middle, end, firstPart + below, numberOfParts - below, highCell);
  this->Nodes[index].Below = low;
  this->Nodes[index].Above = high;
  return static_cast<int>(index);
}
} // namespace cdm
