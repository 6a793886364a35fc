// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronWalk.h
 * @brief Finds the tetrahedra that hold many positions.
 *
 * Method: positions follow a Hilbert curve (SpatialSort.h). The walk to each begins where the one
 * before has ended, and goes through facets that have the position on their far side (a visibility
 * walk: O. Devillers, S. Pion, M. Teillaud, "Walking in a triangulation", 2002,
 * doi:10.1142/S0129054102001047).
 *
 * Guarantees: exact; the same for any number of threads. Where the outside of the mesh is in the
 * way, or a mesh that is not Delaunay leads the walk in a circle, a position may not be found though
 * a tetrahedron holds it. Cost: about a microsecond for each position.
 */
#ifndef cdmTetrahedronWalk_h
#define cdmTetrahedronWalk_h

#include "Core/Meshes/TetMesh.h"

#include <vector>

namespace cdm
{
/**
 * For each position a tetrahedron of any region that holds it in its closure, or NoId.
 * @param numberOfThreads 0: one for each processor core
 */
std::vector<Id> FindTetrahedra(
  const TetMesh& mesh, const std::vector<Vec3>& positions, int numberOfThreads);
} // namespace cdm

#endif
