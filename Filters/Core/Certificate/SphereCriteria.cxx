// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/SphereCriteria.h"

#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/SphereForm.h"

#include <utility>

namespace cdm
{
bool SphereCriteria::IsDelaunay(const TetrahedronIds& ids) const
{
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  const Vec3& c = this->Points[ids[2]];
  const Vec3& d = this->Points[ids[3]];
  const auto isInside = [&](Id point) { return InSphere(a, b, c, d, this->Points[point]) > 0; };
  const EnclosingBall ball(a, b, c, d);
  return !(ball.IsUsable() ? this->Search.FindInside(ball, ids, isInside)
                           : this->Search.FindInside(SphereForm(a, b, c, d), ids, isInside));
}

bool SphereCriteria::IsDelaunay(const TriangleIds& ids) const
{
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  const Vec3& c = this->Points[ids[2]];
  if (AreCollinear(a, b, c))
  {
    return true;
  }
  // Points in the smallest sphere: their side, and the one of them with the smallest lambda.
  int side = 0;
  Id first = NoId;
  const bool isImpossible = this->Search.FindInside(SphereForm(a, b, c), ids,
    [&](Id point)
    {
      const Vec3& p = this->Points[point];
      if (InEquatorialSphere(a, b, c, p) <= 0)
      {
        return false;
      }
      const int pointSide = Orientation(a, b, c, p);
      if (pointSide == 0 || pointSide == -side)
      {
        return true;
      }
      side = pointSide;
      if (first == NoId || side * InSphere(a, b, c, this->Points[first], p) > 0)
      {
        first = point;
      }
      return false;
    });
  if (isImpossible || first == NoId)
  {
    return !isImpossible;
  }
  TetrahedronIds tetrahedron{ ids[0], ids[1], ids[2], first };
  if (side < 0)
  {
    std::swap(tetrahedron[0], tetrahedron[1]);
  }
  return this->IsDelaunay(tetrahedron);
}

bool SphereCriteria::HasEmptySmallestSphere(const TriangleIds& ids) const
{
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  const Vec3& c = this->Points[ids[2]];
  const auto isInside = [&](Id point)
  { return InEquatorialSphere(a, b, c, this->Points[point]) > 0; };
  const EnclosingBall ball(a, b, c);
  // Collinear points have no ball.
  return ball.IsUsable()
    ? !this->Search.FindInside(ball, ids, isInside)
    : AreCollinear(a, b, c) || !this->Search.FindInside(SphereForm(a, b, c), ids, isInside);
}

bool SphereCriteria::HasEmptySmallestSphere(const EdgeIds& ids) const
{
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  return !this->Search.FindInside(SphereForm(a, b), ids,
    [&](Id point) { return InDiametralSphere(a, b, this->Points[point]) > 0; });
}
} // namespace cdm
