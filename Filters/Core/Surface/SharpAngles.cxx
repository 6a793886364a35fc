// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SharpAngles.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/EdgeUses.h"

#include <algorithm>

namespace cdm
{
namespace
{
constexpr double SharpDihedralAngle = 60.0;
/** Of that angle. */
constexpr double SharpDihedralCosine = 0.5;
/** Of 30 degrees. */
constexpr double SharpPlaneCosine = 0.8660254037844386;
/** Edges with a smaller sine of the angle between them go straight on: their points are rounded. */
constexpr double StraightSine = 1e-6;

Vec3 GetDirection(const TriangleMesh& surface, Id from, Id to)
{
  const Vec3 way = surface.Points[to] - surface.Points[from];
  return (1.0 / Norm(way)) * way;
}

bool HasId(const IdLists::Range& ids, Id id)
{
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}
} // namespace

SharpAngles::SharpAngles(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges)
  : IsCorner(surface.Points.size(), 0)
{
  this->FindFacets(surface, edges);
  this->FindArms(surface, edges);
}

void SharpAngles::FindFacets(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges)
{
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
  // Triangles at each edge that is sharp.
  std::vector<std::pair<EdgeIds, std::vector<Id>>> sharp;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    while (end < uses.size() && uses[end].Edge == uses[begin].Edge)
    {
      ++end;
    }
    const EdgeIds ends = uses[begin].GetPoints();
    const StructuralEdge* const edge = FindStructuralEdge(edges, ends);
    if (edge != nullptr && edge->DihedralAngle >= 0.0 && edge->DihedralAngle < SharpDihedralAngle)
    {
      sharp.push_back({ ends, {} });
      for (std::size_t i = begin; i < end; ++i)
      {
        sharp.back().second.push_back(uses[i].Use);
      }
    }
  }

  const std::vector<Id> facets = sharp.empty() ? std::vector<Id>() : NumberFacets(uses, edges);
  for (const auto& [ends, around] : sharp)
  {
    this->IsCorner[ends[0]] = 1;
    this->IsCorner[ends[1]] = 1;
    const Vec3 along = GetDirection(surface, ends[0], ends[1]);
    std::vector<Vec3> across;
    for (Id use : around)
    {
      const Id apex = surface.Triangles[use / 3][(use + 2) % 3];
      const Vec3 way = surface.Points[apex] - surface.Points[ends[0]];
      const Vec3 height = way - Dot(way, along) * along;
      across.push_back((1.0 / Norm(height)) * height);
    }
    for (std::size_t i = 0; i < around.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        if (Dot(across[i], across[j]) > SharpDihedralCosine)
        {
          this->FacetPairs.push_back(std::minmax(facets[around[i] / 3], facets[around[j] / 3]));
        }
      }
    }
  }
  SortUnique(this->FacetPairs);

  std::vector<char> isSharp(surface.Triangles.size(), 0);
  for (const auto& [first, second] : this->FacetPairs)
  {
    isSharp[first] = 1;
    isSharp[second] = 1;
  }
  std::vector<std::pair<Id, Id>> pairs;
  for (Id t = 0; t < static_cast<Id>(surface.Triangles.size()) && !sharp.empty(); ++t)
  {
    const Id facet = facets[t];
    for (Id point : surface.Triangles[t])
    {
      if (isSharp[facet] != 0)
      {
        pairs.emplace_back(point, facet);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  this->PointFacets.Build(static_cast<Id>(surface.Points.size()), pairs);
}

void SharpAngles::FindArms(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges)
{
  const Id numberOfPoints = static_cast<Id>(surface.Points.size());
  std::vector<std::pair<Id, Id>> pairs;
  for (const StructuralEdge& edge : edges)
  {
    pairs.emplace_back(edge.Points[0], edge.Points[1]);
    pairs.emplace_back(edge.Points[1], edge.Points[0]);
  }
  IdLists neighbors;
  neighbors.Build(numberOfPoints, pairs);
  pairs.clear();
  for (Id corner = 0; corner < numberOfPoints; ++corner)
  {
    for (Id first : neighbors[corner])
    {
      const Vec3 direction = GetDirection(surface, corner, first);
      const auto isSharp = [&](Id other)
      {
        return other != first &&
          Dot(direction, GetDirection(surface, corner, other)) > SharpPlaneCosine;
      };
      if (std::none_of(neighbors[corner].begin(), neighbors[corner].end(), isSharp))
      {
        continue;
      }
      this->IsCorner[corner] = 1;
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
      this->Arms.push_back({ corner, direction });
    }
  }
  this->PointArms.Build(numberOfPoints, pairs);
}

bool SharpAngles::IsAtCorner(const TetrahedronIds& ids) const
{
  return std::any_of(ids.begin(), ids.end(),
    [this](Id id) { return id < static_cast<Id>(this->IsCorner.size()) && this->IsCorner[id]; });
}

bool SharpAngles::IsAcross(const TetrahedronIds& ids) const
{
  const Id numberOfPoints = static_cast<Id>(this->IsCorner.size());
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      if (std::max(ids[i], ids[j]) < numberOfPoints &&
        (this->AreAcrossFacets(ids[i], ids[j]) || this->AreAcrossArms(ids[i], ids[j])))
      {
        return true;
      }
    }
  }
  return false;
}

bool SharpAngles::AreAcrossFacets(Id p, Id q) const
{
  if (this->FacetPairs.empty())
  {
    return false;
  }
  const IdLists::Range first = this->PointFacets[p];
  const IdLists::Range second = this->PointFacets[q];
  for (Id f : first)
  {
    for (Id g : second)
    {
      if (!HasId(second, f) && !HasId(first, g) &&
        std::binary_search(
          this->FacetPairs.begin(), this->FacetPairs.end(), std::pair<Id, Id>(std::minmax(f, g))))
      {
        return true;
      }
    }
  }
  return false;
}

bool SharpAngles::AreAcrossArms(Id p, Id q) const
{
  for (Id i : this->PointArms[p])
  {
    for (Id j : this->PointArms[q])
    {
      if (i != j && this->Arms[i].Corner == this->Arms[j].Corner &&
        Dot(this->Arms[i].Direction, this->Arms[j].Direction) > SharpPlaneCosine)
      {
        return true;
      }
    }
  }
  return false;
}
} // namespace cdm
