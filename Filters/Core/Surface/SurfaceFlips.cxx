// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceFlips.h"

#include "Core/Geometry/Predicates.h"
#include "Core/Surface/StructuralEdges.h"

#include <cmath>

namespace cdm
{
namespace
{
constexpr std::int64_t FlipsPerTriangle = 50;
/** However few triangles there are. */
constexpr std::int64_t FewestFlips = 100000;
} // namespace

SurfaceFlips::SurfaceFlips(
  RefinableSurface& surface, const std::vector<Vec3>& points, double flatness, double accuracyAngle)
  : Surface(surface), Points(points), Flatness(flatness), AccuracyAngle(accuracyAngle),
    Budget(FewestFlips + FlipsPerTriangle * surface.GetNumberOfTriangles())
{
}

bool SurfaceFlips::CanFlip(Id use) const
{
  const Id other = this->Surface.GetTriangle(use / 3).Adjacent[use % 3];
  if (other < 0 || this->Budget <= 0 || !this->Surface.IsConvex(use))
  {
    return false;
  }
  const TriangleIds& ids = this->Surface.GetTriangle(use / 3).Points;
  const Vec3& a = this->Points[ids[use % 3]];
  const Vec3& b = this->Points[ids[(use % 3 + 1) % 3]];
  const Vec3& c = this->Points[this->Surface.GetApex(use)];
  const Vec3& d = this->Points[this->Surface.GetApex(other)];
  // The surface moves by at most the distance of the two diagonals.
  const Vec3 across = Cross(b - a, d - c);
  const double norm = Norm(across);
  if (norm > 0.0 && std::abs(Dot(across, c - a)) <= this->Flatness * norm)
  {
    return true;
  }
  const double angle = this->AccuracyAngle;
  return angle > 0.0 && IsSmoothEdge(a, b, c, d, angle, 0.0) &&
    IsSmoothEdge(d, c, a, b, angle, 0.0);
}

bool SurfaceFlips::ShouldFlip(Id use) const
{
  const Id other = this->Surface.GetTriangle(use / 3).Adjacent[use % 3];
  if (other < 0)
  {
    return false;
  }
  const TriangleIds& ids = this->Surface.GetTriangle(use / 3).Points;
  const Vec3& a = this->Points[ids[use % 3]];
  const Vec3& b = this->Points[ids[(use % 3 + 1) % 3]];
  const Vec3& c = this->Points[this->Surface.GetApex(use)];
  const Vec3& d = this->Points[this->Surface.GetApex(other)];
  const bool isBad = InEquatorialSphere(a, b, c, d) > 0 || InEquatorialSphere(b, a, d, c) > 0;
  return isBad && this->CanFlip(use) && InEquatorialSphere(a, d, c, b) <= 0 &&
    InEquatorialSphere(d, b, c, a) <= 0;
}

void SurfaceFlips::Flip(Id use)
{
  this->Surface.Flip(use);
  ++this->NumberOfFlips;
  --this->Budget;
}

void SurfaceFlips::AddPoint()
{
  this->Budget += FlipsPerTriangle;
}
} // namespace cdm
