// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshBoundary.h
 * @brief The surface that bounds the regions of a tetrahedral mesh.
 *
 * Cost: O(n) for n tetrahedra.
 */
#ifndef cdmMeshBoundary_h
#define cdmMeshBoundary_h

#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
/**
 * The outer and interface facets of a mesh, each once, with labels: fronts look out of the mesh,
 * and from the larger to the smaller region id. In the order of the tetrahedra behind them, which
 * are the SourceCells. Points are all those of the mesh.
 */
TriangleMesh ExtractBoundary(const TetMesh& mesh);

/**
 * The boundary of a mesh from which flat tetrahedra were peeled off: triangles of the boundary
 * before that are still there, then the new ones, with an old triangle of the same patch as their
 * source.
 */
TriangleMesh UpdateBoundary(const TetMesh& mesh, const TriangleMesh& before);

/** Drops the points that no triangle uses. Returns the former ids of the others, ascending. */
std::vector<Id> RemoveUnusedPoints(TriangleMesh& surface);

/** The points of tetrahedra that are not on the boundary, ascending. */
std::vector<Id> FindPointsInside(const TetMesh& mesh, const std::vector<Id>& boundaryPoints);
} // namespace cdm

#endif
