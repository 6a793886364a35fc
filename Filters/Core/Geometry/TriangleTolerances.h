// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleTolerances.h
 * @brief Tests whether triangles are coplanar, overlap or have no area up to a tolerance.
 *
 * Answers are rounded: they decide where points are merged, never the topology.
 * Tolerances are lengths in model units.
 */
#ifndef cdmTriangleTolerances_h
#define cdmTriangleTolerances_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
/** Distance of a point from the plane of a triangle; 0 if it has no area. */
double GetHeight(const std::vector<Vec3>& points, Id point, const TriangleIds& t);

/** Whether s lies in the plane of t, up to a tolerance. */
bool IsNearPlane(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t, double tolerance);

/** Width of the common part of two triangles that are nearly coplanar. */
double GetOverlapWidth(const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t);

/** Number of the longest edge; edge i runs from vertex i to the next one. */
int FindLongestEdge(const std::vector<Vec3>& points, const TriangleIds& t);

/** Whether a triangle is narrower than a tolerance, but not because two vertices are so close. */
bool IsNeedle(const std::vector<Vec3>& points, const TriangleIds& t, double tolerance);
} // namespace cdm

#endif
