// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartRegions.h"

#include "Core/Basics/SortedIds.h"
#include <algorithm>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
/** Whether two orders of the same three points have the same orientation. */
bool TurnAlike(const TriangleIds& s, const TriangleIds& t)
{
  const int first = static_cast<int>(std::find(t.begin(), t.end(), s[0]) - t.begin());
  return t[(first + 1) % 3] == s[1];
}
} // namespace

PartRegions::PartRegions(const TetMesh& mesh, Id numberOfOwnPoints,
  const std::vector<TriangleIds>& triangles, const std::vector<RegionPair>& regions)
  : Mesh(mesh), NumberOfOwnPoints(numberOfOwnPoints), Triangles(triangles), Regions(regions),
    SideFacets(2 * triangles.size(), NoId), Barriers(mesh.Tetrahedra.size(), 0),
    ComponentOf(mesh.Tetrahedra.size(), NoId)
{
}

Status PartRegions::FindFacets()
{
  std::vector<std::pair<TriangleIds, Id>> places;
  std::vector<char> isOnSurface(this->Mesh.Points.size(), 0);
  for (std::size_t i = 0; i < this->Triangles.size(); ++i)
  {
    places.emplace_back(Sorted(this->Triangles[i]), static_cast<Id>(i));
    for (Id point : this->Triangles[i])
    {
      isOnSurface[point] = 1;
    }
  }
  std::sort(places.begin(), places.end());
  for (std::size_t t = 0; t < this->Mesh.Tetrahedra.size(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      const TriangleIds facet = GetFacet(this->Mesh.Tetrahedra[t], i);
      if (!isOnSurface[facet[0]] || !isOnSurface[facet[1]] || !isOnSurface[facet[2]])
      {
        continue;
      }
      const auto place =
        std::lower_bound(places.begin(), places.end(), std::make_pair(Sorted(facet), Id(0)));
      if (place != places.end() && place->first == Sorted(facet))
      {
        // The tetrahedron lies behind its outward facet.
        const bool isInFront = !TurnAlike(this->Triangles[place->second], facet);
        this->SideFacets[2 * place->second + (isInFront ? 0 : 1)] = static_cast<Id>(4 * t + i);
        this->Barriers[t] = static_cast<unsigned char>(this->Barriers[t] | (1u << i));
      }
    }
  }
  std::vector<Id> missing;
  for (std::size_t i = 0; i < this->Triangles.size(); ++i)
  {
    if (this->SideFacets[2 * i] == NoId && this->SideFacets[2 * i + 1] == NoId &&
      this->HasOwnPoint(this->Triangles[i]))
    {
      missing.push_back(static_cast<Id>(i));
    }
  }
  if (!missing.empty())
  {
    const std::string count = std::to_string(missing.size());
    return Status::Failure(StatusCode::NotDelaunay,
      count +
        " triangles of the surface are not Delaunay; refine the surface with "
        "the surface refiner first (together with the mesh points, if there are any).",
      std::move(missing));
  }
  return {};
}

bool PartRegions::HasOwnPoint(const TriangleIds& ids) const
{
  return std::min({ ids[0], ids[1], ids[2] }) < this->NumberOfOwnPoints;
}

void PartRegions::FindComponents()
{
  std::vector<Id> front;
  for (std::size_t first = 0; first < this->ComponentOf.size(); ++first)
  {
    if (this->ComponentOf[first] != NoId)
    {
      continue;
    }
    const Id component = static_cast<Id>(this->Components.size());
    this->Components.push_back({ OutsideRegion, false, false });
    this->ComponentOf[first] = component;
    front.assign(1, static_cast<Id>(first));
    while (!front.empty())
    {
      const Id t = front.back();
      front.pop_back();
      for (int i = 0; i < 4; ++i)
      {
        const Id beyond = this->Mesh.Neighbors[t][i];
        if (beyond != NoId && (this->Barriers[t] >> i & 1) == 0 &&
          this->ComponentOf[beyond / 4] == NoId)
        {
          this->ComponentOf[beyond / 4] = component;
          front.push_back(beyond / 4);
        }
      }
    }
  }
}

Status PartRegions::SetRegionOfComponent(Id component, Id region, Id triangle)
{
  Component& item = this->Components[component];
  if (item.IsKnown && item.Region != region)
  {
    return Status::Failure(StatusCode::NotClosed,
      "Regions " + std::to_string(std::min(item.Region, region)) + " and " +
        std::to_string(std::max(item.Region, region)) +
        " are not separated by the surface, or its BoundaryLabels contradict each other. Close the "
        "surface or correct the labels.",
      triangle == NoId ? std::vector<Id>() : std::vector<Id>{ triangle });
  }
  item.IsNews = item.IsNews || !item.IsKnown;
  item.IsKnown = true;
  item.Region = region;
  return {};
}

Status PartRegions::Start()
{
  Status status = this->FindFacets();
  if (!status.IsOk())
  {
    return status;
  }
  this->FindComponents();
  for (std::size_t side = 0; side < this->SideFacets.size() && status.IsOk(); ++side)
  {
    const RegionPair& regions = this->Regions[side / 2];
    const Id region = side % 2 == 0 ? regions.Front : regions.Back;
    if (this->SideFacets[side] != NoId && region != Unknown)
    {
      status = this->SetRegionOfComponent(
        this->ComponentOf[this->SideFacets[side] / 4], region, static_cast<Id>(side / 2));
    }
  }
  return status;
}

std::vector<Id> PartRegions::TakeNews(const std::vector<Id>& tetrahedra)
{
  std::vector<Id> news;
  for (Id t : tetrahedra)
  {
    if (this->Components[this->ComponentOf[t]].IsNews)
    {
      news.push_back(t);
    }
  }
  for (Component& component : this->Components)
  {
    component.IsNews = false;
  }
  return news;
}

Status PartRegions::SetRegion(Id tetrahedron, Id region)
{
  return this->SetRegionOfComponent(this->ComponentOf[tetrahedron], region, NoId);
}

Status PartRegions::Finish(RawVector<Id>& regions) const
{
  regions.clear();
  for (std::size_t t = 0; t < this->ComponentOf.size(); ++t)
  {
    const Component& component = this->Components[this->ComponentOf[t]];
    for (int i = 0; i < 4 && component.Region != OutsideRegion; ++i)
    {
      const TriangleIds facet = GetFacet(this->Mesh.Tetrahedra[t], i);
      if (this->Mesh.Neighbors[t][i] == NoId && (this->Barriers[t] >> i & 1) == 0 &&
        this->HasOwnPoint(facet))
      {
        return Status::Failure(StatusCode::NotClosed,
          "Region " + std::to_string(component.Region) +
            " is not closed: it reaches the convex hull of the points. Close the surface or "
            "correct "
            "its BoundaryLabels.");
      }
    }
    regions.push_back(component.Region);
  }
  return {};
}
} // namespace cdm
