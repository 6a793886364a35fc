// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/CoincidentPoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <unordered_map>

namespace cdm
{
namespace
{
/** Cells of a grid as wide as the tolerance: a near point lies in one of 27 of them. */
bool MergeNearPoints(const std::vector<Vec3>& points, double tolerance,
  const ExecutionContext& context, std::vector<Id>& representatives)
{
  using Cell = std::array<double, 3>;
  struct CellHash
  {
    std::size_t operator()(const Cell& cell) const
    {
      const std::hash<double> hash;
      return (hash(cell[0]) * 0x9E3779B97F4A7C15u + hash(cell[1])) * 0x9E3779B97F4A7C15u +
        hash(cell[2]);
    }
  };
  std::unordered_map<Cell, std::vector<Id>, CellHash> grid;
  const Id n = static_cast<Id>(points.size());
  for (Id i = 0; i < n; ++i)
  {
    if (i % StepsBetweenChecks == 0 &&
      !context.Continue(static_cast<double>(i) / n, "Merging points"))
    {
      return false;
    }
    if (representatives[i] == NoId)
    {
      continue;
    }
    if (representatives[i] != i)
    {
      representatives[i] = representatives[representatives[i]];
      continue;
    }
    const Vec3& p = points[i];
    const Cell home{ std::floor(p.X / tolerance), std::floor(p.Y / tolerance),
      std::floor(p.Z / tolerance) };
    Id found = NoId;
    for (int k = 0; k < 27; ++k)
    {
      const int steps[3] = { k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1 };
      const auto cell = grid.find({ home[0] + steps[0], home[1] + steps[1], home[2] + steps[2] });
      if (cell == grid.end())
      {
        continue;
      }
      for (const Id other : cell->second)
      {
        if (Distance(p, points[other]) < tolerance && (found == NoId || other < found))
        {
          found = other;
        }
      }
    }
    if (found != NoId)
    {
      representatives[i] = found;
    }
    else
    {
      grid[home].push_back(i);
    }
  }
  return true;
}
} // namespace

bool FindRepresentatives(const std::vector<Vec3>& points, double tolerance,
  const ExecutionContext& context, std::vector<Id>& representatives)
{
  const Id n = static_cast<Id>(points.size());
  std::vector<Id> order;
  for (Id i = 0; i < n; ++i)
  {
    if (representatives[i] != NoId)
    {
      representatives[i] = i;
      order.push_back(i);
    }
  }
  std::sort(order.begin(), order.end(),
    [&points](Id a, Id b) { return points[a] != points[b] ? points[a] < points[b] : a < b; });
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (points[order[i]] == points[order[i - 1]])
    {
      representatives[order[i]] = representatives[order[i - 1]];
    }
  }
  return tolerance == 0.0 || MergeNearPoints(points, tolerance, context, representatives);
}
} // namespace cdm
