// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShortestEdges.h
 * @brief How close the points of a mesh are to their neighbors.
 *
 * Cost: O(n) for n tetrahedra.
 */
#ifndef cdmShortestEdges_h
#define cdmShortestEdges_h

#include "Core/Meshes/TetMesh.h"

#include <vector>

namespace cdm
{
/**
 * The length of the shortest edge at each point, infinite without edges. Tetrahedra whose first
 * vertex is NoId do not count.
 */
std::vector<double> FindShortestEdges(const TetMesh& mesh);
} // namespace cdm

#endif
