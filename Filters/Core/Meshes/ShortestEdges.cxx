// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/ShortestEdges.h"

#include <algorithm>

namespace cdm
{
std::vector<double> FindShortestEdges(const TetMesh& mesh)
{
  std::vector<double> lengths(mesh.Points.size(), Infinity);
  for (const TetrahedronIds& ids : mesh.Tetrahedra)
  {
    if (ids[0] == NoId)
    {
      continue;
    }
    for (const int(&edge)[2] : TetrahedronEdges)
    {
      const double length = Distance(mesh.Points[ids[edge[0]]], mesh.Points[ids[edge[1]]]);
      for (const int end : edge)
      {
        lengths[ids[end]] = std::min(lengths[ids[end]], length);
      }
    }
  }
  return lengths;
}
} // namespace cdm
