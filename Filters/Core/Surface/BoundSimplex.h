// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundSimplex.h
 * @brief Triangles and segments of which DeviationBound.h says how far they are from each other.
 */
#ifndef cdmBoundSimplex_h
#define cdmBoundSimplex_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <vector>

namespace cdm
{
/** A triangle, or a segment, whose last corner is repeated. */
struct BoundSimplex
{
  std::array<Vec3, 3> Corners;
  /** The facet or chain that it belongs to. */
  Id Group = NoId;
};

inline bool IsSegment(const std::array<Vec3, 3>& corners)
{
  return corners[1] == corners[2];
}

/** The point of a simplex that is nearest to a position. */
Vec3 FindNearestPoint(const std::array<Vec3, 3>& corners, const Vec3& position);

/**
 * How far some simplices may be from others that take their place, where all of them lie in a plane
 * and have the same border, or on a line and have the same ends: they cover the same part of it then,
 * unless one is turned over.
 *
 * All that is positive in the plane covers what its border runs around. So no simplex has to be
 * compared with another one: it is the sum of what they are off the plane, and of rounding.
 *
 * @return a bound of the distance from any point of either to the other; infinity if it is not known
 */
double GetShift(const std::vector<BoundSimplex>& removed, const std::vector<BoundSimplex>& added);
} // namespace cdm

#endif
