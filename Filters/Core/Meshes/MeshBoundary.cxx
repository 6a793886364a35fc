// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/MeshBoundary.h"

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
} // namespace cdm
