// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceArea.h
 * @brief Areas of the triangles of a surface.
 */
#ifndef cdmSurfaceArea_h
#define cdmSurfaceArea_h

#include "Core/Geometry/Measures.h"
#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
/** Twice the area of a triangle as a vector, which points to the front of the triangle. */
inline Vec3 GetAreaVector(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return Cross(b - a, c - a);
}
inline Vec3 GetAreaVector(const TriangleMesh& surface, const TriangleIds& ids)
{
  return GetAreaVector(surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]]);
}

/** The sum over all triangles, each counted once, in square model units. */
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
