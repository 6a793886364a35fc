// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VolumeRefinement.h
 * @brief Steiner points inside of the regions, for a boundary that stays as it is.
 *
 * Method:
 *  - tetrahedra that break a limit, the largest first, then the worst shaped, get a point at the
 *    circumcenter or off-center (TetrahedronLimits.h); if it disturbs triangles or structural edges
 *    of the boundary (BoundarySpheres.h), that which it disturbs most is requested to be split
 *    instead;
 *  - tetrahedra with a small dihedral angle, worst first: a free point of it is taken out of the
 *    mesh and put in again at the best of some hundred places around, or left out if that is
 *    better. A place is rated by the smallest dihedral angle of all tetrahedra that it would make,
 *    before anything is changed. If no point's move helps, a new point is tried in the same way, at
 *    last the boundary that is in the way is requested to be split. Each change makes the smallest
 *    angle of what it replaces larger, and breaks no limit where all were kept. Tetrahedra across
 *    sharp input angles do not count, they only must not get worse; their turn is the last.
 *
 * Sharp input angles would be refined for ever: a tetrahedron across one (SharpAngles.h) is refined
 * for its size only; if it is a sliver, its points are moved. Each point has a size, the shortest
 * edge at it before any shape was refined, or how close edges of the boundary come to each other
 * there (FeatureSizes.h), and at most the size of another point and the way from there; no point
 * comes closer to it than a twentieth of that, but for size limits. Of tetrahedra across a thin
 * layer (ThinLayers.h) only the size counts. Nor is a tetrahedron refined for its shape whose
 * points all belong to the boundary and lie in one plane but for rounding, as those of turned
 * devices do: new points on the boundary would have more of the kind.
 *
 * References: J. R. Shewchuk, "Tetrahedral mesh generation by Delaunay refinement", 1998,
 * doi:10.1145/276884.276894 (what is split instead, and why it ends); J. Tournois, R. Srinivasan,
 * P. Alliez, "Perturbing slivers in 3D Delaunay meshes", 2009, doi:10.1007/978-3-642-04319-2_10
 * (moved points).
 */
#ifndef cdmVolumeRefinement_h
#define cdmVolumeRefinement_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Improvement/BoundaryRequests.h"
#include "Core/Improvement/BoundaryShape.h"
#include "Core/Improvement/BoundarySplits.h"
#include "Core/Improvement/SliverMemory.h"
#include "Core/Improvement/TetrahedronFacts.h"
#include "Core/Sizing/TetrahedronLimits.h"

#include <memory>
#include <vector>

namespace cdm
{
/** A point inside of a region. */
struct InteriorPoint
{
  Vec3 Position;
  /** No other point comes closer than a twentieth of this; 0: no bound. */
  double Size = 0.0;
  /** Whether it may be moved and removed. */
  bool IsFree = false;
  /** Where it comes from, to the caller; NoId for new and moved points. */
  Id Source = NoId;
  /** See SliverMemory. */
  Id Name = NoId;
};

struct VolumeRefinementOptions
{
  TetrahedronLimits Limits;
  Id MaximumNewPoints = 0;
  /** So many points may be added to the surface by SplitBoundary(). */
  Id Reserve = 0;
  /** Of structural edges, degrees: see SharpAngles. */
  double SharpPlaneAngle = UsualSharpPlaneAngle;
};

/** What may be done about slivers; each also what is above it. */
enum class SliverMeans
{
  /** Free points are moved. */
  Moves,
  /** They are also taken out, and new ones put in. */
  Points,
  /** What is in the way in the boundary is requested to be split. */
  Requests
};

struct VolumeRefinementReport
{
  Id InsertedPoints = 0;
  Id MovedPoints = 0;
  Id RemovedPoints = 0;
};

class VolumeRefinement
{
public:
  /**
   * The mesh has the points of the surface, then the interior points. It is Delaunay; by the
   * pulling rule it stays if it is. The surface's triangles are those of its outer and interface
   * facets whose smallest spheres are empty, and stay so; points are put in only where no other
   * outer facet is near.
   * @param surface outlives the object, as all edges do; they change with SplitBoundary() only
   * @param edges structural ones of the surface, sorted
   * @param keptEdges edges of the surface whose smallest spheres are empty, and stay so
   * @param surfaceSizes as InteriorPoint::Size, one for each point of the surface, or empty
   * @param memory is kept from one boundary to the next, which has more points
   */
  VolumeRefinement(TetMesh mesh, TriangleMesh& surface, std::vector<StructuralEdge>& edges,
    const std::vector<StructuralEdge>& keptEdges, const std::vector<double>& surfaceSizes,
    const std::vector<InteriorPoint>& interior, SliverMemory& memory,
    const VolumeRefinementOptions& options = VolumeRefinementOptions());

  /** One for each point of the surface: whether it has not been there, or has been elsewhere. */
  void NoteNewPoints(const std::vector<char>& isNew);
  /** As InteriorPoint::Size, one for each point of the mesh. */
  void SetSizes(const std::vector<double>& sizes);
  /** Free points closer to another one than this, or than 0.3 of the sizing, which may be empty. */
  void RemoveClosePoints(double smallest, const SizingField& sizing);
  /** Until no tetrahedron breaks a limit, but for those that need the boundary split. */
  Status RefineByLimits(bool isShapeTested, const ExecutionContext& context);
  /** Until nothing of what may be done makes angles below the target (degrees) larger. */
  Status PerturbSlivers(double target, SliverMeans means, const ExecutionContext& context);

  /** Moves points of tetrahedra across sharp angles, as far as all others stay as good. */
  Status PerturbSharp(double target, const ExecutionContext& context);

  /** Tetrahedra with a smaller angle, but for those across thin layers and sharp angles. */
  std::size_t CountSlivers(double target) const;

  /**
   * Moves points of the surface that are corners of slivers. Afterwards it has to be seen whether
   * they are in smallest spheres on the other side of outer facets: the surface gets its points,
   * and SplitBoundary() is called, or a new mesh is made.
   * @param isFree one for each point of the surface, whether it may be moved
   * @param areEdgesKept whether smallest spheres of the kept edges stay empty, too
   * @return where the surface's points are now
   */
  std::vector<Vec3> MoveSurfacePoints(
    double target, const std::vector<char>& isFree, bool areEdgesKept);

  /**
   * Edges of the boundary with a negative coupling, or triangles at those within facets.
   * @return how many edges there are, whether they may be split or not
   */
  std::size_t RequestNegativeCouplings();

  /** What is to be split in the boundary. */
  const BoundaryRequests& GetRequests() const { return this->Requests; }

  /**
   * Splits what is requested in the boundary, and whatever that disturbs, in the mesh itself.
   * @param options those that have made the surface
   * @return whether all is done: if not, the surface is as far as the mesh is, what is left is
   *   still requested, and a new mesh has to be made; this object is good for nothing more
   */
  bool SplitBoundary(const DelaunaySurfaceRefinerOptions& options, const SizingField& sizing,
    const ExecutionContext& context, Status& status);
  /** As InteriorPoint::Size, of new points of the surface, from the first one on. */
  void SetSurfaceSizes(Id first, const std::vector<double>& sizes);

  /** Tetrahedra that are there by rounding. */
  std::vector<Id> FindFlatTetrahedra() const;

  /** The points that are in the mesh now. */
  std::vector<InteriorPoint> GetInterior() const;
  const TetMesh& GetMesh() const { return this->Mesh.GetMesh(); }
  /** Without gaps: points are those of the surface, then those of GetInterior(). */
  TetMesh MakeMesh() const;
  const VolumeRefinementReport& GetReport() const { return this->Report; }
  /** Whether it has made as many points as it may. */
  bool IsFull() const { return this->Report.InsertedPoints >= this->MaximumNewPoints; }

  const ThinLayers& GetLayers() const { return this->Shape->Layers; }
  const SharpAngles& GetSharpAngles() const { return this->Shape->Sharp; }

private:
  struct Task
  {
    TetrahedronFault Fault;
    double Severity;
    Id Tetrahedron;
    std::int64_t Stamp;

    /** Large ones first, then the most severe fault, then the smallest id. */
    friend bool operator<(const Task& a, const Task& b)
    {
      return a.Fault != b.Fault    ? a.Fault > b.Fault
        : a.Severity != b.Severity ? a.Severity < b.Severity
                                   : a.Tetrahedron > b.Tetrahedron;
    }
  };
  void BoundSizes(const std::vector<Id>& tetrahedra);
  bool IsFree(Id point) const;
  std::array<Vec3, 4> GetVertices(const TetrahedronIds& ids) const;
  double GetAngle(Id tetrahedron) const { return this->Facts.GetAngle(tetrahedron); }
  bool IsInLayer(Id tetrahedron) const { return this->Facts.IsInLayer(tetrahedron, *this->Shape); }
  bool IsAcrossSharp(Id tetrahedron) const
  {
    return this->Facts.IsAcrossSharp(tetrahedron, *this->Shape);
  }
  bool IsFlat(Id tetrahedron) const;
  /** What a change is for. */
  struct Aim
  {
    /** Degrees; larger angles are as good. */
    double Target;
    /** Whether tetrahedra across sharp angles are to get better ones, or all others. */
    bool IsSharp;
  };
  /** The smallest angles of tetrahedra that a change replaces, or makes. */
  struct SmallestAngles
  {
    /** Of those that it is for. */
    double Aimed = 180.0;
    double Other = 180.0;
  };
  void Include(const Aim& aim, Id tetrahedron, SmallestAngles& smallest) const;
  static double GetFloor(const Aim& aim, const SmallestAngles& before);
  double RateHole(const Vec3& position, const Aim& aim, double floor, double required) const;
  bool BreaksLimit(const TetrahedronIds& ids, const std::array<Vec3, 4>& vertices) const;
  bool BreaksLimit(Id tetrahedron) const;
  Id CountBroken(const Vec3& position) const;
  bool IsClear(const Vec3& position) const;
  bool DisturbsBoundary(const Vec3& position);
  bool TouchesOpenFacet() const;
  void AddPoint(const Vec3& position);
  bool Move(Id point, const Aim& aim);
  bool InsertBest(Id tetrahedron, const Aim& aim);
  TetrahedronIds GetNames(const TetrahedronIds& ids) const;
  void NoteChanges();
  struct Sliver
  {
    double Angle;
    Id Tetrahedron;
    std::int64_t Stamp;
  };
  bool IsSliver(const Aim& aim, Id tetrahedron) const;
  std::vector<Sliver> FindSlivers(const Aim& aim) const;
  bool Mend(const Sliver& sliver, const Aim& aim, SliverAttempt last);

  DynamicTetrahedralization Mesh;
  TriangleMesh& Surface;
  std::vector<StructuralEdge>& Edges;
  const std::vector<StructuralEdge>& KeptEdges;
  const TetrahedronLimits Limits;
  /** Of the mesh's points; those of the surface, and places for new ones, come before. */
  const Id FirstInside;
  Id MaximumNewPoints;
  SliverMemory& Memory;
  /** Of the surface as it is. */
  std::unique_ptr<BoundaryShape> Shape;
  std::unique_ptr<BoundarySplits> Splits;
  /** One for each point of the mesh. */
  std::vector<InteriorPoint> Points;
  VolumeRefinementReport Report;
  SliverMeans Means = SliverMeans::Moves;

  BoundaryRequests Requests;
  mutable TetrahedronFacts Facts;
  /** Some are of tetrahedra with points of the surface that have been moved in the mesh only. */
  bool AreFactsPreliminary = false;
  /** Work space. */
  DynamicTetrahedralization::Hole Hole;
  BoundarySpheres::Disturbed Disturbed;
};
} // namespace cdm

#endif
