// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TestGridBlock.cxx
 * @brief Blocks of grids are found, and make the tetrahedra that inserting their points makes.
 */
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Delaunay/GridBlock.h"
#include "Core/Search/SpatialSort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace
{
using namespace cdm;
using PointSet = std::vector<Vec3>;

/** Distinct points in the order of the curve, and numbers for them in any order. */
struct SortedPoints
{
  RawVector<Vec3> Points;
  std::vector<Id> Numbers;

  SortedPoints(const PointSet& points, std::mt19937_64& generator)
  {
    std::vector<Id> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    SortAlongHilbertCurve(points, order);
    for (Id point : order)
    {
      if (this->Points.empty() || this->Points.back() != points[point])
      {
        this->Points.push_back(points[point]);
      }
    }
    this->Numbers.resize(this->Points.size());
    std::iota(this->Numbers.begin(), this->Numbers.end(), 0);
    for (std::size_t i = this->Numbers.size(); i > 1; --i)
    {
      std::swap(this->Numbers[i - 1], this->Numbers[generator() % i]);
    }
  }
};

double GetUniform(std::mt19937_64& generator)
{
  return std::ldexp(static_cast<double>(generator() >> 11), -53);
}

/** Ascending values, evenly spaced (in units of 1 or 0.1) or not. */
std::vector<double> MakeLines(int count, int kind, std::mt19937_64& generator)
{
  std::vector<double> lines;
  for (int i = 0; i < count; ++i)
  {
    lines.push_back(kind == 0 ? i : kind == 1 ? 0.1 * i : i + 0.9 * GetUniform(generator));
  }
  return lines;
}

PointSet MakeGrid(const std::array<std::vector<double>, 3>& lines)
{
  PointSet points;
  for (double z : lines[2])
  {
    for (double y : lines[1])
    {
      for (double x : lines[0])
      {
        points.push_back({ x, y, z });
      }
    }
  }
  return points;
}

/** Sorted vertices of each tetrahedron, those at infinity included; checks the neighbors. */
std::set<TetrahedronIds> GetTetrahedra(const DelaunayTetrahedralization& mesh)
{
  std::set<TetrahedronIds> result;
  for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
  {
    TetrahedronIds ids = mesh.Tetrahedra[t];
    if (ids[0] == NoId)
    {
      continue;
    }
    for (int i = 0; i < 4; ++i)
    {
      // Neighbors know each other and have the other three vertices in common.
      const Id facet = mesh.Neighbors[t][i];
      EXPECT_EQ(mesh.Neighbors[facet / 4][facet % 4], static_cast<Id>(4 * t + i));
      TetrahedronIds other = mesh.Tetrahedra[facet / 4];
      other[facet % 4] = ids[i];
      std::sort(other.begin(), other.end());
      TetrahedronIds own = ids;
      std::sort(own.begin(), own.end());
      EXPECT_EQ(own, other);
    }
    std::sort(ids.begin(), ids.end());
    EXPECT_TRUE(result.insert(ids).second);
  }
  return result;
}

void ExpectSameTetrahedra(const SortedPoints& sorted, const GridBlock& block, int numberOfThreads)
{
  DelaunayTetrahedralization expected;
  ASSERT_TRUE(
    BuildDelaunayTetrahedralization(sorted.Points, sorted.Numbers, {}, 1, {}, expected).IsOk());
  DelaunayTetrahedralization mesh;
  ASSERT_TRUE(
    BuildDelaunayTetrahedralization(sorted.Points, sorted.Numbers, block, numberOfThreads, {}, mesh)
      .IsOk());
  EXPECT_EQ(GetTetrahedra(mesh), GetTetrahedra(expected));
  EXPECT_TRUE(mesh.HasCosphericalPoints);
}

TEST(GridBlock, FindsCompleteGrids)
{
  std::mt19937_64 generator(3);
  for (int kind = 0; kind < 3; ++kind)
  {
    const SortedPoints sorted(MakeGrid({ MakeLines(2, kind, generator),
                                MakeLines(9, kind, generator), MakeLines(5, kind, generator) }),
      generator);
    const GridBlock block = FindGridBlock(sorted.Points);
    EXPECT_EQ(block.Sizes, (std::array<Id, 3>{ 2, 9, 5 }));
    ASSERT_EQ(block.Points.size(), sorted.Points.size());
    for (std::size_t i = 0; i < block.Points.size(); ++i)
    {
      const Vec3& p = sorted.Points[block.Points[i]];
      EXPECT_EQ(p.X, sorted.Points[block.Points[i % 2]].X);
      EXPECT_EQ(p.Y, sorted.Points[block.Points[i / 2 % 9 * 2]].Y);
      EXPECT_EQ(p.Z, sorted.Points[block.Points[i / 18 * 18]].Z);
    }
    // Six tetrahedra in each box, two at infinity beyond each face of the hull.
    EXPECT_EQ(GetNumberOfTetrahedra(block), 6u * 1 * 8 * 4 + 4u * (8 + 32 + 4));
    ExpectSameTetrahedra(sorted, block, 1);
    ExpectSameTetrahedra(sorted, block, 3);
  }
}

TEST(GridBlock, LeavesOutWhatIsNoBlock)
{
  std::mt19937_64 generator(4);
  PointSet points = MakeGrid(
    { MakeLines(12, 1, generator), MakeLines(12, 1, generator), MakeLines(12, 1, generator) });
  for (int i = 0; i < 400; ++i)
  {
    points.push_back({ GetUniform(generator), GetUniform(generator), GetUniform(generator) });
  }
  // A corner of 4 x 4 x 4 is missing, and a plane holds some points besides the grid.
  points.erase(std::remove_if(points.begin(), points.end(),
                 [](const Vec3& p) { return p.X < 0.35 && p.Y < 0.35 && p.Z < 0.35; }),
    points.end());
  for (int i = 0; i < 10; ++i)
  {
    points.push_back({ 0.55, 0.1 * i, 0.3 });
  }
  const SortedPoints sorted(points, generator);
  const GridBlock block = FindGridBlock(sorted.Points);
  std::array<Id, 3> sizes = block.Sizes;
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::array<Id, 3>{ 8, 12, 12 }));
  ExpectSameTetrahedra(sorted, block, 1);
}

TEST(GridBlock, FindsNothing)
{
  std::mt19937_64 generator(5);
  RawVector<Vec3> random;
  PointSet rotated;
  RawVector<Vec3> line;
  RawVector<Vec3> plane;
  for (int i = 0; i < 1000; ++i)
  {
    random.push_back({ GetUniform(generator), GetUniform(generator), GetUniform(generator) });
    const Vec3 p{ double(i % 10), double(i / 10 % 10), double(i / 100) };
    rotated.push_back({ 0.6 * p.X - 0.8 * p.Y, 0.8 * p.X + 0.6 * p.Y + 0.001 * p.Z, p.Z });
    line.push_back({ double(i), 2.0, 3.0 });
    plane.push_back({ double(i % 10), double(i / 10), 3.0 });
  }
  EXPECT_TRUE(FindGridBlock({}).IsEmpty());
  EXPECT_TRUE(FindGridBlock(random).IsEmpty());
  EXPECT_TRUE(FindGridBlock(line).IsEmpty());
  EXPECT_TRUE(FindGridBlock(plane).IsEmpty());
  const SortedPoints sorted(rotated, generator);
  EXPECT_TRUE(FindGridBlock(sorted.Points).IsEmpty());
}

TEST(GridBlock, MakesTheTetrahedraOfInsertion)
{
  const char* const given = std::getenv("CDM_SEED");
  const std::uint64_t seed = given != nullptr ? std::strtoull(given, nullptr, 10) : 20261122u;
  std::printf("CDM_SEED=%llu\n", static_cast<unsigned long long>(seed));
  std::mt19937_64 generator(seed);
  int numberOfBlocks = 0;
  for (int round = 0; round < 300; ++round)
  {
    SCOPED_TRACE(round);
    std::array<std::vector<double>, 3> lines;
    const int kind = static_cast<int>(generator() % 3);
    for (std::vector<double>& axis : lines)
    {
      axis = MakeLines(2 + static_cast<int>(generator() % 6), kind, generator);
    }
    PointSet points;
    const double missing = generator() % 2 == 0 ? 0.0 : 0.1 * GetUniform(generator);
    for (const Vec3& p : MakeGrid(lines))
    {
      if (GetUniform(generator) >= missing)
      {
        points.push_back(p);
      }
    }
    // Others: anywhere, on faces and lines of the grid, in the middle of boxes, on its hull.
    const auto getCoordinate = [&](int axis)
    {
      const std::vector<double>& values = lines[axis];
      const std::size_t i = generator() % values.size();
      switch (generator() % 4)
      {
        case 0:
          return values[i];
        case 1:
          return 0.5 * (values[i] + values[(i + 1) % values.size()]);
        case 2:
          return values.back() * GetUniform(generator);
        default:
          return values.back() * (2.0 * GetUniform(generator) - 0.5);
      }
    };
    for (int i = static_cast<int>(generator() % 4) * static_cast<int>(generator() % 40); i > 0; --i)
    {
      points.push_back({ getCoordinate(0), getCoordinate(1), getCoordinate(2) });
    }
    const double scale = generator() % 4 == 0 ? 1e-11 : 1.0;
    const double shift = generator() % 4 == 0 ? 1000.0 : 0.0;
    for (Vec3& p : points)
    {
      p = { scale * (p.X + shift), scale * (p.Y - shift), scale * p.Z };
    }
    const SortedPoints sorted(points, generator);
    const GridBlock block = FindGridBlock(sorted.Points);
    if (!block.IsEmpty())
    {
      ++numberOfBlocks;
      ExpectSameTetrahedra(sorted, block, 1 + round % 3);
      if (::testing::Test::HasFailure())
      {
        return;
      }
    }
  }
  EXPECT_GT(numberOfBlocks, 200);
}

TEST(GridBlock, Aborts)
{
  std::mt19937_64 generator(6);
  const SortedPoints sorted(MakeGrid({ MakeLines(20, 0, generator), MakeLines(20, 0, generator),
                              MakeLines(20, 0, generator) }),
    generator);
  int calls = 0;
  const ExecutionContext context({}, [&calls]() { return ++calls == 3; });
  DelaunayTetrahedralization mesh;
  EXPECT_TRUE(BuildDelaunayTetrahedralization(
    sorted.Points, sorted.Numbers, FindGridBlock(sorted.Points), 1, context, mesh)
                .IsAborted());
  EXPECT_TRUE(mesh.Tetrahedra.empty());
}
} // namespace
