// SPDX-License-Identifier: BSD-3-Clause
/** @file LayerSurfaces.h @brief Labelled surfaces of layers, for tests. */
#ifndef cdmLayerSurfaces_h
#define cdmLayerSurfaces_h

#include "Core/Meshes/TriangleMesh.h"

#include <cmath>

namespace cdm
{
inline void AddQuadrangle(TriangleMesh& surface, Id a, Id b, Id c, Id d)
{
  surface.Triangles.insert(surface.Triangles.end(), { { a, b, c }, { a, c, d } });
  surface.Labels.insert(surface.Labels.end(), 2, { OutsideRegion, 0 });
}

/** Point x + 2 y + 4 z, each 0 or 1, in units of the size. */
inline TriangleMesh MakeBoxSurface(const Vec3& size)
{
  TriangleMesh surface;
  for (int i = 0; i < 8; ++i)
  {
    surface.Points.push_back({ (i & 1) * size.X, ((i >> 1) & 1) * size.Y, (i >> 2) * size.Z });
  }
  AddQuadrangle(surface, 0, 2, 3, 1);
  AddQuadrangle(surface, 4, 5, 7, 6);
  AddQuadrangle(surface, 0, 1, 5, 4);
  AddQuadrangle(surface, 2, 6, 7, 3);
  AddQuadrangle(surface, 0, 4, 6, 2);
  AddQuadrangle(surface, 1, 3, 7, 5);
  return surface;
}

/**
 * A tube of so many facets along the z axis: radius 1, length 6; point 4 i + 2 * isOuter + isTop.
 */
inline TriangleMesh MakeTubeSurface(Id count, double thickness)
{
  TriangleMesh surface;
  for (Id i = 0; i < count; ++i)
  {
    const double angle = 2.0 * 3.14159265358979323846 * i / count;
    for (double radius : { 1.0 - thickness, 1.0 })
    {
      for (double z : { 0.0, 6.0 })
      {
        surface.Points.push_back({ radius * std::cos(angle), radius * std::sin(angle), z });
      }
    }
  }
  for (Id i = 0; i < count; ++i)
  {
    const Id a = 4 * i;
    const Id b = 4 * ((i + 1) % count);
    AddQuadrangle(surface, a + 1, b + 1, b, a);
    AddQuadrangle(surface, a + 2, b + 2, b + 3, a + 3);
    AddQuadrangle(surface, a, b, b + 2, a + 2);
    AddQuadrangle(surface, a + 1, a + 3, b + 3, b + 1);
  }
  return surface;
}
} // namespace cdm

#endif
