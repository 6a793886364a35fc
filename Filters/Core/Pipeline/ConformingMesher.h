// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConformingMesher.h
 * @brief All stages in one run: polygons in, boundary-conforming Delaunay tetrahedra out.
 *
 * Method (thesis chapters 3, 5 and 6):
 *  1. BoundaryTriangulator.h: one clean triangulated surface; RegionSizes.h: sizes of single
 *     regions; SurfaceCoarsener.h: as coarse as the maximum deviation allows and the size asks for;
 *     MeshPointGenerator.h, if points are to be generated;
 *  2. DelaunaySurfaceRefiner.h: flips and new points until the surface is part of its Delaunay
 *     mesh;
 *  3. AdvancingFrontTetrahedralizer.h: tetrahedra for every enclosed region; steps 2 and 3 again, with
 *     more edges as they are, where facets of rounded points have changed a volume (RegionVolumes.h)
 *     or have negative couplings (FacetCouplings.h), eleven times at most;
 *  4. SteinerPointRefiner.h, if Steiner points are to be added, otherwise SliverRemover.h, if
 *     slivers are to be removed: MeshPurpose.h says what is to be done where that is not given, and
 *     DefaultSize.h how long edges may be;
 *  5. MeshCertificate.h: a check of the result, from the mesh and its boundary alone; at the full
 *     level if the criterion is one for finite volumes.
 *
 * Guarantees: those of the stages. Deterministic, for any number of threads.
 * Failure: the Status of the stage that failed, with polygons and points of this input; the output
 * then has only Problems and Warnings, after an abort nothing.
 * Cost: that of the stages.
 */
#ifndef cdmConformingMesher_h
#define cdmConformingMesher_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Warning.h"
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Improvement/SteinerPointRefiner.h"
#include "Core/MeshPoints/MeshPointGenerator.h"
#include "Core/Meshes/PolygonSoup.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Pipeline/MeshPurpose.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Sizing/RegionSizes.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include <optional>
#include <vector>

namespace cdm
{
/** Each option is that of the stage that has it, see there. */
struct ConformingMesherOptions
{
  /** Decides the choices that are not given. */
  MeshPurpose MeshFor = MeshPurpose::FiniteVolumes;
  MeshOptionChoices Choices;
  /** What counts as one point, and what is repaired. */
  BoundaryTriangulatorOptions Boundary;
  /**
   * Limits of the surface; Criterion and MaximumEdgeLength are those of Choices. MaximumTime counts from
   * the first stage on, for Steiner points as well.
   */
  DelaunaySurfaceRefinerOptions Surface;
  /**
   * How far the surface may be from that of the input where it is finer than edges are to be. Model
   * units; 0: it stays as it is; not given: chosen for the surface, see SurfaceCoarsener.h.
   */
  std::optional<double> MaximumDeviation;
  /** Longest edges of single regions, beside the maximum edge length and the sizing. */
  RegionSizesOptions RegionSizes;
  /** Where generated mesh points are. A Spacing of 0 is the maximum edge length, if there is one. */
  MeshPointGeneratorOptions MeshPoints;
  /** Where the surface is open, close the mesh by the convex hull of the points. */
  bool CloseOpenBoundary = false;
  /** With Steiner points. Cubic model units; 0: off. */
  double MaximumVolume = 0.0;
  /** Which layers Steiner points do not fill, see SteinerPointRefinerOptions. 0 or at least 1. */
  double LayerAspectRatio = 0.0;
  /** How many tetrahedra Steiner points make across layers, see there. At least 1. */
  int TetrahedraAcrossLayers = 1;
  /**
   * With Steiner points: rounds in which free points inside go to where fewer circumcenters lie
   * outside of their tetrahedra, see OptimalDelaunaySmoothing.h. 0 (none) to 100.
   */
  int SmoothingRounds = 0;
};

struct ConformingMesherInput
{
  const PolygonSoup* Polygons = nullptr;
  /** Empty, or the structural facet of each polygon: edges between different ones are structural. */
  std::vector<Id> Facets;
  /** Empty, or a number for each polygon: coarsening keeps edges between different ones. */
  std::vector<Id> CellGroups;
  /** Given points for the inside; may be null. */
  const std::vector<Vec3>* MeshPoints = nullptr;
  /**
   * Empty, or one for each given mesh point: whether the removal of slivers may move it. With
   * Steiner points and generated ones no given point is moved.
   */
  std::vector<char> AreMeshPointsFree;
  /** Target edge length; may be empty. */
  SizingField Sizing;
  /** Whether data of the points is to be carried along; only then PointHistory is complete. */
  bool HasPointData = false;
};

/**
 * How the points of the mesh came about, stage by stage: what carries point data of the input
 * along.
 *  1. The clean surface, made coarser or not, has the input's points SurfaceSources, then
 *     SurfacePoints, whose parents are points of the input.
 *  2. The refined surface has these, then RefinedPoints, whose parents are points of the refined
 *     surface itself.
 *  3. The first mesh has these, then mesh points: MeshPointSources counts the given ones, then the
 *     generated ones. With data, generated ones are not in it.
 *  4. If a later stage has made or moved points, or has the generated ones, Before is the first
 *     mesh, and point i of the mesh is its point Sources[i]; or NoId: it is somewhere in Before.
 */
struct PointHistory
{
  std::vector<Id> SurfaceSources;
  std::vector<PointParents> SurfacePoints;
  std::vector<PointParents> RefinedPoints;
  std::vector<Id> MeshPointSources;
  bool HasBefore = false;
  TetMesh Before;
  std::vector<Id> Sources;
};

struct ConformingMesherOutput
{
  TetMesh Mesh;
  /** On the points of Mesh, with labels. SourceCells: polygons of the input; NoId: the hull. */
  TriangleMesh Boundary;
  /** Structural facet of each triangle of the boundary. */
  std::vector<Id> Facets;
  /** Triangles of the boundary that come from ones which miss the criterion, ascending. */
  std::vector<Id> UnresolvedTriangles;
  /** With Steiner points: one for each point, whether it may be moved and taken out. */
  std::vector<char> IsFree;
  /** With Steiner points, if there are any: one for each tetrahedron. */
  std::vector<SteinerFault> Faults;
  PointHistory Points;
  /** What the choices became. */
  MeshSettings Settings;
  MeshCertificate Certificate;
  /** Findings about the polygons, also of a run that failed. */
  std::vector<SurfaceProblem> Problems;
  /** Warnings of all stages; cells are polygons of the input. */
  std::vector<Warning> Warnings;
};

Status MeshPolygons(const ConformingMesherInput& input, const ConformingMesherOptions& options,
  const ExecutionContext& context, ConformingMesherOutput& output);
} // namespace cdm

#endif
