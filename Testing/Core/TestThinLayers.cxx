// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/ThinLayers.h"
#include "LayerSurfaces.h"

#include <gtest/gtest.h>

using namespace cdm;

namespace
{
constexpr TetrahedronIds Across{ 0, 1, 2, 4 };

bool IsAcross(
  const TriangleMesh& surface, const TetrahedronIds& ids, Id region, double aspectRatio = 0.0)
{
  const IdLists triangles = ListTrianglesAtPoints(surface.Triangles, surface.Points.size());
  return ThinLayers(surface, triangles, aspectRatio).IsAcross(ids, region);
}

/** Whether a box of width one, with a region beside so many of its two large sides, is thin. */
bool IsThin(double thickness, int neighbors, double aspectRatio = 0.0)
{
  TriangleMesh layer = MakeBoxSurface({ 1.0, 1.0, thickness });
  for (int t = 0; t < 2 * neighbors; ++t)
  {
    layer.Labels[t].Front = 1;
  }
  return IsAcross(layer, Across, 0, aspectRatio);
}
} // namespace

TEST(ThinLayers, AHundredTimesAsWideAsThickWithTheOutsideOnBothSides)
{
  for (double thickness : { 0.001, 0.0099 })
  {
    const TriangleMesh plate = MakeBoxSurface({ 1.0, 1.0, thickness });
    EXPECT_TRUE(IsAcross(plate, Across, 0));
    EXPECT_FALSE(IsAcross(plate, Across, 1));
    // A point inside, or all points on one side.
    EXPECT_FALSE(IsAcross(plate, { 0, 1, 2, 8 }, 0));
  }
  for (const Vec3& size : { Vec3{ 1.0, 1.0, 0.0101 }, Vec3{ 1.0, 1.0, 1.0 }, Vec3{ 1.0, 2.0, 2.0 },
         Vec3{ 0.1, 0.1, 30.0 }, Vec3{ 10.0, 0.1, 0.1 } })
  {
    const TriangleMesh box = MakeBoxSurface(size);
    EXPECT_FALSE(IsAcross(box, Across, 0));
    EXPECT_FALSE(IsAcross(box, { 3, 5, 6, 7 }, 0));
  }
}

TEST(ThinLayers, TwentyTimesAsWideAsThickBesideARegion)
{
  for (int neighbors : { 1, 2 })
  {
    EXPECT_TRUE(IsThin(0.001, neighbors));
    EXPECT_TRUE(IsThin(0.049, neighbors));
    EXPECT_FALSE(IsThin(0.051, neighbors));
  }
}

TEST(ThinLayers, AsOftenAsWideAsThickAsAskedFor)
{
  for (int neighbors : { 0, 1, 2 })
  {
    EXPECT_TRUE(IsThin(0.19, neighbors, 5.0));
    EXPECT_FALSE(IsThin(0.21, neighbors, 5.0));
    EXPECT_TRUE(IsThin(0.00099, neighbors, 1000.0));
    EXPECT_FALSE(IsThin(0.00101, neighbors, 1000.0));
  }
}

TEST(ThinLayers, EachFacetIsASideOfItsOwn)
{
  // Each facet is a hundredth of the circumference wide, and twelve times the thickness.
  const TriangleMesh narrow = MakeTubeSurface(100, 0.005);
  EXPECT_FALSE(IsAcross(narrow, { 0, 2, 3, 6 }, 0));
  // Each facet of a hexagonal tube is a sixth of the circumference wide, 200 times the thickness.
  const TriangleMesh hexagonal = MakeTubeSurface(6, 0.005);
  EXPECT_TRUE(IsAcross(hexagonal, { 0, 2, 3, 6 }, 0));
  const TriangleMesh thick = MakeTubeSurface(6, 0.2);
  EXPECT_FALSE(IsAcross(thick, { 0, 2, 3, 6 }, 0));
}

TEST(ThinLayers, FacetsThatBendByLessThanADegreeAreOneSide)
{
  // The facets bend by half a degree; each is not even twice as wide as the wall is thick.
  const TriangleMesh thin = MakeTubeSurface(720, 0.005);
  EXPECT_TRUE(IsAcross(thin, { 0, 2, 3, 6 }, 0));
}
