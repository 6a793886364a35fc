// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThinLayers.h
 * @brief Which tetrahedra reach from one side of a thin layer to the other.
 *
 * A layer is thin if it is twenty times as wide as thick: to fill it with tetrahedra as long as it
 * is thick would take thousands of them. Its tetrahedra are flat on purpose.
 *
 * Method: the boundary of each region falls into sides, which are what is connected across edges
 * that bend by less than 45 degrees. A side is as wide as a square with the same ratio of area to
 * perimeter, or with the same area if that is narrower. A tetrahedron is across a layer if all its
 * points lie on the boundary, two of them on sides that face each other, close to each other for
 * its size, and twenty times closer than either side is wide.
 *
 * Cost: O(n log n) to build; O(1) for a tetrahedron. About 100 bytes per triangle.
 */
#ifndef cdmThinLayers_h
#define cdmThinLayers_h

#include "Core/Basics/IdLists.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
class ThinLayers
{
public:
  /** The surface has labels. Triangles at each of its points. Both have to outlive the object. */
  ThinLayers(const TriangleMesh& surface, const IdLists& pointTriangles);
  /**
   * Of the same surface after some triangles have been split.
   * @param parents of each triangle, one that was in its facet before
   */
  ThinLayers(
    const ThinLayers& coarse, const IdLists& pointTriangles, const std::vector<Id>& parents);

  /** Of a region; ids of points that the surface does not have are larger than its own. */
  bool IsAcross(const TetrahedronIds& ids, Id region) const;

private:
  /** A triangle as seen from the region on one side. */
  struct Face
  {
    /** Out of the region, of length one. */
    Vec3 Normal;
    /** How wide the side is that the face belongs to. */
    double Width = 0.0;
  };
  void MeasureWidths();
  const Face* GetFace(Id triangle, Id region) const;

  const TriangleMesh& Surface;
  const IdLists& PointTriangles;
  /** 2 * t as seen from behind a triangle, 2 * t + 1 from its front. */
  std::vector<Face> Faces;
};
} // namespace cdm

#endif
