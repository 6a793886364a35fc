// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/SurfaceOrientation.h"
#include "Core/Meshes/SurfacePolygons.h"
#include "Core/Meshes/SurfaceSides.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Search/BoxTree.h"
#include "Core/Voxels/MaterialInterfaces.h"
#include "EnclosedVolumes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>

using namespace cdm;

namespace
{
LabelledGrid MakeGrid(int nx, int ny, int nz, const std::function<Id(int, int, int)>& getRegion)
{
  LabelledGrid grid;
  const int size[3] = { nx, ny, nz };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int i = 0; i <= size[axis]; ++i)
    {
      grid.Coordinates[axis].push_back(i);
    }
  }
  for (int k = 0; k < nz; ++k)
  {
    for (int j = 0; j < ny; ++j)
    {
      for (int i = 0; i < nx; ++i)
      {
        grid.Regions.push_back(getRegion(i, j, k));
      }
    }
  }
  return grid;
}

LabelledGrid MakeBall(int size, double radius)
{
  return MakeGrid(size, size, size,
    [&](int i, int j, int k)
    {
      const Vec3 center{ 0.5 * size, 0.5 * size, 0.5 * size };
      return Distance({ i + 0.5, j + 0.5, k + 0.5 }, center) < radius ? 1 : 0;
    });
}

MaterialInterfacesOptions MakeOptions(double smoothingLength, bool reduce, double deviation)
{
  MaterialInterfacesOptions options;
  options.SmoothingLength = smoothingLength;
  options.Reduce = reduce;
  options.MaximumDeviation = deviation;
  return options;
}

TriangleMesh Extract(const LabelledGrid& grid, const MaterialInterfacesOptions& options,
  MaterialInterfacesReport* report = nullptr)
{
  TriangleMesh surface;
  MaterialInterfacesReport unused;
  const Status status =
    ExtractMaterialInterfaces(grid, options, {}, surface, report ? *report : unused);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return surface;
}

/** Six times the number of cells of each region. */
std::map<Id, double> CountCells(const LabelledGrid& grid)
{
  std::map<Id, double> counts;
  for (const Id region : grid.Regions)
  {
    counts[region] += 6.0;
  }
  counts.erase(OutsideRegion);
  return counts;
}

/** Around each region as many triangles run along an edge as against it. */
void ExpectWatertight(const TriangleMesh& surface)
{
  std::map<std::pair<Id, EdgeIds>, int> balance;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    const RegionPair& labels = surface.Labels[t];
    ASSERT_NE(labels.Front, labels.Back);
    for (int i = 0; i < 3; ++i)
    {
      const Id a = ids[i];
      const Id b = ids[(i + 1) % 3];
      const EdgeIds edge{ std::min(a, b), std::max(a, b) };
      balance[{ labels.Back, edge }] += a < b ? 1 : -1;
      balance[{ labels.Front, edge }] -= a < b ? 1 : -1;
    }
  }
  for (const auto& [key, sum] : balance)
  {
    ASSERT_EQ(sum, 0) << "region " << key.first << ", edge " << key.second[0] << " "
                      << key.second[1];
  }
}

/** Sides that look into the same space have the same region; nothing intersects. */
void ExpectSound(const TriangleMesh& surface)
{
  ExpectWatertight(surface);
  std::vector<TrianglePair> pairs;
  EXPECT_TRUE(FindIntersectingPairs(surface.Points, surface.Triangles, {}, {}, pairs));
  EXPECT_TRUE(pairs.empty()) << pairs.size() << " intersections";
  const SurfaceSides sides = FindSurfaceSides(surface);
  EXPECT_TRUE(sides.OpenTriangles.empty());
  std::map<Id, Id> regions;
  for (std::size_t side = 0; side < sides.Shells.size(); ++side)
  {
    const RegionPair& labels = surface.Labels[side / 2];
    const Id region = side % 2 == 0 ? labels.Front : labels.Back;
    ASSERT_EQ(regions.emplace(sides.Shells[side], region).first->second, region) << "side " << side;
  }
  TriangleMesh copy = surface;
  EXPECT_TRUE(RepairOrientation(copy).empty());
  std::set<Vec3> places(surface.Points.begin(), surface.Points.end());
  EXPECT_EQ(places.size(), surface.Points.size());
}

/** Stage 0 takes the surface as it is: same points, same triangles. */
void ExpectTriangulatorTakes(const TriangleMesh& surface)
{
  const PolygonSoup soup = MakePolygonSoup(surface);
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  EXPECT_TRUE(output.Problems.empty());
  EXPECT_EQ(output.Surface.Points.size(), surface.Points.size());
  EXPECT_EQ(output.Surface.Triangles.size(), surface.Triangles.size());
}

/** Largest distance from a surface of points spread over the triangles of another one. */
double GetLargestDistance(const TriangleMesh& from, const TriangleMesh& to, double reach)
{
  std::vector<Box> boxes(to.Triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
  {
    for (const Id id : to.Triangles[t])
    {
      boxes[t].Add(to.Points[id]);
    }
  }
  const BoxTree tree(boxes);
  const Vec3 margin{ reach, reach, reach };
  double largest = 0.0;
  for (const TriangleIds& ids : from.Triangles)
  {
    const Vec3& a = from.Points[ids[0]];
    const Vec3& b = from.Points[ids[1]];
    const Vec3& c = from.Points[ids[2]];
    const double longest = std::max({ Distance(a, b), Distance(b, c), Distance(c, a) });
    const int n = std::max(2, static_cast<int>(std::ceil(longest / 0.3)));
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; i + j <= n; ++j)
      {
        const Vec3 p = a + (double(i) / n) * (b - a) + (double(j) / n) * (c - a);
        double nearest = reach;
        tree.VisitOverlaps({ p - margin, p + margin },
          [&](Id t)
          {
            const TriangleIds& other = to.Triangles[t];
            nearest = std::min(nearest,
              GetDistanceToTriangle(
                p, to.Points[other[0]], to.Points[other[1]], to.Points[other[2]]));
          });
        largest = std::max(largest, nearest);
      }
    }
  }
  return largest;
}

/** Random regions; of some grids cells are outside. */
LabelledGrid MakeRandomGrid(std::mt19937_64& generator)
{
  const auto pick = [&](int low, int high)
  { return std::uniform_int_distribution<int>(low, high)(generator); };
  const int labels = pick(2, 5);
  const int first = pick(0, 1) - 1;
  const int nx = pick(2, 6);
  const int ny = pick(2, 6);
  const int nz = pick(2, 6);
  LabelledGrid grid =
    MakeGrid(nx, ny, nz, [&](int, int, int) { return first + pick(0, labels - 1); });
  // At least one cell is not outside.
  grid.Regions.front() = 0;
  return grid;
}

std::mt19937_64 MakeGenerator()
{
  const auto seed = std::random_device{}();
  std::cout << "seed " << seed << "\n";
  testing::Test::RecordProperty("seed", std::to_string(seed));
  return std::mt19937_64(seed);
}
} // namespace

TEST(MaterialInterfaces, OneCellIsACube)
{
  const LabelledGrid grid = MakeGrid(1, 1, 1, [](int, int, int) { return 3; });
  for (const double length : { 0.0, 15.0 })
  {
    for (const bool reduce : { false, true })
    {
      MaterialInterfacesReport report;
      const TriangleMesh surface = Extract(grid, MakeOptions(length, reduce, 0.25), &report);
      EXPECT_EQ(surface.Points.size(), 8u);
      EXPECT_EQ(surface.Triangles.size(), 12u);
      EXPECT_EQ(report.Faces, 6);
      EXPECT_EQ(testing_core::GetEnclosedSixVolumes(surface), CountCells(grid));
      ExpectSound(surface);
    }
  }
}

TEST(MaterialInterfaces, RandomGridsHaveTheirExactVolumes)
{
  std::mt19937_64 generator = MakeGenerator();
  for (int round = 0; round < 300; ++round)
  {
    SCOPED_TRACE(round);
    const LabelledGrid grid = MakeRandomGrid(generator);
    for (const bool reduce : { false, true })
    {
      const TriangleMesh surface = Extract(grid, MakeOptions(0, reduce, 0.0));
      ExpectSound(surface);
      EXPECT_EQ(testing_core::GetEnclosedSixVolumes(surface), CountCells(grid));
      ExpectTriangulatorTakes(surface);
      if (testing::Test::HasFailure())
      {
        return;
      }
    }
  }
}

TEST(MaterialInterfaces, RandomGridsStaySoundWhenSmoothedAndReduced)
{
  std::mt19937_64 generator = MakeGenerator();
  for (int round = 0; round < 40; ++round)
  {
    SCOPED_TRACE(round);
    const LabelledGrid grid = MakeRandomGrid(generator);
    const TriangleMesh smooth = Extract(grid, MakeOptions(10, false, 0.0));
    ExpectSound(smooth);
    ExpectTriangulatorTakes(smooth);
    for (const double deviation : { 0.0, 0.1, 0.5, 3.0 })
    {
      MaterialInterfacesReport report;
      const TriangleMesh surface = Extract(grid, MakeOptions(10, true, deviation), &report);
      ExpectSound(surface);
      EXPECT_EQ(testing_core::GetEnclosedSixVolumes(surface).size(), CountCells(grid).size());
      EXPECT_LE(report.LargestDeviation, deviation);
      const double bound = report.LargestDeviation + 1e-12;
      EXPECT_LE(GetLargestDistance(surface, smooth, bound + 0.1), bound);
      EXPECT_LE(GetLargestDistance(smooth, surface, bound + 0.1), bound);
      ExpectTriangulatorTakes(surface);
      if (testing::Test::HasFailure())
      {
        return;
      }
    }
  }
}

TEST(MaterialInterfaces, PointsGoBackWhereTrianglesWouldIntersect)
{
  // Found among random grids of very different cells: with equal cells it is hard to come by.
  LabelledGrid grid = MakeGrid(
    2, 3, 3, [](int i, int j, int k) { return "002000111220202220"[i + 2 * j + 6 * k] - '0'; });
  grid.Coordinates = { std::vector<double>{ 0.0, 0.2, 6.4 }, { 0.0, 8.2, 9.4, 11.6 },
    { 0.0, 6.2, 13.4, 13.6 } };
  MaterialInterfacesReport report;
  const TriangleMesh surface = Extract(grid, MakeOptions(10, false, 0.0), &report);
  EXPECT_GT(report.HeldPoints, 0);
  ExpectSound(surface);
}

TEST(MaterialInterfaces, ThinLayersKeepHalfOfTheirThickness)
{
  // A layer of one cell over a wavy ground, and a wire of one cell across.
  const LabelledGrid grid = MakeGrid(24, 12, 14,
    [](int i, int j, int k)
    {
      const int height = 5 + static_cast<int>(std::floor(2.0 * std::sin(0.4 * i)));
      return k == 11 && j == 6 ? 3 : k < height ? 0 : k == height ? 1 : 2;
    });
  const TriangleMesh surface = Extract(grid, MakeOptions(10, false, 0.0));
  ExpectSound(surface);
  const std::map<Id, double> volumes = testing_core::GetEnclosedSixVolumes(surface);
  EXPECT_GE(volumes.at(1), 0.5 * CountCells(grid).at(1));
  EXPECT_GE(volumes.at(3), 0.25 * CountCells(grid).at(3));
}

TEST(MaterialInterfaces, TheSameInputMakesTheSameSurface)
{
  std::mt19937_64 generator = MakeGenerator();
  for (int round = 0; round < 10; ++round)
  {
    const LabelledGrid grid = MakeRandomGrid(generator);
    const TriangleMesh first = Extract(grid, {});
    const TriangleMesh second = Extract(grid, {});
    EXPECT_EQ(first.Points, second.Points);
    EXPECT_EQ(first.Triangles, second.Triangles);
    EXPECT_EQ(first.Labels, second.Labels);
  }
}

TEST(MaterialInterfaces, SaysWhatIsWrongWithTheGrid)
{
  const auto expect = [](const LabelledGrid& grid, const std::string& part,
                        StatusCode code = StatusCode::InvalidInput)
  {
    TriangleMesh surface;
    MaterialInterfacesReport report;
    const Status status = ExtractMaterialInterfaces(grid, {}, {}, surface, report);
    EXPECT_EQ(status.Code, code);
    EXPECT_NE(status.Message.find(part), std::string::npos) << status.Message;
    EXPECT_TRUE(surface.Triangles.empty());
    return status;
  };
  const LabelledGrid good = MakeGrid(2, 2, 2, [](int, int, int) { return 0; });
  LabelledGrid grid = good;
  grid.Coordinates[1][1] = 2.0;
  EXPECT_FALSE(expect(grid, "along y are not finite and ascending (number 2)").IsOk());
  grid.Coordinates[1][1] = std::nan("");
  EXPECT_FALSE(expect(grid, "number 1").IsOk());
  grid = good;
  grid.Regions.pop_back();
  EXPECT_FALSE(expect(grid, "8 cells, but 7 labels").IsOk());
  grid = good;
  grid.Regions[5] = -3;
  EXPECT_EQ(expect(grid, "Labels below -1").Cells, (std::vector<Id>{ 5 }));
  grid.Regions.assign(8, OutsideRegion);
  EXPECT_FALSE(expect(grid, "All cells are outside").IsOk());
  grid.Coordinates[2].resize(1);
  EXPECT_FALSE(expect(grid, "no cells along z").IsOk());
  grid.Coordinates[2].clear();
  for (int i = 0; i < 2000; ++i)
  {
    grid.Coordinates[2].push_back(i);
  }
  grid.Coordinates[0] = grid.Coordinates[1] = grid.Coordinates[2];
  EXPECT_FALSE(expect(grid, "2^31 - 1 corners", StatusCode::LimitReached).IsOk());
}

TEST(MaterialInterfaces, TheBorderOfTheGridStaysPlane)
{
  const LabelledGrid grid = MakeGrid(20, 16, 12,
    [](int i, int j, int k) { return k > 3 + i / 4 + j / 5 ? OutsideRegion
                                : k < 2                    ? 0
                                                           : 1; });
  for (const bool reduce : { false, true })
  {
    const TriangleMesh surface = Extract(grid, MakeOptions(10, reduce, 0.3));
    ExpectSound(surface);
    // The area of each side of a grid is that of the cells at it, but for what smoothing shifts.
    double bottom = 0.0;
    std::set<Vec3> corners;
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      const TriangleIds& ids = surface.Triangles[t];
      const Vec3& a = surface.Points[ids[0]];
      const Vec3& b = surface.Points[ids[1]];
      const Vec3& c = surface.Points[ids[2]];
      bottom += a.Z == 0.0 && b.Z == 0.0 && c.Z == 0.0 ? Norm(Cross(b - a, c - a)) : 0.0;
    }
    EXPECT_NEAR(bottom, 2.0 * 20.0 * 16.0, 1e-9);
    Box bounds;
    for (const Vec3& p : surface.Points)
    {
      bounds.Add(p);
      const int planes = (p.X == 0.0 || p.X == 20.0) + (p.Y == 0.0 || p.Y == 16.0);
      if (planes == 2)
      {
        corners.insert({ p.X, p.Y, 0.0 });
      }
    }
    EXPECT_EQ(corners.size(), 4u);
    EXPECT_EQ(bounds.Low, Vec3{});
    EXPECT_EQ(bounds.High.X, 20.0);
    EXPECT_EQ(bounds.High.Y, 16.0);
    // The interface at z = 2 is flat and stays so.
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      if (surface.Labels[t] == RegionPair{ 0, 1 })
      {
        for (const Id id : surface.Triangles[t])
        {
          EXPECT_EQ(surface.Points[id].Z, 2.0);
        }
      }
    }
  }
}

TEST(MaterialInterfaces, SlopesLoseTheirStairs)
{
  // A plane of slope 1 / 4: all points of the slope, but those near its ends, come to lie on it.
  const LabelledGrid grid =
    MakeGrid(48, 8, 20, [](int i, int, int k) { return k + 0.5 < 4.0 + 0.25 * (i + 0.5); });
  const TriangleMesh surface = Extract(grid, MakeOptions(10, false, 0.0));
  double largest = 0.0;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    for (const Id id : surface.Triangles[t])
    {
      const Vec3& p = surface.Points[id];
      if (surface.Labels[t] == RegionPair{ 0, 1 } && p.X > 12.0 && p.X < 36.0)
      {
        largest = std::max(largest, std::abs(p.Z - (4.0 + 0.25 * p.X)));
      }
    }
  }
  // Of half a cell before.
  EXPECT_LT(largest, 0.05);
}

TEST(MaterialInterfaces, ABallIsRound)
{
  const double radius = 12.0;
  const LabelledGrid grid = MakeBall(28, radius);
  const TriangleMesh stairs = Extract(grid, MakeOptions(0, false, 0.0));
  const TriangleMesh smooth = Extract(grid, MakeOptions(10, false, 0.0));
  const auto getRoughness = [&](const TriangleMesh& surface)
  {
    double sum = 0.0;
    std::size_t count = 0;
    for (const Vec3& p : surface.Points)
    {
      const double height = Distance(p, { 14.0, 14.0, 14.0 }) - radius;
      if (std::abs(height) < 2.0)
      {
        sum += height * height;
        ++count;
      }
    }
    return std::sqrt(sum / count);
  };
  EXPECT_LT(getRoughness(smooth), 0.2 * getRoughness(stairs));
  EXPECT_NEAR(testing_core::GetEnclosedSixVolumes(smooth).at(1), CountCells(grid).at(1),
    0.01 * CountCells(grid).at(1));
  for (const double deviation : { 0.1, 0.25 })
  {
    MaterialInterfacesReport report;
    const TriangleMesh reduced = Extract(grid, MakeOptions(10, true, deviation), &report);
    ExpectSound(reduced);
    // Triangles of that deviation from a sphere have edges of sqrt(8 radius deviation) at most;
    // here the bound adds up what many merges may have done, so that a part of it is used only.
    EXPECT_LT(reduced.Triangles.size(), 12u + (smooth.Triangles.size() - 9408u) / 2u);
    EXPECT_LE(report.LargestDeviation, deviation);
    EXPECT_LE(GetLargestDistance(smooth, reduced, 1.0), report.LargestDeviation);
    EXPECT_LE(GetLargestDistance(reduced, smooth, 1.0), report.LargestDeviation);
  }
}
