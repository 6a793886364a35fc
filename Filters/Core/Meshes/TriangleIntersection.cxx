// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/TriangleIntersection.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/BoxTree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cdm
{
namespace
{
/**
 * Pairs of triangles whose boxes overlap are tested when there are so many, and so many at a time by
 * a thread.
 */
constexpr std::size_t PairsBetweenTests = 1 << 15;
constexpr std::size_t PairsAtOnce = 1024;

using Corners = std::array<Vec3, 3>;

Corners GetCorners(const std::vector<Vec3>& points, const TriangleIds& t)
{
  return { points[t[0]], points[t[1]], points[t[2]] };
}

/**
 * An axis along which the projection of the triangle has an area, exactly; sign: the orientation
 * of the projection.
 */
int GetProjectionAxis(const Corners& t, int& sign)
{
  const Vec3 normal = Cross(t[1] - t[0], t[2] - t[0]);
  const Vec3 size{ std::abs(normal.X), std::abs(normal.Y), std::abs(normal.Z) };
  const int best = size.X >= size.Y && size.X >= size.Z ? 0 : size.Y >= size.Z ? 1 : 2;
  for (int i = 0; i < 3; ++i)
  {
    const int axis = (best + i) % 3;
    sign = ProjectedOrientation(axis, t[0], t[1], t[2]);
    if (sign != 0)
    {
      return axis;
    }
  }
  return best;
}

/** Whether p, in the plane of the triangle, lies in it or on its border. */
bool IsInCoplanarTriangle(const Corners& t, const Vec3& p)
{
  int sign = 0;
  const int axis = GetProjectionAxis(t, sign);
  return ProjectedOrientation(axis, t[0], t[1], p) * sign >= 0 &&
    ProjectedOrientation(axis, t[1], t[2], p) * sign >= 0 &&
    ProjectedOrientation(axis, t[2], t[0], p) * sign >= 0;
}

std::array<int, 3> GetSides(const Corners& plane, const Corners& t)
{
  return { Orientation(plane[0], plane[1], plane[2], t[0]),
    Orientation(plane[0], plane[1], plane[2], t[1]),
    Orientation(plane[0], plane[1], plane[2], t[2]) };
}

bool AreStrictlyOnOneSide(const std::array<int, 3>& sides)
{
  return sides[0] != 0 && sides[0] == sides[1] && sides[0] == sides[2];
}

bool AreInPlane(const std::array<int, 3>& sides)
{
  return sides[0] == 0 && sides[1] == 0 && sides[2] == 0;
}

/**
 * Whether the segment from p to q meets the closed triangle t; sideP and sideQ: sides of t's plane
 * on which its ends lie, not both 0.
 */
bool MeetsTriangle(const Vec3& p, const Vec3& q, int sideP, int sideQ, const Corners& t)
{
  if (sideP * sideQ > 0)
  {
    return false;
  }
  if (sideP == 0 || sideQ == 0)
  {
    return IsInCoplanarTriangle(t, sideP == 0 ? p : q);
  }
  const int a = Orientation(p, q, t[0], t[1]);
  const int b = Orientation(p, q, t[1], t[2]);
  if (a * b < 0)
  {
    return false;
  }
  const int c = Orientation(p, q, t[2], t[0]);
  return a * c >= 0 && b * c >= 0;
}

/** Whether an edge of s meets t where it is not in t's plane. */
bool DoesAnEdgeMeet(const Corners& s, const std::array<int, 3>& sides, const Corners& t)
{
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    if ((sides[i] != 0 || sides[j] != 0) && MeetsTriangle(s[i], s[j], sides[i], sides[j], t))
    {
      return true;
    }
  }
  return false;
}

bool HaveNoneInPlane(const std::array<int, 3>& sides)
{
  return sides[0] != 0 && sides[1] != 0 && sides[2] != 0;
}

/** The corners, beginning with the one that is alone on its side. */
Corners BeginWithLoneCorner(const Corners& t, const std::array<int, 3>& sides, int& side)
{
  const int first = sides[1] == sides[2] ? 0 : sides[0] == sides[2] ? 1 : 2;
  side = sides[first];
  return { t[first], t[(first + 1) % 3], t[(first + 2) % 3] };
}

/**
 * Two triangles that cross each other's planes and have no corner in them. Both cut the line where
 * the planes meet; two signs tell whether their pieces of it overlap.
 */
bool DoCrossingTrianglesMeet(const Corners& s, const std::array<int, 3>& sidesS, const Corners& t,
  const std::array<int, 3>& sidesT)
{
  int sideS = 0;
  int sideT = 0;
  Corners first = BeginWithLoneCorner(s, sidesS, sideS);
  Corners second = BeginWithLoneCorner(t, sidesT, sideT);
  if (sideS < 0)
  {
    std::swap(second[1], second[2]);
  }
  if (sideT < 0)
  {
    std::swap(first[1], first[2]);
  }
  return Orientation(first[0], first[1], second[0], second[1]) <= 0 &&
    Orientation(first[0], first[2], second[2], second[0]) <= 0;
}

/**
 * Whether a line along an edge of s separates the triangles in a projection: t lies beyond it,
 * without touching. sign: the orientation of s there.
 */
bool IsSeparatedByAnEdge(const Corners& s, int axis, int sign, const Corners& t)
{
  for (int i = 0; i < 3; ++i)
  {
    const Vec3& p = s[i];
    const Vec3& q = s[(i + 1) % 3];
    const auto isBeyond = [&](const Vec3& r)
    { return ProjectedOrientation(axis, p, q, r) * sign < 0; };
    if (isBeyond(t[0]) && isBeyond(t[1]) && isBeyond(t[2]))
    {
      return true;
    }
  }
  return false;
}

/** Convex polygons in a plane have a common point unless a line along an edge separates them. */
bool DoCoplanarTrianglesMeet(const Corners& s, const Corners& t)
{
  int sign = 0;
  const int axis = GetProjectionAxis(s, sign);
  return !IsSeparatedByAnEdge(s, axis, sign, t) &&
    !IsSeparatedByAnEdge(t, axis, ProjectedOrientation(axis, t[0], t[1], t[2]), s);
}

/**
 * Whether the closed cones of directions from v to a and b, and to c and d, all in a plane, have a
 * direction in common: then a border of one lies in the other one.
 */
bool DoCoplanarConesMeet(const Vec3& v, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  int first = 0;
  const int axis = GetProjectionAxis({ v, a, b }, first);
  const int second = ProjectedOrientation(axis, v, c, d);
  const int ac = ProjectedOrientation(axis, v, a, c);
  const int ad = ProjectedOrientation(axis, v, a, d);
  const int bc = ProjectedOrientation(axis, v, b, c);
  const int bd = ProjectedOrientation(axis, v, b, d);
  return (ac * first >= 0 && bc * first <= 0) || (ad * first >= 0 && bd * first <= 0) ||
    (ac * second <= 0 && ad * second >= 0) || (bc * second <= 0 && bd * second >= 0);
}

/** Whether the direction from v to p is one of the closed cone to c and d, all in a plane. */
bool IsInCoplanarCone(const Vec3& v, const Vec3& c, const Vec3& d, const Vec3& p)
{
  int sign = 0;
  const int axis = GetProjectionAxis({ v, c, d }, sign);
  return ProjectedOrientation(axis, v, c, p) * sign >= 0 &&
    ProjectedOrientation(axis, v, p, d) * sign >= 0;
}

/** Common edge (u, v), third vertices p and q. */
TriangleContact ClassifyAtEdge(const Vec3& u, const Vec3& v, const Vec3& p, const Vec3& q)
{
  if (Orientation(u, v, p, q) != 0)
  {
    return TriangleContact::CommonEdge;
  }
  int sign = 0;
  const int axis = GetProjectionAxis({ u, v, p }, sign);
  return ProjectedOrientation(axis, u, v, q) == sign ? TriangleContact::Intersection
                                                     : TriangleContact::CommonEdge;
}

/** Triangles (v, a, b) and (v, c, d). */
TriangleContact ClassifyAtVertex(Vec3 v, Vec3 a, Vec3 b, const Vec3& c, const Vec3& d)
{
  const int sideC = Orientation(v, a, b, c);
  const int sideD = Orientation(v, a, b, d);
  if (sideC * sideD > 0)
  {
    return TriangleContact::CommonVertex;
  }
  bool meet = false;
  if (sideC == 0 && sideD == 0)
  {
    meet = DoCoplanarConesMeet(v, a, b, c, d);
  }
  else
  {
    int sideA = Orientation(v, c, d, a);
    int sideB = Orientation(v, c, d, b);
    if (sideA * sideB > 0)
    {
      return TriangleContact::CommonVertex;
    }
    if (sideA == 0 || sideB == 0)
    {
      meet = IsInCoplanarCone(v, c, d, sideA == 0 ? a : b);
    }
    else
    {
      if (sideA < 0)
      {
        std::swap(a, b);
      }
      // The line from a, in front, to b, behind, passes the cone on the inner side of both borders.
      meet = Orientation(a, b, v, c) <= 0 && Orientation(a, b, d, v) <= 0;
    }
  }
  return meet ? TriangleContact::Intersection : TriangleContact::CommonVertex;
}

TriangleContact ClassifySeparate(const Corners& s, const Corners& t)
{
  const std::array<int, 3> sidesT = GetSides(s, t);
  if (AreStrictlyOnOneSide(sidesT))
  {
    return TriangleContact::Disjoint;
  }
  bool meet = false;
  if (AreInPlane(sidesT))
  {
    meet = DoCoplanarTrianglesMeet(s, t);
  }
  else
  {
    const std::array<int, 3> sidesS = GetSides(t, s);
    if (AreStrictlyOnOneSide(sidesS))
    {
      return TriangleContact::Disjoint;
    }
    // An end of the common segment is where an edge of one triangle leaves the other's plane; an
    // edge that lies in the plane ends where another one does that.
    meet = HaveNoneInPlane(sidesS) && HaveNoneInPlane(sidesT)
      ? DoCrossingTrianglesMeet(s, sidesS, t, sidesT)
      : DoesAnEdgeMeet(s, sidesS, t) || DoesAnEdgeMeet(t, sidesT, s);
  }
  return meet ? TriangleContact::Intersection : TriangleContact::Disjoint;
}

/** Permutes s and t so that their common vertices come first, alike; returns their number. */
int MoveCommonVerticesToFront(TriangleIds& s, TriangleIds& t)
{
  int common = 0;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = common; j < 3; ++j)
    {
      if (s[i] == t[j])
      {
        std::swap(s[i], s[common]);
        std::swap(t[j], t[common]);
        ++common;
        break;
      }
    }
  }
  return common;
}

/** Vertices of s in t, and edges of s that pierce t; side: 0 if s is the first triangle. */
void AddPiercingContacts(const Corners& s, const Corners& t, int side, ContactPoints& contacts)
{
  const std::array<int, 3> sides = GetSides(t, s);
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    if (sides[i] == 0 && IsInCoplanarTriangle(t, s[i]))
    {
      contacts.push_back({ side, i, -1, -1 });
    }
    if (sides[i] * sides[j] < 0 && MeetsTriangle(s[i], s[j], sides[i], sides[j], t))
    {
      contacts.push_back({ side, -1, i, -1 });
    }
  }
}

void AddCoplanarContacts(const Corners& s, const Corners& t, ContactPoints& contacts)
{
  for (int i = 0; i < 3; ++i)
  {
    if (IsInCoplanarTriangle(t, s[i]))
    {
      contacts.push_back({ 0, i, -1, -1 });
    }
    if (IsInCoplanarTriangle(s, t[i]))
    {
      contacts.push_back({ 1, i, -1, -1 });
    }
  }
  int sign = 0;
  const int axis = GetProjectionAxis(s, sign);
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      if (DoProjectedSegmentsCross(axis, s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]))
      {
        contacts.push_back({ 0, -1, i, j });
      }
    }
  }
}

/** The point where the segment from p to q meets the plane of t. */
Vec3 PiercePlane(const Vec3& p, const Vec3& q, const Corners& t)
{
  const Vec3 normal = Cross(t[1] - t[0], t[2] - t[0]);
  const double heightP = Dot(normal, p - t[0]);
  const double heightQ = Dot(normal, q - t[0]);
  const double ratio = heightP == heightQ ? 0.5 : heightP / (heightP - heightQ);
  return p + std::min(1.0, std::max(0.0, ratio)) * (q - p);
}

Vec3 GetPosition(const ContactPoint& contact, const Corners& a, const Corners& b)
{
  const Corners& own = contact.Triangle == 0 ? a : b;
  const Corners& other = contact.Triangle == 0 ? b : a;
  if (contact.Vertex >= 0)
  {
    return own[contact.Vertex];
  }
  const Vec3& p = own[contact.Edge];
  const Vec3& q = own[(contact.Edge + 1) % 3];
  if (contact.OtherEdge < 0)
  {
    return PiercePlane(p, q, other);
  }
  const Vec3& c = other[contact.OtherEdge];
  const Vec3 normal = Cross(own[1] - own[0], own[2] - own[0]);
  return PiercePlane(p, q, { c, other[(contact.OtherEdge + 1) % 3], c + normal });
}
} // namespace

TriangleContact ClassifyTriangles(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t)
{
  TriangleIds a = s;
  TriangleIds b = t;
  switch (MoveCommonVerticesToFront(a, b))
  {
    case 0:
      return ClassifySeparate(GetCorners(points, s), GetCorners(points, t));
    case 1:
      return ClassifyAtVertex(points[a[0]], points[a[1]], points[a[2]], points[b[1]], points[b[2]]);
    case 2:
      return ClassifyAtEdge(points[a[0]], points[a[1]], points[a[2]], points[b[2]]);
    default:
      return TriangleContact::Intersection;
  }
}

bool AreCoplanar(const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t)
{
  return AreInPlane(GetSides(GetCorners(points, s), GetCorners(points, t)));
}

int FindProjectionAxis(const Vec3& a, const Vec3& b, const Vec3& c, int& sign)
{
  return GetProjectionAxis({ a, b, c }, sign);
}

bool DoProjectedSegmentsCross(int axis, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  return ProjectedOrientation(axis, a, b, c) * ProjectedOrientation(axis, a, b, d) < 0 &&
    ProjectedOrientation(axis, c, d, a) * ProjectedOrientation(axis, c, d, b) < 0;
}

ContactPoints FindContactPoints(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t, bool asCoplanar)
{
  const Corners a = GetCorners(points, s);
  const Corners b = GetCorners(points, t);
  ContactPoints contacts;
  if (asCoplanar)
  {
    AddCoplanarContacts(a, b, contacts);
  }
  else
  {
    AddPiercingContacts(a, b, 0, contacts);
    AddPiercingContacts(b, a, 1, contacts);
  }
  return contacts;
}

void FindIntersectionSegment(const std::vector<Vec3>& points, const TriangleIds& s,
  const TriangleIds& t, Vec3& begin, Vec3& end)
{
  const Corners a = GetCorners(points, s);
  const Corners b = GetCorners(points, t);
  std::vector<Vec3> found;
  for (const ContactPoint& contact : FindContactPoints(points, s, t, AreCoplanar(points, s, t)))
  {
    found.push_back(GetPosition(contact, a, b));
  }
  begin = end = found.empty() ? a[0] : found[0];
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    for (std::size_t j = i + 1; j < found.size(); ++j)
    {
      if (Distance(found[i], found[j]) > Distance(begin, end))
      {
        begin = found[i];
        end = found[j];
      }
    }
  }
}

bool FindIntersectingPairs(const std::vector<Vec3>& points,
  const std::vector<TriangleIds>& triangles, const std::vector<char>& active,
  const ExecutionContext& context, std::vector<TrianglePair>& pairs)
{
  pairs.clear();
  const BoxTree tree(MakeBoxes(points, triangles), context.GetNumberOfThreads());
  const auto isActive = [&active](Id t) { return active.empty() || active[t]; };
  std::vector<TrianglePair> candidates;
  std::vector<char> intersect;
  const auto test = [&]
  {
    intersect.resize(candidates.size());
    ParallelLoop(candidates.size(), { context.GetNumberOfThreads(), PairsAtOnce }, {}, "",
      [&](std::size_t begin, std::size_t end, std::size_t)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          const auto [s, t] = candidates[i];
          intersect[i] = static_cast<char>(
            ClassifyTriangles(points, triangles[s], triangles[t]) == TriangleContact::Intersection);
        }
      });
    for (std::size_t i = 0; i < candidates.size(); ++i)
    {
      if (intersect[i] != 0)
      {
        pairs.push_back(candidates[i]);
      }
    }
    candidates.clear();
  };
  const auto add = [&](Id s, Id t)
  {
    if (isActive(s) || isActive(t))
    {
      candidates.push_back({ std::min(s, t), std::max(s, t) });
    }
  };
  const auto mayGoOn = [&](double progress)
  {
    if (candidates.size() >= PairsBetweenTests)
    {
      test();
    }
    return pairs.size() < MaximumNumberOfPairs &&
      context.Continue(progress, "Looking for self-intersections");
  };
  const bool isDone = tree.VisitPairs(add, mayGoOn);
  test();
  std::sort(pairs.begin(), pairs.end());
  return isDone || pairs.size() >= MaximumNumberOfPairs;
}
} // namespace cdm
