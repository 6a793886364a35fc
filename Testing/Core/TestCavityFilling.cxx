// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/CavityCone.h"
#include "Core/Delaunay/CavityFilling.h"
#include "Core/Geometry/Measures.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

using namespace cdm;

namespace
{
/** A box of two layers with random points inside. */
AdvancingFrontTetrahedralizerOutput MakeMesh(std::mt19937_64& generator)
{
  CellComplex complex({ 1.0, 1.0, 1.0 });
  EXPECT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, 0.5, 1e-6));
  BoundaryTriangulatorOutput boundary;
  EXPECT_TRUE(TriangulateBoundary(complex.GetSoup(), {}, {}, boundary).IsOk());
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  std::vector<Vec3> points;
  for (int i = 0; i < 60; ++i)
  {
    const double z = uniform(generator);
    points.push_back({ uniform(generator), uniform(generator), z + (z < 0.5 ? -0.05 : 0.05) });
  }
  DelaunaySurfaceRefinerInput input;
  input.Surface = &boundary.Surface;
  input.MeshPoints = &points;
  DelaunaySurfaceRefinerOptions options;
  options.MaximumEdgeLength = 0.3;
  DelaunaySurfaceRefinerOutput refined;
  EXPECT_TRUE(RefineDelaunaySurface(input, options, {}, refined).IsOk());
  AdvancingFrontTetrahedralizerInput front;
  front.Surface = &refined.Surface;
  front.MeshPoints = &points;
  AdvancingFrontTetrahedralizerOutput output;
  EXPECT_TRUE(TetrahedralizeByAdvancingFront(front, {}, {}, output).IsOk());
  return output;
}

/** Tetrahedra around one, across facets, whatever region they are in. */
std::vector<Id> Grow(const TetMesh& mesh, Id start, std::size_t count)
{
  std::vector<Id> chosen(1, start);
  for (std::size_t k = 0; k < chosen.size() && chosen.size() < count; ++k)
  {
    for (Id neighbor : mesh.Neighbors[chosen[k]])
    {
      if (neighbor != NoId && std::find(chosen.begin(), chosen.end(), neighbor / 4) == chosen.end())
      {
        chosen.push_back(neighbor / 4);
      }
    }
  }
  return chosen;
}

/** The cavity that is left without them; interfaces are walls. */
Cavity TakeOut(const TetMesh& mesh, const std::vector<Id>& chosen)
{
  Cavity cavity;
  for (Id t : chosen)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    cavity.Numbers.insert(cavity.Numbers.end(), ids.begin(), ids.end());
    for (int i = 0; i < 4; ++i)
    {
      const Id neighbor = mesh.Neighbors[t][i];
      const TriangleIds facet = GetFacet(ids, i);
      if (neighbor == NoId || std::find(chosen.begin(), chosen.end(), neighbor / 4) == chosen.end())
      {
        cavity.Border.push_back({ facet[0], facet[2], facet[1] });
        cavity.Regions.push_back(mesh.Regions[t]);
      }
      else if (mesh.Regions[neighbor / 4] != mesh.Regions[t] && neighbor / 4 > t)
      {
        cavity.Walls.push_back(facet);
      }
    }
  }
  SortUnique(cavity.Numbers);
  for (Id id : cavity.Numbers)
  {
    cavity.Points.push_back(mesh.Points[id]);
  }
  return cavity;
}

std::map<TetrahedronIds, Id> GetRegions(const TetMesh& mesh, const std::vector<Id>& chosen)
{
  std::map<TetrahedronIds, Id> regions;
  for (Id t : chosen)
  {
    TetrahedronIds ids = mesh.Tetrahedra[t];
    std::sort(ids.begin(), ids.end());
    regions[ids] = mesh.Regions[t];
  }
  return regions;
}

void ExpectFilledBy(
  const CavityFilling& filling, const Cavity& cavity, const std::map<TetrahedronIds, Id>& expected)
{
  const std::vector<CavityCell>& cells = filling.GetCells();
  std::map<TetrahedronIds, Id> regions;
  std::vector<int> uses(cavity.Border.size(), 0);
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    TetrahedronIds ids = cells[k].Ids;
    std::sort(ids.begin(), ids.end());
    regions[ids] = cells[k].Region;
    for (int i = 0; i < 4; ++i)
    {
      const Id neighbor = cells[k].Neighbors[i];
      ASSERT_NE(neighbor, NoId);
      if (neighbor >= 0)
      {
        EXPECT_EQ(cells[neighbor / 4].Neighbors[neighbor % 4], static_cast<Id>(4 * k) + i);
      }
      else
      {
        const Id border = CavityCell::GetBorderFacet(neighbor);
        ++uses[border];
        const TriangleIds facet = GetFacet(cells[k].Ids, i);
        EXPECT_TRUE(std::is_permutation(facet.begin(), facet.end(), cavity.Border[border].begin()));
      }
    }
  }
  EXPECT_EQ(regions, expected);
  EXPECT_EQ(static_cast<std::size_t>(std::count(uses.begin(), uses.end(), 1)), uses.size());
}
} // namespace

TEST(CavityFilling, PutsBackWhatWasTakenOut)
{
  std::size_t withWalls = 0;
  std::size_t withManyPoints = 0;
  for (unsigned int seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const TetMesh mesh = MakeMesh(generator).Mesh;
    CavityFilling filling;
    for (int i = 0; i < 50; ++i)
    {
      const std::vector<Id> chosen =
        Grow(mesh, static_cast<Id>(generator() % mesh.Tetrahedra.size()),
          1 + generator() % (i % 5 == 0 ? 250 : 30));
      const Cavity cavity = TakeOut(mesh, chosen);
      withManyPoints += cavity.Points.size() > CavityWrapping::MostPoints ? 1 : 0;
      withWalls += cavity.Walls.empty() ? 0 : 1;
      ASSERT_TRUE(filling.Run(cavity));
      ExpectFilledBy(filling, cavity, GetRegions(mesh, chosen));
    }
  }
  EXPECT_GT(withWalls, 20u);
  EXPECT_GT(withManyPoints, 10u);
}

TEST(CavityFilling, EndsAtACellThatIsNotAccepted)
{
  std::mt19937_64 generator(1);
  const TetMesh mesh = MakeMesh(generator).Mesh;
  CavityFilling filling;
  for (const std::size_t count : { 12, 250 })
  {
    const Cavity cavity = TakeOut(mesh, Grow(mesh, 0, count));
    ASSERT_EQ(cavity.Points.size() > CavityWrapping::MostPoints, count == 250);
    std::map<TetrahedronIds, Id> seen;
    const auto see = [&](TetrahedronIds ids, Id region)
    {
      std::sort(ids.begin(), ids.end());
      seen[ids] = region;
      return true;
    };
    ASSERT_TRUE(filling.Run(cavity, see));
    ExpectFilledBy(filling, cavity, seen);
    std::size_t calls = 0;
    EXPECT_FALSE(filling.Run(
      cavity, [&](const TetrahedronIds& /*ids*/, Id /*region*/) { return ++calls < 3; }));
    EXPECT_EQ(calls, 3u);
  }
}

TEST(CavityFilling, RefusesWhatHasNoBorderAllAround)
{
  std::mt19937_64 generator(1);
  const TetMesh mesh = MakeMesh(generator).Mesh;
  CavityFilling filling;
  for (int i = 0; i < 50; ++i)
  {
    const std::vector<Id> chosen =
      Grow(mesh, static_cast<Id>(generator() % mesh.Tetrahedra.size()), 12);
    const Cavity cavity = TakeOut(mesh, chosen);

    // A wall that is no facet: two points of the border and one that is nowhere near.
    Cavity other = cavity;
    other.Walls.push_back({ cavity.Border[0][0], cavity.Border[0][1], 1000000 });
    EXPECT_FALSE(filling.Run(other));

    // A region on the wrong side of a wall.
    if (!cavity.Walls.empty())
    {
      other = cavity;
      other.Walls.clear();
      EXPECT_FALSE(filling.Run(other));
    }

    // A facet of the border that is missing is a way out, or to the points of a dent.
    other = cavity;
    other.Border.pop_back();
    other.Regions.pop_back();
    if (filling.Run(other))
    {
      EXPECT_GT(filling.GetCells().size(), chosen.size());
    }
  }
}

TEST(CavityFilling, RefusesPointsThatTheCavityDoesNotHave)
{
  Cavity cavity;
  cavity.Numbers = { 2, 4, 6, 8 };
  for (const Vec3& point :
    { Vec3{ 0.0, 0.0, 0.0 }, Vec3{ 1.0, 0.0, 0.0 }, Vec3{ 0.0, 1.0, 0.0 }, Vec3{ 0.0, 0.0, 1.0 } })
  {
    cavity.Points.push_back(point);
  }
  for (int i = 0; i < 4; ++i)
  {
    const TriangleIds facet = GetFacet({ 2, 4, 6, 8 }, i);
    cavity.Border.push_back({ facet[0], facet[2], facet[1] });
    cavity.Regions.push_back(0);
  }
  CavityFilling filling;
  ASSERT_TRUE(filling.Run(cavity));
  EXPECT_EQ(filling.GetCells().size(), 1u);
  // Numbers between those of two points, before all and behind all.
  for (const Id other : { 5, 1, 9 })
  {
    Cavity wrong = cavity;
    std::replace(wrong.Border[0].begin(), wrong.Border[0].end(), 6, other);
    EXPECT_FALSE(filling.Run(wrong)) << other;
    wrong = cavity;
    wrong.Walls.push_back({ 2, 4, other });
    EXPECT_FALSE(filling.Run(wrong)) << other;
  }
}

namespace
{
/** The border of an octahedron of four tetrahedra, with the apex on its axis or beyond. */
struct Octahedron
{
  std::vector<Vec3> Points{ { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { -1.0, 0.0, 0.0 },
    { 0.0, -1.0, 0.0 }, { 0.0, 0.0, 1.0 }, { 0.0, 0.0, -1.0 } };
  Cavity Around;
  CavityCone Cone;

  explicit Octahedron(double height)
  {
    this->Points.push_back({ 0.0, 0.0, height });
    for (Id k = 0; k < 4; ++k)
    {
      // Above and below the square are two regions.
      this->Around.Border.push_back({ (k + 1) % 4, k, 4 });
      this->Around.Regions.push_back(1);
      this->Around.Border.push_back({ k, (k + 1) % 4, 5 });
      this->Around.Regions.push_back(2);
    }
  }
  bool Run(const CavityCone::Walls& walls)
  {
    return this->Cone.Run(
      this->Around, 6, walls, [this](Id id) -> const Vec3& { return this->Points[id]; });
  }
};

CavityCone::Walls MakeSquare(int numberOfSides)
{
  CavityCone::Walls walls;
  for (Id k = 0; k < numberOfSides; ++k)
  {
    const TriangleIds wall = Sorted(TriangleIds{ k, (k + 1) % 4, 6 });
    walls.emplace_back(wall, 1);
    walls.emplace_back(wall, 2);
  }
  std::sort(walls.begin(), walls.end());
  return walls;
}
} // namespace

TEST(CavityCone, JoinsAPointWithAllFacets)
{
  Octahedron octahedron(0.0);
  ASSERT_TRUE(octahedron.Run(MakeSquare(4)));
  const std::vector<CavityCell>& cells = octahedron.Cone.GetCells();
  ASSERT_EQ(cells.size(), 8u);
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    EXPECT_EQ(CavityCell::GetBorderFacet(cells[k].Neighbors[3]), static_cast<Id>(k));
    EXPECT_EQ(cells[k].Region, octahedron.Around.Regions[k]);
    for (int i = 0; i < 3; ++i)
    {
      const Id neighbor = cells[k].Neighbors[i];
      ASSERT_GE(neighbor, 0);
      EXPECT_EQ(cells[neighbor / 4].Neighbors[neighbor % 4], 4 * static_cast<Id>(k) + i);
      EXPECT_EQ(
        Sorted(GetFacet(cells[neighbor / 4].Ids, neighbor % 4)), Sorted(GetFacet(cells[k].Ids, i)));
    }
  }
}

TEST(CavityCone, RefusesWhatIsNoCone)
{
  // Regions meet where no wall is; a wall is where no region is; the apex is beyond a facet.
  EXPECT_FALSE(Octahedron(0.0).Run(MakeSquare(3)));
  CavityCone::Walls walls = MakeSquare(4);
  walls.emplace_back(TriangleIds{ 0, 4, 6 }, 2);
  std::sort(walls.begin(), walls.end());
  EXPECT_FALSE(Octahedron(0.0).Run(walls));
  EXPECT_FALSE(Octahedron(1.5).Run(MakeSquare(4)));
  // It lies in the planes of four facets.
  EXPECT_FALSE(Octahedron(1.0).Run(MakeSquare(4)));
}
