// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MovingBoundaryRemesher.h
 * @brief Moves the boundary and the interfaces of a mesh and makes it Delaunay and conforming
 * again.
 *
 * Method (thesis 3.4.1), for each of a number of steps:
 *  1. points on the boundary move by their displacement; free ones near them follow, inside and
 *     along walls (BoundaryDisplacement.h);
 *  2. the step is checked, exactly: no two triangles of the boundary may cross, overlap or touch,
 *     none may lose its area, no region its positive volume. Where neighboring triangles fold over
 *     each other half of the step is taken first, as the repair in between may make way for the
 *     rest. (The thesis checks the signs of the tetrahedra's volumes, which do not see collisions
 *     across the outside, and stop at slivers that harm nobody: the tetrahedra are made anew.)
 *  3. points inside stay if they still serve: strictly inside of a region, exactly, and neither
 *     the boundary nor another point has come much closer to them. The others are removed;
 *  4. the surface is refined until it is Delaunay with these points (DelaunaySurfaceRefiner.h), and
 *     the regions are filled with the tetrahedra of all points (AdvancingFrontTetrahedralizer.h);
 *  5. where the topology changes (parts of the boundary meet, a layer vanishes, half steps do not
 *     help) the moved boundary is cut along its intersections (BoundaryTriangulator.h) before step
 *     3, and each cell of space between the pieces is given the region that the moved boundary
 *     winds around it most often, of several the one with the lowest id: fronts that meet merge,
 *     layers that have vanished are gone. Pieces between equal regions are dropped, and points
 *     of cuts that do not shape the surface (SurfaceCoarsening.h).
 *
 * Guarantees: the mesh is exactly Delaunay, all tetrahedra are positive, and its boundary is the
 * moved one, with triangles cut and divided, in points computed on them. Points that are given a
 * displacement are moved by it, rounded once, however many steps there are; points that are given
 * none and do not follow keep their coordinates. Deterministic.
 * Failure: InvalidInput for displacements that are not finite, tetrahedra that are inverted or
 * flat; with the points at fault if the moved boundary cannot be meshed, or nothing is left of it.
 * Cost: that of refining and meshing the whole, O(n log n), for each step; some 150 bytes per
 * tetrahedron.
 */
#ifndef cdmMovingBoundaryRemesher_h
#define cdmMovingBoundaryRemesher_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include <vector>

namespace cdm
{
struct MovingBoundaryOptions
{
  /** The displacement is applied in so many equal steps. At least 1. */
  int NumberOfSteps = 1;
  /** How far free points follow, in units of the largest displacement. 0: none does. >= 0. */
  double FollowRatio = 4.0;
  /**
   * A point inside is removed if its distance from the boundary or another point has become smaller
   * than this part of the smallest such distance before the step. 0 to 0.9.
   */
  double PointClearance = 0.5;
  /** For the boundary; MeshPointClearanceRatio is not used: PointClearance decides. */
  DelaunaySurfaceRefinerOptions Refinement;
};

struct MovingBoundaryInput
{
  /** With neighbors. */
  const TetMesh* Mesh = nullptr;
  /** One for each point of the mesh. Those of points inside are not used. Model units. */
  const std::vector<Vec3>* Displacements = nullptr;
};

struct MovingBoundaryReport
{
  /** Meshes made, half steps and changes of topology included. */
  Id Steps = 0;
  /** Steps in which the topology changed. */
  Id TopologyChanges = 0;
  /** Points of the input that were inside or on the boundary, and are in the output no more. */
  Id RemovedPoints = 0;
  Id NewPoints = 0;
  /** New points of all steps beyond the limits of the refinement, without which there is no mesh. */
  Id PointsBeyondLimits = 0;
  /** Triangles of the boundary that do not fulfil the criterion, after the last step. */
  Id UnresolvedTriangles = 0;
  /** Triangles of the boundary that a limit has left larger than asked for, after the last step. */
  Id TooCoarse = 0;
};

struct MovingBoundaryOutput
{
  TetMesh Mesh;
  /** For each point of Mesh: that of the input, or their number plus an index into NewPoints. */
  std::vector<Id> Origins;
  /** New points of all steps, those removed again included; parents count as Origins do. */
  std::vector<PointParents> NewPoints;
  /**
   * For each tetrahedron that of the input which has the most points in common with it, in the same
   * region; NoId if there is none.
   */
  std::vector<Id> TetrahedronSources;
  MovingBoundaryReport Report;
};

Status RemeshMovingBoundary(const MovingBoundaryInput& input, const MovingBoundaryOptions& options,
  const ExecutionContext& context, MovingBoundaryOutput& output);
} // namespace cdm

#endif
