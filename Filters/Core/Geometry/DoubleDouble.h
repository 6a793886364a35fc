// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DoubleDouble.h
 * @brief Arithmetic with twice the digits of double: unevaluated sums of two doubles.
 *
 * It tightens floating-point estimates; it never decides topology. Relative error of an operation:
 * less than 8 squared machine epsilons of double.
 *
 * References: T. J. Dekker, "A floating-point technique for extending the available precision",
 * 1971, doi:10.1007/BF01397083.
 */
#ifndef cdmDoubleDouble_h
#define cdmDoubleDouble_h

#include "Core/Basics/Vec3.h"

#include <cmath>

namespace cdm
{
struct DoubleDouble
{
  double High = 0.0;
  double Low = 0.0;

  static DoubleDouble FromSum(double a, double b)
  {
    const double s = a + b;
    const double t = s - a;
    return { s, (a - (s - t)) + (b - t) };
  }

  static DoubleDouble FromProduct(double a, double b)
  {
    // Halves of 26 digits, whose products are exact; faster than a fused multiplication that the
    // processor is not known to have.
    constexpr double Splitter = 134217729.0;
    const double p = a * b;
    const double aBig = Splitter * a;
    const double aHigh = aBig - (aBig - a);
    const double aLow = a - aHigh;
    const double bBig = Splitter * b;
    const double bHigh = bBig - (bBig - b);
    const double bLow = b - bHigh;
    return { p, aLow * bLow - (((p - aHigh * bHigh) - aLow * bHigh) - aHigh * bLow) };
  }

  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b)
  {
    const DoubleDouble high = FromSum(a.High, b.High);
    const DoubleDouble low = FromSum(a.Low, b.Low);
    const DoubleDouble sum = FromSum(high.High, high.Low + low.High);
    return FromSum(sum.High, sum.Low + low.Low);
  }
  friend DoubleDouble operator-(const DoubleDouble& a) { return { -a.High, -a.Low }; }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b)
  {
    const DoubleDouble product = FromProduct(a.High, b.High);
    return FromSum(product.High, product.Low + (a.High * b.Low + a.Low * b.High));
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b)
  {
    const double first = a.High / b.High;
    const double second = (a - DoubleDouble{ first, 0.0 } * b).High / b.High;
    return FromSum(first, second);
  }
};

struct DoubleDouble3
{
  DoubleDouble X[3];

  /** Exact. */
  static DoubleDouble3 FromDifference(const Vec3& a, const Vec3& b)
  {
    DoubleDouble3 result;
    for (int axis = 0; axis < 3; ++axis)
    {
      result.X[axis] = DoubleDouble::FromSum(a[axis], -b[axis]);
    }
    return result;
  }

  Vec3 GetHigh() const { return { this->X[0].High, this->X[1].High, this->X[2].High }; }

  friend DoubleDouble Dot(const DoubleDouble3& a, const DoubleDouble3& b)
  {
    return a.X[0] * b.X[0] + a.X[1] * b.X[1] + a.X[2] * b.X[2];
  }
  friend DoubleDouble3 Cross(const DoubleDouble3& a, const DoubleDouble3& b)
  {
    DoubleDouble3 result;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int j = (axis + 1) % 3;
      const int k = (axis + 2) % 3;
      result.X[axis] = a.X[j] * b.X[k] - a.X[k] * b.X[j];
    }
    return result;
  }
};
} // namespace cdm

#endif
