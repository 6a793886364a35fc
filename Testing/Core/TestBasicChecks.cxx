// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/EmptySphereSearch.h"
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/SphereForm.h"
#include "Core/Meshes/MeshInvariants.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "HullMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

using namespace cdm;
using namespace testing_core;

namespace
{
struct Model
{
  TetMesh Mesh;
  TriangleMesh Boundary;
};

/**
 * Unit cube cut by the plane z = y through four of its corners: two prisms, regions 3 and 7, of
 * three tetrahedra each; with labels. x is the lowest bit of a point's number.
 */
Model MakeTwoPrisms()
{
  Model model;
  for (int i = 0; i < 8; ++i)
  {
    model.Mesh.Points.push_back({ double(i & 1), double((i >> 1) & 1), double(i >> 2) });
  }
  // Below the plane: the prism (0, 2, 6), (1, 3, 7); above: (0, 6, 4), (1, 7, 5). Each
  // quadrilateral has the diagonal from its point with the smallest id.
  model.Mesh.Tetrahedra = { { 0, 2, 6, 7 }, { 0, 3, 2, 7 }, { 0, 1, 3, 7 }, { 0, 6, 4, 7 },
    { 0, 4, 5, 7 }, { 0, 5, 1, 7 } };
  for (TetrahedronIds& tetrahedron : model.Mesh.Tetrahedra)
  {
    const std::vector<Vec3>& p = model.Mesh.Points;
    if (Orientation(p[tetrahedron[0]], p[tetrahedron[1]], p[tetrahedron[2]], p[tetrahedron[3]]) < 0)
    {
      std::swap(tetrahedron[0], tetrahedron[1]);
    }
  }
  model.Mesh.Regions = { 3, 3, 3, 7, 7, 7 };
  EXPECT_TRUE(BuildNeighbors(model.Mesh).IsOk());

  model.Boundary.Points = model.Mesh.Points;
  const auto add = [&](const TriangleIds& triangle, Id front, Id back)
  {
    model.Boundary.Triangles.push_back(triangle);
    model.Boundary.Labels.push_back({ front, back });
  };
  add({ 0, 2, 3 }, OutsideRegion, 3); // z = 0
  add({ 0, 3, 1 }, OutsideRegion, 3);
  add({ 4, 5, 7 }, OutsideRegion, 7); // z = 1
  add({ 4, 7, 6 }, OutsideRegion, 7);
  add({ 0, 1, 5 }, OutsideRegion, 7); // y = 0
  add({ 0, 5, 4 }, OutsideRegion, 7);
  add({ 2, 6, 7 }, OutsideRegion, 3); // y = 1
  add({ 2, 7, 3 }, OutsideRegion, 3);
  add({ 0, 4, 6 }, OutsideRegion, 7); // x = 0
  add({ 0, 6, 2 }, OutsideRegion, 3);
  add({ 1, 3, 7 }, OutsideRegion, 3); // x = 1
  add({ 1, 7, 5 }, OutsideRegion, 7);
  add({ 0, 1, 7 }, 7, 3); // y = z, the normal looks up
  add({ 0, 7, 6 }, 7, 3);
  return model;
}

MeshCertificate Check(const Model& model, bool withBoundary = true)
{
  MeshCertificate report;
  const Status status =
    CertifyMesh(model.Mesh, withBoundary ? &model.Boundary : nullptr, {}, report);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return report;
}

void RemoveTetrahedron(TetMesh& mesh, std::size_t tetrahedron)
{
  mesh.Tetrahedra.erase(mesh.Tetrahedra.begin() + tetrahedron);
  mesh.Regions.erase(mesh.Regions.begin() + tetrahedron);
  EXPECT_TRUE(BuildNeighbors(mesh).IsOk());
}
} // namespace

TEST(BasicChecks, ValidMeshIsValid)
{
  const Model model = MakeTwoPrisms();
  const MeshCertificate report = Check(model);
  EXPECT_TRUE(report.IsDelaunay()) << report.GetText();
  EXPECT_EQ(6, report.Tetrahedra);
  EXPECT_EQ(8, report.Points);
  EXPECT_EQ(0, report.UnusedPoints);
  ASSERT_EQ(2u, report.Regions.size());
  EXPECT_EQ(3, report.Regions[0].Region);
  EXPECT_EQ(7, report.Regions[1].Region);
  for (const RegionVolume& region : report.Regions)
  {
    EXPECT_EQ(3, region.Tetrahedra);
    EXPECT_NEAR(0.5, region.Volume, 1e-16);
    EXPECT_NEAR(0.5, region.EnclosedVolume, 1e-16);
  }
  // The fans from the corners 0 and 7 make Kuhn's tetrahedra.
  EXPECT_NEAR(45.0, report.SmallestDihedralAngle, 1e-12);
  EXPECT_NEAR(90.0, report.LargestDihedralAngle, 1e-12);
  EXPECT_TRUE(report.Examples.empty());
  EXPECT_EQ("DELAUNAY\n"
            "Valid, all circumspheres are empty; the couplings of the box method were not looked "
            "at.\n"
            "6 tetrahedra, 8 points, 2 regions; boundary: smallest sphere filled at 0 of 14 "
            "triangles and 0 of 14 structural edges; dihedral angles 45.00 to 90.00 degrees, "
            "tetrahedra 0 under 5 and 0 under 15; volume error 0",
    report.GetText());
}

TEST(BasicChecks, WithoutLabelsTheMeshTellsTheSides)
{
  Model model = MakeTwoPrisms();
  model.Boundary.Labels.clear();
  const MeshCertificate report = Check(model);
  EXPECT_TRUE(report.IsDelaunay()) << report.GetText();
  EXPECT_NEAR(0.5, report.Regions[0].EnclosedVolume, 1e-16);

  // The orientation of a triangle without labels means nothing.
  std::swap(model.Boundary.Triangles[2][0], model.Boundary.Triangles[2][1]);
  std::swap(model.Boundary.Triangles[13][0], model.Boundary.Triangles[13][1]);
  EXPECT_TRUE(Check(model).IsDelaunay());
}

TEST(BasicChecks, RegionsLeftOutAreToldByTheirPoints)
{
  Model model = MakeTwoPrisms();
  for (int i = 0; i < 3; ++i)
  {
    RemoveTetrahedron(model.Mesh, 3);
  }
  EXPECT_FALSE(Check(model).IsDelaunay());
  model.Boundary.Labels.clear();
  const MeshCertificate report = Check(model);
  EXPECT_TRUE(report.IsDelaunay()) << report.GetText();
  EXPECT_EQ(2, report.UnusedPoints);
}

TEST(BasicChecks, BoundaryPointsAreFoundByTheirCoordinates)
{
  Model model = MakeTwoPrisms();
  std::reverse(model.Boundary.Points.begin(), model.Boundary.Points.end());
  for (TriangleIds& triangle : model.Boundary.Triangles)
  {
    for (Id& point : triangle)
    {
      point = 7 - point;
    }
  }
  EXPECT_TRUE(Check(model).IsDelaunay());
}

TEST(BasicChecks, WithoutBoundaryNothingIsCompared)
{
  const MeshCertificate report = Check(MakeTwoPrisms(), false);
  EXPECT_TRUE(report.IsDelaunay());
  EXPECT_EQ(std::string::npos, report.GetText().find("volume error"));
}

TEST(BasicChecks, InvertedTetrahedronIsCounted)
{
  Model model = MakeTwoPrisms();
  std::swap(model.Mesh.Tetrahedra[4][0], model.Mesh.Tetrahedra[4][1]);
  EXPECT_TRUE(BuildNeighbors(model.Mesh).IsOk());
  const MeshCertificate report = Check(model);
  EXPECT_EQ(1, report.GetCount(MeshFault::InvertedTetrahedron));
  EXPECT_EQ(0, report.GetCount(MeshFault::OverfullFacet));
  EXPECT_EQ(0, report.UnboundFacets + report.MissingBoundaryTriangles);
  EXPECT_NEAR(2.0 / 3.0, report.LargestVolumeError, 1e-15);
  EXPECT_EQ((std::vector<Id>{ 4 }), report.Examples);
  EXPECT_FALSE(report.IsDelaunay());
  EXPECT_NE(std::string::npos, report.GetText().find("1 inverted"));
  EXPECT_EQ(0u, report.GetText().find("INVALID\n"));

  // Its circumsphere counts all the same.
  EXPECT_EQ(0, report.GetCount(MeshFault::NonDelaunayTetrahedron));
  model.Mesh.Points.push_back({ 0.5, 0.5, 0.5 });
  EXPECT_EQ(6, Check(model).GetCount(MeshFault::NonDelaunayTetrahedron));
}

TEST(BasicChecks, FlatTetrahedronIsCounted)
{
  Model model = MakeTwoPrisms();
  model.Mesh.Tetrahedra.push_back({ 0, 1, 2, 3 });
  model.Mesh.Regions.push_back(3);
  EXPECT_TRUE(BuildNeighbors(model.Mesh).IsOk());
  const MeshCertificate report = Check(model);
  EXPECT_EQ(1, report.GetCount(MeshFault::FlatTetrahedron));
  EXPECT_EQ(0, report.GetCount(MeshFault::InvertedTetrahedron));
  EXPECT_EQ(0.0, report.SmallestDihedralAngle);
  EXPECT_FALSE(report.IsDelaunay());
}

TEST(BasicChecks, ExactlyFlatIsNotNearlyFlat)
{
  Model model;
  model.Mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 1e-300 } };
  model.Mesh.Tetrahedra = { { 0, 1, 2, 3 } };
  model.Mesh.Regions = { 0 };
  EXPECT_TRUE(BuildNeighbors(model.Mesh).IsOk());
  EXPECT_EQ(0, Check(model, false).GetCount(MeshFault::FlatTetrahedron));
  EXPECT_TRUE(Check(model, false).IsDelaunay());
}

TEST(BasicChecks, NonDelaunayTetrahedraAreCounted)
{
  // Two tetrahedra on both sides of a triangle; the lower the apices, the more they disturb.
  Model model;
  model.Mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.3, 0.2 },
    { 0.3, 0.3, -0.2 } };
  model.Mesh.Tetrahedra = { { 0, 1, 2, 3 }, { 0, 2, 1, 4 } };
  model.Mesh.Regions = { 0, 0 };
  EXPECT_TRUE(BuildNeighbors(model.Mesh).IsOk());
  EXPECT_EQ(2, Check(model, false).GetCount(MeshFault::NonDelaunayTetrahedron));
  EXPECT_EQ((std::vector<Id>{ 0, 1 }), Check(model, false).Examples);

  // A point of no tetrahedron counts as well, however far from the tetrahedra's own neighbours.
  Model prisms = MakeTwoPrisms();
  prisms.Mesh.Points.push_back({ 0.5, 0.5, 0.5 });
  const MeshCertificate report = Check(prisms);
  EXPECT_EQ(6, report.GetCount(MeshFault::NonDelaunayTetrahedron));
  EXPECT_EQ(1, report.UnusedPoints);
  // On the sphere, and just outside of it.
  const double radius = std::sqrt(0.75);
  prisms.Mesh.Points[8] = { 0.5, 0.5, 0.5 + radius + 1e-15 };
  EXPECT_TRUE(Check(prisms).IsDelaunay());
}

TEST(BasicChecks, EqualPointsOnOneSphereAreDelaunay)
{
  Model model = MakeTwoPrisms();
  model.Mesh.Points.push_back({ 0.5, 0.5, 0.5 });
  model.Mesh.Points[8] = model.Mesh.Points[7];
  EXPECT_EQ(0, Check(model).GetCount(MeshFault::NonDelaunayTetrahedron));
  EXPECT_EQ(0, Check(model).CoincidentPoints) << "the second point is not used";
  model.Mesh.Tetrahedra[0] = { 2, 0, 6, 8 };
  const MeshCertificate report = Check(model);
  EXPECT_EQ(1, report.CoincidentPoints);
  EXPECT_FALSE(report.IsDelaunay());
}

TEST(BasicChecks, OverfullFacetsAreCounted)
{
  Model model = MakeTwoPrisms();
  model.Mesh.Tetrahedra.push_back(model.Mesh.Tetrahedra[2]);
  model.Mesh.Regions.push_back(3);
  const Status status = BuildNeighbors(model.Mesh);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_FALSE(status.Cells.empty());
  const MeshCertificate report = Check(model);
  EXPECT_EQ(4, report.GetCount(MeshFault::OverfullFacet));
  EXPECT_FALSE(report.IsDelaunay());
}

TEST(BasicChecks, TetrahedraOnOneSideOfAFacetAreCounted)
{
  Model model;
  model.Mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0, 2 } };
  model.Mesh.Tetrahedra = { { 0, 1, 2, 3 }, { 0, 1, 2, 4 } };
  model.Mesh.Regions = { 0, 0 };
  EXPECT_TRUE(BuildNeighbors(model.Mesh).IsOk());
  EXPECT_EQ(1, Check(model, false).GetCount(MeshFault::OverfullFacet));
}

TEST(BasicChecks, WrongNeighborsAreCounted)
{
  Model model = MakeTwoPrisms();
  int facet = 0;
  while (model.Mesh.Neighbors[1][facet] == NoId)
  {
    ++facet;
  }
  model.Mesh.Neighbors[1][facet] = NoId;
  EXPECT_EQ(1, Check(model).WrongNeighbors);
  model.Mesh.Neighbors[1][facet] = std::numeric_limits<Id>::max();
  EXPECT_EQ(1, Check(model).WrongNeighbors);
  EXPECT_FALSE(Check(model).IsDelaunay());
  EXPECT_NE(std::string::npos, Check(model).GetText().find("1 wrong neighbour."));
}

TEST(BasicChecks, MissingTetrahedronIsFound)
{
  Model model = MakeTwoPrisms();
  RemoveTetrahedron(model.Mesh, 1);
  const MeshCertificate report = Check(model);
  // It had two facets at the outside and two inside.
  EXPECT_EQ(2, report.UnboundFacets);
  EXPECT_EQ(2, report.MissingBoundaryTriangles);
  EXPECT_NEAR(1.0 / 3.0, report.LargestVolumeError, 1e-15);
  EXPECT_FALSE(report.IsDelaunay());
}

TEST(BasicChecks, WrongRegionIsFound)
{
  Model model = MakeTwoPrisms();
  model.Mesh.Regions[1] = 7;
  const MeshCertificate report = Check(model);
  EXPECT_EQ(2, report.UnboundFacets);
  EXPECT_EQ(2, report.MissingBoundaryTriangles);
  EXPECT_NEAR(1.0 / 3.0, report.LargestVolumeError, 1e-15);

  // All of one region under another name: every label differs, no volume has a boundary.
  model = MakeTwoPrisms();
  for (int i = 0; i < 3; ++i)
  {
    model.Mesh.Regions[i] = 5;
  }
  EXPECT_EQ(8, Check(model).MissingBoundaryTriangles);
  EXPECT_EQ(3u, Check(model).Regions.size());
  EXPECT_TRUE(std::isinf(Check(model).LargestVolumeError));
  EXPECT_FALSE(Check(model).IsDelaunay(1e300));
}

TEST(BasicChecks, WrongBoundaryIsFound)
{
  // A label turned round.
  Model model = MakeTwoPrisms();
  std::swap(model.Boundary.Labels[13].Front, model.Boundary.Labels[13].Back);
  EXPECT_EQ(1, Check(model).MissingBoundaryTriangles);
  EXPECT_FALSE(Check(model).IsDelaunay());

  // The other diagonal of a side.
  model = MakeTwoPrisms();
  model.Boundary.Triangles[0] = { 0, 2, 1 };
  model.Boundary.Triangles[1] = { 1, 2, 3 };
  EXPECT_EQ(2, Check(model).MissingBoundaryTriangles);
  EXPECT_EQ(2, Check(model).UnboundFacets);
  EXPECT_EQ(0.0, Check(model).LargestVolumeError);
  model.Boundary.Labels.clear();
  EXPECT_EQ(2, Check(model).MissingBoundaryTriangles);

  // A triangle that the boundary lacks.
  model = MakeTwoPrisms();
  model.Boundary.Triangles.pop_back();
  model.Boundary.Labels.pop_back();
  EXPECT_EQ(1, Check(model).UnboundFacets);
  EXPECT_EQ(0, Check(model).MissingBoundaryTriangles);

  // A point that the mesh lacks.
  model = MakeTwoPrisms();
  model.Boundary.Points[5] = { 1, 0, 1.5 };
  EXPECT_EQ(4, Check(model).MissingBoundaryTriangles);
  EXPECT_EQ(4, Check(model).UnboundFacets);
}

TEST(BasicChecks, InnerSheetsBelongToTheBoundary)
{
  // The interface between two halves of one region is still to be kept.
  Model model = MakeTwoPrisms();
  model.Mesh.Regions.assign(6, 3);
  for (RegionPair& label : model.Boundary.Labels)
  {
    label.Front = label.Front == 7 ? 3 : label.Front;
    label.Back = 3;
  }
  EXPECT_TRUE(Check(model).IsDelaunay()) << Check(model).GetText();
  EXPECT_DOUBLE_EQ(1.0, Check(model).Regions[0].EnclosedVolume);
  model.Boundary.Triangles[12] = { 0, 1, 6 };
  EXPECT_EQ(1, Check(model).MissingBoundaryTriangles);
}

TEST(BasicChecks, CriteriaForBoundariesAreCounted)
{
  // Right angles everywhere: the other points lie on the smallest spheres or outside of them.
  EXPECT_EQ(0, Check(MakeTwoPrisms()).GetCount(MeshFault::FacetSphere));
  EXPECT_EQ(0, Check(MakeTwoPrisms()).GetCount(MeshFault::EdgeSphere));

  // A single flat tetrahedron: its apex lies in the smallest spheres of the base and of all of the
  // base's edges, the base's third point in those of two obtuse sides.
  Model model;
  model.Mesh.Points = { { -1, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0.3, 0.1 } };
  model.Mesh.Tetrahedra = { { 0, 1, 2, 3 } };
  model.Mesh.Regions = { 0 };
  EXPECT_TRUE(BuildNeighbors(model.Mesh).IsOk());
  Id spheres = 0;
  Id edges = 0;
  const std::vector<Vec3>& p = model.Mesh.Points;
  for (int i = 0; i < 4; ++i)
  {
    const int* ids = FacetVertices[i];
    spheres += InEquatorialSphere(p[ids[0]], p[ids[1]], p[ids[2]], p[i]) > 0;
    for (int j = i + 1; j < 4; ++j)
    {
      bool isDisturbed = false;
      for (int k = 0; k < 4; ++k)
      {
        isDisturbed = isDisturbed || (k != i && k != j && InDiametralSphere(p[i], p[j], p[k]) > 0);
      }
      edges += isDisturbed;
    }
  }
  EXPECT_GT(spheres, 0);
  EXPECT_GT(edges, 0);
  EXPECT_EQ(spheres, Check(model, false).GetCount(MeshFault::FacetSphere));
  EXPECT_EQ(edges, Check(model, false).GetCount(MeshFault::EdgeSphere));
  ASSERT_EQ(1u, Check(model, false).Interfaces.size());
  EXPECT_EQ(spheres, Check(model, false).Interfaces[0].Violations);
  EXPECT_NE(Check(model, false)
              .GetReasons()
              .find(std::to_string(spheres) +
                " of 4 boundary triangles have a point in their smallest sphere: " +
                std::to_string(spheres) + " of 4 outside of region 0."),
    std::string::npos);
  EXPECT_TRUE(Check(model, false).IsDelaunay())
    << "these criteria are no condition for a valid mesh";
}

TEST(BasicChecks, VolumesAreCompensated)
{
  // A long way from the origin, a thin layer: both volumes have to agree far below the tolerance.
  Model model = MakeTwoPrisms();
  for (std::vector<Vec3>* points : { &model.Mesh.Points, &model.Boundary.Points })
  {
    for (Vec3& point : *points)
    {
      const double angle = 0.3;
      const Vec3 layer{ 100.0 * point.X, 100.0 * point.Y, 1e-3 * point.Z };
      point = { 1e4 + std::cos(angle) * layer.X - std::sin(angle) * layer.Z, 2e4 + layer.Y,
        std::sin(angle) * layer.X + std::cos(angle) * layer.Z };
    }
  }
  EXPECT_LT(Check(model).LargestVolumeError, 1e-14);
}

TEST(BasicChecks, BadInputIsRefused)
{
  MeshCertificate report;
  Model model = MakeTwoPrisms();
  model.Mesh.Tetrahedra[2][1] = 8;
  Status status = CertifyMesh(model.Mesh, nullptr, {}, report);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ((std::vector<Id>{ 2 }), status.Cells);
  EXPECT_EQ(StatusCode::InvalidInput, BuildNeighbors(model.Mesh).Code);

  model = MakeTwoPrisms();
  model.Mesh.Neighbors.resize(1);
  EXPECT_EQ(StatusCode::InvalidInput, CertifyMesh(model.Mesh, nullptr, {}, report).Code);

  model = MakeTwoPrisms();
  model.Mesh.Points[3].Z = std::numeric_limits<double>::infinity();
  status = CertifyMesh(model.Mesh, nullptr, {}, report);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ((std::vector<Id>{ 3 }), status.Points);

  model = MakeTwoPrisms();
  model.Boundary.Triangles[1][0] = -1;
  status = CertifyMesh(model.Mesh, &model.Boundary, {}, report);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ((std::vector<Id>{ 1 }), status.Cells);

  model = MakeTwoPrisms();
  model.Boundary.Labels.pop_back();
  EXPECT_EQ(StatusCode::InvalidInput, CertifyMesh(model.Mesh, &model.Boundary, {}, report).Code);
}

TEST(BasicChecks, EmptyMeshHasNoBoundary)
{
  Model model;
  EXPECT_TRUE(Check(model).IsDelaunay());
  EXPECT_NE(std::string::npos, Check(model).GetText().find("empty"));
  model.Boundary = MakeTwoPrisms().Boundary;
  EXPECT_EQ(14, Check(model).MissingBoundaryTriangles);
  EXPECT_FALSE(Check(model).IsDelaunay());
}

TEST(BasicChecks, AbortIsHonoured)
{
  const Model model = MakeTwoPrisms();
  for (int patience = 0; patience < 5; ++patience)
  {
    int calls = 0;
    MeshCertificate report;
    const ExecutionContext context({}, [&] { return calls++ >= patience; });
    EXPECT_TRUE(CertifyMesh(model.Mesh, &model.Boundary, context, report).IsAborted());
  }
}

namespace
{
/** The search passes over none of the points. */
constexpr std::array<Id, 0> NoVertices{};

/** Points found by the search must hold all points that the exact predicate finds. */
template <typename Sphere, typename Predicate>
void CompareWithAllPoints(const std::vector<Vec3>& points, const Sphere& sphere, Predicate&& isIn)
{
  const EmptySphereSearch search(points);
  std::set<Id> candidates;
  search.FindInside(sphere, NoVertices,
    [&](Id point)
    {
      candidates.insert(point);
      return false;
    });
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    EXPECT_TRUE(!isIn(points[i]) || candidates.count(static_cast<Id>(i)) == 1) << i;
  }
}

/** Returns how many of the spheres of a tetrahedron, of a facet and an edge have a usable ball. */
int CompareWithAllPoints(const std::vector<Vec3>& points, const TetrahedronIds& ids)
{
  const Vec3& a = points[ids[0]];
  const Vec3& b = points[ids[1]];
  const Vec3& c = points[ids[2]];
  const Vec3& d = points[ids[3]];
  int balls = 0;
  if (Orientation(a, b, c, d) > 0)
  {
    const auto isIn = [&](const Vec3& point) { return InSphere(a, b, c, d, point) >= 0; };
    CompareWithAllPoints(points, SphereForm(a, b, c, d), isIn);
    const EnclosingBall ball(a, b, c, d);
    if (ball.IsUsable())
    {
      CompareWithAllPoints(points, ball, isIn);
      ++balls;
    }
  }
  const EnclosingBall edge(a, b);
  EXPECT_FALSE(a == b && edge.IsUsable());
  if (edge.IsUsable())
  {
    CompareWithAllPoints(
      points, edge, [&](const Vec3& point) { return InDiametralSphere(a, b, point) >= 0; });
    ++balls;
  }
  const EnclosingBall ball(a, b, c);
  if (AreCollinear(a, b, c))
  {
    EXPECT_FALSE(ball.IsUsable());
    return balls;
  }
  const auto isIn = [&](const Vec3& point) { return InEquatorialSphere(a, b, c, point) >= 0; };
  CompareWithAllPoints(points, SphereForm(a, b, c), isIn);
  if (ball.IsUsable())
  {
    CompareWithAllPoints(points, ball, isIn);
    ++balls;
  }
  return balls;
}
} // namespace

TEST(BasicChecks, SameForAnyNumberOfThreads)
{
  TetMesh mesh = testing_core::MakeHullMesh(testing_core::MakeRandomPoints(20000, 7));
  ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    mesh.Regions[i] = static_cast<Id>(3.0 * mesh.Points[mesh.Tetrahedra[i][0]].X);
  }
  // Faults of each kind, far apart.
  for (std::size_t i = 100; i < mesh.Tetrahedra.size(); i += 10000)
  {
    std::swap(mesh.Tetrahedra[i][0], mesh.Tetrahedra[i][1]);
    mesh.Neighbors[i + 50][2] = NoId;
    mesh.Points[i / 10] = mesh.Points[i / 10 + 1];
  }
  TriangleMesh boundary;
  boundary.Points = mesh.Points;
  boundary.Triangles = { { 0, 1, 2 } };
  boundary.Labels = { { 0, 1 } };
  MeshCertificate one;
  ASSERT_TRUE(CertifyMesh(mesh, &boundary, {}, one).IsOk());
  EXPECT_GT(one.GetCount(MeshFault::InvertedTetrahedron), 0);
  EXPECT_GT(one.CoincidentPoints, 0);
  EXPECT_GT(one.GetCount(MeshFault::NonDelaunayTetrahedron), 0);
  for (const int threads : { 2, 3, 8 })
  {
    MeshCertificate other;
    ASSERT_TRUE(CertifyMesh(mesh, &boundary, ExecutionContext(threads), other).IsOk());
    EXPECT_EQ(one.GetText(), other.GetText());
    EXPECT_EQ(one.Examples, other.Examples);
    EXPECT_EQ(one.WrongNeighbors, other.WrongNeighbors);
    EXPECT_EQ(one.CoincidentPoints, other.CoincidentPoints);
    EXPECT_EQ(one.GetCount(MeshFault::FacetSphere), other.GetCount(MeshFault::FacetSphere));
    EXPECT_EQ(one.GetCount(MeshFault::EdgeSphere), other.GetCount(MeshFault::EdgeSphere));
    EXPECT_EQ(one.SmallestDihedralAngle, other.SmallestDihedralAngle);
    ASSERT_EQ(one.Regions.size(), other.Regions.size());
    for (std::size_t r = 0; r < one.Regions.size(); ++r)
    {
      EXPECT_EQ(one.Regions[r].Volume, other.Regions[r].Volume);
    }
  }
}

TEST(EmptySphereSearch, FindsWhatTheExactPredicatesFind)
{
  std::mt19937 random(7);
  const auto uniform = [&] { return random() / 4294967296.0; };
  // Far away nothing is known of the centers; halfway there, less than close by.
  for (const double distance : { 7.0, 7e5, 7e9 })
  {
    for (const double flatness : { 1.0, 1e-8, 1e-15, 0.0 })
    {
      for (const double scale : { 1e-30, 1.0, 1e30 })
      {
        std::vector<Vec3> points;
        for (int i = 0; i < 200; ++i)
        {
          // Slanted layers, so that rounding makes them thick where they are not.
          const double x = std::floor(uniform() * 6.0);
          const double y = std::floor(uniform() * 6.0);
          const double z = flatness * uniform();
          points.push_back(
            scale * Vec3{ 0.1 * x - 0.3 * z, 0.1 * y + 0.1 * x, z + 0.03 * x + distance });
        }
        int balls = 0;
        for (int i = 0; i < 20; ++i)
        {
          TetrahedronIds ids{ static_cast<Id>(random() % 200), static_cast<Id>(random() % 200),
            static_cast<Id>(random() % 200), static_cast<Id>(random() % 200) };
          balls += CompareWithAllPoints(points, ids);
          std::swap(ids[0], ids[1]);
          balls += CompareWithAllPoints(points, ids);
        }
        EXPECT_EQ(balls > 20, distance < 7e9) << distance;
      }
    }
  }
}

TEST(EmptySphereSearch, SpheresOfFlatTetrahedraStayNarrow)
{
  // A slanted square layer of points, flat but for rounding, below a block of random points: the
  // sphere through four points of the layer is a half space in effect. On the empty side only the
  // layer's own points may be looked at.
  std::mt19937 random(11);
  const auto uniform = [&] { return random() / 4294967296.0; };
  std::vector<Vec3> points;
  for (int i = 0; i < 100; ++i)
  {
    const double x = uniform();
    const double y = uniform();
    points.push_back({ x, y, (x + y) / 3.0 });
  }
  for (int i = 0; i < 10000; ++i)
  {
    const double x = uniform();
    const double y = uniform();
    points.push_back({ x, y, (x + y) / 3.0 + 1e-6 + uniform() });
  }
  const EmptySphereSearch search(points);
  int tetrahedra = 0;
  for (int i = 0; i + 3 < 100; ++i)
  {
    if (Orientation(points[i], points[i + 1], points[i + 2], points[i + 3]) <= 0)
    {
      continue;
    }
    ++tetrahedra;
    // Whichever side the sphere lies on, candidates above the layer are truly inside.
    search.FindInside(SphereForm(points[i], points[i + 1], points[i + 2], points[i + 3]),
      NoVertices,
      [&](Id point)
      {
        EXPECT_TRUE(point < 100 ||
          InSphere(points[i], points[i + 1], points[i + 2], points[i + 3], points[point]) > 0);
        return false;
      });
  }
  EXPECT_GT(tetrahedra, 5);
}

TEST(EmptySphereSearch, FindsTheSameWithATreeOfSeveralThreads)
{
  const std::vector<Vec3> points = MakeRandomPoints(40000, 8);
  const EmptySphereSearch one(points, 1);
  for (const int threads : { 2, 3, 8 })
  {
    const EmptySphereSearch other(points, threads);
    for (Id i = 0; i + 1 < 400; ++i)
    {
      const EdgeIds edge{ i, i + 1 };
      const SphereForm sphere(points[i], points[i + 1]);
      const auto list = [&](const EmptySphereSearch& search)
      {
        std::vector<Id> found;
        search.FindInside(sphere, edge,
          [&found](Id point)
          {
            found.push_back(point);
            return found.size() >= 50;
          });
        return found;
      };
      ASSERT_EQ(list(one), list(other));
    }
  }
}

TEST(SimplexIncidence, HasEachFacetAndEdgeAtItsLowestPoint)
{
  const TetMesh mesh = MakeHullMesh(MakeRandomPoints(40000, 9));
  const std::size_t count = mesh.Tetrahedra.size();
  for (const int threads : { 1, 2, 3, 8 })
  {
    const SimplexIncidence incidence(mesh, threads);
    std::vector<char> corners(4 * count, 0);
    std::vector<char> facets(4 * count, 0);
    std::vector<char> edges(6 * count, 0);
    std::vector<SimplexIncidence::Record> scratch;
    for (Id point = 0; point < static_cast<Id>(mesh.Points.size()); ++point)
    {
      incidence.ForEachTetrahedron(point,
        [&](Id tetrahedron, int vertex)
        {
          ASSERT_EQ(mesh.Tetrahedra[tetrahedron][vertex], point);
          ++corners[4 * tetrahedron + vertex];
        });
      incidence.ForEachFacet(point, scratch,
        [&](const TriangleIds& ids, auto begin, auto end)
        {
          ASSERT_TRUE(ids[0] == point && ids[0] < ids[1] && ids[1] < ids[2]);
          for (auto record = begin; record != end; ++record)
          {
            TriangleIds facet = GetFacet(mesh.Tetrahedra[record->Simplex / 4], record->Simplex % 4);
            std::sort(facet.begin(), facet.end());
            ASSERT_EQ(facet, ids);
            ++facets[record->Simplex];
          }
        });
      incidence.ForEachEdge(point, scratch,
        [&](const TriangleIds& ids, auto begin, auto end)
        {
          ASSERT_TRUE(ids[0] == point && ids[0] < ids[1] && ids[2] == NoId);
          for (auto record = begin; record != end; ++record)
          {
            const TetrahedronIds& tetrahedron = mesh.Tetrahedra[record->Simplex / 6];
            const int* ends = TetrahedronEdges[record->Simplex % 6];
            ASSERT_EQ(ids[0] + ids[1], tetrahedron[ends[0]] + tetrahedron[ends[1]]);
            ASSERT_EQ(ids[0], std::min(tetrahedron[ends[0]], tetrahedron[ends[1]]));
            ++edges[record->Simplex];
          }
        });
    }
    for (const std::vector<char>& visits : { corners, facets, edges })
    {
      EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), static_cast<long>(visits.size()));
    }
    TetMesh other = mesh;
    other.Neighbors.clear();
    ASSERT_TRUE(BuildNeighbors(other, threads).IsOk());
    EXPECT_TRUE(std::equal(other.Neighbors.begin(), other.Neighbors.end(), mesh.Neighbors.begin(),
      mesh.Neighbors.end()));
  }
}
