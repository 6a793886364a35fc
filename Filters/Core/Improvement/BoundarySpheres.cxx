// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundarySpheres.h"

#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>

namespace cdm
{
namespace
{
/**
 * Balls are enlarged by this, as their centers and radii are rounded: the exact test has to see all
 * candidates.
 */
constexpr double Margin = 1.0 + 1e-6;
} // namespace

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
  const Vec3& a = this->Surface.Points[ids[0]];
  const Vec3 offset =
    GetCircumcenterOffset(a, this->Surface.Points[ids[1]], this->Surface.Points[ids[2]]);
  this->Balls.Set(2 * triangle, a + offset, Margin * Norm(offset));
}

void BoundarySpheres::SetEdge(Id edge, Id segment)
{
  const Vec3& a = this->Surface.Points[this->Edges[edge].Points[0]];
  const Vec3& b = this->Surface.Points[this->Edges[edge].Points[1]];
  this->Balls.Set(2 * segment + 1, 0.5 * (a + b), 0.5 * Margin * Distance(a, b));
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

void BoundarySpheres::Find(const Vec3& position, Encroached& encroached) const
{
  encroached.Triangles.clear();
  encroached.Edges.clear();
  this->Balls.FindSettled(position, encroached.Near);
  const std::vector<Vec3>& points = this->Surface.Points;
  for (Id id : encroached.Near)
  {
    if (id % 2 != 0)
    {
      const Id edge = this->SegmentEdges[id / 2];
      const EdgeIds& ends = this->Edges[edge].Points;
      if (InDiametralSphere(points[ends[0]], points[ends[1]], position) >= 0)
      {
        encroached.Edges.push_back(edge);
      }
      continue;
    }
    const TriangleIds& ids = this->Surface.Triangles[id / 2];
    if (InEquatorialSphere(points[ids[0]], points[ids[1]], points[ids[2]], position) >= 0)
    {
      encroached.Triangles.push_back(id / 2);
    }
  }
  std::sort(encroached.Edges.begin(), encroached.Edges.end());
}
} // namespace cdm
