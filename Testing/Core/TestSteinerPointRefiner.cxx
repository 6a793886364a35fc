// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/SteinerPointRefiner.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Surface/FlatFacets.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;

struct Stage3
{
  TriangleMesh Surface;
  AdvancingFrontTetrahedralizerOutput Output;
};

/** Stages 0 to 3, with mesh points. */
Stage3 MakeMesh(const PolygonSoup& soup, const std::vector<Vec3>& points = {})
{
  Stage3 stage;
  BoundaryTriangulatorOutput boundary;
  EXPECT_TRUE(TriangulateBoundary(soup, {}, {}, boundary).IsOk());
  DelaunaySurfaceRefinerInput input;
  input.Surface = &boundary.Surface;
  input.MeshPoints = &points;
  DelaunaySurfaceRefinerOutput refined;
  EXPECT_TRUE(RefineDelaunaySurface(input, {}, {}, refined).IsOk());
  stage.Surface = refined.Surface;
  AdvancingFrontTetrahedralizerInput front;
  front.Surface = &stage.Surface;
  front.MeshPoints = &points;
  EXPECT_TRUE(TetrahedralizeByAdvancingFront(front, {}, {}, stage.Output).IsOk());
  return stage;
}

PolygonSoup MakeBox(const Vec3& size)
{
  return CellComplex(size).GetSoup();
}

/** A box of three layers, the one in the middle as thin as wanted. */
PolygonSoup MakeLayers(double thickness)
{
  CellComplex complex({ 1.0, 1.0, 1.0 });
  EXPECT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, 0.5, 1e-6));
  EXPECT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, 0.5 + thickness, 1e-6));
  return complex.GetSoup();
}

/** A prism over a polygon in the xz plane, counter-clockwise seen from -y, as long as wanted. */
PolygonSoup MakePrism(const std::vector<Vec3>& outline, double length)
{
  PolygonSoup soup;
  const Id count = static_cast<Id>(outline.size());
  for (double y : { 0.0, length })
  {
    for (const Vec3& point : outline)
    {
      soup.Points.push_back({ point.X, y, point.Z });
    }
  }
  for (Id i = 0; i < count; ++i)
  {
    soup.Connectivity.push_back(i);
  }
  soup.Offsets.push_back(count);
  for (Id i = count; i > 0; --i)
  {
    soup.Connectivity.push_back(count + i - 1);
  }
  soup.Offsets.push_back(2 * count);
  for (Id i = 0; i < count; ++i)
  {
    const Id j = (i + 1) % count;
    soup.Connectivity.insert(soup.Connectivity.end(), { j, i, count + i, count + j });
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  return soup;
}

/** A pyramid over a square; its faces have an angle in degrees at the apex. */
PolygonSoup MakePyramid(double angle)
{
  PolygonSoup soup;
  // A face is as high as the apex is far from the middle of an edge of the base.
  const double faceHeight = 1.0 / std::tan(0.5 * angle * Pi / 180.0);
  soup.Points = { { -1.0, -1.0, 0.0 }, { 1.0, -1.0, 0.0 }, { 1.0, 1.0, 0.0 }, { -1.0, 1.0, 0.0 },
    { 0.0, 0.0, std::sqrt(faceHeight * faceHeight - 1.0) } };
  for (const std::vector<Id>& polygon : std::vector<std::vector<Id>>{
         { 0, 3, 2, 1 }, { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } })
  {
    soup.Connectivity.insert(soup.Connectivity.end(), polygon.begin(), polygon.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  return soup;
}

/** A prism whose side facets meet at an angle in degrees. */
PolygonSoup MakeWedge(double angle)
{
  PolygonSoup soup;
  const double x = std::cos(angle * Pi / 180.0);
  const double y = std::sin(angle * Pi / 180.0);
  soup.Points = { { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0 }, { x, y, 0.0 }, { 0.0, 0.0, 1.0 },
    { 1.0, 0.0, 1.0 }, { x, y, 1.0 } };
  for (const std::vector<Id>& polygon : std::vector<std::vector<Id>>{
         { 0, 2, 1 }, { 3, 4, 5 }, { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 2, 0, 3, 5 } })
  {
    soup.Connectivity.insert(soup.Connectivity.end(), polygon.begin(), polygon.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  return soup;
}

/** Criteria of the mesh, its boundary with labels, and what the faults and the report say. */
void ExpectRight(const SteinerPointRefinerInput& input, const SteinerPointRefinerOptions& options,
  const SteinerPointRefinerOutput& output)
{
  MeshCertificate check;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, check).IsOk());
  EXPECT_TRUE(check.IsDelaunay()) << check.GetText();
  EXPECT_EQ(check.UnusedPoints, 0);
  EXPECT_EQ(check.GetCount(MeshFault::FacetSphere), 0);
  EXPECT_EQ(output.Report.UnresolvedTriangles, 0);
  // The same regions as before.
  MeshCertificate before;
  ASSERT_TRUE(CertifyMesh(*input.Mesh, nullptr, {}, before).IsOk());
  ASSERT_EQ(before.Regions.size(), check.Regions.size());
  for (std::size_t i = 0; i < check.Regions.size(); ++i)
  {
    EXPECT_EQ(before.Regions[i].Region, check.Regions[i].Region);
    EXPECT_NEAR(before.Regions[i].Volume, check.Regions[i].Volume, 1e-12);
  }

  MeshCertificate criteria;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, criteria, FullCertificate).IsOk());
  EXPECT_EQ(
    criteria.GetCount(MeshFault::NegativeCoupling) > 0, output.Report.NegativeCouplings > 0);

  Id counts[5] = { 0, 0, 0, 0, 0 };
  ASSERT_EQ(output.Faults.size(), output.Mesh.Tetrahedra.size());
  const std::vector<Vec3>& p = output.Mesh.Points;
  for (std::size_t t = 0; t < output.Faults.size(); ++t)
  {
    const TetrahedronIds& ids = output.Mesh.Tetrahedra[t];
    const std::array<Vec3, 4> v{ p[ids[0]], p[ids[1]], p[ids[2]], p[ids[3]] };
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    for (const auto& edge : TetrahedronEdges)
    {
      shortest = std::min(shortest, Distance(v[edge[0]], v[edge[1]]));
      longest = std::max(longest, Distance(v[edge[0]], v[edge[1]]));
    }
    const double radius = Distance(v[0], GetCircumcenter(v[0], v[1], v[2], v[3]));
    if (output.Faults[t] == SteinerFault::None)
    {
      EXPECT_GE(GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]), options.DihedralAngleTarget);
      EXPECT_TRUE(options.RadiusEdgeRatio == 0.0 ||
        radius <= (1.0 + 1e-12) * options.RadiusEdgeRatio * shortest);
      EXPECT_TRUE(options.MaximumEdgeLength == 0.0 || longest <= options.MaximumEdgeLength);
      EXPECT_TRUE(options.MaximumVolume == 0.0 ||
        GetSignedVolume(v[0], v[1], v[2], v[3]) <= options.MaximumVolume);
    }
    ++counts[static_cast<int>(output.Faults[t])];
  }
  EXPECT_EQ(counts[1], output.Report.TooLarge);
  EXPECT_EQ(counts[2], output.Report.BadlyShaped);
  EXPECT_EQ(counts[3], output.Report.Slivers);
  EXPECT_EQ(counts[4], output.Report.Inevitable);

  // Points that come from the input are where they were, and first.
  ASSERT_EQ(output.PointSources.size(), p.size());
  Id last = -1;
  for (std::size_t i = 0; i < p.size(); ++i)
  {
    const Id source = output.PointSources[i];
    if (source != NoId)
    {
      EXPECT_GT(source, last);
      EXPECT_EQ(p[i], input.Mesh->Points[source]);
    }
    last = source == NoId ? std::numeric_limits<Id>::max() - 1 : source;
  }
}

SteinerPointRefinerOutput Refine(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context = {})
{
  SteinerPointRefinerOutput output;
  const Status status = RefineBySteinerPoints(input, options, context, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  ExpectRight(input, options, output);
  return output;
}

/** Refines the mesh of stages 0 to 3. */
SteinerPointRefinerOutput Refine(const PolygonSoup& soup, const SteinerPointRefinerOptions& options)
{
  const Stage3 mesh = MakeMesh(soup);
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  return Refine(input, options);
}

void ExpectNoFaults(const SteinerPointRefinerReport& report)
{
  EXPECT_EQ(report.TooLarge, 0);
  EXPECT_EQ(report.BadlyShaped, 0);
  EXPECT_EQ(report.Slivers, 0);
  EXPECT_EQ(report.Inevitable, 0);
  EXPECT_EQ(report.NegativeCouplings, 0);
}

/** The least number of tetrahedra on a way from one side of a facet to the other along z. */
Id CountAcross(const TetMesh& mesh, const std::vector<double>& heights)
{
  const double top = *std::max_element(heights.begin(), heights.end());
  std::vector<char> isReached;
  for (double height : heights)
  {
    isReached.push_back(height < 1e-9 * top ? 1 : 0);
  }
  for (Id count = 0;; ++count)
  {
    std::vector<char> next = isReached;
    for (const TetrahedronIds& ids : mesh.Tetrahedra)
    {
      if (std::any_of(ids.begin(), ids.end(), [&](Id id) { return isReached[id] != 0; }))
      {
        for (Id id : ids)
        {
          next[id] = 1;
        }
      }
    }
    for (std::size_t p = 0; p < next.size(); ++p)
    {
      if (next[p] != 0 && heights[p] > (1.0 - 1e-9) * top)
      {
        return count + 1;
      }
    }
    if (next == isReached)
    {
      return NoId;
    }
    isReached = std::move(next);
  }
}
} // namespace

TEST(SteinerPointRefiner, BoxesGetNoSliversAtAll)
{
  for (const Vec3& size :
    { Vec3{ 1.0, 1.0, 1.0 }, Vec3{ 1.0, 0.7, 0.2 }, Vec3{ 1e-9, 2e-9, 0.5e-9 } })
  {
    const Stage3 mesh = MakeMesh(MakeBox(size));
    SteinerPointRefinerInput input;
    input.Mesh = &mesh.Output.Mesh;
    SteinerPointRefinerOptions options;
    for (double target : { 15.0, 20.0 })
    {
      options.DihedralAngleTarget = target;
      options.MaximumVolume = size.X * size.Y * size.Z / 1000.0;
      ExpectNoFaults(Refine(input, options).Report);
    }
  }
}

TEST(SteinerPointRefiner, LongAndFlatBoxesAreNoThinLayers)
{
  for (const Vec3& size : { Vec3{ 1.0, 2.0, 2.0 }, Vec3{ 6.0, 1.0, 1.0 }, Vec3{ 10.0, 6.0, 1.0 },
         Vec3{ 1.0, 0.1, 1.0 }, Vec3{ 0.1, 0.1, 5.0 } })
  {
    const Stage3 mesh = MakeMesh(MakeBox(size));
    SteinerPointRefinerInput input;
    input.Mesh = &mesh.Output.Mesh;
    ExpectNoFaults(Refine(input, SteinerPointRefinerOptions()).Report);
  }
}

/** It took seven rounds, each of which split the sides once or twice. */
TEST(SteinerPointRefiner, NarrowTrianglesAreSplitInOneRound)
{
  for (const double length : { 30.0, 100.0, 300.0 })
  {
    const SteinerPointRefinerOutput output =
      Refine(MakeBox({ length, 1.0, 1.0 }), SteinerPointRefinerOptions());
    ExpectNoFaults(output.Report);
    EXPECT_LE(output.Report.Rounds, 3) << length;
    EXPECT_LE(output.Mesh.Tetrahedra.size(), 4.0 * length) << length;
  }
}

TEST(SteinerPointRefiner, TurnedBoxesGetNoFlatTetrahedra)
{
  // Their facets are plane but for rounding, and many of their points lie on one circle.
  for (unsigned int seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const Stage3 mesh = MakeMesh(MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 0, 0.3 * seed));
    SteinerPointRefinerInput input;
    input.Mesh = &mesh.Output.Mesh;
    SteinerPointRefinerOptions options;
    options.MaximumVolume = 5e-4;
    const SteinerPointRefinerOutput output = Refine(input, options);
    EXPECT_EQ(output.Report.TooLarge, 0);
    const std::vector<Vec3>& p = output.Mesh.Points;
    for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
    {
      EXPECT_GT(GetSmallestDihedralAngle(p[ids[0]], p[ids[1]], p[ids[2]], p[ids[3]]), 10.0);
    }
  }
}

TEST(SteinerPointRefiner, TurnedLayersAreMeshedAsStraightOnes)
{
  // Points on both sides of a layer are corners of rectangles; turned, these are so but for
  // rounding.
  SteinerPointRefinerOptions options;
  options.MaximumEdgeLength = 0.2;
  std::size_t straight = 0;
  for (double angle : { 0.0, 10.0, 33.0, 77.0 })
  {
    SCOPED_TRACE("angle " + std::to_string(angle));
    PolygonSoup soup = MakeLayers(0.1);
    Rotate(soup.Points, (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 }, angle * Pi / 180.0);
    const Stage3 mesh = MakeMesh(soup);
    SteinerPointRefinerInput input;
    input.Mesh = &mesh.Output.Mesh;
    const SteinerPointRefinerOutput output = Refine(input, options);
    ExpectNoFaults(output.Report);
    const std::size_t count = output.Mesh.Tetrahedra.size();
    straight = angle == 0.0 ? count : straight;
    EXPECT_NEAR(static_cast<double>(count), static_cast<double>(straight),
      0.05 * static_cast<double>(straight));
  }
}

TEST(SteinerPointRefiner, RandomComplexesInAnyPosition)
{
  for (unsigned int seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const Stage3 mesh = MakeMesh(MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 2, 0.5 * seed));
    SteinerPointRefinerInput input;
    input.Mesh = &mesh.Output.Mesh;
    input.Boundary = &mesh.Output.Boundary;
    SteinerPointRefinerOptions options;
    options.MaximumEdgeLength = 0.3;
    const SteinerPointRefinerOutput output = Refine(input, options);
    EXPECT_EQ(output.Report.TooLarge, 0);
    EXPECT_EQ(output.Report.NegativeCouplings, 0);
    // The triangles given, refined.
    for (std::size_t t = 0; t < output.Boundary.Triangles.size(); ++t)
    {
      const Id source = output.Boundary.SourceCells[t];
      ASSERT_GE(source, 0);
      const TriangleIds& ids = mesh.Output.Boundary.Triangles[source];
      const TriangleIds& now = output.Boundary.Triangles[t];
      const std::vector<Vec3>& points = output.Mesh.Points;
      const Vec3 center = (1.0 / 3.0) * (points[now[0]] + points[now[1]] + points[now[2]]);
      // A flip may have united the triangles of a flat facet, which lie in one plane.
      const Vec3& a = mesh.Output.Mesh.Points[ids[0]];
      const Vec3 normal =
        Cross(mesh.Output.Mesh.Points[ids[1]] - a, mesh.Output.Mesh.Points[ids[2]] - a);
      EXPECT_NEAR(Dot(normal, center - a) / Norm(normal), 0.0, 1e-12);
    }
  }
}

TEST(SteinerPointRefiner, ThinLayersStayThinAndSharpWedgesEnd)
{
  for (double thickness : { 0.02, 0.005, 0.001 })
  {
    SCOPED_TRACE("thickness " + std::to_string(thickness));
    SteinerPointRefinerOptions options;
    options.MaximumEdgeLength = 0.2;
    const SteinerPointRefinerOutput output = Refine(MakeLayers(thickness), options);
    EXPECT_EQ(output.Report.TooLarge, 0);
    EXPECT_EQ(output.Report.BadlyShaped, 0);
    EXPECT_EQ(output.Report.Slivers, 0);
    EXPECT_LT(output.Mesh.Points.size(), 2000u);
  }
  for (double angle : { 30.0, 5.0, 1.0 })
  {
    SCOPED_TRACE("angle " + std::to_string(angle));
    const SteinerPointRefinerOutput output = Refine(MakeWedge(angle), SteinerPointRefinerOptions());
    EXPECT_EQ(output.Report.Slivers, 0);
    EXPECT_LT(output.Mesh.Points.size(), 3000u);
  }
}

TEST(SteinerPointRefiner, AsManyTetrahedraAcrossLayersAsAskedFor)
{
  for (const Vec3& size : { Vec3{ 1.0, 1.0, 1.0 }, Vec3{ 1.0, 0.8, 0.1 }, Vec3{ 3.0, 2.0, 0.5 } })
  {
    for (int across : { 2, 3, 4 })
    {
      SCOPED_TRACE(std::to_string(size.Z) + ", " + std::to_string(across) + " across");
      const Vec3 axis = (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 };
      PolygonSoup soup = MakeBox(size);
      Rotate(soup.Points, axis, 0.3);
      SteinerPointRefinerOptions options;
      options.TetrahedraAcrossLayers = across;
      const SteinerPointRefinerOutput output = Refine(soup, options);
      ExpectNoFaults(output.Report);
      std::vector<Vec3> straight = output.Mesh.Points;
      Rotate(straight, axis, -0.3);
      std::vector<double> heights;
      double low = straight[0].Z;
      for (const Vec3& point : straight)
      {
        low = std::min(low, point.Z);
      }
      for (const Vec3& point : straight)
      {
        heights.push_back(point.Z - low);
      }
      const Id found = CountAcross(output.Mesh, heights);
      EXPECT_GE(found, across);
      EXPECT_LE(found, 2 * across);
    }
  }
}

TEST(SteinerPointRefiner, NoMoreTetrahedraAcrossThinLayersAndWedges)
{
  for (const PolygonSoup& soup : { MakeLayers(0.01), MakeWedge(20.0), MakeWedge(5.0) })
  {
    SteinerPointRefinerOptions options;
    options.TetrahedraAcrossLayers = 3;
    const SteinerPointRefinerOutput output = Refine(soup, options);
    EXPECT_EQ(output.Report.TooLarge, 0);
    EXPECT_LT(output.Mesh.Tetrahedra.size(), 20000u);
  }
}

TEST(SteinerPointRefiner, PlatesAndLayersAreFilledUpToTheirAspectRatios)
{
  SteinerPointRefinerOptions options;
  const auto refine = [&](const PolygonSoup& soup)
  {
    const SteinerPointRefinerOutput output = Refine(soup, options);
    EXPECT_EQ(output.Report.Slivers, 0);
    return output.Report;
  };
  // A plate by itself, and a layer between regions, each 30 times as wide as thick.
  const PolygonSoup plate = MakeBox({ 1.0, 1.0, 1.0 / 30.0 });
  const PolygonSoup layer = MakeLayers(1.0 / 30.0);
  ExpectNoFaults(refine(plate));
  EXPECT_GT(refine(layer).Inevitable, 0);
  options.LayerAspectRatio = 25.0;
  EXPECT_GT(refine(plate).Inevitable, 0);
  EXPECT_GT(refine(layer).Inevitable, 0);
  options.LayerAspectRatio = 35.0;
  ExpectNoFaults(refine(plate));
  ExpectNoFaults(refine(layer));
}

TEST(SteinerPointRefiner, PlaneAnglesExcuseNoSlivers)
{
  // Edges that meet at the apex make faces narrow there, but no dihedral angle has to be small.
  for (double angle : { 13.0, 17.0, 20.0, 25.0 })
  {
    SCOPED_TRACE(angle);
    const Stage3 stage = MakeMesh(MakePyramid(angle));
    SteinerPointRefinerInput input;
    input.Mesh = &stage.Output.Mesh;
    SteinerPointRefinerOptions options;
    options.MaximumEdgeLength = 0.7;
    SteinerPointRefinerOutput output;
    ASSERT_TRUE(RefineBySteinerPoints(input, options, {}, output).IsOk());
    ExpectRight(input, options, output);
    double smallest = 180.0;
    for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
    {
      const std::array<Vec3, 4> v = GetCorners(output.Mesh.Points, ids);
      smallest = std::min(smallest, GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]));
    }
    EXPECT_GE(smallest, options.DihedralAngleTarget);
    std::printf("%g degrees: %zu tetrahedra, smallest angle %.1f\n", angle,
      output.Mesh.Tetrahedra.size(), smallest);
  }
}

TEST(SteinerPointRefiner, LongEdgesCloseToEachOtherSetTheSize)
{
  // The only short edges of a low step are at its ends.
  const Stage3 mesh =
    MakeMesh(MakePrism({ { 0.0, 0.0, 0.0 }, { 2.0, 0.0, 0.0 }, { 2.0, 0.0, 1.0 }, { 1.0, 0.0, 1.0 },
                         { 1.0, 0.0, 1.1 }, { 0.0, 0.0, 1.1 } },
      6.0));
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  ExpectNoFaults(Refine(input, SteinerPointRefinerOptions()).Report);
}

TEST(SteinerPointRefiner, ManyEdgesAtOnePointAreNotRefinedForEver)
{
  // A cone of many facets: plane angles of 3 degrees at the apex.
  constexpr Id count = 36;
  PolygonSoup soup;
  soup.Points.push_back({ 0.0, 0.0, 3.0 });
  for (Id i = 0; i < count; ++i)
  {
    soup.Points.push_back({ std::cos(2.0 * Pi * i / count), std::sin(2.0 * Pi * i / count), 0.0 });
    soup.Connectivity.insert(soup.Connectivity.end(), { 0, 1 + i, 1 + (i + 1) % count });
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  for (Id i = count; i > 0; --i)
  {
    soup.Connectivity.push_back(i);
  }
  soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  const Stage3 mesh = MakeMesh(soup);
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  const SteinerPointRefinerOutput output = Refine(input, SteinerPointRefinerOptions());
  EXPECT_EQ(output.Report.BadlyShaped, 0);
  EXPECT_EQ(output.Report.Slivers, 0);
  EXPECT_LT(output.Mesh.Tetrahedra.size(), 2000u);
}

TEST(SteinerPointRefiner, SplitsEdgesWithNegativeCouplings)
{
  PolygonSoup soup;
  soup.Points = { { 2.0, 1.0, 0.0 }, { 3.0, 1.0, 0.0 }, { 0.0, 5.0, 0.0 }, { 4.0, 5.0, 6.0 } };
  soup.Connectivity = { 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3 };
  soup.Offsets = { 0, 3, 6, 9, 12 };
  const Stage3 mesh = MakeMesh(soup);
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  SteinerPointRefinerOptions options;
  // Nothing else is asked for.
  options.RadiusEdgeRatio = 0.0;
  options.DihedralAngleTarget = 0.0;
  const SteinerPointRefinerReport report = Refine(input, options).Report;
  EXPECT_GT(report.BoundaryPoints, 0);
  ExpectNoFaults(report);
}

TEST(SteinerPointRefiner, FollowsTheSizing)
{
  const Stage3 mesh = MakeMesh(MakeBox({ 1.0, 1.0, 1.0 }));
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  input.Sizing = [](const Vec3& p) { return LocalSpacing(0.02 + 0.4 * Norm(p)); };
  const SteinerPointRefinerOutput output = Refine(input, SteinerPointRefinerOptions());
  ExpectNoFaults(output.Report);
  for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
  {
    const std::vector<Vec3>& p = output.Mesh.Points;
    const double size = 0.02 + 0.4 * Norm(0.25 * (p[ids[0]] + p[ids[1]] + p[ids[2]] + p[ids[3]]));
    for (const auto& edge : TetrahedronEdges)
    {
      EXPECT_LE(Distance(p[ids[edge[0]]], p[ids[edge[1]]]), size);
    }
  }
}

TEST(SteinerPointRefiner, GivenPointsStayUnlessTheyAreFree)
{
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(0.2, 0.8);
  std::vector<Vec3> points;
  for (int i = 0; i < 100; ++i)
  {
    points.push_back({ uniform(generator), uniform(generator), uniform(generator) });
  }
  const Stage3 mesh = MakeMesh(MakeBox({ 1.0, 1.0, 1.0 }), points);
  const std::size_t count = mesh.Output.Mesh.Points.size();
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  const auto countKept = [](const SteinerPointRefinerOutput& output)
  {
    return static_cast<std::size_t>(std::count_if(output.PointSources.begin(),
      output.PointSources.end(), [](Id source) { return source != NoId; }));
  };
  const SteinerPointRefinerOutput fixed = Refine(input, SteinerPointRefinerOptions());
  EXPECT_EQ(countKept(fixed), count);

  input.IsFree.assign(count, 1);
  const SteinerPointRefinerOutput moved = Refine(input, SteinerPointRefinerOptions());
  EXPECT_LT(countKept(moved), count);
  EXPECT_GT(moved.Report.MovedPoints, 0);
  EXPECT_EQ(moved.Report.Slivers, 0);

  // Points put in and taken out, and nothing else: no quality is asked for.
  input.IsFree.clear();
  input.IsRemoved.assign(count, 1);
  input.NewPoints = { { 0.5, 0.5, 0.5 }, { 0.25, 0.5, 0.5 }, { 3.0, 0.0, 0.0 }, { 0.0, 0.5, 0.5 },
    { 0.5, 0.5, 0.5 } };
  SteinerPointRefinerOptions none;
  none.RadiusEdgeRatio = 0.0;
  none.DihedralAngleTarget = 0.0;
  const SteinerPointRefinerOutput changed = Refine(input, none);
  EXPECT_EQ(changed.Report.RemovedPoints, 100);
  EXPECT_EQ(changed.Report.InteriorPoints, 0);
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_EQ(
      std::count(changed.Mesh.Points.begin(), changed.Mesh.Points.end(), input.NewPoints[i]), 1);
  }
  EXPECT_EQ(countKept(changed), count - 100);

  // Free points that are close to others go.
  input = SteinerPointRefinerInput();
  input.Mesh = &mesh.Output.Mesh;
  input.IsFree.assign(count, 1);
  none.MinimumEdgeLength = 0.1;
  const SteinerPointRefinerOutput coarse = Refine(input, none);
  EXPECT_GT(coarse.Report.RemovedPoints, 0);
  for (const TetrahedronIds& ids : coarse.Mesh.Tetrahedra)
  {
    for (const auto& edge : TetrahedronEdges)
    {
      EXPECT_GE(Distance(coarse.Mesh.Points[ids[edge[0]]], coarse.Mesh.Points[ids[edge[1]]]), 0.1);
    }
  }
}

TEST(SteinerPointRefiner, MovesFreePointsOfTheSurfaceInTheirFacetsOnly)
{
  // Points on facets and edges, close to the middle of the box: slivers have surface points only.
  std::size_t splits[2] = { 0, 0 };
  for (unsigned int seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> uniform(0.2, 0.5);
    const Vec3 size{ 1.0, 1.0, uniform(generator) };
    const Stage3 box = MakeMesh(MakeBox(size));
    SteinerPointRefinerInput input;
    input.Mesh = &box.Output.Mesh;
    SteinerPointRefinerOptions options;
    options.RadiusEdgeRatio = 0.0;
    options.DihedralAngleTarget = 0.0;
    options.MaximumEdgeLength = uniform(generator);
    const SteinerPointRefinerOutput coarse = Refine(input, options);
    EXPECT_TRUE(std::all_of(
      coarse.IsFree.begin(), coarse.IsFree.begin() + 8, [](char isFree) { return isFree == 0; }));
    EXPECT_TRUE(std::all_of(
      coarse.IsFree.begin() + 8, coarse.IsFree.end(), [](char isFree) { return isFree != 0; }));

    input.Mesh = &coarse.Mesh;
    options.MaximumEdgeLength = 0.0;
    options.DihedralAngleTarget = 15.0;
    for (bool isFree : { false, true })
    {
      input.IsFree = coarse.IsFree;
      if (!isFree)
      {
        input.IsFree.clear();
        input.AreInteriorPointsFree = true;
      }
      const SteinerPointRefinerOutput output = Refine(input, options);
      splits[isFree] += static_cast<std::size_t>(output.Report.BoundaryPoints);
      EXPECT_EQ(output.Report.Slivers, 0);
      const auto isKept = [&](std::size_t p)
      { return output.PointSources[p] == static_cast<Id>(p); };
      for (std::size_t p = 0; p < 8; ++p)
      {
        EXPECT_TRUE(isKept(p));
      }
      // Exactly in the box's facets: each point of the boundary has a coordinate of theirs.
      std::vector<char> isOnSurface(output.Mesh.Points.size(), 0);
      for (const TriangleIds& ids : output.Boundary.Triangles)
      {
        for (Id id : ids)
        {
          isOnSurface[id] = 1;
        }
      }
      for (std::size_t p = 0; p < output.Mesh.Points.size(); ++p)
      {
        const Vec3& x = output.Mesh.Points[p];
        const bool isOnBox =
          x.X == 0.0 || x.X == size.X || x.Y == 0.0 || x.Y == size.Y || x.Z == 0.0 || x.Z == size.Z;
        EXPECT_EQ(isOnSurface[p] != 0, isOnBox);
      }
    }
  }
  EXPECT_LT(splits[1], splits[0]);
  std::printf("points added to the boundary: %zu if all are fixed, %zu if they are free\n",
    splits[0], splits[1]);
}

TEST(SteinerPointRefiner, KeepsSheetsOfTheBoundaryGiven)
{
  // A square in the middle of a box, both sides of which are the same region.
  PolygonSoup soup = MakeBox({ 1.0, 1.0, 1.0 });
  const Id first = static_cast<Id>(soup.Points.size());
  for (const Vec3& p : { Vec3{ 0.25, 0.25, 0.5 }, Vec3{ 0.75, 0.25, 0.5 }, Vec3{ 0.75, 0.75, 0.5 },
         Vec3{ 0.25, 0.75, 0.5 } })
  {
    soup.Points.push_back(p);
    soup.Connectivity.push_back(static_cast<Id>(soup.Points.size()) - 1);
  }
  soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  soup.Labels.push_back({ 0, 0 });
  const Stage3 mesh = MakeMesh(soup);
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  input.Boundary = &mesh.Output.Boundary;
  SteinerPointRefinerOptions options;
  options.MaximumEdgeLength = 0.2;
  const SteinerPointRefinerOutput output = Refine(input, options);
  double area = 0.0;
  for (std::size_t t = 0; t < output.Boundary.Triangles.size(); ++t)
  {
    const TriangleIds& ids = output.Boundary.Triangles[t];
    if (output.Boundary.Labels[t].Front == output.Boundary.Labels[t].Back)
    {
      for (Id id : ids)
      {
        EXPECT_EQ(output.Mesh.Points[id].Z, 0.5);
      }
      area += GetTriangleArea(
        output.Mesh.Points[ids[0]], output.Mesh.Points[ids[1]], output.Mesh.Points[ids[2]]);
    }
  }
  EXPECT_NEAR(area, 0.25, 1e-14);
  EXPECT_EQ(output.PointSources[first], first);
}

/**
 * A needle in the lid of a box, tilted by a ten-thousandth: small triangles at its ends bend by no
 * more than rounded coordinates do, but the edges stay, and with them the facets.
 */
TEST(SteinerPointRefiner, NeedlesKeepTheirFacets)
{
  PolygonSoup soup = MakeBox({ 1.0, 1.0, 1.0 });
  soup.Labels.clear();
  const auto lid = std::find_if(soup.Offsets.begin() + 1, soup.Offsets.end(),
    [&](Id end)
    {
      return std::all_of(soup.Connectivity.begin() + end - 4, soup.Connectivity.begin() + end,
        [&](Id id) { return soup.Points[id].Z == 1.0; });
    });
  ASSERT_NE(lid, soup.Offsets.end());
  const std::vector<Id> corners(
    soup.Connectivity.begin() + *lid - 4, soup.Connectivity.begin() + *lid);
  soup.Connectivity.erase(soup.Connectivity.begin() + *lid - 4, soup.Connectivity.begin() + *lid);
  std::transform(lid, soup.Offsets.end(), lid - 1, [](Id end) { return end - 4; });
  soup.Offsets.pop_back();
  const Id top = static_cast<Id>(soup.Points.size());
  soup.Points.push_back({ 0.5, 1e-4, 1.0 + 1e-8 });
  for (int i = 0; i < 4; ++i)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), { corners[i], corners[(i + 1) % 4], top });
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  const Stage3 mesh = MakeMesh(soup);
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  SteinerPointRefinerOptions options;
  options.MaximumEdgeLength = 0.08;
  // By default the lid counts as plane.
  options.StructuralEdges.FlatnessRatio = RoundedFlatnessRatio;
  const SteinerPointRefinerOutput output = Refine(input, options);
  // Each triangle is in the plane of one that there was.
  for (const TriangleIds& ids : output.Boundary.Triangles)
  {
    double nearest = 1.0;
    for (int i = 0; i < 4; ++i)
    {
      const Vec3& a = soup.Points[corners[i]];
      const Vec3 normal = Cross(soup.Points[corners[(i + 1) % 4]] - a, soup.Points[top] - a);
      double farthest = 0.0;
      for (Id id : ids)
      {
        farthest =
          std::max(farthest, std::abs(Dot(output.Mesh.Points[id] - a, normal)) / Norm(normal));
      }
      nearest = std::min(nearest, farthest);
    }
    if (std::all_of(ids.begin(), ids.end(), [&](Id id) { return output.Mesh.Points[id].Z >= 1.0; }))
    {
      EXPECT_LT(nearest, 1e-14);
    }
  }
  EXPECT_EQ(output.Report.Slivers, 0);
  EXPECT_EQ(output.Report.BadlyShaped, 0);
  std::printf("%zu tetrahedra, %d inevitable\n", output.Mesh.Tetrahedra.size(),
    static_cast<int>(output.Report.Inevitable));
}

/** A pyramid with an edge at its apex that runs a little above a facet which it does not belong to. */
TEST(SteinerPointRefiner, EdgesCloseToFacetsEnd)
{
  for (double height : { 0.2, 0.05, 0.001 })
  {
    SCOPED_TRACE(height);
    PolygonSoup soup;
    soup.Points = { { 0.0, 0.0, 0.0 }, { 1.0, 0.5, 0.0 }, { 1.0, 0.5, 1.0 }, { 1.0, 0.0, height },
      { 1.0, -0.5, 1.0 }, { 1.0, -0.5, 0.0 } };
    soup.Connectivity = { 1, 2, 3, 4, 5 };
    soup.Offsets.push_back(5);
    for (Id i = 1; i <= 5; ++i)
    {
      soup.Connectivity.insert(soup.Connectivity.end(), { i % 5 + 1, i, 0 });
      soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    }
    const Stage3 mesh = MakeMesh(soup);
    SteinerPointRefinerInput input;
    input.Mesh = &mesh.Output.Mesh;
    const SteinerPointRefinerOutput output = Refine(input, {});
    EXPECT_EQ(output.Report.Slivers, 0);
    EXPECT_EQ(output.Report.BadlyShaped, 0);
    EXPECT_LT(output.Mesh.Tetrahedra.size(), 1000u);
    std::printf("%zu tetrahedra, %d inevitable\n", output.Mesh.Tetrahedra.size(),
      static_cast<int>(output.Report.Inevitable));
  }
}

/** Also where the number of points is limited while threads look ahead. */
TEST(SteinerPointRefiner, DoesNotDependOnThreads)
{
  for (unsigned int seed = 1; seed <= 2; ++seed)
  {
    std::mt19937_64 generator(seed);
    const Stage3 mesh = MakeMesh(MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 1, 1.0));
    SteinerPointRefinerInput input;
    input.Mesh = &mesh.Output.Mesh;
    SteinerPointRefinerOptions options;
    options.DihedralAngleTarget = seed % 2 == 0 ? 20.0 : 15.0;
    options.MaximumEdgeLength = 0.12;
    const std::size_t size = Refine(input, options).Mesh.Points.size();
    for (const Id limit : { Id(0), static_cast<Id>(size - mesh.Output.Mesh.Points.size()) - 30 })
    {
      options.MaximumNewPoints = limit;
      const SteinerPointRefinerOutput one = Refine(input, options);
      for (const int threads : { 2, 5 })
      {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", threads " + std::to_string(threads));
        const SteinerPointRefinerOutput several = Refine(input, options, ExecutionContext(threads));
        EXPECT_EQ(one.Mesh.Points, several.Mesh.Points);
        EXPECT_TRUE(std::equal(one.Mesh.Tetrahedra.begin(), one.Mesh.Tetrahedra.end(),
          several.Mesh.Tetrahedra.begin(), several.Mesh.Tetrahedra.end()));
        EXPECT_EQ(one.Faults, several.Faults);
      }
    }
  }
}

TEST(SteinerPointRefiner, StopsAtALimitAndOnRequest)
{
  const Stage3 mesh = MakeMesh(MakeBox({ 1.0, 1.0, 1.0 }));
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  SteinerPointRefinerOptions options;
  options.MaximumVolume = 1e-5;
  options.MaximumNewPoints = 500;
  const SteinerPointRefinerOutput stopped = Refine(input, options);
  EXPECT_GT(stopped.Report.TooLarge, 0);

  options.MaximumNewPoints = 0;
  options.MaximumVolume = 1e-4;
  double last = 0.0;
  int calls = 0;
  SteinerPointRefinerOutput output;
  const ExecutionContext observed(
    [&](double fraction, const char*)
    {
      EXPECT_GE(fraction, last - 1e-12);
      EXPECT_LE(fraction, 1.0);
      last = fraction;
      ++calls;
    },
    {});
  EXPECT_TRUE(RefineBySteinerPoints(input, options, observed, output).IsOk());
  EXPECT_GT(calls, 10);
  for (int limit : { 1, 5, calls / 2, calls - 1 })
  {
    int count = 0;
    const ExecutionContext aborted({}, [&] { return ++count >= limit; });
    EXPECT_TRUE(RefineBySteinerPoints(input, options, aborted, output).IsAborted());
    EXPECT_TRUE(output.Mesh.Tetrahedra.empty());
  }
}

TEST(SteinerPointRefiner, BadInputIsNamed)
{
  const Stage3 good = MakeMesh(MakeBox({ 1.0, 1.0, 1.0 }));
  SteinerPointRefinerInput input;
  SteinerPointRefinerOutput output;
  const auto refine = [&]
  {
    const Status status = RefineBySteinerPoints(input, {}, {}, output);
    EXPECT_EQ(status.Code, StatusCode::InvalidInput);
    EXPECT_TRUE(output.Mesh.Tetrahedra.empty());
    return status;
  };
  TetMesh mesh = good.Output.Mesh;
  input.Mesh = &mesh;
  std::swap(mesh.Tetrahedra[2][0], mesh.Tetrahedra[2][1]);
  const std::vector<Id> cells = refine().Cells;
  EXPECT_TRUE(std::find(cells.begin(), cells.end(), 2) != cells.end());
  mesh = good.Output.Mesh;
  mesh.Regions[1] = OutsideRegion;
  EXPECT_EQ(refine().Cells, std::vector<Id>{ 1 });
  mesh = good.Output.Mesh;
  input.NewPoints = { { 0.5, 0.5, 0.5 }, { 0.5, std::nan(""), 0.5 } };
  EXPECT_EQ(refine().Points, std::vector<Id>{ 1 });

  input.NewPoints.clear();
  TriangleMesh boundary = good.Output.Boundary;
  input.Boundary = &boundary;
  boundary.Triangles.pop_back();
  boundary.Labels.pop_back();
  EXPECT_NE(refine().Message.find("1 facets"), std::string::npos);
  boundary = good.Output.Boundary;
  boundary.Points.pop_back();
  EXPECT_EQ(refine().Code, StatusCode::InvalidInput);
  boundary = good.Output.Boundary;
  // Of the box's diagonals only the one from the first point is an edge.
  boundary.Triangles.push_back({ 1, 6, 0 });
  boundary.Labels.push_back({ 0, 0 });
  const Status status = refine();
  EXPECT_EQ(status.Cells.size(), 1u) << status.Message;
}
