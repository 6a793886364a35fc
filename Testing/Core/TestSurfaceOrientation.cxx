// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/SurfaceOrientation.h"
#include "Core/Repair/BoundaryTriangulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace cdm;

namespace
{
/** The surface of a box, normals outwards. */
void AddBox(TriangleMesh& mesh, const Vec3& low, const Vec3& high)
{
  const Id first = static_cast<Id>(mesh.Points.size());
  for (int i = 0; i < 8; ++i)
  {
    mesh.Points.push_back(
      { i & 1 ? high.X : low.X, i & 2 ? high.Y : low.Y, i & 4 ? high.Z : low.Z });
  }
  for (const TriangleIds& t :
    std::vector<TriangleIds>{ { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 },
      { 0, 5, 4 }, { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } })
  {
    mesh.Triangles.push_back({ first + t[0], first + t[1], first + t[2] });
  }
}

void Reverse(TriangleMesh& mesh, const std::vector<Id>& triangles)
{
  for (const Id t : triangles)
  {
    std::swap(mesh.Triangles[t][1], mesh.Triangles[t][2]);
  }
}
} // namespace

TEST(SurfaceOrientation, ClosureDecides)
{
  TriangleMesh mesh;
  AddBox(mesh, { 0, 0, 0 }, { 1, 1, 1 });
  const std::vector<TriangleIds> right = mesh.Triangles;
  EXPECT_TRUE(RepairOrientation(mesh).empty());
  Reverse(mesh, { 1, 5, 6 });
  EXPECT_EQ((std::vector<Id>{ 1, 5, 6 }), RepairOrientation(mesh));
  EXPECT_EQ(right, mesh.Triangles);
  // Half of them: outwards wins.
  Reverse(mesh, { 0, 2, 4, 6, 8, 10 });
  EXPECT_EQ((std::vector<Id>{ 0, 2, 4, 6, 8, 10 }), RepairOrientation(mesh));
  EXPECT_EQ(right, mesh.Triangles);
}

TEST(SurfaceOrientation, CavitiesAndOpenSheetsKeepTheirs)
{
  TriangleMesh mesh;
  AddBox(mesh, { 0, 0, 0 }, { 3, 3, 3 });
  AddBox(mesh, { 1, 1, 1 }, { 2, 2, 2 });
  Reverse(mesh, { 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23 });
  EXPECT_TRUE(RepairOrientation(mesh).empty());
  Reverse(mesh, { 14 });
  EXPECT_EQ((std::vector<Id>{ 14 }), RepairOrientation(mesh));

  mesh = {};
  mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } };
  mesh.Triangles = { { 0, 1, 2 }, { 1, 2, 3 } };
  EXPECT_TRUE(RepairOrientation(mesh).empty());
}

TEST(SurfaceOrientation, LabelsDecide)
{
  // Two boxes side by side with a common face, one polygon of the interface turned over: its labels
  // contradict those of its neighbours only because of that.
  PolygonSoup soup;
  for (int i = 0; i < 12; ++i)
  {
    soup.Points.push_back({ double(i % 3), double(i / 3 % 2), double(i / 6) });
  }
  const auto add = [&soup](std::vector<Id> ids, RegionPair labels)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), ids.begin(), ids.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    soup.Labels.push_back(labels);
  };
  for (const Id k : { 0, 1 })
  {
    const RegionPair labels{ OutsideRegion, 10 + k };
    add({ k, 3 + k, 4 + k, 1 + k }, labels);
    add({ 6 + k, 7 + k, 10 + k, 9 + k }, labels);
    add({ k, 1 + k, 7 + k, 6 + k }, labels);
    add({ 3 + k, 9 + k, 10 + k, 4 + k }, labels);
  }
  add({ 0, 6, 9, 3 }, { OutsideRegion, 10 });
  add({ 2, 5, 11, 8 }, { OutsideRegion, 11 });
  add({ 1, 4, 10, 7 }, { 11, 10 });
  BoundaryTriangulatorOutput output;
  ASSERT_TRUE(TriangulateBoundary(soup, {}, {}, output).IsOk());
  EXPECT_EQ(0, output.Report.ReversedPolygons);
  const std::vector<TriangleIds> right = output.Surface.Triangles;

  for (const Id cell : { 0, 5, 10 })
  {
    SCOPED_TRACE(cell);
    PolygonSoup turned = soup;
    std::reverse(
      turned.Connectivity.begin() + 4 * cell, turned.Connectivity.begin() + 4 * cell + 4);
    ASSERT_TRUE(TriangulateBoundary(turned, {}, {}, output).IsOk());
    EXPECT_EQ(1, output.Report.ReversedPolygons);
    EXPECT_EQ(turned.Labels[cell], output.Surface.Labels[2 * cell]);
    const SurfaceProblem& problem = output.Problems.back();
    EXPECT_EQ(SurfaceProblemKind::ReversedPolygon, problem.Kind);
    EXPECT_EQ(cell, problem.Cell);
    // As many triangles turn to each side as before: compare as cycles.
    for (std::size_t t = 0; t < right.size(); ++t)
    {
      const Id region = output.Surface.SourceCells[t];
      const Vec3 n = Cross(output.Surface.Points[output.Surface.Triangles[t][1]] -
          output.Surface.Points[output.Surface.Triangles[t][0]],
        output.Surface.Points[output.Surface.Triangles[t][2]] -
          output.Surface.Points[output.Surface.Triangles[t][0]]);
      const Vec3 m = Cross(output.Surface.Points[right[t][1]] - output.Surface.Points[right[t][0]],
        output.Surface.Points[right[t][2]] - output.Surface.Points[right[t][0]]);
      EXPECT_LT(0.0, Dot(n, m)) << region;
    }
  }

  // Labels that nothing mends stay, for the stages that need them to complain about.
  PolygonSoup wrong = soup;
  wrong.Labels[3].Back = 77;
  ASSERT_TRUE(TriangulateBoundary(wrong, {}, {}, output).IsOk());
  EXPECT_EQ(0, output.Report.ReversedPolygons);
}
