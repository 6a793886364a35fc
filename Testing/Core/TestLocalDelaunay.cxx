// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/LocalDelaunay.h"
#include "Core/Geometry/Predicates.h"
#include "HullMeshes.h"
#include "RandomMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

using namespace cdm;

namespace
{
bool IsPositive(const TetMesh& mesh)
{
  return std::all_of(mesh.Tetrahedra.begin(), mesh.Tetrahedra.end(),
    [&mesh](const TetrahedronIds& ids)
    {
      const auto [a, b, c, d] = GetCorners(mesh.Points, ids);
      return Orientation(a, b, c, d) > 0;
    });
}

/** Whether no point lies in a circumsphere: all points, all spheres. */
bool IsDelaunay(const TetMesh& mesh)
{
  return std::all_of(mesh.Tetrahedra.begin(), mesh.Tetrahedra.end(),
    [&mesh](const TetrahedronIds& ids)
    {
      const auto [a, b, c, d] = GetCorners(mesh.Points, ids);
      return std::none_of(mesh.Points.begin(), mesh.Points.end(),
        [&, a = a, b = b, c = c, d = d](const Vec3& p) { return InSphere(a, b, c, d, p) > 0; });
    });
}
} // namespace

/** Of convex meshes, whose outer facets hide nothing. */
TEST(LocalDelaunay, LikeAllPointsInAllSpheres)
{
  int broken = 0;
  for (unsigned int seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    TetMesh mesh = MakeRandomMesh(30, generator);
    EXPECT_TRUE(IsLocallyDelaunay(mesh, 1));
    // A point that moves a little leaves the mesh valid, and often Delaunay.
    const Id p = std::uniform_int_distribution<Id>(0, 29)(generator);
    const double step = seed % 2 == 0 ? 0.01 : 0.03;
    mesh.Points[p] = mesh.Points[p] + step * (DrawPoint(generator) - Vec3{ 0.5, 0.5, 0.5 });
    if (IsPositive(mesh))
    {
      const bool expected = IsDelaunay(mesh);
      broken += expected ? 0 : 1;
      for (int threads : { 1, 3 })
      {
        EXPECT_EQ(IsLocallyDelaunay(mesh, threads), expected);
      }
    }
  }
  EXPECT_GT(broken, 10);
}

/** Where points are cospherical, only the pulling rule's tetrahedra count. */
TEST(LocalDelaunay, OfACubeOneSubdivision)
{
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.push_back({ i % 2 * 1.0, i / 2 % 2 * 1.0, i / 4 * 1.0 });
  }
  const TetMesh mesh = testing_core::MakeHullMesh(points);
  EXPECT_TRUE(IsLocallyDelaunay(mesh, 1));
  // The same tetrahedra with other numbers of their points are another subdivision.
  TetMesh renumbered = mesh;
  std::swap(renumbered.Points[0], renumbered.Points[1]);
  for (TetrahedronIds& ids : renumbered.Tetrahedra)
  {
    for (Id& id : ids)
    {
      id = id < 2 ? 1 - id : id;
    }
  }
  ASSERT_TRUE(IsPositive(renumbered));
  EXPECT_TRUE(IsDelaunay(renumbered));
  EXPECT_FALSE(IsLocallyDelaunay(renumbered, 1));
}
