// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/SizingField.h"

#include "Core/Meshes/TetMesh.h"
#include "Core/Sizing/TetrahedronLimits.h"
#include "Core/Sizing/TriangleLimits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

using namespace cdm;

namespace
{
constexpr int Divisions = 4;

/** Random lengths at the points of a grid over the unit cube, six tetrahedra in each of its cubes. */
class KuhnGrid
{
public:
  explicit KuhnGrid(std::mt19937_64& random)
  {
    std::uniform_real_distribution<double> exponent(-2.0, 0.0);
    for (int i = 0; i < 125; ++i)
    {
      const int corner[3] = { i % 5, i / 5 % 5, i / 25 };
      this->Cells.Points.push_back({ corner[0] / 4.0, corner[1] / 4.0, corner[2] / 4.0 });
      this->Lengths.push_back(std::pow(10.0, exponent(random)));
    }
    for (int i = 0; i < 64; ++i)
    {
      std::array<int, 3> axes{ 0, 1, 2 };
      do
      {
        std::array<int, 3> corner{ i % 4, i / 4 % 4, i / 16 };
        this->Cells.Connectivity.push_back(GetId(corner));
        for (const int axis : axes)
        {
          ++corner[axis];
          this->Cells.Connectivity.push_back(GetId(corner));
        }
        this->Cells.Offsets.push_back(static_cast<Id>(this->Cells.Connectivity.size()));
      } while (std::next_permutation(axes.begin(), axes.end()));
    }
  }

  /** The linear interpolation. */
  double operator()(const Vec3& p) const
  {
    std::array<int, 3> corner;
    std::array<double, 3> part;
    std::array<int, 3> axes{ 0, 1, 2 };
    for (int axis = 0; axis < 3; ++axis)
    {
      corner[axis] = std::clamp(static_cast<int>(p[axis] * Divisions), 0, Divisions - 1);
      part[axis] = p[axis] * Divisions - corner[axis];
    }
    std::sort(axes.begin(), axes.end(), [&](int a, int b) { return part[a] > part[b]; });
    double value = (1.0 - part[axes[0]]) * this->Lengths[GetId(corner)];
    for (int i = 0; i < 3; ++i)
    {
      ++corner[axes[i]];
      value += (part[axes[i]] - (i < 2 ? part[axes[i + 1]] : 0.0)) * this->Lengths[GetId(corner)];
    }
    return value;
  }

  SizingField MakeField() const
  {
    return { [grid = *this](const Vec3& p) { return LocalSpacing(grid(p)); },
      std::make_shared<const SizingMinima>(this->Cells, this->Lengths) };
  }

private:
  static Id GetId(const std::array<int, 3>& corner)
  {
    return corner[0] + 5 * (corner[1] + 5 * corner[2]);
  }

  SizingCells Cells;
  std::vector<double> Lengths;
};

/** The smallest length in a triangle or tetrahedron, by smaller and smaller lengths in question. */
template <std::size_t Size>
double FindMinimum(const SizingField& field, const std::array<Vec3, Size>& corners)
{
  double smallest = std::numeric_limits<double>::infinity();
  while (field.AnyBelow(corners, smallest,
    [&](const Vec3& position, const LocalSpacing& spacing)
    {
      smallest = spacing.GetSmallest();
      const ConvexRegion region(corners);
      for (int plane = 0; plane < region.GetNumberOfPlanes(); ++plane)
      {
        EXPECT_GE(region.GetHeight(plane, position), -1e-9);
      }
      return true;
    }))
  {
  }
  return smallest;
}

template <std::size_t Size>
void ExpectTheMinimum(const KuhnGrid& grid, std::mt19937_64& random)
{
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const SizingField field = grid.MakeField();
  for (int sample = 0; sample < 100; ++sample)
  {
    std::array<Vec3, Size> corners;
    for (Vec3& corner : corners)
    {
      corner = { uniform(random), uniform(random), uniform(random) };
    }
    double sampled = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 1000; ++i)
    {
      double sum = 0.0;
      Vec3 p;
      for (const Vec3& corner : corners)
      {
        const double weight = -std::log(1.0 - uniform(random));
        p = p + weight * corner;
        sum += weight;
      }
      sampled = std::min(sampled, grid((1.0 / sum) * p));
    }
    const double found = FindMinimum(field, corners);
    EXPECT_LE(found, sampled * (1.0 + 1e-12));
  }
}
} // namespace

TEST(SizingMinima, FindsTheSmallestLengthOfALinearField)
{
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  const KuhnGrid grid(random);
  ExpectTheMinimum<3>(grid, random);
  ExpectTheMinimum<4>(grid, random);
  // A box has the smallest of the points in it.
  double smallest = std::numeric_limits<double>::infinity();
  grid.MakeField().VisitMinima({ { 0.2, 0.2, 0.2 }, { 0.8, 0.8, 0.8 } }, smallest,
    [&](const LocalSpacing& spacing) { smallest = std::min(smallest, spacing.GetSmallest()); });
  double sampled = smallest;
  std::uniform_real_distribution<double> uniform(0.2, 0.8);
  for (int i = 0; i < 100000; ++i)
  {
    sampled = std::min(sampled, grid({ uniform(random), uniform(random), uniform(random) }));
  }
  EXPECT_LE(smallest, sampled);
  EXPECT_GE(smallest, 0.8 * sampled);
}

TEST(SizingMinima, FindsPointsOfHexahedraTrianglesAndClouds)
{
  // Small at one point in the middle of the tetrahedron, and at none of its corners.
  const std::array<Vec3, 4> tetrahedron{ Vec3{ 0.0, 0.0, 0.0 }, Vec3{ 1.0, 0.0, 0.0 },
    Vec3{ 0.0, 1.0, 0.0 }, Vec3{ 0.0, 0.0, 1.0 } };
  const Vec3 place{ 0.1, 0.2, 0.15 };
  const std::vector<Vec3> points{ place, { 2.0, 0.0, 0.0 }, { 2.0, 2.0, 0.0 }, { 0.0, 2.0, 0.0 },
    { 0.0, 0.0, 2.0 }, { 2.0, 0.0, 2.0 }, { 2.0, 2.0, 2.0 }, { 0.0, 2.0, 2.0 } };
  std::vector<double> lengths(points.size(), 10.0);
  lengths[0] = 0.001;
  const auto spacing = [&](const Vec3& p)
  { return LocalSpacing(0.001 + 10.0 * Distance(p, place)); };
  for (const Id size : { 1, 2, 3, 4, 8 })
  {
    SizingCells cells;
    cells.Points = points;
    for (Id i = 0; i < size; ++i)
    {
      cells.Connectivity.push_back(i);
    }
    cells.Offsets.push_back(size);
    TetrahedronLimits limits;
    limits.Sizing =
      SizingField(spacing, std::make_shared<const SizingMinima>(std::move(cells), lengths));
    EXPECT_NEAR(FindMinimum(limits.Sizing, tetrahedron), 0.001, 1e-9) << size;
    Vec3 target;
    double severity = 0.0;
    EXPECT_EQ(limits.Find(tetrahedron, false, target, severity), TetrahedronFault::Size) << size;
    // A triangle through the place, too.
    TriangleLimits triangleLimits;
    triangleLimits.Sizing = limits.Sizing;
    Id edge = NoId;
    EXPECT_TRUE(triangleLimits.IsTooCoarse(
      { Vec3{ 0.0, 0.0, 0.15 }, Vec3{ 1.0, 0.0, 0.15 }, Vec3{ 0.0, 1.0, 0.15 } },
      { false, false, false }, true, edge))
      << size;
  }
}

TEST(SizingMinima, AFunctionIsAskedAtCornersEdgesAndCenter)
{
  const std::array<Vec3, 3> triangle{ Vec3{ 0.0, 0.0, 0.0 }, Vec3{ 1.0, 0.0, 0.0 },
    Vec3{ 0.0, 1.0, 0.0 } };
  for (const Vec3& place :
    { Vec3{ 0.0, 0.0, 0.0 }, Vec3{ 0.5, 0.5, 0.0 }, Vec3{ 1.0 / 3.0, 1.0 / 3.0, 0.0 } })
  {
    const SizingField field = [&](const Vec3& p)
    { return LocalSpacing(0.001 + 1e6 * Distance(p, place)); };
    EXPECT_LT(FindMinimum(field, triangle), 0.0011);
  }
}
