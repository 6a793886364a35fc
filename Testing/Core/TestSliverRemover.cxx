// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Improvement/FlipSearch.h"
#include "Core/Improvement/FlippableMesh.h"
#include "Core/Improvement/SliverRemover.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Meshes/MeshInvariants.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "HullMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

using namespace cdm;

namespace
{
constexpr double Degrees = 57.29577951308232;

void AddTetrahedron(TetMesh& mesh, TetrahedronIds ids, Id region)
{
  const std::vector<Vec3>& p = mesh.Points;
  if (Orientation(p[ids[0]], p[ids[1]], p[ids[2]], p[ids[3]]) < 0)
  {
    std::swap(ids[2], ids[3]);
  }
  mesh.Tetrahedra.push_back(ids);
  mesh.Regions.push_back(region);
}

enum class Numbering
{
  /** Points of even parity first: T6 with its slivers, one flip away from T5. */
  Parity,
  /** All kinds of cells. */
  Random
};

/**
 * A grid of size^3 unit cubes, each pulled from its lowest numbered corner: six tetrahedra.
 * The cubes below the middle are region 0, the others region 1.
 */
TetMesh MakeGrid(int size, Numbering numbering)
{
  const int side = size + 1;
  std::vector<int> order(side * side * side);
  std::iota(order.begin(), order.end(), 0);
  if (numbering == Numbering::Parity)
  {
    std::stable_partition(order.begin(), order.end(),
      [=](int i) { return (i % side + i / side % side + i / side / side) % 2 == 0; });
  }
  else
  {
    // The standard fixes what the engine returns, not what std::shuffle makes of it.
    std::mt19937 random(5);
    for (std::size_t i = order.size() - 1; i > 0; --i)
    {
      std::swap(order[i], order[random() % (i + 1)]);
    }
  }
  TetMesh mesh;
  std::vector<Id> ids(order.size());
  for (const int i : order)
  {
    ids[i] = static_cast<Id>(mesh.Points.size());
    mesh.Points.push_back({ double(i % side), double(i / side % side), double(i / side / side) });
  }
  // Corners of the sides of a cube, in the order round each.
  constexpr int sides[6][4] = { { 0, 1, 3, 2 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 3, 7, 6 },
    { 0, 2, 6, 4 }, { 1, 3, 7, 5 } };
  for (int cube = 0; cube < size * size * size; ++cube)
  {
    const int x = cube % size;
    const int y = cube / size % size;
    const int z = cube / size / size;
    std::array<Id, 8> corners;
    for (int i = 0; i < 8; ++i)
    {
      corners[i] = ids[x + (i & 1) + side * (y + (i >> 1 & 1) + side * (z + (i >> 2)))];
    }
    const Id apex = *std::min_element(corners.begin(), corners.end());
    for (const int(&face)[4] : sides)
    {
      std::array<Id, 4> outline{ corners[face[0]], corners[face[1]], corners[face[2]],
        corners[face[3]] };
      std::rotate(outline.begin(), std::min_element(outline.begin(), outline.end()), outline.end());
      if (outline[0] != apex)
      {
        AddTetrahedron(mesh, { apex, outline[0], outline[1], outline[2] }, 2 * z >= size);
        AddTetrahedron(mesh, { apex, outline[0], outline[2], outline[3] }, 2 * z >= size);
      }
    }
  }
  EXPECT_TRUE(BuildNeighbors(mesh).IsOk());
  return mesh;
}

MeshCertificate Check(const TetMesh& mesh, const TriangleMesh* boundary = nullptr)
{
  MeshCertificate report;
  EXPECT_TRUE(CertifyMesh(mesh, boundary, {}, report).IsOk());
  return report;
}

SliverRemoverReport Remove(TetMesh& mesh, double target, double flatness = 1e-9)
{
  SliverRemoverOptions options;
  options.DihedralAngleTarget = target;
  options.FlatnessRatio = flatness;
  SliverRemoverReport report;
  const Status status = RemoveSlivers(mesh, options, {}, report);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return report;
}

/**
 * Two regions that meet in four points, coplanar but for a millionth: region 0 above has a flat
 * tetrahedron with two facets on the interface. All points but the uppermost lie on one sphere,
 * exactly.
 */
TetMesh MakeInterfaceSliver()
{
  TetMesh mesh;
  // h^2 + (h + 1)^2 is the square of the radius.
  const double h = 1e6;
  mesh.Points = { { h + 1, 0, h }, { -(h + 1), 0, h }, { 0, h, h + 1 }, { 0, -h, h + 1 },
    { 0, 0, 4 * h }, { h, 0, -(h + 1) } };
  AddTetrahedron(mesh, { 0, 1, 2, 3 }, 0);
  AddTetrahedron(mesh, { 2, 3, 0, 4 }, 0);
  AddTetrahedron(mesh, { 2, 3, 1, 4 }, 0);
  AddTetrahedron(mesh, { 0, 1, 2, 5 }, 1);
  AddTetrahedron(mesh, { 0, 1, 3, 5 }, 1);
  EXPECT_TRUE(BuildNeighbors(mesh).IsOk());
  return mesh;
}
/** All points are free; those of the boundary stay none the less. */
SliverRemoverReport RemoveWithMoves(
  TetMesh& mesh, double target, bool isQualityFirst = false, bool areBoundaryPointsFree = false)
{
  SliverRemoverOptions options;
  options.DihedralAngleTarget = target;
  options.IsFree.assign(mesh.Points.size(), 1);
  options.QualityBeforeDelaunay = isQualityFirst;
  options.AreBoundaryPointsFree = areBoundaryPointsFree;
  SliverRemoverReport report;
  const Status status = RemoveSlivers(mesh, options, {}, report);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return report;
}

/**
 * The Delaunay mesh of random points in the unit cube, with a hole in the middle and two regions:
 * its boundaries are ragged, their facets Delaunay and no more.
 */
TetMesh MakeRaggedMesh(std::mt19937& random, int size, bool isOnGrid)
{
  std::vector<Vec3> points;
  const auto draw = [&]
  { return isOnGrid ? double(random() % 9) : double(random()) / 536870912.0; };
  for (int i = 0; i < size; ++i)
  {
    const double x = draw();
    const double y = draw();
    points.push_back({ x, y, draw() });
  }
  return testing_core::MakeRegionMesh(points,
    [](const Vec3& center) {
      return Distance(center, { 4.0, 4.0, 4.0 }) <= 1.8 ? OutsideRegion : center.X < 4.0 ? 0 : 1;
    });
}

std::vector<char> FindBoundaryPoints(const TetMesh& mesh, const TriangleMesh& boundary)
{
  std::vector<char> isOnBoundary(mesh.Points.size(), 0);
  for (const TriangleIds& ids : boundary.Triangles)
  {
    for (const Id id : ids)
    {
      isOnBoundary[id] = 1;
    }
  }
  return isOnBoundary;
}

/** A regular octahedron around a point that is not in its center. */
TetMesh MakeOctahedron()
{
  TetMesh mesh;
  mesh.Points = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 },
    { 0.4, 0.3, 0.25 } };
  for (Id i = 0; i < 8; ++i)
  {
    AddTetrahedron(mesh, { i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2), 6 }, 0);
  }
  EXPECT_TRUE(BuildNeighbors(mesh).IsOk());
  return mesh;
}
} // namespace

TEST(SliverRemover, GridOfT6BecomesT5)
{
  for (const int size : { 1, 2, 5 })
  {
    TetMesh mesh = MakeGrid(size, Numbering::Parity);
    const TriangleMesh boundary = ExtractBoundary(mesh);
    const MeshCertificate before = Check(mesh, &boundary);
    ASSERT_TRUE(before.IsDelaunay()) << before.GetText();
    ASSERT_EQ(6 * size * size * size, before.Tetrahedra);
    EXPECT_NEAR(std::atan(std::sqrt(0.5)) * Degrees, before.SmallestDihedralAngle, 1e-12);

    const SliverRemoverReport report = Remove(mesh, 70.0);
    EXPECT_EQ(size * size * size, report.Flips);
    EXPECT_EQ(0, report.PeeledTetrahedra);
    EXPECT_EQ(before.SmallestDihedralAngle, report.SmallestDihedralAngleBefore);

    // The boundary and the interface are as they were.
    const MeshCertificate after = Check(mesh, &boundary);
    EXPECT_TRUE(after.IsDelaunay()) << after.GetText();
    EXPECT_EQ(5 * size * size * size, after.Tetrahedra);
    EXPECT_NEAR(std::atan(std::sqrt(2.0)) * Degrees, after.SmallestDihedralAngle, 1e-12);
    EXPECT_NEAR(after.SmallestDihedralAngle, report.SmallestDihedralAngleAfter, 1e-12);
    EXPECT_LE(after.LargestDihedralAngle, 90.0 + 1e-12);
    for (std::size_t i = 0; i < after.Regions.size(); ++i)
    {
      EXPECT_EQ(before.Regions[i].Region, after.Regions[i].Region);
      EXPECT_DOUBLE_EQ(before.Regions[i].Volume, after.Regions[i].Volume);
    }
    // Nothing is left to be done.
    EXPECT_EQ(0, Remove(mesh, 70.0).Flips);
  }
}

TEST(SliverRemover, MixedCellsImproveAndStayDelaunay)
{
  TetMesh mesh = MakeGrid(6, Numbering::Random);
  const TriangleMesh boundary = ExtractBoundary(mesh);
  const MeshCertificate before = Check(mesh, &boundary);
  ASSERT_TRUE(before.IsDelaunay()) << before.GetText();
  const auto countBad = [](const TetMesh& m)
  {
    return std::count_if(m.Tetrahedra.begin(), m.Tetrahedra.end(),
      [&](const TetrahedronIds& ids)
      {
        return GetSmallestDihedralAngle(
                 m.Points[ids[0]], m.Points[ids[1]], m.Points[ids[2]], m.Points[ids[3]]) < 44.0;
      });
  };
  const auto badBefore = countBad(mesh);
  TetMesh again = mesh;
  const SliverRemoverReport report = Remove(mesh, 50.0);
  EXPECT_GT(report.Flips, 0);
  EXPECT_GE(report.SmallestDihedralAngleAfter, report.SmallestDihedralAngleBefore);
  const MeshCertificate after = Check(mesh, &boundary);
  EXPECT_TRUE(after.IsDelaunay()) << after.GetText();
  EXPECT_LT(2 * countBad(mesh), badBefore);

  // The same input gives the same mesh.
  Remove(again, 50.0);
  EXPECT_EQ(again.Tetrahedra, mesh.Tetrahedra);
  EXPECT_EQ(again.Neighbors, mesh.Neighbors);
  EXPECT_EQ(again.Regions, mesh.Regions);
}

TEST(SliverRemover, TetrahedraAboveTheTargetAreLeftAlone)
{
  TetMesh mesh = MakeGrid(2, Numbering::Parity);
  const TetMesh before = mesh;
  EXPECT_EQ(0, Remove(mesh, 35.0).Flips);
  EXPECT_EQ(before.Tetrahedra, mesh.Tetrahedra);
  EXPECT_EQ(before.Neighbors, mesh.Neighbors);
  EXPECT_EQ(48, Remove(mesh, 36.0).Flips * 6);
}

TEST(SliverRemover, RegionsAreNotMixed)
{
  // The two outer tetrahedra of the three around the diagonal are another region: no flip.
  TetMesh mesh = MakeGrid(1, Numbering::Parity);
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    mesh.Regions[i] = static_cast<Id>(i);
  }
  EXPECT_EQ(0, Remove(mesh, 70.0).Flips);
  EXPECT_EQ(6u, mesh.Tetrahedra.size());
}

TEST(SliverRemover, OnlyCosphericalSetsAreFlipped)
{
  // Three tetrahedra around an edge, better replaced by two: all points on one sphere, or the edge
  // a little shorter, so that the three are the only Delaunay tetrahedralization.
  for (const double z : { -3.0, -2.99 })
  {
    TetMesh mesh;
    mesh.Points = { { 0, 0, z }, { 0, 0, 3 }, { 3, 0, 0 }, { -1, 2, 2 }, { -2, -2, 1 } };
    AddTetrahedron(mesh, { 0, 1, 2, 3 }, 0);
    AddTetrahedron(mesh, { 0, 1, 3, 4 }, 0);
    AddTetrahedron(mesh, { 0, 1, 4, 2 }, 0);
    ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
    const TriangleMesh boundary = ExtractBoundary(mesh);
    ASSERT_TRUE(Check(mesh, &boundary).IsDelaunay());
    const SliverRemoverReport report = Remove(mesh, 70.0);
    EXPECT_EQ(z == -3.0 ? 1 : 0, report.Flips);
    EXPECT_EQ(z == -3.0 ? 2u : 3u, mesh.Tetrahedra.size());
    EXPECT_TRUE(Check(mesh, &boundary).IsDelaunay());

    // Unless quality comes first.
    const SliverRemoverReport next = RemoveWithMoves(mesh, 70.0, true);
    EXPECT_EQ(z == -3.0 ? 0 : 1, next.Flips);
    EXPECT_EQ(2u, mesh.Tetrahedra.size());
    EXPECT_GT(next.SmallestDihedralAngleAfter, next.SmallestDihedralAngleBefore - 1e-9);
  }
}

TEST(SliverRemover, DiagonalOfCocircularPointsIsTurnedBetweenTwoSpheres)
{
  // Four points on a circle, an apex on each side on a sphere of its own. One of the two diagonals
  // is better; a 4-4 flip leads there.
  const std::array<Id, 4> circle{ 0, 1, 2, 3 };
  Id flips = 0;
  std::array<double, 2> angles{};
  for (int i = 0; i < 2; ++i)
  {
    TetMesh mesh;
    mesh.Points = { { 5, 0, 0 }, { 3, 4, 0 }, { -5, 0, 0 }, { 3, -4, 0 }, { 0, 0, 6 },
      { 0, 0, -7 } };
    for (const Id apex : { 4, 5 })
    {
      AddTetrahedron(mesh, { circle[i], circle[(i + 2) % 4], circle[i + 1], apex }, 0);
      AddTetrahedron(mesh, { circle[i], circle[(i + 2) % 4], circle[(i + 3) % 4], apex }, 0);
    }
    ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
    const TriangleMesh boundary = ExtractBoundary(mesh);
    ASSERT_TRUE(Check(mesh, &boundary).IsDelaunay());
    const SliverRemoverReport report = Remove(mesh, 70.0);
    flips += report.Flips;
    angles[i] = report.SmallestDihedralAngleAfter;
    EXPECT_EQ(4u, mesh.Tetrahedra.size());
    EXPECT_TRUE(Check(mesh, &boundary).IsDelaunay());
  }
  EXPECT_EQ(1, flips);
  EXPECT_NEAR(angles[0], angles[1], 1e-9);
}

TEST(SliverRemover, NoRemovalOfAnEdgeIsOverlooked)
{
  // Edges are searched where facets show cospherical points. Here all edges are tried.
  Id flips = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TetMesh mesh =
      testing_core::MakeHullMesh(testing_core::MakeRandomPoints(60, seed, seed % 2 ? 0.25 : 0.125));
    SliverRemoverOptions options;
    options.DihedralAngleTarget = 70.0;
    SliverRemoverReport report;
    do
    {
      ASSERT_TRUE(RemoveSlivers(mesh, options, {}, report).IsOk());
      flips += report.Flips;
    } while (report.Flips > 0);
    FlippableMesh flippable(mesh, options.DihedralAngleTarget);
    flippable.MeasureAngles(1);
    const FlipSearch search(flippable, false);
    for (Id t = 0; t < static_cast<Id>(mesh.Tetrahedra.size()); ++t)
    {
      for (int edge = 0; edge < 6 && flippable.GetAngle(t) < flippable.GetTarget(); ++edge)
      {
        Flip best;
        search.TryEdge(t, edge, best);
        EXPECT_TRUE(best.New.empty()) << t << ", " << edge;
      }
    }
  }
  EXPECT_GT(flips, 100);
}

TEST(SliverRemover, FlatTetrahedronOnTheOutsideIsPeeledOff)
{
  TetMesh mesh = MakeInterfaceSliver();
  mesh.Tetrahedra.resize(3);
  mesh.Regions.resize(3);
  ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
  EXPECT_LT(Check(mesh).SmallestDihedralAngle, 1e-3);

  // A stricter flatness, or a target that asks for less, leave it.
  TetMesh same = mesh;
  EXPECT_EQ(0, Remove(same, 15.0, 1e-9).PeeledTetrahedra);
  EXPECT_EQ(0, Remove(same, 0.0, 1e-6).PeeledTetrahedra);
  EXPECT_EQ(3u, same.Tetrahedra.size());

  const SliverRemoverReport report = Remove(mesh, 15.0, 1e-6);
  EXPECT_EQ(1, report.PeeledTetrahedra);
  EXPECT_EQ(0, report.Flips);
  const MeshCertificate check = Check(mesh);
  EXPECT_EQ(2, check.Tetrahedra);
  EXPECT_EQ(0,
    check.WrongNeighbors + check.GetCount(MeshFault::InvertedTetrahedron) +
      check.GetCount(MeshFault::FlatTetrahedron));
  EXPECT_EQ(0, check.GetCount(MeshFault::NonDelaunayTetrahedron));
  EXPECT_EQ(1, check.UnusedPoints) << "the lowest point, which had no tetrahedron before either";
  EXPECT_GT(check.SmallestDihedralAngle, 15.0);
}

TEST(SliverRemover, PeelingLeavesNoGapAndNoPinch)
{
  // Another tetrahedron at the outer edge, on the far side of the outside: a gap would open.
  TetMesh mesh = MakeInterfaceSliver();
  mesh.Tetrahedra.resize(3);
  mesh.Regions.resize(3);
  mesh.Points.push_back({ 0, 1e6, -1e6 });
  mesh.Points.push_back({ 0, -1e6, -1e6 });
  AddTetrahedron(mesh, { 0, 1, 6, 7 }, 0);
  ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
  EXPECT_EQ(0, Remove(mesh, 15.0, 1e-6).PeeledTetrahedra);

  // The inner edge on the border too: the border would touch itself.
  mesh = MakeInterfaceSliver();
  mesh.Tetrahedra.resize(2);
  mesh.Regions.resize(2);
  ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
  EXPECT_EQ(0, Remove(mesh, 15.0, 1e-6).PeeledTetrahedra);
}

TEST(SliverRemover, FlatTetrahedronOnAnInterfaceVanishesInTheOtherRegion)
{
  TetMesh mesh = MakeInterfaceSliver();
  const MeshCertificate before = Check(mesh);
  ASSERT_TRUE(before.IsDelaunay()) << before.GetText();
  EXPECT_LT(before.SmallestDihedralAngle, 1e-3);
  const SliverRemoverReport report = Remove(mesh, 15.0, 1e-6);
  EXPECT_EQ(1, report.PeeledTetrahedra);
  EXPECT_EQ(1, report.Flips);
  const MeshCertificate after = Check(mesh);
  EXPECT_TRUE(after.IsDelaunay()) << after.GetText();
  EXPECT_EQ(4, after.Tetrahedra);
  EXPECT_GT(after.SmallestDihedralAngle, 15.0);
  EXPECT_EQ((RawVector<Id>{ 0, 0, 1, 1 }),
    [&]
    {
      RawVector<Id> regions = mesh.Regions;
      std::sort(regions.begin(), regions.end());
      return regions;
    }());
  const double total = before.Regions[0].Volume + before.Regions[1].Volume;
  EXPECT_NEAR(1.0, (after.Regions[0].Volume + after.Regions[1].Volume) / total, 1e-14);
  EXPECT_NEAR(1.0, after.Regions[1].Volume / before.Regions[1].Volume, 1e-5);

  // Where no flip makes it vanish it stays with its region: the lowest point off the sphere.
  mesh = MakeInterfaceSliver();
  mesh.Points[5] = { 1e6, 0, -1.1e6 };
  const TetMesh same = mesh;
  EXPECT_EQ(0, Remove(mesh, 15.0, 1e-6).PeeledTetrahedra);
  EXPECT_EQ(same.Regions, mesh.Regions);
  EXPECT_EQ(same.Tetrahedra, mesh.Tetrahedra);
}

TEST(SliverRemover, FreePointIsSmoothedToTheBestPlace)
{
  // The angle between a facet of an octahedron and the plane through its center and an edge.
  const double best = std::atan(std::sqrt(2.0)) * Degrees;
  TetMesh mesh = MakeOctahedron();
  const TriangleMesh boundary = ExtractBoundary(mesh);
  ASSERT_TRUE(Check(mesh, &boundary).IsDelaunay());
  TetMesh same = mesh;
  const SliverRemoverReport report = RemoveWithMoves(mesh, 50.0, true);
  EXPECT_LT(report.SmallestDihedralAngleBefore, 35.0);
  EXPECT_EQ(1, report.MovedPoints);
  EXPECT_EQ(0, report.Flips);
  EXPECT_NEAR(best, report.SmallestDihedralAngleAfter, 1e-6);
  EXPECT_LT(Norm(mesh.Points[6]), 1e-12);
  EXPECT_TRUE(Check(mesh, &boundary).IsDelaunay());

  // There it lies in the smallest spheres of all facets: Delaunay meshes keep those that are empty.
  const MeshCertificate before = Check(same, &boundary);
  RemoveWithMoves(same, 50.0);
  EXPECT_LE(Check(same, &boundary).GetCount(MeshFault::FacetSphere),
    before.GetCount(MeshFault::FacetSphere));
}

TEST(SliverRemover, SliversOfDisturbedGridsVanishByMoves)
{
  // A block of cubes, whose inner points are a little off: nearly cospherical sets everywhere.
  constexpr int size = 5;
  TetMesh block = MakeGrid(size, Numbering::Parity);
  block.Regions.assign(block.Regions.size(), 0);
  TriangleMesh surface = ExtractBoundary(block);
  RemoveUnusedPoints(surface);
  for (unsigned int seed = 1; seed <= 3; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto draw = [&] { return 0.1 * (double(random()) / 2147483648.0 - 1.0); };
    std::vector<Vec3> points;
    for (int i = 0; i < (size - 1) * (size - 1) * (size - 1); ++i)
    {
      const double x = 1 + i % (size - 1) + draw();
      const double y = 1 + i / (size - 1) % (size - 1) + draw();
      points.push_back({ x, y, 1 + i / (size - 1) / (size - 1) + draw() });
    }
    AdvancingFrontTetrahedralizerInput input;
    input.Surface = &surface;
    input.MeshPoints = &points;
    AdvancingFrontTetrahedralizerOutput output;
    ASSERT_TRUE(TetrahedralizeByAdvancingFront(input, {}, {}, output).IsOk());
    TetMesh& mesh = output.Mesh;
    const SliverRemoverReport report = RemoveWithMoves(mesh, 12.0);
    EXPECT_LT(report.SmallestDihedralAngleBefore, 2.0);
    EXPECT_GT(report.SmallestDihedralAngleAfter, 12.0);
    EXPECT_GT(report.MovedPoints, 0);
    const MeshCertificate check = Check(mesh, &output.Boundary);
    EXPECT_TRUE(check.IsDelaunay()) << check.GetText();
    EXPECT_EQ(0, check.GetCount(MeshFault::FacetSphere) + check.GetCount(MeshFault::EdgeSphere));
  }
}

TEST(SliverRemover, MovesKeepAnyBoundaryAndTheDelaunayProperty)
{
  std::array<Id, 2> moved{ 0, 0 };
  for (unsigned int seed = 1; seed <= 8; ++seed)
  {
    // Whole coordinates: many cospherical sets, some of which have been flipped before.
    for (const bool isOnGrid : { false, true })
    {
      const bool areAllFree = seed > 4;
      SCOPED_TRACE("seed " + std::to_string(seed) + (isOnGrid ? ", whole coordinates" : ""));
      std::mt19937 random(seed);
      TetMesh mesh = MakeRaggedMesh(random, 400, isOnGrid);
      if (isOnGrid)
      {
        EXPECT_GT(Remove(mesh, 40.0, 0.0).Flips, 0);
      }
      TetMesh again = mesh;
      const TriangleMesh boundary = ExtractBoundary(mesh);
      const MeshCertificate before = Check(mesh, &boundary);
      ASSERT_TRUE(before.IsDelaunay()) << before.GetText();
      EXPECT_GT(before.GetCount(MeshFault::FacetSphere), 0);
      const std::vector<Vec3> points = mesh.Points;

      const double target = isOnGrid ? 25.0 : 15.0;
      const SliverRemoverReport report = RemoveWithMoves(mesh, target, false, areAllFree);
      moved[isOnGrid] += report.MovedPoints;
      EXPECT_EQ(0, report.PeeledTetrahedra);
      const TriangleMesh now = ExtractBoundary(mesh);
      const MeshCertificate after = Check(mesh, areAllFree ? &now : &boundary);
      EXPECT_EQ(boundary.Triangles.size(), now.Triangles.size());
      EXPECT_TRUE(after.IsDelaunay()) << after.GetText();
      EXPECT_LE(after.GetCount(MeshFault::FacetSphere), before.GetCount(MeshFault::FacetSphere));
      EXPECT_LE(after.GetCount(MeshFault::EdgeSphere), before.GetCount(MeshFault::EdgeSphere));
      EXPECT_EQ(before.UnusedPoints, after.UnusedPoints);
      EXPECT_GE(after.SmallestDihedralAngle, before.SmallestDihedralAngle);
      const std::vector<char> isOnBoundary = FindBoundaryPoints(mesh, boundary);
      for (std::size_t p = 0; p < points.size(); ++p)
      {
        EXPECT_TRUE(!isOnBoundary[p] || areAllFree || points[p] == mesh.Points[p]);
      }

      // The same input gives the same mesh.
      RemoveWithMoves(again, target, false, areAllFree);
      EXPECT_EQ(again.Points, mesh.Points);
      EXPECT_EQ(again.Tetrahedra, mesh.Tetrahedra);
      EXPECT_EQ(again.Neighbors, mesh.Neighbors);
    }
  }
  EXPECT_GT(moved[0], 100);
  EXPECT_GT(moved[1], 10);
}

TEST(SliverRemover, PointsOfTheBoundaryAreMovedInTheirPlanesAndOnTheirLinesOnly)
{
  // Two layers of cubes, an interface between, whose points are off in their facets and on their
  // edges.
  constexpr int size = 2;
  Id moved = 0;
  std::ptrdiff_t slivers[2] = { 0, 0 };
  for (unsigned int seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    TetMesh block = MakeGrid(size, Numbering::Parity);
    const auto isFixed = [](double x) { return x == 0.0 || x == double(size); };
    for (std::size_t t = 0; t < block.Tetrahedra.size(); ++t)
    {
      Vec3 center;
      for (const Id id : block.Tetrahedra[t])
      {
        center = center + 0.25 * block.Points[id];
      }
      block.Regions[t] = center.Z < 0.5 * size ? 0 : 1;
    }
    TriangleMesh surface = ExtractBoundary(block);
    RemoveUnusedPoints(surface);
    for (Vec3& point : surface.Points)
    {
      const bool isInterface = point.Z == 0.5 * size;
      for (int i = 0; i < 3; ++i)
      {
        const double draw = 0.25 * (double(random()) / 2147483648.0 - 1.0);
        point[i] += isFixed(point[i]) || (i == 2 && isInterface) ? 0.0 : draw;
      }
    }
    DelaunaySurfaceRefinerInput refinerInput;
    refinerInput.Surface = &surface;
    DelaunaySurfaceRefinerOptions refinerOptions;
    refinerOptions.Criterion = SurfaceCriterion::SmallestSphereAndEdges;
    DelaunaySurfaceRefinerOutput refined;
    ASSERT_TRUE(RefineDelaunaySurface(refinerInput, refinerOptions, {}, refined).IsOk());
    AdvancingFrontTetrahedralizerInput input;
    input.Surface = &refined.Surface;
    AdvancingFrontTetrahedralizerOutput output;
    ASSERT_TRUE(TetrahedralizeByAdvancingFront(input, {}, {}, output).IsOk());

    TetMesh mesh = output.Mesh;
    RemoveWithMoves(mesh, 15.0);
    EXPECT_EQ(mesh.Points, output.Mesh.Points);
    slivers[0] += Check(mesh).Under15Degrees.Count;
    RemoveWithMoves(mesh, 15.0, false, true);
    slivers[1] += Check(mesh).Under15Degrees.Count;

    const TriangleMesh boundary = ExtractBoundary(mesh);
    EXPECT_EQ(boundary.Triangles.size(), output.Boundary.Triangles.size());
    const MeshCertificate before = Check(output.Mesh, &output.Boundary);
    const MeshCertificate after = Check(mesh, &boundary);
    EXPECT_TRUE(after.IsDelaunay()) << after.GetText();
    EXPECT_EQ(before.GetCount(MeshFault::FacetSphere), 0);
    EXPECT_EQ(after.GetCount(MeshFault::FacetSphere), 0);
    EXPECT_LE(after.GetCount(MeshFault::EdgeSphere), before.GetCount(MeshFault::EdgeSphere));
    for (std::size_t i = 0; i < 2; ++i)
    {
      EXPECT_NEAR(before.Regions[i].Volume, after.Regions[i].Volume, 1e-12);
    }
    for (std::size_t p = 0; p < mesh.Points.size(); ++p)
    {
      const Vec3& old = output.Mesh.Points[p];
      moved += mesh.Points[p] != old;
      for (int i = 0; i < 3; ++i)
      {
        const bool isInterface = i == 2 && old.Z == 0.5 * size;
        EXPECT_TRUE(mesh.Points[p][i] == old[i] || !(isFixed(old[i]) || isInterface));
      }
    }
  }
  std::printf("%td slivers, %td after %d moves\n", slivers[0], slivers[1], moved);
  EXPECT_GT(moved, 20);
  EXPECT_LT(slivers[1], slivers[0] / 2);
}

TEST(SliverRemover, OnlyFreePointsAreMoved)
{
  std::mt19937 random(7);
  TetMesh mesh = MakeRaggedMesh(random, 400, false);
  const TetMesh before = mesh;
  SliverRemoverOptions options;
  options.IsFree.assign(mesh.Points.size(), 0);
  SliverRemoverReport report;
  ASSERT_TRUE(RemoveSlivers(mesh, options, {}, report).IsOk());
  EXPECT_EQ(0, report.MovedPoints);
  EXPECT_EQ(before.Points, mesh.Points);
  EXPECT_EQ(before.Tetrahedra, mesh.Tetrahedra);

  for (std::size_t p = 0; p < mesh.Points.size(); p += 2)
  {
    options.IsFree[p] = 1;
  }
  for (const bool isQualityFirst : { false, true })
  {
    mesh = before;
    options.QualityBeforeDelaunay = isQualityFirst;
    ASSERT_TRUE(RemoveSlivers(mesh, options, {}, report).IsOk());
    EXPECT_GT(report.MovedPoints, 0);
    for (std::size_t p = 1; p < mesh.Points.size(); p += 2)
    {
      EXPECT_EQ(before.Points[p], mesh.Points[p]);
    }
  }

  options.IsFree.pop_back();
  EXPECT_EQ(StatusCode::InvalidInput, RemoveSlivers(mesh, options, {}, report).Code);
}

TEST(SliverRemover, QualityBeforeDelaunayKeepsTheRegions)
{
  for (unsigned int seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const TetMesh input = MakeRaggedMesh(random, 400, false);
    const TriangleMesh boundary = ExtractBoundary(input);
    TetMesh delaunay = input;
    RemoveWithMoves(delaunay, 15.0);
    TetMesh mesh = input;
    const SliverRemoverReport report = RemoveWithMoves(mesh, 15.0, true);
    EXPECT_GT(report.Flips, 0);
    EXPECT_GT(report.MovedPoints, 0);
    EXPECT_GE(report.SmallestDihedralAngleAfter, report.SmallestDihedralAngleBefore);
    EXPECT_LT(Check(mesh).Under15Degrees.Count, Check(input).Under15Degrees.Count / 2);

    // All is as it was but the empty spheres.
    MeshCertificate check = Check(mesh, &boundary);
    EXPECT_GT(check.GetCount(MeshFault::NonDelaunayTetrahedron), 0);
    check.GetCount(MeshFault::NonDelaunayTetrahedron) = 0;
    EXPECT_TRUE(check.IsDelaunay()) << check.GetText();

    // Moves in such a mesh do no harm either.
    RemoveWithMoves(mesh, 20.0);
    check = Check(mesh, &boundary);
    check.GetCount(MeshFault::NonDelaunayTetrahedron) = 0;
    EXPECT_TRUE(check.IsDelaunay()) << check.GetText();
  }
}

TEST(SliverRemover, BadInputIsNamedAndLeftAlone)
{
  TetMesh mesh = MakeGrid(1, Numbering::Parity);
  std::swap(mesh.Tetrahedra[2][0], mesh.Tetrahedra[2][1]);
  ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
  const TetMesh before = mesh;
  SliverRemoverReport report;
  Status status = RemoveSlivers(mesh, {}, {}, report);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ((std::vector<Id>{ 2 }), status.Cells);
  EXPECT_EQ(before.Tetrahedra, mesh.Tetrahedra);

  mesh = MakeGrid(1, Numbering::Parity);
  mesh.Neighbors.pop_back();
  EXPECT_EQ(StatusCode::InvalidInput, RemoveSlivers(mesh, {}, {}, report).Code);

  mesh = MakeGrid(1, Numbering::Parity);
  mesh.Neighbors[3] = { 1, 2, 3, 99 };
  EXPECT_EQ(StatusCode::InvalidInput, RemoveSlivers(mesh, {}, {}, report).Code);
}

TEST(SliverRemover, EmptyMeshAndAbort)
{
  TetMesh mesh;
  const SliverRemoverReport empty = Remove(mesh, 15.0);
  EXPECT_EQ(0.0, empty.SmallestDihedralAngleBefore);
  EXPECT_EQ(0.0, empty.SmallestDihedralAngleAfter);

  mesh = MakeGrid(8, Numbering::Parity);
  const TriangleMesh boundary = ExtractBoundary(mesh);
  SliverRemoverOptions options;
  options.DihedralAngleTarget = 70.0;
  for (int patience = 0; patience < 5; ++patience)
  {
    int calls = 0;
    SliverRemoverReport report;
    const ExecutionContext context({}, [&] { return calls++ >= patience; });
    EXPECT_TRUE(RemoveSlivers(mesh, options, context, report).IsAborted());
    EXPECT_TRUE(Check(mesh, &boundary).IsDelaunay());
  }

  // Also while points are moved.
  std::mt19937 random(3);
  const TetMesh ragged = MakeRaggedMesh(random, 400, false);
  const TriangleMesh raggedBoundary = ExtractBoundary(ragged);
  options.DihedralAngleTarget = 15.0;
  options.IsFree.assign(ragged.Points.size(), 1);
  Id moved = 0;
  for (int patience = 0; patience < 12; ++patience)
  {
    mesh = ragged;
    int calls = 0;
    SliverRemoverReport report;
    const ExecutionContext context({}, [&] { return calls++ >= patience; });
    EXPECT_TRUE(RemoveSlivers(mesh, options, context, report).IsAborted());
    EXPECT_TRUE(Check(mesh, &raggedBoundary).IsDelaunay());
    moved += report.MovedPoints;
  }
  EXPECT_GT(moved, 0);
}
