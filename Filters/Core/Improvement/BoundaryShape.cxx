// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundaryShape.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace cdm
{
BoundaryShape::BoundaryShape(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
  const std::vector<StructuralEdge>& keptEdges, double sharpPlaneAngle, double layerAspectRatio)
  : Spheres(surface, keptEdges),
    PointTriangles(ListTrianglesAtPoints(surface.Triangles, surface.Points.size())),
    Sharp(surface, edges, this->PointTriangles, sharpPlaneAngle),
    Layers(surface, this->PointTriangles, layerAspectRatio), Surface(surface), Edges(edges)
{
}

void BoundaryShape::Follow(const BoundaryChange& change)
{
  this->Spheres.Follow(change.Triangles, change.Edges, change.Segments);
  this->FollowTriangles(change.Triangles);
  this->Sharp.Follow(this->Edges, change.Edges, change.Triangles, change.Parents);
  this->Layers.Follow(change.Triangles, change.Parents);
}

/**
 * Lists the triangles at points again where they have changed. A point that has lost a triangle is a
 * corner of another one that has changed: each split and flip leaves one at all corners.
 */
void BoundaryShape::FollowTriangles(const std::vector<Id>& triangles)
{
  const std::vector<TriangleIds>& all = this->Surface.Triangles;
  if (this->PointTriangles.GetNumberOfIds() > 6 * all.size())
  {
    this->PointTriangles.Build(static_cast<Id>(this->Surface.Points.size()), all);
    return;
  }
  std::vector<std::pair<Id, Id>> corners;
  for (Id t : triangles)
  {
    for (Id point : all[t])
    {
      corners.emplace_back(point, t);
    }
  }
  std::sort(corners.begin(), corners.end());
  std::vector<Id> ids;
  auto next = corners.begin();
  const auto takeNew = [&](Id point)
  {
    for (; next != corners.end() && next->first == point; ++next)
    {
      ids.push_back(next->second);
    }
    SortUnique(ids);
  };
  const Id count = this->PointTriangles.GetNumberOfOwners();
  while (next != corners.end() && next->first < count)
  {
    const Id point = next->first;
    const IdLists::Range before = this->PointTriangles[point];
    ids.clear();
    std::copy_if(before.begin(), before.end(), std::back_inserter(ids),
      [&](Id t) { return Contains(all[t], point); });
    takeNew(point);
    this->PointTriangles.Replace(point, ids);
  }
  for (Id point = count; point < static_cast<Id>(this->Surface.Points.size()); ++point)
  {
    ids.clear();
    takeNew(point);
    this->PointTriangles.Append(ids);
  }
}
} // namespace cdm
