// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RoughSphere.h
 * @brief The circumsphere of a tetrahedron in single precision, with a bound of its error.
 *
 * Most points are far from most spheres: 16 bytes tell that, where the coordinates of the vertices
 * would be 96. What the bound leaves open is for Determinants.h and Predicates.h.
 */
#ifndef cdmRoughSphere_h
#define cdmRoughSphere_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Determinants.h"

#include <cmath>
#include <limits>

namespace cdm
{
/**
 * The circumsphere of a tetrahedron in single precision: its center, from the last vertex, and a
 * bound of the error of the power of a point, per distance from that vertex. A tolerance of
 * infinity decides nothing.
 */
struct RoughSphere
{
  float X;
  float Y;
  float Z;
  float Tolerance;
};

constexpr RoughSphere NoSphere{ 0.0f, 0.0f, 0.0f, std::numeric_limits<float>::infinity() };

/** A vertex relative to the last one of its tetrahedra. */
struct RelativeVertex
{
  Id Vertex;
  Vec3 Difference;
  double Square;
};

/** From three vertices relative to the last one; size bounds the magnitude of their coordinates. */
inline RoughSphere MakeRoughSphere(
  const RelativeVertex& a, const RelativeVertex& b, const RelativeVertex& c, double size)
{
  constexpr double DoubleRoundoff = std::numeric_limits<double>::epsilon() / 2.0;
  constexpr double FloatRoundoff = std::numeric_limits<float>::epsilon() / 2.0;
  const Vec3 bc = Cross(b.Difference, c.Difference);
  const Vec3 ca = Cross(c.Difference, a.Difference);
  const Vec3 ab = Cross(a.Difference, b.Difference);
  const double inverse = 0.5 / Dot(a.Difference, bc);
  const Vec3 center = inverse * (a.Square * bc + b.Square * ca + c.Square * ab);
  // The numerators are sums of 18 products of at most size^4 and the determinant is one of 6
  // products of at most size^3: each is off by less than 16 roundings of that.
  const double offset = GetLargest(std::abs(center.X), std::abs(center.Y), std::abs(center.Z));
  const double error =
    512.0 * DoubleRoundoff * size * size * size * (size + offset) * std::abs(inverse);
  const double tolerance = 2.05 * (1.01 * FloatRoundoff * offset + error);
  // Not if an error in the last bits of a float, or of the double, could be larger than that.
  return tolerance > 1e-30 && offset < 1e30 && error < 1e-3 * offset
    ? RoughSphere{ static_cast<float>(2.0 * center.X), static_cast<float>(2.0 * center.Y),
        static_cast<float>(2.0 * center.Z), static_cast<float>(tolerance) }
    : NoSphere;
}
} // namespace cdm

#endif
