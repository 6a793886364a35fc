// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimalDelaunaySmoothing.h
 * @brief Moves points inside of regions to where circumcenters lie inside of their tetrahedra.
 *
 * Some solvers add up the parts of boxes without signs. Such a box is too large wherever the
 * circumcenter of a tetrahedron, or of a facet, lies outside of it. The excess of a tetrahedron is
 * by how much: its unsigned box volume (VoronoiMeasures.h) less its volume.
 *
 * Method:
 *  1. Each free point inside is taken in turn, in ascending order, in as many rounds as asked for.
 *     Where nothing around a point has changed since it was tried in vain, it is passed over.
 *  2. Its best place is the mean of the circumcenters around it, weighted by volume: there the
 *     piecewise linear interpolation of the squared distance has the smallest error for these
 *     tetrahedra. It goes no farther than a quarter of the distance to its nearest neighbor, as
 *     tetrahedra change on the way.
 *  3. The point is removed from the Delaunay mesh. The place, then places nearer to the old one, are
 *     rated before the point is inserted again. The excess of all tetrahedra that the move replaces
 *     has to fall. Of these the smallest dihedral angle must not fall below the target, nor fall
 *     further, and no more of them may be below. None may be too large, and no more may miss the
 *     radius-edge ratio. The place must not encroach on the boundary, nor be too close to others.
 *  4. If an edge of the boundary has a negative coupling in one of the new tetrahedra, or the point
 *     fits nowhere, the point goes back to its old place.
 *
 * Guarantees: the mesh stays Delaunay by the pulling rule, with the same boundary, which keeps its
 * criterion. Sizes are kept; there are no more negative couplings, no more slivers, and no smaller
 * angles below the target than before. The sum of the excesses falls with each move. Deterministic.
 * Failure: none but an abort; the mesh is valid then as well.
 * Cost: about a tenth of a millisecond for each try.
 *
 * References: L. Chen, J. Xu, "Optimal Delaunay triangulations", J. Comput. Math. 22 (2004), 299;
 * P. Alliez, D. Cohen-Steiner, M. Yvinec, M. Desbrun, "Variational tetrahedral meshing", 2005,
 * doi:10.1145/1073204.1073238.
 */
#ifndef cdmOptimalDelaunaySmoothing_h
#define cdmOptimalDelaunaySmoothing_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Improvement/RefinedMesh.h"

namespace cdm
{
/**
 * @param rounds through all points, at most: it ends when no point moves any more
 * @param target dihedral angle below which a tetrahedron is a sliver. Degrees; 0: none is
 */
Status SmoothOptimalDelaunay(
  int rounds, double target, const ExecutionContext& context, RefinedMesh& mesh);
} // namespace cdm

#endif
