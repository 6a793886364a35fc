// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshCriteria.h
 * @brief The certificate: what a tetrahedral mesh is worth to a box-method or finite element
 * solver.
 *
 * Takes any tetrahedra, valid or not, and needs no neighbours. Method:
 *  1. orientation (exact), shape (thesis 3.1) and Crit. 5.3 of every tetrahedron;
 *  2. facets, gathered at their lowest point: more than two tetrahedra or two on one side; Crit.
 *     5.2 where no tetrahedron at the facet is Delaunay (otherwise it holds); outer and interface
 *     facets: Crit. 3.1, and whether the circumcenter of a tetrahedron lies beyond (which opens
 *     control volumes, Fig. 3.4), that is whether the facet's smallest sphere holds its fourth
 *     vertex;
 *  3. structural edges, those where these facets do not go straight on (Def. 6.2: an edge of other
 *     than two of them, with different regions, or bent by more than a degree): Crit. 3.2. On the
 *     other edges a sphere can be filled by points of the same facet only, which is harmless;
 *  4. all edges, gathered at their lowest point: Crit. 3.3, and for each region the coupling of the
 *     box method, the signed area of the Voronoi facet within the region. If all tetrahedra around
 *     an edge inside of a region are Delaunay that facet is a convex polygon, and nothing is
 *     computed;
 *  5. the volume of each region, compared with that enclosed by the boundary, or without one by the
 *     region's outer and interface facets.
 *
 * What is about spheres is decided by exact predicates, against all points of the mesh. 3.3 and the
 * couplings are sums of quotients, judged with a tolerance of 1e-12 of the lengths (squared: of the
 * areas) involved: on a rotated grid, where both are zero, rounded points alone leave more than
 * exact arithmetic could forgive. A coupling is not called negative either if rounding the
 * coordinates can make it so, which far from the origin is more.
 *
 * Failure: InvalidInput for ids out of range, arrays of the wrong length and coordinates that are
 * not finite. All other faults are listed. Deterministic for any number of threads.
 * Cost: O(n log n), 120 bytes per tetrahedron beside the report.
 * References: P. Fleischmann, thesis, 3.1, 3.2, 5.2.
 */
#ifndef cdmMeshCriteria_h
#define cdmMeshCriteria_h

#include "Core/Certificate/MeshChecks.h"

#include <array>
#include <string>
#include <vector>

namespace cdm
{
/** What a simplex can be at fault with. */
enum class MeshFault
{
  InvertedTetrahedron,
  FlatTetrahedron,
  /** A facet of more than two tetrahedra, or of two on one side of it. */
  OverfullFacet,
  /** Crit. 5.3. */
  NonDelaunayTetrahedron,
  /** Crit. 5.2. */
  NonDelaunayFacet,
  /** Crit. 3.1, outer and interface facets. */
  FacetSphere,
  /** Crit. 3.2, structural edges. */
  EdgeSphere,
  /** A tetrahedron whose circumcenter lies beyond one of these facets. */
  OpenControlVolume,
  /** An edge, in one region. */
  NegativeCoupling,
  /** Crit. 3.3, an edge. */
  NegativeCotangentSum
};
constexpr int NumberOfMeshFaults = 10;

struct MeshViolation
{
  MeshFault Fault = MeshFault::InvertedTetrahedron;
  /** Two, three or four points; NoId after them. */
  std::array<Id, 4> Points{ NoId, NoId, NoId, NoId };
  /** The tetrahedron, or one that has the facet or edge. */
  Id Tetrahedron = NoId;
  /** Its region; of couplings, the region of the coupling. */
  Id Region = NoId;
};

/** Thesis 3.1. Of a flat tetrahedron R is infinite; greater Q are better. */
struct TetrahedronQuality
{
  /** l_min / R, r / l_max, r / R, l_min / l_max, V / l_max^3 (signed). */
  std::array<double, 5> Q{};
  /** Degrees. */
  double SmallestDihedralAngle = 0.0;
  double LargestDihedralAngle = 0.0;
  /** R / l_min: 0.61 for a regular tetrahedron. */
  double RadiusEdgeRatio = 0.0;
  /** R / r, 1 / Q3: 3 for a regular tetrahedron. */
  double AspectRatio = 0.0;
};

TetrahedronQuality GetTetrahedronQuality(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

struct MeshCriteriaReport
{
  Id Tetrahedra = 0;
  Id Points = 0;
  /** Points of tetrahedra that coincide with another such point of smaller id. */
  Id CoincidentPoints = 0;
  Id Facets = 0;
  /** Outer and interface facets. */
  Id BorderFacets = 0;
  Id StructuralEdges = 0;
  Id Edges = 0;
  /** Pairs of an edge and a region. */
  Id Couplings = 0;
  /** By MeshFault. */
  std::array<Id, NumberOfMeshFaults> Faults{};
  /** Tetrahedra with a dihedral angle below. */
  Id Under5Degrees = 0;
  Id Under10Degrees = 0;
  /** Degrees. */
  double SmallestDihedralAngle = 180.0;
  double LargestDihedralAngle = 0.0;
  /** Ascending by region. */
  std::vector<RegionVolume> Regions;
  /** Largest |Volume - EnclosedVolume| / EnclosedVolume over the regions. */
  double LargestVolumeError = 0.0;
  /** One for each tetrahedron. */
  std::vector<TetrahedronQuality> Qualities;
  /** Ascending by fault, then by tetrahedron or by points. */
  std::vector<MeshViolation> Violations;

  Id GetCount(MeshFault fault) const { return this->Faults[static_cast<int>(fault)]; }
  /**
   * Ready for the box method: a valid mesh, Delaunay, without negative couplings. Crit. 3.1 to 3.3
   * and open control volumes are counted, but not asked for: they do not have to hold in every
   * Delaunay mesh.
   */
  bool IsClean(double volumeTolerance = 1e-12) const;
  /** One line of text. */
  std::string GetCertificate() const;
};

/**
 * Neighbors are not used. boundary may be null; if it has labels the volumes that it encloses are
 * compared.
 */
Status EvaluateMeshCriteria(const TetMesh& mesh, const TriangleMesh* boundary,
  const ExecutionContext& context, MeshCriteriaReport& report);
} // namespace cdm

#endif
