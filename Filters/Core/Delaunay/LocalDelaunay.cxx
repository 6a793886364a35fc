// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/LocalDelaunay.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Delaunay/CavitySearch.h"

#include <vector>

namespace cdm
{
bool IsLocallyDelaunay(const TetMesh& mesh, int threads)
{
  const std::vector<Id> none;
  const CavitySearch search(mesh, none);
  return HoldForAll(mesh.Tetrahedra.size(), threads,
    [&](std::size_t t)
    {
      const Id tetrahedron = static_cast<Id>(t);
      for (int i = 0; i < 4; ++i)
      {
        const Id facet = mesh.Neighbors[t][i];
        // Each facet is looked at from one side.
        if (search.IsBoundary(tetrahedron, i) || facet / 4 < tetrahedron)
        {
          continue;
        }
        const Id behind = mesh.Tetrahedra[facet / 4][facet % 4];
        if (search.IsInConflict(tetrahedron, mesh.Points[behind], behind))
        {
          return false;
        }
      }
      return true;
    });
}
} // namespace cdm
