// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AdvancingFrontTetrahedralizer.h
 * @brief Stage 3: grows the Delaunay tetrahedralization of each region from its boundary.
 *
 * Method (thesis 6.4):
 *  1. tetrahedralize all points, which answers for every facet which point in front of it has the
 *     smallest lambda (Crit. 6.2): one incremental construction is two to nine times as fast as the
 *     searches of the thesis, facet by facet, and does not depend on how the points are
 *     distributed;
 *  2. test that each triangle of the surface is strongly Delaunay; flip the diagonals inside of
 *     cocircular facets to those of the pulling rule (SurfaceFacets.h);
 *  3. take the tetrahedron at a side of a triangle of each enclosed region, or at a given seed, and
 *     put it into the front;
 *  4. facets of the front meet their like (Lemma 6.1), or a triangle of the surface, where the
 *     front stops, or get the tetrahedron beyond; go on until the front is empty (Lemma 6.2);
 *  5. number what is meshed by its vertices (CanonicalNumbering.h).
 *
 * Regions: with labels a side of a triangle belongs to its label, and sides labelled
 * OutsideRegion are not meshed. Without labels every enclosed segment gets an id from 0 on, and the
 * unbounded outside is not meshed. With seeds only the regions that hold one are meshed.
 *
 * Guarantees: tetrahedra are positively oriented, none is flat; their circumspheres are empty of
 * all points (exact); the mesh depends on the numbering of the points only, the order of its
 * tetrahedra (along the curve, by their first vertices) on the points alone. Points keep their
 * coordinates; Boundary is the surface with diagonals of cocircular facets flipped.
 * Failure: NotDelaunay names the triangles that are not strongly Delaunay; NotClosed those that
 * contradict each other's labels or enclose nothing; SelfIntersecting those of a flat facet that
 * overlap. InvalidInput is, without a surface, for fewer than four points, and for collinear or
 * coplanar ones. Aborted leaves a valid partial mesh and its front, empty before step 4.
 *
 * Cost: O(n log n) for usual distributions; 49 bytes per tetrahedron of the convex hull and 83 per
 * point at the peak. See Testing/Benchmarks/README.md.
 */
#ifndef cdmAdvancingFrontTetrahedralizer_h
#define cdmAdvancingFrontTetrahedralizer_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Warning.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
struct RegionSeed
{
  Vec3 Position;
  Id Region = 0;
};

struct AdvancingFrontTetrahedralizerOptions
{
  /**
   * Where the surface is open, close the mesh with triangles on the convex hull of the points
   * (thesis 6.4.2); otherwise an open region is an error. Without any triangle the mesh fills the
   * convex hull of all points, in one region 0, and Boundary is the hull.
   */
  bool CloseOpenBoundary = false;
  /** Stop after this many tetrahedra and leave the front as it is. 0: no limit. */
  Id MaximumNumberOfTetrahedra = 0;
};

struct AdvancingFrontTetrahedralizerInput
{
  /** May be null or without triangles if CloseOpenBoundary is on. */
  const TriangleMesh* Surface = nullptr;
  /** May be null. Points outside of all meshed regions are not used, and counted. */
  const std::vector<Vec3>* MeshPoints = nullptr;
  /** May be null or empty: all enclosed regions are meshed. */
  const std::vector<RegionSeed>* Seeds = nullptr;
};

struct AdvancingFrontTetrahedralizerReport
{
  /** Mesh points that lie in no meshed region, and copies of points. */
  Id UnusedMeshPoints = 0;
  /** Triangles with no meshed region on either side, ascending. */
  std::vector<Id> UnusedTriangles;
  Id TurnedDiagonals = 0;
  Id NumberOfRegions = 0;
};

struct AdvancingFrontTetrahedralizerOutput
{
  /** Points: those of the surface in their order, then the used mesh points. */
  TetMesh Mesh;
  /** Input mesh point of each point after those of the surface. */
  std::vector<Id> MeshPointSources;
  /**
   * The surface that bounds the mesh and its regions, on the points of Mesh; with Labels. A
   * triangle made to close an open boundary has SourceCells NoId. Unused triangles are left out,
   * unless the mesh is unfinished.
   */
  TriangleMesh Boundary;
  /** Triangles of the front left by an abort or the limit, fronts to the unmeshed side. */
  std::vector<TriangleIds> Front;
  AdvancingFrontTetrahedralizerReport Report;
  std::vector<Warning> Warnings;
};

Status TetrahedralizeByAdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
  const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
  AdvancingFrontTetrahedralizerOutput& output);
} // namespace cdm

#endif
