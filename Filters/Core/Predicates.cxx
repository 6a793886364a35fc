// SPDX-License-Identifier: BSD-3-Clause
#include "Predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#ifdef __SIZEOF_INT128__
#define CDM_HAS_WIDE_INTEGERS
#endif

namespace cdm
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Unit roundoff, and forward error bounds of the determinants below in units of their permanents
// (Shewchuk 1997, "A" stage of orient2d, orient3d and insphere).
constexpr double Epsilon = std::numeric_limits<double>::epsilon() / 2.0;
constexpr double Orientation2Bound = (3.0 + 16.0 * Epsilon) * Epsilon;
constexpr double OrientationBound = (7.0 + 56.0 * Epsilon) * Epsilon;
constexpr double InSphereBound = (16.0 + 224.0 * Epsilon) * Epsilon;
// Three differences, three products, two sums: each term is off by less than four roundings, the
// sums by two more.
constexpr double DotBound = 8.0 * Epsilon;
// The bounds above hold as long as nothing underflows: values near the smallest doubles are left to
// the exact kernel.
constexpr double Underflow = 1e-280;

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

/** Two's complement integer of N 64-bit words, the lowest first. */
template <int N>
struct WideInteger
{
  std::uint64_t Words[N];

  bool IsNegative() const { return (this->Words[N - 1] >> 63) != 0; }

  int GetSign() const
  {
    std::uint64_t any = 0;
    for (std::uint64_t word : this->Words)
    {
      any |= word;
    }
    return any == 0 ? 0 : this->IsNegative() ? -1 : 1;
  }

  friend WideInteger operator+(const WideInteger& a, const WideInteger& b)
  {
    WideInteger sum;
    UInt128 carry = 0;
    for (int i = 0; i < N; ++i)
    {
      carry += UInt128(a.Words[i]) + b.Words[i];
      sum.Words[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return sum;
  }

  friend WideInteger operator-(const WideInteger& a)
  {
    WideInteger negative;
    UInt128 carry = 1;
    for (int i = 0; i < N; ++i)
    {
      carry += static_cast<std::uint64_t>(~a.Words[i]);
      negative.Words[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return negative;
  }

  friend WideInteger operator-(const WideInteger& a, const WideInteger& b) { return a + -b; }
};

template <int N, int M>
WideInteger<N + M> Multiply(WideInteger<N> a, WideInteger<M> b)
{
  const bool isNegative = a.IsNegative() != b.IsNegative();
  a = a.IsNegative() ? -a : a;
  b = b.IsNegative() ? -b : b;
  WideInteger<N + M> product{};
  for (int i = 0; i < N; ++i)
  {
    UInt128 carry = 0;
    for (int j = 0; j < M; ++j)
    {
      carry += UInt128(a.Words[i]) * b.Words[j] + product.Words[i + j];
      product.Words[i + j] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    product.Words[i + M] = static_cast<std::uint64_t>(carry);
  }
  return isNegative ? -product : product;
}

WideInteger<1> ToWide(std::int64_t value)
{
  return { { static_cast<std::uint64_t>(value) } };
}

WideInteger<2> ToWide(Int128 value)
{
  return { { static_cast<std::uint64_t>(static_cast<UInt128>(value)),
    static_cast<std::uint64_t>(static_cast<UInt128>(value) >> 64) } };
}

/** Differences of the coordinates of some points in units of a common power of two. */
class IntegerDifferences
{
public:
  /** Differences below this keep all determinants within their words. */
  static constexpr std::int64_t Limit = std::int64_t(1) << 60;

  /** From point 0; false if there is no unit that is small and large enough. */
  template <int N>
  bool Set(const Vec3* const (&points)[N])
  {
    // A coordinate is an odd multiple of two to the power of its exponent.
    int lowest = 4096;
    int highest = -4096;
    for (const Vec3* point : points)
    {
      for (const double x : { point->X, point->Y, point->Z })
      {
        std::uint64_t bits;
        std::memcpy(&bits, &x, sizeof(bits));
        const int exponent = static_cast<int>((bits >> 52) & 0x7ff);
        const std::uint64_t mantissa = bits & ((std::uint64_t(1) << 52) - 1);
        if (exponent == 0 && mantissa == 0)
        {
          continue;
        }
        if (exponent == 0)
        {
          return false;
        }
        const int zeros = mantissa == 0 ? 52 : __builtin_ctzll(mantissa);
        lowest = std::min(lowest, exponent - 1075 + zeros);
        highest = std::max(highest, exponent - 1022);
      }
    }
    if (lowest > highest)
    {
      lowest = highest = 0;
    }
    if (highest - lowest > 61 || lowest < -960 || lowest > 960)
    {
      return false;
    }
    std::uint64_t bits = static_cast<std::uint64_t>(1023 - lowest) << 52;
    double scale;
    std::memcpy(&scale, &bits, sizeof(scale));
    const std::int64_t origin[3] = { static_cast<std::int64_t>(points[0]->X * scale),
      static_cast<std::int64_t>(points[0]->Y * scale),
      static_cast<std::int64_t>(points[0]->Z * scale) };
    for (int i = 1; i < N; ++i)
    {
      std::int64_t* const d = this->Values[i - 1];
      d[0] = static_cast<std::int64_t>(points[i]->X * scale) - origin[0];
      d[1] = static_cast<std::int64_t>(points[i]->Y * scale) - origin[1];
      d[2] = static_cast<std::int64_t>(points[i]->Z * scale) - origin[2];
      for (int axis = 0; axis < 3; ++axis)
      {
        if (d[axis] >= Limit || d[axis] <= -Limit)
        {
          return false;
        }
      }
    }
    return true;
  }

  Int128 GetMinor(int i, int j) const
  {
    return Int128(this->Values[i][0]) * this->Values[j][1] -
      Int128(this->Values[j][0]) * this->Values[i][1];
  }
  WideInteger<3> GetDeterminant(int i, Int128 jk, int j, Int128 ik, int k, Int128 ij) const
  {
    return Multiply(ToWide(jk), ToWide(this->Values[i][2])) -
      Multiply(ToWide(ik), ToWide(this->Values[j][2])) +
      Multiply(ToWide(ij), ToWide(this->Values[k][2]));
  }
  WideInteger<2> GetSquare(int i) const
  {
    const std::int64_t* const d = this->Values[i];
    return ToWide(Int128(d[0]) * d[0] + Int128(d[1]) * d[1] + Int128(d[2]) * d[2]);
  }

private:
  std::int64_t Values[4][3];
};

bool OrientByIntegers(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int& sign)
{
  IntegerDifferences difference;
  if (!difference.Set({ &a, &b, &c, &d }))
  {
    return false;
  }
  sign = difference
           .GetDeterminant(0, difference.GetMinor(1, 2), 1, difference.GetMinor(0, 2), 2,
             difference.GetMinor(0, 1))
           .GetSign();
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
  const Int128 pq = difference.GetMinor(0, 1);
  const Int128 pr = difference.GetMinor(0, 2);
  const Int128 ps = difference.GetMinor(0, 3);
  const Int128 qr = difference.GetMinor(1, 2);
  const Int128 qs = difference.GetMinor(1, 3);
  const Int128 rs = difference.GetMinor(2, 3);
  const WideInteger<3> pqr = difference.GetDeterminant(0, qr, 1, pr, 2, pq);
  const WideInteger<3> pqs = difference.GetDeterminant(0, qs, 1, ps, 3, pq);
  const WideInteger<3> prs = difference.GetDeterminant(0, rs, 2, ps, 3, pr);
  const WideInteger<3> qrs = difference.GetDeterminant(1, rs, 2, qs, 3, qr);
  sign = (Multiply(qrs, difference.GetSquare(0)) - Multiply(prs, difference.GetSquare(1)) +
    Multiply(pqs, difference.GetSquare(2)) - Multiply(pqr, difference.GetSquare(3)))
           .GetSign();
  return true;
}
#endif

/** Sign of value if its error bound allows to tell it. */
bool IsCertain(double value, double bound, int& sign)
{
  if (bound > Underflow && (value > bound || -value > bound))
  {
    sign = value > 0.0 ? 1 : -1;
    return true;
  }
  return false;
}
} // namespace

int Orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  const Vec3 r = d - a;
  const double qyrz = q.Y * r.Z;
  const double qzry = q.Z * r.Y;
  const double qzrx = q.Z * r.X;
  const double qxrz = q.X * r.Z;
  const double qxry = q.X * r.Y;
  const double qyrx = q.Y * r.X;
  const double determinant = p.X * (qyrz - qzry) + p.Y * (qzrx - qxrz) + p.Z * (qxry - qyrx);
  const double permanent = std::abs(p.X) * (std::abs(qyrz) + std::abs(qzry)) +
    std::abs(p.Y) * (std::abs(qzrx) + std::abs(qxrz)) +
    std::abs(p.Z) * (std::abs(qxry) + std::abs(qyrx));
  int sign = 0;
  if (IsCertain(determinant, OrientationBound * permanent, sign))
  {
    return sign;
  }
#ifdef CDM_HAS_WIDE_INTEGERS
  if (OrientByIntegers(a, b, c, d, sign))
  {
    return sign;
  }
#endif
  return static_cast<int>(CGAL::orientation(ToPoint3(a), ToPoint3(b), ToPoint3(c), ToPoint3(d)));
}

int InSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e)
{
  const Vec3 p = a - e;
  const Vec3 q = b - e;
  const Vec3 r = c - e;
  const Vec3 s = d - e;

  const double pxqy = p.X * q.Y;
  const double qxpy = q.X * p.Y;
  const double qxry = q.X * r.Y;
  const double rxqy = r.X * q.Y;
  const double rxsy = r.X * s.Y;
  const double sxry = s.X * r.Y;
  const double sxpy = s.X * p.Y;
  const double pxsy = p.X * s.Y;
  const double pxry = p.X * r.Y;
  const double rxpy = r.X * p.Y;
  const double qxsy = q.X * s.Y;
  const double sxqy = s.X * q.Y;

  const double pq = pxqy - qxpy;
  const double qr = qxry - rxqy;
  const double rs = rxsy - sxry;
  const double sp = sxpy - pxsy;
  const double pr = pxry - rxpy;
  const double qs = qxsy - sxqy;

  const double pqr = p.Z * qr - q.Z * pr + r.Z * pq;
  const double qrs = q.Z * rs - r.Z * qs + s.Z * qr;
  const double rsp = r.Z * sp + s.Z * pr + p.Z * rs;
  const double spq = s.Z * pq + p.Z * qs + q.Z * sp;

  const double pp = SquaredNorm(p);
  const double qq = SquaredNorm(q);
  const double rr = SquaredNorm(r);
  const double ss = SquaredNorm(s);

  const double determinant = (rr * spq - ss * pqr) + (pp * qrs - qq * rsp);

  const double pz = std::abs(p.Z);
  const double qz = std::abs(q.Z);
  const double rz = std::abs(r.Z);
  const double sz = std::abs(s.Z);
  const double aqr = std::abs(qxry) + std::abs(rxqy);
  const double ars = std::abs(rxsy) + std::abs(sxry);
  const double asp = std::abs(sxpy) + std::abs(pxsy);
  const double apq = std::abs(pxqy) + std::abs(qxpy);
  const double apr = std::abs(pxry) + std::abs(rxpy);
  const double aqs = std::abs(qxsy) + std::abs(sxqy);
  const double permanent = (ars * qz + aqs * rz + aqr * sz) * pp +
    (asp * rz + apr * sz + ars * pz) * qq + (apq * sz + aqs * pz + asp * qz) * rr +
    (aqr * pz + apr * qz + apq * rz) * ss;
  int sign = 0;
  if (IsCertain(determinant, InSphereBound * permanent, sign))
  {
    return sign;
  }
#ifdef CDM_HAS_WIDE_INTEGERS
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
  const Vec3 u = a - p;
  const Vec3 v = b - p;
  const double x = u.X * v.X;
  const double y = u.Y * v.Y;
  const double z = u.Z * v.Z;
  int sign = 0;
  if (IsCertain(-(x + y + z), DotBound * (std::abs(x) + std::abs(y) + std::abs(z)), sign))
  {
    return sign;
  }
  return static_cast<int>(CGAL::side_of_bounded_sphere(ToPoint3(a), ToPoint3(b), ToPoint3(p)));
}

int InEquatorialSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p)
{
  // With a as origin, n = u x v: |n|^2 |x|^2 - x (n x (|v|^2 u - |u|^2 v)) is the power of x times
  // |n|^2. Each of the two terms is off by less than 30 roundings of the products of lengths that
  // bound it.
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 x = p - a;
  const double uu = SquaredNorm(u);
  const double vv = SquaredNorm(v);
  const double xx = SquaredNorm(x);
  const Vec3 n = Cross(u, v);
  const Vec3 t = vv * u - uu * v;
  const double power = SquaredNorm(n) * xx - Dot(x, Cross(n, t));
  const double bound =
    64.0 * Epsilon * uu * vv * (xx + std::sqrt(xx) * (std::sqrt(uu) + std::sqrt(vv)));
  int sign = 0;
  if (IsCertain(-power, bound, sign))
  {
    return sign;
  }
  return static_cast<int>(
    CGAL::side_of_bounded_sphere(ToPoint3(a), ToPoint3(b), ToPoint3(c), ToPoint3(p)));
}

bool AreCollinear(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return CGAL::collinear(ToPoint3(a), ToPoint3(b), ToPoint3(c));
}

int ProjectedOrientation(int axis, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double left = (b[u] - a[u]) * (c[v] - a[v]);
  const double right = (b[v] - a[v]) * (c[u] - a[u]);
  int sign = 0;
  if (IsCertain(left - right, Orientation2Bound * (std::abs(left) + std::abs(right)), sign))
  {
    return sign;
  }
  return static_cast<int>(CGAL::orientation(Project(axis, a), Project(axis, b), Project(axis, c)));
}
} // namespace cdm
