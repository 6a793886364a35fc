// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/CavityWrapping.h"

#include "Core/Delaunay/FacetApex.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace cdm
{
namespace
{
/** Bits of a point's index. */
constexpr int BitsOfIndex = 6;
static_assert(CavityWrapping::MostPoints <= 1U << BitsOfIndex, "indices are packed into keys");
} // namespace

void CavityWrapping::Clear(std::size_t numberOfPoints)
{
  // Room for four facets of two tetrahedra for each point; more is made when it is needed.
  std::size_t size = 64;
  while (size < 8 * numberOfPoints)
  {
    size *= 2;
  }
  this->Table.assign(size, NoId);
  this->Facets.clear();
  this->CellSides.clear();
}

Id CavityWrapping::GetSide(const TriangleIds& points)
{
  // Each exchange turns the facet around.
  TriangleIds ascending = points;
  Id side = 0;
  for (const auto& [i, j] : { std::pair<int, int>(0, 1), { 1, 2 }, { 0, 1 } })
  {
    if (ascending[i] > ascending[j])
    {
      std::swap(ascending[i], ascending[j]);
      side ^= 1;
    }
  }
  std::size_t place = this->FindPlace(ascending);
  if (this->Table[place] == NoId)
  {
    if (2 * this->Facets.size() >= this->Table.size())
    {
      this->Grow();
      place = this->FindPlace(ascending);
    }
    this->Table[place] = static_cast<Id>(this->Facets.size());
    this->Facets.emplace_back();
    this->Facets.back().Points = ascending;
  }
  return 2 * this->Table[place] + side;
}

/** The place of a facet, or the empty one where it belongs. */
std::size_t CavityWrapping::FindPlace(const TriangleIds& ascending) const
{
  // Multiplied by 2^32 over the golden ratio, high bits are well mixed.
  const auto get = [&](std::size_t i) { return static_cast<std::uint32_t>(ascending[i]); };
  const std::uint32_t key = (get(0) << BitsOfIndex | get(1)) << BitsOfIndex | get(2);
  const std::size_t mask = this->Table.size() - 1;
  std::size_t place = (key * 2654435769U >> 12) & mask;
  while (this->Table[place] != NoId && this->Facets[this->Table[place]].Points != ascending)
  {
    place = (place + 1) & mask;
  }
  return place;
}

void CavityWrapping::Grow()
{
  this->Table.assign(2 * this->Table.size(), NoId);
  for (std::size_t i = 0; i < this->Facets.size(); ++i)
  {
    this->Table[this->FindPlace(this->Facets[i].Points)] = static_cast<Id>(i);
  }
}

//--------------------------------------------------------------------------------------------------
/** The cells so far, and what is known of their facets. */
class CavityWrapping::Front
{
public:
  Front(CavityWrapping& wrapping, const Cavity& cavity, const CavityCellTest& accepts,
    std::vector<CavityCell>& cells)
    : State(wrapping), Input(cavity), Accepts(accepts), Output(cells),
      Apex(cavity.Points, cavity.Numbers)
  {
  }

  /** False: a wall has points that the cavity does not have. */
  bool MarkWalls()
  {
    for (const TriangleIds& wall : this->Input.Walls)
    {
      const TriangleIds facet = this->Input.FindCorners(wall);
      if (!this->IsThere(facet))
      {
        return false;
      }
      const Id side = this->State.GetSide(facet);
      this->State.GetBehind(side) = Wall;
      this->State.GetBehind(side ^ 1) = Wall;
    }
    return true;
  }

  /** Makes what is in front of each facet of the border. False: that is impossible. */
  bool StartAtBorder()
  {
    for (Id k = 0; k < static_cast<Id>(this->Input.Border.size()); ++k)
    {
      const TriangleIds facet = this->Input.FindCorners(this->Input.Border[k]);
      const Id side = this->IsThere(facet) ? this->State.GetSide(facet) : NoId;
      if (side == NoId || !this->TakeFront(side, this->Input.Regions[k], false))
      {
        return false;
      }
      this->State.GetBehind(side ^ 1) = k;
    }
    return true;
  }

  /** Goes inwards. False: two regions meet where no wall is, or the border is not closed. */
  bool Spread()
  {
    for (std::size_t k = 0; k < this->State.CellSides.size(); ++k)
    {
      const std::array<Id, 4> sides = this->State.CellSides[k];
      for (const Id side : sides)
      {
        if (this->State.GetBehind(side) == Open &&
          !this->TakeFront(side, this->Output[k].Region, true))
        {
          return false;
        }
      }
    }
    return true;
  }

  /** False: a wall is no facet of a Delaunay tetrahedron. Those of cells are. */
  bool CheckWalls()
  {
    return std::all_of(this->Input.Walls.begin(), this->Input.Walls.end(),
      [this](const TriangleIds& wall)
      {
        const TriangleIds facet = this->Input.FindCorners(wall);
        const Id side = this->State.GetSide(facet);
        return this->State.GetInner(side) != NoId || this->State.GetInner(side ^ 1) != NoId ||
          this->Apex.Find(facet, false) != NoId ||
          this->Apex.Find({ facet[0], facet[2], facet[1] }, false) != NoId;
      });
  }

  void Connect()
  {
    for (std::size_t k = 0; k < this->State.CellSides.size(); ++k)
    {
      for (int i = 0; i < 4; ++i)
      {
        const Id side = this->State.CellSides[k][i];
        const Id border = this->State.GetBehind(side);
        this->Output[k].Neighbors[i] =
          border >= 0 ? CavityCell::OutOf(border) : this->State.GetInner(side ^ 1);
      }
    }
  }

private:
  bool IsThere(const TriangleIds& facet) const
  {
    return *std::max_element(facet.begin(), facet.end()) <
      static_cast<Id>(this->Input.Numbers.size());
  }

  /**
   * Makes the tetrahedron in front of a facet a cell. False: there is none, it is one of another
   * region, or it is not accepted.
   * @param side of the facet that is behind it
   * @param isFacet whether the facet is known to be one of a Delaunay tetrahedron
   */
  bool TakeFront(Id side, Id region, bool isFacet)
  {
    const Id known = this->State.GetInner(side ^ 1);
    if (known != NoId)
    {
      return this->Output[known / 4].Region == region;
    }
    TriangleIds facet = this->State.Facets[side / 2].Points;
    if (side % 2 != 0)
    {
      std::swap(facet[1], facet[2]);
    }
    const Id apex = this->Apex.Find(facet, isFacet);
    if (apex == NoId)
    {
      return false;
    }
    const TetrahedronIds points{ facet[0], facet[1], facet[2], apex };
    const std::vector<Id>& numbers = this->Input.Numbers;
    const TetrahedronIds ids{ numbers[points[0]], numbers[points[1]], numbers[points[2]],
      numbers[points[3]] };
    if (this->Accepts && !this->Accepts(ids, region))
    {
      return false;
    }
    std::array<Id, 4> sides;
    for (int i = 0; i < 4; ++i)
    {
      sides[i] = i == 3 ? side ^ 1 : this->State.GetSide(GetFacet(points, i));
      this->State.GetInner(sides[i]) = 4 * static_cast<Id>(this->Output.size()) + i;
    }
    this->State.CellSides.push_back(sides);
    this->Output.push_back({ ids, region, { NoId, NoId, NoId, NoId } });
    return true;
  }

  CavityWrapping& State;
  const Cavity& Input;
  const CavityCellTest& Accepts;
  std::vector<CavityCell>& Output;
  FacetApex Apex;
};

//--------------------------------------------------------------------------------------------------
bool CavityWrapping::Run(
  const Cavity& cavity, const CavityCellTest& accepts, std::vector<CavityCell>& cells)
{
  this->Clear(cavity.Numbers.size());
  cells.clear();
  Front front(*this, cavity, accepts, cells);
  if (!front.MarkWalls() || !front.StartAtBorder() || !front.Spread() || !front.CheckWalls())
  {
    return false;
  }
  front.Connect();
  return true;
}
} // namespace cdm
