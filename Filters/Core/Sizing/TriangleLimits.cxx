// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/TriangleLimits.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
bool TriangleLimits::IsTooCoarse(const std::array<Vec3, 3>& corners,
  const std::array<bool, 3>& isStructural, bool isAngleTested, Id& edge) const
{
  constexpr double RadiansPerDegree = 3.14159265358979323846 / 180.0;
  edge = NoId;
  double limit = this->MaximumEdgeLength > 0.0 ? this->MaximumEdgeLength : Infinity;
  int longest = 0;
  double lengths[3];
  for (int i = 0; i < 3; ++i)
  {
    lengths[i] = Distance(corners[i], corners[(i + 1) % 3]);
    longest = lengths[i] > lengths[longest] ? i : longest;
  }
  if (this->Sizing)
  {
    this->Sizing.AnyBelow(corners, std::min(lengths[longest], limit),
      [&](const Vec3&, const LocalSpacing& spacing)
      {
        limit = std::min(limit, spacing.GetLargest());
        return lengths[longest] > limit;
      });
  }
  const double area = 0.5 * Norm(Cross(corners[1] - corners[0], corners[2] - corners[0]));
  const bool isLarge =
    lengths[longest] > limit || (this->MaximumArea > 0.0 && area > this->MaximumArea);
  if (isLarge)
  {
    // The longest structural edge first: facets are refined from a fine enough outline.
    double length = limit;
    for (int i = 0; i < 3; ++i)
    {
      if (isStructural[i] && (lengths[i] > length || (i == longest && edge == NoId)))
      {
        edge = i;
        length = lengths[i];
      }
    }
    return true;
  }
  if (isAngleTested && this->MinimumAngle > 0.0)
  {
    const int shortest = static_cast<int>(std::min_element(lengths, lengths + 3) - lengths);
    const double sine = 2.0 * area / (lengths[(shortest + 1) % 3] * lengths[(shortest + 2) % 3]);
    const bool isGivenAngle = isStructural[(shortest + 1) % 3] && isStructural[(shortest + 2) % 3];
    return !isGivenAngle && sine < std::sin(this->MinimumAngle * RadiansPerDegree);
  }
  return false;
}
} // namespace cdm
