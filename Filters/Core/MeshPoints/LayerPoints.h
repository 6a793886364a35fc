// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LayerPoints.h
 * @brief Mesh points in layers off interfaces: boundary fitted points (thesis 6.2).
 *
 * Method:
 *  1. the surface is refined as the sizing asks for (DelaunaySurfaceRefiner.h);
 *  2. the normal of an interface at a vertex is the mean of those of its triangles there, weighted
 *     by their angles. It is made so long that a step along it leads as far away from the
 *     triangles;
 *  3. on it stand points at distances d, d + d q, d + d q + d q^2, ... from the interface. A point
 *     stays if it is clear of the boundary, no nearer to the interface than wanted, strictly inside
 *     of the region, and clear of the points of layers before it.
 * Above the same vertices these points make prisms, which are Delaunay however flat they are
 * (Filters/Core/README.md).
 *
 * Failure: InvalidOption for layers at an interface that is not there, LimitReached for too many
 * points.
 */
#ifndef cdmLayerPoints_h
#define cdmLayerPoints_h

#include "Core/MeshPoints/MeshPointPlacer.h"

namespace cdm
{
/** Places the layers that the placer's options ask for. */
Status PlaceLayerPoints(const ExecutionContext& context, MeshPointPlacer& placer);
} // namespace cdm

#endif
