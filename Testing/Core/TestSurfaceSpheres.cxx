// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Predicates.h"
#include "Core/Improvement/SurfaceSpheres.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
constexpr Id Side = 7;

/** Two squares of 6 x 6 cells, one above the other, each cell of two triangles. */
TriangleMesh MakePlates(double distance)
{
  TriangleMesh surface;
  for (Id plate = 0; plate < 2; ++plate)
  {
    for (Id i = 0; i < Side * Side; ++i)
    {
      surface.Points.push_back({ double(i % Side), double(i / Side), plate * distance });
      if (i % Side + 1 < Side && i / Side + 1 < Side)
      {
        const Id corner = plate * Side * Side + i;
        surface.Triangles.push_back({ corner, corner + 1, corner + Side + 1 });
        surface.Triangles.push_back({ corner, corner + Side + 1, corner + Side });
      }
    }
  }
  return surface;
}

/** Whether no point lies inside the smallest sphere of any triangle. */
bool AreAllEmpty(const TriangleMesh& surface)
{
  const std::vector<Vec3>& p = surface.Points;
  for (const TriangleIds& ids : surface.Triangles)
  {
    for (const Vec3& other : p)
    {
      if (InEquatorialSphere(p[ids[0]], p[ids[1]], p[ids[2]], other) > 0)
      {
        return false;
      }
    }
  }
  return true;
}
} // namespace

/** The plates are 0.75 apart: moves in one of them fill spheres in the other one, and in itself. */
TEST(SurfaceSpheres, AreThoseOfAllTrianglesAndPoints)
{
  const TriangleMesh surface = MakePlates(0.75);
  ASSERT_TRUE(AreAllEmpty(surface));
  const IdLists pointTriangles = ListTrianglesAtPoints(surface.Triangles, surface.Points.size());
  const std::vector<StructuralEdge> noEdges;
  const BoundarySpheres spheres(surface, noEdges);
  const SurfaceSpheres searched(surface, pointTriangles, spheres);
  int kept = 0;
  for (unsigned int seed = 1; seed <= 500; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const Id point = static_cast<Id>(generator() % surface.Points.size());
    std::uniform_real_distribution<double> step(-0.3, 0.3);
    TriangleMesh moved = surface;
    moved.Points[point] = surface.Points[point] + Vec3{ step(generator), step(generator), 0.0 };
    const bool isKept = searched.StayEmpty(point, moved.Points[point]);
    EXPECT_EQ(isKept, AreAllEmpty(moved));
    kept += isKept ? 1 : 0;
  }
  EXPECT_GT(kept, 20);
  EXPECT_LT(kept, 480);
}

/** Three corners on a line but for rounding. */
TEST(SurfaceSpheres, NeedlesAreNotMoved)
{
  const TriangleMesh surface = MakePlates(3.0);
  const IdLists pointTriangles = ListTrianglesAtPoints(surface.Triangles, surface.Points.size());
  const std::vector<StructuralEdge> noEdges;
  const BoundarySpheres spheres(surface, noEdges);
  const SurfaceSpheres searched(surface, pointTriangles, spheres);
  EXPECT_TRUE(searched.StayEmpty(Side + 1, surface.Points[Side + 1]));
  EXPECT_FALSE(searched.StayEmpty(Side + 1, { 0.5, 1e-17, 0.0 }));
}
