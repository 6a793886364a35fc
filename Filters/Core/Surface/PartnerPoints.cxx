// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/PartnerPoints.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/MatchingPoints.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/PointSearches.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cdm
{
namespace
{
/** New points keep this distance, as a ratio of the edge, from the ends of an edge they split. */
constexpr double SmallestPiece = 0.05;
/**
 * An encroaching point this close to the plane of a triangle, in units of its circumradius, is
 * mirrored into the plane: thin layers get matching points instead of small triangles.
 */
constexpr double ThinLayerRatio = 0.75;
/** An encroaching point this close to an edge, in units of its length, is matched exactly. */
constexpr double ThinGapRatio = 0.1;
/** An encroaching point closer than this, in the same unit, needs no match near an end ... */
constexpr double NeedleGapRatio = 1e-3;
/** ... if the match would be closer to the end than this part of the point's distance. */
constexpr double CloseEndRatio = 0.25;
/**
 * A match closer to an end than this part of the point's distance is the end, but for rounding: of
 * single precision, as STL files have it. Two points 1e-8 apart were made for a point above a corner.
 */
constexpr double RoundedEndRatio = 1e-5;
/**
 * Another point on an edge is matched instead if it is closer to the match than this part of the
 * encroaching point's distance.
 */
constexpr double CloseMatchRatio = 0.5;
/**
 * Lines and planes with a cosine up to this are perpendicular: no point has a partner there.
 * Otherwise rounding would make a few partners in rotated devices, and a quarter more points.
 */
constexpr double PerpendicularCosine = 1e-9;
/** Facets at 60 degrees or less are mirrored onto each other at the plane between them. */
constexpr double MirrorCosine = 0.5;
/** If a match had to be more exact than this, in units in the last place, none is searched. */
constexpr double HopelessMatch = 0.02;

// The ratios that follow belong to the rules for thin layers.
/** Edges pass each other if the square of the sine between them is not below this, ... */
constexpr double PassingSquaredSine = 0.01;
/** ... and are closer to each other than this part of what the split leaves on either side, ... */
constexpr double PassingGapRatio = 0.1;
/** ... and than this part of the encroaching point's way along its edge from there. */
constexpr double PassingWayRatio = 0.5;
/** Used instead of NeedleGapRatio and CloseEndRatio. */
constexpr double LayerGapRatio = 0.1;
constexpr double LayerEndRatio = 0.1;
/** In stacks, how far a match leans toward steeper facets, as a part of what others bear. */
constexpr double LeanRatio = 0.25;
} // namespace

/**
 * The partner of a point on another edge: the point of this edge's line that is as far from the
 * common perpendicular of the two lines. That is type R about the common corner if the edges meet,
 * and type P if they are parallel. Being partners is mutual. So two edges never climb up a ladder
 * between them, and a point is outside of the diametral spheres of all pieces that end at its
 * partner. passing: where the edges pass each other, or -1.
 */
bool PartnerPoints::PlaceOnLine(
  Id segment, Id encroaching, double& way, Vec3& along, double& passing) const
{
  passing = -1.0;
  const EdgeIds& ends = this->Surface.GetSegment(segment).Points;
  const Vec3& a = this->Points[ends[0]];
  const Vec3& p = this->Points[encroaching];
  const Vec3 edge = this->Points[ends[1]] - a;
  const Vec3 direction = (1.0 / Norm(edge)) * edge;
  const std::vector<EdgeIds>& edges = this->Surface.GetInputEdges();
  const Id own = this->Surface.GetSegment(segment).InputEdge;
  // Of several edges at the point the one along this edge matters.
  double best = PerpendicularCosine;
  for (Id other : this->Incidences.GetEdges(encroaching))
  {
    if (other == own)
    {
      continue;
    }
    const Vec3& begin = this->Points[edges[other][0]];
    Vec3 line = this->Points[edges[other][1]] - begin;
    line = (1.0 / Norm(line)) * line;
    double cosine = Dot(line, direction);
    if (cosine < 0.0)
    {
      line = -1.0 * line;
      cosine = -cosine;
    }
    if (cosine <= best)
    {
      continue;
    }
    best = cosine;
    const Vec3 across = Cross(direction, line);
    const double squaredSine = SquaredNorm(across);
    const double foot = Dot(p - a, direction);
    // Distance of p from the common perpendicular along its line, times 1 - cosine: a shift of the
    // foot that stays small and accurate where the lines are almost parallel.
    const double distance =
      squaredSine > 0.0 ? Dot(Cross(p - a, direction), across) / squaredSine : 0.0;
    const double shift = squaredSine > 1e-24 ? -distance * squaredSine / (1.0 + cosine) : 0.0;
    way = foot + shift;
    along = 0.5 * (direction + line);
    passing = -1.0;
    // Edges with a common corner do not pass each other there, as rounding may have it.
    if (AreForLayers(this->Rules) && squaredSine > PassingSquaredSine &&
      !Contains(edges[own], edges[other][0]) && !Contains(edges[own], edges[other][1]))
    {
      // Feet of the common perpendicular, here and on the other edge.
      const double foothold = way + distance;
      const Vec3 here = a + foothold * direction;
      const Vec3 there = p + distance * line;
      const double gap = Distance(here, there);
      const double rest = std::min(foothold, Norm(edge) - foothold);
      const bool isOnEdge = Dot(there - begin, there - this->Points[edges[other][1]]) < 0.0;
      passing =
        isOnEdge && gap < PassingGapRatio * rest && gap < PassingWayRatio * std::abs(distance)
        ? foothold
        : -1.0;
    }
  }
  return best > PerpendicularCosine;
}

/**
 * The partner on an edge of a point in a facet with which the edge shares a corner: the point as
 * far from the corner. The foot of the perpendicular would be nearer to the corner, the point
 * matching the foot nearer still, and so on around the corner.
 */
bool PartnerPoints::RotateToSegment(Id segment, Id encroaching, double& way) const
{
  const RefinableSurface::Segment& piece = this->Surface.GetSegment(segment);
  if (this->Rules == MatchingRules::Usual || !this->Incidences.GetEdges(encroaching).empty())
  {
    return false;
  }
  const Vec3& a = this->Points[piece.Points[0]];
  const Vec3& b = this->Points[piece.Points[1]];
  const Vec3& p = this->Points[encroaching];
  double nearest = Infinity;
  for (Id corner : this->Surface.GetInputEdges()[piece.InputEdge])
  {
    const double distance = Distance(p, this->Points[corner]);
    for (Id facet : this->Incidences.GetFacets(encroaching))
    {
      const IdLists::Range corners = this->Incidences.GetCorners(facet);
      if (distance < nearest && std::binary_search(corners.begin(), corners.end(), corner))
      {
        nearest = distance;
        const Vec3& c = this->Points[corner];
        way =
          Distance(a, c) < Distance(b, c) ? distance - Distance(a, c) : Distance(a, c) - distance;
      }
    }
  }
  if (nearest < Infinity)
  {
    return true;
  }
  const Vec3 direction = (1.0 / Distance(a, b)) * (b - a);
  const Vec3 normal = this->GetNormalAt(encroaching);
  const double sine = Dot(normal, direction);
  const double cosine = std::sqrt(std::max(0.0, 1.0 - sine * sine));
  if (normal == Vec3() || cosine < MirrorCosine)
  {
    return false;
  }
  const Vec3 across = (1.0 / cosine) * (normal - sine * direction);
  way = Dot(p - a, direction) - Dot(p - a, across) * sine / (1.0 + cosine);
  return true;
}

/** The normal of the plane facet within which a point lies; zero for a point of an edge. */
Vec3 PartnerPoints::GetNormalAt(Id point) const
{
  const IdLists::Range facets = this->Incidences.GetFacets(point);
  return this->Incidences.GetEdges(point).empty() && facets.size() == 1
    ? this->Incidences.GetNormal(*facets.begin())
    : Vec3();
}

Vec3 PartnerPoints::PlaceOnSegment(Id segment, Id encroaching) const
{
  const EdgeIds& ends = this->Surface.GetSegment(segment).Points;
  const Vec3& a = this->Points[ends[0]];
  const Vec3& b = this->Points[ends[1]];
  const double length = Distance(a, b);
  const Vec3 direction = (1.0 / length) * (b - a);
  const bool isLayered = AreForLayers(this->Rules);
  const double needleGap = isLayered ? LayerGapRatio : NeedleGapRatio;
  const double closeEnd = isLayered ? LayerEndRatio : CloseEndRatio;
  for (int attempt = 0; encroaching != NoId; ++attempt)
  {
    const Vec3& p = this->Points[encroaching];
    const double foot = Dot(p - a, direction);
    const double height = Distance(p, a + foot * direction);
    const bool isThin = height < ThinGapRatio * length;
    double way = foot;
    Vec3 along = direction;
    double passing;
    const bool isPartner = this->PlaceOnLine(segment, encroaching, way, along, passing) ||
      this->RotateToSegment(segment, encroaching, way);
    if (passing > 0.0)
    {
      return a + passing * direction;
    }
    // If the partner would be close to an end of the piece, the end itself is good enough. The
    // piece only has to be short: p stays outside of the spheres of pieces shorter than its squared
    // height over its distance along the edge.
    const double rest = std::abs(std::min(way, length - way));
    const bool isOnSphere =
      std::abs(Dot(a - p, b - p)) <= PerpendicularCosine * Distance(a, p) * Distance(b, p);
    const bool isClose = rest < RoundedEndRatio * height ||
      ((isOnSphere || height < needleGap * length) && rest < closeEnd * height);
    if (isClose)
    {
      // A point on the sphere, up to rounding, is outside of the spheres of all shorter pieces.
      const double longest = isOnSphere ? height
        : rest > 0.0                    ? 0.5 * height * (height / rest)
                                        : Infinity;
      // The piece at the other end is no shorter either. It may end at a corner, where edges would be
      // split ever closer to it, by the same factor each time.
      const double shorter = std::min(0.5 * length, std::max(height, longest));
      way = way < 0.5 * length ? shorter : length - shorter;
    }
    const double margin = isThin ? 0.0
      : isPartner                ? SmallestPiece * length
                                 : std::min(height, 0.5 * length);
    if (way > margin && way < length - margin)
    {
      const Vec3 position = a + way * direction;
      if (isClose)
      {
        return position;
      }
      // Another point that is much nearer to the position is matched exactly instead.
      NearestPointVisitor visitor(position, NoId, CloseMatchRatio * height);
      this->Octree.Visit(visitor, visitor.GetReach());
      if (attempt == 0 && visitor.Nearest != NoId && visitor.Nearest != encroaching &&
        visitor.Nearest != ends[0] && visitor.Nearest != ends[1] &&
        !this->Incidences.GetEdges(visitor.Nearest).empty())
      {
        encroaching = visitor.Nearest;
        continue;
      }
      return MatchExactly(SnapToCoordinates(position, p, this->Diagonal), p, length, 10,
        [&along](long double x, long double y, long double z)
        { return std::abs(x * along.X + y * along.Y + z * along.Z); });
    }
    if (!isPartner && foot > 0.0 && foot < length)
    {
      // Type P, no nearer to the ends than the encroaching point is to the edge.
      return a + std::min(std::max(foot, margin), length - margin) * direction;
    }
    break;
  }
  // From an acute corner only powers of two are used, so that all edges there end up alike.
  const bool isAcuteA = this->Incidences.IsAcuteCorner(ends[0]);
  const bool isAcuteB = this->Incidences.IsAcuteCorner(ends[1]);
  if (isAcuteA != isAcuteB)
  {
    // First as far as other edges at the corner have been split already.
    const double inner = this->Incidences.GetInnerRadius(isAcuteA ? ends[0] : ends[1]);
    const bool isInside = inner > SmallestPiece * length && inner < (1.0 - SmallestPiece) * length;
    const double way = isInside && this->Rules != MatchingRules::Usual
      ? inner
      : std::ldexp(1.0, std::ilogb(length * (2.0 / 3.0)));
    return isAcuteA ? a + way * direction : b - way * direction;
  }
  return 0.5 * (a + b);
}

/**
 * Type R for facets, about the nearest edge that they share. The lines of other edges may be nearer,
 * but triangles at such a line would not be near the point.
 */
bool PartnerPoints::RotateAboutEdge(Id t, Id encroaching, Vec3& target) const
{
  const RefinableSurface::Triangle& triangle = this->Surface.GetTriangle(t);
  const Vec3& p = this->Points[encroaching];
  const Vec3 center = GetCircumcenter(this->Points[triangle.Points[0]],
    this->Points[triangle.Points[1]], this->Points[triangle.Points[2]]);
  double nearest = Infinity;
  for (Id facet : this->Incidences.GetFacets(encroaching))
  {
    this->Incidences.ForEachSharedEdge(facet, triangle.Facet,
      [&](Id edge)
      {
        const EdgeIds& axis = this->Surface.GetInputEdges()[edge];
        const Vec3& begin = this->Points[axis[0]];
        const double length = Distance(begin, this->Points[axis[1]]);
        const Vec3 direction = (1.0 / length) * (this->Points[axis[1]] - begin);
        const double way = Dot(p - begin, direction);
        const Vec3 foot = begin + way * direction;
        const Vec3 inward = center - (begin + Dot(center - begin, direction) * direction);
        const double distance = Distance(p, foot);
        const double beyond = std::max({ 0.0, -way, way - length });
        const double fromEdge = std::hypot(distance, beyond);
        if (fromEdge < nearest && distance > 0.0 &&
          Dot(inward, p - foot) > PerpendicularCosine * distance * Norm(inward))
        {
          nearest = fromEdge;
          target = foot + (distance / Norm(inward)) * inward;
        }
      });
  }
  return nearest < Infinity;
}

bool PartnerPoints::RotateAboutCorner(Id t, Id encroaching, Vec3& target) const
{
  const RefinableSurface::Triangle& triangle = this->Surface.GetTriangle(t);
  const IdLists::Range corners = this->Incidences.GetCorners(triangle.Facet);
  const Vec3& p = this->Points[encroaching];
  double nearest = Infinity;
  Id corner = NoId;
  for (Id facet : this->Incidences.GetFacets(encroaching))
  {
    const IdLists::Range others = this->Incidences.GetCorners(facet);
    const bool isSmaller = others.size() < corners.size();
    for (Id candidate : isSmaller ? others : corners)
    {
      const double distance = Distance(p, this->Points[candidate]);
      if (candidate != encroaching && distance < nearest &&
        std::binary_search(
          (isSmaller ? corners : others).begin(), (isSmaller ? corners : others).end(), candidate))
      {
        nearest = distance;
        corner = candidate;
      }
    }
  }
  if (corner == NoId)
  {
    return false;
  }
  const Vec3& a = this->Points[triangle.Points[0]];
  const Vec3& b = this->Points[triangle.Points[1]];
  const Vec3& c = this->Points[triangle.Points[2]];
  Vec3 normal = Cross(b - a, c - a);
  normal = (1.0 / Norm(normal)) * normal;
  const Vec3 arm = p - this->Points[corner];
  const Vec3 inPlane = arm - Dot(arm, normal) * normal;
  // A point within another plane facet is mirrored at the plane midway between the two, which leads
  // back to it; that of an edge has no other facet in which it would have to be met again.
  const Vec3 own = this->GetNormalAt(encroaching);
  const double cosine = Dot(own, normal);
  if (std::abs(cosine) < MirrorCosine)
  {
    target = this->Points[corner] + (nearest / Norm(inPlane)) * inPlane;
  }
  else
  {
    const Vec3 across = cosine < 0.0 ? normal - own : normal + own;
    target = p - (Dot(arm, normal) / (1.0 + std::abs(cosine))) * across;
  }
  // If the facets are steep, or the rotated point is far beyond the triangle, it would not help.
  return SquaredNorm(inPlane) > 0.25 * SquaredNorm(arm) && InEquatorialSphere(a, b, c, target) > 0;
}

/**
 * Type P for facets: along the normal. If the point's own facet is not parallel, the foot is moved
 * until both are equally far from the line where the two planes meet, somewhere outside: that is
 * type R again, and mutual.
 */
bool PartnerPoints::Project(Id t, Id encroaching, Vec3& target) const
{
  const TriangleIds& ids = this->Surface.GetTriangle(t).Points;
  const Vec3& a = this->Points[ids[0]];
  const Vec3 normal = Cross(this->Points[ids[1]] - a, this->Points[ids[2]] - a);
  const double radius = Distance(a, GetCircumcenter(a, this->Points[ids[1]], this->Points[ids[2]]));
  const Vec3& p = this->Points[encroaching];
  Vec3 unit = (1.0 / Norm(normal)) * normal;
  unit = Dot(unit, p - a) < 0.0 ? -1.0 * unit : unit;
  const double height = Dot(unit, p - a);
  if (height > ThinLayerRatio * radius)
  {
    return false;
  }
  target = p - height * unit;
  double best = 0.0;
  Vec3 other;
  for (Id facet : this->Incidences.GetFacets(encroaching))
  {
    const Vec3& candidate = this->Incidences.GetNormal(facet);
    const double cosine = Dot(candidate, unit);
    if (std::abs(cosine) > best)
    {
      best = std::abs(cosine);
      other = cosine < 0.0 ? -1.0 * candidate : candidate;
    }
  }
  if (best > 0.5)
  {
    // tan(angle / 2) = sin / (1 + cos); the sine is the length of the tilt.
    const Vec3 tilt = other - best * unit;
    target = target - (height / (1.0 + best)) * tilt;
  }
  return true;
}

/**
 * Mirrors a point at the plane midway between its own plane and that of the triangle. It leaves all
 * triangles alone whose circumcenters are on its side of the line where the planes meet. A point of
 * an edge has several planes. That closest to parallel counts: for another one with the angle b and
 * the height h of the point the match is off by no more than h b, which matters for triangles
 * larger than the distance h / b from where the planes meet. But planes of narrow facets are
 * steeper: a match that is exact for the others is on the spheres of their triangles. So it leans
 * toward them, by a part of the angle h / (2 R) that triangles of this one's radius R bear.
 */
bool PartnerPoints::MirrorInStack(Id t, Id encroaching, Vec3& target) const
{
  const TriangleIds& ids = this->Surface.GetTriangle(t).Points;
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  const Vec3& c = this->Points[ids[2]];
  const Vec3& p = this->Points[encroaching];
  Vec3 normal = Cross(b - a, c - a);
  normal = (1.0 / Norm(normal)) * normal;
  const double height = Dot(p - a, normal);
  const double largestLean = LeanRatio * std::abs(height) / Norm(GetCircumcenterOffset(a, b, c));

  std::vector<Vec3> others;
  std::size_t closest = 0;
  for (Id facet : this->Incidences.GetFacets(encroaching))
  {
    const Vec3& own = this->Incidences.GetNormal(facet);
    if (std::abs(Dot(own, normal)) > MirrorCosine)
    {
      others.push_back(Dot(own, normal) < 0.0 ? -1.0 * own : own);
      closest = SquaredNorm(others.back() - normal) < SquaredNorm(others[closest] - normal)
        ? others.size() - 1
        : closest;
    }
  }
  if (others.empty())
  {
    return false;
  }
  Vec3 across = normal + others[closest];
  for (const Vec3& other : others)
  {
    const Vec3 tilt = other - others[closest];
    const double angle = Norm(tilt);
    across = angle > 0.0 ? across + std::min(1.0, largestLean / angle) * tilt : across;
  }
  target = p - (height / Dot(across, normal)) * across;
  return InEquatorialSphere(a, b, c, target) > 0;
}

bool PartnerPoints::PlaceInFacet(Id t, Id encroaching, Vec3& target) const
{
  // The point lies in the same (curved) facet: matches would come ever closer to it.
  const IdLists::Range facets = this->Incidences.GetFacets(encroaching);
  if (Contains(facets, this->Surface.GetTriangle(t).Facet))
  {
    return false;
  }
  // However close to other points: only points that match exactly leave each other alone.
  return (this->Rules == MatchingRules::Stacks && this->MirrorInStack(t, encroaching, target)) ||
    this->RotateAboutEdge(t, encroaching, target) ||
    this->RotateAboutCorner(t, encroaching, target) || this->Project(t, encroaching, target);
}

/** Moves a point in a plane facet by rounding errors, to match one of another facet exactly. */
Vec3 PartnerPoints::MatchAcross(Id t, Id encroaching, const Vec3& position, double radius) const
{
  const Vec3& p = this->Points[encroaching];
  const Vec3& own = this->Incidences.GetNormal(this->Surface.GetTriangle(t).Facet);
  Vec3 across;
  double best = 0.5;
  for (Id facet : this->Incidences.GetFacets(encroaching))
  {
    const double cosine = Dot(this->Incidences.GetNormal(facet), own);
    if (std::abs(cosine) > best)
    {
      best = std::abs(cosine);
      across = own + (cosine < 0.0 ? -1.0 : 1.0) * this->Incidences.GetNormal(facet);
    }
  }
  if (best <= 0.5 || Distance(position, p) > NeedleGapRatio * radius)
  {
    return position;
  }
  // The best of some 9000 doubles around the position is a tenth of the last place away.
  const double largest =
    std::max({ std::abs(position.X), std::abs(position.Y), std::abs(position.Z) });
  const double lastPlace = std::nextafter(largest, Infinity) - largest;
  if (this->Rules != MatchingRules::Usual &&
    SquaredNorm(position - p) / (8.0 * radius) < HopelessMatch * lastPlace)
  {
    return position;
  }
  const long double square = SquaredNorm(across);
  return MatchExactly(position, p, radius, 10,
    [&across, square](long double x, long double y, long double z)
    {
      const long double along = (x * across.X + y * across.Y + z * across.Z) / square;
      x -= along * across.X;
      y -= along * across.Y;
      z -= along * across.Z;
      return std::sqrt(x * x + y * y + z * z);
    });
}
} // namespace cdm
