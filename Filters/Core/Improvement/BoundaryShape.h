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
/** What splits and moves have changed in a boundary. */
struct BoundaryChange
{
  /** Triangles that are new, or have got other points or positions. */
  std::vector<Id> Triangles;
  /** For each of them a triangle of the boundary as it was before, in the same surface facet. */
  std::vector<Id> Parents;
  /** Structural edges that are new, or have got other ends or positions. */
  std::vector<Id> Edges;
  /** For each structural edge a number that it keeps in other lists: at first its index. */
  const std::vector<Id>& Segments;
};

/** Cannot be copied or moved: some members refer to others. */
struct BoundaryShape
{
  /**
   * The arguments have to outlive the object.
   * @param edges structural edges, sorted
   * @param keptEdges structural edges whose smallest spheres stay empty
   * @param sharpPlaneAngle degrees, see SharpAngles
   * @param layerAspectRatio see ThinLayers
   */
  BoundaryShape(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    const std::vector<StructuralEdge>& keptEdges, double sharpPlaneAngle, double layerAspectRatio);
  /**
   * Follows splits and moves of the boundary, whose kept edges are its structural edges.
   * Tetrahedra that stay are in the same sharp angles and thin layers as before.
   */
  void Follow(const BoundaryChange& change);
  BoundaryShape(const BoundaryShape&) = delete;
  BoundaryShape& operator=(const BoundaryShape&) = delete;

  BoundarySpheres Spheres;
  /** Triangles at each point of the surface. */
  IdLists PointTriangles;
  SharpAngles Sharp;
  ThinLayers Layers;

private:
  void FollowTriangles(const std::vector<Id>& triangles);

  const TriangleMesh& Surface;
  const std::vector<StructuralEdge>& Edges;
};
} // namespace cdm

#endif
