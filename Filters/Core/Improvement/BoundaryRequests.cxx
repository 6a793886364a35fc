// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundaryRequests.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <utility>

namespace cdm
{
BoundaryRequests::BoundaryRequests(
  const TriangleMesh& surface, const std::vector<StructuralEdge>& edges, DistanceRule mayHavePoint)
  : Surface(surface), SurfaceEdges(edges), Rule(std::move(mayHavePoint))
{
  this->Clear();
}

void BoundaryRequests::Clear()
{
  this->Triangles.clear();
  this->Edges.clear();
  this->IsTriangleRequested.assign(this->Surface.Triangles.size(), 0);
  this->IsEdgeRequested.assign(this->SurfaceEdges.size(), 0);
}

template <typename Ids>
bool BoundaryRequests::MayHavePoint(const Ids& ids, double distance) const
{
  return std::all_of(ids.begin(), ids.end(), [&](Id id) { return this->Rule(id, distance); });
}

/** Requests an edge to be split. False if it may not be split. */
bool BoundaryRequests::AddEdge(Id edge, bool isDistanceKept)
{
  const EdgeIds& ends = this->SurfaceEdges[edge].Points;
  const double half = 0.5 * Distance(this->Surface.Points[ends[0]], this->Surface.Points[ends[1]]);
  if (isDistanceKept && !this->MayHavePoint(ends, half))
  {
    return false;
  }
  if (!this->IsEdgeRequested[edge])
  {
    this->IsEdgeRequested[edge] = 1;
    this->Edges.push_back(ends);
  }
  return true;
}

/** Requests a triangle to be split; does nothing for NoId. */
void BoundaryRequests::AddTriangle(Id triangle)
{
  if (triangle != NoId && !this->IsTriangleRequested[triangle])
  {
    this->IsTriangleRequested[triangle] = 1;
    this->Triangles.push_back(triangle);
  }
}

void BoundaryRequests::AddEncroached(
  const Vec3& position, const BoundarySpheres::Encroached& encroached, bool isDistanceKept)
{
  double deepest = Infinity;
  Id best = NoId;
  for (Id e : encroached.Edges)
  {
    if (this->IsEdgeRequested[e])
    {
      return;
    }
    const EdgeIds& ends = this->SurfaceEdges[e].Points;
    const Vec3& a = this->Surface.Points[ends[0]];
    const Vec3& b = this->Surface.Points[ends[1]];
    const double radius = 0.5 * Distance(a, b);
    const double depth = Distance(position, 0.5 * (a + b)) / radius;
    if (depth < deepest && (!isDistanceKept || this->MayHavePoint(ends, radius)))
    {
      deepest = depth;
      best = e;
    }
  }
  if (best != NoId)
  {
    this->AddEdge(best, isDistanceKept);
  }
  if (!encroached.Edges.empty())
  {
    return;
  }
  for (Id t : encroached.Triangles)
  {
    if (this->IsTriangleRequested[t])
    {
      return;
    }
    const TriangleIds& ids = this->Surface.Triangles[t];
    const Vec3& a = this->Surface.Points[ids[0]];
    const Vec3 offset =
      GetCircumcenterOffset(a, this->Surface.Points[ids[1]], this->Surface.Points[ids[2]]);
    const double depth = Distance(position, a + offset) / Norm(offset);
    if (depth < deepest && (!isDistanceKept || this->MayHavePoint(ids, Norm(offset))))
    {
      deepest = depth;
      best = t;
    }
  }
  this->AddTriangle(best);
}

bool BoundaryRequests::AddEdgeOfTwoTriangles(
  const TetrahedronIds& ids, const IdLists& pointTriangles)
{
  for (const auto& positions : TetrahedronEdges)
  {
    const EdgeIds ends = MakeEdge(ids[positions[0]], ids[positions[1]]);
    const StructuralEdge* const edge = FindStructuralEdge(this->SurfaceEdges, ends);
    if (edge == nullptr)
    {
      continue;
    }
    int count = 0;
    for (Id t : pointTriangles[ends[0]])
    {
      const TriangleIds& triangle = this->Surface.Triangles[t];
      count +=
        std::all_of(triangle.begin(), triangle.end(), [&](Id id) { return Contains(ids, id); }) &&
        Contains(triangle, ends[1]);
    }
    if (count == 2 && this->AddEdge(static_cast<Id>(edge - this->SurfaceEdges.data()), true))
    {
      return true;
    }
  }
  return false;
}

void BoundaryRequests::AddEdgeOrTriangle(
  const EdgeIds& ends, const IdLists& pointTriangles, bool isDistanceKept)
{
  if (const StructuralEdge* const edge = FindStructuralEdge(this->SurfaceEdges, ends))
  {
    this->AddEdge(static_cast<Id>(edge - this->SurfaceEdges.data()), isDistanceKept);
    return;
  }
  std::vector<Id> triangles;
  for (Id t : pointTriangles[ends[0]])
  {
    const TriangleIds& corners = this->Surface.Triangles[t];
    if (Contains(corners, ends[1]))
    {
      triangles.push_back(t);
    }
  }
  this->AddLargest(triangles, isDistanceKept);
}

void BoundaryRequests::AddLargestTriangle(const TetrahedronIds& ids, const IdLists& pointTriangles)
{
  std::vector<Id> triangles;
  for (Id id : ids)
  {
    if (id < static_cast<Id>(this->Surface.Points.size()))
    {
      triangles.insert(triangles.end(), pointTriangles[id].begin(), pointTriangles[id].end());
    }
  }
  this->AddLargest(triangles, true);
}

/** Requests the largest of the triangles that may be split. */
void BoundaryRequests::AddLargest(const std::vector<Id>& triangles, bool isDistanceKept)
{
  double largest = 0.0;
  Id best = NoId;
  for (Id t : triangles)
  {
    const TriangleIds& corners = this->Surface.Triangles[t];
    const double radius = Norm(GetCircumcenterOffset(this->Surface.Points[corners[0]],
      this->Surface.Points[corners[1]], this->Surface.Points[corners[2]]));
    if (radius > largest && (!isDistanceKept || this->MayHavePoint(corners, radius)))
    {
      largest = radius;
      best = t;
    }
  }
  this->AddTriangle(best);
}
} // namespace cdm
