// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OctreePoints.h
 * @brief Mesh points at the leaves of an octree, by templates (thesis 6.2, Fig. 6.2).
 *
 * Method:
 *  1. the leaves are as large as the sizing asks for (SizingOctree.h), times a ratio so that the
 *     edges of the mesh are as long;
 *  2. each leaf that is not outside has the points of the template (PointTemplates.h). Points that
 *     several leaves have in common are found by sorting all of them by their position;
 *  3. the spacing of a point is that between the points of its smallest leaf, along each axis.
 *
 * Failure: LimitReached if the sizing needs too many points.
 * Cost: O(n log n); 24 bytes for each point of each leaf.
 */
#ifndef cdmOctreePoints_h
#define cdmOctreePoints_h

#include "Core/MeshPoints/MeshPointPlacer.h"

namespace cdm
{
Status PlaceOctreePoints(const ExecutionContext& context, MeshPointPlacer& placer);
} // namespace cdm

#endif
