// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OrthoProductPoints.h
 * @brief Mesh points where planes across the axes meet: an ortho-product (thesis 4.3).
 *
 * Method:
 *  1. across each axis lie planes at the given ticks. Without any, the distance of two planes is
 *     the smallest spacing between them: the leaves of an octree (SizingOctree.h) say how many
 *     cells, and parts of cells, fit along the axis up to each position; planes divide them evenly;
 *  2. each cell has the points of the template (PointTemplates.h). With equal distances these make
 *     the cubic, body- and face-centered lattices;
 *  3. the spacing of a point is that between the points around it, from the gap between its plane
 *     and the nearest one, along each axis.
 *
 * Failure: LimitReached for more crossings of planes than points are allowed, inside or not.
 * Cost: O(n log n) for n leaves, O(1) for each point.
 */
#ifndef cdmOrthoProductPoints_h
#define cdmOrthoProductPoints_h

#include "Core/MeshPoints/MeshPointPlacer.h"

namespace cdm
{
Status PlaceOrthoProductPoints(const ExecutionContext& context, MeshPointPlacer& placer);
} // namespace cdm

#endif
