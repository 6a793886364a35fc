// SPDX-License-Identifier: BSD-3-Clause
#include "HullMeshes.h"

#include "Core/Certificate/MeshCertificate.h"
#include "Core/Certificate/SphereCriteria.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace cdm;
using namespace testing_core;

namespace
{
/** Alternate corners of the cube [-1, 1]^3, positive. */
const Vec3 A{ -1, -1, -1 };
const Vec3 B{ 1, 1, -1 };
const Vec3 C{ -1, 1, 1 };
const Vec3 D{ 1, -1, 1 };

TetMesh MakeMesh(std::vector<Vec3> points, RawVector<TetrahedronIds> tetrahedra)
{
  TetMesh mesh;
  mesh.Points = std::move(points);
  mesh.Tetrahedra = std::move(tetrahedra);
  mesh.Regions.assign(mesh.Tetrahedra.size(), 0);
  return mesh;
}

MeshCertificate Evaluate(const TetMesh& mesh, int threads = 2)
{
  MeshCertificate report;
  const Status status =
    CertifyMesh(mesh, nullptr, ExecutionContext(threads), report, FullCertificate);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return report;
}
} // namespace

TEST(FullCriteria, QualityOfTheRegularTetrahedron)
{
  const TetrahedronQuality quality = GetTetrahedronQuality(A, B, C, D);
  // Edge sqrt(8), R = sqrt(3), r = R / 3, V = 8 / 3.
  EXPECT_NEAR(std::sqrt(8.0 / 3.0), quality.Q[0], 1e-15);
  EXPECT_NEAR(std::sqrt(3.0) / 3.0 / std::sqrt(8.0), quality.Q[1], 1e-15);
  EXPECT_NEAR(1.0 / 3.0, quality.Q[2], 1e-15);
  EXPECT_NEAR(1.0, quality.Q[3], 1e-15);
  EXPECT_NEAR(8.0 / 3.0 / std::pow(8.0, 1.5), quality.Q[4], 1e-15);
  EXPECT_NEAR(std::sqrt(3.0 / 8.0), quality.RadiusEdgeRatio, 1e-15);
  EXPECT_NEAR(3.0, quality.AspectRatio, 1e-14);
  EXPECT_NEAR(std::acos(1.0 / 3.0) * 180.0 / std::acos(-1.0), quality.SmallestDihedralAngle, 1e-12);
  EXPECT_NEAR(quality.SmallestDihedralAngle, quality.LargestDihedralAngle, 1e-12);
}

/** A volume below 1e-10 of the median is said in the first line, before anything else. */
TEST(FullCriteria, SaysTinyTetrahedraInTheFirstLine)
{
  for (const double height : { 1e-9, 1e-11 })
  {
    std::vector<Vec3> points;
    RawVector<TetrahedronIds> tetrahedra;
    for (const double h : { 1.0, 1.0, height })
    {
      const Id first = static_cast<Id>(points.size());
      const double x = 10.0 * first;
      for (const Vec3& point :
        { Vec3{ x, 0.0, 0.0 }, Vec3{ x + 1.0, 0.0, 0.0 }, Vec3{ x, 1.0, 0.0 }, Vec3{ x, 0.0, h } })
      {
        points.push_back(point);
      }
      tetrahedra.push_back({ first, first + 1, first + 2, first + 3 });
    }
    const MeshCertificate report = Evaluate(MakeMesh(points, tetrahedra));
    EXPECT_NEAR(report.SmallestVolumeRatio, height, 1e-6 * height);
    const std::string text = report.GetText();
    EXPECT_EQ(text.find(", but the smallest tetrahedron has 1e-11 of the median volume\n") ==
        std::string(report.GetVerdictName()).size(),
      height < MeshCertificate::TinyVolumeRatio)
      << text;
  }
}

/** Closed forms of what solvers compute that add up boxes without the signs of their parts. */
TEST(FullCriteria, UnsignedBoxes)
{
  EXPECT_NEAR(1.0, GetTetrahedronQuality(A, B, C, D).UnsignedBoxRatio, 1e-15) << "center inside";
  EXPECT_NEAR(2.0,
    GetTetrahedronQuality({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }).UnsignedBoxRatio,
    1e-15);
  EXPECT_NEAR(1.0,
    GetTetrahedronQuality({ 0, 0, 0 }, { 1, 0, 0 }, { 1, 2, 0 }, { 1, 2, 3 }).UnsignedBoxRatio,
    1e-15)
    << "center on an edge";
  EXPECT_TRUE(std::isinf(
    GetTetrahedronQuality({ 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }).UnsignedBoxRatio));

  // The cube of five, where the four at its corners are twice as large as they should be; beside it
  // a region in which nothing is too large.
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.push_back({ double(i & 1), double((i >> 1) & 1), double((i >> 2) & 1) });
  }
  TetMesh mesh = MakeMesh(
    points, { { 0, 1, 2, 4 }, { 3, 2, 1, 7 }, { 5, 4, 7, 1 }, { 6, 7, 4, 2 }, { 1, 7, 2, 4 } });
  for (const Vec3& corner : { A, B, C, D })
  {
    mesh.Points.push_back(corner + Vec3{ 9, 0, 0 });
  }
  mesh.Tetrahedra.push_back({ 8, 9, 10, 11 });
  mesh.Regions.push_back(1);
  const MeshCertificate report = Evaluate(mesh);
  ASSERT_EQ(2u, report.Regions.size());
  EXPECT_NEAR(5.0 / 3.0, report.Regions[0].UnsignedBoxRatio, 1e-14);
  EXPECT_NEAR(1.0, report.Regions[1].UnsignedBoxRatio, 1e-14);
  EXPECT_EQ((std::vector<char>{ 1, 1, 1, 1, 0, 0 }), report.MakesUnsignedBoxesLarge);
  EXPECT_NE(std::string::npos, report.GetText().find("1.67 times as large in region 0"));
}

TEST(FullCriteria, QualityOfDegenerateTetrahedraIsTheWorst)
{
  const TetrahedronQuality flat =
    GetTetrahedronQuality({ 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 });
  EXPECT_EQ(0.0, flat.Q[0]);
  EXPECT_EQ(0.0, flat.Q[1]);
  EXPECT_EQ(0.0, flat.Q[2]);
  EXPECT_NEAR(std::sqrt(0.5), flat.Q[3], 1e-15);
  EXPECT_EQ(0.0, flat.Q[4]);
  EXPECT_TRUE(std::isinf(flat.AspectRatio));
  EXPECT_LT(GetTetrahedronQuality(B, A, C, D).Q[4], 0.0) << "inverted";
  const TetrahedronQuality point = GetTetrahedronQuality(A, A, A, A);
  for (const double q : point.Q)
  {
    EXPECT_EQ(0.0, q);
  }
}

/** The verdict comes first, in capitals, and its reason second. */
TEST(FullCriteria, VerdictsFromWorstToBest)
{
  // Two tetrahedra at one facet, the second apex at a height below it.
  const auto make = [](double height)
  {
    TetMesh mesh;
    mesh.Points = { { 0, 0, 0 }, { 4, 0, 0 }, { 2, 3, 0 }, { 2, 1, 3 }, { 2, 1, -height } };
    mesh.Tetrahedra = { { 0, 1, 2, 3 }, { 0, 2, 1, 4 } };
    mesh.Regions = { 0, 0 };
    return mesh;
  };
  const auto expect =
    [](const MeshCertificate& certificate, MeshVerdict verdict, const std::string& begin)
  {
    EXPECT_EQ(certificate.GetVerdict(), verdict) << certificate.GetText();
    EXPECT_EQ(certificate.GetText().find(begin), 0u) << certificate.GetText();
    const std::string text = certificate.GetText();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  };
  expect(Evaluate(make(3.0)), MeshVerdict::CleanForFiniteVolumes,
    "CLEAN FOR FINITE VOLUMES\nValid, all circumspheres are empty, no coupling");
  expect(Evaluate(make(0.1)), MeshVerdict::NotDelaunay,
    "NOT DELAUNAY\n2 of 2 (1e+02 %) tetrahedra have a point");
  expect(Evaluate(make(-1.0)), MeshVerdict::Invalid, "INVALID\n1 inverted tetrahedron");
  // Without looking at couplings nothing is called clean.
  MeshCertificate basic;
  ASSERT_TRUE(CertifyMesh(make(3.0), nullptr, {}, basic).IsOk());
  expect(basic, MeshVerdict::Delaunay, "DELAUNAY\nValid, all circumspheres are empty; the coup");
  EXPECT_TRUE(basic.IsDelaunay());
  EXPECT_FALSE(basic.IsClean());
  // An obtuse angle of a facet on the boundary: the coupling of the edge opposite is negative.
  TetMesh obtuse;
  obtuse.Points = { { -3, 0, 0 }, { 3, 0, 0 }, { 0, 1, 0 }, { 0, 0.5, 4 } };
  obtuse.Tetrahedra = { { 0, 1, 2, 3 } };
  obtuse.Regions = { 0 };
  expect(Evaluate(obtuse), MeshVerdict::Delaunay, "DELAUNAY\n");
  EXPECT_GT(Evaluate(obtuse).GetCount(MeshFault::NegativeCoupling), 0);
}

TEST(FullCriteria, RegularTetrahedronIsClean)
{
  const MeshCertificate report = Evaluate(MakeMesh({ A, B, C, D }, { { 0, 1, 2, 3 } }));
  EXPECT_TRUE(report.IsClean()) << report.GetText();
  EXPECT_TRUE(report.Violations.empty()) << report.GetText();
  EXPECT_EQ(4, report.Facets);
  EXPECT_EQ(4, report.BorderFacets);
  EXPECT_EQ(6, report.Edges);
  EXPECT_EQ(6, report.StructuralEdges);
  EXPECT_EQ(6, report.Couplings);
  ASSERT_EQ(1u, report.Regions.size());
  EXPECT_NEAR(8.0 / 3.0, report.Regions[0].Volume, 1e-15);
  EXPECT_NEAR(8.0 / 3.0, report.Regions[0].EnclosedVolume, 1e-15);
}

TEST(FullCriteria, EachFaultIsFound)
{
  const auto count = [](const MeshCertificate& report, MeshFault fault)
  { return report.GetCount(fault); };

  const MeshCertificate inverted = Evaluate(MakeMesh({ B, A, C, D }, { { 0, 1, 2, 3 } }));
  EXPECT_EQ(1, count(inverted, MeshFault::InvertedTetrahedron));
  EXPECT_EQ(0, count(inverted, MeshFault::NonDelaunayTetrahedron));
  EXPECT_FALSE(inverted.IsClean());

  const MeshCertificate flat =
    Evaluate(MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, { { 0, 1, 2, 3 } }));
  EXPECT_EQ(1, count(flat, MeshFault::FlatTetrahedron));
  EXPECT_EQ(0.0, flat.SmallestDihedralAngle);
  EXPECT_EQ(1, flat.Under5Degrees.Count);

  // A fifth point inside of the circumsphere, used by no tetrahedron; it is in no smallest sphere
  // of a facet or edge.
  const MeshCertificate disturbed =
    Evaluate(MakeMesh({ A, B, C, D, { 0, 0, 0.125 } }, { { 0, 1, 2, 3 } }));
  EXPECT_EQ(1, count(disturbed, MeshFault::NonDelaunayTetrahedron));
  EXPECT_EQ(0, count(disturbed, MeshFault::NonDelaunayFacet));

  // Three tetrahedra at a facet.
  const MeshCertificate overfull = Evaluate(MakeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.3, 1 }, { 0.3, 0.3, -1 }, { 0.2, 0.2, 2 } },
    { { 0, 1, 2, 3 }, { 0, 2, 1, 4 }, { 0, 1, 2, 5 } }));
  EXPECT_EQ(1, count(overfull, MeshFault::OverfullFacet));

  // Two flat-topped tetrahedra whose common facet is not Delaunay: 2-3 flip wanted.
  const MeshCertificate facet = Evaluate(
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.3, 0.1 }, { 0.3, 0.3, -0.1 } },
      { { 0, 1, 2, 3 }, { 0, 2, 1, 4 } }));
  EXPECT_EQ(2, count(facet, MeshFault::NonDelaunayTetrahedron));
  EXPECT_EQ(1, count(facet, MeshFault::NonDelaunayFacet));
  EXPECT_EQ(0, facet.Facets - 7);
  // The apices see the facet under obtuse angles: its edges have negative couplings.
  EXPECT_EQ(3, count(facet, MeshFault::NegativeCoupling));

  const MeshCertificate copies =
    Evaluate(MakeMesh({ A, B, C, D, A, B, C, { -1, -1, 1 } }, { { 0, 1, 2, 3 }, { 4, 5, 6, 7 } }));
  EXPECT_EQ(3, copies.CoincidentPoints);
  EXPECT_FALSE(copies.IsClean());
}

/**
 * A wedge of 41 degrees with random points inside and on its sides: a flat tetrahedron from side to side is at a
 * sharp angle, wherever it is. In a box of as many points none is.
 */
TEST(FullCriteria, FlatTetrahedraBetweenSidesOfAWedgeAreAtASharpAngle)
{
  constexpr double slope = 0.375;
  std::mt19937_64 generator(11);
  std::uniform_int_distribution<int> coordinate(1, 255);
  std::uniform_int_distribution<int> part(-63, 63);
  for (const bool isWedge : { true, false })
  {
    std::vector<Vec3> points;
    // Coordinates are short binary fractions: the points of a side lie exactly in its plane.
    const auto add = [&](double x, double sideways, double z) {
      points.push_back({ x, slope * (isWedge ? x : 2.0) * sideways, z });
    };
    for (const double z : { 0.0, 2.0 })
    {
      for (const double side : { -1.0, 1.0 })
      {
        add(4.0, side, z);
        if (!isWedge)
        {
          add(0.0, side, z);
        }
      }
      if (isWedge)
      {
        add(0.0, 0.0, z);
      }
    }
    for (int i = 0; i < 300; ++i)
    {
      const double sideways = i % 3 == 0 ? -1.0 : i % 3 == 1 ? 1.0 : part(generator) / 64.0;
      add(coordinate(generator) / 64.0, sideways, coordinate(generator) / 128.0);
    }
    const TetMesh mesh = MakeHullMesh(points);
    const auto isOnSide = [&](Id point, double side)
    {
      const Vec3& p = mesh.Points[point];
      return p[1] == slope * (isWedge ? p[0] : 2.0) * side;
    };
    Id flat = 0;
    Id between = 0;
    for (const TetrahedronIds& ids : mesh.Tetrahedra)
    {
      const auto [a, b, c, d] = GetCorners(mesh.Points, ids);
      const bool isFlat = GetSmallestDihedralAngle(a, b, c, d) < 15.0;
      const bool isBetween =
        std::any_of(ids.begin(), ids.end(), [&](Id p) { return isOnSide(p, -1.0); }) &&
        std::any_of(ids.begin(), ids.end(), [&](Id p) { return isOnSide(p, 1.0); });
      const bool isAtEdge = isWedge &&
        std::any_of(ids.begin(), ids.end(), [&](Id p) { return mesh.Points[p][0] == 0.0; });
      flat += isFlat ? 1 : 0;
      between += isFlat && (isBetween || isAtEdge) ? 1 : 0;
    }
    MeshCertificate certificate;
    ASSERT_TRUE(CertifyMesh(mesh, nullptr, {}, certificate).IsOk());
    EXPECT_EQ(certificate.Under15Degrees.Count, flat);
    EXPECT_EQ(certificate.Under15Degrees.AtSharpAngles, isWedge ? between : 0);
    EXPECT_GT(between, 20);
    EXPECT_GT(flat - between, 20);
  }
}

TEST(FullCriteria, SmallestSpheresOfTheBorder)
{
  // The top vertex lies inside of the smallest sphere of the bottom, exactly on it, outside.
  const auto evaluate = [](double height)
  {
    return Evaluate(
      MakeMesh({ { -4, -3, 0 }, { 4, -3, 0 }, { 0, 5, 0 }, { 0, 0, height } }, { { 0, 1, 2, 3 } }));
  };
  const double inside = std::nextafter(5.0, 0.0);
  EXPECT_EQ(1, evaluate(inside).GetCount(MeshFault::FacetSphere));
  EXPECT_EQ(1, evaluate(inside).GetCount(MeshFault::OpenControlVolume));
  EXPECT_EQ(0, evaluate(5.0).GetCount(MeshFault::FacetSphere));
  EXPECT_EQ(0, evaluate(5.0).GetCount(MeshFault::OpenControlVolume));
  EXPECT_EQ(0, evaluate(inside).GetCount(MeshFault::EdgeSphere));
  // The bottom edge (-4, -3), (4, -3): 3^2 + height^2 against 4^2; the two others, with the
  // midpoint (2, 1): 5 + height^2 against 20.
  EXPECT_EQ(0, evaluate(3.9).GetCount(MeshFault::EdgeSphere));
  EXPECT_EQ(2, evaluate(3.8).GetCount(MeshFault::EdgeSphere));
  EXPECT_EQ(2, evaluate(2.7).GetCount(MeshFault::EdgeSphere));
  EXPECT_EQ(3, evaluate(2.6).GetCount(MeshFault::EdgeSphere));
}

TEST(FullCriteria, VolumesAreThoseOfTheBoundary)
{
  const TetMesh mesh = MakeMesh({ A, B, C, D }, { { 0, 1, 2, 3 } });
  TriangleMesh boundary;
  boundary.Points = mesh.Points;
  for (int i = 0; i < 4; ++i)
  {
    boundary.Triangles.push_back(GetFacet(mesh.Tetrahedra[0], i));
    boundary.Labels.push_back({ OutsideRegion, 0 });
  }
  MeshCertificate report;
  ASSERT_TRUE(CertifyMesh(mesh, &boundary, {}, report, FullCertificate).IsOk());
  EXPECT_TRUE(report.IsClean());
  for (Vec3& point : boundary.Points)
  {
    point = 2.0 * point;
  }
  ASSERT_TRUE(CertifyMesh(mesh, &boundary, {}, report, FullCertificate).IsOk());
  EXPECT_NEAR(7.0 / 8.0, report.LargestVolumeError, 1e-15);
  EXPECT_FALSE(report.IsClean());
  boundary.Labels[2] = { OutsideRegion, 4 };
  ASSERT_TRUE(CertifyMesh(mesh, &boundary, {}, report, FullCertificate).IsOk());
  ASSERT_EQ(2u, report.Regions.size());
  EXPECT_EQ(4, report.Regions[1].Region);
  EXPECT_EQ(0, report.Regions[1].Tetrahedra);
}

TEST(FullCriteria, DelaunayMeshesHaveDelaunayFacetsAndNoNegativeInnerCouplings)
{
  for (const double rounding : { 0.0, 1.0 / 8.0 })
  {
    std::vector<Vec3> points = MakeRandomPoints(400, 7, rounding);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const TetMesh mesh = MakeHullMesh(points);
    const MeshCertificate report = Evaluate(mesh);
    EXPECT_EQ(0, report.GetCount(MeshFault::NonDelaunayTetrahedron));
    EXPECT_EQ(0, report.GetCount(MeshFault::NonDelaunayFacet));
    // Euler's formula for a ball of tetrahedra.
    EXPECT_EQ(
      1, static_cast<Id>(mesh.Points.size()) - report.Edges + report.Facets - report.Tetrahedra);
  }
}

TEST(FullCriteria, TrianglesAgainstAllSpheresOfThePencil)
{
  // A triangle is Delaunay if some sphere through it is empty: the smallest one, or that through
  // it and another point.
  int delaunay = 0;
  int other = 0;
  for (const double rounding : { 0.0, 1.0 / 4.0 })
  {
    const std::vector<Vec3> points = MakeRandomPoints(24, 11, rounding);
    const SphereCriteria criteria(points);
    for (Id i = 0; i < 24; ++i)
    {
      for (Id j = i + 1; j < 24; ++j)
      {
        for (Id k = j + 1; k < 24; ++k)
        {
          const Vec3& a = points[i];
          const Vec3& b = points[j];
          const Vec3& c = points[k];
          if (AreCollinear(a, b, c))
          {
            EXPECT_TRUE(criteria.IsDelaunay(TriangleIds{ i, j, k }));
            continue;
          }
          bool expected = criteria.HasEmptySmallestSphere(TriangleIds{ i, j, k });
          for (const Vec3& d : points)
          {
            const int side = Orientation(a, b, c, d);
            expected = expected ||
              (side != 0 &&
                std::none_of(points.begin(), points.end(),
                  [&](const Vec3& e) { return side * InSphere(a, b, c, d, e) > 0; }));
          }
          EXPECT_EQ(expected, criteria.IsDelaunay(TriangleIds{ i, j, k })) << i << j << k;
          ++(expected ? delaunay : other);
        }
      }
    }
  }
  EXPECT_GT(delaunay, 100);
  EXPECT_GT(other, 100);
}

TEST(FullCriteria, GridsAreCleanAndRoundingLeavesNoNegativeSums)
{
  const TetMesh grid = MakeHullMesh(MakeGrid(6, 0.1));
  const MeshCertificate straight = Evaluate(grid);
  EXPECT_TRUE(straight.IsClean()) << straight.GetText();
  EXPECT_TRUE(straight.Violations.empty()) << straight.GetText();
  EXPECT_EQ(3 * 25 * 6 * 2 / 3, straight.BorderFacets);
  EXPECT_EQ(12 * 5, straight.StructuralEdges) << "those of the cube";
  EXPECT_NEAR(0.125, straight.Regions[0].Volume, 1e-15);

  // The same tetrahedra on rotated and rounded points: hardly any is Delaunay in the exact sense,
  // but couplings and cotangent sums that are zero stay so to rounding.
  TetMesh rotated = grid;
  for (Vec3& point : rotated.Points)
  {
    point = { 0.6 * point.X - 0.8 * point.Y,
      0.28 * (0.8 * point.X + 0.6 * point.Y) - 0.96 * point.Z,
      0.96 * (0.8 * point.X + 0.6 * point.Y) + 0.28 * point.Z };
  }
  const MeshCertificate turned = Evaluate(rotated);
  EXPECT_GT(turned.GetCount(MeshFault::NonDelaunayTetrahedron), 100);
  EXPECT_EQ(0, turned.GetCount(MeshFault::NegativeCoupling));
  EXPECT_EQ(0, turned.GetCount(MeshFault::NegativeCotangentSum));
  EXPECT_NEAR(straight.SmallestDihedralAngle, turned.SmallestDihedralAngle, 1e-10);
}

TEST(FullCriteria, RoundingFarFromTheOriginLeavesNoNegativeCouplings)
{
  // Coordinates are rounded to 1e-10 of the edges, and the couplings of the diagonals are zero.
  const TetMesh grid = MakeHullMesh(MakeGrid(6, 1e-3));
  TetMesh far = grid;
  for (Vec3& point : far.Points)
  {
    point = Vec3{ 0.6 * point.X - 0.8 * point.Y, 0.8 * point.X + 0.6 * point.Y, point.Z } +
      Vec3{ 700.0, -900.0, 1100.0 };
  }
  EXPECT_EQ(0, Evaluate(far).GetCount(MeshFault::NegativeCoupling));

  // What is negative before is so there.
  TetMesh bad = grid;
  for (Vec3& point : bad.Points)
  {
    point.X *= point.Z < 1e-3 ? 1.0 : 1.0 + 1e-6;
  }
  const Id negative = Evaluate(bad).GetCount(MeshFault::NegativeCoupling);
  EXPECT_GT(negative, 0);
  for (Vec3& point : bad.Points)
  {
    point = point + Vec3{ 700.0, -900.0, 1100.0 };
  }
  EXPECT_EQ(negative, Evaluate(bad).GetCount(MeshFault::NegativeCoupling));
}

TEST(FullCriteria, SameForAnyNumberOfThreads)
{
  // Enough points for a tree that threads build, and regions in slabs.
  TetMesh mesh = MakeHullMesh(MakeRandomPoints(40000, 3));
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    mesh.Regions[i] = static_cast<Id>(5.0 * mesh.Points[mesh.Tetrahedra[i][0]].X);
  }
  const MeshCertificate one = Evaluate(mesh, 1);
  ASSERT_GT(one.Violations.size(), 100u);
  for (const int threads : { 2, 3, 8 })
  {
    const MeshCertificate other = Evaluate(mesh, threads);
    EXPECT_EQ(one.GetText(), other.GetText());
    ASSERT_EQ(one.Violations.size(), other.Violations.size());
    for (std::size_t i = 0; i < one.Violations.size(); ++i)
    {
      ASSERT_EQ(one.Violations[i].Fault, other.Violations[i].Fault);
      ASSERT_EQ(one.Violations[i].Points, other.Violations[i].Points);
      ASSERT_EQ(one.Violations[i].Tetrahedron, other.Violations[i].Tetrahedron);
      ASSERT_EQ(one.Violations[i].Region, other.Violations[i].Region);
    }
    ASSERT_EQ(one.Regions.size(), 5u);
    for (std::size_t i = 0; i < one.Regions.size(); ++i)
    {
      EXPECT_EQ(one.Regions[i].Tetrahedra, other.Regions[i].Tetrahedra);
      EXPECT_EQ(one.Regions[i].Volume, other.Regions[i].Volume);
      EXPECT_EQ(one.Regions[i].EnclosedVolume, other.Regions[i].EnclosedVolume);
    }
  }
}

TEST(FullCriteria, InterfacesAreBordersAndCouplingsBelongToRegions)
{
  TetMesh mesh = MakeHullMesh(MakeGrid(3, 1.0));
  const MeshCertificate one = Evaluate(mesh);
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    double x = 0.0;
    for (const Id point : mesh.Tetrahedra[i])
    {
      x += mesh.Points[point].X / 4.0;
    }
    mesh.Regions[i] = x > 1.0 ? 5 : 2;
  }
  const MeshCertificate two = Evaluate(mesh);
  EXPECT_EQ(one.BorderFacets + 8, two.BorderFacets) << "the interface has four squares";
  EXPECT_EQ(one.StructuralEdges + 8, two.StructuralEdges) << "the rim of the interface";
  EXPECT_EQ(one.Couplings + 16, two.Couplings) << "edges of the interface count twice";
  ASSERT_EQ(2u, two.Regions.size());
  EXPECT_EQ(4.0, two.Regions[0].Volume);
  EXPECT_EQ(4.0, two.Regions[1].EnclosedVolume);
  EXPECT_TRUE(two.IsClean()) << two.GetText();
}

TEST(FullCriteria, AbortAndInvalidInput)
{
  const TetMesh mesh = MakeHullMesh(MakeRandomPoints(3000, 5));
  for (const double limit : { 0.0, 0.3, 0.65, 0.9 })
  {
    double reached = -1.0;
    const ExecutionContext context([&](double fraction, const char*)
      { reached = std::max(reached, fraction); },
      [&] { return reached >= limit; });
    MeshCertificate report;
    EXPECT_TRUE(CertifyMesh(mesh, nullptr, context, report, FullCertificate).IsAborted());
    EXPECT_GE(reached, limit);
  }
  TetMesh broken = mesh;
  broken.Tetrahedra[2][1] = 3000;
  MeshCertificate report;
  Status status = CertifyMesh(broken, nullptr, {}, report, FullCertificate);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ(std::vector<Id>{ 2 }, status.Cells);
  broken = mesh;
  broken.Points[7].Y = std::numeric_limits<double>::quiet_NaN();
  status = CertifyMesh(broken, nullptr, {}, report, FullCertificate);
  EXPECT_EQ(std::vector<Id>{ 7 }, status.Points);
  broken = mesh;
  broken.Regions.pop_back();
  EXPECT_EQ(
    StatusCode::InvalidInput, CertifyMesh(broken, nullptr, {}, report, FullCertificate).Code);
}
