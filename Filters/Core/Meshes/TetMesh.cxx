// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/TetMesh.h"

namespace cdm
{
void RemoveDeadTetrahedra(TetMesh& mesh)
{
  std::vector<Id> newIds(mesh.Tetrahedra.size(), NoId);
  Id count = 0;
  for (Id t = 0; t < static_cast<Id>(newIds.size()); ++t)
  {
    if (mesh.Tetrahedra[t][0] == NoId)
    {
      continue;
    }
    newIds[t] = count;
    mesh.Tetrahedra[count] = mesh.Tetrahedra[t];
    mesh.Regions[count] = mesh.Regions[t];
    mesh.Neighbors[count] = mesh.Neighbors[t];
    ++count;
  }
  mesh.Tetrahedra.resize(count);
  mesh.Regions.resize(count);
  mesh.Neighbors.resize(count);
  for (TetrahedronIds& neighbors : mesh.Neighbors)
  {
    for (Id& facet : neighbors)
    {
      if (facet != NoId)
      {
        facet = 4 * newIds[facet / 4] + facet % 4;
      }
    }
  }
}
} // namespace cdm
