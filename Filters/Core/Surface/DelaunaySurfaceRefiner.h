// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DelaunaySurfaceRefiner.h
 * @brief Stage 2: flips and new points until every triangle of the surface is strongly Delaunay.
 *
 * A triangle is strongly Delaunay if some sphere through its vertices holds no other point of the
 * surface or the mesh points, neither inside nor on it; triangles of one flat facet with a common
 * empty circumcircle count as one polygon. Then every Delaunay tetrahedralization of the points
 * contains the surface (Filters/Core/README.md).
 *
 * Method (thesis 6.3):
 *  1. find the structural edges (Def. 6.2), flip to saturation (recursive triangle flip, Def. 6.1);
 *  2. test each triangle by the chosen criterion, with the double sphere (Crit. 6.1) in at most two
 *     searches of the point octree, and remember the sphere that proves it. For criterion 3.2 the
 *     structural edges come before all triangles, but in stacks, the shortest first, then the
 *     smallest triangle;
 *     for 3.1 only edges of triangles that fail are tested, and the edge comes first whose
 *     encroaching point is closest to its middle;
 *  3. for a triangle that fails: flip; or split an encroached structural edge, at the foot or the
 *     partner of the encroaching point (types P and R); or mirror the encroaching point into the
 *     triangle's facet, about the edge or corner where the facets meet or along the normal; or
 *     insert the projected circumcenter found by the walk (Fig. 6.10); or split the longest edge.
 *     Points in facets come last, when no edge is left to split.
 *     Filters/Core/README.md has the rules, and says why they end;
 *  4. test again the triangles whose proving sphere holds the new point;
 *  5. if that does not end within the limits: start again with the rules for corners, with those
 *     for thin layers, with those for stacks (MatchingRules in PartnerPoints.h), with criterion 3.2
 *     if 3.1 was asked for. Then with the criterion Delaunay, which takes facets as they were first:
 *     for all of the surface, and for triangles and edges below a length only, a twentieth of the
 *     diagonal, a fifth of that and so on, as long as that ends. The least area that misses the
 *     criterion asked for is kept. Where the limits of the user leave triangles that cannot be
 *     meshed, what the criterion Delaunay needs is made beyond them;
 *  6. with an accuracy angle surface facets are curved, and points that mend one triangle may
 *     encroach on its neighbors without end. Where new points come much closer to each other than
 *     those of the input, the edges of the input triangles become structural, and the refinement
 *     starts again. The same is done where flips have made two sheets within FlatnessRatio equal.
 *
 * Guarantees: exact decisions; input points keep their coordinates and ids; new points follow them.
 * Deterministic, unless MaximumTime is reached.
 * Failure: InvalidInput for a surface that breaks the invariants of TriangleMesh.h, or that has two
 * sheets within FlatnessRatio which become the same triangles whatever edges are structural;
 * LimitReached for a MaximumEdgeLength that needs more points than ids can count.
 * Triangles that miss the criterion are listed in UnresolvedTriangles; those that cannot even be
 * meshed also in NonDelaunayTriangles: MaximumNewPoints, MinimumEdgeRatio and MaximumTime leave
 * none of these.
 * Cost: a triangle that is Delaunay takes one search of the octree, O(log n); a new point takes a
 * few searches and one query of the spheres that prove the other triangles. About 350 bytes per
 * triangle. Measured in Testing/Benchmarks/Surface.md.
 */
#ifndef cdmDelaunaySurfaceRefiner_h
#define cdmDelaunaySurfaceRefiner_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Warning.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Sizing/SizingField.h"
#include "Core/Surface/StructuralEdges.h"

namespace cdm
{
enum class SurfaceCriterion
{
  /** Criterion 5.2 by the double sphere 6.1: every triangle is part of the Delaunay mesh. */
  Delaunay = 0,
  /** Criterion 3.1: the smallest sphere of each triangle is empty (it is Gabriel). */
  SmallestSphere = 1,
  /**
   * Criterion 3.2: the smallest spheres of each triangle and of its structural edges are empty.
   * This closes the control volumes. Edges inside of a surface facet are left out: the criterion
   * would forbid obtuse angles there.
   */
  SmallestSphereAndEdges = 2
};

struct DelaunaySurfaceRefinerOptions
{
  SurfaceCriterion Criterion = SurfaceCriterion::Delaunay;
  /** What counts as flat, see StructuralEdges.h. */
  StructuralEdgeOptions StructuralEdges;
  /** Triangles with a smaller angle are refined where possible. Degrees, 0 (off) to 30. */
  double MinimumAngle = 0.0;
  /** Triangles with a larger area are refined. Square model units; 0: off. */
  double MaximumArea = 0.0;
  /** Edges longer than this are split. Model units; 0: off. */
  double MaximumEdgeLength = 0.0;
  /** Mesh points closer to the surface, as a ratio of the diagonal, are dropped. >= 0. */
  double MeshPointClearanceRatio = 1e-3;
  /**
   * No edge is made shorter than this ratio of the diagonal, except for what the criterion Delaunay
   * needs. >= 0. Far from the origin, where coordinates are rounded farther, 8 times their rounding is
   * the limit. Points of different sheets may be closer to each other: they are as close as the sheets.
   */
  double MinimumEdgeRatio = 1e-12;
  /**
   * The refinement stops when it has made this many points, except for what the criterion Delaunay
   * needs. 0: 50 for each triangle, at least 200000, or 1000000 where sizes or angles are asked for;
   * and one for each mesh point. Surfaces that need more are hardly intended: they have sheets a
   * hair apart that run into each other. Rules that are tried first may take less.
   */
  Id MaximumNewPoints = 0;
  /**
   * The refinement stops after so many seconds, except for what the criterion Delaunay needs. 0: off.
   * A result that took as long depends on the machine.
   */
  double MaximumTime = 0.0;
  /**
   * Whether the caller drops a surface that misses the criterion anywhere: rules by which parts of it
   * would miss it are not tried then, nor any after one that takes MaximumNewPoints for sizes or angles.
   * Triangles may be left that cannot be meshed.
   */
  bool IsTrial = false;
};

struct DelaunaySurfaceRefinerInput
{
  const TriangleMesh* Surface = nullptr;
  /** May be null. */
  const std::vector<Vec3>* MeshPoints = nullptr;
  /**
   * May be empty. If the spacing is anisotropic, its largest length counts: Delaunay triangles that
   * were long in one direction and short in another would need matching points on all sides.
   */
  SizingField Sizing;
  /**
   * Triangles and structural edges that a later stage wants split once each, unless the criterion
   * and the flips have changed them before.
   */
  std::vector<Id> TrianglesToSplit = {};
  std::vector<EdgeIds> EdgesToSplit = {};
  /** One for each triangle: whether MinimumAngle does not count there. May be empty. */
  std::vector<char> ExcusedTriangles = {};
};

struct DelaunaySurfaceRefinerReport
{
  Id EdgePoints = 0;
  Id FacetPoints = 0;
  Id Flips = 0;
  Id DroppedMeshPoints = 0;
  /** New points that were made beyond the limits, as there is no mesh without them. */
  Id PointsBeyondLimits = 0;
  /** Triangles that are larger than asked for, as a limit has ended the refinement. */
  Id TooCoarse = 0;
  /** Whether MaximumTime was over before all was done. */
  bool IsLate = false;
  /** Whether facets count as plane that are so but for the digits of their points (FlatFacets.h). */
  bool HasRoundedFacets = false;
};

struct DelaunaySurfaceRefinerOutput
{
  /** SourceCells: triangle of the input surface. */
  TriangleMesh Surface;
  /** One for each point after those of the input. */
  std::vector<PointParents> NewPoints;
  /** The pieces of the structural edges; Chain is that of the input surface. */
  std::vector<StructuralEdge> StructuralEdges;
  /** Ids of the mesh points that are kept, ascending. */
  std::vector<Id> KeptMeshPoints;
  /** Triangles that do not fulfil the criterion, or have an edge that does not, ascending. */
  std::vector<Id> UnresolvedTriangles;
  /** Unresolved triangles whose smallest spheres are not empty though the criterion asks for it. */
  std::vector<Id> WeakTriangles;
  /** Unresolved triangles that are not strongly Delaunay: no mesh can be made with them. */
  std::vector<Id> NonDelaunayTriangles;
  DelaunaySurfaceRefinerReport Report;
  std::vector<Warning> Warnings;
};

Status RefineDelaunaySurface(const DelaunaySurfaceRefinerInput& input,
  const DelaunaySurfaceRefinerOptions& options, const ExecutionContext& context,
  DelaunaySurfaceRefinerOutput& output);
} // namespace cdm

#endif
