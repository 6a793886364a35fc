// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MatchingPoints.h
 * @brief Chooses the last bits of points that have to match others (README.md, stage 2).
 */
#ifndef cdmMatchingPoints_h
#define cdmMatchingPoints_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <cmath>
#include <cstdlib>
#include <vector>

namespace cdm
{
/**
 * Takes over each coordinate that differs from that of a matching point by rounding errors only.
 * Edges parallel to an axis stay exactly so, and the cells in between become exactly cospherical;
 * stage 4 can make good tetrahedra of those.
 */
inline Vec3 SnapToCoordinates(Vec3 position, const Vec3& model, double size)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (std::abs(position[axis] - model[axis]) <= 1e-15 * size)
    {
      position[axis] = model[axis];
    }
  }
  return position;
}

/**
 * Two points that match across a narrow gap do not encroach on the pieces at them only if they
 * differ along the gap by less than its squared width over the size of the pieces. If rounding
 * alone is larger than that, one of the doubles next to the position is taken.
 * @param getOffset distance from the model along the gap, in extended precision
 * @param range largest move from the position, in units in the last place
 */
template <typename GetOffset>
Vec3 MatchExactly(
  const Vec3& position, const Vec3& model, double size, int range, GetOffset&& getOffset)
{
  const auto getOffsetAt = [&](const Vec3& p)
  {
    return getOffset(static_cast<long double>(p.X - model.X),
      static_cast<long double>(p.Y - model.Y), static_cast<long double>(p.Z - model.Z));
  };
  const long double allowed = SquaredNorm(position - model) / (8.0 * size);
  Vec3 best = position;
  long double smallest = getOffsetAt(position);
  if (smallest <= allowed)
  {
    return best;
  }
  std::vector<double> steps[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    steps[axis].resize(2 * range + 1, position[axis]);
    for (int i = 1; i <= range; ++i)
    {
      steps[axis][range + i] = std::nextafter(steps[axis][range + i - 1], Infinity);
      steps[axis][range - i] = std::nextafter(steps[axis][range - i + 1], -Infinity);
    }
  }
  // Shell by shell: no farther than needed.
  for (int shell = 1; shell <= range && smallest > allowed; ++shell)
  {
    for (int i = -shell; i <= shell; ++i)
    {
      for (int j = -shell; j <= shell; ++j)
      {
        const bool isFace = std::abs(i) == shell || std::abs(j) == shell;
        for (int k = -shell; k <= shell; k += isFace ? 1 : 2 * shell)
        {
          const Vec3 candidate{ steps[0][range + i], steps[1][range + j], steps[2][range + k] };
          const long double offset = getOffsetAt(candidate);
          if (offset < smallest)
          {
            smallest = offset;
            best = candidate;
          }
        }
      }
    }
  }
  return best;
}
} // namespace cdm

#endif
