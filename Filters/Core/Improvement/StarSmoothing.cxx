// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/StarSmoothing.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/PlaceSearch.h"

#include <algorithm>
#include <array>

namespace cdm
{
namespace
{
/** All tetrahedra at a point; false if it lies on a border. */
bool FindStar(const FlippableMesh& mesh, Id point, Id first, std::vector<Id>& star)
{
  star.assign(1, first);
  for (std::size_t i = 0; i < star.size(); ++i)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      if (mesh.GetMesh().Tetrahedra[star[i]][facet] == point)
      {
        continue;
      }
      const Id neighbor = mesh.GetMesh().Neighbors[star[i]][facet];
      if (neighbor == NoId || mesh.GetMesh().Regions[neighbor / 4] != mesh.GetMesh().Regions[first])
      {
        return false;
      }
      if (!Contains(star, neighbor / 4))
      {
        star.push_back(neighbor / 4);
      }
    }
  }
  return true;
}

/** The best position for a point within the tetrahedra around it, which stay. */
bool FindBetterPosition(
  const FlippableMesh& mesh, Id point, const std::vector<Id>& star, Vec3& position)
{
  const Vec3 old = mesh.GetPoint(point);
  double smallest = 180.0;
  double nearest = Infinity;
  Vec3 sum;
  for (const Id other : star)
  {
    smallest = std::min(smallest, mesh.GetAngle(other));
    for (const Id id : mesh.GetMesh().Tetrahedra[other])
    {
      if (id != point)
      {
        nearest = std::min(nearest, Distance(old, mesh.GetPoint(id)));
        sum = sum + mesh.GetPoint(id);
      }
    }
  }
  const auto rate = [&](const Vec3& tried, double required)
  {
    double angle = 180.0;
    for (const Id other : star)
    {
      std::array<Vec3, 4> v;
      for (int i = 0; i < 4; ++i)
      {
        const Id id = mesh.GetMesh().Tetrahedra[other][i];
        v[i] = id == point ? tried : mesh.GetPoint(id);
      }
      angle = std::min(angle, GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]));
      if (angle <= required || Orientation(v[0], v[1], v[2], v[3]) <= 0)
      {
        return 0.0;
      }
    }
    return angle;
  };
  Place best{ old, smallest + SmallestGain, false };
  const Vec3 mean = (1.0 / (3.0 * static_cast<double>(star.size()))) * sum;
  SearchMove(old, mean, nearest, mesh.GetTarget(), rate, best);
  position = best.Position;
  return best.IsFound;
}
} // namespace

bool SmoothPointOf(Id tetrahedron, const std::vector<char>& isFree, FlippableMesh& mesh)
{
  std::vector<Id> star;
  for (const Id point : mesh.GetMesh().Tetrahedra[tetrahedron])
  {
    Vec3 position;
    if (!isFree.empty() && isFree[point] != 0 && FindStar(mesh, point, tetrahedron, star) &&
      FindBetterPosition(mesh, point, star, position))
    {
      mesh.MovePoint(point, position, star);
      return true;
    }
  }
  return false;
}
} // namespace cdm
