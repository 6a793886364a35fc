// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryShape.h
 * @brief What tetrahedra have to respect in the current boundary: smallest spheres that stay empty,
 * sharp angles and thin layers.
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
/** Cannot be copied or moved: some members refer to others. */
struct BoundaryShape
{
  /**
   * The arguments have to outlive the object.
   * @param edges structural edges, sorted
   * @param keptEdges structural edges whose smallest spheres stay empty
   * @param sharpPlaneAngle degrees, see SharpAngles
   */
  BoundaryShape(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    const std::vector<StructuralEdge>& keptEdges, double sharpPlaneAngle);
  /**
   * The shape after some triangles have been split. Tetrahedra that stay are in the same sharp
   * angles and thin layers as before.
   * @param parents for each triangle one of the coarse surface in the same surface facet
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
