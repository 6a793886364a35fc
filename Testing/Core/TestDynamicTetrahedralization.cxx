// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/BoundarySpheres.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace cdm;

namespace
{
/** A surface with empty smallest spheres and its structural edges. */
DelaunaySurfaceRefinerOutput MakeSurface(const PolygonSoup& soup, double edge)
{
  BoundaryTriangulatorOutput boundary;
  EXPECT_TRUE(TriangulateBoundary(soup, {}, {}, boundary).IsOk());
  DelaunaySurfaceRefinerInput input;
  input.Surface = &boundary.Surface;
  DelaunaySurfaceRefinerOptions options;
  options.Criterion = SurfaceCriterion::SmallestSphere;
  options.MaximumEdgeLength = edge;
  DelaunaySurfaceRefinerOutput output;
  EXPECT_TRUE(RefineDelaunaySurface(input, options, {}, output).IsOk());
  return output;
}

/**
 * The surface of the unit cube as size^2 squares on each side: all of its cells are cospherical.
 */
PolygonSoup MakeGridSurface(int size)
{
  PolygonSoup soup;
  const int side = size + 1;
  for (int i = 0; i < side * side * side; ++i)
  {
    soup.Points.push_back(
      { double(i % side) / size, double(i / side % side) / size, double(i / side / side) / size });
  }
  const int steps[3] = { 1, side, side * side };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int end = 0; end < 2; ++end)
    {
      for (int cell = 0; cell < size * size; ++cell)
      {
        const int u = steps[(axis + 1) % 3];
        const int v = steps[(axis + 2) % 3];
        const Id corner =
          static_cast<Id>(end * size * steps[axis] + cell % size * u + cell / size * v);
        for (int step : { 0, u, u + v, v })
        {
          soup.Connectivity.push_back(corner + step);
        }
        soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
        soup.Labels.push_back(
          end == 1 ? RegionPair{ OutsideRegion, 0 } : RegionPair{ 0, OutsideRegion });
      }
    }
  }
  return soup;
}

TetMesh Tetrahedralize(const TriangleMesh& surface, const std::vector<Vec3>& points)
{
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &surface;
  input.MeshPoints = &points;
  AdvancingFrontTetrahedralizerOutput output;
  const Status status = TetrahedralizeByAdvancingFront(input, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  EXPECT_EQ(output.MeshPointSources.size(), points.size());
  return output.Mesh;
}

std::vector<std::pair<TetrahedronIds, Id>> GetCells(const TetMesh& mesh, const std::vector<Id>& ids)
{
  std::vector<std::pair<TetrahedronIds, Id>> cells;
  for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
  {
    if (mesh.Tetrahedra[t][0] == NoId)
    {
      continue;
    }
    TetrahedronIds cell = mesh.Tetrahedra[t];
    for (Id& id : cell)
    {
      id = ids[id];
    }
    std::sort(cell.begin(), cell.end());
    cells.emplace_back(cell, mesh.Regions[t]);
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/** Whether the mesh is the one that stage 3 makes of its points, and its neighbors are right. */
void ExpectMeshOfStage3(const DynamicTetrahedralization& dynamic, const TriangleMesh& surface)
{
  TetMesh mesh = dynamic.GetMesh();
  std::vector<Vec3> points;
  std::vector<Id> ids(mesh.Points.size(), NoId);
  for (Id p = 0; p < dynamic.GetNumberOfPoints(); ++p)
  {
    const bool isOnSurface = p < static_cast<Id>(surface.Points.size());
    if (isOnSurface || dynamic.GetTetrahedronAt(p) != NoId)
    {
      ids[p] = isOnSurface ? p : static_cast<Id>(surface.Points.size() + points.size());
      if (!isOnSurface)
      {
        points.push_back(mesh.Points[p]);
      }
    }
  }
  const TetMesh expected = Tetrahedralize(surface, points);
  std::vector<Id> same(expected.Points.size());
  for (std::size_t i = 0; i < same.size(); ++i)
  {
    same[i] = static_cast<Id>(i);
  }
  EXPECT_EQ(GetCells(mesh, ids), GetCells(expected, same));

  for (Id t = 0; t < dynamic.GetNumberOfTetrahedra(); ++t)
  {
    if (dynamic.IsDead(t))
    {
      continue;
    }
    for (int i = 0; i < 4; ++i)
    {
      const Id neighbor = mesh.Neighbors[t][i];
      ASSERT_TRUE(neighbor == NoId || mesh.Neighbors[neighbor / 4][neighbor % 4] == 4 * t + i);
    }
    for (Id id : mesh.Tetrahedra[t])
    {
      EXPECT_FALSE(dynamic.IsDead(dynamic.GetTetrahedronAt(id)));
    }
  }
}

/** Whether the point can be inserted: found from any tetrahedron in conflict. */
bool FindCavity(DynamicTetrahedralization& mesh, BoundarySpheres& spheres, const Vec3& position,
  Id number, PointCavity& cavity)
{
  BoundarySpheres::Encroached encroached;
  spheres.Find(position, encroached);
  for (Id t = 0; t < mesh.GetNumberOfTetrahedra() && encroached.IsEmpty(); ++t)
  {
    if (!mesh.IsDead(t) && mesh.Locate(position, t) == t)
    {
      return mesh.FindCavity(position, number, t, cavity);
    }
  }
  return false;
}

/** All is as before, but for places that no tetrahedron had. */
void ExpectUndone(const TetMesh& before, const std::vector<std::int64_t>& stamps,
  const DynamicTetrahedralization& mesh)
{
  for (Id t = 0; t < mesh.GetNumberOfTetrahedra(); ++t)
  {
    if (t >= static_cast<Id>(stamps.size()) || before.Tetrahedra[t][0] == NoId)
    {
      ASSERT_TRUE(mesh.IsDead(t));
      continue;
    }
    ASSERT_EQ(mesh.GetMesh().Tetrahedra[t], before.Tetrahedra[t]);
    ASSERT_EQ(mesh.GetMesh().Neighbors[t], before.Neighbors[t]);
    ASSERT_EQ(mesh.GetMesh().Regions[t], before.Regions[t]);
    ASSERT_EQ(mesh.GetStamp(t), stamps[t]);
  }
}

/** Whoever looks at facets as they are found sees those of the cavity, and may end the search. */
void ExpectFacetsAsTheyAreFound(
  const DynamicTetrahedralization& mesh, const Vec3& position, const PointCavity& cavity)
{
  CavitySearch search = mesh.MakeSearch(false);
  for (std::size_t last = 0; last <= cavity.Facets.size(); ++last)
  {
    PointCavity again;
    std::vector<TriangleIds> facets;
    const bool isFound =
      search.FindCavity(position, mesh.GetNumberOfPoints(), cavity.Tetrahedra.front(), again,
        [&]
        {
          facets.push_back(again.Facets.back());
          return facets.size() <= last;
        });
    EXPECT_EQ(isFound, last == cavity.Facets.size());
    EXPECT_EQ(facets.size(), std::min(last + 1, cavity.Facets.size()));
    EXPECT_TRUE(std::equal(facets.begin(), facets.end(), cavity.Facets.begin()));
  }
  for (const Id facet : cavity.Inner)
  {
    EXPECT_TRUE(search.IsAroundCavity(facet, position, mesh.GetNumberOfPoints()));
  }
  for (const Id facet : cavity.Outer)
  {
    EXPECT_FALSE(facet != NoId && search.IsAroundCavity(facet, position, mesh.GetNumberOfPoints()));
  }
}

/** Removes a point; a search that left it out before has found what the mesh finds then. */
void ExpectFoundWithoutThePoint(Id point, const Vec3& position, DynamicTetrahedralization& mesh)
{
  CavitySearch search = mesh.MakeSearch(true);
  search.StartRecord();
  ASSERT_TRUE(search.LeaveOut(point));
  const Id first = search.GetFirstCell();
  const Id place = search.Locate(position, first);
  PointCavity foreseen;
  const bool isForeseen = place != NoId && search.FindCavity(position, point, place, foreseen);
  const std::vector<Id> visited = search.GetVisited();
  search.TakeBack();
  EXPECT_EQ(search.GetVisited(), visited);

  ASSERT_TRUE(mesh.Remove(point));
  const std::vector<Id> made = mesh.GetChanged();
  const auto getId = [&](Id t) { return t < first ? t : made[t - first]; };
  ASSERT_EQ(mesh.Locate(position, made.front()), place == NoId ? NoId : getId(place));
  PointCavity cavity;
  ASSERT_EQ(place != NoId && mesh.FindCavity(position, point, getId(place), cavity), isForeseen);
  for (const Id t : foreseen.Tetrahedra)
  {
    EXPECT_TRUE(t >= first || std::count(visited.begin(), visited.end(), t) == 1);
  }
  mesh.NumberCells(first, foreseen);
  EXPECT_EQ(foreseen.Tetrahedra, cavity.Tetrahedra);
  EXPECT_EQ(foreseen.Facets, cavity.Facets);
  EXPECT_EQ(foreseen.Inner, cavity.Inner);
  EXPECT_EQ(foreseen.Outer, cavity.Outer);
}

/** Inserts, removes and moves points at random; getPosition() proposes places. */
template <typename GetPosition>
void Exercise(const DelaunaySurfaceRefinerOutput& refined, int steps, std::mt19937_64& generator,
  GetPosition&& getPosition)
{
  const TriangleMesh& surface = refined.Surface;
  DynamicTetrahedralization mesh(Tetrahedralize(surface, {}));
  BoundarySpheres spheres(surface, refined.StructuralEdges);
  PointCavity cavity;
  std::vector<Id> inside;
  int changes[3] = { 0, 0, 0 };
  for (int step = 0; step < steps; ++step)
  {
    const Vec3 position = getPosition();
    const std::size_t chosen = inside.empty() ? 0 : generator() % inside.size();
    const int action = inside.size() < 5 ? 0 : static_cast<int>(generator() % 4);
    if (action < 2)
    {
      if (FindCavity(mesh, spheres, position, mesh.GetNumberOfPoints(), cavity))
      {
        ExpectFacetsAsTheyAreFound(mesh, position, cavity);
        inside.push_back(mesh.Insert(position, cavity));
        ++changes[0];
      }
    }
    else
    {
      const Id point = inside[chosen];
      const Vec3 old = mesh.GetPoint(point);
      const TetMesh before = mesh.GetMesh();
      std::vector<std::int64_t> stamps;
      for (Id t = 0; t < mesh.GetNumberOfTetrahedra(); ++t)
      {
        stamps.push_back(mesh.GetStamp(t));
      }
      ASSERT_TRUE(mesh.Remove(point));
      EXPECT_EQ(mesh.GetTetrahedronAt(point), NoId);
      mesh.UndoRemove();
      ExpectUndone(before, stamps, mesh);
      ExpectFoundWithoutThePoint(point, position, mesh);
      if (action == 3)
      {
        const bool isMoved = FindCavity(mesh, spheres, position, point, cavity);
        ASSERT_TRUE(isMoved || FindCavity(mesh, spheres, old, point, cavity));
        mesh.Restore(point, isMoved ? position : old, cavity);
        ++changes[2];
      }
      else
      {
        inside.erase(inside.begin() + static_cast<std::ptrdiff_t>(chosen));
        ++changes[1];
      }
    }
    if (step % 10 == 9 || step + 1 == steps)
    {
      ExpectMeshOfStage3(mesh, surface);
    }
  }
  EXPECT_GT(changes[0], steps / 10);
  EXPECT_GT(changes[1], 0);
  EXPECT_GT(changes[2], 0);
}
} // namespace

TEST(DynamicTetrahedralization, IsTheMeshOfStage3InRandomComplexes)
{
  for (unsigned int seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const PolygonSoup soup = MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 2, 0.4 * seed);
    const DelaunaySurfaceRefinerOutput refined = MakeSurface(soup, 0.2);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Exercise(refined, 150, generator,
      [&]
      {
        const std::vector<Vec3>& points = refined.Surface.Points;
        const double weight = uniform(generator);
        return weight * points[generator() % points.size()] +
          (1.0 - weight) * points[generator() % points.size()];
      });
  }
}

TEST(DynamicTetrahedralization, IsTheMeshOfStage3OnGridsWhereAllCellsAreCospherical)
{
  for (unsigned int seed = 1; seed <= 3; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const DelaunaySurfaceRefinerOutput refined = MakeSurface(MakeGridSurface(4), 0.0);
    // Corners of the grid's cells and of cells half as large: copies are refused.
    Exercise(refined, 200, generator,
      [&]
      {
        return Vec3{ double(1 + generator() % 7) / 8.0, double(1 + generator() % 7) / 8.0,
          double(1 + generator() % 7) / 8.0 };
      });
  }
}

TEST(DynamicTetrahedralization, TakesNothingOnOrBeyondABoundary)
{
  const DelaunaySurfaceRefinerOutput refined = MakeSurface(MakeGridSurface(2), 0.0);
  DynamicTetrahedralization mesh(Tetrahedralize(refined.Surface, {}));
  const Id points = mesh.GetNumberOfPoints();
  const Id tetrahedra = mesh.GetNumberOfTetrahedra();
  for (Id p = 0; p < points; ++p)
  {
    EXPECT_FALSE(mesh.Remove(p));
  }
  PointCavity cavity;
  for (const Vec3& position :
    { Vec3{ 0.3, 0.4, 0.0 }, Vec3{ 0.3, 0.4, -0.1 }, Vec3{ 0.5, 0.5, 0.0 }, Vec3{ 2.0, 2.0, 2.0 } })
  {
    for (Id t = 0; t < tetrahedra; ++t)
    {
      EXPECT_FALSE(mesh.FindCavity(position, points, t, cavity));
      const Id found = mesh.Locate(position, t);
      EXPECT_EQ(found == NoId, position.Z < 0.0 || position.Z > 1.0);
    }
  }
  // The center is a point of the grid that is not in the mesh.
  const Id first = mesh.Locate({ 0.5, 0.5, 0.5 }, 0);
  ASSERT_NE(first, NoId);
  ASSERT_TRUE(mesh.FindCavity({ 0.5, 0.5, 0.5 }, points, first, cavity));
  const Id center = mesh.Insert({ 0.5, 0.5, 0.5 }, cavity);
  std::vector<Id> star;
  EXPECT_TRUE(mesh.FindStar(center, star));
  EXPECT_EQ(star.size(), cavity.Facets.size());
  ExpectMeshOfStage3(mesh, refined.Surface);
  EXPECT_TRUE(mesh.Remove(center));
  ExpectMeshOfStage3(mesh, refined.Surface);
  mesh.UndoRemove();
  ExpectMeshOfStage3(mesh, refined.Surface);
}

/** A flat tetrahedron of the boundary is left out: the one behind it is known at its points. */
TEST(DynamicTetrahedralization, KnowsATetrahedronAtThePointsOfAnOuterFacet)
{
  TetMesh pair;
  pair.Points = { { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 },
    { 0.3, 0.3, -1e-17 } };
  pair.Tetrahedra = { { 0, 1, 2, 3 }, { 0, 2, 1, 4 } };
  pair.Regions = { 0, 0 };
  pair.Neighbors = { { NoId, NoId, NoId, 7 }, { NoId, NoId, NoId, 3 } };
  DynamicTetrahedralization mesh(pair);
  EXPECT_EQ(mesh.GetTetrahedronAt(0), 1);
  mesh.MakeOuter(3);
  mesh.Replace({ 1 }, {}, {});
  EXPECT_TRUE(mesh.IsDead(1));
  EXPECT_EQ(mesh.GetMesh().Neighbors[0][3], NoId);
  for (Id point = 0; point < 4; ++point)
  {
    EXPECT_EQ(mesh.GetTetrahedronAt(point), 0);
  }
}
