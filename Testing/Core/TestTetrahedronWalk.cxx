// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/TetrahedronWalk.h"
#include "RandomMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace cdm;

namespace
{
/** The Delaunay mesh of random points, without some of its tetrahedra: walks may not go through. */
TetMesh MakeMesh(int numberOfPoints, int every, std::mt19937_64& generator)
{
  TetMesh mesh = MakeRandomMesh(numberOfPoints, generator);
  for (Id t = 0; t < static_cast<Id>(mesh.Tetrahedra.size()) && every > 0; t += every)
  {
    for (const Id neighbor : mesh.Neighbors[t])
    {
      if (neighbor != NoId)
      {
        mesh.Neighbors[neighbor / 4][neighbor % 4] = NoId;
      }
    }
    mesh.Tetrahedra[t][0] = NoId;
  }
  RemoveDeadTetrahedra(mesh);
  return mesh;
}

bool IsHeld(const TetMesh& mesh, Id t, const Vec3& position)
{
  for (int i = 0; i < 4; ++i)
  {
    const TriangleIds facet = GetFacet(mesh.Tetrahedra[t], i);
    if (Orientation(mesh.Points[facet[0]], mesh.Points[facet[1]], mesh.Points[facet[2]], position) >
      0)
    {
      return false;
    }
  }
  return true;
}
} // namespace

TEST(TetrahedronWalk, FindsWhatHoldsAPosition)
{
  for (const int every : { 0, 20 })
  {
    SCOPED_TRACE(every);
    std::mt19937_64 generator(17);
    const TetMesh mesh = MakeMesh(2000, every, generator);
    std::vector<Vec3> positions;
    for (int i = 0; i < 20000; ++i)
    {
      // Corners of tetrahedra, points of their edges and facets, and points inside.
      const TetrahedronIds& ids = mesh.Tetrahedra[generator() % mesh.Tetrahedra.size()];
      Vec3 sum;
      const int count = 1 + i % 4;
      for (int k = 0; k < count; ++k)
      {
        sum = sum + mesh.Points[ids[k]];
      }
      positions.push_back((1.0 / count) * sum);
    }
    const std::vector<Id> found = FindTetrahedra(mesh, positions, 1);
    ASSERT_EQ(found.size(), positions.size());
    std::size_t missed = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      missed += found[i] == NoId ? 1 : 0;
      EXPECT_TRUE(found[i] == NoId || IsHeld(mesh, found[i], positions[i])) << i;
    }
    // In a mesh without holes, walks miss only what rounding puts outside.
    EXPECT_LT(missed, every == 0 ? positions.size() / 400 : positions.size() / 3);
    EXPECT_EQ(FindTetrahedra(mesh, positions, 3), found);
  }
}

TEST(TetrahedronWalk, FindsNothingOutside)
{
  std::mt19937_64 generator(5);
  const TetMesh mesh = MakeMesh(100, 0, generator);
  const std::vector<Vec3> positions{ { 2.0, 0.5, 0.5 }, { 0.5, 0.5, 0.5 }, { 0.5, -1.0, 0.5 } };
  const std::vector<Id> found = FindTetrahedra(mesh, positions, 0);
  EXPECT_EQ(found[0], NoId);
  EXPECT_NE(found[1], NoId);
  EXPECT_EQ(found[2], NoId);
  EXPECT_EQ(FindTetrahedra(TetMesh(), positions, 1), std::vector<Id>(3, NoId));
  EXPECT_TRUE(FindTetrahedra(mesh, {}, 1).empty());
}
