// SPDX-License-Identifier: BSD-3-Clause
// Angles of the triangles of a surface.
#ifndef SurfaceAngles_h
#define SurfaceAngles_h

#include "Core/Geometry/Measures.h"
#include "Core/Meshes/TriangleMesh.h"

#include <algorithm>
#include <cmath>

namespace testing_core
{
/** The smallest angle of all triangles, in degrees; 180 without any. */
inline double GetSmallestAngle(const cdm::TriangleMesh& surface)
{
  double smallest = 180.0;
  for (const cdm::TriangleIds& ids : surface.Triangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      const cdm::Vec3& corner = surface.Points[ids[i]];
      const cdm::Vec3 first = surface.Points[ids[(i + 1) % 3]] - corner;
      const cdm::Vec3 second = surface.Points[ids[(i + 2) % 3]] - corner;
      smallest = std::min(smallest,
        std::atan2(Norm(Cross(first, second)), Dot(first, second)) * cdm::DegreesPerRadian);
    }
  }
  return smallest;
}
} // namespace testing_core

#endif
