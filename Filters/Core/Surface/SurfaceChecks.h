// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceChecks.h
 * @brief Checks whether a surface can be refined, and to a length of edges.
 *
 * Coordinates are finite, points do not coincide, triangles have an area; there are triangles, and
 * as many points as ids reach. Exact. Cost: O(n log n). Of a length: O(n).
 */
#ifndef cdmSurfaceChecks_h
#define cdmSurfaceChecks_h

#include "Core/Basics/Status.h"
#include "Core/Meshes/TriangleMesh.h"

#include <cstddef>

namespace cdm
{
/**
 * InvalidInput names points or triangles.
 * @param numberOfMeshPoints mesh points beside those of the surface
 */
Status CheckRefinableSurface(const TriangleMesh& surface, std::size_t numberOfMeshPoints);

/**
 * LimitReached where edges so short need more points on the surface than ids count.
 * @param maximumEdgeLength model units; 0: none
 */
Status CheckMaximumEdgeLength(const TriangleMesh& surface, double maximumEdgeLength);
} // namespace cdm

#endif
