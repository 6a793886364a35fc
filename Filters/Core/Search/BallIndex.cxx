// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/BallIndex.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
namespace
{
/** Infinite balls have a level of their own, of one cell. */
constexpr int InfiniteLevel = 1 << 20;

/** Rounding to single precision moves points and centers by less than that, in widths of a cell. */
constexpr double Rounding = 2e-6;

/** Cells farther away than doubles tell apart are not used. */
constexpr double LargestIndex = 4e15;

/** Mark of a cell in its slot: it tells most other cells from the one that is searched. */
std::uint32_t GetMark(std::uint64_t hash)
{
  return static_cast<std::uint32_t>(hash >> 32);
}

int GetLevel(double radius)
{
  // Powers of four: half of the levels of powers of two cost less than the larger cells.
  return std::isfinite(radius) ? (std::ilogb(std::max(radius, 1e-300)) & ~1) + 3 : InfiniteLevel;
}
} // namespace

std::uint64_t BallIndex::CellPlace::GetHash() const
{
  // A sum, of which neighbors have most in common.
  std::uint64_t hash = static_cast<std::uint64_t>(this->Level) * 0x9E3779B97F4A7C15ull +
    static_cast<std::uint64_t>(this->Index[0]) * 0xC2B2AE3D27D4EB4Full +
    static_cast<std::uint64_t>(this->Index[1]) * 0x165667B19E3779F9ull +
    static_cast<std::uint64_t>(this->Index[2]) * 0xD6E8FEB86659FD93ull;
  hash = (hash ^ (hash >> 32)) * 0xD6E8FEB86659FD93ull;
  return hash ^ (hash >> 32);
}

/** The slot of a cell with this hash, or the free one where it belongs. */
std::size_t BallIndex::FindSlot(const CellPlace& place, std::uint64_t hash) const
{
  const std::size_t mask = this->Slots.size() - 1;
  const std::uint32_t mark = GetMark(hash);
  std::size_t slot = hash & mask;
  while (this->Slots[slot].Cell != NoId &&
    !(this->Slots[slot].Mark == mark && this->Cells[this->Slots[slot].Cell].Place == place))
  {
    slot = (slot + 1) & mask;
  }
  return slot;
}

void BallIndex::Resize(std::size_t numberOfSlots)
{
  this->Slots.assign(numberOfSlots, Slot());
  for (std::size_t cell = 0; cell < this->Cells.size(); ++cell)
  {
    const CellPlace& place = this->Cells[cell].Place;
    const std::uint64_t hash = place.GetHash();
    this->Slots[this->FindSlot(place, hash)] = { static_cast<Id>(cell), GetMark(hash) };
  }
}

void BallIndex::Put(const Ball& ball)
{
  CellPlace where{ GetLevel(ball.Radius), { 0, 0, 0 } };
  double width = where.Level == InfiniteLevel ? Infinity : std::ldexp(1.0, where.Level);
  Vec3 corner;
  for (int axis = 0; axis < 3 && where.Level != InfiniteLevel; ++axis)
  {
    const double index = std::floor(ball.Center[axis] / width);
    if (std::abs(index) < LargestIndex)
    {
      where.Index[axis] = static_cast<std::int64_t>(index);
      corner[axis] = index * width;
    }
    else
    {
      where = { InfiniteLevel, { 0, 0, 0 } };
      width = Infinity;
      corner = Vec3();
    }
  }
  const std::uint64_t hash = where.GetHash();
  Slot& slot = this->Slots[this->FindSlot(where, hash)];
  if (slot.Cell == NoId)
  {
    slot = { static_cast<Id>(this->Cells.size()), GetMark(hash) };
    this->Cells.emplace_back();
    this->Cells.back().Place = where;
    this->Cells.back().Corner = corner;
  }
  Cell& cell = this->Cells[slot.Cell];
  const std::size_t place = cell.Numbers.size();
  this->Places[ball.Number] = { slot.Cell, static_cast<Id>(place) };
  cell.Numbers.push_back(ball.Number);
  if (place % BlockSize == 0)
  {
    cell.Blocks.emplace_back();
  }
  Block& block = cell.Blocks.back();
  const std::size_t i = place % BlockSize;
  const Vec3 center = (1.0 / width) * (ball.Center - corner);
  const double radius = ball.Radius / width + Rounding;
  block.X[i] = static_cast<float>(center.X);
  block.Y[i] = static_cast<float>(center.Y);
  block.Z[i] = static_cast<float>(center.Z);
  block.SquaredRadius[i] = where.Level == InfiniteLevel ? std::numeric_limits<float>::infinity()
                                                        : static_cast<float>(radius * radius);
  const float reach = std::sqrt(block.SquaredRadius[i]) * 1.0001f;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float middle = static_cast<float>(center[axis]);
    const bool isFirst = place == 0;
    cell.Low[axis] = isFirst ? middle - reach : std::min(cell.Low[axis], middle - reach);
    cell.High[axis] = isFirst ? middle + reach : std::max(cell.High[axis], middle + reach);
  }
  ++this->Levels[where.Level];
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
  const Ball ball{ center, radius, id };
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
  const auto place = static_cast<std::size_t>(this->Places[id].Index);
  if (this->Slots.empty())
  {
    this->Waiting[place] = this->Waiting.back();
    this->Places[this->Waiting[place].Number].Index = this->Places[id].Index;
    this->Waiting.pop_back();
  }
  else
  {
    Cell& cell = this->Cells[this->Places[id].Cell];
    const auto level = this->Levels.find(cell.Place.Level);
    if (--level->second == 0)
    {
      this->Levels.erase(level);
    }
    const std::size_t last = cell.Numbers.size() - 1;
    Block& to = cell.Blocks[place / BlockSize];
    const Block& from = cell.Blocks.back();
    to.X[place % BlockSize] = from.X[last % BlockSize];
    to.Y[place % BlockSize] = from.Y[last % BlockSize];
    to.Z[place % BlockSize] = from.Z[last % BlockSize];
    to.SquaredRadius[place % BlockSize] = from.SquaredRadius[last % BlockSize];
    cell.Numbers[place] = cell.Numbers[last];
    this->Places[cell.Numbers[place]].Index = this->Places[id].Index;
    cell.Numbers.pop_back();
    if (last % BlockSize == 0)
    {
      cell.Blocks.pop_back();
    }
  }
  this->Places[id].Index = NoId;
}

void BallIndex::Find(const Cell& cell, double scale, const Vec3& point, std::vector<Id>& ids)
{
  const Vec3 p = scale * (point - cell.Corner);
  const float x = static_cast<float>(p.X);
  const float y = static_cast<float>(p.Y);
  const float z = static_cast<float>(p.Z);
  if (x < cell.Low[0] || y < cell.Low[1] || z < cell.Low[2] || x > cell.High[0] ||
    y > cell.High[1] || z > cell.High[2])
  {
    return;
  }
  for (std::size_t b = 0; b < cell.Blocks.size(); ++b)
  {
    const Block& block = cell.Blocks[b];
    // The loop has constant length and no branches: compilers make vector instructions of it.
    std::int32_t isHit[BlockSize];
    std::int32_t isAnyHit = 0;
    for (std::size_t i = 0; i < BlockSize; ++i)
    {
      const float dx = x - block.X[i];
      const float dy = y - block.Y[i];
      const float dz = z - block.Z[i];
      isHit[i] = dx * dx + dy * dy + dz * dz <= block.SquaredRadius[i] ? 1 : 0;
      isAnyHit |= isHit[i];
    }
    if (isAnyHit != 0)
    {
      const std::size_t first = b * BlockSize;
      const std::size_t count = std::min(BlockSize, cell.Numbers.size() - first);
      for (std::size_t i = 0; i < count; ++i)
      {
        if (isHit[i] != 0)
        {
          ids.push_back(cell.Numbers[first + i]);
        }
      }
    }
  }
}

void BallIndex::Settle()
{
  if (this->Slots.empty())
  {
    this->Resize(1024);
    for (const Ball& ball : this->Waiting)
    {
      this->Put(ball);
    }
    this->Waiting = {};
  }
}

void BallIndex::FindSettled(const Vec3& point, std::vector<Id>& ids) const
{
  ids.clear();
  for (const auto& [level, count] : this->Levels)
  {
    if (level == InfiniteLevel)
    {
      this->FindInCells<1>({ { { level, { 0, 0, 0 } } } }, 0.0, point, ids);
      continue;
    }
    // Radii are below half the width: the center lies in the cells nearest to the point.
    const double width = std::ldexp(1.0, level);
    std::int64_t first[3];
    bool isInReach = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double index = std::floor(point[axis] / width - 0.5);
      isInReach = isInReach && std::abs(index) <= LargestIndex + 1.0;
      first[axis] = isInReach ? static_cast<std::int64_t>(index) : 0;
    }
    if (isInReach)
    {
      std::array<CellPlace, 8> places;
      for (int corner = 0; corner < 8; ++corner)
      {
        places[corner] = { level,
          { first[0] + (corner & 1), first[1] + ((corner >> 1) & 1), first[2] + (corner >> 2) } };
      }
      this->FindInCells<8>(places, std::ldexp(1.0, -level), point, ids);
    }
  }
  std::sort(ids.begin(), ids.end());
}

/**
 * Finds balls in those of the cells that there are.
 * @param scale 1 by the width of the cells
 */
template <std::size_t Count>
void BallIndex::FindInCells(const std::array<CellPlace, Count>& places, double scale,
  const Vec3& point, std::vector<Id>& ids) const
{
  // The slots are all read before any of them is looked at: in a large index each is a cache miss,
  // and a branch would make one wait for the other.
  std::array<std::uint64_t, Count> hashes;
  std::array<Id, Count> cells;
  for (std::size_t i = 0; i < Count; ++i)
  {
    hashes[i] = places[i].GetHash();
    cells[i] = this->Slots[hashes[i] & (this->Slots.size() - 1)].Cell;
  }
  for (std::size_t i = 0; i < Count; ++i)
  {
    const Id cell =
      cells[i] == NoId ? NoId : this->Slots[this->FindSlot(places[i], hashes[i])].Cell;
    if (cell != NoId)
    {
      BallIndex::Find(this->Cells[cell], scale, point, ids);
    }
  }
}
} // namespace cdm
