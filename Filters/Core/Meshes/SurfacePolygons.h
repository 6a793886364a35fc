// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfacePolygons.h
 * @brief The triangles of a surface as polygons, for the boundary triangulator.
 */
#ifndef cdmSurfacePolygons_h
#define cdmSurfacePolygons_h

#include "Core/Meshes/PolygonSoup.h"
#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
/** Polygon i is triangle i, with its labels if there are any. */
inline PolygonSoup MakePolygonSoup(const TriangleMesh& surface)
{
  PolygonSoup soup;
  soup.Points = surface.Points;
  soup.Labels = surface.Labels;
  for (const TriangleIds& ids : surface.Triangles)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), ids.begin(), ids.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  return soup;
}
} // namespace cdm

#endif
