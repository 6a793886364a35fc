// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/MovingBoundary/SurfaceCoarsening.h"
#include "EnclosedVolumes.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

using namespace cdm;

namespace
{
/**
 * Two unit cubes on each other, regions 0 and 1, of which all squares are divided into size^2 and
 * these into two triangles.
 */
TriangleMesh MakeCubes(int size)
{
  TriangleMesh surface;
  std::map<Vec3, Id> ids;
  const auto add = [&](const Vec3& p)
  {
    const auto place = ids.emplace(p, static_cast<Id>(surface.Points.size()));
    if (place.second)
    {
      surface.Points.push_back(p);
    }
    return place.first->second;
  };
  const auto addSquare = [&](const Vec3& origin, const Vec3& u, const Vec3& v, RegionPair labels)
  {
    const double step = 1.0 / size;
    for (int i = 0; i < size; ++i)
    {
      for (int j = 0; j < size; ++j)
      {
        const auto at = [&](int k, int l)
        { return add(origin + (i + k) * step * u + (j + l) * step * v); };
        surface.Triangles.push_back({ at(0, 0), at(1, 0), at(1, 1) });
        surface.Triangles.push_back({ at(0, 0), at(1, 1), at(0, 1) });
        surface.Labels.push_back(labels);
        surface.Labels.push_back(labels);
      }
    }
  };
  const Vec3 x{ 1, 0, 0 };
  const Vec3 y{ 0, 1, 0 };
  const Vec3 z{ 0, 0, 1 };
  for (Id region = 0; region < 2; ++region)
  {
    const Vec3 low{ 0, 0, double(region) };
    const RegionPair labels{ OutsideRegion, region };
    addSquare(low, x, z, labels);
    addSquare(low + y, z, x, labels);
    addSquare(low, z, y, labels);
    addSquare(low + x, y, z, labels);
  }
  addSquare({}, y, x, { OutsideRegion, 0 });
  addSquare(z, x, y, { 1, 0 });
  addSquare(2.0 * z, x, y, { OutsideRegion, 1 });
  return surface;
}

std::set<Id> GetUsedPoints(const TriangleMesh& surface)
{
  std::set<Id> used;
  for (const TriangleIds& ids : surface.Triangles)
  {
    used.insert(ids.begin(), ids.end());
  }
  return used;
}
} // namespace

TEST(SurfaceCoarsening, LeavesTheCorners)
{
  for (const int size : { 1, 2, 3, 8 })
  {
    SCOPED_TRACE(size);
    TriangleMesh surface = MakeCubes(size);
    CoarsenSurface(std::vector<char>(surface.Points.size(), 1), 1e-9, surface);
    EXPECT_EQ(GetUsedPoints(surface).size(), 12u);
    EXPECT_EQ(surface.Triangles.size(), 22u);
    const std::map<Id, double> volumes = testing_core::GetEnclosedSixVolumes(surface);
    EXPECT_NEAR(volumes.at(0), 6.0, 1e-12);
    EXPECT_NEAR(volumes.at(1), 6.0, 1e-12);
    std::vector<TrianglePair> pairs;
    EXPECT_TRUE(FindIntersectingPairs(surface.Points, surface.Triangles, {}, {}, pairs));
    EXPECT_TRUE(pairs.empty());
  }
}

TEST(SurfaceCoarsening, KeepsPointsThatAreToStay)
{
  TriangleMesh surface = MakeCubes(4);
  std::vector<char> isRemovable(surface.Points.size(), 1);
  std::size_t corners = 12;
  for (std::size_t i = 0; i < isRemovable.size(); i += 5)
  {
    isRemovable[i] = 0;
    const Vec3& p = surface.Points[i];
    const auto isEnd = [](double c) { return c == 0.0 || c == 1.0 || c == 2.0; };
    corners += !(isEnd(p.X) && isEnd(p.Y) && isEnd(p.Z));
  }
  CoarsenSurface(isRemovable, 1e-9, surface);
  const std::set<Id> used = GetUsedPoints(surface);
  EXPECT_EQ(used.size(), corners);
  for (std::size_t i = 0; i < isRemovable.size(); i += 5)
  {
    EXPECT_EQ(used.count(static_cast<Id>(i)), 1u);
  }
  EXPECT_NEAR(testing_core::GetEnclosedSixVolumes(surface).at(1), 6.0, 1e-12);
}

TEST(SurfaceCoarsening, KeepsTheShape)
{
  // A point of a square is lifted: it and all around it shape the surface.
  TriangleMesh surface = MakeCubes(4);
  std::size_t lifted = 0;
  while (surface.Points[lifted] != Vec3{ 0.5, 0.5, 2.0 })
  {
    ++lifted;
  }
  surface.Points[lifted].Z = 2.25;
  const double volume = testing_core::GetEnclosedSixVolumes(surface).at(1);
  CoarsenSurface(std::vector<char>(surface.Points.size(), 1), 1e-9, surface);
  EXPECT_NEAR(testing_core::GetEnclosedSixVolumes(surface).at(1), volume, 1e-12);
  EXPECT_EQ(GetUsedPoints(surface).size(), 12u + 1u + 6u);
}
