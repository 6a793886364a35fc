// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Vec3.h
 * @brief Three coordinates in double precision and the vector algebra on them.
 */
#ifndef cdmVec3_h
#define cdmVec3_h

#include <cmath>
#include <limits>

namespace cdm
{
struct Vec3
{
  double X = 0.0;
  double Y = 0.0;
  double Z = 0.0;

  double operator[](int axis) const { return axis == 0 ? this->X : axis == 1 ? this->Y : this->Z; }
  double& operator[](int axis) { return axis == 0 ? this->X : axis == 1 ? this->Y : this->Z; }

  friend Vec3 operator+(const Vec3& a, const Vec3& b)
  {
    return { a.X + b.X, a.Y + b.Y, a.Z + b.Z };
  }
  friend Vec3 operator-(const Vec3& a, const Vec3& b)
  {
    return { a.X - b.X, a.Y - b.Y, a.Z - b.Z };
  }
  friend Vec3 operator*(double s, const Vec3& a) { return { s * a.X, s * a.Y, s * a.Z }; }
  friend bool operator==(const Vec3& a, const Vec3& b)
  {
    return a.X == b.X && a.Y == b.Y && a.Z == b.Z;
  }
  friend bool operator!=(const Vec3& a, const Vec3& b) { return !(a == b); }
  /** Lexicographic order. */
  friend bool operator<(const Vec3& a, const Vec3& b)
  {
    return a.X != b.X ? a.X < b.X : a.Y != b.Y ? a.Y < b.Y : a.Z < b.Z;
  }
};

inline double Dot(const Vec3& a, const Vec3& b)
{
  return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
}

inline Vec3 Cross(const Vec3& a, const Vec3& b)
{
  return { a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X };
}

inline double SquaredNorm(const Vec3& a)
{
  return Dot(a, a);
}

inline double Norm(const Vec3& a)
{
  return std::sqrt(SquaredNorm(a));
}

/** The sum of the components' magnitudes, which is at least the length. */
inline double SumNorm(const Vec3& a)
{
  return std::abs(a.X) + std::abs(a.Y) + std::abs(a.Z);
}

/**
 * More than the distance by which rounding moves a point whose coordinates are computed as one sum: far
 * from the origin that may be as much as things there are large.
 */
inline double GetRounding(const Vec3& position)
{
  return 2.0 * std::numeric_limits<double>::epsilon() * SumNorm(position);
}

inline double Distance(const Vec3& a, const Vec3& b)
{
  return Norm(a - b);
}

inline bool IsFinite(const Vec3& a)
{
  return std::isfinite(a.X) && std::isfinite(a.Y) && std::isfinite(a.Z);
}
} // namespace cdm

#endif
