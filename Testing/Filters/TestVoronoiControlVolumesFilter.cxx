// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkTechnologyStructureSource.h>
#include <vtkVoronoiControlVolumes.h>

#include <vtkIdTypeArray.h>
#include <vtkPolyhedron.h>

#include <map>

using namespace testing_filters;

namespace
{
vtkSmartPointer<vtkConformingDelaunayMesher> RunMesher(vtkPolyData* surface, double edgeLength)
{
  auto mesher = vtkSmartPointer<vtkConformingDelaunayMesher>::New();
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(surface);
  mesher->SetMaximumEdgeLength(edgeLength);
  mesher->SetCriterionToSmallestSphereAndEdges();
  mesher->Update();
  return mesher;
}

vtkSmartPointer<vtkUnstructuredGrid> MakeMesh(vtkPolyData* surface, double edgeLength)
{
  return RunMesher(surface, edgeLength)->GetOutput();
}
} // namespace

TEST(VoronoiControlVolumesFilter, SumsAreVolumesAndAreas)
{
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToMosTransistor();
  device->Update();
  const auto mesher = RunMesher(device->GetOutput(), 0.1);
  vtkUnstructuredGrid* mesh = mesher->GetOutput();
  vtkPolyData* surface = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
  vtkNew<vtkVoronoiControlVolumes> filter;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputData(mesh);
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  ExpectProgress(recorder);
  EXPECT_EQ(0, filter->GetNumberOfNegativeCouplings());
  EXPECT_EQ(0, filter->GetBoxes()->GetNumberOfCells()) << "on demand";

  vtkPointData* boxes = filter->GetOutput()->GetPointData();
  vtkDataArray* volumes = FindArray(boxes, "BoxVolume", 1, VTK_DOUBLE);
  vtkDataArray* regions = FindArray(boxes, "RegionId", 1, VTK_INT);
  vtkDataArray* points = FindArray(boxes, "PointId", 1, VTK_ID_TYPE);
  ASSERT_TRUE(volumes && regions && points);
  std::map<int, double> sums;
  for (vtkIdType i = 0; i < volumes->GetNumberOfTuples(); ++i)
  {
    EXPECT_GT(volumes->GetComponent(i, 0), 0.0);
    sums[static_cast<int>(regions->GetComponent(i, 0))] += volumes->GetComponent(i, 0);
    double own[3];
    double meshed[3];
    filter->GetOutput()->GetPoint(i, own);
    mesh->GetPoint(static_cast<vtkIdType>(points->GetComponent(i, 0)), meshed);
    EXPECT_TRUE(std::equal(own, own + 3, meshed));
  }
  ASSERT_EQ(5u, sums.size());
  for (const auto& [region, sum] : sums)
  {
    EXPECT_NEAR(1.0, sum / GetVolume(mesh, region), 1e-12) << region;
  }

  vtkPointData* boundary = filter->GetBoundaryAreas()->GetPointData();
  vtkDataArray* labels = FindArray(boundary, "BoundaryLabels", 2, VTK_INT);
  vtkDataArray* areas = FindArray(boundary, "BoundaryArea", 1, VTK_DOUBLE);
  ASSERT_TRUE(labels && areas);
  std::map<std::array<int, 2>, double> areaSums;
  for (vtkIdType i = 0; i < areas->GetNumberOfTuples(); ++i)
  {
    areaSums[{ static_cast<int>(labels->GetComponent(i, 0)),
      static_cast<int>(labels->GetComponent(i, 1)) }] += areas->GetComponent(i, 0);
  }
  for (const auto& [pair, area] : areaSums)
  {
    EXPECT_LT(pair[0], pair[1]);
    EXPECT_NEAR(1.0, area / GetArea(surface, pair[0], pair[1]), 1e-12) << pair[0] << " " << pair[1];
  }
  EXPECT_GT(areaSums.size(), 7u);
}

TEST(VoronoiControlVolumesFilter, BoxesArePolyhedra)
{
  const auto mesh = MakeMesh(MakeTwoBoxes(true), 0.5);
  vtkNew<vtkVoronoiControlVolumes> filter;
  filter->SetInputData(mesh);
  filter->GenerateBoxesOn();
  filter->Update();
  vtkUnstructuredGrid* boxes = filter->GetBoxes();
  vtkPolyData* vertices = filter->GetOutput();
  ASSERT_EQ(vertices->GetNumberOfPoints(), boxes->GetNumberOfCells());
  vtkDataArray* volumes = FindArray(boxes->GetCellData(), "BoxVolume", 1, VTK_DOUBLE);
  vtkDataArray* regions = FindArray(boxes->GetCellData(), "RegionId", 1, VTK_INT);
  vtkDataArray* linear = FindArray(boxes->GetCellData(), "Linear", 1, VTK_DOUBLE);
  vtkDataArray* ids = FindArray(boxes->GetCellData(), "PointId", 1, VTK_ID_TYPE);
  ASSERT_TRUE(volumes && regions && linear && ids);
  for (vtkIdType i = 0; i < boxes->GetNumberOfCells(); ++i)
  {
    ASSERT_EQ(VTK_POLYHEDRON, boxes->GetCellType(i));
    double center[3];
    mesh->GetPoint(static_cast<vtkIdType>(ids->GetComponent(i, 0)), center);
    EXPECT_NEAR(Linear(center), linear->GetComponent(i, 0), 1e-12);
    // All boxes lie in their region, and the mesh point in its box.
    double bounds[6];
    boxes->GetCell(i)->GetBounds(bounds);
    const bool isLeft = regions->GetComponent(i, 0) == 3;
    EXPECT_GE(bounds[0], isLeft ? -1e-12 : 1.0 - 1e-12);
    EXPECT_LE(bounds[1], isLeft ? 1.0 + 1e-12 : 3.0 + 1e-12);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_GE(center[axis], bounds[2 * axis] - 1e-12);
      EXPECT_LE(center[axis], bounds[2 * axis + 1] + 1e-12);
    }
    // The volume by the divergence theorem, from VTK's own faces.
    double volume = 0.0;
    vtkCell* cell = boxes->GetCell(i);
    for (int face = 0; face < cell->GetNumberOfFaces(); ++face)
    {
      vtkPoints* points = cell->GetFace(face)->GetPoints();
      double x[3][3];
      points->GetPoint(0, x[0]);
      for (vtkIdType j = 1; j + 1 < points->GetNumberOfPoints(); ++j)
      {
        points->GetPoint(j, x[1]);
        points->GetPoint(j + 1, x[2]);
        volume += vtkTetra::ComputeVolume(center, x[0], x[1], x[2]);
      }
    }
    EXPECT_NEAR(volumes->GetComponent(i, 0), volume, 1e-13);
  }
}

TEST(VoronoiControlVolumesFilter, BadInputIsRefused)
{
  vtkNew<vtkVoronoiControlVolumes> filter;
  vtkNew<vtkUnstructuredGrid> empty;
  filter->SetInputData(empty);
  ExpectFailure(filter, { "empty" });

  const auto mesh = MakeMesh(MakeCube(), 0.6);
  vtkNew<vtkUnstructuredGrid> inverted;
  inverted->SetPoints(mesh->GetPoints());
  inverted->AllocateEstimate(mesh->GetNumberOfCells(), 4);
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    vtkIdList* ids = mesh->GetCell(i)->GetPointIds();
    vtkIdType tetrahedron[4] = { ids->GetId(0), ids->GetId(1), ids->GetId(2), ids->GetId(3) };
    if (i == 2)
    {
      std::swap(tetrahedron[0], tetrahedron[1]);
    }
    inverted->InsertNextCell(VTK_TETRA, 4, tetrahedron);
  }
  filter->SetInputData(inverted);
  ExpectFailure(filter, { "inverted or flat", "Cells: 2" });
}

TEST(VoronoiControlVolumesFilter, AbortLeavesNothing)
{
  vtkNew<vtkVoronoiControlVolumes> filter;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  recorder->AbortAt = 0.3;
  filter->GenerateBoxesOn();
  filter->SetInputData(MakeMesh(MakeCube(), 0.2));
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(filter);
}
