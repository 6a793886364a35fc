// SPDX-License-Identifier: BSD-3-Clause
#include "BallIndex.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
constexpr int InfiniteLevel = 1 << 20;

std::int64_t GetIndex(double coordinate, double width)
{
  // Far outside of any sensible ratio of size to radius the cells only have to be some cells.
  const double index = std::floor(coordinate / width);
  return static_cast<std::int64_t>(std::min(std::max(index, -4e18), 4e18));
}
}

std::uint64_t BallIndex::GetCell(int level, const std::int64_t index[3])
{
  std::uint64_t hash = static_cast<std::uint64_t>(level);
  for (int axis = 0; axis < 3; ++axis)
  {
    hash = (hash ^ static_cast<std::uint64_t>(index[axis])) * 0x9E3779B97F4A7C15ull;
    hash ^= hash >> 29;
  }
  return hash;
}

void BallIndex::Set(Id id, const Vec3& center, double radius)
{
  this->Remove(id);
  if (this->Balls.size() <= static_cast<std::size_t>(id))
  {
    this->Balls.resize(static_cast<std::size_t>(id) + 1);
  }
  Ball& ball = this->Balls[id];
  ball.Center = center;
  ball.Radius = radius;
  ball.Level = InfiniteLevel;
  ball.Cell = 0;
  if (std::isfinite(radius))
  {
    ball.Level = std::ilogb(std::max(radius, 1e-300)) + 2;
    const double width = std::ldexp(1.0, ball.Level);
    const std::int64_t index[3] = { GetIndex(center.X, width), GetIndex(center.Y, width),
      GetIndex(center.Z, width) };
    ball.Cell = GetCell(ball.Level, index);
  }
  this->Levels[ball.Level][ball.Cell].push_back(id);
}

void BallIndex::Remove(Id id)
{
  if (static_cast<std::size_t>(id) >= this->Balls.size() || this->Balls[id].Radius < 0.0)
  {
    return;
  }
  Ball& ball = this->Balls[id];
  const auto level = this->Levels.find(ball.Level);
  const auto cell = level->second.find(ball.Cell);
  cell->second.erase(std::find(cell->second.begin(), cell->second.end(), id));
  if (cell->second.empty())
  {
    level->second.erase(cell);
    if (level->second.empty())
    {
      this->Levels.erase(level);
    }
  }
  ball.Radius = -1.0;
}

void BallIndex::Find(const Vec3& point, std::vector<Id>& ids) const
{
  ids.clear();
  for (const auto& [level, cells] : this->Levels)
  {
    if (level == InfiniteLevel)
    {
      const std::vector<Id>& all = cells.begin()->second;
      ids.insert(ids.end(), all.begin(), all.end());
      continue;
    }
    // Radii are below half the width: the center lies in the cells nearest to the point.
    const double width = std::ldexp(1.0, level);
    std::int64_t first[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = GetIndex(point[axis] - 0.5 * width, width);
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      const std::int64_t index[3] = { first[0] + (corner & 1), first[1] + ((corner >> 1) & 1),
        first[2] + (corner >> 2) };
      const auto cell = cells.find(GetCell(level, index));
      if (cell == cells.end())
      {
        continue;
      }
      for (Id id : cell->second)
      {
        const Ball& ball = this->Balls[id];
        if (SquaredNorm(point - ball.Center) <= ball.Radius * ball.Radius)
        {
          ids.push_back(id);
        }
      }
    }
  }
  // Two corners may share a cell by their hash.
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}
}
