// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Pipeline/SurfaceCoarsener.h"

#include "Core/Meshes/EdgeUses.h"
#include "Core/Sizing/DefaultSize.h"
#include "Core/Surface/StructuralEdges.h"
#include "Core/Surface/SurfaceRemesher.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
/** The wanted length of edges, in maximum edge lengths; edges get a third longer or shorter. */
constexpr double WantedLengthRatio = 0.8;
/** The automatic bound, of the maximum edge length and of the thickness of regions. */
constexpr double AutomaticRatio = 0.1;
/** What counts as many triangles, and as small ones, which collapse: of the maximum edge length. */
constexpr Id ManyTriangles = 500;
constexpr double SmallEdgeRatio = WantedLengthRatio * CollapseRatio;

/** The maximum length of edges at a position; 0: none. */
double GetMaximumLength(const SizingField& sizing, double maximumEdgeLength, const Vec3& position)
{
  if (!sizing)
  {
    return maximumEdgeLength;
  }
  const double wanted = sizing(position).GetLargest();
  return maximumEdgeLength > 0.0 ? std::min(maximumEdgeLength, wanted) : wanted;
}

bool HasManyTriangles(const PolygonSoup& polygons)
{
  const Id count = polygons.GetNumberOfPolygons();
  for (Id polygon = 0; polygon < count; ++polygon)
  {
    if (polygons.GetPolygonSize(polygon) > 3)
    {
      return false;
    }
  }
  return count >= ManyTriangles;
}

/** Whether half of the edges are so short that they collapse. lengths: maximum ones at points. */
bool HasSmallEdges(const TriangleMesh& surface, const std::vector<double>& lengths)
{
  Id edges = 0;
  Id small = 0;
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
  for (std::size_t i = 0; i < uses.size(); i = FindEndOfEdge(uses, i))
  {
    const auto [a, b] = uses[i].GetPoints();
    ++edges;
    small += Distance(surface.Points[a], surface.Points[b]) <
      SmallEdgeRatio * std::min(lengths[a], lengths[b]);
  }
  return 2 * small >= edges;
}

/** 0 where the surface is not one of many small triangles, or of strips. */
double GetAutomaticDeviation(const PolygonSoup& polygons, const SizingField& sizing,
  double maximumEdgeLength, const TriangleMesh& surface)
{
  if ((!sizing && maximumEdgeLength == 0.0) || surface.Triangles.empty() ||
    !HasManyTriangles(polygons))
  {
    return 0.0;
  }
  std::vector<double> lengths;
  std::vector<double> wanted;
  for (const Vec3& point : surface.Points)
  {
    lengths.push_back(GetMaximumLength(sizing, maximumEdgeLength, point));
    wanted.push_back(WantedLengthRatio * lengths.back());
  }
  return HasSmallEdges(surface, lengths) || IsOfStrips(surface, wanted) ? AutomaticRatio *
      std::min(*std::min_element(lengths.begin(), lengths.end()), GetLeastThickness(surface))
                                                                        : 0.0;
}

/** A number for each triangle that says which polygons it may not be mixed with. */
std::vector<Id> MakeGroups(const ConformingMesherInput& input, const TriangleMesh& surface)
{
  std::vector<Id> groups;
  if (input.Facets.empty() && input.CellGroups.empty())
  {
    return groups;
  }
  const auto get = [](const std::vector<Id>& of, Id polygon)
  { return of.empty() || polygon == NoId ? NoId : of[polygon]; };
  std::map<std::array<Id, 2>, Id> numbers;
  for (const Id polygon : surface.SourceCells)
  {
    const std::array<Id, 2> key{ get(input.Facets, polygon), get(input.CellGroups, polygon) };
    groups.push_back(numbers.emplace(key, static_cast<Id>(numbers.size())).first->second);
  }
  return groups;
}

/** Points of the clean surface by points of the input. */
class SurfacePointParents
{
public:
  explicit SurfacePointParents(const PointHistory& history) : History(history) {}

  PointParents Get(Id point) const
  {
    const std::size_t given = this->History.SurfaceSources.size();
    return static_cast<std::size_t>(point) < given
      ? PointParents{ { this->History.SurfaceSources[point], NoId, NoId }, { 1.0, 0.0, 0.0 } }
      : this->History.SurfacePoints[point - given];
  }

  /** The three that weigh most of up to nine points of the input. */
  PointParents Compose(const PointParents& parents) const
  {
    std::map<Id, double> weights;
    for (int i = 0; i < 3 && parents.Ids[i] != NoId; ++i)
    {
      const PointParents own = this->Get(parents.Ids[i]);
      for (int j = 0; j < 3 && own.Ids[j] != NoId; ++j)
      {
        weights[own.Ids[j]] += parents.Weights[i] * own.Weights[j];
      }
    }
    std::vector<std::pair<double, Id>> sorted;
    for (const auto& [id, weight] : weights)
    {
      sorted.emplace_back(-weight, id);
    }
    std::sort(sorted.begin(), sorted.end());
    sorted.resize(std::min<std::size_t>(3, sorted.size()));
    double sum = 0.0;
    for (const auto& entry : sorted)
    {
      sum -= entry.first;
    }
    PointParents composed;
    for (std::size_t i = 0; i < sorted.size(); ++i)
    {
      composed.Ids[i] = sorted[i].second;
      composed.Weights[i] = -sorted[i].first / sum;
    }
    return composed;
  }

private:
  const PointHistory& History;
};

/** Points of the input that are left come first, as PointHistory asks for. */
void FollowPoints(const SurfaceRemesherOutput& remeshed, PointHistory& history)
{
  const SurfacePointParents parents(history);
  const std::size_t given = history.SurfaceSources.size();
  std::vector<Id> sources;
  std::vector<PointParents> points;
  for (const Id point : remeshed.PointSources)
  {
    if (static_cast<std::size_t>(point) < given)
    {
      sources.push_back(history.SurfaceSources[point]);
    }
    else
    {
      points.push_back(parents.Get(point));
    }
  }
  for (const PointParents& point : remeshed.NewPoints)
  {
    points.push_back(parents.Compose(point));
  }
  history.SurfaceSources = std::move(sources);
  history.SurfacePoints = std::move(points);
}

std::string Describe(
  std::size_t before, std::size_t after, double deviation, bool isAutomatic, bool hasSizing)
{
  char bound[32];
  std::snprintf(bound, sizeof bound, "%.4g", deviation);
  return "The surface was remeshed to the wanted size: " + std::to_string(before) +
    " triangles became " + std::to_string(after) + ", nowhere farther than " + bound +
    " from each other" +
    (isAutomatic ? std::string(" (the maximum deviation, chosen as a tenth of the ") +
          (hasSizing ? "smallest size" : "maximum edge length") +
          ", or of the thickness of the thinnest region; 0 keeps the surface as it is)."
                 : std::string(" (the maximum deviation)."));
}
} // namespace

Status CoarsenSurface(const ConformingMesherInput& input, const SizingField& sizing,
  const std::optional<double>& maximumDeviation, double maximumEdgeLength,
  const ExecutionContext& context, TriangleMesh& surface, ConformingMesherOutput& output)
{
  const bool isAutomatic = !maximumDeviation;
  SurfaceRemesherOptions options;
  options.MaximumDeviation = isAutomatic
    ? GetAutomaticDeviation(*input.Polygons, sizing, maximumEdgeLength, surface)
    : *maximumDeviation;
  if (options.MaximumDeviation == 0.0 || surface.Triangles.empty())
  {
    return {};
  }
  SurfaceRemesherInput remesherInput;
  remesherInput.Surface = &surface;
  remesherInput.Facets = MakeGroups(input, surface);
  if (sizing)
  {
    remesherInput.Sizing = [&](const Vec3& position)
    { return WantedLengthRatio * GetMaximumLength(sizing, maximumEdgeLength, position); };
  }
  options.EdgeLength = maximumEdgeLength > 0.0 || sizing ? WantedLengthRatio * maximumEdgeLength
                                                         : GetBoundingBoxDiagonal(surface.Points);
  SurfaceRemesherOutput remeshed;
  Status status = RemeshSurface(remesherInput, options, context, remeshed);
  if (!status.IsOk())
  {
    return status;
  }
  for (Id& source : remeshed.Surface.SourceCells)
  {
    source = surface.SourceCells[source];
  }
  FollowPoints(remeshed, output.Points);
  output.Warnings.push_back({ Describe(surface.Triangles.size(), remeshed.Surface.Triangles.size(),
    options.MaximumDeviation, isAutomatic, static_cast<bool>(sizing)) });
  surface = std::move(remeshed.Surface);
  return status;
}
} // namespace cdm
