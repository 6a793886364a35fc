// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundarySpheres.h"

#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"

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
  const Id count = static_cast<Id>(surface.Triangles.size());
  for (Id t = 0; t < count; ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    const Vec3& a = surface.Points[ids[0]];
    const Vec3 offset = GetCircumcenterOffset(a, surface.Points[ids[1]], surface.Points[ids[2]]);
    this->Balls.Set(t, a + offset, Margin * Norm(offset));
  }
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const Vec3& a = surface.Points[edges[e].Points[0]];
    const Vec3& b = surface.Points[edges[e].Points[1]];
    this->Balls.Set(count + static_cast<Id>(e), 0.5 * (a + b), 0.5 * Margin * Distance(a, b));
  }
}

void BoundarySpheres::Find(const Vec3& position, Encroached& encroached)
{
  encroached.Triangles.clear();
  encroached.Edges.clear();
  this->Balls.Find(position, this->Near);
  const Id count = static_cast<Id>(this->Surface.Triangles.size());
  const std::vector<Vec3>& points = this->Surface.Points;
  for (Id id : this->Near)
  {
    if (id >= count)
    {
      const EdgeIds& ends = this->Edges[id - count].Points;
      if (InDiametralSphere(points[ends[0]], points[ends[1]], position) >= 0)
      {
        encroached.Edges.push_back(id - count);
      }
      continue;
    }
    const TriangleIds& ids = this->Surface.Triangles[id];
    if (InEquatorialSphere(points[ids[0]], points[ids[1]], points[ids[2]], position) >= 0)
    {
      encroached.Triangles.push_back(id);
    }
  }
}
} // namespace cdm
