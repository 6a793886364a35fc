// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/FacetApex.h"

#include "Core/Geometry/Determinants.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/PulledSphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cdm
{
namespace
{
constexpr double Roundoff = std::numeric_limits<double>::epsilon() / 2.0;

/** The plane of a facet, relative to the facet's first point. */
struct Plane
{
  Plane(const Vec3& a, const Vec3& b, const Vec3& c)
    : U(b - a), V(c - a), Normal(Cross(U, V)), BoundU(SumNorm(U)), BoundV(SumNorm(V))
  {
  }

  /** A determinant with the sign of Orientation(). */
  Determinant<double> GetSide(const Vec3& point, double bound) const
  {
    // Products of three components, each off by less than eight roundings.
    return { Dot(this->Normal, point), 16.0 * Roundoff * this->BoundU * this->BoundV * bound };
  }

  Vec3 U;
  Vec3 V;
  Vec3 Normal;
  double BoundU;
  double BoundV;
};
} // namespace

/** The sphere through a facet and a point in front, relative to the facet's first point. */
struct FacetApex::Sphere
{
  Sphere() = default;
  Sphere(const Plane& plane, const Vec3& apex)
    : Curvature(Dot(plane.Normal, apex)),
      Gradient(SquaredNorm(apex) * plane.Normal + SquaredNorm(plane.V) * Cross(apex, plane.U) +
        SquaredNorm(plane.U) * Cross(plane.V, apex))
  {
    const double length = SumNorm(apex);
    // Products of five components, each off by less than 18 roundings.
    this->Scale = 32.0 * Roundoff * plane.BoundU * plane.BoundV * length;
    this->Reach = plane.BoundU + plane.BoundV + length;
  }

  /** A determinant with the sign of InSphere(). */
  Determinant<double> GetPosition(const Vec3& point, double bound) const
  {
    return { Dot(point, this->Gradient) - this->Curvature * SquaredNorm(point),
      this->Scale * bound * (bound + this->Reach) };
  }

  double Curvature = 0.0;
  Vec3 Gradient;
  double Scale = 0.0;
  double Reach = 0.0;
};

/** For a point too close to the sphere to tell. */
bool FacetApex::IsInsideExactly(const TriangleIds& facet, Id apex, Id point) const
{
  const TetrahedronIds ids{ facet[0], facet[1], facet[2], apex };
  const std::array<Vec3, 4> corners{ this->Points[ids[0]], this->Points[ids[1]],
    this->Points[ids[2]], this->Points[ids[3]] };
  const Vec3& p = this->Points[point];
  const int side = ExactInSphere(corners[0], corners[1], corners[2], corners[3], p);
  return (side != 0 ? side
                    : GetPulledPosition(corners,
                        { this->Numbers[ids[0]], this->Numbers[ids[1]], this->Numbers[ids[2]],
                          this->Numbers[ids[3]] },
                        p, this->Numbers[point], Orientation)) > 0;
}

Id FacetApex::Find(const TriangleIds& facet, bool isFacet)
{
  // For the compiler, members may change at each call: what does not is held here.
  const Vec3* const points = this->Points.data();
  const Id count = static_cast<Id>(this->Points.size());
  const Vec3 a = points[facet[0]];
  const Plane plane(a, points[facet[1]], points[facet[2]]);
  Sphere sphere;
  Id apex = NoId;
  const auto isInside = [&](Id point, const Vec3& arm, double bound)
  {
    const Determinant<double> position = sphere.GetPosition(arm, bound);
    return position.IsCertain() ? position.Value > 0.0 : this->IsInsideExactly(facet, apex, point);
  };
  this->Others.clear();
  for (Id point = 0; point < count; ++point)
  {
    const Vec3 arm = points[point] - a;
    const double bound = SumNorm(arm);
    const Determinant<double> height = plane.GetSide(arm, bound);
    const bool isCertain = height.IsCertain();
    const bool isCorner =
      !isCertain && (point == facet[0] || point == facet[1] || point == facet[2]);
    const bool isInFront = isCertain
      ? height.Value > 0.0
      : !isCorner && ExactOrientation(a, points[facet[1]], points[facet[2]], points[point]) > 0;
    if (!isInFront)
    {
      if (!isFacet && !isCorner)
      {
        this->Others.push_back(point);
      }
    }
    else if (apex == NoId || isInside(point, arm, bound))
    {
      apex = point;
      sphere = Sphere(plane, arm);
    }
  }
  // A facet of a Delaunay tetrahedron has no point in the spheres on its other side.
  const bool isDelaunay = isFacet ||
    std::none_of(this->Others.begin(), this->Others.end(),
      [&](Id point)
      {
        const Vec3 arm = points[point] - a;
        return apex == NoId || isInside(point, arm, SumNorm(arm));
      });
  return isDelaunay ? apex : NoId;
}
} // namespace cdm
