// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceRemesher.h"

#include "Core/Geometry/Measures.h"
#include "Core/Surface/FeatureChains.h"
#include "Core/Surface/RemeshingPasses.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace cdm
{
bool IsOfStrips(const TriangleMesh& surface, const std::vector<double>& lengths)
{
  const auto isStrip = [&](const TriangleIds& ids)
  {
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const Id a = ids[i];
      const Id b = ids[(i + 1) % 3];
      const double ratio =
        Distance(surface.Points[a], surface.Points[b]) / std::min(lengths[a], lengths[b]);
      shortest = std::min(shortest, ratio);
      longest = std::max(longest, ratio);
    }
    return shortest < CollapseRatio && longest > SplitRatio;
  };
  const auto strips = std::count_if(surface.Triangles.begin(), surface.Triangles.end(), isStrip);
  return 2 * static_cast<std::size_t>(strips) >= surface.Triangles.size();
}

namespace
{
/** What part of the bound the collapse of strips may take. */
constexpr double StripsRatio = 0.1;

/** What is known of a surface. */
struct SurfaceParts
{
  /** The wanted length of edges at each point. */
  std::vector<double> Lengths;
  std::vector<Id> Facets;
  std::vector<StructuralEdge> Edges;
  /** Points that were corners before strips collapsed. */
  std::vector<Id> Corners;
};

/**
 * Short edges collapse within a part of the bound, all else is within the rest: proofs meet
 * a few large triangles then instead of hundreds of narrow ones, which takes 6 instead of 28 s for a
 * pipe of 1,000 facets. What is left has points of the input only.
 */
Status RemoveStrips(const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options,
  const ExecutionContext& context, ThreadTeam& threads, SurfaceParts& parts,
  SurfaceRemesherOutput& left)
{
  RemeshingPasses remesher(input, options, parts.Lengths, parts.Facets, parts.Edges, threads);
  if (!remesher.CollapseStrips(context))
  {
    return Status::Aborted();
  }
  remesher.MakeOutput(left);
  SurfaceParts leftParts;
  for (std::size_t i = 0; i < left.PointSources.size(); ++i)
  {
    const Id point = left.PointSources[i];
    leftParts.Lengths.push_back(parts.Lengths[point]);
    if (remesher.GetFixedPoints()[point] != 0)
    {
      leftParts.Corners.push_back(static_cast<Id>(i));
    }
  }
  for (const Id triangle : left.Surface.SourceCells)
  {
    leftParts.Facets.push_back(parts.Facets[triangle]);
  }
  leftParts.Edges = remesher.ListStructuralEdges(left.PointSources);
  parts = std::move(leftParts);
  return {};
}

/** All steps for a surface of strips. */
Status RemeshStrips(const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options,
  const ExecutionContext& context, ThreadTeam& threads, SurfaceParts& parts,
  SurfaceRemesherOutput& output)
{
  SurfaceRemesherOptions stepOptions = options;
  stepOptions.MaximumDeviation = StripsRatio * options.MaximumDeviation;
  SurfaceRemesherOutput left;
  Status status = RemoveStrips(input, stepOptions, context.Part(0.0, 0.1), threads, parts, left);
  if (!status.IsOk())
  {
    return status;
  }
  SurfaceRemesherInput leftInput = input;
  leftInput.Surface = &left.Surface;
  stepOptions.MaximumDeviation = (1.0 - StripsRatio) * options.MaximumDeviation;
  RemeshingPasses remesher(
    leftInput, stepOptions, parts.Lengths, parts.Facets, parts.Edges, threads);
  for (const Id corner : parts.Corners)
  {
    remesher.FixPoint(corner);
  }
  if (!remesher.CutStrips(context.Part(0.1, 0.4)) || !remesher.Run(context.Part(0.4, 1.0)))
  {
    return Status::Aborted();
  }
  remesher.MakeOutput(output);
  for (Id& triangle : output.Surface.SourceCells)
  {
    triangle = left.Surface.SourceCells[triangle];
  }
  for (Id& point : output.PointSources)
  {
    point = left.PointSources[point];
  }
  for (PointParents& point : output.NewPoints)
  {
    for (Id& parent : point.Ids)
    {
      parent = left.PointSources[parent];
    }
  }
  return {};
}

Status RunRemeshSurface(const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options,
  const ExecutionContext& context, SurfaceRemesherOutput& output)
{
  if (!(options.MaximumDeviation > 0.0) || (!(options.EdgeLength > 0.0) && !input.Sizing))
  {
    return Status::Failure(StatusCode::InvalidOption,
      "The deviation and the length of edges have to be positive to make a surface coarser.");
  }
  StructuralEdgeOptions edgeOptions;
  edgeOptions.AccuracyAngle = options.FeatureAngle;
  edgeOptions.Facets = input.Facets;
  SurfaceParts parts;
  for (const Vec3& point : input.Surface->Points)
  {
    parts.Lengths.push_back(GetWantedLength(input, options, point));
  }
  Status status = FindFeatureChains(
    *input.Surface, edgeOptions, parts.Lengths, context.Part(0.0, 0.05), parts.Edges);
  if (!status.IsOk() || input.Surface->Triangles.empty())
  {
    return status;
  }
  parts.Facets =
    NumberFacets(SortEdgeUses(input.Surface->Triangles, input.Surface->Points.size()), parts.Edges);
  const ExecutionContext rest = context.Part(0.05, 1.0);
  const std::shared_ptr<ThreadTeam> team = context.GetTeam();
  if (IsOfStrips(*input.Surface, parts.Lengths))
  {
    return RemeshStrips(input, options, rest, *team, parts, output);
  }
  RemeshingPasses remesher(
    input, options, std::move(parts.Lengths), parts.Facets, parts.Edges, *team);
  if (!remesher.Run(rest))
  {
    return Status::Aborted();
  }
  remesher.MakeOutput(output);
  return {};
}
} // namespace

Status RemeshSurface(const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options,
  const ExecutionContext& context, SurfaceRemesherOutput& output)
{
  output = {};
  Status status = RunGuarded([&] { return RunRemeshSurface(input, options, context, output); });
  if (!status.IsOk())
  {
    output = {};
  }
  return status;
}
} // namespace cdm
