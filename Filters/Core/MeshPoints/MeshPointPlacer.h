// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPointPlacer.h
 * @brief Decides which positions inside of the regions mesh points may take, and keeps these
 *   points.
 *
 * Method:
 *  1. a position has to be clear of the boundary, by BoundaryClearance of its spacing, and if
 *     asked for of that of the sizing (RegionLocator.h);
 *  2. it has to lie strictly inside of a region, which the octree may know already;
 *  3. and beyond the layers of that region, by BoundaryClearance of its smallest spacing.
 *
 * Guarantees: points are added in the order of their candidates, for any number of threads. Queries
 * are thread safe.
 * Failure: NotClosed for labels that contradict each other or a surface that encloses nothing,
 * LimitReached for more points than allowed.
 * Cost: some microseconds for a candidate.
 */
#ifndef cdmMeshPointPlacer_h
#define cdmMeshPointPlacer_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/MeshPoints/MeshPointGenerator.h"
#include "Core/Sizing/RegionLocator.h"
#include "Core/Sizing/SizingOctree.h"

#include <functional>
#include <optional>
#include <vector>

namespace cdm
{
/** Distance of a layer from its interface; layers are numbered from 1 on. */
double GetLayerDistance(const PointLayers& layers, Id number);

class MeshPointPlacer
{
public:
  struct Candidate
  {
    Vec3 Position;
    /** Spacing of the points around it. */
    LocalSpacing Spacing;
    /** Its region, or MixedRegion if that is not known. */
    Id Region;
  };

  /** All have to outlive the object. */
  MeshPointPlacer(const MeshPointGeneratorInput& input, const MeshPointGeneratorOptions& options,
    MeshPointGeneratorOutput& output);

  /** Finds the regions. */
  Status Build();

  const MeshPointGeneratorInput& GetInput() const { return this->Input; }
  const MeshPointGeneratorOptions& GetOptions() const { return this->Options; }
  const RegionLocator& GetLocator() const { return this->Locator; }
  MeshPointGeneratorOutput& GetOutput() { return this->Output; }

  /** Builds an octree whose leaves are as large as the sizing asks for, times a ratio. */
  Status BuildOctree(double ratio, const ExecutionContext& context, SizingOctree& octree) const;

  /** The region of a point that may stay, or OutsideRegion; the known one may be MixedRegion. */
  Id FindRegion(const Vec3& position, const LocalSpacing& spacing, Id known) const;

  /** Adds a point with its region; layer: 0 if it is in none. */
  Status Add(const Vec3& position, Id region, Id layer);

  /** Adds those of count candidates that may stay. getCandidate is called on all threads. */
  Status PlaceAll(std::size_t count, const ExecutionContext& context,
    const std::function<std::optional<Candidate>(std::size_t)>& getCandidate);

private:
  const MeshPointGeneratorInput& Input;
  const MeshPointGeneratorOptions& Options;
  MeshPointGeneratorOutput& Output;
  RegionLocator Locator;
  /** Distance of the last layer, for each of the options' layers. */
  std::vector<double> LayerHeights;
};
} // namespace cdm

#endif
