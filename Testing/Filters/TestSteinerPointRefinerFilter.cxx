// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkAdvancingFrontTetrahedralizer.h>
#include <vtkBoundaryTriangulator.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkSteinerPointRefiner.h>

#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkUnsignedCharArray.h>

using namespace testing_filters;

namespace
{
/**
 * Two boxes that share a side, with mesh points, meshed up to stage 3; its boundary is output 1.
 */
vtkSmartPointer<vtkAdvancingFrontTetrahedralizer> MakeMesher(const std::vector<Point>& points = {})
{
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(MakeTwoBoxes(true));
  vtkNew<vtkDelaunaySurfaceRefiner> refiner;
  refiner->SetInputConnection(triangulator->GetOutputPort());
  auto mesher = vtkSmartPointer<vtkAdvancingFrontTetrahedralizer>::New();
  mesher->SetInputConnection(refiner->GetOutputPort());
  if (!points.empty())
  {
    refiner->SetInputData(1, MakePoints(points));
    mesher->SetInputConnection(1, refiner->GetOutputPort(2));
  }
  mesher->Update();
  return mesher;
}

/** Number of tetrahedra, and smallest dihedral angle in degrees. */
std::pair<vtkIdType, double> Judge(vtkUnstructuredGrid* mesh)
{
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputData(mesh);
  criteria->Update();
  vtkFieldData* summary = criteria->GetOutput()->GetFieldData();
  const auto get = [&](const char* name)
  {
    vtkDataArray* array = summary->GetArray(name);
    EXPECT_NE(array, nullptr) << name;
    return array ? array->GetComponent(0, 0) : -1.0;
  };
  EXPECT_EQ(get("NonDelaunayTetrahedra"), 0.0);
  EXPECT_EQ(get("InvertedTetrahedra"), 0.0);
  EXPECT_EQ(get("FlatTetrahedra"), 0.0);
  return { mesh->GetNumberOfCells(), get("MeshSmallestDihedralAngle") };
}
} // namespace

TEST(SteinerPointRefinerFilter, MakesGoodTetrahedraAndHandsDataOn)
{
  auto mesher = MakeMesher();
  vtkNew<vtkSteinerPointRefiner> filter;
  filter->SetInputConnection(mesher->GetOutputPort());
  filter->SetInputConnection(2, mesher->GetOutputPort(1));
  filter->SetMaximumVolume(0.02);
  filter->SetDihedralAngleTarget(18.0);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  ExpectProgress(recorder);
  vtkUnstructuredGrid* output = filter->GetOutput();
  const auto [count, angle] = Judge(output);
  EXPECT_GT(count, 100);
  EXPECT_GE(angle, 18.0);
  EXPECT_EQ(filter->GetNumberOfSlivers() + filter->GetNumberOfTooLargeTetrahedra(), 0);
  EXPECT_EQ(output->GetCellData()->GetArray("RefinementFault"), nullptr);
  vtkUnstructuredGrid* before = mesher->GetOutput();
  for (int region = 0; region < 2; ++region)
  {
    EXPECT_NEAR(GetVolume(output, region), GetVolume(before, region), 1e-12);
  }
  // Linear data are interpolated exactly, old points are the first.
  ExpectLinear(output);
  for (vtkIdType i = 0; i < before->GetNumberOfPoints(); ++i)
  {
    double a[3];
    double b[3];
    before->GetPoint(i, a);
    output->GetPoint(i, b);
    EXPECT_TRUE(std::equal(a, a + 3, b));
  }
  FindArray(output->GetPointData(), "FreePoint", 1, VTK_UNSIGNED_CHAR);
  auto boundary = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  auto boundaryBefore = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
  EXPECT_GT(boundary->GetNumberOfCells(), boundaryBefore->GetNumberOfCells());
  EXPECT_NEAR(GetArea(boundary, 0, 1) + GetArea(boundary, 1, 0),
    GetArea(boundaryBefore, 0, 1) + GetArea(boundaryBefore, 1, 0), 1e-12);
  EXPECT_EQ(boundary->GetCellData()->GetNumberOfArrays(),
    boundaryBefore->GetCellData()->GetNumberOfArrays());
  ExpectLinear(boundary);
}

TEST(SteinerPointRefinerFilter, FollowsASizing)
{
  // Edges of 0.1 at x = 0, growing.
  vtkNew<vtkImageData> sizing;
  sizing->SetDimensions(11, 2, 2);
  sizing->SetSpacing(1.0, 10.0, 10.0);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Sizing");
  for (vtkIdType i = 0; i < sizing->GetNumberOfPoints(); ++i)
  {
    values->InsertNextValue(0.1 + 0.3 * sizing->GetPoint(i)[0]);
  }
  sizing->GetPointData()->AddArray(values);
  auto mesher = MakeMesher();
  vtkNew<vtkSteinerPointRefiner> filter;
  filter->SetInputConnection(mesher->GetOutputPort());
  filter->SetInputData(1, sizing);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfTooLargeTetrahedra(), 0);
  const vtkIdType fine = filter->GetOutput()->GetNumberOfCells();
  filter->SetInputData(1, nullptr);
  filter->Update();
  EXPECT_GT(fine, 4 * filter->GetOutput()->GetNumberOfCells());
}

TEST(SteinerPointRefinerFilter, PutsPointsInAndTakesThemOut)
{
  auto mesher = MakeMesher({ { 0.4, 0.5, 0.5 }, { 0.6, 0.5, 0.5 } });
  vtkNew<vtkUnstructuredGrid> input;
  input->ShallowCopy(mesher->GetOutput());
  const vtkIdType count = input->GetNumberOfPoints();
  vtkNew<vtkIntArray> removed;
  removed->SetName("RemovePoint");
  removed->SetNumberOfTuples(count);
  removed->Fill(0);
  removed->SetValue(count - 2, 1);
  input->GetPointData()->AddArray(removed);
  vtkNew<vtkSteinerPointRefiner> filter;
  filter->SetInputData(input);
  filter->SetInputData(3, MakePoints({ { 0.3, 0.3, 0.3 }, { 50.0, 0.0, 0.0 } }));
  filter->SetRadiusEdgeRatio(0.0);
  filter->SetDihedralAngleTarget(0.0);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfRemovedPoints(), 1);
  vtkUnstructuredGrid* output = filter->GetOutput();
  const auto has = [&](double x, double y, double z)
  {
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      const double* p = output->GetPoint(i);
      if (p[0] == x && p[1] == y && p[2] == z)
      {
        return true;
      }
    }
    return false;
  };
  EXPECT_FALSE(has(0.4, 0.5, 0.5));
  EXPECT_TRUE(has(0.6, 0.5, 0.5));
  EXPECT_TRUE(has(0.3, 0.3, 0.3));
  EXPECT_FALSE(has(50.0, 0.0, 0.0));
  EXPECT_EQ(output->GetPointData()->GetArray("RemovePoint"), nullptr);

  // The flags of a run serve the next one: what is free may go.
  vtkNew<vtkSteinerPointRefiner> next;
  next->SetInputConnection(filter->GetOutputPort());
  next->SetMinimumEdgeLength(0.5);
  next->SetRadiusEdgeRatio(0.0);
  next->SetDihedralAngleTarget(0.0);
  next->Update();
  EXPECT_EQ(next->GetNumberOfRemovedPoints(), 0);
  next->FreeInteriorPointsOn();
  next->Update();
  EXPECT_GT(next->GetNumberOfRemovedPoints(), 0);
}

TEST(SteinerPointRefinerFilter, SaysWhatItCouldNotReach)
{
  auto mesher = MakeMesher();
  vtkNew<vtkSteinerPointRefiner> filter;
  filter->SetInputConnection(mesher->GetOutputPort());
  filter->SetMaximumEdgeLength(0.1);
  filter->SetMaximumNewPoints(50);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "are too large")) << recorder->Warnings;
  vtkDataArray* faults =
    FindArray(filter->GetOutput()->GetCellData(), "RefinementFault", 1, VTK_UNSIGNED_CHAR);
  ASSERT_NE(faults, nullptr);
  vtkIdType large = 0;
  for (vtkIdType i = 0; i < faults->GetNumberOfTuples(); ++i)
  {
    large += faults->GetComponent(i, 0) == 1.0;
  }
  EXPECT_EQ(large, filter->GetNumberOfTooLargeTetrahedra());

  filter->SetMaximumNewPoints(0);
  filter->SetMaximumTime(1e-9);
  recorder->Warnings.clear();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "MaximumTime")) << recorder->Warnings;
  EXPECT_GT(filter->GetNumberOfTooLargeTetrahedra(), 0);
}

TEST(SteinerPointRefinerFilter, RefusesBadInput)
{
  auto mesher = MakeMesher();
  vtkNew<vtkSteinerPointRefiner> filter;
  filter->SetInputData(vtkSmartPointer<vtkUnstructuredGrid>::New());
  ExpectFailure(filter, { "empty" });

  vtkNew<vtkUnstructuredGrid> input;
  input->ShallowCopy(mesher->GetOutput());
  filter->SetInputData(input);
  vtkNew<vtkPolyData> other;
  other->ShallowCopy(mesher->GetOutputDataObject(1));
  vtkNew<vtkCellArray> one;
  const vtkIdType ids[3] = { 0, 1, 2 };
  one->InsertNextCell(3, ids);
  vtkNew<vtkPolyData> wrong;
  wrong->SetPoints(other->GetPoints());
  wrong->SetPolys(one);
  filter->SetInputData(2, wrong);
  ExpectFailure(filter, { "boundary" });
  filter->SetInputData(2, nullptr);

  vtkNew<vtkIntArray> flags;
  flags->SetName("FreePoint");
  flags->SetNumberOfComponents(2);
  flags->SetNumberOfTuples(input->GetNumberOfPoints());
  flags->FillValue(1);
  input->GetPointData()->AddArray(flags);
  ExpectFailure(filter, { "FreePoint" });
}
