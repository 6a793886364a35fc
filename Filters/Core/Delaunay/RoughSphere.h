// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RoughSphere.h
 * @brief The circumsphere of a tetrahedron in single precision, with a bound of its error.
 *
 * Most points are far from most spheres: 16 bytes tell that, where the coordinates of the vertices
 * would be 96. What the bound leaves open is for Determinants.h and Predicates.h. The half space
 * beyond a facet of the hull is the limit of spheres through the facet, and is kept as one that is
 * 2^29 times as large as the box of the points.
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

/**
 * The power of a point at this difference from the last vertex; what the sphere decides nothing about
 * has an infinite bound.
 */
inline Determinant<double> GetPower(const RoughSphere& sphere, const Vec3& d)
{
  return { d.X * (d.X - sphere.X) + d.Y * (d.Y - sphere.Y) + d.Z * (d.Z - sphere.Z),
    sphere.Tolerance * (std::abs(d.X) + std::abs(d.Y) + std::abs(d.Z)) + SmallestCertainBound };
}

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

/**
 * The half space beyond a facet of the hull, from two vertices relative to the third one and to
 * their tetrahedron's last one: those that follow the vertex at infinity in the tetrahedron. Size
 * bounds the magnitude of their coordinates, extent is at least the longest side of the box of all
 * points.
 */
inline RoughSphere MakeRoughHalfSpace(
  const RelativeVertex& a, const RelativeVertex& b, double size, double extent)
{
  constexpr double DoubleRoundoff = std::numeric_limits<double>::epsilon() / 2.0;
  constexpr double FloatRoundoff = std::numeric_limits<float>::epsilon() / 2.0;
  // For a point at d from the last vertex the power is d (d - x), x being twice the center: its sign
  // is that of -d x but for the square of d, which is at most extent times the sum of |d|'s
  // coordinates.
  const Vec3 normal = Cross(a.Difference, b.Difference);
  const double length = GetLargest(std::abs(normal.X), std::abs(normal.Y), std::abs(normal.Z));
  const double offset = 0x1p30 * extent;
  const double scale = offset / length;
  // Each coordinate of the normal is a sum of two products of at most size^2: it is off by less than
  // 16 roundings of that.
  const double error = 16.0 * DoubleRoundoff * size * size * scale;
  const double tolerance = 1.02 * (extent + FloatRoundoff * offset + error);
  // A scale larger than that would hide what is lost by underflow.
  return tolerance > 1e-30 && offset < 1e30 && error < 1e-3 * offset && scale < 1e250
    ? RoughSphere{ static_cast<float>(-scale * normal.X), static_cast<float>(-scale * normal.Y),
        static_cast<float>(-scale * normal.Z), static_cast<float>(tolerance) }
    : NoSphere;
}
} // namespace cdm

#endif
