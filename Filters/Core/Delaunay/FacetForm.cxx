// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/FacetForm.h"

#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
FacetForm::FacetForm(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& apex)
  : A(a), B(b), C(c), Normal(Cross(b - a, c - a)), Sphere(a, c, b, apex)
{
  double size = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    size = std::max({ size, std::abs((b - a)[axis]), std::abs((c - a)[axis]) });
  }
  // Two products of differences, each with a few roundings.
  this->Error = 0x1p-49 * size * size;
}

bool FacetForm::MayTouch(const Vec3& low, const Vec3& high) const
{
  double largest = 0.0;
  // Bound of what underflow may lose.
  double error = std::numeric_limits<double>::min();
  for (int axis = 0; axis < 3; ++axis)
  {
    const double lower = low[axis] - this->A[axis];
    const double upper = high[axis] - this->A[axis];
    largest += std::max(this->Normal[axis] * lower, this->Normal[axis] * upper);
    error += (this->Error + 0x1p-49 * std::abs(this->Normal[axis])) *
      std::max(std::abs(lower), std::abs(upper));
  }
  if (std::abs(largest) > error)
  {
    return largest > 0.0;
  }
  // The box comes close to the plane, as all of a flat side of the hull does: if no corner is
  // beyond it, points in the plane are left, for which the sphere decides.
  for (int corner = 0; corner < 8; ++corner)
  {
    const Vec3 p{ (corner & 1 ? high : low).X, (corner & 2 ? high : low).Y,
      (corner & 4 ? high : low).Z };
    if (Orientation(this->A, this->B, this->C, p) > 0)
    {
      return true;
    }
  }
  return this->Sphere.MayTouch(low, high);
}

int FacetForm::GetSide(const Vec3& point) const
{
  const int side = Orientation(this->A, this->B, this->C, point);
  return side != 0 ? side : this->Sphere.GetSide(point);
}
} // namespace cdm
