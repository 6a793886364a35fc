// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryDisplacement.h
 * @brief Spreads the displacement of a moving boundary to the other points of a mesh.
 *
 * Points on the boundary and the interfaces that are given a displacement have it. The others are
 * free as far as the shape of the boundary allows: inside in all directions; on flat parts of the
 * boundary that stay in their plane along the plane, or along a straight edge of them. Within a
 * distance of the points that are given one they take the weighted mean of their neighbors'
 * displacements, by successive over-relaxation. Weights are those of Laplace's equation: the
 * couplings of the box method inside, cotangents on planes, inverse lengths on edges. They are
 * positive on Delaunay meshes, and exact for linear displacements, which fold nothing. So layers
 * along a moving interface stay layers, and points on a wall make way for an interface that moves
 * along it.
 *
 * Guarantees: the boundary has the shape that the given displacements make of it. Free points
 * farther than the distance, measured along the edges of the mesh, get exactly zero. Deterministic.
 * Cost: O(n) for each of at most 400 sweeps over the n points that follow.
 */
#ifndef cdmBoundaryDisplacement_h
#define cdmBoundaryDisplacement_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
struct BoundaryDisplacementInput
{
  const TetMesh* Mesh = nullptr;
  /** On the points of Mesh (MeshBoundary.h). */
  const TriangleMesh* Boundary = nullptr;
  /** One for each point; those inside are not looked at. Model units. */
  std::vector<Vec3> Given;
  /** For each point: the given displacement holds as a whole, whatever the shape. */
  std::vector<char> IsPrescribed;
  /** How far from the points with a given displacement others follow. Model units, >= 0. */
  double FollowDistance = 0.0;
};

/** One displacement for each point. False if the context asks to stop. */
bool SpreadBoundaryDisplacement(const BoundaryDisplacementInput& input,
  const ExecutionContext& context, std::vector<Vec3>& displacements);
} // namespace cdm

#endif
