// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceCoarsening.h"

#include "Predicates.h"
#include "TriangleIntersection.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace cdm
{
namespace
{
class Coarsening
{
public:
  Coarsening(double flatness, TriangleMesh& surface)
    : Flatness(flatness), Surface(surface), Uses(surface.Points.size()),
      IsAlive(surface.Triangles.size(), 1)
  {
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      for (const Id point : surface.Triangles[t])
      {
        this->Uses[point].push_back(static_cast<Id>(t));
      }
    }
  }

  void Run(const std::vector<char>& isRemovable)
  {
    std::deque<Id> queue;
    for (std::size_t point = 0; point < isRemovable.size(); ++point)
    {
      if (isRemovable[point])
      {
        queue.push_back(static_cast<Id>(point));
      }
    }
    while (!queue.empty())
    {
      const Id point = queue.front();
      queue.pop_front();
      const std::vector<Id> neighbors = this->GetNeighbors(point);
      const auto target = std::find_if(neighbors.begin(), neighbors.end(),
        [&](Id neighbor) { return this->MayMerge(point, neighbor); });
      if (target == neighbors.end())
      {
        continue;
      }
      this->Merge(point, *target);
      for (const Id neighbor : neighbors)
      {
        if (isRemovable[neighbor])
        {
          queue.push_back(neighbor);
        }
      }
    }
    this->WriteTriangles();
  }

private:
  bool Has(Id triangle, Id point) const
  {
    const TriangleIds& ids = this->Surface.Triangles[triangle];
    return std::find(ids.begin(), ids.end(), point) != ids.end();
  }

  /** Nearest first, of equal distance by id. */
  std::vector<Id> GetNeighbors(Id point) const
  {
    std::vector<std::pair<double, Id>> neighbors;
    for (const Id t : this->Uses[point])
    {
      for (const Id id : this->Surface.Triangles[t])
      {
        if (id != point)
        {
          neighbors.emplace_back(
            Distance(this->Surface.Points[id], this->Surface.Points[point]), id);
        }
      }
    }
    std::sort(neighbors.begin(), neighbors.end());
    neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
    std::vector<Id> ids;
    for (const auto& neighbor : neighbors)
    {
      ids.push_back(neighbor.second);
    }
    return ids;
  }

  bool MayMerge(Id point, Id target) const
  {
    const std::vector<Vec3>& points = this->Surface.Points;
    std::vector<Id> apexes;
    for (const Id t : this->Uses[point])
    {
      const TriangleIds& ids = this->Surface.Triangles[t];
      if (this->Has(t, target))
      {
        apexes.push_back(ids[0] + ids[1] + ids[2] - point - target);
        continue;
      }
      const Vec3 normal = Cross(points[ids[1]] - points[ids[0]], points[ids[2]] - points[ids[0]]);
      if (std::abs(Dot(normal, points[target] - points[ids[0]])) > this->Flatness * Norm(normal))
      {
        return false;
      }
      TriangleIds merged = ids;
      std::replace(merged.begin(), merged.end(), point, target);
      int sign = 0;
      const int axis = FindProjectionAxis(points[ids[0]], points[ids[1]], points[ids[2]], sign);
      if (ProjectedOrientation(axis, points[merged[0]], points[merged[1]], points[merged[2]]) !=
        sign)
      {
        return false;
      }
    }
    // Whatever else is next to both would be folded onto itself.
    std::sort(apexes.begin(), apexes.end());
    for (const Id t : this->Uses[target])
    {
      for (const Id id : this->Surface.Triangles[t])
      {
        const bool isCommon = id != point && id != target && this->AreNeighbors(id, point);
        if (isCommon && !std::binary_search(apexes.begin(), apexes.end(), id))
        {
          return false;
        }
      }
    }
    return std::adjacent_find(apexes.begin(), apexes.end()) == apexes.end();
  }

  bool AreNeighbors(Id a, Id b) const
  {
    return std::any_of(
      this->Uses[a].begin(), this->Uses[a].end(), [&](Id t) { return this->Has(t, b); });
  }

  void Merge(Id point, Id target)
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

  void WriteTriangles()
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

  const double Flatness;
  TriangleMesh& Surface;
  /** Triangles of each point. */
  std::vector<std::vector<Id>> Uses;
  std::vector<char> IsAlive;
};
} // namespace

void CoarsenSurface(const std::vector<char>& isRemovable, double flatness, TriangleMesh& surface)
{
  Coarsening(flatness, surface).Run(isRemovable);
}
} // namespace cdm
