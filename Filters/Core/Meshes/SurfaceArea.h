// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceArea.h
 * @brief The area of all triangles of a surface, each counted once.
 */
#ifndef cdmSurfaceArea_h
#define cdmSurfaceArea_h

#include "Core/Geometry/Measures.h"
#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
/** Square model units. */
inline double GetSurfaceArea(const TriangleMesh& surface)
{
  double area = 0.0;
  for (const TriangleIds& ids : surface.Triangles)
  {
    area += GetTriangleArea(surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]]);
  }
  return area;
}
} // namespace cdm

#endif
