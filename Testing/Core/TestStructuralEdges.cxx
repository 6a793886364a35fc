// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StructuralEdges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

using namespace cdm;

namespace
{
constexpr double Degrees = 57.29577951308232;

/** Two triangles of each side of the unit cube; x is the lowest bit of a point's number. */
TriangleMesh MakeCube()
{
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i)
  {
    cube.Points.push_back({ double(i & 1), double((i >> 1) & 1), double(i >> 2) });
  }
  cube.Triangles = { { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 },
    { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } };
  return cube;
}

/** A strip of two triangles over the edge (0,0,0)-(0,1,0) that bends up by an angle. */
TriangleMesh MakeHinge(double bend)
{
  TriangleMesh hinge;
  hinge.Points = { { 0, 0, 0 }, { 0, 1, 0 }, { -1, 0.5, 0 },
    { std::cos(bend / Degrees), 0.5, std::sin(bend / Degrees) } };
  hinge.Triangles = { { 0, 1, 2 }, { 1, 0, 3 } };
  return hinge;
}

StructuralEdgesOutput Extract(
  const TriangleMesh& surface, const StructuralEdgeOptions& options = {})
{
  StructuralEdgesOutput output;
  const Status status = ExtractStructuralEdges(surface, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}

const StructuralEdge* Find(const StructuralEdgesOutput& output, Id a, Id b)
{
  for (const StructuralEdge& edge : output.Edges)
  {
    if (edge.Points == EdgeIds{ a, b })
    {
      return &edge;
    }
  }
  return nullptr;
}
} // namespace

TEST(StructuralEdges, CubeHasItsTwelveEdgesEachAChain)
{
  const auto output = Extract(MakeCube());
  ASSERT_EQ(12u, output.Edges.size());
  EXPECT_EQ(8u, output.Corners.size());
  EXPECT_EQ(12, output.NumberOfChains);
  std::set<Id> chains;
  for (std::size_t i = 0; i < output.Edges.size(); ++i)
  {
    const StructuralEdge& edge = output.Edges[i];
    EXPECT_EQ(StructuralEdgeKind::Sharp, edge.Kind);
    EXPECT_NEAR(90.0, edge.DihedralAngle, 1e-12);
    EXPECT_LT(edge.Points[0], edge.Points[1]);
    EXPECT_TRUE(i == 0 || output.Edges[i - 1].Points < edge.Points);
    chains.insert(edge.Chain);
  }
  EXPECT_EQ(12u, chains.size());
  EXPECT_EQ(0, *chains.begin());
  EXPECT_EQ(11, *chains.rbegin());
}

TEST(StructuralEdges, OrientationOfTrianglesDoesNotMatter)
{
  TriangleMesh cube = MakeCube();
  for (std::size_t i = 0; i < cube.Triangles.size(); i += 2)
  {
    std::swap(cube.Triangles[i][1], cube.Triangles[i][2]);
  }
  const auto output = Extract(cube);
  EXPECT_EQ(12u, output.Edges.size());
}

TEST(StructuralEdges, AccuracyAngleDecides)
{
  StructuralEdgeOptions options;
  options.AccuracyAngle = 10.0;
  EXPECT_EQ(nullptr, Find(Extract(MakeHinge(9.999), options), 0, 1));
  EXPECT_EQ(nullptr, Find(Extract(MakeHinge(-9.999), options), 0, 1));
  const auto output = Extract(MakeHinge(10.001), options);
  ASSERT_NE(nullptr, Find(output, 0, 1));
  EXPECT_NEAR(169.999, Find(output, 0, 1)->DihedralAngle, 1e-9);
  EXPECT_NE(nullptr, Find(Extract(MakeHinge(-10.001), options), 0, 1));
  // Without an accuracy angle only what is flat within the rounding of coordinates is smooth.
  EXPECT_EQ(nullptr, Find(Extract(MakeHinge(1e-7)), 0, 1));
  EXPECT_NE(nullptr, Find(Extract(MakeHinge(1e-3)), 0, 1));
  options.AccuracyAngle = 180.0;
  EXPECT_EQ(4u, Extract(MakeHinge(179.0), options).Edges.size());
}

TEST(StructuralEdges, OpenEdgesFormAClosedChain)
{
  const auto output = Extract(MakeHinge(0.0));
  ASSERT_EQ(4u, output.Edges.size());
  EXPECT_EQ(1, output.NumberOfChains);
  EXPECT_TRUE(output.Corners.empty());
  for (const StructuralEdge& edge : output.Edges)
  {
    EXPECT_EQ(StructuralEdgeKind::Open, edge.Kind);
    EXPECT_EQ(-1.0, edge.DihedralAngle);
    EXPECT_EQ(0, edge.Chain);
  }
}

TEST(StructuralEdges, ChainsRunFromCornerToCornerThenClosedOnes)
{
  // A hinge with a subdivided fold would be enough for corners; the separate triangle is a closed
  // chain with smaller ids, numbered after those with corners.
  TriangleMesh surface;
  surface.Points = { { 9, 0, 0 }, { 9, 1, 0 }, { 9, 0, 1 }, //
    { 0, 0, 0 }, { 0, 1, 0 }, { 0, 2, 0 },                  //
    { -1, 1, 0 }, { 0, 1, 1 } };
  surface.Triangles = { { 0, 1, 2 }, { 3, 4, 6 }, { 4, 5, 6 }, { 4, 3, 7 }, { 5, 4, 7 } };
  const auto output = Extract(surface);
  EXPECT_EQ((std::vector<Id>{ 3, 5 }), output.Corners);
  EXPECT_EQ(4, output.NumberOfChains);
  EXPECT_EQ(0, Find(output, 3, 4)->Chain);
  EXPECT_EQ(0, Find(output, 4, 5)->Chain);
  EXPECT_EQ(1, Find(output, 3, 6)->Chain);
  EXPECT_EQ(1, Find(output, 5, 6)->Chain);
  EXPECT_EQ(2, Find(output, 3, 7)->Chain);
  EXPECT_EQ(3, Find(output, 0, 1)->Chain);
  EXPECT_EQ(3, Find(output, 1, 2)->Chain);
}

TEST(StructuralEdges, NonManifoldEdgeHasItsSmallestAngle)
{
  const auto findSmallestAngle = [](const std::vector<double>& angles)
  {
    TriangleMesh fan;
    fan.Points = { { 0, 0, 0 }, { 0, 0, 1 } };
    for (const double angle : angles)
    {
      fan.Triangles.push_back({ 0, 1, static_cast<Id>(fan.Points.size()) });
      fan.Points.push_back({ std::cos(angle / Degrees), std::sin(angle / Degrees), 0.5 });
    }
    const auto output = Extract(fan);
    const StructuralEdge* edge = Find(output, 0, 1);
    EXPECT_NE(nullptr, edge);
    EXPECT_EQ(StructuralEdgeKind::NonManifold, edge->Kind);
    return edge->DihedralAngle;
  };
  EXPECT_NEAR(20.0, findSmallestAngle({ 10.0, 350.0, 130.0, 200.0 }), 1e-12);
  // Whichever triangle comes first, and on both sides of the half turn.
  EXPECT_NEAR(15.0, findSmallestAngle({ 0.0, 175.0, 190.0 }), 1e-12);
  EXPECT_NEAR(15.0, findSmallestAngle({ 175.0, 190.0, 0.0 }), 1e-12);
}

TEST(StructuralEdges, LabelsAreComparedInOneOrientation)
{
  TriangleMesh hinge = MakeHinge(0.0);
  hinge.Labels = { { 1, 2 }, { 1, 2 } };
  EXPECT_EQ(4u, Extract(hinge).Edges.size());

  hinge.Labels[1] = { 1, 3 };
  const auto output = Extract(hinge);
  ASSERT_NE(nullptr, Find(output, 0, 1));
  EXPECT_EQ(StructuralEdgeKind::LabelChange, Find(output, 0, 1)->Kind);
  EXPECT_NEAR(180.0, Find(output, 0, 1)->DihedralAngle, 1e-12);

  std::swap(hinge.Triangles[1][0], hinge.Triangles[1][1]);
  hinge.Labels[1] = { 2, 1 };
  EXPECT_EQ(4u, Extract(hinge).Edges.size());
  hinge.Labels[1] = { 1, 2 };
  EXPECT_EQ(5u, Extract(hinge).Edges.size());
}

TEST(StructuralEdges, NeedlesAreJudgedByTheirPlanes)
{
  // Heights of 1e-9 over an edge of length one, far from the origin in units of the height.
  const Vec3 a{ 0.5, 0.5, 0.5 };
  const Vec3 b{ 0.5, 1.5, 0.5 };
  const double h = std::ldexp(1.0, -30);
  const Vec3 c{ 0.5 - h, 1.0, 0.5 };
  EXPECT_TRUE(IsSmoothEdge(a, b, c, { 0.5 + h, 1.0, 0.5 }, 0.0, 0.0));
  EXPECT_FALSE(IsSmoothEdge(a, b, c, { 0.5, 1.0, 0.5 + h }, 89.9, 1.0));
  EXPECT_TRUE(IsSmoothEdge(a, b, c, { 0.5, 1.0, 0.5 + h }, 90.1, 0.0));
  // Folded back onto itself is not flat.
  EXPECT_FALSE(IsSmoothEdge(a, b, c, { 0.5 - 2 * h, 1.0, 0.5 }, 90.0, 1.0));
  // A skew long edge: only the exact differences keep the needle's plane.
  const Vec3 e{ 1.0 / 3.0, 1.0 / 7.0, 1.0 / 11.0 };
  const Vec3 f{ 4.0 / 3.0, 8.0 / 7.0, 12.0 / 11.0 };
  EXPECT_TRUE(IsSmoothEdge(
    e, f, e + Vec3{ 0.5, 0.5, 0.5 + 1e-6 }, e + Vec3{ 0.25, 0.25, 0.25 - 1e-6 }, 1e-3, 0.0));
}

TEST(StructuralEdges, FlatnessNeedsBothVerticesNearAndLessThanADegree)
{
  const Vec3 a{ 0, 0, 0 };
  const Vec3 b{ 0, 1, 0 };
  const double bend = 0.5 / Degrees;
  const Vec3 near{ 0.01 * std::cos(bend), 0.5, 0.01 * std::sin(bend) };
  EXPECT_TRUE(IsSmoothEdge(a, b, { -0.01, 0.5, 0 }, near, 0.0, 1e-4));
  EXPECT_FALSE(IsSmoothEdge(a, b, { -1.0, 0.5, 0 }, near, 0.0, 1e-4));
  EXPECT_FALSE(IsSmoothEdge(a, b, { -0.01, 0.5, 0 }, { 0.01, 0.5, 0.0002 }, 0.0, 1.0));
  // Without area there is no plane.
  EXPECT_FALSE(IsSmoothEdge(a, b, { 0, 0.5, 0 }, near, 90.0, 1.0));
}

TEST(StructuralEdges, FacetsAreKeptWhereTrianglesAreSmall)
{
  // The hinge bends by half a degree, and is small beside the triangle far away.
  TriangleMesh surface = MakeHinge(0.5);
  surface.Points.insert(surface.Points.end(), { { 1e9, 0, 0 }, { 1e9, 1, 0 }, { 1e9, 0, 1 } });
  surface.Triangles.push_back({ 4, 5, 6 });
  const StructuralEdgesOutput lost = Extract(surface);
  EXPECT_EQ(lost.Edges.size(), 7u);
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
  EXPECT_EQ(NumberFacets(uses, lost.Edges), (std::vector<Id>{ 0, 0, 1 }));
  StructuralEdgeOptions options;
  options.Facets = { 5, 3, 3 };
  const StructuralEdgesOutput kept = Extract(surface, options);
  EXPECT_EQ(kept.Edges.size(), 8u);
  const StructuralEdge* const edge = Find(kept, 0, 1);
  ASSERT_NE(edge, nullptr);
  EXPECT_EQ(edge->Kind, StructuralEdgeKind::Sharp);
  EXPECT_NEAR(edge->DihedralAngle, 179.5, 1e-9);
  EXPECT_EQ(NumberFacets(uses, kept.Edges), (std::vector<Id>{ 0, 1, 2 }));
}

TEST(StructuralEdges, TinyAndHugeModelsAreJudgedAlike)
{
  for (const double scale : { 1e-120, 1e-9, 1e9, 1e120 })
  {
    TriangleMesh cube = MakeCube();
    for (Vec3& point : cube.Points)
    {
      point = scale * point;
    }
    EXPECT_EQ(12u, Extract(cube).Edges.size()) << scale;
  }
}

/** Rounding bends the diagonals of its sides by more than 1e-9 of the cube from 1e7 on. */
TEST(StructuralEdges, DiagonalsAreSmoothFarFromTheOrigin)
{
  for (const double distance : { 0.0, 1e6, 1e7, 1e8, 1e9 })
  {
    SCOPED_TRACE(distance);
    TriangleMesh cube = MakeCube();
    for (Vec3& p : cube.Points)
    {
      // A rotation by the columns of an orthogonal matrix.
      p = p.X * Vec3{ 2.0 / 3, 2.0 / 3, 1.0 / 3 } + p.Y * Vec3{ -2.0 / 3, 1.0 / 3, 2.0 / 3 } +
        p.Z * Vec3{ 1.0 / 3, -2.0 / 3, 2.0 / 3 } + Vec3{ distance, 0.7 * distance, -distance };
    }
    StructuralEdgesOutput output;
    ASSERT_TRUE(ExtractStructuralEdges(cube, {}, {}, output).IsOk());
    EXPECT_EQ(output.Edges.size(), 12u);
  }
}

TEST(StructuralEdges, BoundingBoxDiagonal)
{
  EXPECT_EQ(0.0, GetBoundingBoxDiagonal({}));
  EXPECT_EQ(0.0, GetBoundingBoxDiagonal({ { 3, 4, 5 } }));
  EXPECT_DOUBLE_EQ(std::sqrt(3.0), GetBoundingBoxDiagonal(MakeCube().Points));
}

TEST(StructuralEdges, BadInputIsNamed)
{
  StructuralEdgesOutput output;
  TriangleMesh cube = MakeCube();
  cube.Triangles[3] = { 4, 4, 6 };
  cube.Triangles[7] = { 2, 7, 8 };
  Status status = ExtractStructuralEdges(cube, {}, {}, output);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ((std::vector<Id>{ 3, 7 }), status.Cells);
  EXPECT_TRUE(output.Edges.empty());

  cube = MakeCube();
  cube.Points[5].Y = std::numeric_limits<double>::quiet_NaN();
  status = ExtractStructuralEdges(cube, {}, {}, output);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ((std::vector<Id>{ 5 }), status.Points);

  cube = MakeCube();
  cube.Labels.resize(3);
  EXPECT_EQ(StatusCode::InvalidInput, ExtractStructuralEdges(cube, {}, {}, output).Code);
  EXPECT_TRUE(Extract({}).Edges.empty());
}

TEST(StructuralEdges, AbortLeavesNothing)
{
  StructuralEdgesOutput output;
  const ExecutionContext context({}, [] { return true; });
  EXPECT_TRUE(ExtractStructuralEdges(MakeCube(), {}, context, output).IsAborted());
  EXPECT_TRUE(output.Edges.empty());
}
