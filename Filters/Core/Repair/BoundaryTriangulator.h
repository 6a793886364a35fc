// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryTriangulator.h
 * @brief Stage 0: from a soup of polygons to a clean, well connected triangulated surface.
 *
 * Method (thesis 3.5 and 6.3):
 *  1. refuse points that are not finite; merge coincident points (exactly, or within a tolerance:
 *     CoincidentPoints.h);
 *  2. drop repeated vertices and degenerate polygons;
 *  3. split polygon edges at the vertices that lie on them (T-junctions, Fig. 3.16, TJunctions.h);
 *     then drop duplicate polygons, whose labels are united;
 *  4. triangulate every polygon by recursive splitting with exact signs, in the projection along
 *     the largest component of its normal (PolygonTriangulation.h); outlines bridged to holes and
 *     collinear vertices are welcome. A non-planar polygon is triangulated in that same projection;
 *  5. trace open edges into rings and patch those of at most MaximumGapEdges edges (GapPatches.h),
 *     unless the patch would meet the surface (a lone triangle is no hole, nor is a flat sheet);
 *  6. find all pairs of triangles that cross, overlap or touch other than in a common edge or
 *     vertex, exactly (TriangleIntersection.h); as an option split them along their intersections
 *     (IntersectionResolver.h);
 *     A surface of triangles without a tolerance is searched for them first: if there are none,
 *     steps 3 and 4 have nothing to do;
 *  7. reverse the triangles whose orientation is wrong, where labels or closure tell
 *     (SurfaceOrientation.h).
 *
 * What a tolerance of zero does not mend: a vertex beside an edge, off by a rounding error (as when
 * a slanted edge is divided in single precision), is no T-junction but opens a gap. Give a
 * MergeTolerance above the precision of the coordinates then.
 * Rings that stay open even if MaximumGapEdges allows them: those that are simple in no projection
 * along an axis, and those whose patch would meet the surface. For the border of a Moebius strip
 * there is none that does not: a strip and a disc make a projective plane, which always crosses
 * itself in space. Where intersections are resolved a patch may cross the surface, but not lie in
 * it.
 *
 * Guarantees: on Ok the surface has the invariants stated in TriangleMesh.h (with
 * RefuseSelfIntersections off, but for the intersections listed); the input points that are used
 * keep their exact coordinates. Deterministic.
 * Uniting labels: a side labelled OutsideRegion takes the region that a copy of the polygon has on
 * that side; two different regions on one side contradict each other.
 * Failure: InvalidInput names cells or points, SelfIntersecting the cells that intersect (unless
 * they are only to be reported); InvalidOption and LimitReached see Status.h. The output is then
 * empty except for Problems and Report.
 * Cost: O(n log n) for n triangles of bounded overlap.
 */
#ifndef cdmBoundaryTriangulator_h
#define cdmBoundaryTriangulator_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Warning.h"
#include "Core/Meshes/PolygonSoup.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Repair/IntersectionResolver.h"

namespace cdm
{
struct BoundaryTriangulatorOptions
{
  /**
   * Points closer than this are merged (the lowest id stays), and a vertex closer than this to an
   * edge splits it. Model units; 0: only equal coordinates, only vertices exactly on the edge.
   * Range >= 0.
   */
  double MergeTolerance = 0.0;
  /** Rings of at most this many open edges are patched. 0: none. Range >= 0. */
  Id MaximumGapEdges = 0;
  /** False: a self-intersection is listed in Problems, and the surface is made all the same. */
  bool RefuseSelfIntersections = true;
  /** Split triangles that intersect along their intersections instead. */
  bool ResolveSelfIntersections = false;
  /** What stays of a surface whose self-intersections were resolved. */
  ResolvedPieces Pieces = ResolvedPieces::OutsideOnly;
};

enum class SurfaceProblemKind : unsigned char
{
  /** Two triangles cross, overlap or touch; SegmentBegin/End: where. */
  SelfIntersection,
  /** A polygon without area, dropped. */
  DegeneratePolygon,
  /** A polygon that repeats another one (OtherCell), or has a triangle in common; dropped. */
  DuplicatePolygon,
  /** A polygon whose outline crosses itself so that no triangulation exists. */
  InvalidOutline,
  /** A vertex (SegmentBegin and End) that lies on an edge of Cell: the edge was split there. */
  TJunction,
  /** An open edge of a ring that was patched. */
  PatchedGap,
  /** An open edge left as it is. */
  OpenEdge,
  /** A polygon against the orientation of the others; its triangles were reversed. */
  ReversedPolygon
};

/** One finding, with the cells of the input it concerns and a segment (or point) to look at. */
struct SurfaceProblem
{
  SurfaceProblemKind Kind = SurfaceProblemKind::SelfIntersection;
  Id Cell = NoId;
  Id OtherCell = NoId;
  Vec3 SegmentBegin;
  Vec3 SegmentEnd;
};

struct BoundaryTriangulatorReport
{
  Id MergedPoints = 0;
  /** Points of the input that are in no triangle, other than the merged ones. */
  Id UnusedPoints = 0;
  Id RepeatedVertices = 0;
  Id DegeneratePolygons = 0;
  Id DuplicatePolygons = 0;
  /** Triangles that different polygons have in common, dropped but for one. */
  Id DuplicateTriangles = 0;
  /** Vertices on edges, counted for each polygon at the edge. */
  Id TJunctions = 0;
  /** Polygons that leave their mean plane by more than 1e-6 of their extent. */
  Id NonPlanarPolygons = 0;
  Id PatchedRings = 0;
  Id OpenEdges = 0;
  Id NonManifoldEdges = 0;
  Id ReversedPolygons = 0;
  /** Pairs of triangles, before they are resolved. The search stops at a million. */
  Id SelfIntersections = 0;
  /** Resolved self-intersections. */
  IntersectionResolverReport Resolution;
};

struct BoundaryTriangulatorOutput
{
  /** SourceCells: polygon of the input (for a patch the polygon at its first edge). */
  TriangleMesh Surface;
  /**
   * For each of the first points of Surface the input point whose coordinates and data it has. All
   * points, unless self-intersections were resolved.
   */
  std::vector<Id> PointSources;
  /** For each of the other points of Surface: parents, as ids of points of the input. */
  std::vector<PointParents> NewPoints;
  std::vector<SurfaceProblem> Problems;
  /** What was dropped. */
  std::vector<Warning> Warnings;
  BoundaryTriangulatorReport Report;
};

Status TriangulateBoundary(const PolygonSoup& input, const BoundaryTriangulatorOptions& options,
  const ExecutionContext& context, BoundaryTriangulatorOutput& output);
} // namespace cdm

#endif
