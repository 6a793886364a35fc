// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/CavityFilling.h"

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>

namespace cdm
{
namespace
{
/** Points of a cavity are packed into a key in so many bits. */
constexpr int BitsOfPoint = 21;

std::uint64_t MakeKey(const TriangleIds& facet)
{
  const TriangleIds ids = Sorted(facet);
  return (static_cast<std::uint64_t>(ids[0]) << BitsOfPoint | ids[1]) << BitsOfPoint | ids[2];
}
} // namespace

bool CavityFilling::Run(const Cavity& cavity)
{
  this->Cells.clear();
  DelaunayTetrahedralization local;
  if (cavity.Numbers.size() >> BitsOfPoint > 0 ||
    !BuildDelaunayTetrahedralization(
      cavity.Points, cavity.Numbers, GridBlock(), 1, ExecutionContext(), local)
       .IsOk())
  {
    return false;
  }
  const Id infinite = static_cast<Id>(cavity.Numbers.size());
  const auto isOutside = [&](Id t)
  {
    const TetrahedronIds& vertices = local.Tetrahedra[t];
    return std::find(vertices.begin(), vertices.end(), infinite) != vertices.end();
  };
  this->Facets.clear();
  for (Id t = 0; t < static_cast<Id>(local.Tetrahedra.size()); ++t)
  {
    if (local.Tetrahedra[t][0] == NoId || isOutside(t))
    {
      continue;
    }
    for (int i = 0; i < 4; ++i)
    {
      this->Facets.emplace_back(MakeKey(GetFacet(local.Tetrahedra[t], i)), 4 * t + i);
    }
  }
  std::sort(this->Facets.begin(), this->Facets.end());

  // What is behind each facet of a tetrahedron, if it is on the border or a wall.
  constexpr Id open = -1;
  constexpr Id wall = -2;
  std::vector<Id> behind(4 * local.Tetrahedra.size(), open);
  // A point that the cavity does not have is told by its index: no facet is found at it.
  const auto findCorners = [&](TriangleIds facet)
  {
    for (Id& id : facet)
    {
      const auto place = std::lower_bound(cavity.Numbers.begin(), cavity.Numbers.end(), id);
      const bool isThere = place != cavity.Numbers.end() && *place == id;
      id = isThere ? static_cast<Id>(place - cavity.Numbers.begin()) : infinite;
    }
    return facet;
  };
  const auto forEachSide = [&](const TriangleIds& facet, auto&& apply)
  {
    const std::uint64_t key = MakeKey(facet);
    auto found = std::lower_bound(
      this->Facets.begin(), this->Facets.end(), std::pair<std::uint64_t, Id>(key, 0));
    bool isThere = false;
    for (; found != this->Facets.end() && found->first == key; ++found)
    {
      isThere = true;
      apply(found->second);
    }
    return isThere;
  };
  for (const TriangleIds& facet : cavity.Walls)
  {
    if (!forEachSide(findCorners(facet), [&](Id side) { behind[side] = wall; }))
    {
      return false;
    }
  }
  std::vector<Id> cells(local.Tetrahedra.size(), NoId);
  std::vector<Id> filled;
  const auto add = [&](Id t, Id region)
  {
    if (cells[t] != NoId)
    {
      return this->Cells[cells[t]].Region == region;
    }
    const TetrahedronIds& vertices = local.Tetrahedra[t];
    cells[t] = static_cast<Id>(this->Cells.size());
    this->Cells.push_back({ { cavity.Numbers[vertices[0]], cavity.Numbers[vertices[1]],
                              cavity.Numbers[vertices[2]], cavity.Numbers[vertices[3]] },
      region, { NoId, NoId, NoId, NoId } });
    filled.push_back(t);
    return true;
  };
  for (Id k = 0; k < static_cast<Id>(cavity.Border.size()); ++k)
  {
    const TriangleIds facet = findCorners(cavity.Border[k]);
    Id inner = NoId;
    forEachSide(facet,
      [&](Id side)
      {
        const Vec3& apex = cavity.Points[local.Tetrahedra[side / 4][side % 4]];
        if (Orientation(
              cavity.Points[facet[0]], cavity.Points[facet[1]], cavity.Points[facet[2]], apex) > 0)
        {
          inner = side;
        }
      });
    if (inner == NoId)
    {
      return false;
    }
    behind[inner] = k;
    if (!add(inner / 4, cavity.Regions[k]))
    {
      return false;
    }
  }
  for (std::size_t k = 0; k < filled.size(); ++k)
  {
    const Id region = this->Cells[k].Region;
    for (int i = 0; i < 4; ++i)
    {
      const Id side = 4 * filled[k] + i;
      const Id next = local.Neighbors[filled[k]][i] / 4;
      if (behind[side] == open && (isOutside(next) || !add(next, region)))
      {
        return false;
      }
    }
  }
  for (std::size_t k = 0; k < filled.size(); ++k)
  {
    for (int i = 0; i < 4; ++i)
    {
      const Id side = 4 * filled[k] + i;
      const Id inner = local.Neighbors[filled[k]][i];
      Id& neighbor = this->Cells[k].Neighbors[i];
      if (behind[side] >= 0)
      {
        neighbor = OutOf(behind[side]);
      }
      else if (cells[inner / 4] != NoId)
      {
        neighbor = 4 * cells[inner / 4] + inner % 4;
      }
    }
  }
  return true;
}
} // namespace cdm
