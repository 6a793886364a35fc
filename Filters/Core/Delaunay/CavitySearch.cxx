// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/CavitySearch.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/PulledSphere.h"

#include <algorithm>

namespace cdm
{
bool CavitySearch::IsBoundary(Id tetrahedron, int facet) const
{
  const Id neighbor = this->GetNeighbor(tetrahedron, facet);
  return neighbor == NoId || this->GetRegion(neighbor / 4) != this->GetRegion(tetrahedron);
}

std::uint32_t CavitySearch::StartSearch()
{
  // The mesh may have grown.
  const std::size_t size = this->Mesh.Tetrahedra.size() + this->CellNeighbors.size();
  if (this->Marks.size() < size)
  {
    this->Marks.resize(size, 0);
  }
  this->Search += 2;
  if (this->Search >= FirstHidden)
  {
    for (std::uint32_t& mark : this->Marks)
    {
      mark = mark >= FirstHidden ? mark : 0;
    }
    this->FirstOfRecord = 2;
    this->Search = 4;
  }
  return this->Search;
}

void CavitySearch::StartRecord()
{
  if (!this->IsRecording)
  {
    return;
  }
  this->Visited.clear();
  this->FirstOfRecord = this->StartSearch();
}

bool CavitySearch::FindStar(Id point, std::vector<Id>& star)
{
  const std::uint32_t search = this->StartSearch();
  bool isInside = true;
  star.assign(1, this->PointTetrahedra[point]);
  this->Visit(star[0]);
  this->Marks[star[0]] = search;
  for (std::size_t i = 0; i < star.size(); ++i)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      if (this->Mesh.Tetrahedra[star[i]][facet] == point)
      {
        continue;
      }
      if (this->IsBoundary(star[i], facet))
      {
        isInside = false;
        continue;
      }
      const Id neighbor = this->Mesh.Neighbors[star[i]][facet] / 4;
      if (this->Marks[neighbor] != search)
      {
        this->Visit(neighbor);
        this->Marks[neighbor] = search;
        star.push_back(neighbor);
      }
    }
  }
  return isInside;
}

Id CavitySearch::Locate(const Vec3& position, Id first)
{
  Id t = first;
  int from = -1;
  for (std::size_t step = 0; step < this->Mesh.Tetrahedra.size(); ++step)
  {
    this->Visit(t);
    const TetrahedronIds& ids = this->GetIds(t);
    int next = -1;
    for (int i = 0; i < 4 && next < 0; ++i)
    {
      const int* const facet = FacetVertices[i];
      if (i != from &&
        Orientation(this->Mesh.Points[ids[facet[0]]], this->Mesh.Points[ids[facet[1]]],
          this->Mesh.Points[ids[facet[2]]], position) > 0)
      {
        next = i;
      }
    }
    if (next < 0)
    {
      return t;
    }
    if (this->IsBoundary(t, next))
    {
      return NoId;
    }
    const Id neighbor = this->GetNeighbor(t, next);
    t = neighbor / 4;
    from = neighbor % 4;
  }
  return NoId;
}

bool CavitySearch::IsInConflict(Id tetrahedron, const Vec3& position, Id number) const
{
  const TetrahedronIds& ids = this->GetIds(tetrahedron);
  const Vec3* const points = this->Mesh.Points.data();
  const int side =
    InSphere(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]], position);
  return side != 0
    ? side > 0
    : GetPulledPosition(GetCorners(this->Mesh.Points, ids), ids, position, number, Orientation) > 0;
}

bool CavitySearch::IsAroundCavity(Id facet, const Vec3& position, Id number)
{
  const Id outer = this->GetNeighbor(facet / 4, facet % 4);
  this->Visit(facet / 4);
  if (outer != NoId)
  {
    this->Visit(outer / 4);
  }
  return this->IsInConflict(facet / 4, position, number) &&
    (outer == NoId || !this->IsInConflict(outer / 4, position, number));
}

/** Whether all facets around a cavity are in front of the position. */
bool CavitySearch::IsVisible(const PointCavity& cavity, const Vec3& position) const
{
  return std::all_of(cavity.Facets.begin(), cavity.Facets.end(),
    [&](const TriangleIds& facet)
    {
      return Orientation(this->Mesh.Points[facet[0]], this->Mesh.Points[facet[1]],
               this->Mesh.Points[facet[2]], position) > 0;
    });
}

bool CavitySearch::LeaveOut(Id point)
{
  if (!this->FindStar(point, this->Star))
  {
    return false;
  }
  Cavity& cavity = this->Around;
  cavity.Clear();
  this->Beyond.clear();
  for (const Id t : this->Star)
  {
    const TetrahedronIds& vertices = this->Mesh.Tetrahedra[t];
    const int i =
      static_cast<int>(std::find(vertices.begin(), vertices.end(), point) - vertices.begin());
    const TriangleIds facet = GetFacet(vertices, i);
    cavity.Border.push_back({ facet[0], facet[2], facet[1] });
    this->Beyond.push_back(this->Mesh.Neighbors[t][i]);
    cavity.Numbers.insert(cavity.Numbers.end(), facet.begin(), facet.end());
  }
  SortUnique(cavity.Numbers);
  cavity.Points.reserve(cavity.Numbers.size());
  for (const Id id : cavity.Numbers)
  {
    cavity.Points.push_back(this->Mesh.Points[id]);
  }
  this->HiddenRegion = this->Mesh.Regions[this->Star.front()];
  cavity.Regions.assign(cavity.Border.size(), this->HiddenRegion);
  if (!this->Filling.Run(cavity))
  {
    return false;
  }
  this->Substitutes.assign(this->Star.size(), NoId);
  this->CellNeighbors.clear();
  const Id first = this->GetFirstCell();
  for (const CavityCell& cell : this->GetCells())
  {
    std::array<Id, 4> neighbors;
    for (int i = 0; i < 4; ++i)
    {
      const Id inner = cell.Neighbors[i];
      const Id facet = CavityCell::GetBorderFacet(inner);
      neighbors[i] = facet >= 0 ? this->Beyond[facet] : 4 * first + inner;
      if (facet >= 0)
      {
        this->Substitutes[facet] = 4 * (first + static_cast<Id>(this->CellNeighbors.size())) + i;
      }
    }
    this->CellNeighbors.push_back(neighbors);
  }
  for (std::size_t i = 0; i < this->Star.size(); ++i)
  {
    this->Marks[this->Star[i]] = FirstHidden + static_cast<std::uint32_t>(i);
  }
  return true;
}

void CavitySearch::TakeBack()
{
  for (const Id t : this->Star)
  {
    this->Marks[t] = this->FirstOfRecord;
  }
  this->CellNeighbors.clear();
}
} // namespace cdm
