// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/MeshPointClearance.h"

#include "Core/Basics/ParallelSort.h"
#include "Core/Geometry/Box.h"
#include "Core/Geometry/Measures.h"
#include "Core/Search/PointOctree.h"

#include <algorithm>

namespace cdm
{
namespace
{
/** Points within a distance of a triangle. */
class NearTriangleVisitor
{
public:
  NearTriangleVisitor(
    const Vec3& a, const Vec3& b, const Vec3& c, double distance, std::vector<char>& isNear)
    : Corners{ a, b, c }, Distance(distance), IsNear(isNear)
  {
    this->Bounds.Add(a);
    this->Bounds.Add(b);
    this->Bounds.Add(c);
    const Vec3 margin{ distance, distance, distance };
    this->Bounds = { this->Bounds.Low - margin, this->Bounds.High + margin };
  }

  double Order(const Box& box) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (box.Low[axis] > this->Bounds.High[axis] || box.High[axis] < this->Bounds.Low[axis])
      {
        return Infinity;
      }
    }
    return 0.0;
  }

  /** The box of the triangle, wider by the distance on each side. */
  const Box& GetReach() const { return this->Bounds; }

  void Visit(Id id, const Vec3& p)
  {
    if (!this->IsNear[id] &&
      GetDistanceToTriangle(p, this->Corners[0], this->Corners[1], this->Corners[2]) <=
        this->Distance)
    {
      this->IsNear[id] = 1;
    }
  }

private:
  Vec3 Corners[3];
  Box Bounds;
  double Distance;
  std::vector<char>& IsNear;
};
} // namespace

std::vector<Id> FindClearMeshPoints(const TriangleMesh& surface,
  const std::vector<Vec3>& meshPoints, double clearance, int numberOfThreads)
{
  std::vector<Id> order;
  for (std::size_t i = 0; i < meshPoints.size(); ++i)
  {
    if (IsFinite(meshPoints[i]))
    {
      order.push_back(static_cast<Id>(i));
    }
  }
  ParallelSort(order, numberOfThreads, {}, "",
    [&meshPoints](Id i, Id j)
    { return meshPoints[i] != meshPoints[j] ? meshPoints[i] < meshPoints[j] : i < j; });
  order.erase(std::unique(order.begin(), order.end(),
                [&meshPoints](Id i, Id j) { return meshPoints[i] == meshPoints[j]; }),
    order.end());
  std::vector<Vec3> positions;
  positions.reserve(order.size());
  for (const Id i : order)
  {
    positions.push_back(meshPoints[i]);
  }
  PointOctree octree;
  octree.Insert(positions);
  std::vector<char> isClose(order.size(), 0);
  for (const TriangleIds& ids : surface.Triangles)
  {
    NearTriangleVisitor visitor(
      surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]], clearance, isClose);
    octree.Visit(visitor, visitor.GetReach());
  }
  std::vector<Id> clear;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    if (!isClose[i])
    {
      clear.push_back(order[i]);
    }
  }
  std::sort(clear.begin(), clear.end());
  return clear;
}
} // namespace cdm
