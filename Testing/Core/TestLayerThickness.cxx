// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/LayerThickness.h"
#include "Core/Surface/StructuralEdges.h"
#include "LayerSurfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace cdm;

namespace
{
std::vector<Id> FindFacets(const TriangleMesh& surface)
{
  StructuralEdgesOutput edges;
  EXPECT_TRUE(ExtractStructuralEdges(surface, {}, {}, edges).IsOk());
  return NumberFacets(SortEdgeUses(surface.Triangles, surface.Points.size()), edges.Edges);
}

/** Of the thinnest layer there; the limit without one. */
double FindThickness(
  const TriangleMesh& surface, const Vec3& position, double limit, double aspectRatio = 0.0)
{
  double least = limit;
  for (const LayerThickness::Layer& layer :
    LayerThickness(surface, FindFacets(surface), aspectRatio).Find(position, limit))
  {
    least = std::min(least, layer.Thickness);
  }
  return least;
}
} // namespace

TEST(LayerThickness, OfBoxesAllThreeSides)
{
  const double sides[3] = { 4.0, 3.0, 1.0 };
  const Vec3 axes[3] = { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } };
  const TriangleMesh box = MakeBoxSurface({ sides[0], sides[1], sides[2] });
  const LayerThickness thickness(box, FindFacets(box), 0.0);
  constexpr std::uint64_t seed = 5;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 1000; ++i)
  {
    const Vec3 p{ sides[0] * share(generator), sides[1] * share(generator),
      sides[2] * share(generator) };
    // No more is looked for than matters.
    for (double limit : { 5.0, 3.5, 2.0, 0.9 })
    {
      const std::vector<LayerThickness::Layer> layers = thickness.Find(p, limit);
      for (int k = 0; k < 3; ++k)
      {
        const bool isFound = std::any_of(layers.begin(), layers.end(),
          [&](const LayerThickness::Layer& layer)
          {
            return std::abs(layer.Thickness - sides[k]) < 1e-12 &&
              std::abs(std::abs(Dot(axes[k], layer.Direction)) - 1.0) < 1e-12;
          });
        EXPECT_EQ(isFound, sides[k] < limit);
      }
    }
  }
}

TEST(LayerThickness, TetrahedraMayBeWiderThanHigh)
{
  const TriangleMesh plate = MakeBoxSurface({ 1.0, 1.0, 0.1 });
  const LayerThickness thickness(plate, FindFacets(plate), 0.0);
  const auto isTooThick = [&](double width, double height, int across)
  {
    const Vec3 a{ 0.4, 0.4, 0.02 };
    return thickness.IsTooThick(
      { a, a + Vec3{ width, 0.0, 0.0 }, a + Vec3{ 0.0, width, 0.0 }, a + Vec3{ 0.0, 0.0, height } },
      std::max(height, 1.5 * width), across);
  };
  EXPECT_FALSE(isTooThick(0.15, 0.049, 2));
  EXPECT_TRUE(isTooThick(0.15, 0.051, 2));
  EXPECT_TRUE(isTooThick(0.15, 0.049, 3));
  EXPECT_FALSE(isTooThick(0.01, 0.033, 3));
}

TEST(LayerThickness, OfTubesTheirWall)
{
  const TriangleMesh tube = MakeTubeSurface(60, 0.1);
  // The wall is as thick as its facets are far apart.
  const double wall = 0.1 * std::cos(3.14159265358979323846 / 60.0);
  EXPECT_NEAR(FindThickness(tube, { 0.93, 0.0, 3.0 }, 1.0), wall, 1e-3);
  EXPECT_NEAR(FindThickness(tube, { 0.0, -0.97, 1.0 }, 1.0), wall, 1e-3);
}

TEST(LayerThickness, ThinLayersAreNone)
{
  const TriangleMesh plate = MakeBoxSurface({ 1.0, 1.0, 0.02 });
  const Vec3 middle{ 0.4, 0.4, 0.01 };
  EXPECT_NEAR(FindThickness(plate, middle, 1.0), 0.02, 1e-15);
  EXPECT_NEAR(FindThickness(plate, middle, 1.0, 51.0), 0.02, 1e-15);
  EXPECT_EQ(FindThickness(plate, middle, 1.0, 49.0), 1.0);
}

/** Towards the edge it would be thinner and thinner. */
TEST(LayerThickness, WedgesAreNoLayers)
{
  TriangleMesh wedge;
  wedge.Points = { { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0 }, { 1.0, 0.2, 0.0 }, { 0.0, 0.0, 1.0 },
    { 1.0, 0.0, 1.0 }, { 1.0, 0.2, 1.0 } };
  wedge.Triangles = { { 0, 2, 1 }, { 3, 4, 5 } };
  wedge.Labels.assign(2, { OutsideRegion, 0 });
  AddQuadrangle(wedge, 0, 1, 4, 3);
  AddQuadrangle(wedge, 1, 2, 5, 4);
  AddQuadrangle(wedge, 2, 0, 3, 5);
  EXPECT_EQ(FindThickness(wedge, { 0.5, 0.04, 0.5 }, 0.9), 0.9);
  // Between the triangles at its ends, though.
  EXPECT_NEAR(FindThickness(wedge, { 0.5, 0.04, 0.5 }, 2.0), 1.0, 1e-12);
}
