// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Predicates.h
 * @brief Exact signs on double coordinates: the only functions that decide topology.
 *
 * Each returns -1, 0 or +1: the sign of the exact real value, however nearly degenerate the points.
 * A floating-point filter answers almost all calls; CGAL's exact kernel (LGPL) answers the rest.
 * Coordinates have to be finite. Thread safe.
 *
 * References: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
 * geometric predicates", 1997, doi:10.1007/PL00009321 (forward error bounds);
 * H. Bronnimann, C. Burnikel, S. Pion, "Interval arithmetic yields efficient dynamic filters for
 * computational geometry", 2001, doi:10.1016/S0166-218X(00)00231-6 (the kernel behind it).
 */
#ifndef cdmPredicates_h
#define cdmPredicates_h

#include "Core/Basics/Vec3.h"

namespace cdm
{
/**
 * Side of point d of the plane through a, b, c: +1 in front (the side from which a, b, c turn
 * counter-clockwise; (a, b, c, d) is then a positive tetrahedron in VTK's order), -1 behind,
 * 0 coplanar.
 */
int Orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/**
 * Position of e relative to the sphere through a, b, c, d: +1 strictly inside, 0 on it, -1 strictly
 * outside, for a tetrahedron of positive orientation; the sign flips with the orientation and is 0
 * if a, b, c, d are coplanar and e too.
 */
int InSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

/** The same for callers with a floating-point filter of their own, which could not tell. */
int ExactOrientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
int ExactInSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

/** Position of p relative to the smallest sphere through a and b: +1 inside, 0 on, -1 outside. */
int InDiametralSphere(const Vec3& a, const Vec3& b, const Vec3& p);

/**
 * Position of p relative to the smallest sphere through a, b and c (the equatorial sphere of the
 * triangle, which must not be degenerate): +1 inside, 0 on, -1 outside.
 */
int InEquatorialSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

/** True if a, b and c lie on one line (which includes coincident points). */
bool AreCollinear(const Vec3& a, const Vec3& b, const Vec3& c);

/**
 * Turn of the polyline a, b, c, all three in one plane of which only the normal's direction
 * matters: the sign of the component of (b - a) x (c - a) along the axis (0 = x, 1 = y, 2 = z).
 * This is the orientation of the triangle projected along that axis.
 */
int ProjectedOrientation(int axis, const Vec3& a, const Vec3& b, const Vec3& c);
} // namespace cdm

#endif
