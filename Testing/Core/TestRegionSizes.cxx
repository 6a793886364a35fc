// SPDX-License-Identifier: BSD-3-Clause
// Sizes of single regions: what they are anywhere, and that meshes keep them.
#include "ComplexKinds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Pipeline/ConformingMesher.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Sizing/RegionLocator.h"
#include "Core/Sizing/RegionSizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace cdm;

namespace
{
/** Three unit cubes in a row, regions 0, 1 and 2. */
PolygonSoup MakeRow()
{
  PolygonSoup soup;
  for (int x = 0; x <= 3; ++x)
  {
    for (const auto& [y, z] :
      { std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1) })
    {
      soup.Points.push_back({ double(x), double(y), double(z) });
    }
  }
  const auto add = [&](std::initializer_list<Id> ids, const RegionPair& labels)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), ids);
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    soup.Labels.push_back(labels);
  };
  for (Id x = 0; x <= 3; ++x)
  {
    const Id p = 4 * x;
    // The normal points along x.
    add({ p, p + 1, p + 2, p + 3 }, { x < 3 ? x : OutsideRegion, x > 0 ? x - 1 : OutsideRegion });
  }
  for (Id x = 0; x < 3; ++x)
  {
    for (Id i = 0; i < 4; ++i)
    {
      const Id a = 4 * x + i;
      const Id b = 4 * x + (i + 1) % 4;
      add({ a, a + 4, b + 4, b }, { x, OutsideRegion });
    }
  }
  return soup;
}

TriangleMesh Triangulate(const PolygonSoup& soup)
{
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output.Surface;
}

/** The longest edge of the tetrahedra of each region. */
std::vector<double> GetLongestEdges(const TetMesh& mesh)
{
  std::vector<double> longest(3, 0.0);
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    for (int a = 0; a < 4; ++a)
    {
      for (int b = 0; b < a; ++b)
      {
        double& length = longest[mesh.Regions[i]];
        length = std::max(
          length, Distance(mesh.Points[mesh.Tetrahedra[i][a]], mesh.Points[mesh.Tetrahedra[i][b]]));
      }
    }
  }
  return longest;
}

ConformingMesherOutput Mesh(
  const PolygonSoup& soup, const ConformingMesherOptions& options, const SizingField& sizing = {})
{
  ConformingMesherInput input;
  input.Polygons = &soup;
  input.Sizing = sizing;
  ConformingMesherOutput output;
  const Status status = MeshPolygons(input, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}
} // namespace

TEST(RegionSizes, GrowWithTheDistance)
{
  const TriangleMesh surface = Triangulate(MakeRow());
  RegionSizesOptions options;
  options.Sizes = { { 0, 0.1 }, { 2, 0.25 } };
  options.Growth = 0.5;
  SizingField sizing;
  ASSERT_TRUE(LimitByRegions(surface, options, 0.4, sizing).IsOk());
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 1000; ++i)
  {
    const Vec3 p{ 3.0 * uniform(generator), uniform(generator), uniform(generator) };
    // In boxes in a row distances are along it.
    const double expected = std::min(
      { 0.4, 0.1 + 0.5 * std::max(0.0, p.X - 1.0), 0.25 + 0.5 * std::max(0.0, 2.0 - p.X) });
    EXPECT_NEAR(sizing(p).GetLargest(), expected, 1e-12) << p.X;
    EXPECT_EQ(sizing(p).GetLargest(), sizing(p).GetSmallest());
  }
  // At an interface the smaller size counts, although nobody can say on which side a position is.
  EXPECT_EQ(sizing({ 1.0, 0.3, 0.6 }).GetLargest(), 0.1);
  EXPECT_EQ(sizing({ 2.0, 0.3, 0.6 }).GetLargest(), 0.25);
}

/** Without labels the space around an enclosed component belongs to the region that it lies in. */
TEST(RegionSizes, KnowRegionsAroundComponents)
{
  PolygonSoup soup = CellComplex({ 3.0, 3.0, 3.0 }).GetSoup();
  const PolygonSoup inner = CellComplex({ 1.0, 1.0, 1.0 }).GetSoup();
  const Id first = static_cast<Id>(soup.Points.size());
  for (const Vec3& p : inner.Points)
  {
    soup.Points.push_back(p + Vec3{ 1.0, 1.0, 1.0 });
  }
  for (Id polygon = 0; polygon < inner.GetNumberOfPolygons(); ++polygon)
  {
    for (Id i = 0; i < inner.GetPolygonSize(polygon); ++i)
    {
      soup.Connectivity.push_back(first + inner.GetPolygon(polygon)[i]);
    }
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  soup.Labels.clear();
  const TriangleMesh surface = Triangulate(soup);
  RegionLocator locator(surface);
  ASSERT_TRUE(locator.Build().IsOk());
  const Id around = locator.Locate({ 0.5, 0.5, 0.5 });
  const Id inside = locator.Locate({ 1.5, 1.5, 1.5 });
  ASSERT_NE(around, inside);
  for (std::size_t i = 0; i < surface.Triangles.size(); ++i)
  {
    const RegionPair regions = locator.GetRegions(static_cast<Id>(i));
    const bool isInner = surface.Triangles[i][0] >= first;
    EXPECT_EQ(std::max(regions.Front, regions.Back), isInner ? std::max(around, inside) : around);
    EXPECT_EQ(
      std::min(regions.Front, regions.Back), isInner ? std::min(around, inside) : OutsideRegion);
  }
  RegionSizesOptions options;
  options.Sizes = { { around, 0.2 } };
  SizingField sizing;
  ASSERT_TRUE(LimitByRegions(surface, options, 1.0, sizing).IsOk());
  EXPECT_NEAR(sizing({ 1.5, 1.5, 1.5 }).GetLargest(), 0.2 + 0.3 * 0.5, 1e-12);
}

TEST(RegionSizes, LowerOtherSizes)
{
  const TriangleMesh surface = Triangulate(MakeRow());
  RegionSizesOptions options;
  options.Sizes = { { 1, 0.2 } };
  options.Growth = 1e6;
  SizingField sizing = [](const Vec3& p) { return LocalSpacing(0.05 + 0.1 * p.X); };
  ASSERT_TRUE(LimitByRegions(surface, options, 0.0, sizing).IsOk());
  EXPECT_DOUBLE_EQ(sizing({ 0.5, 0.5, 0.5 }).GetLargest(), 0.1);
  EXPECT_DOUBLE_EQ(sizing({ 1.2, 0.5, 0.5 }).GetLargest(), 0.17);
  EXPECT_DOUBLE_EQ(sizing({ 1.8, 0.5, 0.5 }).GetLargest(), 0.2);
  EXPECT_DOUBLE_EQ(sizing({ 2.5, 0.5, 0.5 }).GetLargest(), 0.3);
}

/** Of a spacing in any position only the lengths above the limit change. */
TEST(RegionSizes, LimitSpacingsInPosition)
{
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto pick = [&] {
    return Vec3{ uniform(generator), uniform(generator), uniform(generator) };
  };
  for (int round = 0; round < 200; ++round)
  {
    Vec3 directions[3];
    const Vec3 first = pick();
    const Vec3 normal = Cross(first, pick());
    directions[0] = (1.0 / Norm(first)) * first;
    directions[2] = (1.0 / Norm(normal)) * normal;
    directions[1] = Cross(directions[2], directions[0]);
    const Vec3 lengths{ 0.1, 1.0, 10.0 };
    const LocalSpacing limited = LocalSpacing(lengths, directions).GetLimited(2.0);
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_NEAR(limited.GetAlong(directions[i]), std::min(2.0, lengths[i]), 1e-9) << round;
    }
    EXPECT_NEAR(limited.GetSmallest(), 0.1, 1e-12);
    EXPECT_NEAR(limited.GetLargest(), 2.0, 1e-12);
  }
}

TEST(RegionSizes, AreKeptByMeshes)
{
  const PolygonSoup soup = MakeRow();
  for (const MeshPurpose purpose : { MeshPurpose::FiniteVolumes, MeshPurpose::FiniteElements })
  {
    ConformingMesherOptions options;
    options.MeshFor = purpose;
    options.Choices.MaximumEdgeLength = 0.5;
    const std::size_t coarse = Mesh(soup, options).Mesh.Tetrahedra.size();
    options.RegionSizes.Sizes = { { 1, 0.15 } };
    options.RegionSizes.Growth = 0.3;
    const ConformingMesherOutput slow = Mesh(soup, options);
    options.RegionSizes.Growth = 2.0;
    const ConformingMesherOutput fast = Mesh(soup, options);
    for (const ConformingMesherOutput* output : { &slow, &fast })
    {
      EXPECT_TRUE(output->Certificate.IsDelaunay()) << output->Certificate.GetText();
      const std::vector<double> longest = GetLongestEdges(output->Mesh);
      EXPECT_LE(longest[1], 0.15 * (1.0 + 1e-12));
      EXPECT_GT(longest[0], 0.25);
      EXPECT_LE(longest[0], 0.5 * (1.0 + 1e-12));
    }
    EXPECT_GT(fast.Mesh.Tetrahedra.size(), 2 * coarse);
    // Edges that grow more slowly fill more of the regions around.
    EXPECT_GT(slow.Mesh.Tetrahedra.size(), fast.Mesh.Tetrahedra.size());
  }
}

/** Also for a field that knows where it is smallest: the regions' sizes are not passed over. */
TEST(RegionSizes, AreKeptBesideASizing)
{
  const PolygonSoup soup = MakeRow();
  SizingCells cells;
  cells.Points = { { 0.0, 0.0, 0.0 }, { 9.0, 0.0, 0.0 }, { 0.0, 9.0, 0.0 }, { 0.0, 0.0, 9.0 } };
  cells.Offsets = { 0, 4 };
  cells.Connectivity = { 0, 1, 2, 3 };
  const std::vector<double> lengths(4, 0.5);
  const SizingField sizing(
    [](const Vec3&) { return LocalSpacing(0.5); }, std::make_shared<SizingMinima>(cells, lengths));
  ConformingMesherOptions options;
  options.RegionSizes.Sizes = { { 2, 0.2 } };
  const std::vector<double> longest = GetLongestEdges(Mesh(soup, options, sizing).Mesh);
  EXPECT_LE(longest[2], 0.2 * (1.0 + 1e-12));
  EXPECT_LE(longest[0], 0.5 * (1.0 + 1e-12));
  EXPECT_GT(longest[0], 0.3);
}

TEST(RegionSizes, RefuseWhatMakesNoSense)
{
  const PolygonSoup soup = MakeRow();
  ConformingMesherInput input;
  input.Polygons = &soup;
  const auto getCode = [&](const RegionSize& size, double growth)
  {
    ConformingMesherOptions options;
    options.RegionSizes.Sizes = { size };
    options.RegionSizes.Growth = growth;
    ConformingMesherOutput output;
    return MeshPolygons(input, options, {}, output).Code;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : { 0.0, -1.0, none })
  {
    EXPECT_EQ(getCode({ 0, wrong }, 0.3), StatusCode::InvalidOption);
    EXPECT_EQ(getCode({ 0, 0.5 }, wrong), StatusCode::InvalidOption);
  }
  EXPECT_EQ(getCode({ 3, 0.5 }, 0.3), StatusCode::InvalidOption);
  EXPECT_EQ(getCode({ OutsideRegion, 0.5 }, 0.3), StatusCode::InvalidOption);
}
