// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/MeshPointPlacer.h"

#include "Core/Basics/ParallelLoop.h"

namespace cdm
{
namespace
{
/** Cells of an octree that fill a box are a little smaller than the sizing allows. */
constexpr double SizedClearanceRatio = 0.9;
} // namespace

double GetLayerDistance(const PointLayers& layers, Id number)
{
  double distance = 0.0;
  double gap = layers.FirstDistance;
  for (Id i = 0; i < number; ++i, gap *= layers.GrowthRatio)
  {
    distance += gap;
  }
  return distance;
}

MeshPointPlacer::MeshPointPlacer(const MeshPointGeneratorInput& input,
  const MeshPointGeneratorOptions& options, MeshPointGeneratorOutput& output)
  : Input(input), Options(options), Output(output), Locator(*input.Surface)
{
  for (const PointLayers& layers : options.Layers)
  {
    this->LayerHeights.push_back(GetLayerDistance(layers, layers.NumberOfLayers));
  }
}

Status MeshPointPlacer::Build()
{
  return this->Locator.Build();
}

Status MeshPointPlacer::BuildOctree(
  double ratio, const ExecutionContext& context, SizingOctree& octree) const
{
  SizingOctreeOptions options;
  options.MaximumRatio = ratio;
  options.MaximumLevelDifference = this->Options.MaximumLevelDifference;
  options.MaximumNumberOfLeaves = this->Options.MaximumNumberOfPoints;
  return octree.Build(this->Locator, this->Input.Sizing, options, context);
}

Id MeshPointPlacer::FindRegion(const Vec3& position, const LocalSpacing& spacing, Id known) const
{
  if (known == OutsideRegion ||
    !this->Locator.IsClear(position, spacing, this->Options.BoundaryClearance) ||
    (this->Options.IsSizingLimit &&
      !this->Locator.IsClear(position, this->Input.Sizing(position),
        SizedClearanceRatio * this->Options.BoundaryClearance)))
  {
    return OutsideRegion;
  }
  const Id region = known >= 0 ? known : this->Locator.Locate(position);
  for (std::size_t i = 0; i < this->Options.Layers.size(); ++i)
  {
    const PointLayers& layers = this->Options.Layers[i];
    const double reach =
      this->LayerHeights[i] + this->Options.BoundaryClearance * spacing.GetSmallest();
    if (region == layers.Region &&
      !this->Locator.IsClear(position, 1.0, reach, { layers.Region, layers.Neighbor }))
    {
      return OutsideRegion;
    }
  }
  return region;
}

Status MeshPointPlacer::Add(const Vec3& position, Id region, Id layer)
{
  if (static_cast<Id>(this->Output.Points.size()) >= this->Options.MaximumNumberOfPoints)
  {
    return MakeTooManyPoints(this->Options.MaximumNumberOfPoints);
  }
  this->Output.Points.push_back(position);
  this->Output.Regions.push_back(region);
  this->Output.Layers.push_back(layer);
  return {};
}

Status MeshPointPlacer::PlaceAll(std::size_t count, const ExecutionContext& context,
  const std::function<std::optional<Candidate>(std::size_t)>& getCandidate)
{
  struct PlacedPoint
  {
    Vec3 Position;
    Id Region;
  };
  const ParallelLoopOptions loop{ context.GetNumberOfThreads(), 1024 };
  std::vector<std::vector<PlacedPoint>> blocks(GetNumberOfBlocks(count, loop));
  const auto placeBlock = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      if (const std::optional<Candidate> candidate = getCandidate(i))
      {
        const Id region =
          this->FindRegion(candidate->Position, candidate->Spacing, candidate->Region);
        if (region != OutsideRegion)
        {
          blocks[block].push_back({ candidate->Position, region });
        }
      }
    }
  };
  if (!ParallelLoop(count, loop, context, "Placing points", placeBlock))
  {
    return Status::Aborted();
  }
  Status status;
  for (const std::vector<PlacedPoint>& block : blocks)
  {
    for (auto point = block.begin(); point != block.end() && status.IsOk(); ++point)
    {
      status = this->Add(point->Position, point->Region, 0);
    }
  }
  return status;
}
} // namespace cdm
