// SPDX-License-Identifier: BSD-3-Clause
#include "RoundHole.h"

#include "Device.h"

#include <algorithm>

namespace cdm
{
RoundHole AddRoundHole(LayeredStructure& structure, const std::array<Id, 4>& corners, double radius,
  int numberOfSegments)
{
  // Two cuts from opposite corners of the rectangle to the vertices of the circle that lie farthest
  // in the direction of these corners cannot meet the circle before.
  const int n = numberOfSegments;
  RoundHole hole;
  std::vector<double> reach;
  for (int i = 0; i < n; ++i)
  {
    const CosineSine direction = GetCosineSine(360.0 * i / n);
    const double u = radius * direction.Cosine;
    const double v = radius * direction.Sine;
    hole.Circle.push_back(structure.AddVertex(u, v));
    reach.push_back(u + v);
  }
  const auto getIndex = [&reach](std::vector<double>::const_iterator position)
  { return static_cast<int>(position - reach.cbegin()); };
  const int farthest = getIndex(std::max_element(reach.cbegin(), reach.cend()));
  const int nearest = getIndex(std::min_element(reach.cbegin(), reach.cend()));
  const auto addArc = [&](std::vector<Id>& outline, int begin, int end)
  {
    for (int i = begin; i != end; i = (i + n - 1) % n)
    {
      outline.push_back(hole.Circle[i]);
    }
    outline.push_back(hole.Circle[end]);
  };
  hole.Surroundings[0] = { corners[0], corners[1], corners[2] };
  addArc(hole.Surroundings[0], farthest, nearest);
  hole.Surroundings[1] = { corners[2], corners[3], corners[0] };
  addArc(hole.Surroundings[1], nearest, farthest);
  return hole;
}
} // namespace cdm
