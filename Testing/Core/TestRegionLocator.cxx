// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Sizing/RegionLocator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace cdm;

namespace
{
TriangleMesh Triangulate(const PolygonSoup& soup)
{
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output.Surface;
}

void AppendBox(PolygonSoup& soup, const Vec3& low, double size, const RegionPair& labels)
{
  const PolygonSoup box = CellComplex({ size, size, size }).GetSoup();
  const Id first = static_cast<Id>(soup.Points.size());
  for (const Vec3& p : box.Points)
  {
    soup.Points.push_back(low + p);
  }
  for (Id polygon = 0; polygon < box.GetNumberOfPolygons(); ++polygon)
  {
    for (Id i = 0; i < box.GetPolygonSize(polygon); ++i)
    {
      soup.Connectivity.push_back(first + box.GetPolygon(polygon)[i]);
    }
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    soup.Labels.push_back(labels);
  }
}

/** The locator finds the centers of all tetrahedra in the regions that the mesh gives them. */
void ExpectSameRegionsAsMesh(const TriangleMesh& surface)
{
  DelaunaySurfaceRefinerInput refinerInput;
  refinerInput.Surface = &surface;
  DelaunaySurfaceRefinerOutput refined;
  ASSERT_TRUE(RefineDelaunaySurface(refinerInput, {}, {}, refined).IsOk());
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &refined.Surface;
  AdvancingFrontTetrahedralizerOutput output;
  const Status meshed = TetrahedralizeByAdvancingFront(input, {}, {}, output);
  ASSERT_TRUE(meshed.IsOk()) << meshed.Message;
  RegionLocator locator(surface);
  const Status status = locator.Build();
  ASSERT_TRUE(status.IsOk()) << status.Message;
  for (std::size_t t = 0; t < output.Mesh.Tetrahedra.size(); ++t)
  {
    Vec3 center;
    for (const Id id : output.Mesh.Tetrahedra[t])
    {
      center = center + 0.25 * output.Mesh.Points[id];
    }
    EXPECT_EQ(locator.Locate(center), output.Mesh.Regions[t]) << t;
  }
}
} // namespace

TEST(RegionLocator, AgreesWithTheMeshOfRandomComplexes)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    PolygonSoup soup = MakeTurnedComplex(generator, { 1.0, 1.2, 0.8 }, 4, 0.7);
    ExpectSameRegionsAsMesh(Triangulate(soup));
    // Without labels the enclosed segments are numbered as the mesh does it.
    soup.Labels.clear();
    ExpectSameRegionsAsMesh(Triangulate(soup));
  }
}

TEST(RegionLocator, FindsTheInnermostOfNestedBodies)
{
  // Boxes in boxes: 9 > 7 > 5 > 3 > 1, the third one labelled as a cavity.
  PolygonSoup soup;
  AppendBox(soup, { 0.0, 0.0, 0.0 }, 9.0, { OutsideRegion, 4 });
  AppendBox(soup, { 1.0, 1.0, 1.0 }, 7.0, { 4, 8 });
  AppendBox(soup, { 2.0, 2.0, 2.0 }, 5.0, { 8, OutsideRegion });
  AppendBox(soup, { 3.0, 3.0, 3.0 }, 3.0, { OutsideRegion, 2 });
  AppendBox(soup, { 4.0, 4.0, 4.0 }, 1.0, { 2, 6 });
  AppendBox(soup, { 12.0, 0.0, 0.0 }, 2.0, { OutsideRegion, 1 });
  TriangleMesh surface = Triangulate(soup);
  RegionLocator labelled(surface);
  ASSERT_TRUE(labelled.Build().IsOk());
  const Id expected[6] = { 4, 8, OutsideRegion, 2, 6, 1 };
  const double places[6] = { 0.5, 1.5, 2.5, 3.5, 4.5, 12.5 };
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(labelled.Locate({ places[i], i < 5 ? 4.5 : 0.5, i < 5 ? 4.5 : 0.5 }), expected[i]);
  }
  EXPECT_EQ(labelled.Locate({ 11.0, 1.0, 1.0 }), OutsideRegion);
  EXPECT_EQ(labelled.Locate({ 100.0, 4.5, 4.5 }), OutsideRegion);
  surface.Labels.clear();
  RegionLocator unlabelled(surface);
  ASSERT_TRUE(unlabelled.Build().IsOk());
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(unlabelled.Locate({ places[i], i < 5 ? 4.5 : 0.5, i < 5 ? 4.5 : 0.5 }), i);
  }
}

TEST(RegionLocator, IsExactOnAndBesideTheSurface)
{
  PolygonSoup soup = CellComplex({ 1.0, 1.0, 1.0 }).GetSoup();
  const TriangleMesh box = Triangulate(soup);
  RegionLocator straight(box);
  ASSERT_TRUE(straight.Build().IsOk());
  const double below = std::nextafter(1.0, 0.0);
  const double above = std::nextafter(1.0, 2.0);
  for (const double y : { 0.25, 0.5, 0.75 })
  {
    for (const double z : { 0.25, 0.5, 0.7 })
    {
      EXPECT_EQ(straight.Locate({ 1.0, y, z }), OutsideRegion);
      EXPECT_EQ(straight.Locate({ below, y, z }), 0);
      EXPECT_EQ(straight.Locate({ above, y, z }), OutsideRegion);
      EXPECT_EQ(straight.Locate({ std::nextafter(0.0, 1.0), y, z }), 0);
      EXPECT_EQ(straight.Locate({ 0.0, y, z }), OutsideRegion);
    }
  }
  // Of a turned box only the vertices lie on the surface for sure.
  std::mt19937_64 generator(3);
  Rotate(soup.Points, MakeRandomDirection(generator), 1.1);
  const TriangleMesh turned = Triangulate(soup);
  RegionLocator locator(turned);
  ASSERT_TRUE(locator.Build().IsOk());
  for (const Vec3& p : turned.Points)
  {
    EXPECT_EQ(locator.Locate(p), OutsideRegion);
  }
}

TEST(RegionLocator, MeasuresClearanceInSpacings)
{
  const TriangleMesh box = Triangulate(CellComplex({ 1.0, 1.0, 1.0 }).GetSoup());
  RegionLocator locator(box);
  ASSERT_TRUE(locator.Build().IsOk());
  const Vec3 p{ 0.5, 0.5, 0.125 };
  EXPECT_TRUE(locator.IsClear(p, 0.25, 0.5));
  EXPECT_FALSE(locator.IsClear(p, 0.2501, 0.5));
  EXPECT_TRUE(locator.IsClear(p, LocalSpacing(Vec3{ 1.0, 1.0, 0.25 }), 0.5));
  EXPECT_FALSE(locator.IsClear(p, LocalSpacing(Vec3{ 1.01, 1.0, 0.25 }), 0.5));
  EXPECT_FALSE(locator.IsClear(p, 1.0, 0.2, { 0, OutsideRegion }));
  EXPECT_FALSE(locator.IsClear(p, 1.0, 0.2, { OutsideRegion, 0 }));
  EXPECT_TRUE(locator.IsClear(p, 1.0, 0.2, { 0, 1 }));
}

TEST(RegionLocator, RefusesOpenSurfacesAndWrongLabels)
{
  PolygonSoup soup = CellComplex({ 1.0, 1.0, 1.0 }).GetSoup();
  TriangleMesh surface = Triangulate(soup);
  surface.Labels[3] = { OutsideRegion, 5 };
  RegionLocator wrong(surface);
  Status status = wrong.Build();
  EXPECT_EQ(status.Code, StatusCode::NotClosed);
  EXPECT_EQ(status.Cells, std::vector<Id>{ 3 });

  soup.Offsets.pop_back();
  soup.Connectivity.resize(soup.Offsets.back());
  soup.Labels.pop_back();
  surface = Triangulate(soup);
  RegionLocator openLabelled(surface);
  EXPECT_EQ(openLabelled.Build().Code, StatusCode::NotClosed);
  surface.Labels.clear();
  RegionLocator open(surface);
  status = open.Build();
  EXPECT_EQ(status.Code, StatusCode::NotClosed);
  EXPECT_NE(status.Message.find("encloses nothing"), std::string::npos);
  EXPECT_FALSE(status.Cells.empty());
}
