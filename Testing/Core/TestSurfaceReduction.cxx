// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Voxels/SurfaceReduction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

using namespace cdm;

namespace
{
using Height = std::function<double(double, double)>;

/** The ground of a box of 10 x 10 x 10, region 0, whose upper side is the graph of a function. */
class SurfaceBuilder
{
public:
  Id Add(const Vec3& p)
  {
    const auto [place, isNew] = this->Ids.emplace(p, static_cast<Id>(this->Surface.Points.size()));
    if (isNew)
    {
      this->Surface.Points.push_back(p);
    }
    return place->second;
  }

  void AddQuad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, RegionPair labels)
  {
    this->AddTriangle(a, b, c, labels);
    this->AddTriangle(a, c, d, labels);
  }

  void AddTriangle(const Vec3& a, const Vec3& b, const Vec3& c, RegionPair labels)
  {
    this->Surface.Triangles.push_back({ this->Add(a), this->Add(b), this->Add(c) });
    this->Surface.Labels.push_back(labels);
  }

  void AddGround(const Height& height)
  {
    const RegionPair labels{ OutsideRegion, 0 };
    const auto top = [&](int i, int j) { return Vec3{ double(i), double(j), height(i, j) }; };
    const auto foot = [](int i, int j) { return Vec3{ double(i), double(j), 0.0 }; };
    for (int i = 0; i < 10; ++i)
    {
      for (int j = 0; j < 10; ++j)
      {
        this->AddQuad(top(i, j), top(i + 1, j), top(i + 1, j + 1), top(i, j + 1), labels);
        this->AddQuad(foot(i, j), foot(i, j + 1), foot(i + 1, j + 1), foot(i + 1, j), labels);
      }
      this->AddQuad(foot(i, 0), foot(i + 1, 0), top(i + 1, 0), top(i, 0), labels);
      this->AddQuad(foot(i + 1, 10), foot(i, 10), top(i, 10), top(i + 1, 10), labels);
      this->AddQuad(foot(0, i + 1), foot(0, i), top(0, i), top(0, i + 1), labels);
      this->AddQuad(foot(10, i), foot(10, i + 1), top(10, i + 1), top(10, i), labels);
    }
  }

  /** A tetrahedron of region 1. */
  void AddBubble(const Vec3& p, double size, Id around)
  {
    const Vec3 x = p + Vec3{ size, 0.0, 0.0 };
    const Vec3 y = p + Vec3{ 0.0, size, 0.0 };
    const Vec3 z = p + Vec3{ 0.0, 0.0, size };
    const RegionPair labels{ around, 1 };
    this->AddTriangle(p, y, x, labels);
    this->AddTriangle(p, x, z, labels);
    this->AddTriangle(p, z, y, labels);
    this->AddTriangle(x, y, z, labels);
  }

  TriangleMesh Surface;

private:
  std::map<Vec3, Id> Ids;
};

/** Six times the volume: exact for small integers as coordinates. */
double GetSixVolumes(const TriangleMesh& surface, Id region)
{
  double volume = 0.0;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    const double part =
      Dot(surface.Points[ids[0]], Cross(surface.Points[ids[1]], surface.Points[ids[2]]));
    volume += surface.Labels[t].Back == region ? part : 0.0;
    volume -= surface.Labels[t].Front == region ? part : 0.0;
  }
  return volume;
}

SurfaceReductionReport Reduce(double deviation, TriangleMesh& surface)
{
  SurfaceReductionOptions options;
  options.MaximumDeviation = deviation;
  SurfaceReductionReport report;
  const Status status = ReduceSurface(options, {}, surface, report);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  std::vector<TrianglePair> pairs;
  EXPECT_TRUE(FindIntersectingPairs(surface.Points, surface.Triangles, {}, {}, pairs));
  EXPECT_TRUE(pairs.empty());
  return report;
}
} // namespace

TEST(SurfaceReduction, LeavesTheCornersOfABox)
{
  SurfaceBuilder builder;
  builder.AddGround([](double, double) { return 10.0; });
  const SurfaceReductionReport report = Reduce(0.0, builder.Surface);
  EXPECT_EQ(builder.Surface.Points.size(), 8u);
  EXPECT_EQ(builder.Surface.Triangles.size(), 12u);
  EXPECT_EQ(GetSixVolumes(builder.Surface, 0), 6000.0);
  EXPECT_EQ(report.LargestDeviation, 0.0);
}

TEST(SurfaceReduction, TakesTheBumpsThatTheBoundAllows)
{
  // One point of the top is lifted: with a bound below its height it stays.
  const auto bump = [](double x, double y) { return x == 5.0 && y == 5.0 ? 10.5 : 10.0; };
  SurfaceBuilder builder;
  builder.AddGround(bump);
  TriangleMesh surface = builder.Surface;
  EXPECT_LE(Reduce(0.4, surface).LargestDeviation, 0.4);
  double highest = 0.0;
  for (const Vec3& p : surface.Points)
  {
    highest = std::max(highest, p.Z);
  }
  EXPECT_EQ(highest, 10.5);
  surface = builder.Surface;
  // Merges around it may come first, and count as well.
  const SurfaceReductionReport report = Reduce(2.0, surface);
  EXPECT_EQ(surface.Points.size(), 8u);
  EXPECT_GE(report.LargestDeviation, 0.5);
  EXPECT_LE(report.LargestDeviation, 2.0);
  EXPECT_EQ(GetSixVolumes(surface, 0), 6000.0);
}

TEST(SurfaceReduction, DoesNotPassOverWhatLiesBetween)
{
  // A bubble in the bump, or above the dent, is on its side of the surface before and after.
  for (const double height : { 10.5, 9.5 })
  {
    SurfaceBuilder builder;
    builder.AddGround([&](double x, double y) { return x == 5.0 && y == 5.0 ? height : 10.0; });
    const bool isInside = height > 10.0;
    builder.AddBubble({ 5.0, 5.0, isInside ? 10.1 : 9.8 }, 0.05, isInside ? 0 : OutsideRegion);
    TriangleMesh surface = builder.Surface;
    Reduce(5.0, surface);
    bool isThere = false;
    for (const Vec3& p : surface.Points)
    {
      isThere = isThere || p == Vec3{ 5.0, 5.0, height };
    }
    EXPECT_TRUE(isThere);
    EXPECT_NEAR(GetSixVolumes(surface, 1), 0.05 * 0.05 * 0.05, 1e-12);
    // Elsewhere it is as flat as it can be.
    EXPECT_LT(surface.Points.size(), 30u);
  }
}

TEST(SurfaceReduction, KeepsWhatIsMarked)
{
  // The middle of the top is a patch of its own, in the same plane.
  SurfaceBuilder builder;
  builder.AddGround([](double, double) { return 10.0; });
  SurfaceReductionOptions options;
  for (const TriangleIds& ids : builder.Surface.Triangles)
  {
    bool isInside = true;
    for (const Id id : ids)
    {
      const Vec3& p = builder.Surface.Points[id];
      isInside = isInside && p.Z == 10.0 && std::abs(p.X - 5.0) < 2.5 && std::abs(p.Y - 5.0) < 2.5;
    }
    options.Patches.push_back(isInside);
  }
  SurfaceReductionReport report;
  const Status status = ReduceSurface(options, {}, builder.Surface, report);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  EXPECT_EQ(builder.Surface.Points.size(), 12u);
  EXPECT_EQ(GetSixVolumes(builder.Surface, 0), 6000.0);
}

TEST(SurfaceReduction, AnAbortLeavesTheSurfaceAlone)
{
  SurfaceBuilder builder;
  builder.AddGround([](double, double) { return 10.0; });
  const TriangleMesh before = builder.Surface;
  SurfaceReductionReport report;
  EXPECT_TRUE(ReduceSurface({}, ExecutionContext({}, [] { return true; }), builder.Surface, report)
                .IsAborted());
  EXPECT_EQ(builder.Surface.Triangles, before.Triangles);
  EXPECT_EQ(report.RemovedPoints, 0);
}
