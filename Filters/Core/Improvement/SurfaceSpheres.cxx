// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SurfaceSpheres.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <array>

namespace cdm
{
SurfaceSpheres::SurfaceSpheres(
  const TriangleMesh& surface, const IdLists& pointTriangles, const BoundarySpheres& spheres)
  : Surface(surface), PointTriangles(pointTriangles), Spheres(spheres), Search(surface.Points)
{
}

bool SurfaceSpheres::StayEmpty(Id point, const Vec3& position) const
{
  BoundarySpheres::Encroached encroached;
  this->Spheres.Find(position, encroached);
  const auto isFilled = [&](Id triangle)
  {
    const TriangleIds& ids = this->Surface.Triangles[triangle];
    const std::vector<Vec3>& points = this->Surface.Points;
    return !Contains(ids, point) &&
      InEquatorialSphere(points[ids[0]], points[ids[1]], points[ids[2]], position) > 0;
  };
  if (std::any_of(encroached.Triangles.begin(), encroached.Triangles.end(), isFilled))
  {
    return false;
  }
  const IdLists::Range moved = this->PointTriangles[point];
  return std::all_of(moved.begin(), moved.end(),
    [&](Id triangle)
    {
      const TriangleIds& ids = this->Surface.Triangles[triangle];
      std::array<Vec3, 3> corners;
      for (int i = 0; i < 3; ++i)
      {
        corners[i] = ids[i] == point ? position : this->Surface.Points[ids[i]];
      }
      const EnclosingBall ball(corners[0], corners[1], corners[2]);
      return ball.IsUsable() &&
        !this->Search.FindInside(ball, ids,
          [&](Id other)
          {
            return InEquatorialSphere(
                     corners[0], corners[1], corners[2], this->Surface.Points[other]) > 0;
          });
    });
}
} // namespace cdm
