// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverRemover.h
 * @brief Stage 4: better tetrahedra from the same points, with every tetrahedron still Delaunay.
 *
 * Method (thesis 3.4.6, 3.4.7, 5.7 and 6.4.3), for tetrahedra with a dihedral angle below the
 * target:
 *  1. one that is numerically flat and has exactly two facets on the outer boundary, which bend by
 *     less than a degree, is peeled off: a 2-2 flip of these two triangles;
 *  2. worst first, each tries to vanish by a 2-3 flip at one of its facets or by the removal of one
 *     of its edges (3-2, 4-4 and larger flips, the ring triangulated best possible by Klincsek's
 *     dynamic programming). A flip counts if it stays in one region, if each new tetrahedron has
 *     the circumsphere of one that it replaces (exactly cospherical sets, where any tetrahedra are
 *     Delaunay), and if the smallest dihedral angle of the tetrahedra involved grows, or stays and
 *     fewer of them have it (the sorted angles grow lexicographically);
 *  3. one that is flat on an interface, like 1., is handed to the other region if a flip there
 *     makes it vanish;
 *  4. free points of those that are left are moved, with the Delaunay tetrahedra around them made
 *     anew, so that the smallest dihedral angle of what is replaced grows (SliverPointMoves.h);
 *     then also those of tetrahedra below 1.02 times the target, which leaves some room. Points
 *     inside go anywhere, those of the boundary and of interfaces along their facet or structural
 *     edge. Where cospherical sets are not split by the pulling rule, as after flips, points may
 *     have to stay.
 * With quality before Delaunay, 2. takes any flip that improves, cospherical or not, and instead of
 * 4. free points are moved within the tetrahedra around them, which stay (smoothing), in turn with
 * the flips.
 *
 * Guarantees: points that are not free are not moved, and those of the boundary and of interfaces
 * not out of their plane or line but for rounding; none is added, removed, or loses its last
 * tetrahedron; no tetrahedron is inverted or flat. A mesh that was Delaunay is so still, and
 * triangles and edges of the boundary whose smallest spheres were empty (Crit. 3.1 and 3.2) still
 * have empty ones: neither is so with quality before Delaunay. The boundary and the interfaces
 * change where tetrahedra are peeled off or handed over, by less than the flatness, otherwise not
 * at all. Deterministic.
 * Failure: InvalidInput names tetrahedra that are inverted, flat or have wrong neighbors; the mesh
 * is then left alone. Aborted leaves a valid mesh.
 * Cost: O(b log b) for b tetrahedra below the target, after one look at all of them; 20 bytes per
 * tetrahedron. About a millisecond for a point that is tried to be moved, and 120 bytes per
 * tetrahedron if there are such points.
 * References: G. T. Klincsek, "Minimal triangulations of polygonal domains", 1980,
 * doi:10.1016/S0167-5060(08)70044-X; J. R. Shewchuk, "Two discrete optimization algorithms for the
 * topological improvement of tetrahedral meshes", 2002 (edge removal by it).
 */
#ifndef cdmSliverRemover_h
#define cdmSliverRemover_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"

namespace cdm
{
struct SliverRemoverOptions
{
  /** Tetrahedra with a smaller dihedral angle are treated. Degrees, 0 to 70. */
  double DihedralAngleTarget = 15.0;
  /** A boundary tetrahedron lower than this ratio of the diagonal may be peeled off. >= 0. */
  double FlatnessRatio = 1e-9;
  /** Empty, or one for each point of the mesh: whether it may be moved if inside of a region. */
  std::vector<char> IsFree;
  /** Whether points of the boundary and of interfaces may be moved; corners never are. */
  bool AreBoundaryPointsFree = false;
  /** Flips and smoothing need not keep the mesh Delaunay; points of the boundary then stay. */
  bool QualityBeforeDelaunay = false;
};

struct SliverRemoverReport
{
  /** Removed at the outer boundary, or handed to another region. */
  Id PeeledTetrahedra = 0;
  Id Flips = 0;
  /** Moves of points, each of which counts as often as it is moved. */
  Id MovedPoints = 0;
  /** Degrees, before and after; 0 for a mesh without tetrahedra. */
  double SmallestDihedralAngleBefore = 0.0;
  double SmallestDihedralAngleAfter = 0.0;
};

/** Works in place; tetrahedra may be renumbered. */
Status RemoveSlivers(TetMesh& mesh, const SliverRemoverOptions& options,
  const ExecutionContext& context, SliverRemoverReport& report);
} // namespace cdm

#endif
