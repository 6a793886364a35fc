// SPDX-License-Identifier: BSD-3-Clause
#include "BallIndex.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
/** Infinite balls have a level of their own, of one cell. */
constexpr int InfiniteLevel = 1 << 20;

std::int64_t GetIndex(double coordinate, double width)
{
  // Far outside of any sensible ratio of size to radius the cells only have to be some cells.
  const double index = std::floor(coordinate / width);
  return static_cast<std::int64_t>(std::min(std::max(index, -4e18), 4e18));
}

int GetLevel(double radius)
{
  // Powers of four: half of the levels of powers of two cost less than the larger cells.
  return std::isfinite(radius) ? (std::ilogb(std::max(radius, 1e-300)) & ~1) + 3 : InfiniteLevel;
}
} // namespace

std::uint64_t BallIndex::GetKey(int level, const std::int64_t index[3])
{
  std::uint64_t hash = static_cast<std::uint64_t>(level);
  for (int axis = 0; axis < 3; ++axis)
  {
    hash = (hash ^ static_cast<std::uint64_t>(index[axis])) * 0x9E3779B97F4A7C15ull;
    hash ^= hash >> 29;
  }
  return hash;
}

/** The slot of a cell, or the free one where it belongs. */
std::size_t BallIndex::FindSlot(std::uint64_t key) const
{
  const std::size_t mask = this->Slots.size() - 1;
  std::size_t slot = key & mask;
  while (this->Slots[slot].second != NoId && this->Slots[slot].first != key)
  {
    slot = (slot + 1) & mask;
  }
  return slot;
}

void BallIndex::Resize(std::size_t numberOfSlots)
{
  std::vector<std::pair<std::uint64_t, Id>> former(numberOfSlots, { 0, NoId });
  former.swap(this->Slots);
  for (const auto& [key, cell] : former)
  {
    if (cell != NoId)
    {
      this->Slots[this->FindSlot(key)] = { key, cell };
    }
  }
}

void BallIndex::Put(const Ball& ball)
{
  std::int64_t index[3] = { 0, 0, 0 };
  if (ball.Level != InfiniteLevel)
  {
    const double width = std::ldexp(1.0, ball.Level);
    for (int axis = 0; axis < 3; ++axis)
    {
      index[axis] = GetIndex(ball.Center[axis], width);
    }
  }
  const std::uint64_t key = GetKey(ball.Level, index);
  auto& slot = this->Slots[this->FindSlot(key)];
  if (slot.second == NoId)
  {
    slot = { key, static_cast<Id>(this->Cells.size()) };
    this->Cells.emplace_back();
  }
  std::vector<Ball>& balls = this->Cells[slot.second];
  this->Places[ball.Number] = { slot.second, static_cast<Id>(balls.size()) };
  balls.push_back(ball);
  if (2 * this->Cells.size() > this->Slots.size())
  {
    this->Resize(2 * this->Slots.size());
  }
}

void BallIndex::Set(Id id, const Vec3& center, double radius)
{
  this->Remove(id);
  if (this->Places.size() <= static_cast<std::size_t>(id))
  {
    this->Places.resize(static_cast<std::size_t>(id) + 1);
  }
  const Ball ball{ center, radius, GetLevel(radius), id };
  ++this->Levels[ball.Level];
  if (this->Slots.empty())
  {
    this->Places[id].Index = static_cast<Id>(this->Waiting.size());
    this->Waiting.push_back(ball);
    return;
  }
  this->Put(ball);
}

void BallIndex::Remove(Id id)
{
  if (static_cast<std::size_t>(id) >= this->Places.size() || this->Places[id].Index == NoId)
  {
    return;
  }
  const Place place = this->Places[id];
  std::vector<Ball>& balls = this->Slots.empty() ? this->Waiting : this->Cells[place.Cell];
  const auto level = this->Levels.find(balls[place.Index].Level);
  if (--level->second == 0)
  {
    this->Levels.erase(level);
  }
  balls[place.Index] = balls.back();
  this->Places[balls.back().Number].Index = place.Index;
  this->Places[id].Index = NoId;
  balls.pop_back();
}

void BallIndex::Find(const Vec3& point, std::vector<Id>& ids)
{
  ids.clear();
  if (this->Slots.empty())
  {
    this->Resize(1024);
    for (const Ball& ball : this->Waiting)
    {
      this->Put(ball);
    }
    this->Waiting = {};
  }
  const auto visit = [this, &point, &ids](std::uint64_t key)
  {
    const Id cell = this->Slots[this->FindSlot(key)].second;
    if (cell == NoId)
    {
      return;
    }
    for (const Ball& ball : this->Cells[cell])
    {
      if (SquaredNorm(point - ball.Center) <= ball.Radius * ball.Radius)
      {
        ids.push_back(ball.Number);
      }
    }
  };
  for (const auto& [level, count] : this->Levels)
  {
    std::int64_t first[3] = { 0, 0, 0 };
    if (level == InfiniteLevel)
    {
      visit(GetKey(level, first));
      continue;
    }
    // Radii are below half the width: the center lies in the cells nearest to the point.
    const double width = std::ldexp(1.0, level);
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = GetIndex(point[axis] - 0.5 * width, width);
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      const std::int64_t index[3] = { first[0] + (corner & 1), first[1] + ((corner >> 1) & 1),
        first[2] + (corner >> 2) };
      visit(GetKey(level, index));
    }
  }
  // Two corners may share a cell by their hash.
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}
} // namespace cdm
