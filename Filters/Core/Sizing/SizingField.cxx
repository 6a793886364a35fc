// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/SizingField.h"

#include "Core/Basics/ParallelLoop.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

namespace cdm
{
namespace
{
/**
 * Makes a symmetric matrix diagonal by rotations, one of which takes away each pair of elements in
 * turn (Jacobi's method); the columns of the rotation are then the principal directions.
 */
void Diagonalize(double (&matrix)[3][3], double (&rotation)[3][3])
{
  // It converges quadratically: six sweeps leave nothing.
  constexpr int sweeps = 6;
  for (int step = 0; step < 3 * sweeps; ++step)
  {
    const int p = step % 3;
    const int q = (p + 1) % 3;
    if (matrix[p][q] == 0.0)
    {
      continue;
    }
    const double half = 0.5 * (matrix[q][q] - matrix[p][p]) / matrix[p][q];
    const double tangent =
      (half >= 0.0 ? 1.0 : -1.0) / (std::abs(half) + std::sqrt(half * half + 1.0));
    const double cosine = 1.0 / std::sqrt(tangent * tangent + 1.0);
    const double sine = tangent * cosine;
    const auto turn = [=](double& x, double& y)
    {
      const double turned = cosine * x - sine * y;
      y = sine * x + cosine * y;
      x = turned;
    };
    for (double(&row)[3] : matrix)
    {
      turn(row[p], row[q]);
    }
    for (int column = 0; column < 3; ++column)
    {
      turn(matrix[p][column], matrix[q][column]);
    }
    for (double(&row)[3] : rotation)
    {
      turn(row[p], row[q]);
    }
  }
}
} // namespace

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

LocalSpacing LocalSpacing::GetLimited(double length) const
{
  if (this->Largest <= length)
  {
    return *this;
  }
  if (this->Smallest >= length)
  {
    return length;
  }
  double inverse[3][3];
  double rotation[3][3] = { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } };
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      inverse[row][column] = this->Rows[row][column];
    }
  }
  Diagonalize(inverse, rotation);
  Vec3 lengths;
  Vec3 directions[3];
  for (int i = 0; i < 3; ++i)
  {
    lengths[i] = std::min(length, 1.0 / inverse[i][i]);
    directions[i] = { rotation[0][i], rotation[1][i], rotation[2][i] };
  }
  return LocalSpacing(lengths, directions);
}

//--------------------------------------------------------------------------------------------------
void SizingField::Limit(LengthFunction lengths)
{
  if (!this->Spacing)
  {
    this->Spacing = std::move(lengths);
    return;
  }
  this->Lengths = !this->Lengths
    ? std::move(lengths)
    : [former = std::move(this->Lengths), added = std::move(lengths)](const Vec3& position)
  { return std::min(former(position), added(position)); };
}

template <std::size_t Size>
bool SizingField::AnyBelowIn(
  const std::array<Vec3, Size>& corners, double length, const Predicate& isSought) const
{
  const auto isSoughtAt = [&](const Vec3& position)
  {
    if (this->Minima && !this->Minima->MayBeBelow(position, length) &&
      !(this->Lengths && this->Lengths(position) < length))
    {
      return false;
    }
    const LocalSpacing spacing = (*this)(position);
    return spacing.GetSmallest() < length && isSought(position, spacing);
  };
  Vec3 center;
  for (const Vec3& corner : corners)
  {
    center = center + (1.0 / Size) * corner;
  }
  if (isSoughtAt(center) || std::any_of(corners.begin(), corners.end(), isSoughtAt))
  {
    return true;
  }
  for (std::size_t i = 0; i < Size; ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      if (isSoughtAt(0.5 * (corners[i] + corners[j])))
      {
        return true;
      }
    }
  }
  bool isFound = false;
  if (this->Minima)
  {
    this->Minima->VisitBelow(ConvexRegion(corners), length,
      [&](const Vec3& position)
      {
        isFound = isSoughtAt(position);
        return isFound ? 0.0 : length;
      });
  }
  return isFound;
}

bool SizingField::AnyBelow(
  const std::array<Vec3, 3>& triangle, double length, const Predicate& isSought) const
{
  return this->AnyBelowIn(triangle, length, isSought);
}

bool SizingField::AnyBelow(
  const std::array<Vec3, 4>& tetrahedron, double length, const Predicate& isSought) const
{
  return this->AnyBelowIn(tetrahedron, length, isSought);
}

void SizingField::VisitMinima(const Box& box, double length,
  const std::function<void(const LocalSpacing& spacing)>& visit) const
{
  if (!this->Minima)
  {
    return;
  }
  this->Minima->VisitBelow(ConvexRegion(box), length,
    [&](const Vec3& position)
    {
      const LocalSpacing spacing = (*this)(position);
      visit(spacing);
      length = std::min(length, spacing.GetSmallest());
      return length;
    });
}

//--------------------------------------------------------------------------------------------------
namespace
{
constexpr const char* Activity = "Bounding the gradation";

/**
 * Visits points in the order of their sizes, a part of them at a time: larger parts have more to do
 * for all threads at once, in smaller ones fewer points are lowered more than once.
 */
class GradationBound
{
public:
  GradationBound(
    const SizingCells& cells, const GradationOptions& options, const std::vector<double>& sizes)
    : Cells(cells), Gradation(options.Gradation), Sizes(sizes.size()), IsNear(sizes.size())
  {
    std::copy(sizes.begin(), sizes.end(), this->Sizes.begin());
  }

  Status Run(const ExecutionContext& context, std::vector<double>& sizes);

private:
  void CollectCells();
  bool LowerNeighbors(double limit, const ExecutionContext& context);
  bool Lower(Id point, double size);
  double GetSize(Id point) const { return this->Sizes[point].load(std::memory_order_relaxed); }

  const SizingCells& Cells;
  const double Gradation;
  ParallelLoopOptions LoopOptions;
  /** Mean distance of two points of a cell. */
  double MeanDistance = 0.0;
  /** The cells of each point. */
  std::vector<Id> Starts;
  std::vector<Id> CellsOfPoints;
  std::vector<std::atomic<double>> Sizes;
  /** Points up to the limit whose neighbors are to be lowered. */
  std::vector<Id> Near;
  std::vector<std::atomic<bool>> IsNear;
  /** All points beyond the limit. */
  std::vector<Id> Far;
};

void GradationBound::CollectCells()
{
  const Id numberOfCells = static_cast<Id>(this->Cells.Offsets.size()) - 1;
  this->Starts.assign(this->Sizes.size() + 1, 0);
  for (const Id point : this->Cells.Connectivity)
  {
    ++this->Starts[point + 1];
  }
  std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
  std::vector<Id> places(this->Starts.begin(), this->Starts.end() - 1);
  this->CellsOfPoints.resize(this->Cells.Connectivity.size());
  double sum = 0.0;
  for (Id cell = 0; cell < numberOfCells; ++cell)
  {
    const Id begin = this->Cells.Offsets[cell];
    for (Id i = begin; i < this->Cells.Offsets[cell + 1]; ++i)
    {
      const Id point = this->Cells.Connectivity[i];
      this->CellsOfPoints[places[point]++] = cell;
      sum +=
        Distance(this->Cells.Points[this->Cells.Connectivity[begin]], this->Cells.Points[point]);
    }
  }
  this->MeanDistance = sum / std::max<double>(1.0, this->Cells.Connectivity.size());
}

/** Whether the size was larger. */
bool GradationBound::Lower(Id point, double size)
{
  std::atomic<double>& place = this->Sizes[point];
  double former = place.load(std::memory_order_relaxed);
  while (size < former)
  {
    if (place.compare_exchange_weak(former, size, std::memory_order_relaxed))
    {
      return true;
    }
  }
  return false;
}

/**
 * Lowers the sizes around all near points. Points that are lowered to no more than the limit become
 * near.
 */
bool GradationBound::LowerNeighbors(double limit, const ExecutionContext& context)
{
  const std::size_t count = this->Near.size();
  std::vector<std::vector<Id>> lowered(GetNumberOfBlocks(count, this->LoopOptions));
  const bool isDone = ParallelLoop(count, this->LoopOptions, context, Activity,
    [&](std::size_t begin, std::size_t end, std::size_t block)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Id point = this->Near[i];
        // Whoever lowers it from here on makes it near again.
        this->IsNear[point].exchange(false, std::memory_order_acq_rel);
        const double size = this->GetSize(point);
        for (Id j = this->Starts[point]; j < this->Starts[point + 1]; ++j)
        {
          const Id cell = this->CellsOfPoints[j];
          for (Id k = this->Cells.Offsets[cell]; k < this->Cells.Offsets[cell + 1]; ++k)
          {
            const Id other = this->Cells.Connectivity[k];
            const double bound = size +
              this->Gradation * Distance(this->Cells.Points[point], this->Cells.Points[other]);
            if (this->Lower(other, bound) && bound <= limit &&
              !this->IsNear[other].exchange(true, std::memory_order_acq_rel))
            {
              lowered[block].push_back(other);
            }
          }
        }
      }
    });
  this->Near.clear();
  for (const std::vector<Id>& points : lowered)
  {
    this->Near.insert(this->Near.end(), points.begin(), points.end());
  }
  return isDone;
}

Status GradationBound::Run(const ExecutionContext& context, std::vector<double>& sizes)
{
  this->LoopOptions.NumberOfThreads = context.GetNumberOfThreads();
  // Points of so many cells in a row at a time; more if to look for them takes longer than to visit
  // them, as where sizes differ by far more than cells do.
  constexpr double cellsAtOnce = 4.0;
  constexpr std::size_t fewVisits = 64;
  this->CollectCells();
  double step = std::max(
    cellsAtOnce * this->Gradation * this->MeanDistance, std::numeric_limits<double>::min());
  this->Far.resize(sizes.size());
  std::iota(this->Far.begin(), this->Far.end(), 0);
  while (!this->Far.empty())
  {
    const double done = 1.0 - double(this->Far.size()) / double(sizes.size());
    double smallest = Infinity;
    for (const Id point : this->Far)
    {
      smallest = std::min(smallest, this->GetSize(point));
    }
    const double limit = smallest + step;
    const auto isBeyond = [&](Id point) { return this->GetSize(point) > limit; };
    this->Near.assign(
      std::partition(this->Far.begin(), this->Far.end(), isBeyond), this->Far.end());
    for (const Id point : this->Near)
    {
      this->IsNear[point].store(true, std::memory_order_relaxed);
    }
    std::size_t visits = 0;
    while (!this->Near.empty())
    {
      visits += this->Near.size();
      if (!this->LowerNeighbors(limit, context.Part(done, done)))
      {
        return Status::Aborted();
      }
    }
    step *= fewVisits * visits < this->Far.size() ? 2.0 : 1.0;
    this->Far.erase(std::partition(this->Far.begin(), this->Far.end(), isBeyond), this->Far.end());
  }
  std::copy(this->Sizes.begin(), this->Sizes.end(), sizes.begin());
  return {};
}
} // namespace

Status BoundGradation(const SizingCells& cells, const GradationOptions& options,
  const ExecutionContext& context, std::vector<double>& sizes)
{
  return RunGuarded(
    [&]() -> Status { return GradationBound(cells, options, sizes).Run(context, sizes); });
}
} // namespace cdm
