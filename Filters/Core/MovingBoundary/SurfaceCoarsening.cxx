// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MovingBoundary/SurfaceCoarsening.h"

#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/MergeableSurface.h"
#include "Core/Meshes/TriangleIntersection.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace cdm
{
namespace
{
/**
 * Whether each triangle of the point keeps its plane, to flatness, and its orientation, exactly.
 */
bool KeepsShape(const MergeableSurface& surface, Id point, Id target, double flatness)
{
  const std::vector<Vec3>& points = surface.GetPoints();
  for (const Id t : surface.GetUses(point))
  {
    if (surface.Has(t, target))
    {
      continue;
    }
    const TriangleIds& ids = surface.GetTriangle(t);
    const Vec3 normal = Cross(points[ids[1]] - points[ids[0]], points[ids[2]] - points[ids[0]]);
    if (std::abs(Dot(normal, points[target] - points[ids[0]])) > flatness * Norm(normal))
    {
      return false;
    }
    TriangleIds merged = ids;
    std::replace(merged.begin(), merged.end(), point, target);
    int sign = 0;
    const int axis = FindProjectionAxis(points[ids[0]], points[ids[1]], points[ids[2]], sign);
    if (ProjectedOrientation(axis, points[merged[0]], points[merged[1]], points[merged[2]]) != sign)
    {
      return false;
    }
  }
  return true;
}
} // namespace

void CoarsenSurface(const std::vector<char>& isRemovable, double flatness, TriangleMesh& surface)
{
  MergeableSurface mergeable(surface);
  std::deque<Id> queue;
  for (std::size_t point = 0; point < isRemovable.size(); ++point)
  {
    if (isRemovable[point])
    {
      queue.push_back(static_cast<Id>(point));
    }
  }
  while (!queue.empty())
  {
    const Id point = queue.front();
    queue.pop_front();
    const std::vector<Id> neighbors = mergeable.GetNeighbors(point);
    const auto target = std::find_if(neighbors.begin(), neighbors.end(),
      [&](Id neighbor)
      {
        return KeepsShape(mergeable, point, neighbor, flatness) &&
          mergeable.KeepsTopology(point, neighbor);
      });
    if (target == neighbors.end())
    {
      continue;
    }
    mergeable.Merge(point, *target);
    for (const Id neighbor : neighbors)
    {
      if (isRemovable[neighbor])
      {
        queue.push_back(neighbor);
      }
    }
  }
  mergeable.Finish();
}
} // namespace cdm
