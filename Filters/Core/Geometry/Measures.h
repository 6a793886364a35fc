// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Measures.h
 * @brief Floating-point measures of triangles and tetrahedra; they never decide topology.
 *
 * Angles are in degrees and stay accurate for slivers and needles: each comes from its sine and its
 * cosine together. References: W. Kahan, "Miscalculating Area and Angles of a Needle-like
 * Triangle", 2014 (why the arc cosine alone fails).
 */
#ifndef cdmMeasures_h
#define cdmMeasures_h

#include "Core/Basics/Vec3.h"

#include <array>

namespace cdm
{
constexpr double DegreesPerRadian = 57.29577951308232;

/** Positive for a tetrahedron of positive orientation. */
double GetSignedVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

double GetTriangleArea(const Vec3& a, const Vec3& b, const Vec3& c);

/**
 * Dihedral angles at the edges ab, ac, ad, bc, bd, cd: 0 to 180 degrees, whatever the orientation.
 * A flat tetrahedron has angles of 0 and 180 only; at an edge without length, or next to a facet
 * without area, the angle is 0.
 */
std::array<double, 6> GetDihedralAngles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/** One of them: 0 for the edge ab, 5 for cd. */
double GetDihedralAngle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int edge);

/** The smallest of them, which is never above 70.53 degrees. */
double GetSmallestDihedralAngle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/** The square of its tangent, which tells tetrahedra apart as the angle does, and is quicker. */
double GetSmallestDihedralTangent2(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/** Smallest of the four heights: distance of a vertex from the opposite facet's plane. */
double GetSmallestHeight(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/** Center of the circumcircle; not finite for collinear points. */
Vec3 GetCircumcenter(const Vec3& a, const Vec3& b, const Vec3& c);

/** Center of the circumcircle relative to the first point. */
Vec3 GetCircumcenterOffset(const Vec3& a, const Vec3& b, const Vec3& c);

/** Distance of p from the nearest point of a triangle. */
double GetDistanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/** Weights of a, b and c, one in sum, of the projection of p onto their plane. */
Vec3 GetBarycentricWeights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/** Center of the circumsphere; not finite for coplanar points. */
Vec3 GetCircumcenter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
} // namespace cdm

#endif
