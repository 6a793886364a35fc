// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SharpAngles.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/EdgeUses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace cdm
{
namespace
{
/** Tolerance in degrees: angles less than this below a limit are at the limit up to rounding. */
constexpr double AngleTolerance = 1e-7;
constexpr double SharpDihedralAngle = 60.0 - AngleTolerance;

double GetCosine(double degrees)
{
  return std::cos(degrees / DegreesPerRadian);
}

/**
 * Edges with a smaller sine of the angle between them go straight on, up to rounding of their
 * points.
 */
constexpr double StraightSine = 1e-6;

/** Unit vector from one point to another. */
Vec3 GetDirection(const TriangleMesh& surface, Id from, Id to)
{
  const Vec3 way = surface.Points[to] - surface.Points[from];
  return (1.0 / Norm(way)) * way;
}

bool IsSharp(const StructuralEdge& edge)
{
  return edge.DihedralAngle >= 0.0 && edge.DihedralAngle < SharpDihedralAngle;
}

/** Cosine of the angle of a direction and the closest one between two others; all of length one. */
double GetSectorCosine(const Vec3& direction, const Vec3& first, const Vec3& second)
{
  const Vec3 normal = Cross(first, second);
  const double closest = std::max(Dot(direction, first), Dot(direction, second));
  const Vec3 across = Cross(normal, direction);
  if (Dot(across, first) >= 0.0 || Dot(across, second) <= 0.0)
  {
    return closest;
  }
  return std::max(closest, Norm(across) / Norm(normal));
}

IdLists ListNeighbors(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges)
{
  std::vector<std::pair<Id, Id>> pairs;
  for (const StructuralEdge& edge : edges)
  {
    pairs.emplace_back(edge.Points[0], edge.Points[1]);
    pairs.emplace_back(edge.Points[1], edge.Points[0]);
  }
  IdLists neighbors;
  neighbors.Build(static_cast<Id>(surface.Points.size()), pairs);
  return neighbors;
}
} // namespace

SharpAngles::PlaneLimit::PlaneLimit(double degrees)
  : Cosine(GetCosine(degrees - AngleTolerance)),
    Sine(std::sin((degrees - AngleTolerance) / DegreesPerRadian))
{
}

SharpAngles::SharpAngles(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
  const IdLists& pointTriangles, double sharpPlaneAngle)
  : Surface(surface), ForShapes(sharpPlaneAngle), ForSlivers(SharpPlaneAngleOfSlivers)
{
  const IdLists neighbors = ListNeighbors(surface, edges);
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
  this->Facets = NumberFacets(uses, edges);
  this->FindFacetPairs(edges, uses);
  this->FindTips(pointTriangles, neighbors);
  this->FindArms(pointTriangles, neighbors);
  this->ListFacets(pointTriangles);
  this->NumberOfVisits =
    static_cast<std::int64_t>(surface.Points.size() + surface.Triangles.size() + this->Arms.size());
}

void SharpAngles::Follow(const std::vector<StructuralEdge>& edges,
  const std::vector<Id>& changedEdges, const std::vector<Id>& triangles,
  const std::vector<Id>& parents)
{
  this->Facets.resize(this->Surface.Triangles.size(), NoId);
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    this->Facets[triangles[i]] = this->Facets[parents[i]];
  }
  this->NumberOfVisits += static_cast<std::int64_t>(triangles.size());
  this->FollowFacets(triangles);
  this->FollowArms(edges, changedEdges);
}

/** Lists the surface facets at new points. */
void SharpAngles::FollowFacets(const std::vector<Id>& triangles)
{
  const Id first = this->PointFacets.GetNumberOfOwners();
  std::vector<std::pair<Id, Id>> pairs;
  for (Id t : triangles)
  {
    for (Id point : this->Surface.Triangles[t])
    {
      if (point >= first && this->IsFacetSharp[this->Facets[t]] != 0)
      {
        pairs.emplace_back(point, this->Facets[t]);
      }
    }
  }
  SortUnique(pairs);
  std::vector<Id> facets;
  auto next = pairs.begin();
  for (Id point = first; point < static_cast<Id>(this->Surface.Points.size()); ++point)
  {
    ++this->NumberOfVisits;
    facets.clear();
    for (; next != pairs.end() && next->first == point; ++next)
    {
      facets.push_back(next->second);
    }
    this->PointFacets.Append(facets);
  }
}

/** The arms that a point lies on, and those that start at it; ascending. */
std::vector<Id> SharpAngles::ListArmsAt(Id point) const
{
  std::vector<Id> arms(this->PointArms[point].begin(), this->PointArms[point].end());
  const auto own = std::lower_bound(this->Arms.begin(), this->Arms.end(), point,
    [](const Arm& arm, Id corner) { return arm.Corner < corner; });
  for (auto arm = own; arm != this->Arms.end() && arm->Corner == point; ++arm)
  {
    arms.push_back(static_cast<Id>(arm - this->Arms.begin()));
  }
  std::sort(arms.begin(), arms.end());
  return arms;
}

/** A new point lies on the arms that the next older points on both sides have in common. */
void SharpAngles::FollowArms(
  const std::vector<StructuralEdge>& edges, const std::vector<Id>& changedEdges)
{
  const Id first = this->PointArms.GetNumberOfOwners();
  const Id count = static_cast<Id>(this->Surface.Points.size()) - first;
  std::vector<std::pair<Id, Id>> pairs;
  for (Id e : changedEdges)
  {
    const EdgeIds& ends = edges[e].Points;
    for (int i = 0; i < 2; ++i)
    {
      if (ends[i] >= first)
      {
        pairs.emplace_back(ends[i] - first, ends[1 - i]);
      }
    }
  }
  IdLists neighbors;
  neighbors.Build(count, pairs);
  const auto findOlder = [&](Id last, Id point)
  {
    while (point >= first)
    {
      const IdLists::Range ends = neighbors[point - first];
      last = std::exchange(point, *ends.begin() != last ? *ends.begin() : *(ends.end() - 1));
    }
    return point;
  };
  std::vector<Id> common;
  for (Id i = 0; i < count; ++i)
  {
    common.clear();
    const IdLists::Range ends = neighbors[i];
    if (!ends.empty())
    {
      const std::vector<Id> one = this->ListArmsAt(findOlder(first + i, *ends.begin()));
      const std::vector<Id> other = this->ListArmsAt(findOlder(first + i, *(ends.end() - 1)));
      this->NumberOfVisits += static_cast<std::int64_t>(one.size() + other.size());
      std::set_intersection(
        one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(common));
    }
    this->PointArms.Append(common);
  }
}

void SharpAngles::FindFacetPairs(
  const std::vector<StructuralEdge>& edges, const std::vector<EdgeUse>& uses)
{
  const TriangleMesh& surface = this->Surface;
  const double sharpCosine = GetCosine(SharpDihedralAngle);
  std::vector<Vec3> across;
  std::vector<std::pair<Id, Id>> pairs;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    end = FindEndOfEdge(uses, begin);
    const EdgeIds ends = uses[begin].GetPoints();
    const StructuralEdge* const edge = FindStructuralEdge(edges, ends);
    if (edge == nullptr || !IsSharp(*edge))
    {
      continue;
    }
    const Vec3 along = GetDirection(surface, ends[0], ends[1]);
    across.clear();
    for (std::size_t i = begin; i < end; ++i)
    {
      const Id use = uses[i].Use;
      const Id apex = surface.Triangles[use / 3][(use + 2) % 3];
      const Vec3 way = surface.Points[apex] - surface.Points[ends[0]];
      const Vec3 height = way - Dot(way, along) * along;
      across.push_back((1.0 / Norm(height)) * height);
      for (std::size_t j = begin; j < i; ++j)
      {
        if (Dot(across[i - begin], across[j - begin]) > sharpCosine)
        {
          pairs.push_back(std::minmax(this->Facets[use / 3], this->Facets[uses[j].Use / 3]));
        }
      }
    }
  }
  SortUnique(pairs);
  this->Partners.Build(static_cast<Id>(surface.Triangles.size()), pairs);
}

/** Facets that do not meet at an edge of a point have at least two structural edges there each. */
void SharpAngles::FindTips(const IdLists& pointTriangles, const IdLists& neighbors)
{
  for (Id corner = 0; corner < neighbors.GetNumberOfOwners(); ++corner)
  {
    if (neighbors[corner].size() >= 4)
    {
      this->FindTipsAt(corner, pointTriangles[corner], neighbors[corner]);
    }
  }
  SortUnique(this->Tips);
  std::vector<std::pair<Id, Id>> tips;
  for (const Tip& tip : this->Tips)
  {
    tips.emplace_back(tip.Facets.first, static_cast<Id>(tips.size()));
  }
  this->FacetTips.Build(static_cast<Id>(this->Surface.Triangles.size()), tips);
}

/** The closest ways into two facets from the corner: at least one of them is an edge. */
void SharpAngles::FindTipsAt(Id corner, const IdLists::Range& triangles, const IdLists::Range& ends)
{
  const std::vector<Id>& facets = this->Facets;
  // Facets at each edge, and pairs that meet at one.
  std::vector<std::pair<Id, Id>> edgeFacets;
  std::vector<std::pair<Id, Id>> meeting;
  for (Id end : ends)
  {
    const std::size_t first = edgeFacets.size();
    for (Id t : triangles)
    {
      const TriangleIds& ids = this->Surface.Triangles[t];
      if (Contains(ids, end))
      {
        edgeFacets.emplace_back(end, facets[t]);
        for (std::size_t i = first; i + 1 < edgeFacets.size(); ++i)
        {
          meeting.push_back(std::minmax(edgeFacets[i].second, facets[t]));
        }
      }
    }
  }
  SortUnique(meeting);

  for (Id t : triangles)
  {
    TriangleIds ids = this->Surface.Triangles[t];
    std::rotate(ids.begin(), std::find(ids.begin(), ids.end(), corner), ids.end());
    const Vec3 first = GetDirection(this->Surface, corner, ids[1]);
    const Vec3 second = GetDirection(this->Surface, corner, ids[2]);
    for (const auto& [end, facet] : edgeFacets)
    {
      const std::pair<Id, Id> pair = std::minmax(facet, facets[t]);
      if (facet != facets[t] && !std::binary_search(meeting.begin(), meeting.end(), pair) &&
        GetSectorCosine(GetDirection(this->Surface, corner, end), first, second) >
          this->ForShapes.Cosine)
      {
        this->Tips.push_back({ pair, corner });
      }
    }
  }
}

void SharpAngles::ListFacets(const IdLists& pointTriangles)
{
  std::vector<char>& isSharp = this->IsFacetSharp;
  isSharp.assign(this->Surface.Triangles.size(), 0);
  for (Id facet = 0; facet < this->Partners.GetNumberOfOwners(); ++facet)
  {
    for (Id partner : this->Partners[facet])
    {
      isSharp[facet] = 1;
      isSharp[partner] = 1;
    }
  }
  for (const Tip& tip : this->Tips)
  {
    isSharp[tip.Facets.first] = 1;
    isSharp[tip.Facets.second] = 1;
  }
  for (const Arm& arm : this->Arms)
  {
    for (const Shadow& shadow : arm.Shadows)
    {
      isSharp[shadow.Facet] = 1;
    }
  }
  std::vector<std::pair<Id, Id>> pairs;
  std::vector<Id> around;
  const Id numberOfPoints = static_cast<Id>(this->Surface.Points.size());
  for (Id point = 0; point < numberOfPoints; ++point)
  {
    around.clear();
    for (Id t : pointTriangles[point])
    {
      if (isSharp[this->Facets[t]] != 0)
      {
        around.push_back(this->Facets[t]);
      }
    }
    SortUnique(around);
    for (Id facet : around)
    {
      pairs.emplace_back(point, facet);
    }
  }
  this->PointFacets.Build(numberOfPoints, pairs);
}

/**
 * Finds the shadows of the edge from the corner to other, on the facets of the edge to first that
 * are on its side.
 */
void SharpAngles::FindShadows(Id corner, Id first, Id other, const IdLists::Range& triangles,
  std::vector<Shadow>& shadows) const
{
  const Vec3 along = GetDirection(this->Surface, corner, first);
  const auto getHeight = [&](Id point)
  {
    const Vec3 way = this->Surface.Points[point] - this->Surface.Points[corner];
    return way - Dot(way, along) * along;
  };
  const Vec3 height = getHeight(other);
  // At a right angle rounding would decide.
  const auto isOnSide = [&height](const Vec3& way)
  { return Dot(height, way) > StraightSine * Norm(height) * Norm(way); };
  const double sine = Norm(Cross(along, GetDirection(this->Surface, corner, other)));
  std::vector<Id> own;
  for (Id t : triangles)
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    if (Contains(ids, other))
    {
      own.push_back(this->Facets[t]);
    }
  }
  for (Id t : triangles)
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    const auto apex =
      std::find_if(ids.begin(), ids.end(), [&](Id id) { return id != corner && id != first; });
    if (Contains(ids, first) && !Contains(own, this->Facets[t]) && isOnSide(getHeight(*apex)))
    {
      shadows.push_back({ this->Facets[t], sine });
    }
  }
}

void SharpAngles::FindArms(const IdLists& pointTriangles, const IdLists& neighbors)
{
  const TriangleMesh& surface = this->Surface;
  const Id numberOfPoints = static_cast<Id>(surface.Points.size());
  std::vector<std::pair<Id, Id>> pairs;
  for (Id corner = 0; corner < numberOfPoints; ++corner)
  {
    for (Id first : neighbors[corner])
    {
      const Vec3 direction = GetDirection(surface, corner, first);
      bool isSharp = false;
      std::vector<Shadow> shadows;
      for (Id other : neighbors[corner])
      {
        if (other != first &&
          Dot(direction, GetDirection(surface, corner, other)) > this->ForShapes.Cosine)
        {
          isSharp = true;
          this->FindShadows(corner, first, other, pointTriangles[corner], shadows);
        }
      }
      if (!isSharp)
      {
        continue;
      }
      Id last = corner;
      for (Id point = first; point != NoId;)
      {
        pairs.emplace_back(point, static_cast<Id>(this->Arms.size()));
        const auto isNext = [&](Id other)
        {
          const Vec3 onward = GetDirection(surface, point, other);
          return other != last && Dot(onward, direction) > 0.0 &&
            Norm(Cross(onward, direction)) < StraightSine;
        };
        const IdLists::Range ends = neighbors[point];
        const auto next = std::find_if(ends.begin(), ends.end(), isNext);
        last = point;
        point = next == ends.end() ? NoId : *next;
      }
      this->Arms.push_back({ corner, direction, std::move(shadows) });
    }
  }
  this->PointArms.Build(numberOfPoints, pairs);
}

std::vector<char> SharpAngles::MarkFacets() const
{
  std::vector<char> isMarked = this->IsFacetSharp;
  for (std::size_t t = 0; t < this->Facets.size(); ++t)
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    if (std::any_of(
          ids.begin(), ids.end(), [this](Id point) { return !this->PointArms[point].empty(); }))
    {
      isMarked[this->Facets[t]] = 1;
    }
  }
  return isMarked;
}

bool SharpAngles::IsAcross(const TetrahedronIds& ids, SharpAngleUse use) const
{
  const PlaneLimit& limit = use == SharpAngleUse::Sliver ? this->ForSlivers : this->ForShapes;
  const Id numberOfPoints = this->PointFacets.GetNumberOfOwners();
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      if (std::max(ids[i], ids[j]) < numberOfPoints &&
        (this->AreAcrossFacets(ids[i], ids[j], limit) ||
          this->AreAcrossArms(ids[i], ids[j], limit) || this->IsInShadow(ids[i], ids[j], limit) ||
          this->IsInShadow(ids[j], ids[i], limit)))
      {
        return true;
      }
    }
  }
  return false;
}

bool SharpAngles::AreAcrossFacets(Id p, Id q, const PlaneLimit& limit) const
{
  const IdLists::Range first = this->PointFacets[p];
  const IdLists::Range second = this->PointFacets[q];
  for (Id f : first)
  {
    if (Contains(second, f))
    {
      continue;
    }
    for (Id g : second)
    {
      const auto [smaller, larger] = std::minmax({ f, g });
      if ((Contains(this->Partners[smaller], larger) ||
            this->AreAcrossTip(smaller, larger, p, q, limit)) &&
        !Contains(first, g))
      {
        return true;
      }
    }
  }
  return false;
}

bool SharpAngles::AreAcrossTip(Id facet, Id largerFacet, Id p, Id q, const PlaneLimit& limit) const
{
  const IdLists::Range tips = this->FacetTips[facet];
  return std::any_of(tips.begin(), tips.end(),
    [&](Id i)
    {
      const Tip& tip = this->Tips[i];
      return tip.Facets.second == largerFacet && tip.Point != p && tip.Point != q &&
        Dot(GetDirection(this->Surface, tip.Point, p), GetDirection(this->Surface, tip.Point, q)) >
        limit.Cosine;
    });
}

bool SharpAngles::AreAcrossArms(Id p, Id q, const PlaneLimit& limit) const
{
  for (Id i : this->PointArms[p])
  {
    for (Id j : this->PointArms[q])
    {
      if (i != j && this->Arms[i].Corner == this->Arms[j].Corner &&
        Dot(this->Arms[i].Direction, this->Arms[j].Direction) > limit.Cosine)
      {
        return true;
      }
    }
  }
  return false;
}

/** Points of an angle are matched by points of its shadow. */
bool SharpAngles::IsInShadow(Id armPoint, Id point, const PlaneLimit& limit) const
{
  const IdLists::Range facets = this->PointFacets[point];
  for (Id i : this->PointArms[armPoint])
  {
    const Arm& arm = this->Arms[i];
    for (const Shadow& shadow : arm.Shadows)
    {
      if (shadow.Sine > limit.Sine || point == arm.Corner || !Contains(facets, shadow.Facet) ||
        Contains(this->PointArms[point], i))
      {
        continue;
      }
      const Vec3 direction = GetDirection(this->Surface, arm.Corner, point);
      const double sine = Norm(Cross(direction, arm.Direction));
      if (Dot(direction, arm.Direction) > 0.0 && sine < (1.0 + StraightSine) * shadow.Sine)
      {
        return true;
      }
    }
  }
  return false;
}
} // namespace cdm
