// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/TetrahedronLimits.h"

#include "Core/Geometry/Measures.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cdm
{
TetrahedronFault TetrahedronLimits::Find(
  const std::array<Vec3, 4>& vertices, bool isShapeTested, Vec3& target, double& severity) const
{
  double longest2 = 0.0;
  double shortest2 = Infinity;
  int shortestEdge = 0;
  for (int e = 0; e < 6; ++e)
  {
    const double length2 =
      SquaredNorm(vertices[TetrahedronEdges[e][1]] - vertices[TetrahedronEdges[e][0]]);
    longest2 = std::max(longest2, length2);
    if (length2 < shortest2)
    {
      shortest2 = length2;
      shortestEdge = e;
    }
  }
  const Vec3 center = GetCircumcenter(vertices[0], vertices[1], vertices[2], vertices[3]);
  const double radius2 = SquaredNorm(center - vertices[0]);
  const double longest = std::sqrt(longest2);
  bool isLarge = (this->MaximumEdgeLength > 0.0 && longest > this->MaximumEdgeLength) ||
    (this->MaximumVolume > 0.0 &&
      GetSignedVolume(vertices[0], vertices[1], vertices[2], vertices[3]) > this->MaximumVolume);
  if (!isLarge && this->Sizing)
  {
    isLarge = this->Sizing.AnyBelow(vertices, longest,
      [&](const Vec3&, const LocalSpacing& spacing)
      {
        return std::any_of(std::begin(TetrahedronEdges), std::end(TetrahedronEdges),
          [&](const auto& e)
          { return SquaredNorm(spacing.ToUnits(vertices[e[1]] - vertices[e[0]])) > 1.0; });
      });
  }
  if (!isLarge && this->IsTooLarge)
  {
    isLarge = this->IsTooLarge(vertices, longest);
  }
  if (isLarge)
  {
    target = center;
    severity = std::sqrt(radius2);
    return TetrahedronFault::Size;
  }
  if (!isShapeTested || this->RadiusEdgeRatio <= 0.0 ||
    radius2 <= this->RadiusEdgeRatio * this->RadiusEdgeRatio * shortest2)
  {
    return TetrahedronFault::None;
  }
  const double shortest = std::sqrt(shortest2);
  severity = std::sqrt(radius2) / shortest;
  target = center;
  const Vec3 middle = 0.5 *
    (vertices[TetrahedronEdges[shortestEdge][0]] + vertices[TetrahedronEdges[shortestEdge][1]]);
  // The apex of an isosceles triangle over the edge whose circumradius is the ratio times the edge.
  const double height = shortest *
    (this->RadiusEdgeRatio +
      std::sqrt(std::max(0.0, this->RadiusEdgeRatio * this->RadiusEdgeRatio - 0.25)));
  const double distance = Distance(middle, center);
  if (distance > height)
  {
    target = middle + (height / distance) * (center - middle);
  }
  return TetrahedronFault::Shape;
}
} // namespace cdm
