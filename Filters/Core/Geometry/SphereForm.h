// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SphereForm.h
 * @brief A sphere through two to four points, and on which side of it a point or a box surely lies.
 *
 * Method: a sphere through point a with center c holds p exactly where
 * g(p) = D |p - a|^2 - 2 (p - a) . D (c - a) is negative; D and D (c - a) are polynomials of the
 * points, evaluated in twice the working precision, so g stays accurate where the center runs off
 * to infinity and the sphere becomes a half space. g is a sum over the axes, each convex: its
 * minimum over a box is found without a square root.
 *
 * Guarantees: a side is told only where the error bounds leave no doubt; the exact predicates
 * decide the rest.
 */
#ifndef cdmSphereForm_h
#define cdmSphereForm_h

#include "Core/Basics/Vec3.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
/** A sphere in the form above. */
class SphereForm
{
public:
  /** The smallest sphere through two points. */
  SphereForm(const Vec3& a, const Vec3& b);
  /** The smallest sphere through three points, the equatorial sphere of the triangle. */
  SphereForm(const Vec3& a, const Vec3& b, const Vec3& c);
  /** The circumsphere of a tetrahedron of positive orientation. */
  SphereForm(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

  /** False only if no point of the box lies inside or on the sphere. */
  bool MayTouch(const Vec3& lower, const Vec3& upper) const;

  /**
   * False only if the point lies outside of the sphere; rarely true for a point that does, as g is
   * evaluated in twice the working precision where the box's bound does not tell.
   */
  bool MayHold(const Vec3& point) const { return this->GetSide(point) >= 0; }

  /** +1: the point surely lies inside, -1: surely outside; 0: too close to tell. */
  int GetSide(const Vec3& point) const;

private:
  /**
   * Relative error of a coefficient rounded to double and of the few operations on it: less than 16
   * units in the last place.
   */
  static constexpr double RoundingBound = 0x1p-49;

  /**
   * Absolute error of the coefficients before they are rounded, and of what is made of them in
   * twice the working precision: sums of fewer than 60 products that are below 20 in units of Size
   * and of the point's distance, each off by less than 2^-100.
   */
  static constexpr double WideBound = 0x1p-88;

  void FindCenter();
  /** The smallest value of g in a box, and how far off it may be. */
  double GetSmallest(const Vec3& lower, const Vec3& upper, double& error) const;

  Vec3 Origin;
  /** Length by which the polynomials are scaled: a power of two near the size of the simplex. */
  double Size = 1.0;
  /** D in units of Size, and what rounding leaves of it. */
  double Curvature = 1.0;
  double CurvatureRest = 0.0;
  /** 2 D (c - a), and what rounding leaves of it. */
  Vec3 Gradient;
  Vec3 GradientRest;
  /** The center relative to Origin: along each axis where g is smallest. */
  Vec3 Center;
};

inline double SphereForm::GetSmallest(const Vec3& lower, const Vec3& upper, double& error) const
{
  double smallest = 0.0;
  error = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double begin = lower[axis] - this->Origin[axis];
    const double end = upper[axis] - this->Origin[axis];
    const double gradient = this->Gradient[axis];
    const double lowest = std::min(std::max(this->Center[axis], begin), end);
    smallest += lowest * (this->Curvature * lowest - gradient);
    const double reach = std::max(std::abs(begin), std::abs(end));
    error += reach *
      (RoundingBound * (this->Curvature * reach + std::abs(gradient)) +
        WideBound * (reach + this->Size));
  }
  return smallest;
}

inline bool SphereForm::MayTouch(const Vec3& lower, const Vec3& upper) const
{
  double error;
  const double smallest = this->GetSmallest(lower, upper, error);
  // In this form a result that is not a number counts as touched.
  return !(smallest > error);
}
} // namespace cdm

#endif
