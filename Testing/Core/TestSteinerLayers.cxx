// SPDX-License-Identifier: BSD-3-Clause
// Steiner points in thin layers and plates, at sharp angles, and at what lies close together.
#include "Core/Surface/FlatFacets.h"
#include "SteinerMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;

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

/** Adds the twelve points and twenty triangles of an icosahedron around the origin. */
void AddIcosahedron(double radius, PolygonSoup& soup)
{
  const Id first = static_cast<Id>(soup.Points.size());
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  const double scale = radius / std::sqrt(1.0 + golden * golden);
  const double length = 2.0 * scale;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int i = 0; i < 4; ++i)
    {
      Vec3 point;
      point[axis] = i % 2 == 0 ? scale : -scale;
      point[(axis + 1) % 3] = i / 2 == 0 ? golden * scale : -golden * scale;
      soup.Points.push_back(point);
    }
  }
  const auto isEdge = [&](Id a, Id b)
  { return Distance(soup.Points[a], soup.Points[b]) < 1.01 * length; };
  const Id end = static_cast<Id>(soup.Points.size());
  for (Id a = first; a < end; ++a)
  {
    for (Id b = a + 1; b < end; ++b)
    {
      for (Id c = b + 1; c < end; ++c)
      {
        if (isEdge(a, b) && isEdge(b, c) && isEdge(c, a))
        {
          soup.Connectivity.insert(soup.Connectivity.end(), { a, b, c });
          soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
        }
      }
    }
  }
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

TEST(SteinerLayers, LongAndFlatBoxesAreNoThinLayers)
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

TEST(SteinerLayers, TurnedLayersAreMeshedAsStraightOnes)
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

TEST(SteinerLayers, ThinLayersStayThinAndSharpWedgesEnd)
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

TEST(SteinerLayers, AsManyTetrahedraAcrossLayersAsAskedFor)
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

TEST(SteinerLayers, NoMoreTetrahedraAcrossThinLayersAndWedges)
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

TEST(SteinerLayers, PlatesAndLayersAreFilledUpToTheirAspectRatios)
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

TEST(SteinerLayers, ShellsAreFilledByTheSizeOfTheirFacets)
{
  // The facets are thirteen times as wide as the shell is thick, the whole sphere is forty times.
  PolygonSoup soup;
  AddIcosahedron(1.0, soup);
  AddIcosahedron(0.9, soup);
  const SteinerPointRefinerOutput output = Refine(soup, SteinerPointRefinerOptions());
  ExpectNoFaults(output.Report);
  std::printf("%zu tetrahedra\n", output.Mesh.Tetrahedra.size());
  EXPECT_LT(output.Mesh.Tetrahedra.size(), 16000u);
}

TEST(SteinerLayers, PlaneAnglesExcuseNoSlivers)
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

TEST(SteinerLayers, SliversAtSharpAnglesAreMendedAsLongAsThatHelps)
{
  // Such angles excuse slivers. Moves in one pass left 27; new points, too, and more passes leave 16.
  Id slivers = 0;
  for (double angle : { 35.0, 40.0, 45.0, 50.0, 55.0 })
  {
    SteinerPointRefinerOptions options;
    options.MaximumEdgeLength = 0.12;
    options.DihedralAngleTarget = 18.0;
    const SteinerPointRefinerOutput output = Refine(MakeWedge(angle), options);
    Id here = 0;
    for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
    {
      const auto [a, b, c, d] = GetCorners(output.Mesh.Points, ids);
      here += GetSmallestDihedralAngle(a, b, c, d) < options.DihedralAngleTarget ? 1 : 0;
    }
    std::printf("%g degrees: %zu tetrahedra, %d slivers\n", angle, output.Mesh.Tetrahedra.size(),
      static_cast<int>(here));
    slivers += here;
  }
  EXPECT_LT(slivers, 20);
}

TEST(SteinerLayers, LongEdgesCloseToEachOtherSetTheSize)
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

TEST(SteinerLayers, ManyEdgesAtOnePointAreNotRefinedForEver)
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

/**
 * A needle in the lid of a box, tilted by a ten-thousandth: small triangles at its ends bend by no
 * more than rounded coordinates do, but the edges stay, and with them the facets.
 */
TEST(SteinerLayers, NeedlesKeepTheirFacets)
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
  // The lid counts as plane by default.
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
TEST(SteinerLayers, EdgesCloseToFacetsEnd)
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
