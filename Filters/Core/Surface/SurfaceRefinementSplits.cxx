// SPDX-License-Identifier: BSD-3-Clause
// Splits of segments and triangles: which one is split for a bad triangle, and where.
#include "Core/Surface/SurfaceRefinement.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
/**
 * In curved facets, points closer to others than this are too close, in shortest edges of the input
 * triangle.
 */
constexpr double OverrefinementRatio = 1.0 / 8.0;
/**
 * If another point is closer to a match than this part of the encroaching point's distance, it is
 * match enough. The triangle is too large then: a match would encroach on what lies between.
 */
constexpr double MatchEnoughRatio = 0.1;
/**
 * The same without the rules for thin layers. Matches in facets of rounded points are not exact: what
 * is so close is the match of the same point, and smaller triangles leave that outside.
 */
constexpr double SameMatchRatio = 1e-3;
/** A segment passes a new point if it is closer above or below than this, in circumradii ... */
constexpr double PassingRadiusRatio = 0.5;
/** ... and in lengths of the segment, ... */
constexpr double PassingLengthRatio = 0.25;
/** ... and if the sine of its angle with the facet is no larger than this. */
constexpr double PassingSine = 0.5;
/** A point matches a corner of a triangle if it is no farther from it than this, in heights. */
constexpr double MatchRatio = 1.1;
/** Distances from a corner that are as equal as that count as equal. */
constexpr double EqualRadii = 1.01;

/**
 * Whether the corner of a triangle matches an encroaching point, and the triangle's other points are
 * equally far from there. A point at height h above the facet, and s along it from the corner, with s
 * far below h, is outside of the sphere of what is shorter than h^2/s.
 * @param first,second from the corner to the triangle's other points
 * @param encroaching from the corner to that point, at this height above the facet
 */
bool IsMatchedByCorner(
  const Vec3& first, const Vec3& second, const Vec3& encroaching, double height)
{
  const auto [shorter, longer] = std::minmax({ Norm(first), Norm(second) });
  // The squared distance is s^2 + h^2, and s has to be below MatchEnoughRatio h.
  return longer <= EqualRadii * shorter &&
    SquaredNorm(encroaching) < (1.0 + MatchEnoughRatio * MatchEnoughRatio) * height * height;
}
} // namespace

bool SurfaceRefinement::SplitSegment(Id segment, Id encroaching)
{
  const EdgeIds ends = this->Surface->GetSegment(segment).Points;
  const Vec3 a = this->Points[ends[0]];
  const Vec3 b = this->Points[ends[1]];
  const double length = Distance(a, b);
  Vec3 position = this->Partners->PlaceOnSegment(segment, encroaching);
  for (int attempt = 0; attempt < 2; ++attempt)
  {
    if (std::min(Distance(position, a), Distance(position, b)) >= this->MinimumEdge &&
      !this->HasPointNear(position, 0.0) && this->Surface->CanSplitSegment(segment, position))
    {
      const double weight = Distance(position, a) / length;
      const PointParents parents{ { ends[0], ends[1], NoId }, { 1.0 - weight, weight, 0.0 } };
      const Id point =
        this->AddPoint(position, parents, NoId, this->Surface->GetSegment(segment).InputEdge);
      ++this->NumberOfEdgePoints;
      std::vector<Id> uses;
      this->Surface->SplitSegment(segment, point, uses);
      this->NoteSegment(segment);
      this->NoteSegment(this->Surface->GetNumberOfSegments() - 1);
      if (this->AreEdgesTested())
      {
        this->EmptyEdges.Remove(segment);
        this->EnqueueEdge(segment);
        this->EnqueueEdge(this->Surface->GetNumberOfSegments() - 1);
      }
      this->Legalize(uses);
      return true;
    }
    position = 0.5 * (a + b);
  }
  return false;
}

/**
 * Finds the segment of a bad triangle on which any point encroaches most: facets get points where
 * their outline is fine enough.
 */
SurfaceRefinement::EncroachedEdge SurfaceRefinement::FindEncroachedEdge(Id t) const
{
  EncroachedEdge best;
  double bestDepth = Infinity;
  for (int i = 0; i < 3; ++i)
  {
    const Id segment = this->Surface->GetSegmentAt(t, i);
    if (segment == NoId)
    {
      continue;
    }
    const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
    const Id deepest = this->FindDeepestPoint(ends);
    if (deepest == NoId)
    {
      continue;
    }
    const Vec3& a = this->Points[ends[0]];
    const Vec3& b = this->Points[ends[1]];
    const double distance = Distance(this->Points[deepest], 0.5 * (a + b));
    const double depth = distance / Distance(a, b);
    if (depth < bestDepth)
    {
      best = { segment, deepest, distance };
      bestDepth = depth;
    }
  }
  return best;
}

/** Remembers the diametral sphere of a segment if new points in facets have to give way to it. */
void SurfaceRefinement::NoteSegment(Id segment)
{
  if (this->Plan.Rules == MatchingRules::Stacks)
  {
    const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
    const EnclosingBall ball(this->Points[ends[0]], this->Points[ends[1]]);
    this->SegmentBalls.Set(segment, ball.GetCenter(), ball.GetRadius());
  }
}

/**
 * Finds the segment on which a new point in a facet would encroach most, of those that pass close
 * above or below it, or none. What matches the points of that segment would come close to the new one.
 */
Id SurfaceRefinement::FindPassingSegment(Id t, const Vec3& position)
{
  if (this->Plan.Rules != MatchingRules::Stacks)
  {
    return NoId;
  }
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Vec3& corner = this->Points[ids[0]];
  Vec3 normal = Cross(this->Points[ids[1]] - corner, this->Points[ids[2]] - corner);
  normal = (1.0 / Norm(normal)) * normal;
  const double radius = Distance(this->FindCircumcenter(t), corner);
  this->SegmentBalls.Find(position, this->Reached);
  Id found = NoId;
  double nearest = Infinity;
  for (Id segment : this->Reached)
  {
    const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
    const Vec3& a = this->Points[ends[0]];
    const Vec3& b = this->Points[ends[1]];
    const double length = Distance(a, b);
    const Vec3 direction = (1.0 / length) * (b - a);
    const Vec3 arm = a + Dot(position - a, direction) * direction - position;
    const double height = std::abs(Dot(arm, normal));
    const double distance = Norm(arm) / length;
    if (distance < nearest && height <= PassingRadiusRatio * radius &&
      height <= PassingLengthRatio * length && std::abs(Dot(direction, normal)) <= PassingSine &&
      InDiametralSphere(a, b, position) >= 0)
    {
      nearest = distance;
      found = segment;
    }
  }
  return found;
}

/**
 * Whether a point in a triangle would make too short an edge. Points of other sheets may be closer: a
 * match is as close as the sheets are.
 */
bool SurfaceRefinement::IsTooClose(Id t, const Vec3& position) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  return this->HasPointNear(position, 0.0) ||
    std::any_of(ids.begin(), ids.end(),
      [&](Id id) { return Distance(this->Points[id], position) < this->MinimumEdge; });
}

bool SurfaceRefinement::ResolveInFacet(Id t, Id encroaching, const Vec3& target, bool isMirrored)
{
  const RefinableSurface& surface = *this->Surface;
  const TriangleIds start = surface.GetTriangle(t).Points;
  FacetWalk::Landing landing;
  if (!this->Walk->Run(t, isMirrored ? encroaching : NoId, target, landing))
  {
    return false;
  }
  if (landing.Segment != NoId)
  {
    const EdgeIds& ends = surface.GetSegment(landing.Segment).Points;
    const auto isEncroachedBy = [&](const Vec3& p)
    { return InDiametralSphere(this->Points[ends[0]], this->Points[ends[1]], p) >= 0; };
    // For a match, the segment's own ends do not count: a match that rounding puts beyond the segment
    // would halve it time and again towards one end.
    const auto isEncroachedByCorner = [&](Id p)
    { return !(isMirrored && Contains(ends, p)) && isEncroachedBy(this->Points[p]); };
    const bool isEncroached = encroaching != NoId && isEncroachedBy(this->Points[encroaching]);
    if (isMirrored && !isEncroached && this->IsMatchedByEnd(landing.Segment, encroaching, target))
    {
      return false;
    }
    const bool isTargetPartner =
      this->Plan.Rules != MatchingRules::Usual && isMirrored && isEncroachedBy(target);
    // On a curved facet the walk may lead to an edge that has nothing to do with the triangle.
    return (isEncroached || isEncroachedBy(target) ||
             std::any_of(start.begin(), start.end(), isEncroachedByCorner)) &&
      this->SplitSegment(landing.Segment, isEncroached || isTargetPartner ? encroaching : NoId);
  }

  // A point that does not encroach on the triangle would not remove it (on curved facets).
  const Vec3& position = landing.Position;
  if (this->IsTooClose(landing.Triangle, position) ||
    InEquatorialSphere(
      this->Points[start[0]], this->Points[start[1]], this->Points[start[2]], position) <= 0)
  {
    return false;
  }
  if (isMirrored)
  {
    const double ratio = AreForLayers(this->Plan.Rules) ? MatchEnoughRatio : SameMatchRatio;
    const double reach = ratio * Distance(position, this->Points[encroaching]);
    NearestPointVisitor visitor(position, encroaching, reach);
    this->Octree.Visit(visitor, visitor.GetReach());
    const IdLists::Range facets =
      visitor.Nearest != NoId ? this->Incidences->GetFacets(visitor.Nearest) : IdLists::Range();
    if (std::binary_search(facets.begin(), facets.end(), surface.GetTriangle(t).Facet))
    {
      return false;
    }
  }
  const Id current = landing.Triangle;
  if (landing.Edge != NoId && surface.GetSegmentAt(current, landing.Edge) != NoId)
  {
    return this->SplitSegment(surface.GetSegmentAt(current, landing.Edge), encroaching);
  }

  // A point that would encroach on an edge of the facet must not be made: split the edge instead.
  const Id encroached = this->Walk->FindEncroachedSegment(current, position);
  if (encroached != NoId)
  {
    if (isMirrored && this->IsMatchedByEnd(encroached, encroaching, position))
    {
      return false;
    }
    return this->SplitSegment(encroached, isMirrored ? encroaching : NoId);
  }
  const Id passing = isMirrored ? NoId : this->FindPassingSegment(t, position);
  if (passing != NoId && this->SplitSegment(passing, NoId))
  {
    return true;
  }

  const TriangleIds ids = surface.GetTriangle(current).Points;
  const Vec3 weights = GetBarycentricWeights(
    position, this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
  const PointParents parents{ ids, { weights.X, weights.Y, weights.Z } };
  const Id point = this->AddPoint(position, parents, surface.GetTriangle(current).Facet, NoId);
  std::vector<Id> uses;
  if (landing.Edge == NoId)
  {
    this->Surface->SplitTriangle(current, point, uses);
  }
  else
  {
    this->Surface->SplitSmoothEdge(3 * current + landing.Edge, point, uses);
  }
  this->Legalize(uses);
  return true;
}

bool SurfaceRefinement::SplitLongestEdge(Id t)
{
  const TriangleIds ids = this->Surface->GetTriangle(t).Points;
  int longest = 0;
  double length = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const double candidate = Distance(this->Points[ids[i]], this->Points[ids[(i + 1) % 3]]);
    if (candidate > length)
    {
      longest = i;
      length = candidate;
    }
  }
  const Id use = 3 * t + longest;
  const Id segment = this->Surface->GetSegmentAt(t, longest);
  if (segment != NoId)
  {
    return this->SplitSegment(segment, this->Surface->GetApex(use));
  }
  const EdgeIds ends{ ids[longest], ids[(longest + 1) % 3] };
  const Vec3 a = this->Points[ends[0]];
  const Vec3 edge = this->Points[ends[1]] - a;
  const double foot = Dot(this->Points[this->Surface->GetApex(use)] - a, edge) / SquaredNorm(edge);
  for (double weight : { std::min(std::max(foot, 0.25), 0.75), 0.5 })
  {
    const Vec3 position = a + weight * edge;
    if (0.25 * length >= this->MinimumEdge && !this->HasPointNear(position, 0.0) &&
      this->Surface->CanSplitSmoothEdge(use, position))
    {
      const PointParents parents{ { ends[0], ends[1], NoId }, { 1.0 - weight, weight, 0.0 } };
      const Id point = this->AddPoint(position, parents, this->Surface->GetTriangle(t).Facet, NoId);
      std::vector<Id> uses;
      this->Surface->SplitSmoothEdge(use, point, uses);
      this->Legalize(uses);
      return true;
    }
  }
  return false;
}

Vec3 SurfaceRefinement::FindCircumcenter(Id t) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  return GetCircumcenter(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
}

/** Segment: a structural edge to split first, or NoId. */
bool SurfaceRefinement::FindTooCoarse(Id t, Id& segment) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Id segments[3] = { this->Surface->GetSegmentAt(t, 0), this->Surface->GetSegmentAt(t, 1),
    this->Surface->GetSegmentAt(t, 2) };
  Id edge;
  const bool isTooCoarse =
    this->Limits.IsTooCoarse({ this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]] },
      { segments[0] != NoId, segments[1] != NoId, segments[2] != NoId },
      this->ExcusedTriangles.empty() ||
        this->ExcusedTriangles[this->Surface->GetTriangle(t).Source] == 0,
      edge);
  segment = edge != NoId ? segments[edge] : NoId;
  return isTooCoarse;
}

/**
 * Notes where points come too close to each other in a curved facet. There a point that mends one
 * triangle may encroach on its neighbors, which are bent against it, and so on with ever smaller
 * triangles. Points much closer to each other than those of the input are a sign of that.
 */
void SurfaceRefinement::NoteOverrefinement(Id t, Id newPoint)
{
  const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
  if (this->ShortestEdges.empty() || newPoint >= static_cast<Id>(this->Points.size()) ||
    !this->Incidences->IsCurved(triangle.Facet) || !this->Incidences->GetEdges(newPoint).empty())
  {
    return;
  }
  const double reach = OverrefinementRatio * this->ShortestEdges[triangle.Source];
  if (this->HasPointNear(this->Points[newPoint], reach, newPoint))
  {
    this->IsOverrefined.resize(this->ShortestEdges.size(), 0);
    this->IsOverrefined[triangle.Source] = 1;
  }
}

/**
 * Whether an end of a segment matches the encroaching point as well as the position does. The usual
 * rules do not ask for it.
 */
bool SurfaceRefinement::IsMatchedByEnd(Id segment, Id encroaching, const Vec3& position) const
{
  const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
  const double nearest =
    std::min(Distance(position, this->Points[ends[0]]), Distance(position, this->Points[ends[1]]));
  return this->Plan.Rules != MatchingRules::Usual &&
    nearest < MatchEnoughRatio * Distance(position, this->Points[encroaching]);
}

/**
 * Whether a triangle with a corner of the input is too long, as seen from there. The corner matches
 * a point that is in the triangle's sphere all the same. Or a point that matches another corner is,
 * as the match is not exact in the direction of this one.
 */
bool SurfaceRefinement::IsTooLong(Id t, int corner, Id encroaching) const
{
  if (this->Plan.Rules != MatchingRules::Stacks || encroaching == NoId)
  {
    return false;
  }
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Vec3& q = this->Points[encroaching];
  const Vec3 first = this->Points[ids[(corner + 1) % 3]] - this->Points[ids[corner]];
  const Vec3 second = this->Points[ids[(corner + 2) % 3]] - this->Points[ids[corner]];
  const Vec3 normal = Cross(first, second);
  const Vec3 fromCorner = q - this->Points[ids[corner]];
  const double height = std::abs(Dot(fromCorner, normal)) / Norm(normal);
  if (IsMatchedByCorner(first, second, fromCorner, height))
  {
    return true;
  }
  Vec3 outward = (1.0 / Norm(first)) * first + (1.0 / Norm(second)) * second;
  outward = (1.0 / Norm(outward)) * outward;
  const Vec3 center = this->FindCircumcenter(t);
  const double distance = Norm(fromCorner);
  for (const Id point : { ids[(corner + 1) % 3], ids[(corner + 2) % 3] })
  {
    // How much nearer the match is to the circumcenter than the point: away from the corner, or by the
    // distance from it, and otherwise.
    const double radius = Distance(this->Points[point], this->Points[ids[corner]]);
    const Vec3 offset = q - this->Points[point];
    const Vec3 arm = center - this->Points[point];
    const double along = this->Plan.CutsArcs ? 0.5 * radius * (radius - distance)
                                             : Dot(offset, outward) * Dot(arm, outward);
    const double across = Dot(offset, arm) - along;
    if (Norm(offset) < MatchRatio * height && along > 0.0 && along > across)
    {
      return true;
    }
  }
  return false;
}

/**
 * Finds a point on a shell around a corner of the input, to be used instead of the circumcenter of
 * a triangle at that corner. Only with the rules for thin layers. The triangle's other two points
 * have to be about as far from the corner as the nearest points on its edges: then the point midway
 * between them at that distance is taken. If one is farther away, the point at that distance on the
 * way to it is taken. Nearer points would ask for nearer ones in all sheets that meet in the
 * corner, and are made only for a triangle that is too long.
 */
bool SurfaceRefinement::FindShellPoint(Id t, Id encroaching, Vec3& target) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  for (int i = 0; i < 3 && AreForLayers(this->Plan.Rules); ++i)
  {
    const Id v = ids[i];
    if (v >= this->NumberOfSurfacePoints || this->Incidences->GetEdges(v).size() < 2)
    {
      continue;
    }
    const Vec3& corner = this->Points[v];
    Vec3 near = this->Points[ids[(i + 1) % 3]] - corner;
    Vec3 far = this->Points[ids[(i + 2) % 3]] - corner;
    if (SquaredNorm(near) > SquaredNorm(far))
    {
      std::swap(near, far);
    }
    const double radius = Norm(near);
    if (radius <= EqualRadii * this->Incidences->GetInnerRadius(v))
    {
      const double farther = Norm(far);
      const bool isTooLong = this->IsTooLong(t, i, encroaching);
      const Vec3 direction =
        farther > EqualRadii * radius && !isTooLong ? far : near + (radius / farther) * far;
      target = corner + ((isTooLong ? 0.5 : 1.0) * radius / Norm(direction)) * direction;
      return true;
    }
  }
  return false;
}
} // namespace cdm
