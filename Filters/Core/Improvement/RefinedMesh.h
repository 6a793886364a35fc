// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinedMesh.h
 * @brief A mesh that gets Steiner points inside of its regions, and what they have to respect.
 *
 * The mesh has the points of its surface, then those inside. It is Delaunay; by the pulling rule it
 * stays if it is. The surface's triangles are those of its outer and interface facets whose
 * smallest spheres are empty, and stay so; points are put in only where no other outer facet is
 * near. The boundary itself changes in SplitBoundary() only.
 *
 * Each point has a size, the shortest edge at it before any shape was refined, or how close edges
 * and facets of the boundary come to each other there (FeatureSizes.h), and at most the size of
 * another point and the way from there; no point comes closer to it than a twentieth of that, but
 * for size limits. Sharp input angles would be refined for ever: a tetrahedron across one
 * (SharpAngles.h) is refined for its size only, as is one across a thin layer (ThinLayers.h).
 *
 * What is done with it: VolumeRefinement.h, SliverPerturbation.h.
 */
#ifndef cdmRefinedMesh_h
#define cdmRefinedMesh_h

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

/** The boundary that a mesh is refined for; all outlives the mesh. */
struct RefinedBoundary
{
  TriangleMesh& Surface;
  /** Structural ones of the surface, sorted; they change with the surface. */
  std::vector<StructuralEdge>& Edges;
  /** Edges of the surface whose smallest spheres are empty, and stay so. */
  const std::vector<StructuralEdge>& KeptEdges;
};

struct RefinedMeshOptions
{
  TetrahedronLimits Limits;
  Id MaximumNewPoints = 0;
  /** So many points may be added to the surface by SplitBoundary(). */
  Id Reserve = 0;
  /** Of structural edges, degrees: see SharpAngles. */
  double SharpPlaneAngle = UsualSharpPlaneAngle;
  /** As InteriorPoint::Size, one for each point of the surface, or empty. */
  std::vector<double> SurfaceSizes;
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

  /** One for each point of the surface: whether it has not been there, or has been elsewhere. */
  void NoteNewPoints(const std::vector<char>& isNew);
  /** As InteriorPoint::Size, one for each point of the mesh. */
  void SetSizes(const std::vector<double>& sizes);
  /** As InteriorPoint::Size, of new points of the surface, from the first one on. */
  void SetSurfaceSizes(Id first, const std::vector<double>& sizes);

  /** The points that are in the mesh now. */
  std::vector<InteriorPoint> GetInterior() const;
  const TetMesh& GetMesh() const { return this->Mesh.GetMesh(); }
  /** Without gaps: points are those of the surface, then those of GetInterior(). */
  TetMesh MakeMesh() const;
  const RefinedMeshReport& GetReport() const { return this->Report; }
  /** Whether it has got as many points as it may. */
  bool IsFull() const { return this->Report.InsertedPoints >= this->MaximumNewPoints; }
  const TetrahedronLimits& GetLimits() const { return this->Limits; }
  const RefinedBoundary& GetBoundary() const { return this->Boundary; }
  /** Of the surface as it is. */
  const BoundaryShape& GetShape() const { return *this->Shape; }

  /** What is to be split in the boundary. */
  const BoundaryRequests& GetRequests() const { return this->Requests; }
  BoundaryRequests& GetRequests() { return this->Requests; }
  /** What a point at the position disturbs most; false if it disturbs nothing. */
  bool RequestDisturbed(const Vec3& position, bool isSizeKept);
  /**
   * Edges of the boundary with a negative coupling, or triangles at those within facets.
   * @return how many edges there are, whether they may be split or not
   */
  std::size_t RequestNegativeCouplings();
  /**
   * Splits what is requested in the boundary, and whatever that disturbs, in the mesh itself.
   * @param options those that have made the surface
   * @return whether all is done: if not, the surface is as far as the mesh is, what is left is
   *   still requested, and a new mesh has to be made; this object is good for nothing more
   */
  bool SplitBoundary(const DelaunaySurfaceRefinerOptions& options, const SizingField& sizing,
    const ExecutionContext& context, Status& status);

  /** Not of the surface. */
  bool IsInside(Id point) const { return point >= this->FirstInside; }
  /** Of a point inside: whether it may be moved and removed. */
  bool IsFree(Id point) const;
  /** How close a new point may come. */
  double GetClearance(Id point) const;
  /** The smallest dihedral one, in degrees. */
  double GetAngle(Id tetrahedron) const { return this->Facts.GetAngle(tetrahedron); }
  TetrahedronFault GetFault(Id tetrahedron, double& severity) const
  {
    return this->Facts.GetFault(tetrahedron, severity);
  }
  bool IsInLayer(Id tetrahedron) const { return this->Facts.IsInLayer(tetrahedron, *this->Shape); }
  bool IsAcrossSharp(Id tetrahedron) const
  {
    return this->Facts.IsAcrossSharp(tetrahedron, *this->Shape);
  }
  /**
   * By rounding, as in turned devices: its points, which are all on the surface, would have no
   * tetrahedron otherwise; more points on the surface would have more of the kind.
   */
  bool IsFlat(Id tetrahedron) const;
  std::vector<Id> FindFlatTetrahedra() const;
  /** Of what is refined for. */
  bool BreaksLimit(Id tetrahedron) const;
  /** Of a tetrahedron that might be made; ids of points inside do not matter. */
  bool BreaksLimit(const TetrahedronIds& ids, const std::array<Vec3, 4>& corners) const;

  /** The tetrahedra themselves. Who changes them says so by NoteChanges(), or undoes it. */
  const DynamicTetrahedralization& GetTetrahedra() const { return this->Mesh; }
  DynamicTetrahedralization& GetTetrahedra() { return this->Mesh; }
  void NoteChanges();
  /** Points of the surface have been moved in the mesh only: the surface will follow. */
  void NoteSurfaceMove();
  /** What is tried for a tetrahedron is remembered under its points' names, which are sorted. */
  TetrahedronIds GetNames(const TetrahedronIds& ids) const;
  SliverMemory& GetMemory() { return this->Memory; }

  /**
   * Looks for the hole of a point (DynamicTetrahedralization::FindHole()), which what follows is
   * about; number: its id, that of the next new point by default.
   */
  bool FindHole(const Vec3& position, Id first, Id number = NoId);
  const DynamicTetrahedralization::Hole& GetHole() const { return this->Hole; }
  /** How many tetrahedra of the hole's cone would break a limit. */
  Id CountBroken(const Vec3& position) const;
  /** Whether the point keeps the distances that the sizes of its neighbors ask for. */
  bool IsClear(const Vec3& position) const;
  bool DisturbsBoundary(const Vec3& position);
  void Insert(const Vec3& position);
  /** Puts a point that was taken out, and is free, back in at another place. */
  void Restore(Id point, const Vec3& position);
  /** That a free point has been taken out, and is not restored. */
  void NoteRemoval();

private:
  void BoundSizes(const std::vector<Id>& tetrahedra);
  bool TouchesOpenFacet() const;

  DynamicTetrahedralization Mesh;
  const RefinedBoundary Boundary;
  const TetrahedronLimits Limits;
  /** Of the mesh's points; those of the surface, and places for new ones, come before. */
  const Id FirstInside;
  Id MaximumNewPoints;
  SliverMemory& Memory;
  std::unique_ptr<BoundaryShape> Shape;
  std::unique_ptr<BoundarySplits> Splits;
  /** One for each point of the mesh. */
  std::vector<InteriorPoint> Points;
  RefinedMeshReport Report;
  BoundaryRequests Requests;
  mutable TetrahedronFacts Facts;
  /** Some are of tetrahedra with points of the surface that have been moved in the mesh only. */
  bool AreFactsPreliminary = false;
  DynamicTetrahedralization::Hole Hole;
  /** Work space. */
  BoundarySpheres::Disturbed Disturbed;
};
} // namespace cdm

#endif
