// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkBoundaryTriangulator.h>
#include <vtkSphereSource.h>
#include <vtkStructuralEdgeExtractor.h>

using namespace testing_filters;

namespace
{
vtkPolyData* GetEdges(vtkStructuralEdgeExtractor* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
}

int CountEdges(vtkStructuralEdgeExtractor* filter, int kind)
{
  vtkDataArray* kinds = FindArray(GetEdges(filter)->GetCellData(), "Kind", 1, VTK_INT);
  int count = 0;
  for (vtkIdType i = 0; kinds && i < kinds->GetNumberOfTuples(); ++i)
  {
    count += kinds->GetComponent(i, 0) == kind;
  }
  return count;
}
} // namespace

TEST(StructuralEdgeExtractorFilter, FindsTheEdgesOfACube)
{
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(MakeCube(true));
  vtkNew<vtkStructuralEdgeExtractor> filter;
  filter->SetInputConnection(triangulator->GetOutputPort());
  filter->Update();
  vtkPolyData* edges = GetEdges(filter);
  ASSERT_EQ(edges->GetNumberOfLines(), 12);
  EXPECT_EQ(edges->GetNumberOfCells(), 12);
  EXPECT_EQ(edges->GetNumberOfPoints(), 8);
  EXPECT_EQ(edges->GetCellData()->GetNumberOfArrays(), 3);
  EXPECT_EQ(CountEdges(filter, vtkStructuralEdgeExtractor::Sharp), 12);
  EXPECT_EQ(filter->GetNumberOfChains(), 12);
  EXPECT_EQ(filter->GetNumberOfCorners(), 8);
  vtkDataArray* angles = FindArray(edges->GetCellData(), "DihedralAngle", 1, VTK_DOUBLE);
  vtkDataArray* chains = FindArray(edges->GetCellData(), "ChainId", 1, VTK_INT);
  for (vtkIdType i = 0; i < 12; ++i)
  {
    EXPECT_NEAR(angles->GetComponent(i, 0), 90.0, 1e-12);
    EXPECT_GE(chains->GetComponent(i, 0), 0);
    EXPECT_LT(chains->GetComponent(i, 0), 12);
  }
  ExpectLinear(edges, 0.0);
  vtkDataArray* ids = FindArray(edges->GetPointData(), "SurfacePointId", 1, VTK_ID_TYPE);
  for (vtkIdType i = 0; i < edges->GetNumberOfPoints(); ++i)
  {
    double x[3];
    edges->GetPoint(i, x);
    const double* y =
      filter->GetOutput()->GetPoint(static_cast<vtkIdType>(ids->GetComponent(i, 0)));
    EXPECT_TRUE(x[0] == y[0] && x[1] == y[1] && x[2] == y[2]);
  }
  // The surface goes through as it is.
  EXPECT_EQ(filter->GetOutput()->GetPolys(), triangulator->GetOutput()->GetPolys());
  EXPECT_TRUE(filter->GetOutput()->GetCellData()->HasArray("BoundaryLabels"));
  EXPECT_TRUE(filter->GetOutput()->GetCellData()->HasArray("PolygonId"));
}

TEST(StructuralEdgeExtractorFilter, FindsInterfacesAndLabelChanges)
{
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(MakeTwoBoxes(true));
  vtkNew<vtkStructuralEdgeExtractor> filter;
  filter->SetInputConnection(triangulator->GetOutputPort());
  filter->Update();
  EXPECT_EQ(CountEdges(filter, vtkStructuralEdgeExtractor::NonManifold), 4);
  EXPECT_EQ(CountEdges(filter, vtkStructuralEdgeExtractor::Sharp), 16);

  // Two triangles of one square with different labels: only their diagonal changes.
  SurfaceBuilder builder;
  builder.AddPoint(0, 0, 0);
  builder.AddPoint(1, 0, 0);
  builder.AddPoint(1, 1, 0);
  builder.AddPoint(0, 1, 0);
  builder.AddPolygon({ 0, 1, 2 }, -1, 0);
  builder.AddPolygon({ 0, 2, 3 }, -1, 1);
  filter->SetInputData(builder.Build(true));
  filter->Update();
  EXPECT_EQ(CountEdges(filter, vtkStructuralEdgeExtractor::LabelChange), 1);
  EXPECT_EQ(CountEdges(filter, vtkStructuralEdgeExtractor::Open), 4);
  vtkDataArray* kinds = GetEdges(filter)->GetCellData()->GetArray("Kind");
  vtkDataArray* angles = GetEdges(filter)->GetCellData()->GetArray("DihedralAngle");
  for (vtkIdType i = 0; i < kinds->GetNumberOfTuples(); ++i)
  {
    const bool isOpen = kinds->GetComponent(i, 0) == vtkStructuralEdgeExtractor::Open;
    EXPECT_NEAR(angles->GetComponent(i, 0), isOpen ? -1.0 : 180.0, 1e-6);
  }
}

TEST(StructuralEdgeExtractorFilter, HonoursTheAccuracyAngle)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(24);
  sphere->SetPhiResolution(24);
  vtkNew<vtkStructuralEdgeExtractor> filter;
  filter->SetInputConnection(sphere->GetOutputPort());
  filter->SetAccuracyAngle(40.0);
  filter->Update();
  EXPECT_EQ(GetEdges(filter)->GetNumberOfCells(), 0);
  filter->SetAccuracyAngle(0.0);
  filter->Update();
  EXPECT_GT(GetEdges(filter)->GetNumberOfCells(), 500);
}

TEST(StructuralEdgeExtractorFilter, RefusesBadInput)
{
  vtkNew<vtkStructuralEdgeExtractor> filter;
  vtkNew<vtkPolyData> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "empty" });
  filter->SetInputData(MakeCube());
  ExpectFailure(filter, { "vtkBoundaryTriangulator", "Cells: 0, 1, 2, 3, 4, 5 (6 in all)" });
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(MakeCube());
  triangulator->Update();
  vtkNew<vtkPolyData> surface;
  surface->DeepCopy(triangulator->GetOutput());
  surface->GetPoints()->SetPoint(3, std::numeric_limits<double>::infinity(), 0.0, 0.0);
  filter->SetInputData(surface);
  ExpectFailure(filter, { "not finite", "Points: 3 (inf, 0, 0)" });
}

TEST(StructuralEdgeExtractorFilter, ReportsProgressAndAborts)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(300);
  sphere->SetPhiResolution(300);
  vtkNew<vtkStructuralEdgeExtractor> filter;
  filter->SetInputConnection(sphere->GetOutputPort());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  ExpectProgress(recorder);
  recorder->AbortAt = 0.05;
  filter->Modified();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(filter);
}
