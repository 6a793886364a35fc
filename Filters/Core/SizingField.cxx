// SPDX-License-Identifier: BSD-3-Clause
#include "SizingField.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <utility>

namespace cdm
{
LocalSpacing::LocalSpacing(const Vec3& lengths)
  : Rows{ { 1.0 / lengths.X, 0.0, 0.0 }, { 0.0, 1.0 / lengths.Y, 0.0 },
      { 0.0, 0.0, 1.0 / lengths.Z } },
    Extents(lengths), Smallest(std::min({ lengths.X, lengths.Y, lengths.Z })),
    Largest(std::max({ lengths.X, lengths.Y, lengths.Z }))
{
}

LocalSpacing::LocalSpacing(const Vec3& lengths, const Vec3 (&directions)[3])
  : Smallest(std::min({ lengths.X, lengths.Y, lengths.Z })),
    Largest(std::max({ lengths.X, lengths.Y, lengths.Z }))
{
  for (int row = 0; row < 3; ++row)
  {
    double square = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      this->Rows[row] = this->Rows[row] + (directions[i][row] / lengths[i]) * directions[i];
      square += lengths[i] * lengths[i] * directions[i][row] * directions[i][row];
    }
    this->Extents[row] = std::sqrt(square);
  }
}

LocalSpacing::LocalSpacing(const Vec3& direction, double along, double across)
  : Smallest(std::min(along, across)), Largest(std::max(along, across))
{
  for (int row = 0; row < 3; ++row)
  {
    const double part = direction[row];
    this->Rows[row] = (part * (1.0 / along - 1.0 / across)) * direction;
    this->Rows[row][row] += 1.0 / across;
    this->Extents[row] =
      std::sqrt(part * part * along * along + std::max(0.0, 1.0 - part * part) * across * across);
  }
}

Status BoundGradation(const SizingCells& cells, double gradation, const ExecutionContext& context,
  std::vector<double>& sizes)
{
  // Cells of each point.
  const Id numberOfCells = static_cast<Id>(cells.Offsets.size()) - 1;
  std::vector<Id> starts(sizes.size() + 1, 0);
  for (const Id point : cells.Connectivity)
  {
    ++starts[point + 1];
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Id> places(starts.begin(), starts.end() - 1);
  std::vector<Id> cellsOfPoints(cells.Connectivity.size());
  for (Id cell = 0; cell < numberOfCells; ++cell)
  {
    for (Id i = cells.Offsets[cell]; i < cells.Offsets[cell + 1]; ++i)
    {
      cellsOfPoints[places[cells.Connectivity[i]]++] = cell;
    }
  }

  // A point that leaves the queue has its final size: what is left in it is larger.
  using Entry = std::pair<double, Id>;
  std::vector<Entry> entries;
  entries.reserve(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    entries.emplace_back(sizes[i], static_cast<Id>(i));
  }
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(
    std::greater<>(), std::move(entries));
  for (std::size_t settled = 0; !queue.empty();)
  {
    const auto [size, point] = queue.top();
    queue.pop();
    if (size > sizes[point])
    {
      continue;
    }
    if (++settled % 4096 == 0 &&
      !context.Continue(static_cast<double>(settled) / sizes.size(), "Bounding the gradation"))
    {
      return Status::Aborted();
    }
    for (Id i = starts[point]; i < starts[point + 1]; ++i)
    {
      const Id cell = cellsOfPoints[i];
      for (Id j = cells.Offsets[cell]; j < cells.Offsets[cell + 1]; ++j)
      {
        const Id other = cells.Connectivity[j];
        const double bound = size + gradation * Distance(cells.Points[point], cells.Points[other]);
        if (bound < sizes[other])
        {
          sizes[other] = bound;
          queue.emplace(bound, other);
        }
      }
    }
  }
  return {};
}
} // namespace cdm
