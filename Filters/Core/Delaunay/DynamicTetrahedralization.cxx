// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/DynamicTetrahedralization.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace cdm
{
DynamicTetrahedralization::DynamicTetrahedralization(TetMesh mesh)
  : Mesh(std::move(mesh)), Stamps(this->Mesh.Tetrahedra.size(), 0), NextStamp(1),
    PointTetrahedra(this->Mesh.Points.size(), NoId), Search(this->Mesh, this->PointTetrahedra)
{
  for (Id t = 0; t < this->GetNumberOfTetrahedra(); ++t)
  {
    for (Id point : this->Mesh.Tetrahedra[t])
    {
      this->PointTetrahedra[point] = t;
    }
  }
}

bool DynamicTetrahedralization::FindWholeStar(
  Id point, std::size_t most, std::vector<Id>& star) const
{
  star.assign(1, this->GetTetrahedronAt(point));
  for (std::size_t k = 0; k < star.size() && star.size() <= most; ++k)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[star[k]];
    for (int i = 0; i < 4; ++i)
    {
      const Id neighbor = this->Mesh.Neighbors[star[k]][i];
      if (neighbor != NoId && ids[i] != point && !Contains(star, neighbor / 4))
      {
        star.push_back(neighbor / 4);
      }
    }
  }
  return star.size() <= most;
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
  this->Note(t);
  return t;
}

void DynamicTetrahedralization::Note(Id tetrahedron)
{
  constexpr std::size_t fewestNotes = 1 << 14;
  if (this->Noted.size() > std::max(fewestNotes, this->Mesh.Tetrahedra.size() / 2))
  {
    const auto dropped = static_cast<std::ptrdiff_t>(this->Noted.size() / 2);
    this->Noted.erase(this->Noted.begin(), this->Noted.begin() + dropped);
    this->FirstNoted += dropped;
  }
  this->Noted.push_back(tetrahedron);
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
  this->Facets.Start(3 * cavity.Facets.size() / 2);
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
      const Id one = 4 * t + k;
      const Id other = this->Facets.Match(MakeEdge(facet[(k + 1) % 3], facet[(k + 2) % 3]), one);
      if (other != NoId)
      {
        this->Mesh.Neighbors[t][k] = other;
        this->Mesh.Neighbors[other / 4][other % 4] = one;
      }
    }
  }
}

void DynamicTetrahedralization::FacetsAtEdges::Start(std::size_t numberOfEdges)
{
  // At most half of the places are used.
  std::size_t size = 64;
  while (size < 2 * numberOfEdges)
  {
    size *= 2;
  }
  this->Places.assign(size, { NoEdge, NoId });
}

Id DynamicTetrahedralization::FacetsAtEdges::Match(const EdgeIds& edge, Id facet)
{
  const std::uint64_t key = PackIds(edge);
  const std::size_t mask = this->Places.size() - 1;
  std::size_t place = (key * 0x9E3779B97F4A7C15ULL >> 32) & mask;
  while (this->Places[place].first != NoEdge && this->Places[place].first != key)
  {
    place = (place + 1) & mask;
  }
  const Id other = this->Places[place].second;
  this->Places[place] = { key, facet };
  return other;
}

void DynamicTetrahedralization::ReservePoints(Id first, Id count)
{
  this->Mesh.Points.insert(this->Mesh.Points.begin() + first, count, Vec3());
  this->PointTetrahedra.insert(this->PointTetrahedra.begin() + first, count, NoId);
  for (TetrahedronIds& ids : this->Mesh.Tetrahedra)
  {
    for (Id& id : ids)
    {
      id += id >= first ? count : 0;
    }
  }
  this->RemovedStar.clear();
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
  if (!this->Search.LeaveOut(point))
  {
    return false;
  }
  this->Search.TakeBack();
  this->Remove(point, this->Search.GetStar(), this->Search.GetCells());
  return true;
}

void DynamicTetrahedralization::Remove(
  Id point, const std::vector<Id>& star, const std::vector<CavityCell>& cells)
{
  std::vector<Id> outer;
  this->RemovedStar.clear();
  this->FormerlyFree = this->Free.size();
  for (const Id t : star)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
    outer.push_back(
      this->Mesh.Neighbors[t][std::find(ids.begin(), ids.end(), point) - ids.begin()]);
    this->RemovedStar.push_back({ t, ids, this->Mesh.Neighbors[t], this->Stamps[t] });
    this->RemovedRegion = this->Mesh.Regions[t];
  }
  this->Replace(star, outer, cells);
  this->PointTetrahedra[point] = NoId;
}

void DynamicTetrahedralization::NumberCells(Id firstCell, PointCavity& cavity) const
{
  const auto number = [&](Id& id, Id perTetrahedron)
  {
    const Id cell = id / perTetrahedron - firstCell;
    id = id == NoId || cell < 0 ? id : perTetrahedron * this->Changed[cell] + id % perTetrahedron;
  };
  std::for_each(cavity.Tetrahedra.begin(), cavity.Tetrahedra.end(), [&](Id& t) { number(t, 1); });
  std::for_each(cavity.Inner.begin(), cavity.Inner.end(), [&](Id& facet) { number(facet, 4); });
  std::for_each(cavity.Outer.begin(), cavity.Outer.end(), [&](Id& facet) { number(facet, 4); });
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

void DynamicTetrahedralization::MakeOuter(Id facet)
{
  const Id t = facet / 4;
  this->Mesh.Neighbors[t][facet % 4] = NoId;
  // What lay beyond may be the tetrahedron that is known at these points.
  for (Id point : GetFacet(this->Mesh.Tetrahedra[t], facet % 4))
  {
    this->PointTetrahedra[point] = t;
  }
}

void DynamicTetrahedralization::Replace(const std::vector<Id>& tetrahedra,
  const std::vector<Id>& outer, const std::vector<CavityCell>& cells)
{
  for (auto t = tetrahedra.rbegin(); t != tetrahedra.rend(); ++t)
  {
    this->Kill(*t);
  }
  this->Changed.clear();
  for (const CavityCell& cell : cells)
  {
    this->Make(cell.Ids, cell.Region);
  }
  for (std::size_t k = 0; k < this->Changed.size(); ++k)
  {
    const Id made = this->Changed[k];
    for (int i = 0; i < 4; ++i)
    {
      const Id inner = cells[k].Neighbors[i];
      const Id facet = CavityCell::GetBorderFacet(inner);
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
