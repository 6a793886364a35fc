// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SteinerPointRounds.h
 * @brief The mesh of each round of stage 5, and the surface and points that it is made of.
 *
 * Method: a round starts with a refined surface and a mesh that fits it. Whoever refines the mesh
 * may request splits of the surface, or give its points other positions; then the next round is
 * started. Where few splits of a surface with plane facets are requested for its size, these are done
 * in the mesh itself (BoundarySplits.h). Otherwise the surface is refined
 * (DelaunaySurfaceRefiner.h) and tetrahedralized anew with the points inside of the mesh so far
 * (AdvancingFrontTetrahedralizer.h).
 *
 * Splits may leave triangles whose smallest spheres cannot be emptied, or two sheets that become one, or
 * take far more points than they are, in thin stacks.
 * Then the last noted state comes back, and the boundary is final.
 */
#ifndef cdmSteinerPointRounds_h
#define cdmSteinerPointRounds_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Improvement/FeatureSizes.h"
#include "Core/Improvement/LayerThickness.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Improvement/SliverMemory.h"
#include "Core/Improvement/SteinerPointRefiner.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Surface/StructuralEdges.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace cdm
{
class SteinerPointRounds
{
public:
  /** All have to outlive the object. The report gets the counts of points and rounds. */
  SteinerPointRounds(const SteinerPointRefinerInput& input,
    const SteinerPointRefinerOptions& options, const ExecutionContext& context,
    SteinerPointRefinerReport& report);

  /** Takes the surface and the points of the input, and starts the first round. */
  Status StartFirst();
  /** Starts the next round: splits the boundary as requested. */
  Status StartNext();
  /** Progress within this round. Rounds get shorter: each takes a fifth of what is left. */
  ExecutionContext GetContext() const;

  RefinedMesh& GetMesh() { return *this->Mesh; }
  const RefinedMesh& GetMesh() const { return *this->Mesh; }
  std::size_t CountRequests() const { return this->Mesh->GetRequests().GetNumber(); }
  /** Whether the start of this round has split nothing of what was requested, nor moved points. */
  bool IsStuck() const { return this->HasSplitNothing; }
  /** Whether requested splits could not be had. The boundary then stays as it was before them. */
  bool IsBoundaryFinal() const { return this->HasFinalBoundary; }

  /**
   * Notes the state that may have to come back: all smallest spheres are empty now. Points that are
   * inserted or moved after it may request splits that cannot be had. Does nothing if the last noted
   * state is nearly the same.
   */
  void NoteState();
  /**
   * Measures the size at each point: its shortest edge, and how close features of the surface are.
   * Until then only sizes are refined. What may be requested after it is something else.
   */
  void MeasureSizes();
  /** Lets new points come twice as close to the points of these tetrahedra. */
  void HalveSizes(const std::vector<Id>& tetrahedra);

  /** One for each point of the surface: whether it may be moved in its facet or along its edge. */
  const std::vector<char>& GetFreeSurfacePoints() const { return this->IsSurfaceFree; }
  /** Gives other positions to points of the surface. False if all points stay. */
  bool TakeSurfacePositions(const std::vector<Vec3>& positions);

  /**
   * Ends the last round.
   * @return its mesh, which has the points of the surface first
   */
  TetMesh Finish();
  /** Brings points kept from the input to the front of this mesh, and adds what belongs to it. */
  void MakeOutput(SteinerPointRefinerOutput& output);

private:
  /** What a mesh is made of. */
  struct State
  {
    TriangleMesh Surface;
    std::vector<StructuralEdge> Edges;
    std::vector<Id> SurfaceSources;
    std::vector<InteriorPoint> Interior;
    /** How many points had come, gone or moved by then. */
    Id NumberOfChanges = 0;
  };

  void ExtractSurface();
  void ExtractInterior();
  bool IsMarkedFree(Id point) const;
  Status FindFacets();
  std::vector<Id> GetFacets() const;
  Status Translate(Status status, const std::vector<Id>& sources) const;
  DelaunaySurfaceRefinerOptions GetSurfaceOptions() const;
  RefinedMeshOptions GetMeshOptions() const;
  Status RemakeMesh();
  bool TakeGivenMesh(const DelaunaySurfaceRefinerOutput& refined);
  Status RefineSurface(const ExecutionContext& context, DelaunaySurfaceRefinerOutput& refined);
  Status MakeMesh(const TriangleMesh& surface, const std::vector<InteriorPoint>& interior,
    const std::vector<Id>& sourceCells, const ExecutionContext& context);
  void TakeMesh(
    AdvancingFrontTetrahedralizerOutput made, const std::vector<InteriorPoint>& interior);
  Status RestoreState(const ExecutionContext& context);
  bool HasPlaneBoundary() const;
  bool CanSplitInPlace() const;
  bool MayShapeSurface() const;
  Id GetMaximumOfShapes() const;
  Status SplitInPlace();
  std::size_t CollectSurfaceSizes(const std::vector<Id>& triangles);
  void SpreadSurfaceSizes(const std::vector<Id>& triangles);
  void CollectReport();

  const SteinerPointRefinerInput& Input;
  const SteinerPointRefinerOptions& Options;
  const ExecutionContext& Context;
  SteinerPointRefinerReport& Report;

  /** SourceCells: triangles of the first surface. */
  TriangleMesh Surface;
  /** For each triangle of the first surface: its cell in the input, and its surface facet. */
  std::vector<Id> InputCells;
  std::vector<Id> Facets;
  std::vector<StructuralEdge> Edges;
  /** Input point of each of the surface's first points. */
  std::vector<Id> SurfaceSources;
  /** See InteriorPoint::Size; empty while only sizes are refined. */
  std::vector<double> SurfaceSizes;
  /** Feature sizes of the surface at the time when SurfaceSizes were measured. */
  std::unique_ptr<FeatureSizes> Features;
  /** Null if one tetrahedron across is enough. */
  std::unique_ptr<LayerThickness> Layers;
  /** Points inside, while there is no mesh that has them. */
  std::vector<InteriorPoint> Interior;
  SliverMemory Memory;
  std::unique_ptr<RefinedMesh> Mesh;
  /** One for each point of the surface: whether it was made or moved since the mesh was made. */
  std::vector<char> IsNew;
  std::vector<char> IsSurfaceFree;
  /** Points of the surface that have been moved in this round. */
  std::vector<Id> MovedPoints;
  /** Whether narrow triangles have been split all at once. */
  bool HasShaped = false;
  /** Whether narrow triangles took too many points, or spoilt the criterion. */
  bool HasFailedToShape = false;
  bool HasSplitNothing = false;
  State Noted;
  bool HasFinalBoundary = false;
};
} // namespace cdm

#endif
