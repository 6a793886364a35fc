// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartRegions.h"
#include "Core/Meshes/MeshInvariants.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace cdm;

namespace
{
/** Two tetrahedra at the triangle (0, 1, 2): point 3 in front of it, point 4 behind it. */
TetMesh MakeTwoTetrahedra()
{
  TetMesh mesh;
  mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } };
  mesh.Tetrahedra = { { 0, 1, 2, 3 }, { 0, 2, 1, 4 } };
  EXPECT_TRUE(BuildNeighbors(mesh).IsOk());
  return mesh;
}

/** Their outside, and the triangle between them if it is wanted. */
void MakeSurface(
  bool hasMiddle, std::vector<TriangleIds>& triangles, std::vector<RegionPair>& regions)
{
  triangles = { { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 }, { 0, 4, 1 }, { 1, 4, 2 }, { 0, 2, 4 } };
  regions.assign(3, { OutsideRegion, 5 });
  regions.resize(6, { OutsideRegion, hasMiddle ? 8 : 5 });
  if (hasMiddle)
  {
    triangles.push_back({ 0, 1, 2 });
    regions.push_back({ 5, 8 });
  }
}
} // namespace

TEST(PartRegions, FillsBothSidesOfATriangle)
{
  const TetMesh mesh = MakeTwoTetrahedra();
  std::vector<TriangleIds> triangles;
  std::vector<RegionPair> sides;
  MakeSurface(true, triangles, sides);
  PartRegions regions(mesh, 5, triangles, sides);
  ASSERT_TRUE(regions.Start().IsOk());
  EXPECT_EQ(regions.TakeNews({ 0, 1 }), (std::vector<Id>{ 0, 1 }));
  EXPECT_EQ(regions.TakeNews({ 0, 1 }), std::vector<Id>()) << "told once";
  EXPECT_EQ(regions.GetRegion(0), 5);
  EXPECT_EQ(regions.GetSideRegion(2 * 6), 5);
  EXPECT_EQ(regions.GetSideRegion(2 * 6 + 1), 8);
  RawVector<Id> found;
  ASSERT_TRUE(regions.Finish(found).IsOk());
  EXPECT_EQ(found, (RawVector<Id>{ 5, 8 }));
}

TEST(PartRegions, HearsFromOtherParts)
{
  // Without the triangle between them both are one region, of which nothing is known here.
  const TetMesh mesh = MakeTwoTetrahedra();
  std::vector<TriangleIds> triangles;
  std::vector<RegionPair> sides;
  MakeSurface(false, triangles, sides);
  for (RegionPair& side : sides)
  {
    side = { PartRegions::Unknown, PartRegions::Unknown };
  }
  PartRegions regions(mesh, 5, triangles, sides);
  ASSERT_TRUE(regions.Start().IsOk());
  EXPECT_EQ(regions.TakeNews({ 0, 1 }), std::vector<Id>());
  RawVector<Id> found;
  ASSERT_TRUE(regions.Finish(found).IsOk());
  EXPECT_EQ(found, (RawVector<Id>{ OutsideRegion, OutsideRegion })) << "what nobody knows";
  ASSERT_TRUE(regions.SetRegion(1, 3).IsOk());
  EXPECT_EQ(regions.TakeNews({ 0 }), std::vector<Id>{ 0 });
  ASSERT_TRUE(regions.SetRegion(0, 3).IsOk());
  EXPECT_EQ(regions.TakeNews({ 0, 1 }), std::vector<Id>()) << "known before";
  ASSERT_TRUE(regions.Finish(found).IsOk());
  EXPECT_EQ(found, (RawVector<Id>{ 3, 3 }));
  const Status status = regions.SetRegion(0, 4);
  EXPECT_EQ(status.Code, StatusCode::NotClosed);
  EXPECT_NE(status.Message.find("Regions 3 and 4 are not separated"), std::string::npos);
}

TEST(PartRegions, NamesTriangles)
{
  const TetMesh mesh = MakeTwoTetrahedra();
  std::vector<TriangleIds> triangles;
  std::vector<RegionPair> sides;
  // Labels that contradict each other: nothing lies between the two regions.
  MakeSurface(true, triangles, sides);
  triangles.pop_back();
  sides.pop_back();
  Status status = PartRegions(mesh, 5, triangles, sides).Start();
  EXPECT_EQ(status.Code, StatusCode::NotClosed);
  EXPECT_EQ(status.Cells, std::vector<Id>{ 3 });
  // A triangle that is no facet, at an own point or at none.
  MakeSurface(true, triangles, sides);
  triangles.push_back({ 2, 3, 4 });
  sides.push_back({ 5, 5 });
  status = PartRegions(mesh, 5, triangles, sides).Start();
  EXPECT_EQ(status.Code, StatusCode::NotDelaunay);
  EXPECT_EQ(status.Cells, std::vector<Id>{ 7 });
  EXPECT_TRUE(PartRegions(mesh, 2, triangles, sides).Start().IsOk());
}

TEST(PartRegions, RefusesRegionsUpToTheHull)
{
  const TetMesh mesh = MakeTwoTetrahedra();
  std::vector<TriangleIds> triangles;
  std::vector<RegionPair> sides;
  MakeSurface(true, triangles, sides);
  triangles.erase(triangles.begin());
  sides.erase(sides.begin());
  PartRegions regions(mesh, 5, triangles, sides);
  ASSERT_TRUE(regions.Start().IsOk());
  RawVector<Id> found;
  const Status status = regions.Finish(found);
  EXPECT_EQ(status.Code, StatusCode::NotClosed);
  EXPECT_NE(status.Message.find("Region 5 is not closed"), std::string::npos) << status.Message;
}
