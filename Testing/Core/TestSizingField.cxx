// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/SizingField.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace cdm;

TEST(SizingField, SpacingIsTheRadiusOfAnEllipsoid)
{
  const LocalSpacing sphere = 2.0;
  EXPECT_DOUBLE_EQ(sphere.GetAlong({ 3.0, -1.0, 2.0 }), 2.0);
  EXPECT_DOUBLE_EQ(sphere.GetDensity(), 1.0 / 8.0);

  const LocalSpacing axes(Vec3{ 1.0, 2.0, 4.0 });
  EXPECT_DOUBLE_EQ(axes.GetAlong({ 0.0, -3.0, 0.0 }), 2.0);
  EXPECT_EQ(axes.GetSmallest(), 1.0);
  EXPECT_EQ(axes.GetLargest(), 4.0);
  // On the ellipsoid x^2 + (y / 2)^2 = 1 in direction (1, 1): r = 1 / sqrt((1 + 1 / 4) / 2).
  EXPECT_NEAR(axes.GetAlong({ 1.0, 1.0, 0.0 }), 1.0 / std::sqrt(0.625), 1e-15);

  // Turned by 30 degrees about z, in both forms.
  const double c = std::sqrt(0.75);
  const double s = 0.5;
  const Vec3 directions[3] = { { c, s, 0.0 }, { -s, c, 0.0 }, { 0.0, 0.0, 1.0 } };
  const LocalSpacing turned({ 1.0, 3.0, 3.0 }, directions);
  const LocalSpacing layer(directions[0], 1.0, 3.0);
  for (const LocalSpacing& spacing : { turned, layer })
  {
    EXPECT_NEAR(spacing.GetAlong(directions[0]), 1.0, 1e-14);
    EXPECT_NEAR(spacing.GetAlong(directions[1]), 3.0, 1e-14);
    EXPECT_NEAR(spacing.GetAlong({ 0.0, 0.0, 1.0 }), 3.0, 1e-14);
    EXPECT_NEAR(spacing.GetDensity(), 1.0 / 9.0, 1e-15);
    EXPECT_NEAR(Norm(spacing.ToUnits(2.0 * directions[1])), 2.0 / 3.0, 1e-15);
    EXPECT_NEAR(spacing.GetExtents().X, std::sqrt(c * c + 9.0 * s * s), 1e-14);
    EXPECT_NEAR(spacing.GetExtents().Z, 3.0, 1e-14);
    EXPECT_EQ(spacing.GetSmallest(), 1.0);
    EXPECT_EQ(spacing.GetLargest(), 3.0);
  }
}

TEST(SizingField, BoundsTheGradation)
{
  // Cells of four random points each, in a cloud.
  const unsigned seed = 17;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const auto uniform = [&random] { return random() / 4294967296.0; };
  SizingCells cells;
  std::vector<double> given;
  for (int i = 0; i < 500; ++i)
  {
    cells.Points.push_back({ uniform(), uniform(), uniform() });
    given.push_back(std::pow(10.0, -3.0 + 4.0 * uniform()));
  }
  for (int cell = 0; cell < 800; ++cell)
  {
    for (int i = 0; i < 4; ++i)
    {
      cells.Connectivity.push_back(static_cast<Id>(random() % cells.Points.size()));
    }
    cells.Offsets.push_back(static_cast<Id>(cells.Connectivity.size()));
  }
  constexpr double gradation = 0.4;
  std::vector<double> sizes = given;
  ASSERT_TRUE(BoundGradation(cells, { gradation }, {}, sizes).IsOk());
  std::vector<char> isReached(sizes.size(), 0);
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    EXPECT_LE(sizes[i], given[i]);
    isReached[i] = sizes[i] == given[i];
  }
  int lowered = 0;
  for (std::size_t cell = 0; cell + 1 < cells.Offsets.size(); ++cell)
  {
    for (Id i = cells.Offsets[cell]; i < cells.Offsets[cell + 1]; ++i)
    {
      for (Id j = cells.Offsets[cell]; j < cells.Offsets[cell + 1]; ++j)
      {
        const Id a = cells.Connectivity[i];
        const Id b = cells.Connectivity[j];
        const double bound = sizes[a] + gradation * Distance(cells.Points[a], cells.Points[b]);
        EXPECT_LE(sizes[b], bound);
        lowered += !isReached[b] && sizes[b] == bound;
        isReached[b] = isReached[b] || sizes[b] == bound;
      }
    }
  }
  // The largest such sizes: each is the given one, or as large as a neighbor allows.
  EXPECT_EQ(std::count(isReached.begin(), isReached.end(), 1), 500);
  EXPECT_GT(lowered, 100);
}

TEST(SizingField, GradationOfAChainIsTheClosedForm)
{
  SizingCells cells;
  std::vector<double> sizes(101, 10.0);
  sizes[30] = 0.5;
  for (int i = 0; i <= 100; ++i)
  {
    cells.Points.push_back({ 0.25 * i, 0.0, 0.0 });
    if (i > 0)
    {
      cells.Connectivity.push_back(i - 1);
      cells.Connectivity.push_back(i);
      cells.Offsets.push_back(2 * i);
    }
  }
  ASSERT_TRUE(BoundGradation(cells, { 0.5 }, {}, sizes).IsOk());
  for (int i = 0; i <= 100; ++i)
  {
    EXPECT_NEAR(sizes[i], std::min(10.0, 0.5 + 0.5 * 0.25 * std::abs(i - 30)), 1e-13);
  }
}

TEST(SizingField, GradationIsTheSameForAnyNumberOfThreads)
{
  // The cells of a grid of 40^3 cubes, moved and graded: sizes of a layer, scattered ones, and a
  // single small one that reaches all points.
  const unsigned seed = 18;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const auto uniform = [&random] { return random() / 4294967296.0; };
  constexpr int size = 41;
  SizingCells cells;
  for (int i = 0; i < size * size * size; ++i)
  {
    cells.Points.push_back({ std::pow((i % size + 0.3 * uniform()) / size, 3.0),
      (i / size % size + 0.3 * uniform()) / size, (i / size / size + 0.3 * uniform()) / size });
  }
  for (int i = 0; i < size * size * size; ++i)
  {
    if (i % size + 1 < size && i / size % size + 1 < size && i / size / size + 1 < size)
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        cells.Connectivity.push_back(
          i + (corner & 1) + size * (corner >> 1 & 1) + size * size * (corner >> 2));
      }
      cells.Offsets.push_back(static_cast<Id>(cells.Connectivity.size()));
    }
  }
  std::vector<double> given[3];
  for (const Vec3& p : cells.Points)
  {
    given[0].push_back(1.0 / (1.0 + 200.0 / std::cosh(50.0 * (p.Y - 0.5))));
    given[1].push_back(std::pow(10.0, -4.0 + 5.0 * uniform()));
    given[2].push_back(1e3);
  }
  given[2][size / 2] = 1e-6;
  for (const std::vector<double>& sizes : given)
  {
    std::vector<double> one = sizes;
    ASSERT_TRUE(BoundGradation(cells, { 0.3 }, ExecutionContext(1), one).IsOk());
    EXPECT_TRUE(one != sizes);
    // A field that is bounded stays as it is.
    std::vector<double> again = one;
    ASSERT_TRUE(BoundGradation(cells, { 0.3 }, ExecutionContext(2), again).IsOk());
    EXPECT_TRUE(one == again);
    for (const int threads : { 2, 3, 8 })
    {
      std::vector<double> other = sizes;
      ASSERT_TRUE(BoundGradation(cells, { 0.3 }, ExecutionContext(threads), other).IsOk());
      EXPECT_TRUE(one == other) << threads;
    }
  }
  // All points at one place, and no sizes at all.
  SizingCells heap = cells;
  heap.Points.assign(heap.Points.size(), Vec3());
  std::vector<double> sizes = given[1];
  ASSERT_TRUE(BoundGradation(heap, {}, {}, sizes).IsOk());
  const double smallest = *std::min_element(given[1].begin(), given[1].end());
  EXPECT_EQ(
    std::count(sizes.begin(), sizes.end(), smallest), static_cast<std::ptrdiff_t>(sizes.size()));
  sizes.clear();
  EXPECT_TRUE(BoundGradation({}, {}, {}, sizes).IsOk());
  const ExecutionContext aborting({}, [] { return true; });
  EXPECT_TRUE(BoundGradation(cells, {}, aborting, given[0]).IsAborted());
}
