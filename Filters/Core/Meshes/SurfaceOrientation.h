// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceOrientation.h
 * @brief Reverses triangles whose orientation is opposite to that of the others.
 *
 * Method: sides that look into the same space form a shell (SurfaceSides.h).
 *  1. With labels: all sides of a shell have to have the same region. The region that most sides
 *     have wins; a triangle whose two regions fit when exchanged is reversed, with its regions left
 *     as they are.
 *  2. Without labels: triangles between the outer shell of their component and another shell get
 *     the orientation that most of them have: all fronts to the outer shell, or all away from it
 *     (as the surface of a void may be). In a tie the fronts face the outer shell.
 * Other triangles stay as they are, because nothing decides for them: open sheets, and interfaces
 * between enclosed segments without labels.
 *
 * Inputs: a surface with the invariants of TriangleMesh.h. Cost: O(n log n).
 */
#ifndef cdmSurfaceOrientation_h
#define cdmSurfaceOrientation_h

#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/** Returns the triangles that were reversed, ascending. */
std::vector<Id> RepairOrientation(TriangleMesh& surface);
} // namespace cdm

#endif
