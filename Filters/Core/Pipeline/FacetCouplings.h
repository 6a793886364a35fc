// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetCouplings.h
 * @brief Finds edges in facets of rounded points whose couplings are negative.
 *
 * Criterion 3.1 makes the two triangles at an edge within a plane facet share its Voronoi facet, and
 * criterion 3.2 keeps the smallest spheres of structural edges empty (NegativeCouplings.h). Edges
 * within a facet that is plane but for the digits of its points (FlatFacets.h) are neither: a coupling
 * may be negative there, by as little as the facet bends. Few are. What they come from is refined
 * anew, with its edges as they are.
 *
 * Method: of the edges with two triangles of one facet those that bend by more than the last digits of
 * the coordinates are looked at.
 *
 * Guarantees: deterministic; where the surface fulfils criterion 3.2 and none is found, no coupling is
 * negative. Cost: O(n log n).
 * Reference: P. Fleischmann, thesis, 3.1.
 */
#ifndef cdmFacetCouplings_h
#define cdmFacetCouplings_h

#include "Core/Basics/ThreadTeam.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/**
 * The triangles of the boundary at such edges, ascending.
 * @param boundary on the points of the mesh
 * @param facets of the triangles of the boundary
 * @param team whose threads share the work
 */
std::vector<Id> FindNegativeTriangles(const TetMesh& mesh, const TriangleMesh& boundary,
  const std::vector<Id>& facets, ThreadTeam& team);
} // namespace cdm

#endif
