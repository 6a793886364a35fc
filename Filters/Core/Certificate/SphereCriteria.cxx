// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/SphereCriteria.h"

#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/SphereForm.h"
#include "Core/Meshes/TetMesh.h"

#include <tuple>
#include <utility>

namespace cdm
{
template <std::size_t N, typename Predicate>
bool SphereCriteria::FindInside(const std::array<Id, N>& ids, Predicate&& isInside) const
{
  const auto find = [&](const auto&... corners)
  {
    const EnclosingBall ball(corners...);
    return ball.IsUsable() ? this->Search.FindInside(ball, ids, isInside)
                           : this->Search.FindInside(SphereForm(corners...), ids, isInside);
  };
  return std::apply([&](auto... id) { return find(this->Points[id]...); }, ids);
}

bool SphereCriteria::IsDelaunay(const TetrahedronIds& ids) const
{
  const std::array<Vec3, 4> v = GetCorners(this->Points, ids);
  return !this->FindInside(
    ids, [&](Id point) { return InSphere(v[0], v[1], v[2], v[3], this->Points[point]) > 0; });
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
  return AreCollinear(a, b, c) || !this->FindInside(ids, isInside);
}

bool SphereCriteria::HasEmptySmallestSphere(const EdgeIds& ids) const
{
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  return !this->FindInside(
    ids, [&](Id point) { return InDiametralSphere(a, b, this->Points[point]) > 0; });
}
} // namespace cdm
