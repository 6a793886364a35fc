// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Predicates.h"

#include "Core/Geometry/Determinants.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <tuple>

#ifdef __SIZEOF_INT128__
#define CDM_HAS_WIDE_INTEGERS
#endif

namespace cdm
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Unit roundoff, and forward error bounds of the determinants below in units of their permanents
// (Shewchuk 1997, "A" stage of orient2d).
constexpr double Epsilon = std::numeric_limits<double>::epsilon() / 2.0;
constexpr double Orientation2Bound = (3.0 + 16.0 * Epsilon) * Epsilon;

Kernel::Point_3 ToPoint3(const Vec3& p)
{
  return { p.X, p.Y, p.Z };
}

Kernel::Point_2 Project(int axis, const Vec3& p)
{
  return { p[(axis + 1) % 3], p[(axis + 2) % 3] };
}

#ifdef CDM_HAS_WIDE_INTEGERS
// Points that the filters cannot tell apart are close to each other most of the time. Then their
// coordinates are small multiples of one power of two, and their determinants fit into integers of
// fixed size: no memory is allocated, and a sign costs little more than the filter.

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

/** High * 2^64 + Low. */
struct Int192
{
  Int128 High;
  std::uint64_t Low;

  bool IsNegative() const { return this->High < 0; }

  friend Int192 operator+(const Int192& a, const Int192& b)
  {
    const std::uint64_t low = a.Low + b.Low;
    return { a.High + b.High + (low < a.Low ? 1 : 0), low };
  }
  friend Int192 operator-(const Int192& a, const Int192& b)
  {
    return { a.High - b.High - (a.Low < b.Low ? 1 : 0), a.Low - b.Low };
  }
};

Int192 Multiply(Int128 a, std::int64_t b)
{
  const std::uint64_t low = static_cast<std::uint64_t>(a);
  const std::int64_t high = static_cast<std::int64_t>(a >> 64);
  const UInt128 product = UInt128(low) * static_cast<std::uint64_t>(b);
  const std::uint64_t carry = static_cast<std::uint64_t>(product >> 64);
  return { Int128(high) * b + Int128(carry) - (b < 0 ? Int128(low) : Int128(0)),
    static_cast<std::uint64_t>(product) };
}

/** Sum of products of 320 bits, in two's complement. */
class Sum320
{
public:
  void Add(const Int192& a, UInt128 b) { this->Accumulate(a, b, a.IsNegative()); }
  void Subtract(const Int192& a, UInt128 b) { this->Accumulate(a, b, !a.IsNegative()); }

  int GetSign() const
  {
    std::uint64_t any = 0;
    for (std::uint64_t word : this->Words)
    {
      any |= word;
    }
    return any == 0 ? 0 : (this->Words[4] >> 63) != 0 ? -1 : 1;
  }

private:
  void Accumulate(const Int192& a, UInt128 b, bool isSubtracted)
  {
    const Int192 magnitude = a.IsNegative() ? Int192{ 0, 0 } - a : a;
    const std::uint64_t words[3] = { magnitude.Low, static_cast<std::uint64_t>(magnitude.High),
      static_cast<std::uint64_t>(magnitude.High >> 64) };
    const std::uint64_t factors[2] = { static_cast<std::uint64_t>(b),
      static_cast<std::uint64_t>(b >> 64) };
    std::uint64_t product[5] = { 0, 0, 0, 0, 0 };
    for (int j = 0; j < 2; ++j)
    {
      UInt128 carry = 0;
      for (int i = 0; i < 3; ++i)
      {
        carry += UInt128(words[i]) * factors[j] + product[i + j];
        product[i + j] = static_cast<std::uint64_t>(carry);
        carry >>= 64;
      }
      product[3 + j] = static_cast<std::uint64_t>(carry);
    }
    const std::uint64_t flip = isSubtracted ? ~std::uint64_t(0) : 0;
    UInt128 carry = isSubtracted ? 1 : 0;
    for (int i = 0; i < 5; ++i)
    {
      carry += UInt128(this->Words[i]) + (product[i] ^ flip);
      this->Words[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
  }

  std::uint64_t Words[5] = { 0, 0, 0, 0, 0 };
};

template <typename Integer>
int GetSign(Integer value)
{
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

int GetSign(const Int192& value)
{
  return value.High != 0 ? GetSign(value.High) : value.Low != 0 ? 1 : 0;
}

/** Differences of the coordinates of some points in units of a common power of two. */
class IntegerDifferences
{
public:
  /** Takes the differences from point 0. False if no unit is small enough and large enough. */
  template <int N>
  bool Set(const Vec3* const (&points)[N])
  {
    // A coordinate is an odd multiple of two to the power of its exponent. Without branches: these
    // loops take as long as the determinant.
    constexpr std::uint64_t Leading = std::uint64_t(1) << 52;
    int lowest = 4096;
    int highest = -4096;
    bool hasDenormals = false;
    for (const Vec3* point : points)
    {
      for (const double x : { point->X, point->Y, point->Z })
      {
        std::uint64_t bits;
        std::memcpy(&bits, &x, sizeof(bits));
        const int exponent = static_cast<int>((bits >> 52) & 0x7ff);
        const std::uint64_t mantissa = bits & (Leading - 1);
        const int zeros = __builtin_ctzll(mantissa | Leading);
        const bool isZero = x == 0.0;
        hasDenormals |= (exponent == 0) & !isZero;
        lowest = std::min(lowest, isZero ? 4096 : exponent - 1075 + zeros);
        highest = std::max(highest, isZero ? -4096 : exponent - 1022);
      }
    }
    if (hasDenormals)
    {
      return false;
    }
    if (lowest > highest)
    {
      lowest = highest = 0;
    }
    if (highest - lowest > 61 || lowest < -960 || lowest > 960)
    {
      return false;
    }
    const std::uint64_t bits = static_cast<std::uint64_t>(1023 - lowest) << 52;
    double scale;
    std::memcpy(&scale, &bits, sizeof(scale));
    const std::int64_t origin[3] = { static_cast<std::int64_t>(points[0]->X * scale),
      static_cast<std::int64_t>(points[0]->Y * scale),
      static_cast<std::int64_t>(points[0]->Z * scale) };
    std::uint64_t any = 0;
    for (int i = 1; i < N; ++i)
    {
      std::int64_t* const d = this->Values[i - 1];
      d[0] = static_cast<std::int64_t>(points[i]->X * scale) - origin[0];
      d[1] = static_cast<std::int64_t>(points[i]->Y * scale) - origin[1];
      d[2] = static_cast<std::int64_t>(points[i]->Z * scale) - origin[2];
      for (int axis = 0; axis < 3; ++axis)
      {
        any |= static_cast<std::uint64_t>(d[axis] ^ (d[axis] >> 63));
      }
    }
    this->Bits = any == 0 ? 0 : 64 - __builtin_clzll(any);
    return this->Bits < MaximumBits;
  }

  /** Differences are smaller than two to the power of this. */
  int GetBits() const { return this->Bits; }

  /** Sign of the determinant of the first three differences. */
  int GetOrientation() const
  {
    // Six terms of three factors.
    if (this->Bits <= 20)
    {
      return GetSign(this->GetDeterminant<std::int64_t>(0, 1, 2));
    }
    return GetSign(Multiply(this->GetMinor<Int128>(1, 2), this->Values[0][2]) -
      Multiply(this->GetMinor<Int128>(0, 2), this->Values[1][2]) +
      Multiply(this->GetMinor<Int128>(0, 1), this->Values[2][2]));
  }

  /** Sign of the determinant of two coordinates of the first two differences. */
  int GetProjectedOrientation(int u, int v) const
  {
    return GetSign(this->GetMinor<Int128>(0, 1, u, v));
  }

  /** Sign of the determinant of all four and their squares. */
  int GetInSphere() const
  {
    // 24 terms of three factors times a sum of three squares.
    return this->Bits <= 11 ? this->GetInSphere<std::int64_t>()
      : this->Bits <= 24    ? this->GetInSphere<Int128>()
                            : this->GetLongInSphere();
  }

  /** Sign of the scalar product of the first two differences. */
  int GetDotSign() const
  {
    const std::int64_t* const u = this->Values[0];
    const std::int64_t* const v = this->Values[1];
    return GetSign(Int128(u[0]) * v[0] + Int128(u[1]) * v[1] + Int128(u[2]) * v[2]);
  }

  /**
   * Position of the third difference relative to the smallest sphere through the origin and the
   * first two; false if neither the numbers are small nor the three in a plane.
   */
  bool GetInEquatorialSphere(int& sign)
  {
    if (this->Bits <= 19)
    {
      sign = -GetSign(this->GetEquatorialPower());
      return true;
    }
    if (this->GetOrientation() != 0)
    {
      return false;
    }
    // In the plane all spheres through the triangle are the same: one through a point beside it.
    int axis = 0;
    int side = 0;
    for (int i = 0; i < 3 && side == 0; ++i)
    {
      axis = i;
      side = GetSign(this->GetMinor<Int128>(0, 1, (i + 1) % 3, (i + 2) % 3));
    }
    for (int i = 0; i < 3; ++i)
    {
      this->Values[3][i] = this->Values[2][i];
      this->Values[2][i] = i == axis ? 1 : 0;
    }
    sign = this->GetInSphere() * side;
    return true;
  }

private:
  static constexpr int MaximumBits = 61;

  template <typename Integer>
  Integer GetMinor(int i, int j, int x = 0, int y = 1) const
  {
    return Integer(this->Values[i][x]) * this->Values[j][y] -
      Integer(this->Values[j][x]) * this->Values[i][y];
  }
  template <typename Integer>
  Integer GetDeterminant(int i, int j, int k) const
  {
    return this->GetMinor<Integer>(j, k) * this->Values[i][2] -
      this->GetMinor<Integer>(i, k) * this->Values[j][2] +
      this->GetMinor<Integer>(i, j) * this->Values[k][2];
  }
  template <typename Integer>
  Integer GetSquare(int i) const
  {
    const std::int64_t* const d = this->Values[i];
    return Integer(d[0]) * d[0] + Integer(d[1]) * d[1] + Integer(d[2]) * d[2];
  }
  template <typename Integer>
  int GetInSphere() const
  {
    return GetSign(this->GetDeterminant<Integer>(1, 2, 3) * this->GetSquare<Integer>(0) -
      this->GetDeterminant<Integer>(0, 2, 3) * this->GetSquare<Integer>(1) +
      this->GetDeterminant<Integer>(0, 1, 3) * this->GetSquare<Integer>(2) -
      this->GetDeterminant<Integer>(0, 1, 2) * this->GetSquare<Integer>(3));
  }

  /** The same as GetEquatorialPower() in floating point. */
  Int128 GetEquatorialPower() const
  {
    const Int128 n[3] = { this->GetMinor<Int128>(0, 1, 1, 2), this->GetMinor<Int128>(0, 1, 2, 0),
      this->GetMinor<Int128>(0, 1, 0, 1) };
    const Int128 uu = this->GetSquare<Int128>(0);
    const Int128 vv = this->GetSquare<Int128>(1);
    Int128 power = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) * this->GetSquare<Int128>(2);
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      const Int128 cross = n[j] * (vv * this->Values[0][k] - uu * this->Values[1][k]) -
        n[k] * (vv * this->Values[0][j] - uu * this->Values[1][j]);
      power -= cross * this->Values[2][i];
    }
    return power;
  }

  int GetLongInSphere() const
  {
    const Int128 pq = this->GetMinor<Int128>(0, 1);
    const Int128 pr = this->GetMinor<Int128>(0, 2);
    const Int128 ps = this->GetMinor<Int128>(0, 3);
    const Int128 qr = this->GetMinor<Int128>(1, 2);
    const Int128 qs = this->GetMinor<Int128>(1, 3);
    const Int128 rs = this->GetMinor<Int128>(2, 3);
    const std::int64_t p = this->Values[0][2];
    const std::int64_t q = this->Values[1][2];
    const std::int64_t r = this->Values[2][2];
    const std::int64_t s = this->Values[3][2];
    Sum320 sum;
    sum.Add(
      Multiply(rs, q) - Multiply(qs, r) + Multiply(qr, s), UInt128(this->GetSquare<Int128>(0)));
    sum.Subtract(
      Multiply(rs, p) - Multiply(ps, r) + Multiply(pr, s), UInt128(this->GetSquare<Int128>(1)));
    sum.Add(
      Multiply(qs, p) - Multiply(ps, q) + Multiply(pq, s), UInt128(this->GetSquare<Int128>(2)));
    sum.Subtract(
      Multiply(qr, p) - Multiply(pr, q) + Multiply(pq, r), UInt128(this->GetSquare<Int128>(3)));
    return sum.GetSign();
  }

  std::int64_t Values[4][3];
  int Bits = 0;
};

bool OrientByIntegers(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int& sign)
{
  IntegerDifferences difference;
  if (!difference.Set({ &a, &b, &c, &d }))
  {
    return false;
  }
  sign = difference.GetOrientation();
  return true;
}

bool InSphereByIntegers(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e, int& sign)
{
  IntegerDifferences difference;
  if (!difference.Set({ &e, &a, &b, &c, &d }))
  {
    return false;
  }
  sign = difference.GetInSphere();
  return true;
}
#endif

/** True if all points are corners of one box with axis-parallel edges, which lie on a sphere. */
bool AreCornersOfBox(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double first = a[axis];
    double second = b[axis];
    for (const Vec3* point : { &c, &d, &e })
    {
      second = second == first ? (*point)[axis] : second;
      if ((*point)[axis] != first && (*point)[axis] != second)
      {
        return false;
      }
    }
  }
  return true;
}

/**
 * Decides what the filter of InEquatorialSphere() cannot tell: most often points in the plane of
 * the triangle, on its circumcircle. Testing these by multiple precision numbers took half of the
 * time of refining surfaces made of rectangles.
 */
int ExactInEquatorialSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p)
{
  // The smallest sphere through a triangle with a right angle is that of its longest edge.
  for (const auto& [corner, begin, end] :
    { std::tie(a, b, c), std::tie(b, c, a), std::tie(c, a, b) })
  {
    if (InDiametralSphere(begin, end, corner) == 0)
    {
      return InDiametralSphere(begin, end, p);
    }
  }
  const auto power = GetEquatorialPower<long double>(a, b, c, p);
  if (power.IsCertain())
  {
    return -power.GetSign();
  }
#ifdef CDM_HAS_WIDE_INTEGERS
  IntegerDifferences difference;
  int sign = 0;
  if (difference.Set({ &a, &b, &c, &p }) && difference.GetInEquatorialSphere(sign))
  {
    return sign;
  }
#endif
  return static_cast<int>(
    CGAL::side_of_bounded_sphere(ToPoint3(a), ToPoint3(b), ToPoint3(c), ToPoint3(p)));
}

} // namespace

int Orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const auto determinant = GetOrientationDeterminant<double>(a, b, c, d);
  return determinant.IsCertain() ? determinant.GetSign() : ExactOrientation(a, b, c, d);
}

int ExactOrientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  if ((a.X == b.X && a.X == c.X && a.X == d.X) || (a.Y == b.Y && a.Y == c.Y && a.Y == d.Y) ||
    (a.Z == b.Z && a.Z == c.Z && a.Z == d.Z))
  {
    return 0;
  }
#ifdef CDM_HAS_WIDE_INTEGERS
  int sign = 0;
  if (OrientByIntegers(a, b, c, d, sign))
  {
    return sign;
  }
#endif
  return static_cast<int>(CGAL::orientation(ToPoint3(a), ToPoint3(b), ToPoint3(c), ToPoint3(d)));
}

int InSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e)
{
  const auto determinant = GetInSphereDeterminant<double>(a, b, c, d, e);
  return determinant.IsCertain() ? determinant.GetSign() : ExactInSphere(a, b, c, d, e);
}

int ExactInSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e)
{
  if (AreCornersOfBox(a, b, c, d, e))
  {
    return 0;
  }
  // The widest floating-point type resolves most of what rounded coordinates make nearly
  // cospherical; it is useless, but right, where it is double.
  const auto determinant = GetInSphereDeterminant<long double>(a, b, c, d, e);
  if (determinant.IsCertain())
  {
    return determinant.GetSign();
  }
#ifdef CDM_HAS_WIDE_INTEGERS
  int sign = 0;
  if (InSphereByIntegers(a, b, c, d, e, sign))
  {
    return sign;
  }
#endif
  return static_cast<int>(
    CGAL::side_of_oriented_sphere(ToPoint3(a), ToPoint3(b), ToPoint3(c), ToPoint3(d), ToPoint3(e)));
}

int InDiametralSphere(const Vec3& a, const Vec3& b, const Vec3& p)
{
  const auto power = GetDiametralPower<double>(a, b, p);
  if (power.IsCertain())
  {
    return -power.GetSign();
  }
  if ((a.X == p.X || b.X == p.X) && (a.Y == p.Y || b.Y == p.Y) && (a.Z == p.Z || b.Z == p.Z))
  {
    // A right angle between edges along the axes.
    return 0;
  }
#ifdef CDM_HAS_WIDE_INTEGERS
  IntegerDifferences difference;
  if (difference.Set({ &p, &a, &b }))
  {
    return -difference.GetDotSign();
  }
#endif
  return static_cast<int>(CGAL::side_of_bounded_sphere(ToPoint3(a), ToPoint3(b), ToPoint3(p)));
}

int InEquatorialSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p)
{
  const auto power = GetEquatorialPower<double>(a, b, c, p);
  return power.IsCertain() ? -power.GetSign() : ExactInEquatorialSphere(a, b, c, p);
}

bool AreCollinear(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return ProjectedOrientation(0, a, b, c) == 0 && ProjectedOrientation(1, a, b, c) == 0 &&
    ProjectedOrientation(2, a, b, c) == 0;
}

int ProjectedOrientation(int axis, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double left = (b[u] - a[u]) * (c[v] - a[v]);
  const double right = (b[v] - a[v]) * (c[u] - a[u]);
  const Determinant<double> area{ left - right,
    Orientation2Bound * (std::abs(left) + std::abs(right)) };
  if (area.IsCertain())
  {
    return area.GetSign();
  }
  if ((a[u] == b[u] || a[v] == c[v]) && (a[v] == b[v] || a[u] == c[u]))
  {
    // On a line along an axis.
    return 0;
  }
#ifdef CDM_HAS_WIDE_INTEGERS
  IntegerDifferences difference;
  if (difference.Set({ &a, &b, &c }))
  {
    return difference.GetProjectedOrientation(u, v);
  }
#endif
  return static_cast<int>(CGAL::orientation(Project(axis, a), Project(axis, b), Project(axis, c)));
}
} // namespace cdm
