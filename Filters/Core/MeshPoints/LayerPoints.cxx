// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/LayerPoints.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Geometry/Measures.h"
#include "Core/MeshPoints/NearestInUnits.h"
#include "Core/Search/PointOctree.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace cdm
{
namespace
{
/** Points of layers that are nearer, in spacings, are the same up to rounding. */
constexpr double SmallestDistance = 1e-6;

/** A vertex of the refined surface, as seen from an interface. */
struct LayerVertex
{
  /** Normal of the interface, of any length. */
  Vec3 Normal;
  /** The shortest edge at the vertex. */
  double Edge = Infinity;
  /** Whether the vertex has triangles of other interfaces, too. */
  bool IsRim = false;
  /** Triangles of the interface at the vertex. */
  std::vector<Id> Triangles;
};

/** A vertex that carries a point of each layer. */
struct LayerFoot
{
  Vec3 Position;
  /** Into the region; a step along it leads as far away from the interface. */
  Vec3 Direction;
  double Edge;
  /** The interface ends here; where a wall begins there is no room for points above it. */
  bool IsRim;
};

/** Measures each vertex of the refined surface; false if there is no such interface. */
bool MeasureVertices(const PointLayers& layers, const RegionLocator& locator,
  const DelaunaySurfaceRefinerOutput& refined, std::vector<LayerVertex>& vertices)
{
  const TriangleMesh& surface = refined.Surface;
  vertices.resize(surface.Points.size());
  bool isFound = false;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const RegionPair regions = locator.GetRegions(surface.SourceCells[t]);
    const bool isForward = regions.Front == layers.Region && regions.Back == layers.Neighbor;
    const bool isBackward = regions.Back == layers.Region && regions.Front == layers.Neighbor;
    isFound = isFound || isForward || isBackward;
    for (int i = 0; i < 3; ++i)
    {
      LayerVertex& vertex = vertices[surface.Triangles[t][i]];
      const Vec3& origin = surface.Points[surface.Triangles[t][i]];
      const Vec3 a = surface.Points[surface.Triangles[t][(i + 1) % 3]] - origin;
      const Vec3 b = surface.Points[surface.Triangles[t][(i + 2) % 3]] - origin;
      vertex.Edge = std::min({ vertex.Edge, Norm(a), Norm(b) });
      if (!isForward && !isBackward)
      {
        vertex.IsRim = true;
        continue;
      }
      const Vec3 normal = Cross(a, b);
      const double angle = std::atan2(Norm(normal), Dot(a, b));
      vertex.Normal = vertex.Normal + ((isForward ? angle : -angle) / Norm(normal)) * normal;
      vertex.Triangles.push_back(static_cast<Id>(t));
    }
  }
  return isFound;
}

Status FindLayerFeet(const PointLayers& layers, const RegionLocator& locator,
  const DelaunaySurfaceRefinerOutput& refined, std::vector<LayerFoot>& feet)
{
  std::vector<LayerVertex> vertices;
  if (!MeasureVertices(layers, locator, refined, vertices))
  {
    return Status::Failure(StatusCode::InvalidOption,
      "There are to be layers in region " + std::to_string(layers.Region) + " off region " +
        std::to_string(layers.Neighbor) + ", but these have no interface.");
  }
  const TriangleMesh& surface = refined.Surface;
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    const LayerVertex& vertex = vertices[v];
    if (vertex.Triangles.empty() || !(Norm(vertex.Normal) > 0.0))
    {
      continue;
    }
    const Vec3 normal = (1.0 / Norm(vertex.Normal)) * vertex.Normal;
    // The distance from the triangles grows in proportion as long as no others come nearer.
    const double step = 1e-3 * vertex.Edge;
    double distance = Infinity;
    for (const Id t : vertex.Triangles)
    {
      const TriangleIds& ids = surface.Triangles[t];
      distance = std::min(distance,
        GetDistanceToTriangle(step * normal, surface.Points[ids[0]] - surface.Points[v],
          surface.Points[ids[1]] - surface.Points[v], surface.Points[ids[2]] - surface.Points[v]));
    }
    // In a sharp groove the points of all vertices would meet.
    if (distance > 0.3 * step)
    {
      feet.push_back({ surface.Points[v], (step / distance) * normal, vertex.Edge, vertex.IsRim });
    }
  }
  return {};
}

Status PlaceLayers(const PointLayers& layers, const std::vector<LayerFoot>& feet,
  const ExecutionContext& context, MeshPointPlacer& placer)
{
  const MeshPointGeneratorOptions& options = placer.GetOptions();
  const RegionLocator& locator = placer.GetLocator();
  MeshPointGeneratorOutput& output = placer.GetOutput();
  const double clearance = options.BoundaryClearance;
  PointOctree others;
  others.Insert(output.Points);
  for (Id number = 1; number <= layers.NumberOfLayers; ++number)
  {
    const double distance = GetLayerDistance(layers, number);
    const double gap = distance - GetLayerDistance(layers, number - 1);
    const auto getPosition = [distance](const LayerFoot& foot)
    { return foot.Position + distance * foot.Direction; };
    const auto getSpacing = [gap](const LayerFoot& foot)
    {
      return LocalSpacing(
        (1.0 / Norm(foot.Direction)) * foot.Direction, gap, std::max(gap, foot.Edge));
    };
    std::vector<char> isClear(feet.size());
    const auto test = [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Vec3 position = getPosition(feet[i]);
        isClear[i] = locator.IsClear(position, getSpacing(feet[i]), clearance) &&
          locator.IsClear(
            position, 1.0, (1.0 - 1e-9) * distance, { layers.Region, layers.Neighbor }) &&
          locator.Locate(position) == layers.Region;
      }
    };
    if (!ParallelLoop(
          feet.size(), { context.GetNumberOfThreads(), 64 }, context, "Placing layers", test))
    {
      return Status::Aborted();
    }
    for (std::size_t i = 0; i < feet.size(); ++i)
    {
      const Vec3 position = getPosition(feet[i]);
      NearestInUnits nearest(position, getSpacing(feet[i]), std::max(clearance, SmallestDistance));
      if (isClear[i])
      {
        others.Visit(nearest);
      }
      const bool stays = isClear[i] && nearest.Found == NoId;
      if (stays)
      {
        others.Insert(static_cast<Id>(output.Points.size()), position);
        const Status status = placer.Add(position, layers.Region, number);
        if (!status.IsOk())
        {
          return status;
        }
      }
      output.DroppedLayerPoints += !stays && !feet[i].IsRim;
    }
  }
  return {};
}

void WarnOfEmptyLayers(
  std::ptrdiff_t row, const PointLayers& layers, MeshPointGeneratorOutput& output)
{
  output.Warnings.push_back({ "Layers " + std::to_string(row) + ", in region " +
    std::to_string(layers.Region) + " off region " + std::to_string(layers.Neighbor) +
    ", have no points: the surface has no vertices inside of their interface at this spacing, or "
    "the layers do not fit into the region." });
}
} // namespace

Status PlaceLayerPoints(const ExecutionContext& context, MeshPointPlacer& placer)
{
  const MeshPointGeneratorOptions& options = placer.GetOptions();
  if (options.Layers.empty())
  {
    return {};
  }
  DelaunaySurfaceRefinerInput refinerInput;
  refinerInput.Surface = placer.GetInput().Surface;
  refinerInput.Sizing = placer.GetInput().Sizing;
  DelaunaySurfaceRefinerOutput refined;
  Status status = RefineDelaunaySurface(refinerInput, {}, context, refined);
  for (auto layers = options.Layers.begin(); layers != options.Layers.end() && status.IsOk();
       ++layers)
  {
    std::vector<LayerFoot> feet;
    const auto checkNumber = [&]
    {
      const double number = static_cast<double>(placer.GetOutput().Points.size()) +
        static_cast<double>(feet.size()) * layers->NumberOfLayers;
      return number > options.MaximumNumberOfPoints
        ? MakeTooManyPoints(options.MaximumNumberOfPoints)
        : Status();
    };
    const std::size_t before = placer.GetOutput().Points.size();
    status = FindLayerFeet(*layers, placer.GetLocator(), refined, feet)
               .Then(checkNumber)
               .Then([&] { return PlaceLayers(*layers, feet, context.Part(1.0, 1.0), placer); });
    if (status.IsOk() && placer.GetOutput().Points.size() == before)
    {
      WarnOfEmptyLayers(layers - options.Layers.begin(), *layers, placer.GetOutput());
    }
  }
  return status;
}
} // namespace cdm
