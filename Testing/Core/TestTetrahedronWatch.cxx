// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/TetrahedronWatch.h"
#include "RandomMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace cdm;

namespace
{
bool Insert(const Vec3& position, DynamicTetrahedralization& mesh)
{
  PointCavity cavity;
  Id first = 0;
  while (mesh.IsDead(first))
  {
    ++first;
  }
  first = mesh.Locate(position, first);
  if (first == NoId || !mesh.FindCavity(position, mesh.GetNumberOfPoints(), first, cavity))
  {
    return false;
  }
  mesh.Insert(position, cavity);
  return true;
}

/** A third of all. */
bool HasProperty(const DynamicTetrahedralization& mesh, Id t)
{
  const TetrahedronIds& ids = mesh.GetMesh().Tetrahedra[t];
  return (ids[0] + ids[1] + ids[2] + ids[3]) % 3 == 0;
}

std::vector<Id> FindAll(const DynamicTetrahedralization& mesh)
{
  std::vector<Id> found;
  for (Id t = 0; t < mesh.GetNumberOfTetrahedra(); ++t)
  {
    if (!mesh.IsDead(t) && HasProperty(mesh, t))
    {
      found.push_back(t);
    }
  }
  return found;
}

std::vector<Id> Update(
  const DynamicTetrahedralization& mesh, TetrahedronWatch& watch, int numberOfThreads = 1)
{
  ThreadTeam team(numberOfThreads);
  std::vector<Id> found = watch.Update(mesh, team, [&](Id t) { return HasProperty(mesh, t); });
  std::sort(found.begin(), found.end());
  return found;
}
} // namespace

TEST(TetrahedronWatch, AsksForWhatIsNewOnly)
{
  std::mt19937_64 generator(1);
  DynamicTetrahedralization mesh(MakeRandomMesh(2000, generator));
  TetrahedronWatch watch;
  EXPECT_EQ(Update(mesh, watch), FindAll(mesh));
  EXPECT_EQ(watch.GetNumberOfTests(), mesh.GetNumberOfTetrahedra());
  for (int round = 0; round < 100; ++round)
  {
    const std::int64_t before = watch.GetNumberOfTests();
    const std::int64_t visits = watch.GetNumberOfVisits();
    // Unchanged: nothing is asked.
    EXPECT_EQ(Update(mesh, watch), FindAll(mesh));
    EXPECT_EQ(watch.GetNumberOfTests(), before);
    EXPECT_EQ(watch.GetNumberOfVisits(), visits);
    if (!Insert(DrawPoint(generator), mesh))
    {
      continue;
    }
    EXPECT_EQ(Update(mesh, watch), FindAll(mesh));
    const auto changed = static_cast<std::int64_t>(mesh.GetChanged().size());
    EXPECT_EQ(watch.GetNumberOfTests() - before, changed);
    EXPECT_EQ(watch.GetNumberOfVisits() - visits, changed);
  }
}

TEST(TetrahedronWatch, AsksOnSeveralThreads)
{
  std::mt19937_64 generator(5);
  DynamicTetrahedralization mesh(MakeRandomMesh(2000, generator));
  TetrahedronWatch watch;
  EXPECT_EQ(Update(mesh, watch, 4), FindAll(mesh));
  EXPECT_EQ(watch.GetNumberOfTests(), mesh.GetNumberOfTetrahedra());
  for (int i = 0; i < 100; ++i)
  {
    Insert(DrawPoint(generator), mesh);
  }
  EXPECT_EQ(Update(mesh, watch, 4), FindAll(mesh));
}

/** More changes than the mesh remembers, and more than it has tetrahedra. */
TEST(TetrahedronWatch, VisitsAllAfterManyChanges)
{
  std::mt19937_64 generator(4);
  DynamicTetrahedralization mesh(MakeRandomMesh(300, generator));
  TetrahedronWatch watch;
  for (const int changes : { 10, 2000, 10, 100 })
  {
    for (int i = 0; i < changes; ++i)
    {
      Insert(DrawPoint(generator), mesh);
    }
    EXPECT_EQ(Update(mesh, watch), FindAll(mesh));
  }
}

TEST(TetrahedronWatch, FollowsRemovalsThatAreUndone)
{
  std::mt19937_64 generator(2);
  DynamicTetrahedralization mesh(MakeRandomMesh(500, generator));
  TetrahedronWatch watch;
  Update(mesh, watch);
  int removals = 0;
  for (Id point = 0; point < 500; ++point)
  {
    if (mesh.Remove(point))
    {
      ++removals;
      if (point % 2 == 0)
      {
        mesh.UndoRemove();
      }
      EXPECT_EQ(Update(mesh, watch), FindAll(mesh));
    }
  }
  EXPECT_GT(removals, 200);
}

TEST(TetrahedronWatch, AsksAgainForWhatItHasToForget)
{
  std::mt19937_64 generator(3);
  DynamicTetrahedralization mesh(MakeRandomMesh(500, generator));
  TetrahedronWatch watch;
  Update(mesh, watch);
  const MeshMoment moment = mesh.GetMoment();
  ASSERT_TRUE(Insert({ 0.5, 0.5, 0.5 }, mesh));
  Update(mesh, watch);
  const auto count = static_cast<std::int64_t>(mesh.GetChanged().size());
  const std::int64_t before = watch.GetNumberOfTests();
  const std::int64_t visits = watch.GetNumberOfVisits();
  watch.Forget(moment);
  EXPECT_EQ(Update(mesh, watch), FindAll(mesh));
  EXPECT_EQ(watch.GetNumberOfTests() - before, count);
  EXPECT_EQ(watch.GetNumberOfVisits() - visits, count);
}
