// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverPointMoves.h
 * @brief Moves points of slivers in a Delaunay mesh, without a split of its boundary.
 *
 * Method:
 *  1. triangles and edges of the boundary (outer facets and interfaces) whose smallest spheres are
 *     empty are found: these stay empty. Near other outer facets nothing is moved, since what lies
 *     beyond could be in conflict;
 *  2. points inside are moved (SliverPerturbation.h);
 *  3. if points of the boundary are free, too, they are moved in their plane or on their line
 *     (SurfacePointMoves.h). This does not see what lies beyond outer facets: if one of those
 *     spheres is found to be filled afterwards, the moves that fill it are taken back, and 3. is
 *     begun anew without these points;
 *  4. moved boundary points give interior points new room: 2. is done again.
 *
 * Guarantees: a Delaunay mesh stays Delaunay. Deterministic.
 * Cost: about 100 microseconds for each point that it tries to move; 120 bytes per tetrahedron.
 */
#ifndef cdmSliverPointMoves_h
#define cdmSliverPointMoves_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"

#include <vector>

namespace cdm
{
/**
 * @param target degrees
 * @param isFree empty, or one for each point: whether it may be moved if inside of a region
 * @param areBoundaryPointsFree whether all points of the boundary but its corners may be moved
 * @param mesh is changed in place; valid also if aborted
 * @param movedPoints is increased by the number of moves
 */
Status MoveSliverPoints(double target, const std::vector<char>& isFree, bool areBoundaryPointsFree,
  const ExecutionContext& context, TetMesh& mesh, Id& movedPoints);
} // namespace cdm

#endif
