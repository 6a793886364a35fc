// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinedMesh.h
 * @brief A Delaunay mesh that gets Steiner points inside of its regions, with the rules that these
 * have to respect.
 *
 * The mesh has the points of its surface first, then interior points. It stays Delaunay; if its
 * cospherical sets are split by the pulling rule, they stay so. The surface consists of the outer
 * and interface facets whose smallest spheres are empty, and these spheres stay empty. Points are
 * inserted only where no other outer facet is near. The boundary changes only in SplitBoundary()
 * and by moves of surface points (NoteSurfaceMove()).
 *
 * Each point has a size: the shortest edge at it before any shape was refined, or the local feature
 * size (FeatureSizes.h) if that is smaller. It is at most the size of another point plus the
 * distance from there. No point is inserted closer to it than a twentieth of its size, unless a
 * size limit asks for it. Sharp input angles would be refined without end: a tetrahedron across one
 * (SharpAngles.h) or across a thin layer (ThinLayers.h) is refined for its size only. Slivers are
 * mended at all but the sharpest of these angles.
 *
 * VolumeRefinement.h, SliverPerturbation.h and OptimalDelaunaySmoothing.h work on this mesh.
 */
#ifndef cdmRefinedMesh_h
#define cdmRefinedMesh_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/ThreadTeam.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Improvement/BoundaryRequests.h"
#include "Core/Improvement/BoundaryShape.h"
#include "Core/Improvement/BoundarySplits.h"
#include "Core/Improvement/NegativeCouplings.h"
#include "Core/Improvement/RefinementWork.h"
#include "Core/Improvement/SliverMemory.h"
#include "Core/Improvement/TetrahedronFacts.h"
#include "Core/Improvement/TetrahedronWatch.h"
#include "Core/Sizing/TetrahedronLimits.h"

#include <functional>
#include <memory>
#include <optional>
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
  /** The caller's id of the point; NoId for new and moved points. */
  Id Source = NoId;
  /** Its name in SliverMemory. */
  Id Name = NoId;
};

/** The boundary that a mesh is refined for. The referenced objects have to outlive the mesh. */
struct RefinedBoundary
{
  TriangleMesh& Surface;
  /** Structural edges of the surface, sorted; they change with the surface. */
  std::vector<StructuralEdge>& Edges;
  /** Edges of the surface whose smallest spheres are empty, and stay so. */
  const std::vector<StructuralEdge>& KeptEdges;
};

struct RefinedMeshOptions
{
  TetrahedronLimits Limits;
  Id MaximumNewPoints = 0;
  /** When it is over, no more points are inserted, as if there were as many as allowed. */
  Deadline TimeLimit;
  /** Plane angles between structural edges below this are sharp. Degrees; see SharpAngles. */
  double SharpPlaneAngle = UsualSharpPlaneAngle;
  /** How many times as wide as thick thin layers are at least; 0: see ThinLayers. */
  double LayerAspectRatio = 0.0;
  /** Sizes as in InteriorPoint::Size, one for each point of the surface, or empty. */
  std::vector<double> SurfaceSizes;
  /** The threads that look ahead. Results are the same for any number. */
  std::shared_ptr<ThreadTeam> Threads = std::make_shared<ThreadTeam>(1);
};

struct RefinedMeshReport
{
  Id InsertedPoints = 0;
  Id MovedPoints = 0;
  Id RemovedPoints = 0;
};

class RefinedMesh
{
public:
  /** @param memory is kept from one boundary to the next, which has more points */
  RefinedMesh(TetMesh mesh, const RefinedBoundary& boundary,
    const std::vector<InteriorPoint>& interior, SliverMemory& memory,
    const RefinedMeshOptions& options = RefinedMeshOptions());
  RefinedMesh(const RefinedMesh&) = delete;
  RefinedMesh& operator=(const RefinedMesh&) = delete;

  /** Marks new and moved points: one entry for each point of the surface. */
  void NoteNewPoints(const std::vector<char>& isNew);
  /** Sizes as in InteriorPoint::Size, one for each point of the mesh. */
  void SetSizes(const std::vector<double>& sizes);
  /** Halves the sizes of points, and bounds those of others by them. */
  void HalveSizes(const std::vector<Id>& points, const std::vector<Id>& tetrahedra);
  /** Sizes as in InteriorPoint::Size for new points of the surface, from the first one on. */
  void SetSurfaceSizes(Id first, const std::vector<double>& sizes);

  /** Lists the points that are in the mesh now. */
  void GetInterior(std::vector<InteriorPoint>& interior) const;
  const TetMesh& GetMesh() const { return this->Mesh.GetMesh(); }
  /**
   * Gives the mesh away, without dead tetrahedra and unused ids: points are those of the surface,
   * then those of GetInterior(). Limits and shape are what is left.
   */
  TetMesh TakeMesh();
  const RefinedMeshReport& GetReport() const { return this->Report; }
  /** What this mesh has made and looked at so far. */
  RefinementWork GetWork() const;
  /** Whether as many points have been inserted as allowed, or the time is over. */
  bool IsFull() const
  {
    return this->Report.InsertedPoints >= this->MaximumNewPoints || this->TimeLimit.IsOver();
  }
  const TetrahedronLimits& GetLimits() const { return this->Limits; }
  const RefinedBoundary& GetBoundary() const { return this->Boundary; }
  ThreadTeam& GetThreads() const { return *this->Threads; }
  /**
   * A search in the tetrahedra for each thread, which records if there are several. It lasts as long
   * as the mesh, so that its marks, one for each tetrahedron, are not made for each pass.
   */
  CavitySearch& GetSearch(int thread) { return this->Searches[static_cast<std::size_t>(thread)]; }
  /** The shape of the current surface. */
  const BoundaryShape& GetShape() const { return *this->Shape; }

  /** The boundary triangles and edges that are requested to be split. */
  const BoundaryRequests& GetRequests() const { return this->Requests; }
  BoundaryRequests& GetRequests() { return this->Requests; }
  /**
   * Requests a split of what a point at the position encroaches on most. False if it encroaches on
   * nothing.
   */
  bool RequestEncroached(const Vec3& position, bool isSizeKept);
  /**
   * Requests splits of edges with a negative coupling, or of triangles at those within facets. If
   * the distances that sizes ask for allow none of them, one is requested all the same.
   * @return number of edges with a negative coupling, whether they may be split or not
   */
  std::size_t RequestNegativeCouplings();
  /**
   * Makes the requested splits of the boundary, and further ones that these need, in the mesh
   * itself.
   * @param moved points of the surface that have been moved since the last splits, ascending
   * @param options those that the surface was refined with
   * @param setSizes called when all requests are done: it may call SetSurfaceSizes() for the new
   *   points, and returns whether points have sizes
   * @return whether all requests are done. If not, surface and mesh still fit each other, the
   *   requests that are left stay, and a new mesh has to be made: this object cannot be used then
   */
  bool SplitBoundary(std::vector<Id> moved, const DelaunaySurfaceRefinerOptions& options,
    const SizingField& sizing, const std::function<bool()>& setSizes,
    const ExecutionContext& context, Status& status);
  /** Whether the last splits took far more points than they were: see BoundarySplits.h. */
  bool HaveSplitsRunAway() const { return this->Splits && this->Splits->HasRunAway(); }
  /** Triangles of the surface that the last splits have made or may have changed, ascending. */
  const std::vector<Id>& GetSplitTriangles() const { return this->Splits->GetChangedTriangles(); }

  /** Whether a point is none of the surface. */
  bool IsInside(Id point) const { return point >= this->FirstInside; }
  /** Whether a point is an interior one that may be moved and removed. */
  bool IsFree(Id point) const;
  /** Smallest distance at which a new point may come to this one. */
  double GetClearance(Id point) const;
  /**
   * Makes room for facts about all tetrahedra (GetAngle() to IsAcrossSharp(), IsFaulty()): several
   * threads may then ask for them, each about other tetrahedra, until a tetrahedron is added.
   */
  void MakeRoomForFacts() const { this->Facts.MakeRoom(); }
  /** The smallest dihedral angle, in degrees. */
  double GetAngle(Id tetrahedron) const { return this->Facts.GetAngle(tetrahedron); }
  TetrahedronFault GetFault(Id tetrahedron) const { return this->Facts.GetFault(tetrahedron); }
  bool IsInLayer(Id tetrahedron) const { return this->Facts.IsInLayer(tetrahedron, *this->Shape); }
  bool IsAcrossSharp(Id tetrahedron, SharpAngleUse use) const
  {
    return this->Facts.IsAcrossSharp(tetrahedron, *this->Shape, use);
  }
  /**
   * Whether a tetrahedron is numerically flat, as happens in rotated devices. All its points are on
   * the surface; more points on the surface would only make more such tetrahedra.
   */
  bool IsFlat(Id tetrahedron) const;
  /** Ascending. */
  std::vector<Id> FindFlatTetrahedra() const;
  /** Tetrahedra with a dihedral angle below the target (degrees), in no order. */
  std::vector<Id> FindFlatter(double target) const;
  /**
   * Those of them that are neither across sharp angles nor across thin layers. Where most are, to
   * tell them apart in each round took an eighth of the time.
   */
  std::vector<Id> FindSlivers(double target) const;
  /**
   * Tetrahedra that get a new point, in no order: those that are too large, and, if shapes are
   * tested, badly shaped ones that are neither flat nor across sharp angles or thin layers.
   */
  const std::vector<Id>& FindFaulty(bool isShapeTested) const;
  bool IsFaulty(Id tetrahedron, bool isShapeTested) const;
  /**
   * One for each triangle of the boundary: whether tetrahedra in its surface facet may be excused
   * from the limits of shapes, as the facet has a sharp angle or lies at a thin layer.
   */
  std::vector<char> FindExcusedTriangles() const;
  /** Whether the tetrahedron breaks a limit that it is refined for. */
  bool BreaksLimit(Id tetrahedron) const;
  /** The same for a tetrahedron that might be made; ids of interior points do not matter. */
  bool BreaksLimit(const TetrahedronIds& ids, const std::array<Vec3, 4>& corners) const;
  /** The same for the tetrahedron of a facet and a point inside. */
  bool BreaksLimit(const TriangleIds& facet, const Vec3& inside) const;

  /** The tetrahedra themselves. Whoever changes them calls NoteChanges(), or undoes the change. */
  const DynamicTetrahedralization& GetTetrahedra() const { return this->Mesh; }
  DynamicTetrahedralization& GetTetrahedra() { return this->Mesh; }
  /**
   * While the mesh is frozen, it must not be changed, and several threads may call functions that
   * are const.
   */
  void Freeze(bool isFrozen) const { this->Facts.Freeze(isFrozen); }
  void NoteChanges();
  /** Notes that surface points have been moved in the mesh only: the surface will follow. */
  void NoteSurfaceMove();
  /** The names of a tetrahedron's points, under which SliverMemory keeps failed attempts. */
  TetrahedronIds GetNames(const TetrahedronIds& ids) const;
  SliverMemory& GetMemory() { return this->Memory; }
  /** Whether a point is immovable, see SliverMemory. */
  bool IsImmovable(Id point, SliverPlace place) const
  {
    return this->Memory.IsImmovable(this->Points[point].Name, place);
  }
  void SetImmovable(const std::vector<Id>& points, SliverPlace place);

  /**
   * The first facet whose tetrahedron would break a limit if the cavity were filled from the
   * position, or the number of facets.
   */
  std::size_t FindBroken(const PointCavity& cavity, const Vec3& position) const;
  /** Whether the position keeps the distances that the sizes of points at the cavity ask for. */
  bool IsClear(const PointCavity& cavity, const Vec3& position) const;
  /** @param scratch gets what the position encroaches on, if that is why it does */
  bool EncroachesOnBoundary(
    const PointCavity& cavity, const Vec3& position, BoundarySpheres::Encroached& scratch) const;
  /** Inserts a new free point. */
  void Insert(const Vec3& position, const PointCavity& cavity);
  /** Notes that a free point has been moved in the tetrahedra. */
  void NoteMove(Id point);
  /** Counts a free point that was removed and is not restored. */
  void NoteRemoval(Id point);

private:
  void ReservePoints();
  void FollowBoundary(const std::vector<Id>& moved);
  std::vector<Id> FindEdgesAt(
    const std::vector<Id>& points, const std::vector<Id>& triangles) const;
  void BoundSizes(const std::vector<Id>& tetrahedra);
  void BoundSizesAtSplits();
  bool TouchesOpenFacet(const PointCavity& cavity) const;
  template <typename Property>
  std::vector<Id> FindBelow(double target, TetrahedronWatch& watch, Property&& hasProperty) const;

  DynamicTetrahedralization Mesh;
  const RefinedBoundary Boundary;
  const TetrahedronLimits Limits;
  /**
   * Id of the first interior point. Points of the surface, and ids reserved for new ones, come
   * before.
   */
  Id FirstInside;
  Id MaximumNewPoints;
  Deadline TimeLimit;
  const std::shared_ptr<ThreadTeam> Threads;
  std::vector<CavitySearch> Searches;
  SliverMemory& Memory;
  std::unique_ptr<BoundaryShape> Shape;
  std::unique_ptr<BoundarySplits> Splits;
  /** For each source cell of the surface a triangle that came from it before the first splits. */
  std::vector<Id> SourceTriangles;
  /** One for each point of the mesh. */
  std::vector<InteriorPoint> Points;
  /** Interior points that have come, gone or moved since the last splits of the boundary. */
  std::vector<Id> ChangedInside;
  RefinedMeshReport Report;
  /** What the members do not count themselves. */
  RefinementWork Work;
  BoundaryRequests Requests;
  NegativeCouplings Couplings;
  mutable TetrahedronFacts Facts;
  /**
   * The moment before surface points were moved in the mesh only, if there are any: facts about
   * tetrahedra that have been made since then may be about these.
   */
  std::optional<MeshMoment> BeforeMoves;
  /** Tetrahedra with an angle below FlatterTarget, slivers among them, and those of FindFaulty(). */
  mutable TetrahedronWatch Flatter;
  mutable TetrahedronWatch Slivers;
  mutable double FlatterTarget = 0.0;
  mutable TetrahedronWatch Faulty;
  mutable bool IsFaultyShape = false;
  /** Work space. */
  BoundarySpheres::Encroached Encroached;
};
} // namespace cdm

#endif
