// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundarySpheres.h"

#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>

namespace cdm
{
BoundarySpheres::BoundarySpheres(
  const TriangleMesh& surface, const std::vector<StructuralEdge>& edges)
  : Surface(surface), Edges(edges)
{
  for (Id t = 0; t < static_cast<Id>(surface.Triangles.size()); ++t)
  {
    this->SetTriangle(t);
  }
  for (Id e = 0; e < static_cast<Id>(edges.size()); ++e)
  {
    this->SegmentEdges.push_back(e);
    this->SetEdge(e, e);
  }
  this->Balls.Settle();
}

void BoundarySpheres::SetTriangle(Id triangle)
{
  const TriangleIds& ids = this->Surface.Triangles[triangle];
  const std::vector<Vec3>& points = this->Surface.Points;
  const EnclosingBall ball(points[ids[0]], points[ids[1]], points[ids[2]]);
  this->Balls.Set(2 * triangle, ball.GetCenter(), ball.GetRadius());
  ++this->NumberOfVisits;
}

void BoundarySpheres::SetEdge(Id edge, Id segment)
{
  const EdgeIds& ends = this->Edges[edge].Points;
  const EnclosingBall ball(this->Surface.Points[ends[0]], this->Surface.Points[ends[1]]);
  this->Balls.Set(2 * segment + 1, ball.GetCenter(), ball.GetRadius());
  ++this->NumberOfVisits;
}

void BoundarySpheres::Follow(const std::vector<Id>& triangles, const std::vector<Id>& changedEdges,
  const std::vector<Id>& segments)
{
  for (Id t : triangles)
  {
    this->SetTriangle(t);
  }
  this->SegmentEdges.resize(segments.size());
  for (std::size_t e = 0; e < segments.size(); ++e)
  {
    this->SegmentEdges[segments[e]] = static_cast<Id>(e);
  }
  for (Id e : changedEdges)
  {
    this->SetEdge(e, segments[e]);
  }
}

bool BoundarySpheres::IsOnTriangle(Id triangle, const Vec3& position) const
{
  const std::vector<Vec3>& points = this->Surface.Points;
  const TriangleIds& ids = this->Surface.Triangles[triangle];
  return InEquatorialSphere(points[ids[0]], points[ids[1]], points[ids[2]], position) >= 0;
}

bool BoundarySpheres::IsOnEdge(Id edge, const Vec3& position) const
{
  const EdgeIds& ends = this->Edges[edge].Points;
  return InDiametralSphere(
           this->Surface.Points[ends[0]], this->Surface.Points[ends[1]], position) >= 0;
}

void BoundarySpheres::Find(const Vec3& position, Encroached& encroached) const
{
  encroached.Clear();
  this->Balls.FindSettled(position, encroached.Near);
  for (Id id : encroached.Near)
  {
    if (id % 2 == 0 && this->IsOnTriangle(id / 2, position))
    {
      encroached.Triangles.push_back(id / 2);
    }
    else if (id % 2 != 0 && this->IsOnEdge(this->SegmentEdges[id / 2], position))
    {
      encroached.Edges.push_back(this->SegmentEdges[id / 2]);
    }
  }
  std::sort(encroached.Edges.begin(), encroached.Edges.end());
}

bool BoundarySpheres::IsOnOneOf(const Encroached& encroached, const Vec3& position) const
{
  return std::any_of(encroached.Triangles.begin(), encroached.Triangles.end(),
           [&](Id triangle) { return this->IsOnTriangle(triangle, position); }) ||
    std::any_of(encroached.Edges.begin(), encroached.Edges.end(),
      [&](Id edge) { return this->IsOnEdge(edge, position); });
}
} // namespace cdm
