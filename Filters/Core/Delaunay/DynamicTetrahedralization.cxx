// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/DynamicTetrahedralization.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/PulledSphere.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace cdm
{
DynamicTetrahedralization::DynamicTetrahedralization(TetMesh mesh)
  : Mesh(std::move(mesh)), Stamps(this->Mesh.Tetrahedra.size(), 0), NextStamp(1),
    PointTetrahedra(this->Mesh.Points.size(), NoId), Marks(this->Mesh.Tetrahedra.size(), 0)
{
  for (Id t = 0; t < this->GetNumberOfTetrahedra(); ++t)
  {
    for (Id point : this->Mesh.Tetrahedra[t])
    {
      this->PointTetrahedra[point] = t;
    }
  }
}

bool DynamicTetrahedralization::IsBoundary(Id tetrahedron, int facet) const
{
  const Id neighbor = this->Mesh.Neighbors[tetrahedron][facet];
  return neighbor == NoId || this->Mesh.Regions[neighbor / 4] != this->Mesh.Regions[tetrahedron];
}

std::uint32_t DynamicTetrahedralization::StartSearch()
{
  this->Search += 2;
  if (this->Search == 0)
  {
    std::fill(this->Marks.begin(), this->Marks.end(), 0);
    this->Search = 2;
  }
  return this->Search;
}

bool DynamicTetrahedralization::FindStar(Id point, std::vector<Id>& star)
{
  const std::uint32_t search = this->StartSearch();
  bool isInside = true;
  star.assign(1, this->PointTetrahedra[point]);
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
        this->Marks[neighbor] = search;
        star.push_back(neighbor);
      }
    }
  }
  return isInside;
}

Id DynamicTetrahedralization::Locate(const Vec3& position, Id first) const
{
  Id t = first;
  int from = -1;
  for (Id step = 0; step < this->GetNumberOfTetrahedra(); ++step)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
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
    const Id neighbor = this->Mesh.Neighbors[t][next];
    t = neighbor / 4;
    from = neighbor % 4;
  }
  return NoId;
}

bool DynamicTetrahedralization::IsInConflict(Id tetrahedron, const Vec3& position, Id number) const
{
  const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
  const std::array<Vec3, 4> vertices = cdm::GetCorners(this->Mesh.Points, ids);
  const int side = InSphere(vertices[0], vertices[1], vertices[2], vertices[3], position);
  return side != 0 ? side > 0 : GetPulledPosition(vertices, ids, position, number, Orientation) > 0;
}

bool DynamicTetrahedralization::FindCavity(
  const Vec3& position, Id number, Id first, PointCavity& cavity)
{
  return this->FindCavity(position, number, first, cavity, [](const TriangleIds&) { return true; });
}

/** Whether all facets around a cavity are in front of the position. */
bool DynamicTetrahedralization::IsVisible(const PointCavity& cavity, const Vec3& position) const
{
  return std::all_of(cavity.Facets.begin(), cavity.Facets.end(),
    [&](const TriangleIds& facet)
    {
      return Orientation(this->Mesh.Points[facet[0]], this->Mesh.Points[facet[1]],
               this->Mesh.Points[facet[2]], position) > 0;
    });
}

Id DynamicTetrahedralization::Make(const TetrahedronIds& ids, Id region)
{
  Id t = NoId;
  if (this->Free.empty())
  {
    t = this->GetNumberOfTetrahedra();
    this->Mesh.Tetrahedra.push_back(ids);
    this->Mesh.Neighbors.push_back({ NoId, NoId, NoId, NoId });
    this->Mesh.Regions.push_back(region);
    this->Stamps.push_back(0);
    this->Marks.push_back(0);
  }
  else
  {
    t = this->Free.back();
    this->Free.pop_back();
    this->Mesh.Tetrahedra[t] = ids;
    this->Mesh.Regions[t] = region;
  }
  this->Stamps[t] = this->NextStamp++;
  for (Id point : ids)
  {
    this->PointTetrahedra[point] = t;
  }
  this->Changed.push_back(t);
  return t;
}

void DynamicTetrahedralization::Kill(Id tetrahedron)
{
  this->Mesh.Tetrahedra[tetrahedron][0] = NoId;
  this->Stamps[tetrahedron] = this->NextStamp++;
  this->Free.push_back(tetrahedron);
}

void DynamicTetrahedralization::Fill(Id point, const PointCavity& cavity)
{
  const Id region = this->Mesh.Regions[cavity.Tetrahedra.front()];
  for (auto t = cavity.Tetrahedra.rbegin(); t != cavity.Tetrahedra.rend(); ++t)
  {
    this->Kill(*t);
  }
  this->Changed.clear();
  // New tetrahedra meet in the facets through the point and an edge of the cavity.
  this->Facets.clear();
  for (std::size_t i = 0; i < cavity.Facets.size(); ++i)
  {
    const TriangleIds& facet = cavity.Facets[i];
    const Id t = this->Make({ facet[0], facet[1], facet[2], point }, region);
    const Id outer = cavity.Outer[i];
    this->Mesh.Neighbors[t][3] = outer;
    if (outer != NoId)
    {
      this->Mesh.Neighbors[outer / 4][outer % 4] = 4 * t + 3;
    }
    for (int k = 0; k < 3; ++k)
    {
      const auto [a, b] = std::minmax(facet[(k + 1) % 3], facet[(k + 2) % 3]);
      this->Facets.emplace_back(static_cast<std::uint64_t>(a) << 32 | b, 4 * t + k);
    }
  }
  std::sort(this->Facets.begin(), this->Facets.end());
  for (std::size_t i = 0; i + 1 < this->Facets.size(); i += 2)
  {
    const Id one = this->Facets[i].second;
    const Id other = this->Facets[i + 1].second;
    this->Mesh.Neighbors[one / 4][one % 4] = other;
    this->Mesh.Neighbors[other / 4][other % 4] = one;
  }
}

Id DynamicTetrahedralization::Insert(const Vec3& position, const PointCavity& cavity)
{
  const Id point = this->GetNumberOfPoints();
  this->Mesh.Points.push_back(position);
  this->PointTetrahedra.push_back(NoId);
  this->Fill(point, cavity);
  return point;
}

void DynamicTetrahedralization::Restore(Id point, const Vec3& position, const PointCavity& cavity)
{
  this->Mesh.Points[point] = position;
  this->Fill(point, cavity);
}

bool DynamicTetrahedralization::Remove(Id point)
{
  if (!this->FindStar(point, this->Star))
  {
    return false;
  }
  this->RemovedStar.clear();
  this->RemovedRegion = this->Mesh.Regions[this->Star.front()];
  this->FormerlyFree = this->Free.size();
  Cavity cavity;
  std::vector<Id> outer;
  for (Id t : this->Star)
  {
    const TetrahedronIds& vertices = this->Mesh.Tetrahedra[t];
    const int i =
      static_cast<int>(std::find(vertices.begin(), vertices.end(), point) - vertices.begin());
    const TriangleIds facet = GetFacet(vertices, i);
    cavity.Border.push_back({ facet[0], facet[2], facet[1] });
    outer.push_back(this->Mesh.Neighbors[t][i]);
    cavity.Numbers.insert(cavity.Numbers.end(), facet.begin(), facet.end());
    this->RemovedStar.push_back({ t, vertices, this->Mesh.Neighbors[t], this->Stamps[t] });
  }
  SortUnique(cavity.Numbers);
  cavity.Points.reserve(cavity.Numbers.size());
  for (Id id : cavity.Numbers)
  {
    cavity.Points.push_back(this->Mesh.Points[id]);
  }
  cavity.Regions.assign(cavity.Border.size(), this->RemovedRegion);
  if (!this->Filling.Run(cavity))
  {
    return false;
  }
  this->Replace(this->Star, outer, this->Filling.GetCells());
  this->PointTetrahedra[point] = NoId;
  return true;
}

void DynamicTetrahedralization::UndoRemove()
{
  for (Id t : this->Changed)
  {
    this->Mesh.Tetrahedra[t][0] = NoId;
    this->Stamps[t] = this->NextStamp++;
  }
  for (const Removed& removed : this->RemovedStar)
  {
    const Id t = removed.Tetrahedron;
    this->Mesh.Tetrahedra[t] = removed.Ids;
    this->Mesh.Neighbors[t] = removed.Neighbors;
    this->Mesh.Regions[t] = this->RemovedRegion;
    this->Stamps[t] = removed.Stamp;
    for (int i = 0; i < 4; ++i)
    {
      this->PointTetrahedra[removed.Ids[i]] = t;
      const Id neighbor = removed.Neighbors[i];
      if (neighbor != NoId)
      {
        this->Mesh.Neighbors[neighbor / 4][neighbor % 4] = 4 * t + i;
      }
    }
  }
  this->Free.resize(std::min(this->Free.size(), this->FormerlyFree));
  std::copy_if(this->Changed.begin(), this->Changed.end(), std::back_inserter(this->Free),
    [this](Id t) { return this->IsDead(t); });
  this->Changed.clear();
}

void DynamicTetrahedralization::Replace(const std::vector<Id>& tetrahedra,
  const std::vector<Id>& outer, const std::vector<CavityFilling::Cell>& cells)
{
  for (auto t = tetrahedra.rbegin(); t != tetrahedra.rend(); ++t)
  {
    this->Kill(*t);
  }
  this->Changed.clear();
  for (const CavityFilling::Cell& cell : cells)
  {
    this->Make(cell.Ids, cell.Region);
  }
  for (std::size_t k = 0; k < this->Changed.size(); ++k)
  {
    const Id made = this->Changed[k];
    for (int i = 0; i < 4; ++i)
    {
      const Id inner = cells[k].Neighbors[i];
      const Id facet = CavityFilling::GetBorderFacet(inner);
      Id& neighbor = this->Mesh.Neighbors[made][i];
      neighbor = facet >= 0 ? outer[facet]
        : inner == NoId     ? NoId
                            : 4 * this->Changed[inner / 4] + inner % 4;
      if (facet >= 0 && neighbor != NoId)
      {
        this->Mesh.Neighbors[neighbor / 4][neighbor % 4] = 4 * made + i;
      }
    }
  }
}
} // namespace cdm
