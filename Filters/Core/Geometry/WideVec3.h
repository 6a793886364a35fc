// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WideVec3.h
 * @brief Vectors in the widest floating-point type, for differences of almost equal products.
 *
 * The height of a needle over its long edge, for example, is left in the additional bits only. The
 * products of very small or large coordinates also stay in the range of the exponent. Where the
 * widest type is double, results are right, but no better.
 */
#ifndef cdmWideVec3_h
#define cdmWideVec3_h

#include "Core/Basics/Vec3.h"

namespace cdm
{
struct WideVec3
{
  long double X;
  long double Y;
  long double Z;

  static WideVec3 FromDifference(const Vec3& a, const Vec3& b)
  {
    return { static_cast<long double>(a.X) - b.X, static_cast<long double>(a.Y) - b.Y,
      static_cast<long double>(a.Z) - b.Z };
  }

  Vec3 Round() const
  {
    return { static_cast<double>(this->X), static_cast<double>(this->Y),
      static_cast<double>(this->Z) };
  }

  friend WideVec3 operator+(const WideVec3& a, const WideVec3& b)
  {
    return { a.X + b.X, a.Y + b.Y, a.Z + b.Z };
  }
  friend WideVec3 operator*(long double s, const WideVec3& a)
  {
    return { s * a.X, s * a.Y, s * a.Z };
  }
  friend WideVec3 operator/(const WideVec3& a, long double s)
  {
    return { a.X / s, a.Y / s, a.Z / s };
  }
  friend long double Dot(const WideVec3& a, const WideVec3& b)
  {
    return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
  }
  friend WideVec3 Cross(const WideVec3& a, const WideVec3& b)
  {
    return { a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X };
  }
};
} // namespace cdm

#endif
