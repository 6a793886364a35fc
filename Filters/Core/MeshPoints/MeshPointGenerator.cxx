// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/MeshPointGenerator.h"

#include "Core/MeshPoints/LayerPoints.h"
#include "Core/MeshPoints/MeshPointPlacer.h"
#include "Core/MeshPoints/OctreePoints.h"
#include "Core/MeshPoints/OrthoProductPoints.h"
#include "Core/MeshPoints/RandomPoints.h"

namespace cdm
{
namespace
{
Status RunGenerateMeshPoints(const MeshPointGeneratorInput& input,
  const MeshPointGeneratorOptions& options, const ExecutionContext& context,
  MeshPointGeneratorOutput& output)
{
  output = {};
  MeshPointPlacer placer(input, options, output);
  Status status = placer.Build();
  if (status.IsOk())
  {
    status = PlaceLayerPoints(context.Part(0.05, 0.25), placer);
  }
  if (!status.IsOk())
  {
    return status;
  }
  const ExecutionContext rest = context.Part(0.25, 1.0);
  switch (options.Placement)
  {
    case PointPlacement::Octree:
      return PlaceOctreePoints(rest, placer);
    case PointPlacement::OrthoProduct:
      return PlaceOrthoProductPoints(rest, placer);
    case PointPlacement::Random:
      return PlaceRandomPoints(rest, placer);
    default:
      return {};
  }
}
} // namespace

Status GenerateMeshPoints(const MeshPointGeneratorInput& input,
  const MeshPointGeneratorOptions& options, const ExecutionContext& context,
  MeshPointGeneratorOutput& output)
{
  return RunGuarded([&] { return RunGenerateMeshPoints(input, options, context, output); });
}
} // namespace cdm
