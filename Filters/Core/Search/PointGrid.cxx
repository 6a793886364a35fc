// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/PointGrid.h"

#include <cmath>

namespace cdm
{
Id PointGrid::Find(const Vec3& p) const
{
  const Vec3 margin{ this->Tolerance, this->Tolerance, this->Tolerance };
  const Cell low = this->GetCell(p - margin);
  const Cell high = this->GetCell(p + margin);
  Id best = NoId;
  double bestDistance = this->Tolerance;
  for (std::int64_t x = low[0]; x <= high[0]; ++x)
  {
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
    {
      for (std::int64_t z = low[2]; z <= high[2]; ++z)
      {
        const auto found = this->Cells.find({ x, y, z });
        if (found == this->Cells.end())
        {
          continue;
        }
        for (const Id id : found->second)
        {
          const double distance = Distance(p, this->Points[id]);
          if (distance < bestDistance || (distance == bestDistance && (best == NoId || id < best)))
          {
            best = id;
            bestDistance = distance;
          }
        }
      }
    }
  }
  return best;
}

std::size_t PointGrid::CellHash::operator()(const Cell& cell) const
{
  std::uint64_t h = static_cast<std::uint64_t>(cell[0]) * 0x9E3779B97F4A7C15ull;
  h = (h ^ (h >> 29)) + static_cast<std::uint64_t>(cell[1]);
  h = h * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 32)) + static_cast<std::uint64_t>(cell[2]);
  h = h * 0x94D049BB133111EBull;
  return static_cast<std::size_t>(h ^ (h >> 31));
}

PointGrid::Cell PointGrid::GetCell(const Vec3& p) const
{
  return { static_cast<std::int64_t>(std::floor(p.X / this->Width)),
    static_cast<std::int64_t>(std::floor(p.Y / this->Width)),
    static_cast<std::int64_t>(std::floor(p.Z / this->Width)) };
}

} // namespace cdm
