// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/CellSizing.h"

#include "Core/Geometry/Measures.h"
#include "Core/Search/BoxTree.h"
#include "Core/Search/PointOctree.h"
#include "Core/Search/PointSearches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace cdm
{
namespace
{
/** By how much a barycentric coordinate may be negative in the tetrahedron that counts. */
constexpr double CoordinateTolerance = 1e-9;

class CellInterpolator
{
public:
  CellInterpolator(SizingCells cells, std::vector<double> lengths)
    : Cells(std::move(cells)), Lengths(std::move(lengths)), Tree(MakeBoxes(Cells))
  {
    for (std::size_t i = 0; i < this->Cells.Points.size(); ++i)
    {
      // Points of an octree are distinct; of several at one place the first one counts.
      NearestPointVisitor nearest(this->Cells.Points[i], NoId);
      this->Octree.Visit(nearest);
      if (nearest.Nearest == NoId || nearest.SquaredDistance > 0.0)
      {
        this->Octree.Insert(static_cast<Id>(i), this->Cells.Points[i]);
      }
    }
  }

  double operator()(const Vec3& p) const
  {
    Box box;
    box.Add(p);
    double inside = -CoordinateTolerance;
    double length = 0.0;
    Id first = NoId;
    this->Tree.VisitOverlaps(box,
      [&](Id cell)
      {
        std::array<double, 4> weights;
        const double lowest = this->FindWeights(cell, p, weights);
        if (lowest > inside || (lowest == inside && cell < first))
        {
          inside = lowest;
          first = cell;
          length = 0.0;
          for (int i = 0; i < 4; ++i)
          {
            length += weights[i] * this->Lengths[this->Cells.Connectivity[4 * cell + i]];
          }
          length = std::max(length, this->GetShortest(cell));
        }
      });
    if (first != NoId)
    {
      return length;
    }
    NearestPointVisitor nearest(p, NoId);
    this->Octree.Visit(nearest);
    return this->Lengths[std::max<Id>(0, nearest.Nearest)];
  }

private:
  static std::vector<Box> MakeBoxes(const SizingCells& cells)
  {
    std::vector<Box> boxes(cells.Offsets.size() - 1);
    for (std::size_t i = 0; i < cells.Connectivity.size(); ++i)
    {
      boxes[i / 4].Add(cells.Points[cells.Connectivity[i]]);
    }
    return boxes;
  }

  /** Barycentric coordinates; returns the smallest of them. */
  double FindWeights(Id cell, const Vec3& p, std::array<double, 4>& weights) const
  {
    const auto corner = [&](int i) -> const Vec3&
    { return this->Cells.Points[this->Cells.Connectivity[4 * cell + i]]; };
    const double volume = GetSignedVolume(corner(0), corner(1), corner(2), corner(3));
    weights[0] = GetSignedVolume(p, corner(1), corner(2), corner(3)) / volume;
    weights[1] = GetSignedVolume(corner(0), p, corner(2), corner(3)) / volume;
    weights[2] = GetSignedVolume(corner(0), corner(1), p, corner(3)) / volume;
    weights[3] = 1.0 - weights[0] - weights[1] - weights[2];
    const double lowest = *std::min_element(weights.begin(), weights.end());
    // Flat ones hold nothing.
    return std::isfinite(weights[3]) ? lowest : -1.0;
  }

  double GetShortest(Id cell) const
  {
    double shortest = this->Lengths[this->Cells.Connectivity[4 * cell]];
    for (int i = 1; i < 4; ++i)
    {
      shortest = std::min(shortest, this->Lengths[this->Cells.Connectivity[4 * cell + i]]);
    }
    return shortest;
  }

  SizingCells Cells;
  std::vector<double> Lengths;
  BoxTree Tree;
  PointOctree Octree;
};
} // namespace

//--------------------------------------------------------------------------------------------------
Status MakeCellSizing(SizingCells cells, std::vector<double> lengths, SizingField& sizing)
{
  std::vector<Id> bad;
  for (std::size_t i = 0; i < cells.Points.size(); ++i)
  {
    if (!IsFinite(cells.Points[i]) || !std::isfinite(lengths[i]) || !(lengths[i] > 0.0))
    {
      bad.push_back(static_cast<Id>(i));
    }
  }
  if (!bad.empty() || cells.Points.empty())
  {
    return Status::InvalidInput(
      "A sizing needs points with finite coordinates, and a positive length at each.", {}, bad);
  }
  auto minima = std::make_shared<const SizingMinima>(cells, lengths);
  const auto interpolator =
    std::make_shared<const CellInterpolator>(std::move(cells), std::move(lengths));
  sizing = SizingField(
    [interpolator](const Vec3& p) { return LocalSpacing((*interpolator)(p)); }, std::move(minima));
  return {};
}
} // namespace cdm
