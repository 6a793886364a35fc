// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkBoundaryTriangulator.h>
#include <vtkIdList.h>
#include <vtkPlatonicSolidSource.h>
#include <vtkSphereSource.h>

using namespace testing_filters;

namespace
{
vtkPolyData* GetProblems(vtkBoundaryTriangulator* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
}

/** Number of problem cells of a kind. */
int CountProblems(vtkBoundaryTriangulator* filter, int kind)
{
  vtkDataArray* kinds = FindArray(GetProblems(filter)->GetCellData(), "ProblemKind", 1, VTK_INT);
  int count = 0;
  for (vtkIdType i = 0; kinds && i < kinds->GetNumberOfTuples(); ++i)
  {
    count += kinds->GetComponent(i, 0) == kind;
  }
  return count;
}
} // namespace

TEST(BoundaryTriangulatorFilter, TriangulatesACubeAndPassesData)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(MakeCube(true));
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_EQ(recorder->Warnings, "");
  vtkPolyData* output = filter->GetOutput();
  EXPECT_EQ(output->GetNumberOfPoints(), 8);
  ASSERT_EQ(output->GetNumberOfPolys(), 12);
  EXPECT_EQ(output->GetNumberOfCells(), 12);
  ExpectLinear(output, 0.0);
  FindArray(output->GetCellData(), "BoundaryLabels", 2, VTK_INT);
  EXPECT_NEAR(GetArea(output, -1, 0), 6.0, 1e-14);
  vtkDataArray* ids = FindArray(output->GetCellData(), "PolygonId", 1, VTK_INT);
  ASSERT_NE(ids, nullptr);
  ASSERT_EQ(ids->GetNumberOfTuples(), 12);
  std::array<int, 6> count{};
  for (int i = 0; i < 12; ++i)
  {
    ++count[static_cast<int>(ids->GetComponent(i, 0))];
  }
  EXPECT_EQ(count, (std::array<int, 6>{ 2, 2, 2, 2, 2, 2 }));
  EXPECT_EQ(GetProblems(filter)->GetNumberOfCells(), 0);
  for (const char* name : { "Cell", "OtherCell" })
  {
    FindArray(GetProblems(filter)->GetCellData(), name, 1, VTK_ID_TYPE);
  }
  EXPECT_EQ(filter->GetNumberOfOpenEdges(), 0);
}

TEST(BoundaryTriangulatorFilter, MakesNoLabelsWhereThereAreNone)
{
  vtkNew<vtkPlatonicSolidSource> solid;
  solid->SetSolidTypeToDodecahedron();
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputConnection(solid->GetOutputPort());
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), 36);
  EXPECT_FALSE(filter->GetOutput()->GetCellData()->HasArray("BoundaryLabels"));
  EXPECT_EQ(filter->GetNumberOfOpenEdges(), 0);
}

TEST(BoundaryTriangulatorFilter, SharesTheInterface)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(MakeTwoBoxes(true));
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 12);
  EXPECT_EQ(filter->GetNumberOfMergedPoints(), 4);
  EXPECT_EQ(filter->GetNumberOfNonManifoldEdges(), 4);
  EXPECT_NEAR(GetArea(filter->GetOutput(), 3, 7), 1.0, 1e-14);
  EXPECT_NEAR(GetArea(filter->GetOutput(), -1, 3), 5.0, 1e-14);
  EXPECT_NEAR(GetArea(filter->GetOutput(), -1, 7), 9.0, 1e-14);
}

TEST(BoundaryTriangulatorFilter, ReadsStripsAndIgnoresLines)
{
  // A tetrahedron: one strip goes around it. Vertices and lines come first in the cell data.
  auto surface = MakePoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } });
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ 0 });
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 1 });
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 0, 2, 1, 3, 0, 2 });
  surface->SetVerts(verts);
  surface->SetLines(lines);
  surface->SetStrips(strips);
  vtkNew<vtkIntArray> ids;
  ids->SetName("PolygonId");
  for (int id : { 10, 11, 12 })
  {
    ids->InsertNextValue(id);
  }
  surface->GetCellData()->AddArray(ids);
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(surface);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "1 vertex cells and 1 lines")) << recorder->Warnings;
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), 4);
  EXPECT_EQ(filter->GetNumberOfOpenEdges(), 0);
  vtkDataArray* passed = filter->GetOutput()->GetCellData()->GetArray("PolygonId");
  ASSERT_NE(passed, nullptr);
  for (vtkIdType i = 0; i < passed->GetNumberOfTuples(); ++i)
  {
    EXPECT_EQ(passed->GetComponent(i, 0), 12);
  }
}

TEST(BoundaryTriangulatorFilter, RepairsAndReports)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  builder.AddPolygon({ 0, 1, 1 });    // 6: no area
  builder.AddPolygon({ 2, 3, 1, 0 }); // 7: polygon 0 once more
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(builder.Build());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  for (const char* text : { "repeated points of polygons. Cells: 6 (1 in all).",
         "without area. Cells: 6 (1 in all).", "repeat others. Cells: 7 (1 in all)." })
  {
    EXPECT_TRUE(Contains(recorder->Warnings, text)) << recorder->Warnings;
  }
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), 12);
  EXPECT_EQ(filter->GetNumberOfDegeneratePolygons(), 1);
  EXPECT_EQ(filter->GetNumberOfDuplicatePolygons(), 1);
  EXPECT_GE(filter->GetNumberOfRepeatedVertices(), 1);
  EXPECT_GE(CountProblems(filter, vtkBoundaryTriangulator::DegeneratePolygon), 1);
  EXPECT_GE(CountProblems(filter, vtkBoundaryTriangulator::DuplicatePolygon), 1);
}

TEST(BoundaryTriangulatorFilter, PatchesGaps)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 }, -1, 0, 1);
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(builder.Build(true));
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfOpenEdges(), 4);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), 10);
  EXPECT_GE(CountProblems(filter, vtkBoundaryTriangulator::OpenEdge), 4);
  filter->SetMaximumGapEdges(4);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfOpenEdges(), 0);
  EXPECT_EQ(filter->GetNumberOfPatchedRings(), 1);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), 12);
  EXPECT_NEAR(GetArea(filter->GetOutput(), -1, 0), 6.0, 1e-14);
}

TEST(BoundaryTriangulatorFilter, ListsSelfIntersections)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(MakeCrossingBoxes());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  // Side 5 of the first box is crossed by the sides 8 to 11 (y and z) of the second.
  EXPECT_TRUE(Contains(recorder->Errors, "Cells: 5, ")) << recorder->Errors;
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  // The segments and the polygons that they are on are told apart.
  EXPECT_GT(GetProblems(filter)->GetNumberOfLines(), 0);
  EXPECT_EQ(CountProblems(filter, vtkBoundaryTriangulator::SelfIntersection),
    GetProblems(filter)->GetNumberOfVerts() + GetProblems(filter)->GetNumberOfLines());
  EXPECT_GE(CountProblems(filter, vtkBoundaryTriangulator::IntersectingPolygon), 5);
  EXPECT_EQ(CountProblems(filter, vtkBoundaryTriangulator::IntersectingPolygon),
    GetProblems(filter)->GetNumberOfPolys());
  vtkDataArray* cells = GetProblems(filter)->GetCellData()->GetArray("Cell");
  vtkDataArray* others = GetProblems(filter)->GetCellData()->GetArray("OtherCell");
  for (vtkIdType i = 0; i < cells->GetNumberOfTuples(); ++i)
  {
    EXPECT_TRUE(cells->GetComponent(i, 0) == 5 || others->GetComponent(i, 0) == 5);
  }

  recorder->Errors.clear();
  filter->RefuseSelfIntersectionsOff();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), 24);
  EXPECT_GT(filter->GetNumberOfSelfIntersections(), 0);
  EXPECT_GE(CountProblems(filter, vtkBoundaryTriangulator::SelfIntersection), 4);
}

TEST(BoundaryTriangulatorFilter, ResolvesSelfIntersections)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(MakeCrossingBoxes());
  filter->ResolveSelfIntersectionsOn();
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  // The cube, and half of the other box in front of its side x = 1.
  double area = 0.0;
  for (vtkIdType cell = 0; cell < filter->GetOutput()->GetNumberOfCells(); ++cell)
  {
    area += vtkTriangle::SafeDownCast(filter->GetOutput()->GetCell(cell))->ComputeArea();
  }
  EXPECT_NEAR(area, 6.0 + 4 * 0.25, 1e-12);
  EXPECT_EQ(filter->GetNumberOfOpenEdges(), 0);
  EXPECT_GT(filter->GetNumberOfSelfIntersections(), 0);
  ExpectLinear(filter->GetOutput());
}

TEST(BoundaryTriangulatorFilter, RefusesEmptyInput)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  vtkNew<vtkPolyData> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "empty" });
  filter->SetInputData(MakePoints({ { 0, 0, 0 } }));
  ExpectFailure(filter, { "no polygons" });
}

TEST(BoundaryTriangulatorFilter, RefusesNaN)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(MakeCubeWithNaN());
  ExpectFailure(filter, { "not finite", "Points: 6 (0, nan, 1)" });
}

TEST(BoundaryTriangulatorFilter, RefusesMissingPoints)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  builder.AddPolygon({ 0, 1, 8 });
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(builder.Build());
  ExpectFailure(filter, { "points that do not exist", "Cells: 6 (1 in all)" });
}

TEST(BoundaryTriangulatorFilter, RefusesWrongLabels)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  auto cube = MakeCube(true);
  cube->GetCellData()->GetArray("BoundaryLabels")->SetComponent(4, 1, -2);
  filter->SetInputData(cube);
  ExpectFailure(filter, { "BoundaryLabels", "Cells: 4 (1 in all)" });
  cube = MakeCube();
  vtkNew<vtkIntArray> labels;
  labels->SetName("BoundaryLabels");
  labels->SetNumberOfTuples(6);
  labels->FillValue(0);
  cube->GetCellData()->AddArray(labels);
  filter->SetInputData(cube);
  ExpectFailure(filter, { "BoundaryLabels", "two integers" });
}

TEST(BoundaryTriangulatorFilter, RecoversAfterAnError)
{
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputData(MakeCubeWithNaN());
  ExpectFailure(filter, {});
  filter->SetInputData(MakeCube());
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), 12);
}

TEST(BoundaryTriangulatorFilter, ReportsProgressAndAborts)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(100);
  sphere->SetPhiResolution(100);
  vtkNew<vtkBoundaryTriangulator> filter;
  filter->SetInputConnection(sphere->GetOutputPort());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  ExpectProgress(recorder);
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
  recorder->AbortAt = 0.05;
  filter->Modified();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(filter);
}
