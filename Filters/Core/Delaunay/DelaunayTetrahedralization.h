// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DelaunayTetrahedralization.h
 * @brief The Delaunay tetrahedralization of the convex hull of points. The advancing front reads
 *   the fourth point of every facet from it.
 *
 * Method:
 *  1. vertices are the points in the order of a Hilbert curve. Those of a block of a rectilinear
 *     grid get their tetrahedra at once (GridBlock.h); the others are inserted in rounds, each
 *     about eight times larger than the one before, drawn by a hash of the vertex, and along the
 *     curve within a round;
 *  2. a vertex is located by a walk from the last one; the tetrahedra whose sphere holds it, and
 *     the facets of the hull that it sees, are removed, and the cavity is filled with the cone
 *     from the vertex (VertexInsertion.h). Beyond each facet of the hull lies a tetrahedron with
 *     the vertex at infinity;
 *  3. a sphere is tested in single precision with a bound of its error, then in double precision,
 *     then exactly. Points on one sphere are told apart as if each had been pulled into it
 *     infinitely little, the lowest numbered one most: that gives the cells of the Delaunay
 *     subdivision the tetrahedra of the pulling rule, and none is flat;
 *  4. threads take parts of the curve. A thread touches only tetrahedra with all vertices in its
 *     part, so that none waits for another; vertices that need more are left for the next cut of
 *     the curve, and the few that remain for one thread at the end of the round.
 *
 * Guarantees: the set of tetrahedra depends on the points and their numbers only; all have positive
 * orientation and spheres empty of all points (exact).
 * Cost: O(n log n) for usual distributions, also for any number of points on one sphere; 49 bytes
 * per tetrahedron while it runs, 32 of them stay.
 *
 * References: N. Amenta, S. Choi, G. Rote, "Incremental constructions con BRIO", 2003,
 * doi:10.1145/777792.777824 (rounds); O. Devillers, M. Teillaud, "Perturbations for Delaunay and
 * weighted Delaunay 3D triangulations", 2011, doi:10.1016/j.comgeo.2010.09.010 (perturbed spheres
 * make no flat tetrahedra); C. Marot, J. Pellerin, J.-F. Remacle, "One machine, one minute, three
 * billion tetrahedra", 2019, doi:10.1002/nme.5987 (parts of the curve for threads).
 */
#ifndef cdmDelaunayTetrahedralization_h
#define cdmDelaunayTetrahedralization_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/RawVector.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Delaunay/GridBlock.h"

#include <vector>

namespace cdm
{
struct DelaunayTetrahedralization
{
  /**
   * Vertices of each tetrahedron; the number of points stands for the vertex at infinity. Entry 0
   * is NoId in unused slots.
   */
  RawVector<TetrahedronIds> Tetrahedra;
  /** Facet ids (4 * tetrahedron + i) of the neighbors, seen from these, as in TetMesh. */
  RawVector<TetrahedronIds> Neighbors;
  /** False if no five points that were compared lie on one sphere: all cells are tetrahedra. */
  bool HasCosphericalPoints = false;
};

/**
 * Points are distinct, finite, and follow a Hilbert curve (SortAlongHilbertCurve()); numbers are
 * distinct and decide the order of pulling. The block of a grid among them, if there is one
 * (FindGridBlock()), saves time and changes nothing else. InvalidInput if there are fewer than four
 * points, or all of them lie on a line or in a plane; LimitReached for more than 2^29 tetrahedra.
 * Aborted leaves nothing.
 */
Status BuildDelaunayTetrahedralization(const RawVector<Vec3>& points,
  const std::vector<Id>& numbers, const GridBlock& block, int numberOfThreads,
  const ExecutionContext& context, DelaunayTetrahedralization& output);

/** Finds a tetrahedron that holds the position in its closure; NoId outside of the hull. */
Id LocateInTetrahedralization(const RawVector<Vec3>& points,
  const DelaunayTetrahedralization& tetrahedralization, const Vec3& position);
} // namespace cdm

#endif
