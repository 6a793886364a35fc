// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/SpatialSort.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/RawVector.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace cdm
{
namespace
{
/** Runs up to this length are sorted by their coordinates. */
constexpr std::size_t SmallRun = 6;
constexpr int MaximumBits = 21;
constexpr int DigitBits = 11;
/** Threads sort parts of this many items at least. */
constexpr std::size_t SmallestPart = std::size_t(1) << 15;

/** For each state and octant: the octant's number along the curve, and the next state. */
struct CurveTable
{
  std::array<std::array<unsigned char, 8>, 24> Numbers;
  std::array<std::array<unsigned char, 8>, 24> States;

  CurveTable()
  {
    const auto rotateRight = [](unsigned x, unsigned by)
    {
      by %= 3;
      return ((x >> by) | (x << (3 - by))) & 7u;
    };
    for (unsigned entry = 0; entry < 8; ++entry)
    {
      for (unsigned direction = 0; direction < 3; ++direction)
      {
        for (unsigned octant = 0; octant < 8; ++octant)
        {
          const unsigned gray = rotateRight(octant ^ entry, direction + 1);
          const unsigned number = gray ^ (gray >> 1) ^ (gray >> 2);
          // Entry point and direction of the sub-curve (Hamilton and Rau-Chaplin).
          const unsigned even = number == 0 ? 0 : 2 * ((number - 1) / 2);
          const unsigned subEntry = number == 0 ? 0 : even ^ (even >> 1);
          const unsigned odd = number == 0 ? 0 : number % 2 == 0 ? number - 1 : number;
          unsigned trailing = 0;
          while (((odd >> trailing) & 1u) != 0)
          {
            ++trailing;
          }
          const unsigned nextEntry = entry ^ rotateRight(subEntry, 3 - (direction + 1) % 3);
          const unsigned nextDirection = (direction + trailing % 3 + 1) % 3;
          this->Numbers[3 * entry + direction][octant] = static_cast<unsigned char>(number);
          this->States[3 * entry + direction][octant] =
            static_cast<unsigned char>(3 * nextEntry + nextDirection);
        }
      }
    }
  }
};

struct Item
{
  std::uint64_t Key;
  Id Point;
};

class HilbertSorter
{
public:
  HilbertSorter(const std::vector<Vec3>& points, int numberOfThreads)
    : Points(points), NumberOfThreads(numberOfThreads)
  {
  }

  void Sort(Id* begin, Id* end)
  {
    const std::size_t count = end - begin;
    if (count <= SmallRun)
    {
      this->SortByCoordinates(begin, end);
      return;
    }
    Vec3 low = this->Points[*begin];
    Vec3 high = low;
    for (const Id* id = begin; id != end; ++id)
    {
      const Vec3& p = this->Points[*id];
      low = { std::min(low.X, p.X), std::min(low.Y, p.Y), std::min(low.Z, p.Z) };
      high = { std::max(high.X, p.X), std::max(high.Y, p.Y), std::max(high.Z, p.Z) };
    }
    // Half of the extent: the whole one of the largest doubles would be infinite.
    const double extent = std::max(
      { 0.5 * high.X - 0.5 * low.X, 0.5 * high.Y - 0.5 * low.Y, 0.5 * high.Z - 0.5 * low.Z });
    if (extent < std::numeric_limits<double>::min())
    {
      this->SortByCoordinates(begin, end);
      return;
    }
    int bits = 3;
    while (bits < MaximumBits && (std::size_t(1) << (3 * (bits - 2))) < count)
    {
      ++bits;
    }
    const double cells = static_cast<double>(std::uint64_t(1) << bits);
    const std::uint64_t lastCell = (std::uint64_t(1) << bits) - 1;
    const auto toCell = [cells, lastCell, extent](double x, double from)
    {
      const double cell = (0.5 * x - 0.5 * from) / extent * cells;
      return std::min(static_cast<std::uint64_t>(cell), lastCell);
    };
    static const CurveTable Table;
    RawVector<Item> items(count);
    ParallelLoop(count, { this->NumberOfThreads, std::size_t(1) << 15 }, {}, "",
      [&](std::size_t first, std::size_t last, std::size_t)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          const Vec3& p = this->Points[begin[i]];
          const std::uint64_t x = toCell(p.X, low.X);
          const std::uint64_t y = toCell(p.Y, low.Y);
          const std::uint64_t z = toCell(p.Z, low.Z);
          std::uint64_t key = 0;
          unsigned state = 0;
          for (int bit = bits - 1; bit >= 0; --bit)
          {
            const unsigned octant =
              ((x >> bit) & 1u) | (((y >> bit) & 1u) << 1) | (((z >> bit) & 1u) << 2);
            key = (key << 3) | Table.Numbers[state][octant];
            state = Table.States[state][octant];
          }
          items[i] = { key, begin[i] };
        }
      });
    this->SortByKey(items, 3 * bits);
    for (std::size_t i = 0; i < count; ++i)
    {
      begin[i] = items[i].Point;
    }
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    for (std::size_t first = 0, next = 0; first < count; first = next)
    {
      while (next < count && items[next].Key == items[first].Key)
      {
        ++next;
      }
      if (next - first > 1)
      {
        runs.emplace_back(first, next);
      }
    }
    items = RawVector<Item>();
    for (const auto& [first, next] : runs)
    {
      this->Sort(begin + first, begin + next);
    }
  }

private:
  void SortByCoordinates(Id* begin, Id* end) const
  {
    std::sort(begin, end,
      [this](Id i, Id j)
      { return this->Points[i] != this->Points[j] ? this->Points[i] < this->Points[j] : i < j; });
  }

  /**
   * Radix sort by digits, from the last one on; each thread counts and moves one part of the items.
   */
  void SortByKey(RawVector<Item>& items, int bits) const
  {
    if (items.size() < 512)
    {
      std::sort(
        items.begin(), items.end(), [](const Item& a, const Item& b) { return a.Key < b.Key; });
      return;
    }
    constexpr std::size_t Digits = std::size_t(1) << DigitBits;
    const std::size_t part =
      std::max(SmallestPart, items.size() / static_cast<std::size_t>(this->NumberOfThreads) + 1);
    const ParallelLoopOptions options{ this->NumberOfThreads, part };
    RawVector<Item> other(items.size());
    std::vector<std::vector<std::size_t>> starts(GetNumberOfBlocks(items.size(), options));
    for (int shift = 0; shift < bits; shift += DigitBits)
    {
      const auto getDigit = [shift](const Item& item)
      { return (item.Key >> shift) & (Digits - 1); };
      ParallelLoop(items.size(), options, {}, "",
        [&](std::size_t first, std::size_t last, std::size_t block)
        {
          starts[block].assign(Digits, 0);
          for (std::size_t i = first; i < last; ++i)
          {
            ++starts[block][getDigit(items[i])];
          }
        });
      std::size_t sum = 0;
      for (std::size_t digit = 0; digit < Digits; ++digit)
      {
        for (std::vector<std::size_t>& ofPart : starts)
        {
          sum += ofPart[digit];
          ofPart[digit] = sum - ofPart[digit];
        }
      }
      ParallelLoop(items.size(), options, {}, "",
        [&](std::size_t first, std::size_t last, std::size_t block)
        {
          for (std::size_t i = first; i < last; ++i)
          {
            other[starts[block][getDigit(items[i])]++] = items[i];
          }
        });
      items.swap(other);
    }
  }

  const std::vector<Vec3>& Points;
  int NumberOfThreads;
};
} // namespace

void SortAlongHilbertCurve(
  const std::vector<Vec3>& points, std::vector<Id>& ids, int numberOfThreads)
{
  HilbertSorter(points, numberOfThreads).Sort(ids.data(), ids.data() + ids.size());
}
} // namespace cdm
