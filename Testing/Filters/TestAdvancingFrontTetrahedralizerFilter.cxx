// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkAdvancingFrontTetrahedralizer.h>
#include <vtkBoundaryTriangulator.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkPlatonicSolidSource.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <map>

using namespace testing_filters;

namespace
{
/** Polygons through the stages up to the tetrahedralizer. */
struct Pipeline
{
  explicit Pipeline(vtkPolyData* surface, vtkPolyData* meshPoints = nullptr)
  {
    this->Triangulator->SetInputData(surface);
    this->Refiner->SetInputConnection(this->Triangulator->GetOutputPort());
    this->Filter->SetInputConnection(this->Refiner->GetOutputPort());
    if (meshPoints)
    {
      this->Refiner->SetInputData(1, meshPoints);
      this->Filter->SetInputConnection(1, this->Refiner->GetOutputPort(2));
    }
    this->Recorder->Watch(this->Filter);
  }
  vtkUnstructuredGrid* GetMesh() const { return this->Filter->GetOutput(); }
  vtkPolyData* GetSurface(int port) const
  {
    return vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(port));
  }
  vtkNew<vtkBoundaryTriangulator> Triangulator;
  vtkNew<vtkDelaunaySurfaceRefiner> Refiner;
  vtkNew<vtkAdvancingFrontTetrahedralizer> Filter;
  vtkNew<EventRecorder> Recorder;
};

using Facet = std::array<vtkIdType, 3>;

Facet Sort(vtkIdType a, vtkIdType b, vtkIdType c)
{
  Facet facet{ a, b, c };
  std::sort(facet.begin(), facet.end());
  return facet;
}

/** Number of tetrahedra at each facet. */
std::map<Facet, int> CountFacets(vtkUnstructuredGrid* mesh)
{
  std::map<Facet, int> facets;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    EXPECT_EQ(mesh->GetCellType(cell), VTK_TETRA);
    vtkIdList* ids = mesh->GetCell(cell)->GetPointIds();
    for (int i = 0; i < 4; ++i)
    {
      ++facets[Sort(ids->GetId(i), ids->GetId((i + 1) % 4), ids->GetId((i + 2) % 4))];
    }
  }
  return facets;
}

/** Facets with one tetrahedron are the outer boundary, all others have two. */
void ExpectClosed(const Pipeline& run)
{
  std::map<Facet, int> facets = CountFacets(run.GetMesh());
  int outer = 0;
  for (const auto& facet : facets)
  {
    EXPECT_LE(facet.second, 2);
    outer += facet.second == 1;
  }
  vtkPolyData* boundary = run.GetSurface(1);
  vtkDataArray* labels = FindArray(boundary->GetCellData(), "BoundaryLabels", 2, VTK_INT);
  ASSERT_NE(labels, nullptr);
  int outerTriangles = 0;
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    vtkIdList* ids = boundary->GetCell(cell)->GetPointIds();
    const auto found = facets.find(Sort(ids->GetId(0), ids->GetId(1), ids->GetId(2)));
    ASSERT_NE(found, facets.end());
    const bool isOuter = labels->GetComponent(cell, 0) == -1 || labels->GetComponent(cell, 1) == -1;
    EXPECT_EQ(found->second, isOuter ? 1 : 2);
    outerTriangles += isOuter;
  }
  EXPECT_EQ(outer, outerTriangles);
  EXPECT_EQ(run.GetSurface(2)->GetNumberOfCells(), 0);
}
} // namespace

TEST(AdvancingFrontTetrahedralizerFilter, MeshesACube)
{
  Pipeline run(MakeCube());
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors + run.Recorder->Warnings, "");
  // One cospherical cell of eight points: the faces without the lowest one, two triangles each.
  EXPECT_EQ(run.GetMesh()->GetNumberOfCells(), 6);
  EXPECT_EQ(run.Filter->GetNumberOfRegions(), 1);
  EXPECT_EQ(run.GetMesh()->GetNumberOfPoints(), 8);
  EXPECT_NEAR(GetVolume(run.GetMesh(), 0), 1.0, 1e-14);
  FindArray(run.GetMesh()->GetCellData(), "RegionId", 1, VTK_INT);
  ExpectLinear(run.GetMesh(), 0.0);
  ExpectClosed(run);
  EXPECT_EQ(run.GetSurface(1)->GetNumberOfPolys(), 12);
  FindArray(run.GetSurface(1)->GetCellData(), "PolygonId", 1, VTK_INT);
  ExpectLinear(run.GetSurface(1), 0.0);
}

TEST(AdvancingFrontTetrahedralizerFilter, KeepsRegionsOfLabels)
{
  Pipeline run(MakeTwoBoxes(true));
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_EQ(run.Filter->GetNumberOfRegions(), 2);
  EXPECT_NEAR(GetVolume(run.GetMesh(), 3), 1.0, 1e-13);
  EXPECT_NEAR(GetVolume(run.GetMesh(), 7), 2.0, 1e-13);
  EXPECT_NEAR(GetVolume(run.GetMesh()), 3.0, 1e-13);
  EXPECT_NEAR(GetArea(run.GetSurface(1), 3, 7), 1.0, 1e-14);
  ExpectClosed(run);
}

TEST(AdvancingFrontTetrahedralizerFilter, FindsRegionsWithoutLabels)
{
  Pipeline run(MakeTwoBoxes());
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_EQ(run.Filter->GetNumberOfRegions(), 2);
  const double first = GetVolume(run.GetMesh(), 0);
  EXPECT_NEAR(first + GetVolume(run.GetMesh(), 1), 3.0, 1e-13);
  EXPECT_NEAR(std::min(first, 3.0 - first), 1.0, 1e-13);
  EXPECT_NEAR(GetArea(run.GetSurface(1), 0, 1), 1.0, 1e-14);
}

TEST(AdvancingFrontTetrahedralizerFilter, LeavesCavitiesOut)
{
  Pipeline run(MakeCubeWithCavity());
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_NEAR(GetVolume(run.GetMesh(), 0), 26.0, 1e-11);
  ExpectClosed(run);
}

TEST(AdvancingFrontTetrahedralizerFilter, MeshesPlatonicSolids)
{
  for (int solid = 0; solid < 5; ++solid)
  {
    vtkNew<vtkPlatonicSolidSource> source;
    source->SetSolidType(solid);
    source->Update();
    Pipeline run(source->GetOutput());
    run.Filter->Update();
    EXPECT_EQ(run.Recorder->Errors, "") << solid;
    EXPECT_GT(GetVolume(run.GetMesh()), 0.0) << solid;
    ExpectClosed(run);
  }
}

TEST(AdvancingFrontTetrahedralizerFilter, UsesMeshPointsAndTheirData)
{
  std::vector<Point> points;
  for (double x : { 0.3, 0.5, 0.8 })
  {
    for (double y : { 0.25, 0.6 })
    {
      points.push_back({ x, y, 0.45 });
    }
  }
  points.push_back({ 4, 4, 4 }); // outside
  Pipeline run(MakeCube(), MakePoints(points));
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_TRUE(Contains(run.Recorder->Warnings, "Left out 1 mesh points")) << run.Recorder->Warnings;
  EXPECT_EQ(run.Filter->GetNumberOfUnusedMeshPoints(), 1);
  EXPECT_EQ(run.GetMesh()->GetNumberOfPoints(), run.Refiner->GetOutput()->GetNumberOfPoints() + 6);
  EXPECT_NEAR(GetVolume(run.GetMesh(), 0), 1.0, 1e-13);
  ExpectLinear(run.GetMesh());
  ExpectClosed(run);
}

TEST(AdvancingFrontTetrahedralizerFilter, PassesOnlyArraysThatBothInputsHave)
{
  auto cube = MakeCube();
  vtkNew<vtkDoubleArray> surfaceOnly;
  surfaceOnly->SetName("SurfaceOnly");
  surfaceOnly->SetNumberOfTuples(8);
  surfaceOnly->FillValue(1.0);
  cube->GetPointData()->AddArray(surfaceOnly);
  Pipeline run(cube);
  run.Filter->Update();
  EXPECT_TRUE(run.GetMesh()->GetPointData()->HasArray("SurfaceOnly"));
  Pipeline withPoints(cube, MakePoints({ { 0.5, 0.45, 0.4 } }));
  withPoints.Filter->Update();
  EXPECT_FALSE(withPoints.GetMesh()->GetPointData()->HasArray("SurfaceOnly"));
  ExpectLinear(withPoints.GetMesh());
}

TEST(AdvancingFrontTetrahedralizerFilter, MeshesOnlySeededRegions)
{
  Pipeline run(MakeTwoBoxes());
  auto seeds = MakePoints({ { 2.1, 0.4, 0.45 } });
  run.Filter->SetInputData(2, seeds);
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_NEAR(GetVolume(run.GetMesh()), 2.0, 1e-13);
  EXPECT_NEAR(GetVolume(run.GetMesh(), 0), 2.0, 1e-13);

  vtkNew<vtkIntArray> ids;
  ids->SetName("RegionId");
  ids->InsertNextValue(5);
  seeds->GetPointData()->AddArray(ids);
  seeds->Modified();
  run.Filter->Update();
  EXPECT_NEAR(GetVolume(run.GetMesh(), 5), 2.0, 1e-13);

  ids->SetValue(0, -3);
  seeds->Modified();
  ids->Modified();
  ExpectFailure(run.Filter, { "RegionId of the seeds", "seed 0" });
}

TEST(AdvancingFrontTetrahedralizerFilter, ClosesOpenBoundaries)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 }, -1, 0, 1);
  {
    Pipeline run(builder.Build());
    ExpectFailure(run.Filter, { "CloseOpenBoundary", "Cells: " });
  }
  for (bool withLabels : { true, false })
  {
    SCOPED_TRACE(withLabels ? "with labels" : "without labels");
    Pipeline run(builder.Build(withLabels));
    run.Filter->CloseOpenBoundaryOn();
    run.Filter->Update();
    EXPECT_EQ(run.Recorder->Errors, "");
    EXPECT_NEAR(GetVolume(run.GetMesh()), 1.0, 1e-13);
    ExpectClosed(run);
    EXPECT_NEAR(GetArea(run.GetSurface(1), -1, 0), 6.0, 1e-13);
  }
}

TEST(AdvancingFrontTetrahedralizerFilter, StopsAtTheLimitWithItsFront)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(16);
  sphere->SetPhiResolution(16);
  sphere->Update();
  Pipeline run(sphere->GetOutput(), MakePoints({ { 0.1, 0, 0 }, { -0.1, 0.05, 0.02 } }));
  run.Filter->Update();
  const vtkIdType all = run.GetMesh()->GetNumberOfCells();
  run.Filter->SetMaximumNumberOfTetrahedra(20);
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_GE(run.GetMesh()->GetNumberOfCells(), 20);
  EXPECT_LT(run.GetMesh()->GetNumberOfCells(), all);
  EXPECT_GT(run.GetSurface(2)->GetNumberOfPolys(), 0);
  EXPECT_EQ(run.GetSurface(2)->GetPoints()->GetDataType(), VTK_DOUBLE);
}

TEST(AdvancingFrontTetrahedralizerFilter, RefusesBadInput)
{
  vtkNew<vtkAdvancingFrontTetrahedralizer> filter;
  vtkNew<vtkPolyData> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "empty" });
  filter->SetInputData(MakeCube());
  ExpectFailure(filter, { "vtkBoundaryTriangulator", "Cells: 0, 1, 2, 3, 4, 5 (6 in all)" });

  Pipeline square(MakeSquare());
  ExpectFailure(square.Filter, { "encloses nothing", "Cells: 0, 1 (2 in all)" });

  Pipeline run(MakeCube());
  run.Refiner->Update();
  vtkNew<vtkPolyData> surface;
  surface->DeepCopy(run.Refiner->GetOutput());
  surface->GetPoints()->SetPoint(2, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  filter->SetInputData(surface);
  ExpectFailure(filter, { "finite", "Points: 2 (0, nan, 0)" });

  // Points on both sides of the interface, and close to it, disturb its two triangles.
  Pipeline boxes(MakeTwoBoxes());
  boxes.Filter->SetInputData(1, MakePoints({ { 0.99, 0.5, 0.5 }, { 1.01, 0.5, 0.5 } }));
  ExpectFailure(boxes.Filter, { "with the surface refiner first", "(2 in all)" });
}

TEST(AdvancingFrontTetrahedralizerFilter, MeshesPointsOfAnyPointSet)
{
  // The points of a grid of unit cubes; its cells do not matter.
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> corners;
  for (int i = 0; i < 27; ++i)
  {
    corners->InsertNextPoint(i % 3, i / 3 % 3, i / 9);
  }
  grid->SetPoints(corners);
  vtkNew<vtkAdvancingFrontTetrahedralizer> filter;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputData(grid);
  filter->CloseOpenBoundaryOn();
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 8 * 6);
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 0), 8.0, 1e-14);
}

TEST(AdvancingFrontTetrahedralizerFilter, ReportsProgressAndKeepsThePartialMeshOfAnAbort)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(40);
  sphere->Update();
  std::vector<Point> points;
  for (int i = 0; i < 1000; ++i)
  {
    points.push_back({ 0.05 * (i % 10) - 0.225, 0.05 * (i / 10 % 10) - 0.225 + 0.0001 * i,
      0.05 * (i / 100) - 0.225 });
  }
  Pipeline run(sphere->GetOutput(), MakePoints(points));
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  ExpectProgress(run.Recorder);
  ExpectClosed(run);
  const vtkIdType all = run.GetMesh()->GetNumberOfCells();
  const double volume = GetVolume(run.GetMesh());

  run.Recorder->AbortAt = 0.8;
  run.Filter->Modified();
  run.Filter->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_GT(run.GetMesh()->GetNumberOfCells(), 0);
  EXPECT_LT(run.GetMesh()->GetNumberOfCells(), all);
  EXPECT_LT(GetVolume(run.GetMesh()), volume);
  EXPECT_GT(run.GetSurface(2)->GetNumberOfCells(), 0);

  run.Recorder->AbortAt = 2.0;
  run.Filter->SetAbortExecute(0);
  run.Filter->Modified();
  run.Filter->Update();
  EXPECT_EQ(run.GetMesh()->GetNumberOfCells(), all);
}
