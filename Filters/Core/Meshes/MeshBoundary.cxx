// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/MeshBoundary.h"

#include "Core/Basics/SortedIds.h"

#include <map>

namespace cdm
{
TriangleMesh ExtractBoundary(const TetMesh& mesh)
{
  TriangleMesh boundary;
  boundary.Points = mesh.Points;
  for (Id tetrahedron = 0; tetrahedron < static_cast<Id>(mesh.Tetrahedra.size()); ++tetrahedron)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      const Id neighbor = mesh.Neighbors[tetrahedron][facet];
      const Id front = neighbor == NoId ? OutsideRegion : mesh.Regions[neighbor / 4];
      if (front < mesh.Regions[tetrahedron])
      {
        boundary.Triangles.push_back(GetFacet(mesh.Tetrahedra[tetrahedron], facet));
        boundary.Labels.push_back({ front, mesh.Regions[tetrahedron] });
        boundary.SourceCells.push_back(tetrahedron);
      }
    }
  }
  return boundary;
}

std::vector<Id> RemoveUnusedPoints(TriangleMesh& surface)
{
  std::vector<Id> newIds(surface.Points.size(), NoId);
  for (const TriangleIds& triangle : surface.Triangles)
  {
    for (const Id id : triangle)
    {
      newIds[id] = id;
    }
  }
  std::vector<Id> kept;
  for (Id& id : newIds)
  {
    if (id != NoId)
    {
      surface.Points[kept.size()] = surface.Points[id];
      kept.push_back(id);
      id = static_cast<Id>(kept.size()) - 1;
    }
  }
  surface.Points.resize(kept.size());
  for (TriangleIds& triangle : surface.Triangles)
  {
    triangle = { newIds[triangle[0]], newIds[triangle[1]], newIds[triangle[2]] };
  }
  return kept;
}

std::vector<Id> FindPointsInside(const TetMesh& mesh, const std::vector<Id>& boundaryPoints)
{
  std::vector<char> isInside(mesh.Points.size(), 0);
  for (const TetrahedronIds& ids : mesh.Tetrahedra)
  {
    for (const Id id : ids)
    {
      isInside[id] = 1;
    }
  }
  for (const Id id : boundaryPoints)
  {
    isInside[id] = 0;
  }
  std::vector<Id> points;
  for (std::size_t p = 0; p < isInside.size(); ++p)
  {
    if (isInside[p])
    {
      points.push_back(static_cast<Id>(p));
    }
  }
  return points;
}
namespace
{
EdgeIds GetSide(const TriangleIds& triangle, int i)
{
  return MakeEdge(triangle[i], triangle[(i + 1) % 3]);
}

/** Whether it is the same interface, whichever side is in front. */
bool AreSameRegions(const RegionPair& a, const RegionPair& b)
{
  return a == b || (a.Front == b.Back && a.Back == b.Front);
}
} // namespace

TriangleMesh UpdateBoundary(const TetMesh& mesh, const TriangleMesh& before)
{
  const TriangleMesh facets = ExtractBoundary(mesh);
  std::map<TriangleIds, std::size_t> interfaces;
  for (std::size_t i = 0; i < facets.Triangles.size(); ++i)
  {
    interfaces[Sorted(facets.Triangles[i])] = i;
  }

  TriangleMesh after;
  after.Points = mesh.Points;
  std::map<EdgeIds, std::vector<Id>> goneByEdge;
  for (std::size_t i = 0; i < before.Triangles.size(); ++i)
  {
    const TriangleIds& ids = before.Triangles[i];
    const auto found = interfaces.find(Sorted(ids));
    // A sheet inside of one region is no interface, and nothing is peeled off at it.
    if (found != interfaces.end() || before.Labels[i].Front == before.Labels[i].Back)
    {
      after.Triangles.push_back(ids);
      after.Labels.push_back(before.Labels[i]);
      after.SourceCells.push_back(static_cast<Id>(i));
      if (found != interfaces.end())
      {
        interfaces.erase(found);
      }
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      goneByEdge[GetSide(ids, k)].push_back(static_cast<Id>(i));
    }
  }
  for (const auto& item : interfaces)
  {
    const TriangleIds& added = facets.Triangles[item.second];
    const RegionPair& labels = facets.Labels[item.second];
    Id source = NoId;
    for (int k = 0; k < 3 && source == NoId; ++k)
    {
      const std::vector<Id>& gone = goneByEdge[GetSide(added, k)];
      const auto found = std::find_if(
        gone.begin(), gone.end(), [&](Id i) { return AreSameRegions(before.Labels[i], labels); });
      source = found == gone.end() ? NoId : *found;
    }
    after.Triangles.push_back(added);
    after.Labels.push_back(labels);
    after.SourceCells.push_back(source);
  }
  return after;
}
} // namespace cdm
