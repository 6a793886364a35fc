// SPDX-License-Identifier: BSD-3-Clause
// Structures from a layout and process steps: closed regions with volumes in closed form, the same
// device as the source makes, and meshes that fill them.
#include "FilterTesting.h"

#include <vtkBoundaryTriangulator.h>
#include <vtkConformingDelaunayMesher.h>
#include <vtkLayoutExtruder.h>
#include <vtkMath.h>
#include <vtkTechnologyStructureSource.h>
#include <vtkTriangle.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

using namespace testing_filters;

namespace
{
/** Polygons in the plane with their masks. */
class LayoutBuilder
{
public:
  void AddPolygon(int mask, const std::vector<std::array<double, 2>>& outline)
  {
    std::vector<vtkIdType> ids;
    for (const std::array<double, 2>& point : outline)
    {
      // The height does not matter.
      ids.push_back(this->Surface.AddPoint(point[0], point[1], 7.0 * mask));
    }
    this->Surface.AddPolygon(std::move(ids));
    this->Masks->InsertNextValue(mask);
  }
  void AddRectangle(int mask, double x0, double x1, double y0, double y1)
  {
    this->AddPolygon(mask, { { x0, y0 }, { x1, y0 }, { x1, y1 }, { x0, y1 } });
  }
  vtkSmartPointer<vtkPolyData> Build()
  {
    auto layout = this->Surface.Build();
    this->Masks->SetName("Mask");
    layout->GetCellData()->AddArray(this->Masks);
    return layout;
  }

private:
  SurfaceBuilder Surface;
  vtkNew<vtkIntArray> Masks;
};

/** Volumes by the divergence theorem, from the polygons and their labels. */
std::map<int, double> GetVolumes(vtkPolyData* boundary)
{
  std::map<int, double> volumes;
  vtkDataArray* labels = boundary->GetCellData()->GetArray("BoundaryLabels");
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < boundary->GetNumberOfCells(); ++i)
  {
    boundary->GetCellPoints(i, ids);
    double volume = 0.0;
    double a[3], b[3], c[3];
    boundary->GetPoint(ids->GetId(0), a);
    for (vtkIdType j = 1; j + 1 < ids->GetNumberOfIds(); ++j)
    {
      boundary->GetPoint(ids->GetId(j), b);
      boundary->GetPoint(ids->GetId(j + 1), c);
      volume += vtkMath::Determinant3x3(a, b, c) / 6.0;
    }
    volumes[static_cast<int>(labels->GetComponent(i, 1))] += volume;
    volumes[static_cast<int>(labels->GetComponent(i, 0))] -= volume;
  }
  return volumes;
}

/** Closed regions, which the mesher takes without a T-junction, gap or overlap. */
void CheckStructure(vtkLayoutExtruder* extruder, const std::map<int, double>& expected)
{
  vtkNew<EventRecorder> recorder;
  recorder->Watch(extruder);
  extruder->Update();
  extruder->RemoveObserver(recorder);
  EXPECT_EQ(recorder->Errors, "");
  vtkPolyData* boundary = extruder->GetOutput();
  ASSERT_GT(boundary->GetNumberOfCells(), 0);
  std::map<int, double> volumes = GetVolumes(boundary);
  EXPECT_EQ(volumes.size(), expected.size() + 1);
  double total = 0.0;
  for (const auto& [region, volume] : expected)
  {
    EXPECT_NEAR(volumes[region], volume, 1e-12) << "region " << region;
    total += volume;
  }
  EXPECT_NEAR(volumes[-1], -total, 1e-12);

  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputConnection(extruder->GetOutputPort());
  triangulator->Update();
  EXPECT_EQ(vtkPolyData::SafeDownCast(triangulator->GetOutputDataObject(1))->GetNumberOfCells(), 0)
    << "problems are found";
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputConnection(extruder->GetOutputPort());
  mesher->Update();
  for (const auto& [region, volume] : expected)
  {
    EXPECT_NEAR(GetVolume(mesher->GetOutput(), region), volume, 1e-12) << "region " << region;
  }
}

TEST(LayoutExtruder, RectanglesThatCross)
{
  LayoutBuilder layout;
  layout.AddRectangle(0, 0.0, 3.0, 1.0, 2.0);
  layout.AddRectangle(1, 1.0, 2.0, 0.0, 3.0);
  vtkNew<vtkLayoutExtruder> extruder;
  extruder->SetInputData(layout.Build());
  // A substrate, a line, an oxide over all, a line above that crosses the first, with a plug where
  // both are: the last step of a place decides.
  extruder->SetMargin(0.5);
  extruder->AddStep(-1, -1.0, 0.0, 0);
  extruder->AddStep(-1, 0.0, 3.0, 1);
  extruder->AddStep(0, 0.0, 0.5, 2);
  extruder->AddStep(1, 1.5, 2.0, 3);
  extruder->AddRegionName("Bulk");
  extruder->AddRegionName("Oxide");
  CheckStructure(extruder, { { 0, 16.0 }, { 1, 48.0 - 3.0 }, { 2, 1.5 }, { 3, 1.5 } });
  EXPECT_EQ(
    GetTexts(extruder->GetOutput(), "RegionNames"), (std::vector<std::string>{ "Bulk", "Oxide" }));

  // A trench etched where the masks were, and open; the lines stay.
  extruder->AddStep(0, 0.5, 3.0, -1);
  CheckStructure(
    extruder, { { 0, 16.0 }, { 1, 45.0 - 3.0 * 2.5 + 1.0 * 0.5 }, { 2, 1.5 }, { 3, 1.0 } });
  extruder->RemoveAllSteps();
  extruder->RemoveAllRegionNames();
  extruder->AddStep(0, 0.0, 1.0, 4);
  CheckStructure(extruder, { { 4, 3.0 } });
  EXPECT_EQ(extruder->GetOutput()->GetNumberOfCells(), 6);
  EXPECT_EQ(extruder->GetOutput()->GetNumberOfPoints(), 8);
}

TEST(LayoutExtruder, PolygonsThatTouchOverlapAndRepeat)
{
  LayoutBuilder layout;
  // An L, a rectangle with an edge in common with it, the same again, a hole by a bridge.
  layout.AddPolygon(
    0, { { 0.0, 0.0 }, { 3.0, 0.0 }, { 3.0, 1.0 }, { 1.0, 1.0 }, { 1.0, 3.0 }, { 0.0, 3.0 } });
  layout.AddRectangle(0, 1.0, 2.0, 1.0, 2.0);
  layout.AddRectangle(1, 1.0, 2.0, 1.0, 2.0);
  layout.AddRectangle(2, 0.5, 2.5, 0.5, 2.5);
  vtkNew<vtkLayoutExtruder> extruder;
  extruder->SetInputData(layout.Build());
  extruder->AddStep(0, 0.0, 1.0, 0);
  CheckStructure(extruder, { { 0, 6.0 } });
  extruder->AddStep(1, 0.0, 2.0, 1);
  CheckStructure(extruder, { { 0, 5.0 }, { 1, 2.0 } });
  // The part of the square outside of the others: 4 - 1 - (0.25 + 2 * 0.75).
  extruder->RemoveAllSteps();
  extruder->AddStep(2, 0.0, 1.0, 2);
  extruder->AddStep(0, 0.0, 1.0, 0);
  CheckStructure(extruder, { { 0, 6.0 }, { 2, 1.25 } });
}

/** Slanted edges cross at rounded places: volumes by areas of polygons that are known. */
TEST(LayoutExtruder, TurnedSquares)
{
  LayoutBuilder layout;
  constexpr int count = 5;
  constexpr double pi = 3.14159265358979323846;
  for (int i = 0; i < count; ++i)
  {
    std::vector<std::array<double, 2>> square;
    for (int corner = 0; corner < 4; ++corner)
    {
      const double angle = 0.5 * pi * (corner + static_cast<double>(i) / count);
      square.push_back({ std::cos(angle), std::sin(angle) });
    }
    layout.AddPolygon(i, square);
  }
  // Of all squares together: a star with 4 * count points. In common: a regular polygon with the
  // same incircle as a square.
  vtkNew<vtkLayoutExtruder> extruder;
  extruder->SetInputData(layout.Build());
  for (int i = 0; i < count; ++i)
  {
    extruder->AddStep(i, 0.0, 1.0, 0);
  }
  // A point of the star is at 1, a notch where neighbouring sides meet: at half of the angle.
  const double inradius = std::sqrt(0.5);
  const double step = 0.5 * pi / count;
  const double notch = inradius / std::cos(0.25 * pi - 0.5 * step);
  const double star = 4.0 * count * notch * std::sin(0.5 * step);
  CheckStructure(extruder, { { 0, star } });
}

TEST(LayoutExtruder, RandomRectanglesFillTheirDomain)
{
  const unsigned seed = 20240817;
  std::mt19937 random(seed);
  SCOPED_TRACE(seed);
  std::uniform_int_distribution<int> place(0, 20);
  LayoutBuilder layout;
  bool filled[20][20] = {};
  constexpr int count = 25;
  for (int i = 0; i < count; ++i)
  {
    const int x[2] = { place(random), place(random) };
    const int y[2] = { place(random), place(random) };
    if (x[0] == x[1] || y[0] == y[1])
    {
      continue;
    }
    const auto [x0, x1] = std::minmax(x[0], x[1]);
    const auto [y0, y1] = std::minmax(y[0], y[1]);
    layout.AddRectangle(0, 0.1 * x0, 0.1 * x1, 0.1 * y0, 0.1 * y1);
    for (int u = x0; u < x1; ++u)
    {
      for (int v = y0; v < y1; ++v)
      {
        filled[u][v] = true;
      }
    }
  }
  int cells = 0;
  for (const auto& row : filled)
  {
    cells += static_cast<int>(std::count(std::begin(row), std::end(row), true));
  }
  auto polygons = layout.Build();
  double bounds[6];
  polygons->GetBounds(bounds);
  const double area = (bounds[1] - bounds[0]) * (bounds[3] - bounds[2]);
  vtkNew<vtkLayoutExtruder> extruder;
  extruder->SetInputData(polygons);
  extruder->AddStep(-1, 0.0, 1.0, 0);
  extruder->AddStep(0, 0.0, 0.5, 1);
  std::map<int, double> expected{ { 0, area - 0.005 * cells }, { 1, 0.005 * cells } };
  CheckStructure(extruder, expected);
}

/** The layout and the process of the via plug. */
TEST(LayoutExtruder, MakesADeviceOfTheSource)
{
  vtkNew<vtkTechnologyStructureSource> via;
  via->SetStructureToViaPlug();
  via->Update();
  LayoutBuilder layout;
  layout.AddRectangle(0, -0.5, 0.5, -0.2, 0.2);
  layout.AddRectangle(1, -0.2, 0.2, -0.5, 0.5);
  std::vector<std::array<double, 2>> circle;
  for (int i = 0; i < 24; ++i)
  {
    const double angle = 2.0 * 3.14159265358979323846 * i / 24.0;
    circle.push_back({ 0.15 * std::cos(angle), 0.15 * std::sin(angle) });
  }
  layout.AddPolygon(2, circle);
  vtkNew<vtkLayoutExtruder> extruder;
  extruder->SetInputData(layout.Build());
  extruder->AddStep(-1, -0.3, 0.9, 0);
  extruder->AddStep(0, -0.3, 0.0, 1);
  extruder->AddStep(2, 0.0, 0.6, 2);
  extruder->AddStep(1, 0.6, 0.9, 3);
  std::map<int, double> volumes = GetVolumes(via->GetOutput());
  volumes.erase(-1);
  CheckStructure(extruder, volumes);
}

void ExpectError(
  const std::function<void(vtkLayoutExtruder*, LayoutBuilder&)>& change, const std::string& words)
{
  LayoutBuilder layout;
  layout.AddRectangle(0, 0.0, 1.0, 0.0, 1.0);
  vtkNew<vtkLayoutExtruder> extruder;
  change(extruder, layout);
  extruder->SetInputData(layout.Build());
  ExpectFailure(extruder, { words });
}

TEST(LayoutExtruder, ErrorsNameStepsAndCells)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ExpectError([](vtkLayoutExtruder*, LayoutBuilder&) {}, "no process steps");
  ExpectError([](vtkLayoutExtruder* e, LayoutBuilder&) { e->AddStep(1, 0.0, 1.0, 0); },
    "Step 0: no polygon is of mask 1");
  ExpectError([](vtkLayoutExtruder* e, LayoutBuilder&) { e->AddStep(0, 1.0, 1.0, 0); },
    "Step 0: the top, 1, has to be above the bottom, 1");
  ExpectError([=](vtkLayoutExtruder* e, LayoutBuilder&) { e->AddStep(0, 1.0, nan, 0); }, "Step 0");
  ExpectError([](vtkLayoutExtruder* e, LayoutBuilder&) { e->AddStep(0, 0.0, 1.0, 0.5); },
    "whole numbers from -1 on");
  ExpectError([](vtkLayoutExtruder* e, LayoutBuilder&) { e->AddStep(-2, 0.0, 1.0, 0); },
    "whole numbers from -1 on");
  ExpectError(
    [](vtkLayoutExtruder* e, LayoutBuilder&) { e->AddStep(0, 0.0, 1.0, -1); }, "leave nothing");
  ExpectError(
    [](vtkLayoutExtruder* e, LayoutBuilder& layout)
    {
      layout.AddPolygon(0, { { 0.0, 0.0 }, { 1.0, 1.0 }, { 1.0, 0.0 }, { 0.0, 1.0 } });
      e->AddStep(0, 0.0, 1.0, 0);
    },
    "Cells: 1");
  ExpectError(
    [](vtkLayoutExtruder* e, LayoutBuilder& layout)
    {
      layout.AddRectangle(-3, 0.0, 1.0, 2.0, 3.0);
      e->AddStep(0, 0.0, 1.0, 0);
    },
    "Cells: 1");
  ExpectError(
    [=](vtkLayoutExtruder* e, LayoutBuilder& layout)
    {
      layout.AddRectangle(0, 0.0, nan, 2.0, 3.0);
      e->AddStep(0, 0.0, 1.0, 0);
    },
    "finite");
}

TEST(LayoutExtruder, ReportsProgressAndEndsWhenAborted)
{
  LayoutBuilder layout;
  for (int i = 0; i < 20; ++i)
  {
    layout.AddRectangle(0, 0.0, 20.0, i + 0.25, i + 0.75);
    layout.AddRectangle(0, i + 0.25, i + 0.75, 0.0, 20.0);
  }
  vtkNew<vtkLayoutExtruder> extruder;
  extruder->SetInputData(layout.Build());
  extruder->AddStep(0, 0.0, 1.0, 0);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(extruder);
  extruder->Update();
  ExpectProgress(recorder);
  // 40 lines of an area of 10, less their 400 common squares.
  EXPECT_NEAR(GetVolumes(extruder->GetOutput())[0], 40.0 * 10.0 - 400.0 * 0.25, 1e-9);

  recorder->AbortAt = 0.5;
  extruder->Modified();
  extruder->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(extruder);
}
} // namespace

// The end of a contact lies within a plane: no triangle of the mesh may cross it.
TEST(LayoutExtruder, ContactsReachTheMesh)
{
  LayoutBuilder layout;
  layout.AddRectangle(0, 0.0, 2.0, 0.0, 1.0);
  layout.AddRectangle(1, 0.0, 0.3, 0.0, 1.0);
  layout.AddPolygon(2, { { 1.2, 0.5 }, { 1.5, 0.2 }, { 1.8, 0.5 }, { 1.5, 0.8 } });
  vtkNew<vtkLayoutExtruder> extruder;
  extruder->SetInputData(layout.Build());
  extruder->AddStep(0.0, 0.0, 0.5, 0.0);
  extruder->AddStep(1.0, 0.5, 0.75, 1.0);
  extruder->AddContact(-1.0, 0.0);
  extruder->AddContact(1.0, 0.5);
  extruder->AddContact(2.0, 0.5);
  extruder->AddContactName("substrate");
  extruder->AddContactName("metal");
  extruder->AddContactName("drain");
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetInputConnection(extruder->GetOutputPort());
  mesher->SetMaximumEdgeLength(0.2);
  mesher->Update();
  const auto names = vtkStringArray::SafeDownCast(
    extruder->GetOutput()->GetFieldData()->GetAbstractArray("ContactNames"));
  ASSERT_TRUE(names);
  EXPECT_EQ("drain", names->GetValue(2));

  auto boundary = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
  vtkDataArray* ids = boundary->GetCellData()->GetArray("ContactId");
  vtkDataArray* labels = boundary->GetCellData()->GetArray("BoundaryLabels");
  ASSERT_TRUE(ids && labels);
  std::map<double, double> areas;
  for (vtkIdType i = 0; i < boundary->GetNumberOfCells(); ++i)
  {
    double x[3][3];
    for (int j = 0; j < 3; ++j)
    {
      boundary->GetPoint(boundary->GetCell(i)->GetPointId(j), x[j]);
    }
    areas[ids->GetComponent(i, 0)] += vtkTriangle::TriangleArea(x[0], x[1], x[2]);
    if (ids->GetComponent(i, 0) == 1.0)
    {
      EXPECT_EQ(0.0, labels->GetComponent(i, 0)) << "an interface";
      EXPECT_EQ(1.0, labels->GetComponent(i, 1));
    }
  }
  EXPECT_NEAR(2.0, areas[0.0], 1e-12);
  EXPECT_NEAR(0.3, areas[1.0], 1e-12);
  EXPECT_NEAR(0.18, areas[2.0], 1e-12);

  // Where nothing is, and where nothing can be.
  const auto expectError = [&](double mask, double height, const char* text)
  {
    extruder->RemoveAllContacts();
    extruder->AddContact(mask, height);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(extruder);
    extruder->Update();
    EXPECT_TRUE(Contains(recorder->Errors, text)) << recorder->Errors;
    EXPECT_EQ(0, extruder->GetOutput()->GetNumberOfCells());
  };
  expectError(2.0, 0.75, "Contact 0: there is no boundary");
  expectError(2.0, 0.6, "Contact 0: no step begins or ends at the height 0.6.");
  expectError(7.0, 0.5, "Contact 0: no polygon is of mask 7.");
  expectError(0.5, 0.5, "Contact 0: the mask has to be a whole number");
}
