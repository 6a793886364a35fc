// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/FeatureSizes.h"

#include <algorithm>

namespace cdm
{
namespace
{
/** The first radius of a search, in limits; the next ones are four times as large. */
constexpr double FirstRadius = 1.0 / 64.0;
/**
 * In limits: edges closer to each other are a strip that nobody fills with well shaped elements.
 */
constexpr double SmallestSize = 0.01;

double GetDistance(const Vec3& position, const std::array<Vec3, 2>& ends)
{
  const Vec3 way = ends[1] - ends[0];
  const double share = Dot(position - ends[0], way) / SquaredNorm(way);
  return Distance(position, ends[0] + std::min(std::max(share, 0.0), 1.0) * way);
}

bool AreDisjoint(const EdgeIds& a, const EdgeIds& b)
{
  return a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1];
}
} // namespace

FeatureSizes::FeatureSizes(
  const std::vector<Vec3>& points, const std::vector<StructuralEdge>& edges)
  : Segments(MakeSegments(points, edges)), Tree(MakeBoxes(this->Segments))
{
}

std::vector<FeatureSizes::Segment> FeatureSizes::MakeSegments(
  const std::vector<Vec3>& points, const std::vector<StructuralEdge>& edges)
{
  std::vector<Segment> segments;
  for (const StructuralEdge& edge : edges)
  {
    segments.push_back({ edge.Points, { points[edge.Points[0]], points[edge.Points[1]] } });
  }
  return segments;
}

std::vector<Box> FeatureSizes::MakeBoxes(const std::vector<Segment>& segments)
{
  std::vector<Box> boxes(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    boxes[i].Add(segments[i].Ends[0]);
    boxes[i].Add(segments[i].Ends[1]);
  }
  return boxes;
}

double FeatureSizes::Find(const Vec3& position, double limit) const
{
  std::vector<std::pair<double, Id>> near;
  for (double radius = FirstRadius * limit;; radius = std::min(4.0 * radius, limit))
  {
    near.clear();
    this->Tree.VisitOverlaps(Box::MakeAround(position, radius),
      [&](Id id)
      {
        const double distance = GetDistance(position, this->Segments[id].Ends);
        if (distance < radius)
        {
          near.emplace_back(distance, id);
        }
      });
    std::sort(near.begin(), near.end());
    for (auto second = near.begin(); second != near.end(); ++second)
    {
      if (second->first >= SmallestSize * limit &&
        std::any_of(near.begin(), second,
          [&](const std::pair<double, Id>& first) {
            return AreDisjoint(
              this->Segments[first.second].Ids, this->Segments[second->second].Ids);
          }))
      {
        return second->first;
      }
    }
    if (radius >= limit)
    {
      return limit;
    }
  }
}
} // namespace cdm
