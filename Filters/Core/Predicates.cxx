// SPDX-License-Identifier: BSD-3-Clause
#include "Predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cmath>
#include <limits>

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
}

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
  return static_cast<int>(
    CGAL::orientation(ToPoint3(a), ToPoint3(b), ToPoint3(c), ToPoint3(d)));
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
  return static_cast<int>(CGAL::side_of_oriented_sphere(
    ToPoint3(a), ToPoint3(b), ToPoint3(c), ToPoint3(d), ToPoint3(e)));
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
  return static_cast<int>(
    CGAL::orientation(Project(axis, a), Project(axis, b), Project(axis, c)));
}
}
