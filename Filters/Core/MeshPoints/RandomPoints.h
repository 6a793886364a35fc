// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomPoints.h
 * @brief Mesh points at random, smoothed (thesis 6.2).
 *
 * Method:
 *  1. darts are thrown into the leaves of an octree as fine as the sizing (SizingOctree.h), in
 *     several rounds, each in another order. A dart stays if no other point is near, measured in
 *     the spacing at the dart (Poisson disks in the metric of the sizing);
 *  2. Lloyd's iteration: each point moves to the center of its Voronoi cell, found by samples in
 *     the leaves, each of which counts for the nearest point. A point that may not take that
 *     position stays. Points of layers have cells, too, but do not move.
 *
 * Guarantees: random numbers are drawn, and sums are made, on one thread: points are the same for
 * any number of threads.
 * Failure: LimitReached if the sizing needs too many points.
 * Cost: about a millisecond for a point.
 * References: R. L. Cook, "Stochastic sampling in computer graphics", 1986,
 * doi:10.1145/7529.8927 (darts); Q. Du, V. Faber, M. Gunzburger, "Centroidal Voronoi
 * tessellations", 1999, doi:10.1137/S0036144599352836 (Lloyd's iteration with a density by
 * samples).
 */
#ifndef cdmRandomPoints_h
#define cdmRandomPoints_h

#include "Core/MeshPoints/MeshPointPlacer.h"

namespace cdm
{
Status PlaceRandomPoints(const ExecutionContext& context, MeshPointPlacer& placer);
} // namespace cdm

#endif
