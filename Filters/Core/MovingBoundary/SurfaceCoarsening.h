// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceCoarsening.h
 * @brief Takes points out of a surface where they do not shape it.
 *
 * Method: a point inside of a flat part, or of a straight edge between flat parts, is merged into a
 * neighbor in the plane of all its triangles: the nearest one for which every triangle keeps its
 * orientation, exactly, and no two become equal. In the order of the ids, until none is left.
 *
 * Inputs: the invariants of TriangleMesh.h.
 * Guarantees: the surface keeps its shape, to FlatnessRatio, and the labels their places. Where
 * triangles of other parts of it lie closer than that they may intersect afterwards. Deterministic.
 * Cost: O(n) for n removed points of bounded degree.
 */
#ifndef cdmSurfaceCoarsening_h
#define cdmSurfaceCoarsening_h

#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/**
 * isRemovable: for each point. Points stay in the list; triangles that are left keep their order.
 * flatness: how far from a plane a point may be, in model units.
 */
void CoarsenSurface(const std::vector<char>& isRemovable, double flatness, TriangleMesh& surface);
} // namespace cdm

#endif
