// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointGrid.h
 * @brief Finds points by their position, up to a tolerance.
 *
 * Guarantees: the answer does not depend on the order in which points were inserted.
 * Cost: constant for a bounded number of points within a few tolerances of each other; 70 bytes per
 * point.
 */
#ifndef cdmPointGrid_h
#define cdmPointGrid_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace cdm
{
class PointGrid
{
public:
  /** The points have to outlive this; the tolerance is positive, in model units. */
  PointGrid(const std::vector<Vec3>& points, double tolerance)
    : Points(points), Tolerance(tolerance), Width(4.0 * tolerance)
  {
  }

  void Insert(Id id) { this->Cells[this->GetCell(this->Points[id])].push_back(id); }

  /** The nearest inserted point within the tolerance, the lowest of several, or NoId. */
  Id Find(const Vec3& p) const;

private:
  using Cell = std::array<std::int64_t, 3>;
  struct CellHash
  {
    std::size_t operator()(const Cell& cell) const;
  };

  Cell GetCell(const Vec3& p) const;

  const std::vector<Vec3>& Points;
  double Tolerance;
  double Width;
  std::unordered_map<Cell, std::vector<Id>, CellHash> Cells;
};
} // namespace cdm

#endif
