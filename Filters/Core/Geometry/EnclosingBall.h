// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EnclosingBall.h
 * @brief A ball that surely encloses a sphere through two to four points, and is hardly larger.
 *
 * Method: the center is computed in double precision, and the radius is made larger by all that
 * rounding may have done to both. The ball takes a tenth of the time of a SphereForm, and tells nearly
 * all points and boxes that are outside. The center of a flat simplex, or of one that is tiny beside
 * its distance from the origin, is not known well enough: there a SphereForm is needed.
 */
#ifndef cdmEnclosingBall_h
#define cdmEnclosingBall_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
class EnclosingBall
{
public:
  /** The smallest sphere through two points. */
  EnclosingBall(const Vec3& a, const Vec3& b)
  {
    const Vec3 u = b - a;
    this->Set(a, u, 1.0, 1.0, SumNorm(u));
  }
  /** The smallest sphere through three points. */
  EnclosingBall(const Vec3& a, const Vec3& b, const Vec3& c)
  {
    const Vec3 u = b - a;
    const Vec3 v = c - a;
    const Vec3 normal = Cross(u, v);
    const double product = SumNorm(u) * SumNorm(v);
    this->Set(a, Cross(normal, SquaredNorm(v) * u - SquaredNorm(u) * v), SquaredNorm(normal),
      product * product, SumNorm(u) + SumNorm(v));
  }
  /** The circumsphere of a tetrahedron. */
  EnclosingBall(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
  {
    const Vec3 u = b - a;
    const Vec3 v = c - a;
    const Vec3 w = d - a;
    const Vec3 uv = Cross(u, v);
    this->Set(a, SquaredNorm(w) * uv + SquaredNorm(v) * Cross(w, u) + SquaredNorm(u) * Cross(v, w),
      Dot(uv, w), SumNorm(u) * SumNorm(v) * SumNorm(w), SumNorm(u) + SumNorm(v) + SumNorm(w));
  }

  /** False: it may be much larger than the sphere, or nothing can be told at all. */
  bool IsUsable() const { return this->Usable; }
  const Vec3& GetCenter() const { return this->Center; }
  /** Whether it is usable or not; infinity where nothing can be told. */
  double GetRadius() const { return this->Radius; }
  /** False only if no point of the box lies inside or on the circumsphere. */
  bool MayTouch(const Vec3& lower, const Vec3& upper) const
  {
    double square = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double center = this->Center[axis];
      const double nearest = std::min(std::max(center, lower[axis]), upper[axis]);
      square += (nearest - center) * (nearest - center);
    }
    return square <= this->SquaredRadius;
  }
  /** False only if the point lies outside of the circumsphere. */
  bool MayHold(const Vec3& point) const
  {
    return SquaredNorm(point - this->Center) <= this->SquaredRadius;
  }

private:
  static constexpr double Roundoff = std::numeric_limits<double>::epsilon() / 2.0;
  /** More than rounding does to distances. */
  static constexpr double Wider = 1.0 + 1e-12;
  /** The largest error of the center, in radii, with which the ball leaves few points. */
  static constexpr double LargestError = 1e-7;
  /** The largest error of the denominator, as part of it, with which there is a ball. */
  static constexpr double LargestPart = 0.25;
  /** Below this, digits may have been lost to underflow. */
  static constexpr double SmallestDenominator = 1e-280;

  /**
   * The center, seen from the origin, is half of the numerator over the denominator, which are sums
   * of products.
   * @param product bound of the magnitudes in the denominator
   * @param lengths the same for the numerator, in units of it
   */
  void Set(
    const Vec3& origin, const Vec3& numerator, double denominator, double product, double lengths)
  {
    const double half = 0.5 / denominator;
    const Vec3 offset = half * numerator;
    this->Center = origin + offset;
    // The products are off by less than 24 roundings each, the sum by one; the bound is more than
    // twice as large.
    const double part = 64.0 * Roundoff * product * std::abs(half);
    const double error = part * (lengths + SumNorm(offset)) + GetRounding(this->Center);
    const double radius = Norm(offset);
    const bool isKnown = part < LargestPart && denominator > SmallestDenominator;
    this->Radius = isKnown ? Wider * (radius + 2.0 * error) : Infinity;
    this->SquaredRadius = Wider * this->Radius * this->Radius;
    this->Usable = isKnown && error < LargestError * radius;
  }

  Vec3 Center;
  double Radius;
  double SquaredRadius;
  bool Usable;
};
} // namespace cdm

#endif
