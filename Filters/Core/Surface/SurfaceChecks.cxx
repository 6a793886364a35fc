// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceChecks.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Search/SpatialSort.h"

#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>
#include <vector>

namespace cdm
{
Status CheckRefinableSurface(const TriangleMesh& surface, std::size_t numberOfMeshPoints)
{
  if (surface.Triangles.empty())
  {
    return Status::InvalidInput("The surface has no triangles; there is nothing to refine.");
  }
  const Status range = CheckNumberOfPoints(surface.Points.size(), numberOfMeshPoints);
  if (!range.IsOk())
  {
    return range;
  }
  const std::vector<Vec3>& points = surface.Points;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!IsFinite(points[i]))
    {
      return Status::InvalidInput(
        "A point has a coordinate that is not a finite number; remove or repair it.", {},
        { static_cast<Id>(i) });
    }
  }
  std::vector<Id> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  SortAlongHilbertCurve(points, order);
  std::vector<Id> coincident;
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (points[order[i]] == points[order[i - 1]])
    {
      coincident.push_back(order[i - 1]);
      coincident.push_back(order[i]);
    }
  }
  if (!coincident.empty())
  {
    SortUnique(coincident);
    return Status::InvalidInput("Points of the surface coincide; merge them with "
                                "the boundary triangulator first.",
      {}, std::move(coincident));
  }
  std::vector<Id> degenerate;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    const Vec3& a = points[ids[0]];
    const Vec3& b = points[ids[1]];
    const Vec3& c = points[ids[2]];
    // Far above the error of the cross product, and of products below the range of doubles.
    const double certain = 1e-24 * SquaredNorm(b - a) * SquaredNorm(c - a);
    if (!(certain > 1e-280 && SquaredNorm(Cross(b - a, c - a)) > certain) && AreCollinear(a, b, c))
    {
      degenerate.push_back(static_cast<Id>(t));
    }
  }
  if (!degenerate.empty())
  {
    return Status::InvalidInput(
      "Triangles without area; clean the surface with the boundary triangulator first.",
      std::move(degenerate));
  }
  return Status();
}

Status CheckMaximumEdgeLength(const TriangleMesh& surface, double maximumEdgeLength)
{
  if (!(maximumEdgeLength > 0.0))
  {
    return {};
  }
  // No triangle is larger than the equilateral one, and there is a point for two of them.
  const double points =
    GetSurfaceArea(surface) / (0.5 * std::sqrt(3.0)) / maximumEdgeLength / maximumEdgeLength;
  if (points <= static_cast<double>(LargestId))
  {
    return {};
  }
  char text[160];
  std::snprintf(text, sizeof text,
    "A maximum edge length of %.4g asks for at least %.3g points on the surface, more than the "
    "%.3g that can be counted. Enlarge it.",
    maximumEdgeLength, points, static_cast<double>(LargestId));
  return Status::Failure(StatusCode::LimitReached, text);
}
} // namespace cdm
