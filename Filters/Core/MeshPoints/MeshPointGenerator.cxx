// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/MeshPointGenerator.h"

#include "Core/MeshPoints/LayerPoints.h"
#include "Core/MeshPoints/MeshPointPlacer.h"
#include "Core/MeshPoints/OctreePoints.h"
#include "Core/MeshPoints/OrthoProductPoints.h"
#include "Core/MeshPoints/RandomPoints.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace cdm
{
namespace
{
constexpr Id MaximumNumberOfLayers = 1000;

bool IsPositive(double value)
{
  return value > 0.0 && std::isfinite(value);
}

Status CheckOptions(const MeshPointGeneratorOptions& options)
{
  for (std::size_t i = 0; i < options.Layers.size(); ++i)
  {
    const PointLayers& layers = options.Layers[i];
    if (layers.Region < 0 || layers.Neighbor < OutsideRegion || layers.NumberOfLayers < 1 ||
      layers.NumberOfLayers > MaximumNumberOfLayers || !IsPositive(layers.FirstDistance) ||
      !IsPositive(layers.GrowthRatio))
    {
      return Status::Failure(StatusCode::InvalidOption,
        "Layers " + std::to_string(i) +
          " are not right: they need a region from 0 on, a neighbor from -1 on, 1 to 1000 layers, "
          "a "
          "first distance and a growth ratio above 0.");
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<double>& ticks = options.Ticks[axis];
    if (!std::all_of(ticks.begin(), ticks.end(), [](double t) { return std::isfinite(t); }))
    {
      return Status::Failure(StatusCode::InvalidOption,
        std::string("A tick of the ") + "xyz"[axis] + " axis is not finite: correct it.");
    }
    if (!(options.Spacing[axis] >= 0.0 && std::isfinite(options.Spacing[axis])))
    {
      return Status::Failure(
        StatusCode::InvalidOption, "Spacing must not be negative, and finite.");
    }
  }
  return {};
}

/** The spacing that holds without a sizing. */
SizingField MakeConstantSizing(const Vec3& spacing, const std::vector<Vec3>& points)
{
  Vec3 low = points.front();
  Vec3 high = low;
  for (const Vec3& point : points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }
  const Vec3 sides = high - low;
  const double side = std::max({ sides.X, sides.Y, sides.Z });
  Vec3 lengths;
  for (int axis = 0; axis < 3; ++axis)
  {
    lengths[axis] = spacing[axis] > 0.0 ? spacing[axis] : 0.1 * side;
  }
  const LocalSpacing constant(lengths);
  return [constant](const Vec3&) { return constant; };
}

Status PlacePoints(const ExecutionContext& context, MeshPointPlacer& placer)
{
  switch (placer.GetOptions().Placement)
  {
    case PointPlacement::Octree:
      return PlaceOctreePoints(context, placer);
    case PointPlacement::OrthoProduct:
      return PlaceOrthoProductPoints(context, placer);
    case PointPlacement::Random:
      return PlaceRandomPoints(context, placer);
    default:
      return {};
  }
}

/** Rows of layers without points have theirs already. */
void WarnOfNoPoints(const MeshPointGeneratorOptions& options, MeshPointGeneratorOutput& output)
{
  if (!output.Points.empty())
  {
    return;
  }
  if (options.Placement != PointPlacement::None)
  {
    output.Warnings.push_back(
      { "No point has place inside: the spacing is too large for the regions." });
  }
  else if (options.Layers.empty())
  {
    output.Warnings.push_back(
      { "There are no mesh points, as only layers are to have some, and there are no layers: add "
        "them, or choose another placement." });
  }
}

Status RunGenerateMeshPoints(const MeshPointGeneratorInput& input,
  const MeshPointGeneratorOptions& options, const ExecutionContext& context,
  MeshPointGeneratorOutput& output)
{
  output = {};
  MeshPointGeneratorInput sized = input;
  if (!sized.Sizing && !input.Surface->Points.empty())
  {
    sized.Sizing = MakeConstantSizing(options.Spacing, input.Surface->Points);
  }
  MeshPointPlacer placer(sized, options, output);
  Status status = CheckOptions(options)
                    .Then([&] { return placer.Build(); })
                    .Then([&] { return PlaceLayerPoints(context.Part(0.05, 0.25), placer); })
                    .Then([&] { return PlacePoints(context.Part(0.25, 1.0), placer); });
  if (status.IsOk())
  {
    WarnOfNoPoints(options, output);
  }
  return status;
}
} // namespace

Status GenerateMeshPoints(const MeshPointGeneratorInput& input,
  const MeshPointGeneratorOptions& options, const ExecutionContext& context,
  MeshPointGeneratorOutput& output)
{
  return RunGuarded([&] { return RunGenerateMeshPoints(input, options, context, output); });
}
} // namespace cdm
