// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalDelaunay.h
 * @brief Whether no facet of a mesh has the point behind it in its circumsphere.
 *
 * Facets between regions and at the outside are left out. If the triangles there are strongly
 * Delaunay, a mesh that is locally Delaunay is the Delaunay mesh of its points: it is constrained
 * Delaunay, and no facet hides a point that lies in a sphere. Where points are cospherical the pulling
 * rule decides, so that there is only one such mesh.
 *
 * Exact. Cost: O(n) for n tetrahedra, 0.15 microseconds for each on one thread.
 * Reference: J. R. Shewchuk, "General-dimensional constrained Delaunay and constrained regular
 * triangulations, I: combinatorial properties", 2008, doi:10.1007/s00454-008-9060-3.
 */
#ifndef cdmLocalDelaunay_h
#define cdmLocalDelaunay_h

#include "Core/Meshes/TetMesh.h"

namespace cdm
{
/** @param threads 0: one for each processor core */
bool IsLocallyDelaunay(const TetMesh& mesh, int threads);
} // namespace cdm

#endif
