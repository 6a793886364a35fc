// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceOrientation.h
 * @brief Turns over the triangles that are reversed against the others.
 *
 * Method: sides that look into the same space form a shell (SurfaceSides.h).
 *  1. With labels: all sides of a shell have to have the same region. The region that most sides
 *     have wins; a triangle whose two regions fit when exchanged is turned over, with its regions
 *     left as they are.
 *  2. Without: triangles between the outer shell of their component and another shell are turned
 *     as most of them are: with the front to the outer shell or all away from it (as the surface of
 *     a cavity may be); of as many to the outer shell.
 * Others, as open sheets and interfaces between enclosed segments without labels, stay as they are:
 * nothing decides for them.
 *
 * Inputs: a surface with the invariants of TriangleMesh.h. Cost: O(n log n).
 */
#ifndef cdmSurfaceOrientation_h
#define cdmSurfaceOrientation_h

#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/** Returns the triangles that were turned, ascending. */
std::vector<Id> RepairOrientation(TriangleMesh& surface);
} // namespace cdm

#endif
