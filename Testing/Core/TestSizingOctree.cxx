// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Sizing/SizingOctree.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace cdm;

namespace
{
TriangleMesh MakeBox(const Vec3& size)
{
  BoundaryTriangulatorOutput output;
  EXPECT_TRUE(TriangulateBoundary(CellComplex(size).GetSoup(), {}, {}, output).IsOk());
  return output.Surface;
}

/** Short at a point near one corner. */
LocalSpacing GetConeSpacing(const Vec3& p)
{
  return 0.004 + 0.8 * Distance(p, { 0.3, 0.2, 0.25 });
}

struct Tree
{
  Tree(const Vec3& size, SizingField sizing, const SizingOctreeOptions& options,
    const ExecutionContext& context = {})
    : Surface(MakeBox(size)), Locator(this->Surface), Sizing(std::move(sizing))
  {
    EXPECT_TRUE(this->Locator.Build().IsOk());
    this->Result = this->Octree.Build(this->Locator, this->Sizing, options, context);
  }

  /** The largest difference of levels of leaves that touch. */
  int GetLargestLevelDifference() const
  {
    int largest = 0;
    const std::vector<SizingOctree::Leaf>& leaves = this->Octree.GetLeaves();
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        bool touch = true;
        for (int axis = 0; axis < 3; ++axis)
        {
          touch = touch && leaves[i].Low[axis] <= leaves[j].Low[axis] + leaves[j].Size[axis] &&
            leaves[j].Low[axis] <= leaves[i].Low[axis] + leaves[i].Size[axis];
        }
        for (int axis = 0; axis < 3 && touch; ++axis)
        {
          largest = std::max(largest,
            std::abs(
              this->Octree.GetLevels(leaves[i])[axis] - this->Octree.GetLevels(leaves[j])[axis]));
        }
      }
    }
    return largest;
  }

  double GetVolume() const
  {
    double volume = 0.0;
    for (const SizingOctree::Leaf& leaf : this->Octree.GetLeaves())
    {
      const Vec3 edges = this->Octree.GetEdges(leaf);
      volume += edges.X * edges.Y * edges.Z;
    }
    return volume;
  }

  TriangleMesh Surface;
  RegionLocator Locator;
  SizingField Sizing;
  SizingOctree Octree;
  Status Result;
};
} // namespace

TEST(SizingOctree, BoundsTheIrregularity)
{
  SizingOctreeOptions options;
  options.MaximumLevelDifference = 0;
  const Tree free({ 1.0, 1.0, 1.0 }, GetConeSpacing, options);
  ASSERT_TRUE(free.Result.IsOk());
  EXPECT_GT(free.GetLargestLevelDifference(), 1);
  std::size_t last = free.Octree.GetLeaves().size();
  for (int difference : { 2, 1 })
  {
    options.MaximumLevelDifference = difference;
    const Tree bounded({ 1.0, 1.0, 1.0 }, GetConeSpacing, options);
    ASSERT_TRUE(bounded.Result.IsOk());
    EXPECT_LE(bounded.GetLargestLevelDifference(), difference);
    EXPECT_GE(bounded.Octree.GetLeaves().size(), last);
    EXPECT_NEAR(bounded.GetVolume(), 1.0, 1e-12);
    last = bounded.Octree.GetLeaves().size();
  }
}

TEST(SizingOctree, LeavesAreAsLargeAsTheSpacing)
{
  SizingOctreeOptions options;
  options.MaximumRatio = 1.25;
  options.MaximumLevelDifference = 0;
  const Tree tree({ 1.0, 1.0, 1.0 }, GetConeSpacing, options);
  ASSERT_TRUE(tree.Result.IsOk());
  for (const SizingOctree::Leaf& leaf : tree.Octree.GetLeaves())
  {
    const Vec3 edges = tree.Octree.GetEdges(leaf);
    const Vec3 low{ double(leaf.Low[0]), double(leaf.Low[1]), double(leaf.Low[2]) };
    const Vec3 position = tree.Octree.GetPosition(low);
    EXPECT_LE(edges.X, 1.25 * 4.0 / 3.0 * GetConeSpacing(position).GetLargest());
    EXPECT_LE(edges.X, 1.25 * leaf.Spacing.X);
  }
}

TEST(SizingOctree, AnisotropicSpacingMakesFlatCells)
{
  SizingOctreeOptions options;
  const Vec3 lengths{ 0.26, 0.26, 0.02 };
  const Tree tree(
    { 1.0, 1.0, 1.0 }, [&](const Vec3&) { return LocalSpacing(lengths); }, options);
  ASSERT_TRUE(tree.Result.IsOk());
  // 1/4 along x and y; along z 50 cells would do, and quarters of 13 roots fit best.
  EXPECT_EQ(tree.Octree.GetLeaves().size(), 4u * 4u * 52u);

  // Levels are bounded for each axis by itself.
  const Tree graded(
    { 1.0, 1.0, 1.0 },
    [](const Vec3& p) {
      return LocalSpacing(Vec3{ 0.25, 0.25, 0.01 + 0.9 * p.X * p.X });
    },
    options);
  ASSERT_TRUE(graded.Result.IsOk());
  EXPECT_EQ(graded.GetLargestLevelDifference(), 1);
  EXPECT_NEAR(graded.GetVolume(), 1.0, 1e-12);
}

/** Seven leaves of 0.3 fill 2.1, and none is split for a rounding error. */
TEST(SizingOctree, LeavesFillTheBox)
{
  for (int cells = 1; cells <= 60; ++cells)
  {
    const double length = 0.3 * cells;
    const Tree tree({ length, 0.3, 0.3 }, [](const Vec3&) { return 0.3; }, {});
    ASSERT_TRUE(tree.Result.IsOk());
    // Roots are halved, so that up to an eighth more are needed.
    const std::size_t count = tree.Octree.GetLeaves().size();
    EXPECT_GE(count, static_cast<std::size_t>(cells));
    EXPECT_LE(count, static_cast<std::size_t>(cells <= 15 ? cells : cells + cells / 8));
  }
}

TEST(SizingOctree, RootsAreNearlyCubic)
{
  SizingOctreeOptions options;
  const Tree tree(
    { 1.0, 0.5, 0.25 }, [](const Vec3&) { return 10.0; }, options);
  ASSERT_TRUE(tree.Result.IsOk());
  ASSERT_EQ(tree.Octree.GetLeaves().size(), 4u * 2u * 1u);
  EXPECT_EQ(tree.Octree.GetEdges(tree.Octree.GetLeaves()[0]), (Vec3{ 0.25, 0.25, 0.25 }));
}

TEST(SizingOctree, RefusesTooFineSizings)
{
  SizingOctreeOptions options;
  options.MaximumNumberOfLeaves = 1000;
  const Tree many(
    { 1.0, 1.0, 1.0 }, [](const Vec3&) { return 0.01; }, options);
  EXPECT_EQ(many.Result.Code, StatusCode::LimitReached);
  EXPECT_NE(many.Result.Message.find("1000 points"), std::string::npos);
  for (const double spacing : { 1e-12, 1e-160, 1e-300 })
  {
    const Tree tiny(
      { 1.0, 1.0, 1.0 }, [&](const Vec3&) { return spacing; }, options);
    EXPECT_EQ(tiny.Result.Code, StatusCode::LimitReached);
  }
  options.MaximumNumberOfLeaves = 1000000;
  const Tree deep(
    { 1.0, 1.0, 1.0 },
    [](const Vec3& p) {
      return 1e-8 + Distance(p, { 0.0, 0.0, 0.0 });
    },
    options);
  EXPECT_EQ(deep.Result.Code, StatusCode::LimitReached);
  EXPECT_NE(deep.Result.Message.find("1.526e-05"), std::string::npos);
}

TEST(SizingOctree, TheSameForAnyNumberOfThreads)
{
  const auto flat = [](const Vec3& p) {
    return LocalSpacing(Vec3{ 0.01 + 0.3 * p.X, 0.1 + 0.2 * p.Z, 0.02 + 0.5 * p.Y });
  };
  const auto cone = [](const Vec3& p) { return 0.3 * GetConeSpacing(p).GetSmallest(); };
  for (const SizingField& sizing : { SizingField(cone), SizingField(flat) })
  {
    const SizingOctreeOptions options;
    const Tree one({ 1.0, 1.5, 0.5 }, sizing, options);
    EXPECT_GT(one.Octree.GetLeaves().size(), 1000u);
    for (const int threads : { 2, 3, 8 })
    {
      const Tree other({ 1.0, 1.5, 0.5 }, sizing, options, ExecutionContext(threads));
      ASSERT_EQ(other.Octree.GetLeaves().size(), one.Octree.GetLeaves().size());
      for (std::size_t i = 0; i < one.Octree.GetLeaves().size(); ++i)
      {
        const SizingOctree::Leaf& a = one.Octree.GetLeaves()[i];
        const SizingOctree::Leaf& b = other.Octree.GetLeaves()[i];
        ASSERT_TRUE(
          a.Low == b.Low && a.Size == b.Size && a.Spacing == b.Spacing && a.Region == b.Region);
      }
    }
  }
}
