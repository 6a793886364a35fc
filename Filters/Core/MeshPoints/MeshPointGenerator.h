// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPointGenerator.h
 * @brief Points for the inside of the regions, as dense as a sizing field asks for.
 *
 * Placements (thesis 3.6 and 6.2):
 *  - octree (OctreePoints.h): the leaves of SizingOctree.h, each with a template of points
 *    (PointTemplates.h): its corners, its center, or the unit cell of a body- or face-centered
 *    lattice;
 *  - ortho-product (OrthoProductPoints.h): planes across the axes, at given ticks or as the sizing
 *    asks for, with the same templates in each cell;
 *  - random (RandomPoints.h): darts, none near to others, then Lloyd's iteration;
 *  - layers off chosen interfaces (LayerPoints.h), besides any of these: points on the normals of
 *    the vertices that the refined surface has there.
 *
 * Steps: layers first; then the placement, without the points that come near the layers. A point
 * stays if it is clear of the boundary, measured in its own spacing: that between the points
 * around it, not that of the sizing; and if it lies strictly inside of a region
 * (MeshPointPlacer.h).
 *
 * Anisotropic sizing: octree and ortho-product follow the spacing along the axes, random points the
 * whole tensor, layers its largest length along the interface.
 *
 * Inputs: a surface with the invariants of TriangleMesh.h, closed, with or without labels.
 * Guarantees: each point is strictly inside of its region, exactly; no triangle is nearer than
 * BoundaryClearance spacings of the point; a layer has its distance from the interface, to
 * rounding. Deterministic for any number of threads, all of which evaluate the sizing.
 * Failure: NotClosed for labels that contradict each other and a surface that encloses nothing,
 * InvalidOption for numbers out of range and layers at an interface that is not there, LimitReached
 * for a sizing that needs too many points.
 * Cost: O(n log n) for n points and leaves; 150 bytes for each point; a random point
 * takes about a millisecond, one of the octree some microseconds.
 *
 * References: P. Fleischmann, thesis, 6.2 (octree with templates, smoothed random points, boundary
 * fitted points).
 */
#ifndef cdmMeshPointGenerator_h
#define cdmMeshPointGenerator_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Warning.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Sizing/SizingField.h"

#include <array>
#include <vector>

namespace cdm
{
enum class PointPlacement
{
  Octree = 0,
  OrthoProduct = 1,
  Random = 2,
  /** Layers only. */
  None = 3
};

/** Points of a cell. */
enum class PointTemplate
{
  Corners = 0,
  Centers = 1,
  /** Corners and center. */
  BodyCentered = 2,
  /** Corners and centers of the sides. */
  FaceCentered = 3
};

/** Layers in a region, off its interface with another one, which may be OutsideRegion. */
struct PointLayers
{
  Id Region = 0;
  Id Neighbor = OutsideRegion;
  Id NumberOfLayers = 1;
  /** Distance of the first layer from the interface. Model units, > 0. */
  double FirstDistance = 1.0;
  /** Ratio of each gap between two layers to the one before. > 0. */
  double GrowthRatio = 1.0;
};

struct MeshPointGeneratorOptions
{
  /**
   * Without a sizing: the spacing along x, y and z. Model units, >= 0; 0: a tenth of the longest
   * side of the bounding box.
   */
  Vec3 Spacing;
  PointPlacement Placement = PointPlacement::Octree;
  PointTemplate Template = PointTemplate::BodyCentered;
  /** Octree, random: by how many levels neighboring leaves may differ. 0: no bound. */
  int MaximumLevelDifference = 1;
  /** Ortho-product: planes across each axis. Model units; empty: as the sizing asks for. */
  std::array<std::vector<double>, 3> Ticks;
  int SmoothingIterations = 10;
  std::uint64_t Seed = 1;
  std::vector<PointLayers> Layers;
  /** Distance from the boundary in spacings of the point. >= 0. */
  double BoundaryClearance = 0.5;
  /**
   * Whether no edge between points is to be longer than the sizing, as a mesh with Steiner points
   * has it. The leaves of the octree are then small enough for that. BoundaryClearance holds in
   * spacings of the sizing, too, so layers thinner than these get no points but those of Layers.
   */
  bool IsSizingLimit = false;
  Id MaximumNumberOfPoints = 10000000;
};

struct MeshPointGeneratorInput
{
  const TriangleMesh* Surface = nullptr;
  /** May be empty: Spacing then holds everywhere. */
  SizingField Sizing;
};

struct MeshPointGeneratorOutput
{
  /** Layers first. */
  std::vector<Vec3> Points;
  std::vector<Id> Regions;
  /** Number of the layer from the interface, from 1 on; 0: none. */
  std::vector<Id> Layers;
  /**
   * Points of layers that would be too close to the boundary or to other layers; above the rim of
   * an interface they are not expected, and not counted.
   */
  Id DroppedLayerPoints = 0;
  std::vector<Warning> Warnings;
};

Status GenerateMeshPoints(const MeshPointGeneratorInput& input,
  const MeshPointGeneratorOptions& options, const ExecutionContext& context,
  MeshPointGeneratorOutput& output);
} // namespace cdm

#endif
