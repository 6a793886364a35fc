// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/FacetWalk.h"

#include "Core/Geometry/MatchingPoints.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/PointSearches.h"

#include <algorithm>
#include <utility>

namespace cdm
{
namespace
{
/** Largest number of triangles on a walk. */
constexpr int LongestWalk = 10000;
/** Largest number of triangles whose edges are searched for one that a new point encroaches on. */
constexpr std::size_t LargestCavity = 1000;
} // namespace

/** Moves a position along a normal into the plane of a triangle. */
Vec3 FacetWalk::PutIntoPlane(Id t, const Vec3& position, const Vec3& normal) const
{
  const TriangleIds& ids = this->Surface.GetTriangle(t).Points;
  const Vec3& p = this->Points[ids[0]];
  const Vec3 n = Cross(this->Points[ids[1]] - p, this->Points[ids[2]] - p);
  const double slope = Dot(n, normal);
  Vec3 result = slope != 0.0 ? position + (Dot(n, p - position) / slope) * normal : position;
  // A plane across an axis is met exactly, and so are the coordinates of a matching point.
  for (int axis = 0; axis < 3; ++axis)
  {
    const double coordinate = p[axis];
    if (this->Points[ids[1]][axis] == coordinate && this->Points[ids[2]][axis] == coordinate)
    {
      result[axis] = coordinate;
    }
  }
  return result;
}

bool FacetWalk::Run(Id t, Id mirrored, const Vec3& target, Landing& landing) const
{
  const RefinableSurface& surface = this->Surface;
  const TriangleIds& start = surface.GetTriangle(t).Points;
  const Vec3& a = this->Points[start[0]];
  const Vec3& b = this->Points[start[1]];
  const Vec3& c = this->Points[start[2]];
  const Vec3 normal = Cross(b - a, c - a);
  const double radius = Norm(GetCircumcenterOffset(a, b, c));
  Id current = t;
  Id previous = NoId;
  // Rounding may send a walk around a corner for ever. Each step follows from these two triangles:
  // the walk goes around where they are those of the last power of two (Brent's method).
  std::pair<Id, Id> mark(NoId, NoId);
  for (int step = 0; step <= LongestWalk; ++step)
  {
    if (mark == std::make_pair(current, previous))
    {
      return false;
    }
    if ((step & (step - 1)) == 0)
    {
      mark = { current, previous };
    }
    const TriangleIds& ids = surface.GetTriangle(current).Points;
    Id worst = NoId;
    double worstSide = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const Vec3& p = this->Points[ids[i]];
      const Vec3 edge = this->Points[ids[(i + 1) % 3]] - p;
      const double side = Dot(normal, Cross(edge, target - p)) / Norm(edge);
      const Id adjacent = surface.GetTriangle(current).Adjacent[i];
      if (side < worstSide && !(adjacent >= 0 && adjacent / 3 == previous))
      {
        worst = i;
        worstSide = side;
      }
    }
    if (worst == NoId)
    {
      Vec3 position = this->PutIntoPlane(current, target, normal);
      if (mirrored != NoId)
      {
        position = SnapToCoordinates(position, this->Points[mirrored], this->Diagonal);
        position = this->Partners.MatchAcross(current, mirrored, position, radius);
      }
      else
      {
        // The point may have been made already, for the other side of a layer.
        NearestPointVisitor visitor(
          position, NoId, std::max(2.0 * Distance(position, this->Points[ids[0]]), SamePoint));
        this->Octree.Visit(visitor, visitor.GetReach());
        position = SnapToCoordinates(position, this->Points[visitor.Nearest], this->Diagonal);
      }
      const auto [edge, isInside] = surface.Locate(current, position);
      const Id beyond = isInside ? NoId : surface.GetTriangle(current).Adjacent[edge];
      // Rounded into the plane of either triangle it may lie in the other one: on the edge between.
      if (isInside ||
        (beyond >= 0 && beyond / 3 == previous &&
          surface.CanSplitSmoothEdge(3 * current + edge, position)))
      {
        landing = { current, edge, position, NoId };
        return true;
      }
      worst = edge;
    }
    const Id adjacent = surface.GetTriangle(current).Adjacent[worst];
    if (adjacent < 0)
    {
      landing.Segment = -1 - adjacent;
      return true;
    }
    previous = current;
    current = adjacent / 3;
  }
  return false;
}

Id FacetWalk::FindEncroachedSegment(Id t, const Vec3& position)
{
  const RefinableSurface& surface = this->Surface;
  this->IsInCavity.resize(surface.GetNumberOfTriangles(), 0);
  std::vector<Id> cavity(1, t);
  this->IsInCavity[t] = 1;
  Id found = NoId;
  for (std::size_t i = 0; i < cavity.size() && found == NoId && cavity.size() < LargestCavity; ++i)
  {
    for (Id adjacent : surface.GetTriangle(cavity[i]).Adjacent)
    {
      if (adjacent < 0)
      {
        const EdgeIds& ends = surface.GetSegment(-1 - adjacent).Points;
        if (InDiametralSphere(this->Points[ends[0]], this->Points[ends[1]], position) >= 0)
        {
          found = -1 - adjacent;
          break;
        }
        continue;
      }
      const TriangleIds& ids = surface.GetTriangle(adjacent / 3).Points;
      if (!this->IsInCavity[adjacent / 3] &&
        InEquatorialSphere(
          this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], position) >= 0)
      {
        this->IsInCavity[adjacent / 3] = 1;
        cavity.push_back(adjacent / 3);
      }
    }
  }
  for (Id triangle : cavity)
  {
    this->IsInCavity[triangle] = 0;
  }
  return found;
}
} // namespace cdm
