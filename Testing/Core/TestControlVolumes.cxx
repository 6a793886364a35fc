// SPDX-License-Identifier: BSD-3-Clause
#include "HullMeshes.h"

#include "Core/BoxMethod/ControlPolyhedra.h"
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/MeshInvariants.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

using namespace cdm;
using namespace testing_core;

namespace
{
ControlVolumes Compute(const TetMesh& mesh, int threads = 2)
{
  ControlVolumes volumes;
  const Status status = ComputeControlVolumes(mesh, ExecutionContext(threads), volumes);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return volumes;
}

double GetVolume(const TetMesh& mesh, Id region)
{
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[i];
    if (mesh.Regions[i] == region)
    {
      volume += GetSignedVolume(
        mesh.Points[ids[0]], mesh.Points[ids[1]], mesh.Points[ids[2]], mesh.Points[ids[3]]);
    }
  }
  return volume;
}

/** Boxes sum up to the volumes of the regions, boundary areas to those of the facets. */
void ExpectSums(const TetMesh& mesh, const ControlVolumes& volumes, double tolerance)
{
  std::map<Id, double> sums;
  for (const ControlBox& box : volumes.Boxes)
  {
    sums[box.Region] += box.Volume;
  }
  for (const auto& [region, sum] : sums)
  {
    EXPECT_NEAR(1.0, sum / GetVolume(mesh, region), tolerance) << region;
  }
  std::map<EdgeIds, double> areas;
  for (const BoundaryArea& area : volumes.BoundaryAreas)
  {
    areas[{ area.LowRegion, area.HighRegion }] += area.Area;
  }
  std::map<EdgeIds, double> expected;
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      const Id neighbor = mesh.Neighbors[i][facet];
      const Id other = neighbor == NoId ? OutsideRegion : mesh.Regions[neighbor / 4];
      if (other < mesh.Regions[i])
      {
        const TriangleIds ids = GetFacet(mesh.Tetrahedra[i], facet);
        expected[{ other, mesh.Regions[i] }] +=
          GetTriangleArea(mesh.Points[ids[0]], mesh.Points[ids[1]], mesh.Points[ids[2]]);
      }
    }
  }
  ASSERT_EQ(expected.size(), areas.size());
  for (const auto& [regions, area] : expected)
  {
    EXPECT_NEAR(1.0, areas[regions] / area, tolerance);
  }
}

/** Each polyhedron is closed and encloses the volume of its box. */
void ExpectClosedPolyhedra(const TetMesh& mesh, const ControlVolumes& volumes, double tolerance)
{
  ControlPolyhedra polyhedra;
  ASSERT_TRUE(MakeControlPolyhedra(mesh, volumes, {}, polyhedra).IsOk());
  ASSERT_EQ(volumes.Boxes.size() + 1, polyhedra.BoxOffsets.size());
  for (std::size_t box = 0; box < volumes.Boxes.size(); ++box)
  {
    std::map<EdgeIds, int> edges;
    double volume = 0.0;
    const Vec3& center = mesh.Points[volumes.Boxes[box].Point];
    for (Id i = polyhedra.BoxOffsets[box]; i < polyhedra.BoxOffsets[box + 1]; ++i)
    {
      const Id use = polyhedra.BoxPolygons[i];
      const Id polygon = use < 0 ? ~use : use;
      std::vector<Id> ids(polyhedra.Connectivity.begin() + polyhedra.Offsets[polygon],
        polyhedra.Connectivity.begin() + polyhedra.Offsets[polygon + 1]);
      ASSERT_GE(ids.size(), 3u);
      if (use < 0)
      {
        std::reverse(ids.begin(), ids.end());
      }
      for (std::size_t j = 0; j < ids.size(); ++j)
      {
        const Id a = ids[j];
        const Id b = ids[(j + 1) % ids.size()];
        EXPECT_NE(a, b);
        edges[{ std::min(a, b), std::max(a, b) }] += a < b ? 1 : -1;
        if (j + 2 < ids.size())
        {
          volume += GetSignedVolume(center, polyhedra.Points[ids[0]], polyhedra.Points[ids[j + 1]],
            polyhedra.Points[ids[j + 2]]);
        }
      }
    }
    for (const auto& [edge, balance] : edges)
    {
      EXPECT_EQ(0, balance) << "box " << box << " is open at " << edge[0] << " " << edge[1];
    }
    EXPECT_NEAR(volumes.Boxes[box].Volume, volume, tolerance) << "box " << box;
  }
}

void SplitAt(TetMesh& mesh, double x)
{
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    double center = 0.0;
    for (const Id point : mesh.Tetrahedra[i])
    {
      center += mesh.Points[point].X / 4.0;
    }
    mesh.Regions[i] = center > x ? 5 : 2;
  }
}
} // namespace

TEST(ControlVolumes, RegularSimplex)
{
  TetMesh mesh;
  mesh.Points = { { -1, -1, -1 }, { 1, 1, -1 }, { -1, 1, 1 }, { 1, -1, 1 } };
  mesh.Tetrahedra = { { 0, 1, 2, 3 } };
  mesh.Regions = { 3 };
  ASSERT_TRUE(BuildNeighbors(mesh).IsOk());
  const ControlVolumes volumes = Compute(mesh);
  const double volume = 8.0 / 3.0;
  ASSERT_EQ(4u, volumes.Boxes.size());
  for (const ControlBox& box : volumes.Boxes)
  {
    EXPECT_EQ(3, box.Region);
    EXPECT_NEAR(volume / 4.0, box.Volume, 1e-15);
  }
  ASSERT_EQ(6u, volumes.Couplings.size());
  for (const EdgeCoupling& coupling : volumes.Couplings)
  {
    EXPECT_NEAR(std::sqrt(8.0), coupling.Length, 1e-15);
    // Twelve pyramids of height l / 2 over these areas fill the volume.
    EXPECT_NEAR(volume / (2.0 * std::sqrt(8.0)), coupling.Area, 1e-15);
  }
  ASSERT_EQ(4u, volumes.BoundaryAreas.size());
  for (const BoundaryArea& area : volumes.BoundaryAreas)
  {
    EXPECT_NEAR(std::sqrt(3.0) / 4.0 * 8.0, area.Area, 1e-14);
    EXPECT_EQ(OutsideRegion, area.LowRegion);
    EXPECT_EQ(3, area.HighRegion);
  }
  ExpectClosedPolyhedra(mesh, volumes, 1e-15);
}

TEST(ControlVolumes, CubicGrid)
{
  const int size = 5;
  const double h = 0.1;
  const TetMesh mesh = MakeHullMesh(MakeGrid(size, h));
  const ControlVolumes volumes = Compute(mesh);
  EXPECT_EQ(0, volumes.NegativeCouplings);
  // A grid point on k sides of the cube has the volume h^3 / 2^k, an edge on k sides the area
  // h^2 / 2^k if it is parallel to an axis and none otherwise.
  const auto countSides = [&](const Vec3& p)
  {
    int sides = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      sides += p[axis] < 0.5 * h || p[axis] > (size - 1.5) * h;
    }
    return sides;
  };
  ASSERT_EQ(mesh.Points.size(), volumes.Boxes.size());
  for (const ControlBox& box : volumes.Boxes)
  {
    EXPECT_NEAR(h * h * h / (1 << countSides(mesh.Points[box.Point])), box.Volume, 1e-17);
  }
  for (const EdgeCoupling& coupling : volumes.Couplings)
  {
    const Vec3 middle = 0.5 * (mesh.Points[coupling.Points[0]] + mesh.Points[coupling.Points[1]]);
    const double area = coupling.Length < 1.1 * h ? h * h / (1 << countSides(middle)) : 0.0;
    EXPECT_NEAR(area, coupling.Area, 1e-16);
  }
  ExpectSums(mesh, volumes, 1e-14);
  ExpectClosedPolyhedra(mesh, volumes, 1e-17);

  ControlPolyhedra polyhedra;
  ASSERT_TRUE(MakeControlPolyhedra(mesh, volumes, {}, polyhedra).IsOk());
  for (std::size_t box = 0; box < volumes.Boxes.size(); ++box)
  {
    if (countSides(mesh.Points[volumes.Boxes[box].Point]) == 0)
    {
      EXPECT_EQ(6, polyhedra.BoxOffsets[box + 1] - polyhedra.BoxOffsets[box]) << "a cube";
    }
  }
}

TEST(ControlVolumes, BodyCenteredLattice)
{
  // Boxes are truncated octahedra with 8 hexagons and 6 squares of edge length a sqrt(2) / 4.
  const int size = 4;
  std::vector<Vec3> points = MakeGrid(size, 1.0);
  for (const Vec3& point : MakeGrid(size - 1, 1.0))
  {
    points.push_back({ point.X + 0.5, point.Y + 0.5, point.Z + 0.5 });
  }
  const TetMesh mesh = MakeHullMesh(points);
  const ControlVolumes volumes = Compute(mesh);
  const auto isInside = [&](Id id)
  {
    const Vec3& p = mesh.Points[id];
    const double low = std::min({ p.X, p.Y, p.Z });
    const double high = std::max({ p.X, p.Y, p.Z });
    return low > 0.9 && high < size - 1.9;
  };
  ControlPolyhedra polyhedra;
  ASSERT_TRUE(MakeControlPolyhedra(mesh, volumes, {}, polyhedra).IsOk());
  int inner = 0;
  for (std::size_t i = 0; i < volumes.Boxes.size(); ++i)
  {
    if (isInside(volumes.Boxes[i].Point))
    {
      ++inner;
      EXPECT_NEAR(0.5, volumes.Boxes[i].Volume, 1e-15);
      EXPECT_EQ(14, polyhedra.BoxOffsets[i + 1] - polyhedra.BoxOffsets[i]);
    }
  }
  EXPECT_EQ(8 + 1, inner);
  for (const EdgeCoupling& coupling : volumes.Couplings)
  {
    if (isInside(coupling.Points[0]) && isInside(coupling.Points[1]))
    {
      EXPECT_NEAR(
        coupling.Length < 0.99 ? 3.0 * std::sqrt(3.0) / 16.0 : 1.0 / 8.0, coupling.Area, 1e-15);
    }
  }
  ExpectSums(mesh, volumes, 1e-14);
  ExpectClosedPolyhedra(mesh, volumes, 1e-14);
}

TEST(ControlVolumes, SumsHoldWithNegativeCouplings)
{
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    SCOPED_TRACE(seed);
    TetMesh mesh = MakeHullMesh(MakeRandomPoints(500, seed));
    SplitAt(mesh, 0.45);
    const ControlVolumes volumes = Compute(mesh);
    EXPECT_GT(volumes.NegativeCouplings, 0);
    const auto negative = std::count_if(volumes.Couplings.begin(), volumes.Couplings.end(),
      [](const EdgeCoupling& coupling) { return coupling.Area < 0.0; });
    EXPECT_EQ(volumes.NegativeCouplings, negative);
    ExpectSums(mesh, volumes, 1e-12);
    ExpectClosedPolyhedra(mesh, volumes, 1e-9);
  }
}

TEST(ControlVolumes, CertificateCountsTheSameNegativeCouplings)
{
  // Delaunay meshes of two regions, and grids whose points are moved under their tetrahedra.
  for (const double jitter : { 0.0, 0.1, 0.2 })
  {
    std::vector<Vec3> points = jitter > 0.0 ? MakeGrid(7, 1.0) : MakeRandomPoints(700, 12);
    TetMesh mesh = MakeHullMesh(points);
    const std::vector<Vec3> moves = MakeRandomPoints(static_cast<int>(mesh.Points.size()), 13);
    for (std::size_t i = 0; i < mesh.Points.size(); ++i)
    {
      mesh.Points[i] = mesh.Points[i] + jitter * (moves[i] - Vec3{ 0.5, 0.5, 0.5 });
    }
    SplitAt(mesh, jitter > 0.0 ? 3.0 : 0.5);
    const ControlVolumes volumes = Compute(mesh);
    MeshCertificate report;
    ASSERT_TRUE(CertifyMesh(mesh, nullptr, {}, report, FullCertificate).IsOk());
    EXPECT_EQ(jitter > 0.0, report.GetCount(MeshFault::NonDelaunayTetrahedron) > 0);
    EXPECT_GT(volumes.NegativeCouplings, 0);
    EXPECT_EQ(volumes.NegativeCouplings, report.GetCount(MeshFault::NegativeCoupling));
    EXPECT_EQ(static_cast<Id>(volumes.Couplings.size()), report.Couplings);
    ExpectSums(mesh, volumes, 1e-12);
  }
}

TEST(ControlVolumes, LinearFunctionsHaveNoNetFlux)
{
  // The facets of a closed polyhedron, as vectors, vanish in sum: so do the fluxes of the function
  // x out of the box of an inner point.
  const TetMesh mesh = MakeHullMesh(MakeRandomPoints(800, 9));
  const ControlVolumes volumes = Compute(mesh);
  std::vector<double> flux(mesh.Points.size(), 0.0);
  std::vector<double> scale(mesh.Points.size(), 0.0);
  for (const EdgeCoupling& coupling : volumes.Couplings)
  {
    const Vec3& a = mesh.Points[coupling.Points[0]];
    const Vec3& b = mesh.Points[coupling.Points[1]];
    const double current = coupling.Area / coupling.Length * (b.X - a.X);
    flux[coupling.Points[0]] += current;
    flux[coupling.Points[1]] -= current;
    scale[coupling.Points[0]] += std::abs(current);
    scale[coupling.Points[1]] += std::abs(current);
  }
  std::set<Id> border;
  for (const BoundaryArea& area : volumes.BoundaryAreas)
  {
    border.insert(area.Point);
  }
  int inner = 0;
  for (std::size_t i = 0; i < flux.size(); ++i)
  {
    if (border.count(static_cast<Id>(i)) == 0)
    {
      ++inner;
      EXPECT_NEAR(0.0, flux[i] / scale[i], 1e-12);
    }
  }
  EXPECT_GT(inner, 500);
}

TEST(ControlVolumes, SharesOfSliversSumUp)
{
  for (const double lift : { 1e-16, 1e-12, 1e-6 })
  {
    const Vec3 a{ 0, 0, 0 };
    const Vec3 b{ 1, 0, 0 };
    const Vec3 c{ 1.3, 1.1, lift };
    const Vec3 d{ 0, 1, 0 };
    const Vec3 corners[4] = { a, b, d, c };
    const auto couplings = GetCouplings(a, b, d, c);
    DoubleDouble sum;
    for (int edge = 0; edge < 6; ++edge)
    {
      sum = sum +
        GetSquaredDistance(corners[TetrahedronEdges[edge][0]], corners[TetrahedronEdges[edge][1]]) *
          couplings[edge];
    }
    const double volume = GetSignedVolume(a, b, d, c);
    EXPECT_NEAR(volume, sum.High / 3.0, 1e-8 * volume + 1e-16) << lift;
  }
}

TEST(ControlVolumes, CouplingsOfSingleEdgesAreThoseOfAll)
{
  // Each edge of a tetrahedron by itself, computed from its own end, against all six at once.
  const std::vector<Vec3> points = MakeRandomPoints(4000, 17);
  int negative = 0;
  for (std::size_t i = 0; i + 3 < points.size(); i += 4)
  {
    TetMesh mesh;
    mesh.Points.assign(points.begin() + i, points.begin() + i + 4);
    const bool isPositive =
      Orientation(mesh.Points[0], mesh.Points[1], mesh.Points[2], mesh.Points[3]) > 0;
    mesh.Tetrahedra = { isPositive ? TetrahedronIds{ 0, 1, 2, 3 } : TetrahedronIds{ 1, 0, 2, 3 } };
    mesh.Regions = { 0 };
    const auto [a, b, c, d] = GetCorners(mesh.Points, mesh.Tetrahedra[0]);
    const std::array<DoubleDouble, 6> couplings = GetCouplings(a, b, c, d);
    for (int edge = 0; edge < 6; ++edge)
    {
      const EdgeIds ends{ mesh.Tetrahedra[0][TetrahedronEdges[edge][0]],
        mesh.Tetrahedra[0][TetrahedronEdges[edge][1]] };
      const std::vector<SimplexIncidence::Record> records{ { ends[1], NoId, edge } };
      const bool isNegative = HasNegativeCoupling(mesh, ends, records.begin(), records.end(), 0);
      EXPECT_EQ(couplings[edge].High < 0.0, isNegative) << i << " edge " << edge;
      negative += isNegative ? 1 : 0;
    }
  }
  EXPECT_GT(negative, 1000);
  EXPECT_LT(negative, 5000);
}

TEST(ControlVolumes, SameForAnyNumberOfThreads)
{
  TetMesh mesh = MakeHullMesh(MakeRandomPoints(20000, 4));
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    mesh.Regions[i] = static_cast<Id>(5.0 * mesh.Points[mesh.Tetrahedra[i][0]].X);
  }
  const ControlVolumes one = Compute(mesh, 1);
  for (const int threads : { 2, 3, 8 })
  {
    const ControlVolumes other = Compute(mesh, threads);
    ASSERT_EQ(one.Couplings.size(), other.Couplings.size());
    for (std::size_t i = 0; i < one.Couplings.size(); ++i)
    {
      ASSERT_EQ(one.Couplings[i].Points, other.Couplings[i].Points);
      ASSERT_EQ(one.Couplings[i].Region, other.Couplings[i].Region);
      ASSERT_EQ(one.Couplings[i].Area, other.Couplings[i].Area);
    }
    EXPECT_EQ(one.NegativeCouplings, other.NegativeCouplings);
    ASSERT_EQ(one.Boxes.size(), other.Boxes.size());
    for (std::size_t i = 0; i < one.Boxes.size(); ++i)
    {
      ASSERT_EQ(one.Boxes[i].Point, other.Boxes[i].Point);
      ASSERT_EQ(one.Boxes[i].Region, other.Boxes[i].Region);
      ASSERT_EQ(one.Boxes[i].Volume, other.Boxes[i].Volume);
    }
    ASSERT_EQ(one.BoundaryAreas.size(), other.BoundaryAreas.size());
    for (std::size_t i = 0; i < one.BoundaryAreas.size(); ++i)
    {
      ASSERT_EQ(one.BoundaryAreas[i].Point, other.BoundaryAreas[i].Point);
      ASSERT_EQ(one.BoundaryAreas[i].Area, other.BoundaryAreas[i].Area);
    }
  }
}

TEST(ControlVolumes, PolyhedraAreTheSameForAnyNumberOfThreads)
{
  // Regions with flat and bent borders, cospherical cells, and more points than a block has.
  TetMesh random = MakeHullMesh(MakeRandomPoints(20000, 14));
  SplitAt(random, 0.5);
  TetMesh grid = MakeHullMesh(MakeGrid(24, 1.0));
  SplitAt(grid, 11.0);
  for (const TetMesh& mesh : { random, grid })
  {
    const ControlVolumes volumes = Compute(mesh);
    const auto make = [&](int threads)
    {
      ControlPolyhedra polyhedra;
      EXPECT_TRUE(MakeControlPolyhedra(mesh, volumes, ExecutionContext(threads), polyhedra).IsOk());
      return polyhedra;
    };
    const ControlPolyhedra one = make(1);
    EXPECT_EQ(volumes.Boxes.size() + 1, one.BoxOffsets.size());
    for (const int threads : { 2, 3, 8 })
    {
      const ControlPolyhedra other = make(threads);
      EXPECT_TRUE(one.Points == other.Points) << threads;
      EXPECT_TRUE(one.Offsets == other.Offsets) << threads;
      EXPECT_TRUE(one.Connectivity == other.Connectivity) << threads;
      EXPECT_TRUE(one.BoxOffsets == other.BoxOffsets) << threads;
      EXPECT_TRUE(one.BoxPolygons == other.BoxPolygons) << threads;
    }
  }
}

TEST(ControlVolumes, BadTetrahedraAndAbort)
{
  TetMesh mesh = MakeHullMesh(MakeRandomPoints(3000, 5));
  for (const double limit : { 0.0, 0.4, 0.7 })
  {
    double reached = -1.0;
    const ExecutionContext context([&](double fraction, const char*)
      { reached = std::max(reached, fraction); },
      [&] { return reached >= limit; });
    ControlVolumes volumes;
    EXPECT_TRUE(ComputeControlVolumes(mesh, context, volumes).IsAborted());
    volumes = Compute(mesh);
    reached = -1.0;
    ControlPolyhedra polyhedra;
    EXPECT_TRUE(MakeControlPolyhedra(mesh, volumes, context, polyhedra).IsAborted());
  }
  std::swap(mesh.Tetrahedra[7][0], mesh.Tetrahedra[7][1]);
  ControlVolumes volumes;
  const Status status = ComputeControlVolumes(mesh, {}, volumes);
  EXPECT_EQ(StatusCode::InvalidInput, status.Code);
  EXPECT_EQ(std::vector<Id>{ 7 }, status.Cells);
}
