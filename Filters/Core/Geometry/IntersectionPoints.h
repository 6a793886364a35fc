// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IntersectionPoints.h
 * @brief Points where segments pierce triangles or cross each other: exact determinants, rounded
 *   once.
 *
 * Parameters are quotients of determinants with hardly any relative error, also where the segment
 * is nearly parallel to what it meets: so a computed point is off by roundings of its coordinates
 * only, and lies on the segment up to those.
 *
 * Cost: that of floating-point determinants, but where these cannot be trusted.
 *
 * Reference: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
 * geometric predicates", 1997, doi:10.1007/PL00009321 (exact sums).
 */
#ifndef cdmIntersectionPoints_h
#define cdmIntersectionPoints_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>

namespace cdm
{
/**
 * The point that divides the way from a to b in the ratio heightA to -heightB; never outside of it.
 */
Vec3 DivideSegment(const Vec3& a, const Vec3& b, double heightA, double heightB);

/**
 * The point where the segment from a to b meets the plane of a triangle. a and b lie on different
 * sides of it.
 */
Vec3 PierceTriangle(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& triangle);

/**
 * The point where two segments cross that are coplanar up to rounding, seen along an axis; a point
 * of the first one. Coordinates that both ends of the second one have in common are exact.
 */
Vec3 CrossSegments(int axis, const std::array<Vec3, 2>& segment, const std::array<Vec3, 2>& other);
} // namespace cdm

#endif
