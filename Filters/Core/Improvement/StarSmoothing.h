// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StarSmoothing.h
 * @brief Moves points within the tetrahedra around them, which stay.
 *
 * Method: a pattern search (PlaceSearch.h) for the position with the largest smallest dihedral angle
 * of the tetrahedra at the point. The mesh need not be Delaunay afterwards.
 *
 * Cost: a hundred ratings for a point.
 */
#ifndef cdmStarSmoothing_h
#define cdmStarSmoothing_h

#include "Core/Improvement/FlippableMesh.h"

#include <vector>

namespace cdm
{
/**
 * Moves the first of a tetrahedron's points that can be moved to a better position. False if there
 * is none.
 * @param isFree one for each point of the mesh: whether it may move if inside of a region; or empty
 */
bool SmoothPointOf(Id tetrahedron, const std::vector<char>& isFree, FlippableMesh& mesh);
} // namespace cdm

#endif
