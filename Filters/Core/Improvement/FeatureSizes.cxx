// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/FeatureSizes.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"

#include <algorithm>
#include <utility>

namespace cdm
{
namespace
{
/** The first radius of a search, in units of the limit; each next one is four times as large. */
constexpr double FirstRadius = 1.0 / 4.0;
/**
 * Smallest size, in units of the limit. Features closer to each other bound a strip or a layer that
 * nobody fills with well shaped elements.
 */
constexpr double SmallestSize = 0.01;

/**
 * Give up where this many features touch each other, as at the tip of a cone: others do not matter.
 */
constexpr std::size_t MostTouching = 256;

double GetDistance(const Vec3& position, const Vec3& a, const Vec3& b)
{
  const Vec3 way = b - a;
  const double share = Dot(position - a, way) / SquaredNorm(way);
  return Distance(position, a + std::min(std::max(share, 0.0), 1.0) * way);
}

std::vector<EdgeIds> ListPoints(const std::vector<StructuralEdge>& edges)
{
  std::vector<EdgeIds> points;
  for (const StructuralEdge& edge : edges)
  {
    points.push_back(edge.Points);
  }
  return points;
}
} // namespace

FeatureSizes::FeatureSizes(const std::vector<Vec3>& points,
  const std::vector<TriangleIds>& triangles, const std::vector<Id>& facets,
  const std::vector<StructuralEdge>& edges, int numberOfThreads)
  : Points(points), Edges(ListPoints(edges)), Triangles(triangles), Facets(facets),
    Contacts(static_cast<Id>(points.size()), triangles, facets),
    Tree(this->MakeBoxes(), numberOfThreads)
{
}

std::vector<Box> FeatureSizes::MakeBoxes() const
{
  std::vector<Box> boxes;
  const auto add = [&](const auto& ids)
  {
    boxes.emplace_back();
    for (Id id : ids)
    {
      boxes.back().Add(this->Points[id]);
    }
  };
  std::for_each(this->Edges.begin(), this->Edges.end(), add);
  std::for_each(this->Triangles.begin(), this->Triangles.end(), add);
  return boxes;
}

Id FeatureSizes::GetFeature(Id part) const
{
  const Id first = static_cast<Id>(this->Edges.size());
  return part < first ? part : first + this->Facets[part - first];
}

double FeatureSizes::GetDistanceTo(Id part, const Vec3& position) const
{
  const Id first = static_cast<Id>(this->Edges.size());
  if (part < first)
  {
    const EdgeIds& ids = this->Edges[part];
    return GetDistance(position, this->Points[ids[0]], this->Points[ids[1]]);
  }
  const TriangleIds& ids = this->Triangles[part - first];
  return GetDistanceToTriangle(
    position, this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
}

/** Whether two features have no common point. */
bool FeatureSizes::AreDisjoint(Id a, Id b) const
{
  const Id first = static_cast<Id>(this->Edges.size());
  const auto [low, high] = std::minmax(a, b);
  if (low >= first)
  {
    return this->Contacts.AreDisjoint(low - first, high - first);
  }
  const EdgeIds& ids = this->Edges[low];
  return std::none_of(ids.begin(), ids.end(),
    [&, last = high](Id id)
    {
      const IdLists::Range facets = this->Contacts.PointFacets[id];
      return last < first ? Contains(this->Edges[last], id)
                          : std::binary_search(facets.begin(), facets.end(), last - first);
    });
}

double FeatureSizes::Find(const Vec3& position, double limit) const
{
  std::vector<std::pair<double, Id>> near;
  // Features found so far: their other parts are farther away.
  std::vector<Id> nearer;
  for (double radius = FirstRadius * limit;; radius = std::min(4.0 * radius, limit))
  {
    near.clear();
    this->Tree.VisitNear(position, radius,
      [&](Id part)
      {
        const Id feature = this->GetFeature(part);
        if (Contains(nearer, feature))
        {
          return;
        }
        const double distance = this->GetDistanceTo(part, position);
        if (distance < radius)
        {
          near.emplace_back(distance, feature);
        }
      });
    std::sort(near.begin(), near.end());
    for (const auto& [distance, feature] : near)
    {
      // A facet is as close as the closest one of its triangles.
      if (Contains(nearer, feature))
      {
        continue;
      }
      if (nearer.size() == MostTouching)
      {
        return limit;
      }
      if (distance >= SmallestSize * limit &&
        std::any_of(nearer.begin(), nearer.end(),
          [this, feature = feature](Id other) { return this->AreDisjoint(feature, other); }))
      {
        return distance;
      }
      nearer.push_back(feature);
    }
    if (radius >= limit)
    {
      return limit;
    }
  }
}
} // namespace cdm
