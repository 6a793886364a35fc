// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Determinants.h
 * @brief The determinants behind the predicates in floating point, with bounds of their errors.
 *
 * Filters of the exact predicates: Predicates.h decides what these leave open. The bounds hold in
 * any binary floating-point type; the products of the permanents are bounded by those of the
 * largest differences, which costs a third of the permanents themselves.
 *
 * Powers of points have the sign of the distance from the sphere: negative inside.
 *
 * References: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
 * geometric predicates", 1997, doi:10.1007/PL00009321 ("A" stages of orient3d and insphere).
 */
#ifndef cdmDeterminants_h
#define cdmDeterminants_h

#include "Core/Basics/Vec3.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
/** Bounds below this may have lost digits to underflow: they tell nothing. */
constexpr double SmallestCertainBound = 1e-280;

template <typename Real>
struct Determinant
{
  Real Value;
  /** More than the error of the value. */
  Real Bound;

  bool IsCertain() const
  {
    return this->Bound > Real(SmallestCertainBound) && std::abs(this->Value) > this->Bound;
  }
  int GetSign() const { return this->Value > 0 ? 1 : this->Value < 0 ? -1 : 0; }
};

template <typename Real>
inline Real GetLargest(Real a, Real b, Real c)
{
  return std::max(std::max(a, b), c);
}

/** A determinant with the sign of Orientation(). */
template <typename Real>
inline Determinant<Real> GetOrientationDeterminant(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Real px = Real(a.X) - d.X;
  const Real py = Real(a.Y) - d.Y;
  const Real pz = Real(a.Z) - d.Z;
  const Real qx = Real(b.X) - d.X;
  const Real qy = Real(b.Y) - d.Y;
  const Real qz = Real(b.Z) - d.Z;
  const Real rx = Real(c.X) - d.X;
  const Real ry = Real(c.Y) - d.Y;
  const Real rz = Real(c.Z) - d.Z;
  const Real value = px * (qz * ry - qy * rz) + py * (qx * rz - qz * rx) + pz * (qy * rx - qx * ry);
  const Real x = GetLargest(std::abs(px), std::abs(qx), std::abs(rx));
  const Real y = GetLargest(std::abs(py), std::abs(qy), std::abs(ry));
  const Real z = GetLargest(std::abs(pz), std::abs(qz), std::abs(rz));
  // Six products, each off by less than eight roundings.
  constexpr Real Unit = 6 * 8 * (std::numeric_limits<Real>::epsilon() / 2);
  return { value, Unit * x * y * z };
}

/** A determinant with the sign of InSphere(). */
template <typename Real>
inline Determinant<Real> GetInSphereDeterminant(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e)
{
  const Real px = Real(a.X) - e.X;
  const Real py = Real(a.Y) - e.Y;
  const Real pz = Real(a.Z) - e.Z;
  const Real qx = Real(b.X) - e.X;
  const Real qy = Real(b.Y) - e.Y;
  const Real qz = Real(b.Z) - e.Z;
  const Real rx = Real(c.X) - e.X;
  const Real ry = Real(c.Y) - e.Y;
  const Real rz = Real(c.Z) - e.Z;
  const Real sx = Real(d.X) - e.X;
  const Real sy = Real(d.Y) - e.Y;
  const Real sz = Real(d.Z) - e.Z;

  const Real pq = px * qy - qx * py;
  const Real qr = qx * ry - rx * qy;
  const Real rs = rx * sy - sx * ry;
  const Real sp = sx * py - px * sy;
  const Real pr = px * ry - rx * py;
  const Real qs = qx * sy - sx * qy;

  const Real pqr = pz * qr - qz * pr + rz * pq;
  const Real qrs = qz * rs - rz * qs + sz * qr;
  const Real rsp = rz * sp + sz * pr + pz * rs;
  const Real spq = sz * pq + pz * qs + qz * sp;

  const Real pp = px * px + py * py + pz * pz;
  const Real qq = qx * qx + qy * qy + qz * qz;
  const Real rr = rx * rx + ry * ry + rz * rz;
  const Real ss = sx * sx + sy * sy + sz * sz;

  const Real value = (rr * spq - ss * pqr) + (pp * qrs - qq * rsp);
  const Real x = std::max(GetLargest(std::abs(px), std::abs(qx), std::abs(rx)), std::abs(sx));
  const Real y = std::max(GetLargest(std::abs(py), std::abs(qy), std::abs(ry)), std::abs(sy));
  const Real z = std::max(GetLargest(std::abs(pz), std::abs(qz), std::abs(rz)), std::abs(sz));
  // 24 products, each off by less than seventeen roundings.
  constexpr Real Unit = 24 * 17 * (std::numeric_limits<Real>::epsilon() / 2);
  return { value, Unit * x * y * z * std::max(GetLargest(pp, qq, rr), ss) };
}

/** Power of p of the smallest sphere through a and b. */
template <typename Real>
inline Determinant<Real> GetDiametralPower(const Vec3& a, const Vec3& b, const Vec3& p)
{
  const Real x = (Real(a.X) - p.X) * (Real(b.X) - p.X);
  const Real y = (Real(a.Y) - p.Y) * (Real(b.Y) - p.Y);
  const Real z = (Real(a.Z) - p.Z) * (Real(b.Z) - p.Z);
  // Three products, each off by less than three roundings, and two sums.
  constexpr Real Unit = 8 * (std::numeric_limits<Real>::epsilon() / 2);
  return { x + y + z, Unit * (std::abs(x) + std::abs(y) + std::abs(z)) };
}

/**
 * Power of p of the smallest sphere through a, b and c, times the square of twice their area. With
 * a as origin and n = u x v: |n|^2 |p|^2 - p (n x (|v|^2 u - |u|^2 v)).
 */
template <typename Real>
inline Determinant<Real> GetEquatorialPower(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p)
{
  const Real ux = Real(b.X) - a.X;
  const Real uy = Real(b.Y) - a.Y;
  const Real uz = Real(b.Z) - a.Z;
  const Real vx = Real(c.X) - a.X;
  const Real vy = Real(c.Y) - a.Y;
  const Real vz = Real(c.Z) - a.Z;
  const Real px = Real(p.X) - a.X;
  const Real py = Real(p.Y) - a.Y;
  const Real pz = Real(p.Z) - a.Z;
  const Real uu = ux * ux + uy * uy + uz * uz;
  const Real vv = vx * vx + vy * vy + vz * vz;
  const Real pp = px * px + py * py + pz * pz;
  const Real nx = uy * vz - uz * vy;
  const Real ny = uz * vx - ux * vz;
  const Real nz = ux * vy - uy * vx;
  const Real tx = vv * ux - uu * vx;
  const Real ty = vv * uy - uu * vy;
  const Real tz = vv * uz - uu * vz;
  const Real value = (nx * nx + ny * ny + nz * nz) * pp -
    (px * (ny * tz - nz * ty) + py * (nz * tx - nx * tz) + pz * (nx * ty - ny * tx));
  // Each of the two terms is off by less than 30 roundings of the products of lengths that bound
  // it.
  constexpr Real Unit = 64 * (std::numeric_limits<Real>::epsilon() / 2);
  const Real bound = Unit * uu * vv * (pp + std::sqrt(pp) * (std::sqrt(uu) + std::sqrt(vv)));
  return { value, bound };
}
} // namespace cdm

#endif
