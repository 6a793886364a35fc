// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshCertificate.h
 * @brief The certificate: evaluates any tetrahedral mesh, whoever made it.
 *
 * Basic level, which every run checks for its result:
 *  1. exact orientation of every tetrahedron, its dihedral angles, its volume;
 *  2. all facets sorted by their points: shared by at most two tetrahedra, on opposite sides, and
 *     Neighbors, if there are any, says so; outer and interface facets are the triangles of the
 *     boundary and these are facets, with the labels of the two sides;
 *  3. volume of each region against what its boundary encloses (divergence theorem), both with
 *     compensated sums in extended precision;
 *  4. circumspheres against all points of the mesh, used or not (Crit. 5.3); then Crit. 3.1 (the
 *     smallest sphere) for outer and interface facets, and Crit. 3.2 for structural edges, those
 *     where these facets do not go straight on (Def. 6.2: an edge of other than two of them, with
 *     different regions, or bent by more than a degree). On the other edges a sphere can be filled
 *     by points of the same facet only, which is harmless.
 * Full level, which solvers need, in addition:
 *  5. shape of every tetrahedron (thesis 3.1), Crit. 5.2 of facets where no tetrahedron is
 *     Delaunay, and whether the circumcenter of a tetrahedron lies beyond an outer or interface
 *     facet (which opens control volumes, Fig. 3.4), that is whether the facet's smallest sphere
 *     holds its fourth vertex;
 *  6. all edges: Crit. 3.3, and for each region the coupling of the box method, the signed area of
 *     the Voronoi facet within the region. If all tetrahedra around an edge inside of a region are
 *     Delaunay that facet is a convex polygon, and nothing is computed;
 *  7. for each region the volume of its boxes if their pieces are added up without signs, as some
 *     solvers do: where circumcenters lie outside of tetrahedra or facets it is too large, also in
 *     a mesh that is clean.
 *
 * Criteria about spheres are decided by exact predicates, against all points of the mesh. Crit. 3.3
 * and the couplings are sums of quotients, judged with a tolerance of 1e-12 of the lengths
 * (squared: of the areas) involved: on a rotated grid both should be zero, but the rounded points
 * alone can make them negative. Nor does a coupling count as negative if rounding of the
 * coordinates can make it so; far from the origin this allows for more.
 *
 * The certificate is independent of the stages that it judges. It shares with them containers,
 * formulas of Geometry, the exact predicates and incidences, but nothing that searches or decides
 * (the test core.Layers checks it).
 *
 * Points of the boundary are those of the mesh with the same id if they coincide, otherwise those
 * with equal coordinates. With labels the boundary is to be kept completely; without, triangles
 * with a point that no tetrahedron uses belong to a region that was not meshed.
 *
 * Failure: InvalidInput for ids out of range, arrays of the wrong length and coordinates that are
 * not finite. All other faults are counted, whatever their number. Deterministic for any number of
 * threads.
 * Cost: O(n log n) on meshes that are Delaunay; 64 bytes per tetrahedron for the sorted facets, at
 * the full level 120.
 * References: P. Fleischmann, thesis, 3.1, 3.2, 5.2.
 */
#ifndef cdmMeshCertificate_h
#define cdmMeshCertificate_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

#include <array>
#include <string>
#include <vector>

namespace cdm
{
/** From worst to best. */
enum class MeshVerdict
{
  /** A tetrahedron is inverted or flat, a facet is wrong, or the boundary is not kept. */
  Invalid,
  NotDelaunay,
  /** Valid and Delaunay; what the box method needs is not there, or was not looked at. */
  Delaunay,
  /** Also no coupling of the box method is negative. */
  CleanForFiniteVolumes
};

/** The faults that a simplex can have. */
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
  /** Its region; for couplings, the region of the coupling. */
  Id Region = NoId;
};

/** Quality measures of thesis 3.1. R is infinite for a flat tetrahedron; larger Q are better. */
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
  /** Volume of its parts of boxes without signs to its volume: 1 or more; infinite if flat. */
  double UnsignedBoxRatio = 1.0;
};

TetrahedronQuality GetTetrahedronQuality(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

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
  /**
   * Volume of the boxes without signs (VoronoiMeasures.h) to Volume: 1 if all circumcenters lie
   * inside, else more. Inverted and flat tetrahedra are left out. 0 at the basic level.
   */
  double UnsignedBoxRatio = 0.0;

  /** |Volume - EnclosedVolume| / |EnclosedVolume|; infinite if only the latter is zero. */
  double GetRelativeError() const;
};

/** The outer or interface facets between two regions, whichever side is in front. */
struct InterfaceSpheres
{
  /** Front <= Back. */
  RegionPair Regions;
  Id Facets = 0;
  /** Facets whose smallest sphere holds a point (Crit. 3.1). */
  Id Violations = 0;
};

/** Tetrahedra with a dihedral angle below a bound, and why (FlatTetrahedra.h). */
struct FlatterTetrahedra
{
  Id Count = 0;
  /** At sharp angles of the input. */
  Id AtSharpAngles = 0;
  /** Others with all points on outer and interface facets. */
  Id AcrossLayers = 0;

  Id GetOthers() const { return this->Count - this->AtSharpAngles - this->AcrossLayers; }
};

enum class CertificateLevel
{
  Basic,
  Full
};

enum class BoundaryUse
{
  /** The triangles have to be the mesh's outer and interface facets. */
  Facets,
  /** Any labelled triangles: only the volumes that they enclose are compared. */
  Volumes
};

struct CertificateOptions
{
  CertificateLevel Level = CertificateLevel::Basic;
  BoundaryUse Boundary = BoundaryUse::Facets;
  /** At the full level: whether to fill what there is for each tetrahedron, and Violations. */
  bool KeepsDetails = false;
};

/** For meshes from anywhere, whose boundary has triangles of its own. */
constexpr CertificateOptions FullCertificate{ CertificateLevel::Full, BoundaryUse::Volumes, true };

struct MeshCertificate
{
  /** Solvers lose digits where a volume is smaller than this ratio of the median. */
  static constexpr double TinyVolumeRatio = 1e-10;
  /** The volumes may differ by this ratio. */
  static constexpr double VolumeTolerance = 1e-12;

  CertificateLevel Level = CertificateLevel::Basic;
  Id Tetrahedra = 0;
  Id Points = 0;
  /** Points of no tetrahedron. */
  Id UnusedPoints = 0;
  /** Points of tetrahedra that coincide with another such point of smaller id. */
  Id CoincidentPoints = 0;
  /** Entries of TetMesh::Neighbors that are wrong. */
  Id WrongNeighbors = 0;
  /** Whether the facets of a boundary were compared: otherwise these two are zero. */
  bool HasBoundary = false;
  /** Outer or interface facets of the mesh that are no boundary triangle. */
  Id UnboundFacets = 0;
  /** Boundary triangles that are no facet of the mesh, or whose labels differ from its regions. */
  Id MissingBoundaryTriangles = 0;
  /** By MeshFault; from NegativeCoupling on, and NonDelaunayFacet, at the full level only. */
  std::array<Id, NumberOfMeshFaults> Faults{};
  /** Outer and interface facets, and where they do not go straight on. */
  Id BorderFacets = 0;
  Id StructuralEdges = 0;
  /** At the full level: all of them, and pairs of an edge and a region. */
  Id Facets = 0;
  Id Edges = 0;
  Id Couplings = 0;
  /** Degrees. */
  double SmallestDihedralAngle = 180.0;
  double LargestDihedralAngle = 0.0;
  FlatterTetrahedra Under5Degrees;
  FlatterTetrahedra Under10Degrees;
  FlatterTetrahedra Under15Degrees;
  /** The smallest volume of a tetrahedron as a ratio of their median; 1 if there are none. */
  double SmallestVolumeRatio = 1.0;
  /** Ascending by region. */
  std::vector<RegionVolume> Regions;
  /** Largest |Volume - EnclosedVolume| / EnclosedVolume over the regions. */
  double LargestVolumeError = 0.0;
  /** Ascending by regions. */
  std::vector<InterfaceSpheres> Interfaces;
  /** Up to ten tetrahedra at fault, for messages. */
  std::vector<Id> Examples;
  /** One for each tetrahedron. */
  std::vector<TetrahedronQuality> Qualities;
  /**
   * One for each tetrahedron: whether it is one of those, as few as can be, which together make nine
   * tenths of what the unsigned boxes of their region have too much.
   */
  std::vector<char> MakesUnsignedBoxesLarge;
  /** Ascending by fault, then by tetrahedron or by points. */
  std::vector<MeshViolation> Violations;
  /** A line that says how the mesh was made; empty if that is not known. It is not judged. */
  std::string Settings;

  Id GetCount(MeshFault fault) const { return this->Faults[static_cast<int>(fault)]; }
  Id& GetCount(MeshFault fault) { return this->Faults[static_cast<int>(fault)]; }

  MeshVerdict GetVerdict(double volumeTolerance = VolumeTolerance) const;
  /** Whether the verdict is Delaunay or better. */
  bool IsDelaunay(double volumeTolerance = VolumeTolerance) const;
  /**
   * Ready for the box method. Crit. 3.1 to 3.3 and open control volumes are counted, but not asked
   * for: they do not have to hold in every Delaunay mesh. Never so at the basic level.
   */
  bool IsClean(double volumeTolerance = VolumeTolerance) const;

  /** The verdict as it begins the text: "INVALID", "NOT DELAUNAY", "DELAUNAY", "CLEAN FOR ...". */
  const char* GetVerdictName() const;
  /**
   * A sentence: how many tetrahedra are flatter than 5 and 15 degrees, and why; empty if none is.
   */
  std::string DescribeFlatTetrahedra() const;
  /** A line: why the verdict is not better, or what it means. */
  std::string GetReasons() const;
  /**
   * Three lines: verdict, reasons, numbers; and a fourth if Settings are known. At the full level
   * the first one says so if the smallest volume is tiny.
   */
  std::string GetText() const;
};

/**
 * InvalidInput for a mesh that cannot be checked: ids out of range, arrays of the wrong length,
 * coordinates that are not finite. Neighbors are not looked at; boundary may be null.
 */
Status CheckMeshInput(const TetMesh& mesh, const TriangleMesh* boundary);

/** boundary may be null: then boundary and volumes are not compared. */
Status CertifyMesh(const TetMesh& mesh, const TriangleMesh* boundary,
  const ExecutionContext& context, MeshCertificate& certificate,
  const CertificateOptions& options = {});
} // namespace cdm

#endif
