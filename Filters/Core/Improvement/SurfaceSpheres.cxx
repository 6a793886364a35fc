// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SurfaceSpheres.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Box.h"
#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <array>

namespace cdm
{
namespace
{
/** Looks for a point inside the smallest sphere of a triangle, other than its corners. */
class TriangleSphereVisitor
{
public:
  TriangleSphereVisitor(const TriangleIds& ids, const std::array<Vec3, 3>& corners)
    : Ids(ids), Corners(corners), Ball(corners[0], corners[1], corners[2])
  {
  }

  /** Whether the ball around the sphere is tight enough for a search. */
  bool IsUsable() const { return this->Ball.IsUsable(); }
  Box GetReach() const { return Box::MakeAround(this->Ball.GetCenter(), this->Ball.GetRadius()); }

  double Order(const Box& box) const
  {
    return !this->IsFound && this->Ball.MayTouch(box.Low, box.High)
      ? box.GetSquaredDistance(this->Ball.GetCenter())
      : Infinity;
  }

  void Visit(Id id, const Vec3& p)
  {
    this->IsFound = this->IsFound ||
      (this->Ball.MayHold(p) && !Contains(this->Ids, id) &&
        InEquatorialSphere(this->Corners[0], this->Corners[1], this->Corners[2], p) > 0);
  }

  bool IsFound = false;

private:
  const TriangleIds& Ids;
  const std::array<Vec3, 3>& Corners;
  const EnclosingBall Ball;
};
} // namespace

SurfaceSpheres::SurfaceSpheres(
  const TriangleMesh& surface, const IdLists& pointTriangles, const BoundarySpheres& spheres)
  : Surface(surface), PointTriangles(pointTriangles), Spheres(spheres)
{
  this->Octree.Insert(surface.Points);
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
      TriangleSphereVisitor visitor(ids, corners);
      if (visitor.IsUsable())
      {
        this->Octree.Visit(visitor, visitor.GetReach());
      }
      return visitor.IsUsable() && !visitor.IsFound;
    });
}
} // namespace cdm
