// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryShape.h
 * @brief What follows for tetrahedra from the boundary of their mesh as it is: smallest spheres
 * that stay empty, sharp angles and thin layers.
 */
#ifndef cdmBoundaryShape_h
#define cdmBoundaryShape_h

#include "Core/Basics/IdLists.h"
#include "Core/Improvement/BoundarySpheres.h"
#include "Core/Improvement/ThinLayers.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/SharpAngles.h"
#include "Core/Surface/StructuralEdges.h"

#include <vector>

namespace cdm
{
/** It stays where it is: some of it refers to other parts. */
struct BoundaryShape
{
  /**
   * All outlive the object.
   * @param edges structural ones, sorted
   * @param keptEdges those whose smallest spheres stay empty
   * @param sharpPlaneAngle degrees, see SharpAngles
   */
  BoundaryShape(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    const std::vector<StructuralEdge>& keptEdges, double sharpPlaneAngle);
  /**
   * After some triangles have been split. Tetrahedra that stay are in the same sharp angles and
   * thin layers.
   * @param parents of each triangle, one that was in its facet before
   */
  BoundaryShape(BoundaryShape&& coarse, const TriangleMesh& surface,
    const std::vector<StructuralEdge>& edges, const std::vector<StructuralEdge>& keptEdges,
    const std::vector<Id>& parents);
  BoundaryShape(const BoundaryShape&) = delete;
  BoundaryShape& operator=(const BoundaryShape&) = delete;

  BoundarySpheres Spheres;
  /** Triangles at each point of the surface. */
  const IdLists PointTriangles;
  SharpAngles Sharp;
  const ThinLayers Layers;
};
} // namespace cdm

#endif
