// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshChecks.h
 * @brief Recomputes from a mesh alone whether it is what the engine promises.
 *
 * Shares no code with the stages but the exact predicates.
 *
 * Method:
 *  1. exact orientation of every tetrahedron, its dihedral angles, its volume;
 *  2. all facets sorted by their points: shared by at most two tetrahedra, on opposite sides, and
 *     Neighbors says so; outer and interface facets are the triangles of the boundary and these
 *     are facets, with the labels of the two sides;
 *  3. volume of each region against what its boundary encloses (divergence theorem), both with
 *     compensated sums in extended precision;
 *  4. circumspheres against all points of the mesh, used or not, with the exact predicate; then the
 *     criteria 3.1 and 3.2 for the outer and interface facets, which IsValid() does not ask for.
 *
 * Points of the boundary are those of the mesh with the same id if they coincide, otherwise those
 * with equal coordinates. With labels the boundary is to be kept completely; without, triangles
 * with a point that no tetrahedron uses belong to a region that was not meshed.
 *
 * Failure: InvalidInput for ids out of range, arrays of the wrong length and coordinates that are
 * not finite. All other faults are counted, whatever their number.
 * Cost: O(n log n) on meshes that are Delaunay; the points in circumspheres are searched in a tree
 * of its own (EmptySphereSearch.h). 64 bytes per tetrahedron for the sorted facets.
 */
#ifndef cdmMeshChecks_h
#define cdmMeshChecks_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

#include <string>

namespace cdm
{
struct RegionVolume
{
  Id Region = NoId;
  Id Tetrahedra = 0;
  double Volume = 0.0;
  /**
   * Volume enclosed by the boundary triangles that carry the region's label; without labels by
   * those that bound the region's tetrahedra.
   */
  double EnclosedVolume = 0.0;

  /** |Volume - EnclosedVolume| / |EnclosedVolume|; infinite if only the latter is zero. */
  double GetRelativeError() const;
};

/** The outer or interface facets between two regions, whichever side is in front. */
struct InterfaceSpheres
{
  /** Front <= Back. */
  RegionPair Regions;
  Id Facets = 0;
  /** Those whose smallest sphere holds a point (Crit. 3.1). */
  Id Violations = 0;
};

struct MeshCheckReport
{
  Id Tetrahedra = 0;
  Id Points = 0;
  /** Points of no tetrahedron. */
  Id UnusedPoints = 0;
  /** Points of tetrahedra that coincide with another such point of smaller id. */
  Id CoincidentPoints = 0;
  Id InvertedTetrahedra = 0;
  Id FlatTetrahedra = 0;
  /** Facets with more than two tetrahedra, or two on the same side. */
  Id OverfullFacets = 0;
  /** Entries of TetMesh::Neighbors that are wrong. */
  Id WrongNeighbors = 0;
  /** Tetrahedra with a mesh point strictly inside of their circumsphere. */
  Id NonDelaunayTetrahedra = 0;
  /** Whether a boundary was given: otherwise these two and the volume error are zero. */
  bool HasBoundary = false;
  /** Outer or interface facets of the mesh that are no boundary triangle. */
  Id UnboundFacets = 0;
  /** Boundary triangles that are no facet of the mesh, or whose labels differ from its regions. */
  Id MissingBoundaryTriangles = 0;
  /** Boundary and interface triangles whose smallest sphere holds a point (Crit. 3.1). */
  Id SmallestSphereViolations = 0;
  /** Edges of those triangles whose smallest sphere holds a point (Crit. 3.2). */
  Id EdgeSphereViolations = 0;
  /** Largest |Volume - EnclosedVolume| / EnclosedVolume over the regions. */
  double LargestVolumeError = 0.0;
  /** Degrees. */
  double SmallestDihedralAngle = 180.0;
  double LargestDihedralAngle = 0.0;
  /** Ascending by region. */
  std::vector<RegionVolume> Regions;
  /** Ascending by regions. */
  std::vector<InterfaceSpheres> Interfaces;
  /** Up to ten tetrahedra at fault, for messages. */
  std::vector<Id> Examples;

  /** No inverted, flat, non-Delaunay tetrahedron, no wrong facet, the boundary kept. */
  bool IsValid(double volumeTolerance = 1e-12) const;
  /** One line of text. */
  std::string GetSummary() const;
  /** Another one: where the smallest spheres of the boundary are empty (Crit. 3.1). */
  std::string GetSphereSummary() const;
};

/**
 * InvalidInput for what no check can look at: ids out of range, arrays of the wrong length,
 * coordinates that are not finite. Neighbors are left alone; boundary may be null.
 */
Status CheckMeshInput(const TetMesh& mesh, const TriangleMesh* boundary);

/** boundary may be null: then boundary and volumes are not compared. */
Status CheckTetMesh(const TetMesh& mesh, const TriangleMesh* boundary,
  const ExecutionContext& context, MeshCheckReport& report);

/**
 * The invariants of TetMesh.h, one tetrahedron by itself: InvalidInput names those that are
 * inverted, flat, or have wrong points or neighbors. What stages ask for that change a mesh.
 */
Status CheckMeshInvariants(const TetMesh& mesh, int numberOfThreads);

/**
 * Neighbors of tetrahedra from their vertices alone; for meshes that come from outside. Threads: 0:
 * one for each processor core. No check: it takes SimplexIncidence.h.
 */
Status BuildNeighbors(TetMesh& mesh, int numberOfThreads = 1);
} // namespace cdm

#endif
