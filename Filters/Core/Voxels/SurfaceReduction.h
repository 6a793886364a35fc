// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceReduction.h
 * @brief Reduces the triangles of a surface, within a bound of the distance from the original.
 *
 * Method (thesis 3.5.2):
 *  1. structural edges (StructuralEdges.h) and their corners: a point inside of a patch may be
 *     merged into any neighbor, a point of a chain into the next one along it, a corner stays; so
 *     does a point where patches touch that have no edge in common;
 *  2. what a merge costs: the old triangles at the point and the new ones are two surfaces over one
 *     plane, and points above each other belong together. These differ most where edges cross, and
 *     at the point itself; a point of a chain goes to the nearest point of the new edge first. The
 *     difference is added to the deviation that the old triangles have already, which is then that
 *     of the new ones: so a deviation bounds the distance of both surfaces, in both directions;
 *  3. merges by cost (deviation, plus a small part of the length of the edge: short edges first),
 *     as long as the deviation is within its bound, no topology changes (MergeableSurface.h), no
 *     triangle turns by more than about 70 degrees, and bent triangles do not become needles;
 *  4. the new triangles must not meet others, decided exactly (TriangleIntersection.h); nothing may
 *     lie between the old and the new ones; and around edges of three or more triangles the regions
 *     have to follow one on the other as before. Merges within the planes of all triangles,
 *     exactly, need no such test: with a bound of 0 these are left.
 *
 * Inputs: the invariants of TriangleMesh.h, with labels. Guarantees: these invariants are kept, and
 * so are the labels on both sides and the topology; corners keep their positions. Deterministic.
 * Failure: as of ExtractStructuralEdges. After a failure or an abort the surface is left alone.
 * Cost: O(n log n), about 40 microseconds for a removed point; 500 bytes per point.
 * References: C. L. Bajaj, D. R. Schikore, "Error-bounded reduction of triangle meshes with
 * multivariate data", 1996, doi:10.1117/12.234674 (the deviation of one merge); T. K. Dey,
 * H. Edelsbrunner, S. Guha, D. V. Nekhayev, "Topology preserving edge contraction", 1999 (the link
 * condition for surfaces that are no manifolds).
 */
#ifndef cdmSurfaceReduction_h
#define cdmSurfaceReduction_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
struct SurfaceReductionOptions
{
  /** Largest distance of the new surface from the old one, anywhere. Model units, >= 0. */
  double MaximumDeviation = 0.0;
  /** Degrees, 0 to 180: edges that bend by more are structural. */
  double FeatureAngle = 60.0;
  /**
   * Empty, or a number for each triangle, 0 for those between two regions: edges between triangles
   * of different numbers are structural.
   */
  std::vector<unsigned char> Patches;
};

struct SurfaceReductionReport
{
  Id RemovedPoints = 0;
  /** Largest bound of the distance, over all triangles. Model units. */
  double LargestDeviation = 0.0;
};

/**
 * Removed points are dropped from the list; the other points, and the triangles, keep their order.
 */
Status ReduceSurface(const SurfaceReductionOptions& options, const ExecutionContext& context,
  TriangleMesh& surface, SurfaceReductionReport& report);
} // namespace cdm

#endif
