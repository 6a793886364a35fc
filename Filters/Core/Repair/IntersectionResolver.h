// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IntersectionResolver.h
 * @brief Splits triangles that cross, overlap or touch along their intersections (stage 0).
 *
 * Method, in rounds until no intersection is left:
 *  1. find the triangles that intersect, exactly (TriangleIntersection.h); after the first round
 *     only those that have changed are looked at;
 *  2. compute the points where an edge pierces a triangle and where edges of coplanar triangles
 *     cross (IntersectionPoints.h, CuttingRound.h): parameters from exact determinants, then
 *     rounded to double. A point within a tolerance of another one is that point; within it of an
 *     edge it divides the edge, in all triangles that have it: so pieces stay connected, and a
 *     closed surface stays closed;
 *  3. the segments between these points are chains common to both triangles; where two chains
 *     cross in a triangle both get the crossing;
 *  4. triangulate each triangle anew with its points and chains (ConstrainedTriangulation.h);
 *     pieces without area vanish, equal ones are united, with their labels;
 *  5. rounded points lie beside the planes and edges they belong to, which may make new, tiny
 *     intersections: check again. The tolerance grows from round to round, so that what keeps
 *     intersecting is pulled together. If points are nearer than that they are merged first.
 *     Triangles of the input that are narrower than the first tolerance (what is left of a
 *     T-junction in a file whose coordinates are rounded) are closed in the first round, too.
 * Last, of an unlabelled surface only the pieces that bound the outside are kept (UnionBoundary.h),
 * unless all are asked for. Parts of the surface that take part in no intersection stay as they
 * are, inner sheets included.
 *
 * Inputs: the invariants of TriangleMesh.h but for the intersections; SourceCells, for messages.
 * Outputs: pieces have the label and source cell of their triangle. Points are appended; those that
 * are no longer used stay. For each appended point its parents: the corners of an input triangle
 * that it lies in, with its barycentric coordinates.
 * Guarantees: on Ok the invariants of TriangleMesh.h hold; points of the input are not moved, but
 * those of intersecting triangles merged if nearer than the tolerance; a triangle without
 * intersections is changed only where a neighbour's cut divides its edge, or if it is narrower than
 * the tolerance. Deterministic.
 * Failure: SelfIntersecting names the cells that still intersect after MaximumRounds (seen where
 * many triangles cross at angles of some hundred tolerances over their length); InvalidInput those
 * that cover each other with different regions on the same side; InvalidOption is for options out
 * of range. The surface is then left as it was.
 * Cost: O(n log n) per round for n triangles of bounded overlap, k^2 in a triangle with k cuts.
 *
 * Reference: D. Halperin, E. Packer, "Iterated snap rounding", Computational Geometry 23 (2002),
 * 209-225 (pulling rounded points together, in rounds).
 */
#ifndef cdmIntersectionResolver_h
#define cdmIntersectionResolver_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
enum class ResolvedPieces : unsigned char
{
  /** The boundary of the union. Surfaces with labels keep all pieces nevertheless. */
  OutsideOnly,
  /** Pieces inside stay as internal sheets. */
  All
};

struct IntersectionResolverOptions
{
  ResolvedPieces Pieces = ResolvedPieces::OutsideOnly;
  /**
   * How far points are pulled together in the first round. Model units, range >= 0; at least 1e-11
   * of the diagonal of the bounding box.
   */
  double Tolerance = 0.0;
  /** Range > 0. */
  int MaximumRounds = 12;
};

struct IntersectionResolverReport
{
  /** Rounds that cut or merged. */
  int Rounds = 0;
  Id MergedPoints = 0;
  /** Triangles of the input that were cut. */
  Id CutTriangles = 0;
  /** Pieces left out because they do not bound the outside. */
  Id InternalTriangles = 0;
};

Status ResolveIntersections(const IntersectionResolverOptions& options,
  const ExecutionContext& context, TriangleMesh& surface, std::vector<PointParents>& newPoints,
  IntersectionResolverReport& report);
} // namespace cdm

#endif
