// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/ThinLayers.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;

void AddQuadrangle(TriangleMesh& surface, Id a, Id b, Id c, Id d)
{
  surface.Triangles.insert(surface.Triangles.end(), { { a, b, c }, { a, c, d } });
  surface.Labels.insert(surface.Labels.end(), 2, { OutsideRegion, 0 });
}

/** Point x + 2 y + 4 z, each 0 or 1, in units of the size. */
TriangleMesh MakeBox(const Vec3& size)
{
  TriangleMesh surface;
  for (int i = 0; i < 8; ++i)
  {
    surface.Points.push_back({ (i & 1) * size.X, ((i >> 1) & 1) * size.Y, (i >> 2) * size.Z });
  }
  AddQuadrangle(surface, 0, 2, 3, 1);
  AddQuadrangle(surface, 4, 5, 7, 6);
  AddQuadrangle(surface, 0, 1, 5, 4);
  AddQuadrangle(surface, 2, 6, 7, 3);
  AddQuadrangle(surface, 0, 4, 6, 2);
  AddQuadrangle(surface, 1, 3, 7, 5);
  return surface;
}

/**
 * A tube of so many facets along the z axis: radius 1, length 6; point 4 i + 2 * isOuter + isTop.
 */
TriangleMesh MakeTube(Id count, double thickness)
{
  TriangleMesh surface;
  for (Id i = 0; i < count; ++i)
  {
    for (double radius : { 1.0 - thickness, 1.0 })
    {
      for (double z : { 0.0, 6.0 })
      {
        surface.Points.push_back(
          { radius * std::cos(2.0 * Pi * i / count), radius * std::sin(2.0 * Pi * i / count), z });
      }
    }
  }
  for (Id i = 0; i < count; ++i)
  {
    const Id a = 4 * i;
    const Id b = 4 * ((i + 1) % count);
    AddQuadrangle(surface, a + 1, b + 1, b, a);
    AddQuadrangle(surface, a + 2, b + 2, b + 3, a + 3);
    AddQuadrangle(surface, a, b, b + 2, a + 2);
    AddQuadrangle(surface, a + 1, a + 3, b + 3, b + 1);
  }
  return surface;
}

bool IsAcross(const TriangleMesh& surface, const TetrahedronIds& ids, Id region)
{
  const IdLists triangles = ListTrianglesAtPoints(surface.Triangles, surface.Points.size());
  return ThinLayers(surface, triangles).IsAcross(ids, region);
}
} // namespace

TEST(ThinLayers, TwentyTimesAsWideAsThick)
{
  const TetrahedronIds across{ 0, 1, 2, 4 };
  for (double thickness : { 0.001, 0.049 })
  {
    const TriangleMesh layer = MakeBox({ 1.0, 1.0, thickness });
    EXPECT_TRUE(IsAcross(layer, across, 0));
    EXPECT_FALSE(IsAcross(layer, across, 1));
    // A point inside, or all points on one side.
    EXPECT_FALSE(IsAcross(layer, { 0, 1, 2, 8 }, 0));
  }
  for (const Vec3& size : { Vec3{ 1.0, 1.0, 0.051 }, Vec3{ 1.0, 1.0, 1.0 }, Vec3{ 1.0, 2.0, 2.0 },
         Vec3{ 0.1, 0.1, 30.0 }, Vec3{ 10.0, 0.1, 0.1 } })
  {
    const TriangleMesh box = MakeBox(size);
    EXPECT_FALSE(IsAcross(box, across, 0));
    EXPECT_FALSE(IsAcross(box, { 3, 5, 6, 7 }, 0));
  }
}

TEST(ThinLayers, NarrowFacetsThatBendALittleAreOneSide)
{
  // Each facet is a hundredth of the circumference wide, and twelve times the thickness.
  const TriangleMesh thin = MakeTube(100, 0.005);
  EXPECT_TRUE(IsAcross(thin, { 0, 2, 3, 6 }, 0));
  // The inside of the tube bends by 60 degrees.
  const TriangleMesh hexagonal = MakeTube(6, 0.005);
  EXPECT_TRUE(IsAcross(hexagonal, { 0, 2, 3, 6 }, 0));
  const TriangleMesh thick = MakeTube(6, 0.2);
  EXPECT_FALSE(IsAcross(thick, { 0, 2, 3, 6 }, 0));
}
