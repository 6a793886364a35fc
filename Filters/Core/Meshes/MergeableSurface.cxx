// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/MergeableSurface.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>
#include <utility>

namespace cdm
{
MergeableSurface::MergeableSurface(TriangleMesh& surface)
  : Surface(surface), Uses(surface.Points.size()), IsAlive(surface.Triangles.size(), 1)
{
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    for (const Id point : surface.Triangles[t])
    {
      this->Uses[point].push_back(static_cast<Id>(t));
    }
  }
}

bool MergeableSurface::Has(Id triangle, Id point) const
{
  const TriangleIds& ids = this->Surface.Triangles[triangle];
  return Contains(ids, point);
}

std::vector<Id> MergeableSurface::GetNeighbors(Id point) const
{
  std::vector<std::pair<double, Id>> neighbors;
  for (const Id t : this->Uses[point])
  {
    for (const Id id : this->Surface.Triangles[t])
    {
      if (id != point)
      {
        neighbors.emplace_back(Distance(this->Surface.Points[id], this->Surface.Points[point]), id);
      }
    }
  }
  SortUnique(neighbors);
  std::vector<Id> ids;
  ids.reserve(neighbors.size());
  for (const auto& neighbor : neighbors)
  {
    ids.push_back(neighbor.second);
  }
  return ids;
}

bool MergeableSurface::AreNeighbors(Id a, Id b) const
{
  return std::any_of(
    this->Uses[a].begin(), this->Uses[a].end(), [&](Id t) { return this->Has(t, b); });
}

bool MergeableSurface::KeepsTopology(Id point, Id target) const
{
  std::vector<Id> apexes;
  for (const Id t : this->Uses[point])
  {
    if (this->Has(t, target))
    {
      const TriangleIds& ids = this->Surface.Triangles[t];
      apexes.push_back(ids[0] + ids[1] + ids[2] - point - target);
    }
  }
  std::sort(apexes.begin(), apexes.end());
  if (std::adjacent_find(apexes.begin(), apexes.end()) != apexes.end())
  {
    return false;
  }
  for (const Id t : this->Uses[target])
  {
    if (this->Has(t, point))
    {
      continue;
    }
    int common = 0;
    for (const Id id : this->Surface.Triangles[t])
    {
      const bool isCommon = id != target && this->AreNeighbors(id, point);
      if (isCommon && !std::binary_search(apexes.begin(), apexes.end(), id))
      {
        return false;
      }
      common += isCommon;
    }
    // A triangle of the point that would become equal to this one.
    const auto hasSameEdge = [&](Id other)
    {
      const TriangleIds& ids = this->Surface.Triangles[t];
      return std::all_of(
        ids.begin(), ids.end(), [&](Id id) { return id == target || this->Has(other, id); });
    };
    if (common == 2 && std::any_of(this->Uses[point].begin(), this->Uses[point].end(), hasSameEdge))
    {
      return false;
    }
  }
  return true;
}

void MergeableSurface::Merge(Id point, Id target)
{
  for (const Id t : this->Uses[point])
  {
    TriangleIds& ids = this->Surface.Triangles[t];
    if (!this->Has(t, target))
    {
      std::replace(ids.begin(), ids.end(), point, target);
      this->Uses[target].push_back(t);
      continue;
    }
    this->IsAlive[t] = 0;
    for (const Id id : ids)
    {
      if (id != point)
      {
        std::vector<Id>& uses = this->Uses[id];
        uses.erase(std::find(uses.begin(), uses.end(), t));
      }
    }
  }
  this->Uses[point].clear();
}

void MergeableSurface::Finish()
{
  std::size_t count = 0;
  for (std::size_t t = 0; t < this->IsAlive.size(); ++t)
  {
    if (this->IsAlive[t])
    {
      this->Surface.Triangles[count] = this->Surface.Triangles[t];
      this->Surface.Labels[count] = this->Surface.Labels[t];
      ++count;
    }
  }
  this->Surface.Triangles.resize(count);
  this->Surface.Labels.resize(count);
  this->Surface.SourceCells.clear();
}
} // namespace cdm
