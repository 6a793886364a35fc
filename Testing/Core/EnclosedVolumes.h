// SPDX-License-Identifier: BSD-3-Clause
// What the regions of a labelled surface enclose.
#ifndef EnclosedVolumes_h
#define EnclosedVolumes_h

#include "Core/Meshes/TriangleMesh.h"

#include <map>

namespace testing_core
{
/**
 * Six times the volume that the labels enclose, by region: exact for small integers as coordinates.
 */
inline std::map<cdm::Id, double> GetEnclosedSixVolumes(const cdm::TriangleMesh& surface)
{
  std::map<cdm::Id, double> volumes;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const cdm::TriangleIds& ids = surface.Triangles[t];
    const double volume =
      Dot(surface.Points[ids[0]], Cross(surface.Points[ids[1]], surface.Points[ids[2]]));
    volumes[surface.Labels[t].Back] += volume;
    volumes[surface.Labels[t].Front] -= volume;
  }
  volumes.erase(cdm::OutsideRegion);
  return volumes;
}
} // namespace testing_core

#endif
