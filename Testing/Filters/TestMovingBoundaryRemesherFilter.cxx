// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkMovingBoundaryRemesher.h>

#include <cmath>
#include <functional>

using namespace testing_filters;

namespace
{
/**
 * The two boxes of FilterTesting, region 3 to x = 1, region 7 to x = 3, with points inside; the
 * vectors Displacement, and the cell array TetrahedronId, numbers from 1 on.
 */
vtkSmartPointer<vtkUnstructuredGrid> MakeMesh(
  const std::function<Point(const Point&)>& motion, double spacing = 0.25)
{
  auto boxes = MakeTwoBoxes(true);
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(boxes);
  mesher->SetMaximumEdgeLength(spacing);
  mesher->Update();
  auto mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
  mesh->ShallowCopy(mesher->GetOutput());
  vtkNew<vtkDoubleArray> displacement;
  displacement->SetName("Displacement");
  displacement->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    Point x;
    mesh->GetPoint(i, x.data());
    displacement->InsertNextTuple(motion(x).data());
  }
  mesh->GetPointData()->SetVectors(displacement);
  vtkNew<vtkIntArray> ids;
  ids->SetName("TetrahedronId");
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    ids->InsertNextValue(static_cast<int>(i) + 1);
  }
  mesh->GetCellData()->AddArray(ids);
  return mesh;
}

Point MoveInterface(const Point& x)
{
  return { x[0] == 1.0 ? 0.3 : 0.0, 0.0, 0.0 };
}

void ExpectVerdict(vtkMovingBoundaryRemesher* filter, const char* verdict)
{
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputConnection(0, filter->GetOutputPort(0));
  criteria->SetInputConnection(1, filter->GetOutputPort(1));
  criteria->Update();
  EXPECT_EQ(criteria->GetCertificate().find(verdict), 0u) << criteria->GetCertificate();
}
} // namespace

TEST(MovingBoundaryRemesherFilter, MovesAnInterfaceAndKeepsArrays)
{
  auto input = MakeMesh(MoveInterface);
  vtkNew<vtkMovingBoundaryRemesher> filter;
  filter->SetInputData(input);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  ExpectProgress(recorder);
  vtkUnstructuredGrid* output = filter->GetOutput();
  EXPECT_NEAR(GetVolume(output, 3), 1.3, 1e-12);
  EXPECT_NEAR(GetVolume(output, 7), 1.7, 1e-12);
  ExpectVerdict(filter, "CLEAN FOR FINITE VOLUMES\n");
  EXPECT_EQ(filter->GetNumberOfStepsTaken(), 1);
  EXPECT_EQ(filter->GetNumberOfTopologyChanges(), 0);
  EXPECT_EQ(filter->GetNumberOfUnresolvedTriangles(), 0);
  EXPECT_EQ(output->GetNumberOfPoints(),
    input->GetNumberOfPoints() - filter->GetNumberOfRemovedPoints() +
      filter->GetNumberOfNewPoints());

  auto boundary = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_NEAR(GetArea(boundary, 3, 7), 1.0, 1e-12);
  EXPECT_NEAR(GetArea(boundary, -1, 3), 1.0 + 4.0 * 1.3, 1e-12);
  EXPECT_NEAR(GetArea(boundary, -1, 7), 1.0 + 4.0 * 1.7, 1e-12);
  FindArray(boundary->GetPointData(), "Linear", 1, VTK_DOUBLE);

  // Data move with their points: Linear holds where a point was, and points that stay keep it.
  vtkDataArray* linear = FindArray(output->GetPointData(), "Linear", 1, VTK_DOUBLE);
  vtkDataArray* displacement = FindArray(output->GetPointData(), "Displacement", 3, VTK_DOUBLE);
  ASSERT_TRUE(linear && displacement);
  EXPECT_EQ(output->GetPointData()->GetVectors(), displacement);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    double x[3];
    output->GetPoint(i, x);
    if (x[0] > 1.3 + 4.0 * 0.3)
    {
      EXPECT_NEAR(linear->GetComponent(i, 0), Linear(x), 1e-12);
    }
    const double dx = displacement->GetComponent(i, 0);
    const double before[3] = { x[0] - dx, x[1], x[2] };
    if (dx == 0.3)
    {
      EXPECT_EQ(x[0], 1.3);
      EXPECT_NEAR(linear->GetComponent(i, 0), Linear(before), 1e-12);
    }
  }

  vtkDataArray* regions = FindArray(output->GetCellData(), "RegionId", 1, VTK_INT);
  vtkDataArray* ids = FindArray(output->GetCellData(), "TetrahedronId", 1, VTK_INT);
  vtkDataArray* inputRegions = input->GetCellData()->GetArray("RegionId");
  ASSERT_TRUE(regions && ids);
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    const auto source = static_cast<vtkIdType>(ids->GetComponent(cell, 0)) - 1;
    if (source >= 0)
    {
      EXPECT_EQ(regions->GetComponent(cell, 0), inputRegions->GetComponent(source, 0));
    }
  }
}

TEST(MovingBoundaryRemesherFilter, ItsOutputIsItsInput)
{
  // Time steps of a simulation: the interface comes back where it was.
  vtkSmartPointer<vtkUnstructuredGrid> mesh = MakeMesh(MoveInterface);
  for (const double sign : { 1.0, 1.0, -1.0, -1.0 })
  {
    vtkDataArray* displacement = mesh->GetPointData()->GetVectors();
    for (vtkIdType i = 0; i < displacement->GetNumberOfTuples(); ++i)
    {
      const bool isOnInterface = displacement->GetComponent(i, 0) != 0.0;
      displacement->SetComponent(i, 0, isOnInterface ? sign * 0.25 : 0.0);
    }
    vtkNew<vtkMovingBoundaryRemesher> filter;
    filter->SetInputData(mesh);
    filter->SetCriterionToSmallestSphereAndEdges();
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfTopologyChanges(), 0);
    ExpectVerdict(filter, "CLEAN FOR FINITE VOLUMES\n");
    mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
    mesh->DeepCopy(filter->GetOutput());
  }
  EXPECT_NEAR(GetVolume(mesh, 3), 1.0, 1e-12);
  EXPECT_NEAR(GetVolume(mesh, 7), 2.0, 1e-12);
}

TEST(MovingBoundaryRemesherFilter, ALayerVanishes)
{
  auto mesh = MakeMesh([](const Point& x) { return Point{ x[0] == 1.0 ? -1.5 : 0.0, 0.0, 0.0 }; });
  vtkNew<vtkMovingBoundaryRemesher> filter;
  filter->SetInputData(mesh);
  filter->SetNumberOfSteps(2);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  EXPECT_GE(filter->GetNumberOfTopologyChanges(), 1);
  // Cuts leave no points on the walls, which are flat: what is left is coarser than before.
  EXPECT_LT(filter->GetOutput()->GetNumberOfPoints(), mesh->GetNumberOfPoints());
  // Region 7 sticks out where region 3 was; that is what its boundary encloses.
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 7), 3.5, 1e-12);
  EXPECT_NEAR(GetVolume(filter->GetOutput()), 3.5, 1e-12);
  ExpectVerdict(filter, "DELAUNAY\n");
}

TEST(MovingBoundaryRemesherFilter, RefusesBadInput)
{
  vtkNew<vtkMovingBoundaryRemesher> filter;
  vtkNew<vtkUnstructuredGrid> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "empty" });

  auto mesh = MakeMesh(MoveInterface, 1.0);
  filter->SetInputData(mesh);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Nowhere");
  ExpectFailure(filter, { "array to process", "three components" });
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Linear");
  ExpectFailure(filter, { "array to process", "three components" });

  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Displacement");
  mesh->GetPointData()->GetVectors()->SetComponent(4, 1, std::numeric_limits<double>::quiet_NaN());
  filter->Modified();
  ExpectFailure(filter, { "not finite", "Points: 4" });

  auto mixed = MakeMesh(MoveInterface, 1.0);
  const vtkIdType ids[4] = { 0, 1, 2, 3 };
  mixed->InsertNextCell(VTK_QUAD, 4, ids);
  filter->SetInputData(mixed);
  ExpectFailure(filter, { "VTK_TETRA" });

  // All that is left is turned inside out.
  auto mirrored = MakeMesh([](const Point& x) { return Point{ -2.0 * x[0], 0.0, 0.0 }; }, 1.0);
  filter->SetInputData(mirrored);
  ExpectFailure(filter, { "Nothing is left" });
}

TEST(MovingBoundaryRemesherFilter, LimitsLeaveAMesh)
{
  auto bent = MakeMesh(
    [](const Point& x) {
      return Point{ x[0] == 1.0 ? 0.5 * std::sin(9.0 * x[1]) * x[2] : 0.0, 0.0, 0.0 };
    });
  vtkNew<vtkMovingBoundaryRemesher> filter;
  filter->SetInputData(bent);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Displacement");
  filter->SetMaximumNewPoints(1);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "beyond the limits")) << recorder->Warnings;
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);

  filter->SetMaximumNewPoints(0);
  filter->SetMaximumTime(1e-9);
  filter->SetMaximumEdgeLength(0.1);
  recorder->Warnings.clear();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "larger than asked for")) << recorder->Warnings;
  EXPECT_TRUE(Contains(recorder->Warnings, "MaximumTime")) << recorder->Warnings;
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST(MovingBoundaryRemesherFilter, Aborts)
{
  auto mesh = MakeMesh(MoveInterface, 0.1);
  vtkNew<vtkMovingBoundaryRemesher> filter;
  filter->SetInputData(mesh);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  recorder->AbortAt = 0.2;
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(filter);
}
