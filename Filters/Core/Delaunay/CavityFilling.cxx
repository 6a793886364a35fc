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

//--------------------------------------------------------------------------------------------------
/** The Delaunay tetrahedra of a cavity's points, and which of them fill it. */
class CavityFilling::Flood
{
public:
  Flood(CavityFilling& filling, const Cavity& cavity)
    : Filling(filling), Input(cavity), Infinite(static_cast<Id>(cavity.Numbers.size()))
  {
  }

  /** False: there is no such tetrahedralization. */
  bool Tetrahedralize()
  {
    if (this->Input.Numbers.size() >> BitsOfPoint > 0 ||
      !BuildDelaunayTetrahedralization(
        this->Input.Points, this->Input.Numbers, GridBlock(), 1, ExecutionContext(), this->Local)
         .IsOk())
    {
      return false;
    }
    std::vector<std::pair<std::uint64_t, Id>>& facets = this->Filling.Facets;
    facets.clear();
    for (Id t = 0; t < static_cast<Id>(this->Local.Tetrahedra.size()); ++t)
    {
      for (int i = 0; i < 4 && this->Local.Tetrahedra[t][0] != NoId && !this->IsOutside(t); ++i)
      {
        facets.emplace_back(MakeKey(GetFacet(this->Local.Tetrahedra[t], i)), 4 * t + i);
      }
    }
    std::sort(facets.begin(), facets.end());
    this->Behind.resize(4 * this->Local.Tetrahedra.size(), Open);
    this->Cells.resize(this->Local.Tetrahedra.size(), NoId);
    return true;
  }

  /** False: a wall is missing. */
  bool FindWalls()
  {
    return std::all_of(this->Input.Walls.begin(), this->Input.Walls.end(),
      [this](const TriangleIds& wall)
      {
        return this->VisitSides(
          this->Input.FindCorners(wall), [this](Id side) { this->Behind[side] = Wall; });
      });
  }

  /** Takes what is in front of each facet of the border. False: a facet is missing. */
  bool StartAtBorder()
  {
    for (Id k = 0; k < static_cast<Id>(this->Input.Border.size()); ++k)
    {
      const TriangleIds facet = this->Input.FindCorners(this->Input.Border[k]);
      Id inner = NoId;
      this->VisitSides(facet,
        [&](Id side)
        {
          const auto& points = this->Input.Points;
          const Vec3& apex = points[this->Local.Tetrahedra[side / 4][side % 4]];
          if (Orientation(points[facet[0]], points[facet[1]], points[facet[2]], apex) > 0)
          {
            inner = side;
          }
        });
      if (inner == NoId)
      {
        return false;
      }
      this->Behind[inner] = k;
      if (!this->Take(inner / 4, this->Input.Regions[k]))
      {
        return false;
      }
    }
    return true;
  }

  /** Goes inwards. False: two regions meet where no wall is, or the border is not closed. */
  bool Spread()
  {
    for (std::size_t k = 0; k < this->Filled.size(); ++k)
    {
      const Id region = this->Filling.Cells[k].Region;
      for (int i = 0; i < 4; ++i)
      {
        const Id next = this->Local.Neighbors[this->Filled[k]][i] / 4;
        if (this->Behind[4 * this->Filled[k] + i] == Open &&
          (this->IsOutside(next) || !this->Take(next, region)))
        {
          return false;
        }
      }
    }
    return true;
  }

  void Connect()
  {
    for (std::size_t k = 0; k < this->Filled.size(); ++k)
    {
      for (int i = 0; i < 4; ++i)
      {
        const Id side = 4 * this->Filled[k] + i;
        const Id inner = this->Local.Neighbors[this->Filled[k]][i];
        Id& neighbor = this->Filling.Cells[k].Neighbors[i];
        if (this->Behind[side] >= 0)
        {
          neighbor = CavityCell::OutOf(this->Behind[side]);
        }
        else if (this->Cells[inner / 4] != NoId)
        {
          neighbor = 4 * this->Cells[inner / 4] + inner % 4;
        }
      }
    }
  }

private:
  bool IsOutside(Id t) const
  {
    const TetrahedronIds& vertices = this->Local.Tetrahedra[t];
    return Contains(vertices, this->Infinite);
  }

  /** Visits a facet from the tetrahedra on its sides, as 4 * tetrahedron + facet. False: none. */
  template <typename Function>
  bool VisitSides(const TriangleIds& facet, Function&& visit) const
  {
    const std::vector<std::pair<std::uint64_t, Id>>& facets = this->Filling.Facets;
    const std::uint64_t key = MakeKey(facet);
    const auto first =
      std::lower_bound(facets.begin(), facets.end(), std::pair<std::uint64_t, Id>(key, 0));
    auto found = first;
    for (; found != facets.end() && found->first == key; ++found)
    {
      visit(found->second);
    }
    return found != first;
  }

  /** Makes a tetrahedron a cell. False: it is one, in another region. */
  bool Take(Id t, Id region)
  {
    if (this->Cells[t] != NoId)
    {
      return this->Filling.Cells[this->Cells[t]].Region == region;
    }
    const TetrahedronIds& vertices = this->Local.Tetrahedra[t];
    const std::vector<Id>& numbers = this->Input.Numbers;
    this->Cells[t] = static_cast<Id>(this->Filling.Cells.size());
    this->Filling.Cells.push_back(
      { { numbers[vertices[0]], numbers[vertices[1]], numbers[vertices[2]], numbers[vertices[3]] },
        region, { NoId, NoId, NoId, NoId } });
    this->Filled.push_back(t);
    return true;
  }

  /** Behind a facet is a tetrahedron, or a wall; or else a facet of the border, by its index. */
  static constexpr Id Open = -1;
  static constexpr Id Wall = -2;

  CavityFilling& Filling;
  const Cavity& Input;
  const Id Infinite;
  DelaunayTetrahedralization Local;
  /** What is behind facet i of tetrahedron t, at 4 * t + i. */
  std::vector<Id> Behind;
  /** The cell that a tetrahedron is, or NoId; and the tetrahedron of each cell. */
  std::vector<Id> Cells;
  std::vector<Id> Filled;
};

//--------------------------------------------------------------------------------------------------
bool CavityFilling::Run(const Cavity& cavity, const CavityCellTest& accepts)
{
  this->Cells.clear();
  if (cavity.Numbers.size() <= CavityWrapping::MostPoints)
  {
    return this->Wrapping.Run(cavity, accepts, this->Cells);
  }
  Flood flood(*this, cavity);
  if (!flood.Tetrahedralize() || !flood.FindWalls() || !flood.StartAtBorder() || !flood.Spread())
  {
    return false;
  }
  flood.Connect();
  return !accepts ||
    std::all_of(this->Cells.begin(), this->Cells.end(),
      [&](const CavityCell& cell) { return accepts(cell.Ids, cell.Region); });
}
} // namespace cdm
