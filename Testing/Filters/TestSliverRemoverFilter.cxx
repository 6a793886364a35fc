// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkAdvancingFrontTetrahedralizer.h>
#include <vtkBoundaryTriangulator.h>
#include <vtkConformingDelaunayMesher.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkFieldData.h>
#include <vtkSliverRemover.h>
#include <vtkSteinerPointRefiner.h>
#include <vtkTechnologyStructureSource.h>

#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

using namespace testing_filters;

#include <initializer_list>

namespace
{
/**
 * A block of n x n x n unit cubes of mesh points inside of a box, meshed up to stage 3. With noise,
 * the points are off by up to that, and nearly cospherical sets make slivers.
 */
vtkSmartPointer<vtkUnstructuredGrid> MakeGridMesh(int n, double noise = 0.0)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { double(n), double(n), double(n) });
  std::vector<Point> points;
  for (int i = 1; i < n; ++i)
  {
    for (int j = 1; j < n; ++j)
    {
      for (int k = 1; k < n; ++k)
      {
        const auto draw = [&](double a) { return noise * std::sin(a * (i + 7.3 * j + 41.7 * k)); };
        points.push_back({ i + draw(11.0), j + draw(17.0), k + draw(23.0) });
      }
    }
  }
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(builder.Build());
  vtkNew<vtkDelaunaySurfaceRefiner> refiner;
  refiner->SetInputConnection(triangulator->GetOutputPort());
  refiner->SetInputData(1, MakePoints(points));
  vtkNew<vtkAdvancingFrontTetrahedralizer> tetrahedralizer;
  tetrahedralizer->SetInputConnection(refiner->GetOutputPort());
  tetrahedralizer->SetInputConnection(1, refiner->GetOutputPort(2));
  tetrahedralizer->Update();
  vtkSmartPointer<vtkUnstructuredGrid> mesh = tetrahedralizer->GetOutput();
  vtkNew<vtkIntArray> ids;
  ids->SetName("TetrahedronId");
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    ids->InsertNextValue(static_cast<int>(i) + 1);
  }
  mesh->GetCellData()->AddArray(ids);
  return mesh;
}

/** Two tetrahedra that share a facet, made by hand, without RegionId and in float coordinates. */
vtkSmartPointer<vtkUnstructuredGrid> MakeTwoTetrahedra()
{
  auto mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  points->InsertNextPoint(0, 1, 0);
  points->InsertNextPoint(0, 0, 1);
  points->InsertNextPoint(0, 0, -1);
  mesh->SetPoints(points);
  const vtkIdType upper[4] = { 0, 1, 2, 3 };
  const vtkIdType lower[4] = { 0, 2, 1, 4 };
  mesh->InsertNextCell(VTK_TETRA, 4, upper);
  mesh->InsertNextCell(VTK_TETRA, 4, lower);
  return mesh;
}

std::array<vtkIdType, 4> GetSortedIds(vtkUnstructuredGrid* mesh, vtkIdType cell)
{
  std::array<vtkIdType, 4> ids;
  std::copy_n(mesh->GetCell(cell)->GetPointIds()->GetPointer(0), 4, ids.begin());
  std::sort(ids.begin(), ids.end());
  return ids;
}
} // namespace

/** A certificate is that of the mesh that was looked at, not of what a filter makes of it. */
TEST(SliverRemoverFilter, TakesTheCertificateAway)
{
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToMosTransistor();
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputConnection(device->GetOutputPort());
  vtkNew<vtkSliverRemover> remover;
  remover->SetInputConnection(mesher->GetOutputPort());
  vtkNew<vtkSteinerPointRefiner> refiner;
  refiner->SetInputConnection(mesher->GetOutputPort());
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ remover, refiner })
  {
    filter->Update();
    vtkFieldData* const after = filter->GetOutputDataObject(0)->GetFieldData();
    EXPECT_EQ(after->GetAbstractArray("Certificate"), nullptr);
    EXPECT_EQ(after->GetArray("IsClean"), nullptr);
    EXPECT_NE(mesher->GetOutput()->GetFieldData()->GetAbstractArray("Certificate"), nullptr);
  }
}

TEST(SliverRemoverFilter, ImprovesAMeshAndKeepsDataOfSurvivors)
{
  auto input = MakeGridMesh(4);
  ASSERT_GT(input->GetNumberOfCells(), 0);
  vtkNew<vtkSliverRemover> filter;
  filter->SetInputData(input);
  filter->SetDihedralAngleTarget(70.0);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  vtkUnstructuredGrid* output = filter->GetOutput();
  EXPECT_NEAR(GetVolume(output, 0), 64.0, 1e-10);
  EXPECT_EQ(output->GetNumberOfPoints(), input->GetNumberOfPoints());
  EXPECT_GE(filter->GetSmallestDihedralAngleAfter(), filter->GetSmallestDihedralAngleBefore());
  EXPECT_GT(filter->GetSmallestDihedralAngleBefore(), 0.0);
  FindArray(output->GetCellData(), "RegionId", 1, VTK_INT);
  ExpectLinear(output);
  vtkDataArray* ids = FindArray(output->GetCellData(), "TetrahedronId", 1, VTK_INT);
  ASSERT_NE(ids, nullptr);
  vtkIdType survivors = 0;
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    const auto source = static_cast<vtkIdType>(ids->GetComponent(cell, 0)) - 1;
    if (source >= 0)
    {
      EXPECT_EQ(GetSortedIds(output, cell), GetSortedIds(input, source));
      ++survivors;
    }
  }
  EXPECT_GT(survivors, 0);
}

TEST(SliverRemoverFilter, TakesMeshesFromOutside)
{
  vtkNew<vtkSliverRemover> filter;
  filter->SetInputData(MakeTwoTetrahedra());
  filter->Update();
  vtkUnstructuredGrid* output = filter->GetOutput();
  ASSERT_EQ(output->GetNumberOfCells(), 2);
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_NEAR(GetVolume(output, 0), 1.0 / 3.0, 1e-15);
}

TEST(SliverRemoverFilter, MovesFreePoints)
{
  auto input = MakeGridMesh(5, 0.1);
  const vtkIdType count = input->GetNumberOfPoints();
  vtkNew<vtkSliverRemover> filter;
  filter->SetInputData(input);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfMovedPoints(), 0);
  const double before = filter->GetSmallestDihedralAngleAfter();

  // All inside, or those with the array: here one half of the points.
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName("FreePoint");
  for (vtkIdType i = 0; i < count; ++i)
  {
    flags->InsertNextValue(i % 2);
  }
  for (const bool isAll : { true, false })
  {
    filter->SetFreeInteriorPoints(isAll);
    if (!isAll)
    {
      input->GetPointData()->AddArray(flags);
    }
    for (const bool isQualityFirst : { false, true })
    {
      filter->SetQualityBeforeDelaunay(isQualityFirst);
      filter->Update();
      EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
      EXPECT_GT(filter->GetNumberOfMovedPoints(), 0);
      EXPECT_GE(filter->GetSmallestDihedralAngleAfter(), before);
      vtkUnstructuredGrid* output = filter->GetOutput();
      ASSERT_EQ(output->GetNumberOfPoints(), count);
      EXPECT_NEAR(GetVolume(output, 0), 125.0, 1e-10);
      ExpectLinear(output);
      vtkDataArray* kept = output->GetPointData()->GetArray("FreePoint");
      EXPECT_EQ(kept == nullptr, isAll);
      for (vtkIdType i = 0; i < count; ++i)
      {
        double x[3];
        double y[3];
        input->GetPoint(i, x);
        output->GetPoint(i, y);
        const bool isInside =
          *std::min_element(x, x + 3) > 0.0 && *std::max_element(x, x + 3) < 5.0;
        EXPECT_TRUE((isInside && (isAll || i % 2 == 1)) || std::equal(x, x + 3, y));
        EXPECT_TRUE(isAll || kept->GetComponent(i, 0) == i % 2);
      }

      vtkNew<vtkDelaunayMeshCriteria> criteria;
      criteria->SetInputData(output);
      criteria->Update();
      vtkFieldData* summary = criteria->GetOutput()->GetFieldData();
      vtkDataArray* faults = summary->GetArray("NonDelaunayTetrahedra");
      ASSERT_NE(faults, nullptr);
      EXPECT_EQ(faults->GetComponent(0, 0) > 0.0, isQualityFirst);
    }
  }
}

TEST(SliverRemoverFilter, MovesBoundaryPointsInTheirFacets)
{
  // A plate without points inside: all tetrahedra have points of the boundary only.
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 0.2 });
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(builder.Build());
  mesher->SetCriterionToSmallestSphereAndEdges();
  mesher->SetMaximumEdgeLength(0.22);
  mesher->RemoveSliversOff();
  mesher->Update();
  vtkUnstructuredGrid* input = mesher->GetOutput();

  vtkNew<vtkSliverRemover> filter;
  filter->SetInputData(input);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfMovedPoints(), 0);
  const double before = filter->GetSmallestDihedralAngleAfter();
  filter->FreeBoundaryPointsOn();
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  EXPECT_GT(filter->GetNumberOfMovedPoints(), 0);
  EXPECT_GT(filter->GetSmallestDihedralAngleAfter(), before);
  vtkUnstructuredGrid* output = filter->GetOutput();
  ASSERT_EQ(output->GetNumberOfPoints(), input->GetNumberOfPoints());
  EXPECT_NEAR(GetVolume(output, 0), 0.2, 1e-14);
  ExpectLinear(output);
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    const double size[3] = { 1.0, 1.0, 0.2 };
    double x[3];
    double y[3];
    input->GetPoint(i, x);
    output->GetPoint(i, y);
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_TRUE(x[k] == y[k] || (x[k] != 0.0 && x[k] != size[k]));
    }
  }
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputData(output);
  criteria->Update();
  for (const char* name : { "NonDelaunayTetrahedra", "FacetSphereViolations",
         "EdgeSphereViolations", "NegativeCouplings" })
  {
    vtkDataArray* faults = criteria->GetOutput()->GetFieldData()->GetArray(name);
    ASSERT_NE(faults, nullptr);
    EXPECT_EQ(faults->GetComponent(0, 0), 0.0) << name;
  }
}

TEST(SliverRemoverFilter, RefusesBadInput)
{
  vtkNew<vtkSliverRemover> filter;
  vtkNew<vtkUnstructuredGrid> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "empty" });

  auto mixed = MakeTwoTetrahedra();
  const vtkIdType pyramid[5] = { 0, 1, 2, 3, 4 };
  mixed->InsertNextCell(VTK_PYRAMID, 5, pyramid);
  filter->SetInputData(mixed);
  ExpectFailure(filter, { "VTK_TETRA", "Cells: 2 (1 in all)" });

  auto inverted = MakeTwoTetrahedra();
  const vtkIdType ids[4] = { 1, 0, 2, 3 };
  inverted->ReplaceCell(0, 4, ids);
  filter->SetInputData(inverted);
  ExpectFailure(filter, { "Cells: 0" });

  auto withNaN = MakeTwoTetrahedra();
  withNaN->GetPoints()->SetPoint(4, 0, 0, std::numeric_limits<double>::quiet_NaN());
  filter->SetInputData(withNaN);
  ExpectFailure(filter, { "finite", "Points: 4 (0, 0, nan)" });

  auto wrongRegion = MakeTwoTetrahedra();
  vtkNew<vtkIntArray> regions;
  regions->SetName("RegionId");
  regions->InsertNextValue(0);
  regions->InsertNextValue(-7);
  wrongRegion->GetCellData()->AddArray(regions);
  filter->SetInputData(wrongRegion);
  ExpectFailure(filter, { "RegionId", "Cells: 1 (1 in all)" });

  auto wrongFlags = MakeTwoTetrahedra();
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName("FreePoint");
  flags->SetNumberOfComponents(2);
  flags->SetNumberOfTuples(5);
  flags->Fill(1);
  wrongFlags->GetPointData()->AddArray(flags);
  filter->SetInputData(wrongFlags);
  ExpectFailure(filter, { "FreePoint" });
}

TEST(SliverRemoverFilter, ReportsProgressAndAborts)
{
  auto mesh = MakeGridMesh(12);
  vtkNew<vtkSliverRemover> filter;
  filter->SetInputData(mesh);
  filter->SetDihedralAngleTarget(70.0);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  ExpectProgress(recorder);
  recorder->AbortAt = 0.0;
  filter->Modified();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(filter);
}
