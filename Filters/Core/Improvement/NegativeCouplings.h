// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NegativeCouplings.h
 * @brief Edges of a boundary with a negative coupling in the box method.
 *
 * The coupling of an edge is the signed area of its Voronoi facet within a region. Edges inside of
 * a region have no negative coupling in a Delaunay mesh. At an edge of the boundary the Voronoi
 * facet ends where it meets the triangles there. A part of it counts negative where it lies beyond
 * the edge, which takes a point in the edge's smallest sphere. Crit. 3.2 would exclude that for all
 * edges; Crit. 3.1 excludes it for edges within surface facets.
 *
 * Only edges whose smallest spheres are not empty are looked at. Deterministic. Cost: O(n) for n
 * tetrahedra, twice through all of them.
 * Reference: P. Fleischmann, thesis, 3.1.
 */
#ifndef cdmNegativeCouplings_h
#define cdmNegativeCouplings_h

#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/**
 * Edges of the boundary whose coupling in a region is negative, ascending.
 * @param mesh has the points of the boundary first; tetrahedra whose first vertex is NoId are dead
 */
std::vector<EdgeIds> FindNegativeCouplings(const TetMesh& mesh, const TriangleMesh& boundary);
} // namespace cdm

#endif
