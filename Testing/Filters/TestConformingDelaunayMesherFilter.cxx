// SPDX-License-Identifier: BSD-3-Clause
#include "../Core/ComplexKinds.h"
#include "FilterTesting.h"
#include "MeshCertificate.h"

#include <vtkCleanPolyData.h>
#include <vtkConformingDelaunayMesher.h>
#include <vtkDataSetTriangleFilter.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkProbeFilter.h>
#include <vtkSphereSource.h>
#include <vtkStringArray.h>
#include <vtkSuperquadricSource.h>
#include <vtkTechnologyStructureSource.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <vector>

using namespace testing_filters;

namespace
{
vtkPolyData* GetSurface(vtkConformingDelaunayMesher* filter, int port)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port));
}

std::string GetCertificate(vtkUnstructuredGrid* mesh)
{
  std::string text;
  for (const std::string& line : GetTexts(mesh, "Certificate"))
  {
    text += (text.empty() ? "" : "\n") + line;
  }
  EXPECT_NE(text, "");
  return text;
}

void ExpectSameCells(vtkUnstructuredGrid* mesh, vtkUnstructuredGrid* expected)
{
  ASSERT_EQ(mesh->GetNumberOfCells(), expected->GetNumberOfCells());
  ASSERT_GT(mesh->GetNumberOfCells(), 0);
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_EQ(mesh->GetCell(cell)->GetPointId(i), expected->GetCell(cell)->GetPointId(i));
    }
  }
}

/** The cube turned about an odd axis: cospherical and coplanar up to rounding only. */
vtkSmartPointer<vtkPolyData> MakeTurnedBoxes()
{
  auto boxes = MakeTwoBoxes(true);
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  for (vtkIdType i = 0; i < boxes->GetNumberOfPoints(); ++i)
  {
    double x[3];
    boxes->GetPoint(i, x);
    const double y[3] = { c * x[0] - s * x[1], s * x[0] + c * x[1], x[2] };
    boxes->GetPoints()->SetPoint(i, y[0], c * y[1] - s * y[2], s * y[1] + c * y[2]);
  }
  return boxes;
}

/** The turned boxes are meshed like the straight ones. */
void ExpectTurnedBoxes(double maximumEdgeLength)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(MakeTurnedBoxes());
  filter->SetMaximumEdgeLength(maximumEdgeLength);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->GetFaults(), "") << GetCertificate(filter->GetOutput());
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 3), 1.0, 1e-12);
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 7), 2.0, 1e-12);
  // Also where tetrahedra were peeled off, the boundary is whole and knows its polygons.
  vtkPolyData* boundary = GetSurface(filter, 1);
  EXPECT_NEAR(GetArea(boundary, 3, 7), 1.0, 1e-12);
  EXPECT_NEAR(GetArea(boundary, -1, 3), 5.0, 1e-12);
  EXPECT_NEAR(GetArea(boundary, -1, 7), 9.0, 1e-12);
  vtkDataArray* ids = FindArray(boundary->GetCellData(), "PolygonId", 1, VTK_INT);
  vtkDataArray* labels = boundary->GetCellData()->GetArray("BoundaryLabels");
  ASSERT_NE(ids, nullptr);
  for (vtkIdType i = 0; i < boundary->GetNumberOfCells(); ++i)
  {
    const bool isInterface = labels->GetComponent(i, 0) != -1 && labels->GetComponent(i, 1) != -1;
    EXPECT_EQ(ids->GetComponent(i, 0) == 5, isInterface);
  }
}
} // namespace

TEST(ConformingDelaunayMesherFilter, MeshesTwoMaterials)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(MakeTwoBoxes(true));
  filter->SetMaximumEdgeLength(0.4);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->GetFaults(), "");
  vtkUnstructuredGrid* mesh = filter->GetOutput();
  EXPECT_NEAR(GetVolume(mesh, 3), 1.0, 1e-12);
  EXPECT_NEAR(GetVolume(mesh, 7), 2.0, 1e-12);
  EXPECT_NE(GetCertificate(mesh), "");
  ExpectLinear(mesh);
  FindArray(mesh->GetCellData(), "RegionId", 1, VTK_INT);
  EXPECT_EQ(mesh->GetCellData()->GetNumberOfArrays(), 1);
  EXPECT_EQ(mesh->GetPointData()->GetNumberOfArrays(), 1);

  vtkPolyData* boundary = GetSurface(filter, 1);
  EXPECT_NEAR(GetArea(boundary, 3, 7), 1.0, 1e-12);
  EXPECT_NEAR(GetArea(boundary, -1, 3), 5.0, 1e-12);
  EXPECT_NEAR(GetArea(boundary, -1, 7), 9.0, 1e-12);
  FindArray(boundary->GetCellData(), "PolygonId", 1, VTK_INT);
  FindArray(boundary->GetCellData(), "StructuralFacetId", 1, VTK_INT);
  EXPECT_EQ(boundary->GetCellData()->GetNumberOfArrays(), 3);
  EXPECT_EQ(GetSurface(filter, 2)->GetNumberOfCells(), 0);
  FindArray(GetSurface(filter, 2)->GetCellData(), "ProblemKind", 1, VTK_INT);
}

/** The mesh is right but for the size that was asked for, and its certificate says what holds. */
TEST(ConformingDelaunayMesherFilter, TheTimeLimitLeavesAMesh)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetInputData(MakeTurnedBoxes());
  filter->SetMaximumEdgeLength(0.05);
  filter->SetMaximumTime(1e-9);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "MaximumTime")) << recorder->Warnings;
  EXPECT_EQ(GetCertificate(filter->GetOutput()).find("CLEAN FOR FINITE VOLUMES\n"), 0u)
    << GetCertificate(filter->GetOutput());
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 3), 1.0, 1e-12);
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 7), 2.0, 1e-12);
}

/** As it is: what finite volumes ask for; with each value set, as before there were purposes. */
TEST(ConformingDelaunayMesherFilter, IsForFiniteVolumesUnlessTold)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetInputData(MakeTwoBoxes(true));
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->GetFaults(), "");
  vtkFieldData* data = filter->GetOutput()->GetFieldData();
  EXPECT_EQ(GetCertificate(filter->GetOutput()).find("CLEAN FOR FINITE VOLUMES\n"), 0u);
  EXPECT_EQ(data->GetArray("TetrahedraUnder15Degrees")->GetComponent(0, 0), 0.0);
  EXPECT_EQ(
    data->GetArray("MeshFor")->GetComponent(0, 0), vtkConformingDelaunayMesher::FINITE_VOLUMES);
  const double size = data->GetArray("MaximumEdgeLength")->GetComponent(0, 0);
  EXPECT_GT(size, 0.0);
  EXPECT_LT(size, 0.3);

  filter->SetMaximumEdgeLength(0.5);
  filter->Update();
  EXPECT_EQ(
    filter->GetOutput()->GetFieldData()->GetArray("MaximumEdgeLength")->GetComponent(0, 0), 0.5);

  vtkNew<vtkConformingDelaunayMesher> fewest;
  fewest->SetMeshForToFewestPoints();
  fewest->SetInputData(MakeTwoBoxes(true));
  fewest->Update();
  filter->SetCriterionToDelaunay();
  filter->SetMaximumEdgeLength(0.0);
  filter->AddSteinerPointsOff();
  filter->RemoveSliversOn();
  filter->SetDihedralAngleTarget(15.0);
  filter->SetRadiusEdgeRatio(1.4);
  filter->Update();
  ExpectSameCells(filter->GetOutput(), fewest->GetOutput());
}

TEST(ConformingDelaunayMesherFilter, RefusesNumbersOutOfTheirRange)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetInputData(MakeTwoBoxes(true));
  filter->SetMaximumEdgeLength(-5.0);
  ExpectFailure(filter, { "MaximumEdgeLength is -5", "or -1" });
  filter->SetMaximumEdgeLength(vtkConformingDelaunayMesher::AUTOMATIC);
  filter->SetDihedralAngleTarget(71.0);
  ExpectFailure(filter, { "DihedralAngleTarget is 71", "from 0 to 70" });
  filter->SetDihedralAngleTarget(vtkConformingDelaunayMesher::AUTOMATIC);
  filter->SetRadiusEdgeRatio(-0.5);
  ExpectFailure(filter, { "RadiusEdgeRatio is -0.5" });
}

TEST(ConformingDelaunayMesherFilter, MeshesTurnedBoxes)
{
  ExpectTurnedBoxes(0.0);
}

TEST(ConformingDelaunayMesherFilter, MeshesTurnedBoxesWithShortEdges)
{
  ExpectTurnedBoxes(0.4);
}

/**
 * Of coordinates in single precision: the tetrahedra peeled off have a volume, 1e-10 of the whole.
 */
TEST(ConformingDelaunayMesherFilter, PeelingLeavesAValidMesh)
{
  vtkNew<vtkSuperquadricSource> source;
  source->ToroidalOn();
  source->SetThetaResolution(24);
  source->SetPhiResolution(24);
  source->SetSize(10.0);
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkCleanPolyData> surface;
  surface->SetInputConnection(triangles->GetOutputPort());
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputConnection(surface->GetOutputPort());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->GetFaults(), "");
  EXPECT_EQ(GetCertificate(filter->GetOutput()).find("DELAUNAY\n"), 0u)
    << GetCertificate(filter->GetOutput());
}

/**
 * Random tetrahedra of many regions in a slab. As it is made it fulfils the criterion; turned and
 * moved, it does not.
 */
TEST(ConformingDelaunayMesherFilter, MeshesWhatMissesTheCriterion)
{
  cdm::ComplexMaker maker(cdm::ComplexKind::SlabTetrahedra, 3);
  cdm::PolygonSoup soup = maker.Make();
  maker.Place(soup);
  SurfaceBuilder builder;
  for (const cdm::Vec3& point : soup.Points)
  {
    builder.AddPoint(point[0], point[1], point[2]);
  }
  for (cdm::Id i = 0; i < soup.GetNumberOfPolygons(); ++i)
  {
    const cdm::Id* const polygon = soup.GetPolygon(i);
    builder.AddPolygon({ polygon, polygon + soup.GetPolygonSize(i) },
      static_cast<int>(soup.Labels[i].Front), static_cast<int>(soup.Labels[i].Back));
  }
  for (const bool hasSteinerPoints : { false, true })
  {
    vtkNew<vtkConformingDelaunayMesher> filter;
    filter->SetMeshForToFewestPoints();
    filter->SetInputData(builder.Build(true));
    filter->SetCriterionToSmallestSphere();
    filter->SetAddSteinerPoints(hasSteinerPoints);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(filter);
    filter->Update();
    EXPECT_EQ(recorder->Errors, "");
    EXPECT_TRUE(Contains(recorder->Warnings, "do not fulfil the criterion within the limits"));
    EXPECT_EQ(Contains(recorder->Warnings, "no Steiner points"), hasSteinerPoints);
    EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
    vtkDataArray* marks =
      FindArray(GetSurface(filter, 1)->GetCellData(), "Unresolved", 1, VTK_UNSIGNED_CHAR);
    ASSERT_NE(marks, nullptr);
    EXPECT_EQ(marks->GetRange()[1], 1.0);
    const std::string certificate = GetCertificate(filter->GetOutput());
    EXPECT_TRUE(Contains(certificate, " between regions ")) << certificate;
    EXPECT_EQ(certificate.find("DELAUNAY\n"), 0u) << certificate;
  }
}

TEST(ConformingDelaunayMesherFilter, WorksWithoutSliverRemoval)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(MakeCubeWithCavity());
  filter->RemoveSliversOff();
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 0), 26.0, 1e-11);
  EXPECT_NE(GetCertificate(filter->GetOutput()), "");
}

TEST(ConformingDelaunayMesherFilter, FulfilsCriteriaAndUsesItsOtherInputs)
{
  auto sizing = MakePoints({ { 0.5, 0.5, 0.5 } });
  vtkNew<vtkDoubleArray> values;
  values->SetName("Sizing");
  values->InsertNextValue(0.35);
  sizing->GetPointData()->AddArray(values);
  for (int criterion = 0; criterion < 3; ++criterion)
  {
    vtkNew<vtkConformingDelaunayMesher> filter;
    filter->SetMeshForToFewestPoints();
    filter->SetInputData(MakeCube());
    filter->SetInputData(1, MakePoints({ { 0.5, 0.4, 0.6 }, { 0.2, 0.3, 0.4 } }));
    filter->SetInputData(2, sizing);
    filter->SetCriterion(criterion);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(filter);
    filter->Update();
    EXPECT_EQ(recorder->GetFaults(), "") << criterion;
    EXPECT_NEAR(GetVolume(filter->GetOutput(), 0), 1.0, 1e-12);
    EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 60);
    ExpectLinear(filter->GetOutput());
  }
}

TEST(ConformingDelaunayMesherFilter, SizesHoldAllAlongEdgesAndInTetrahedra)
{
  // 0.01 at one point of a coarse grid, on a facet's middle line, and 1 everywhere else.
  vtkNew<vtkImageData> image;
  image->SetDimensions(5, 5, 5);
  image->SetSpacing(0.25, 0.25, 0.25);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Sizing");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    const double place[3] = { 0.5, 0.25, 0.5 };
    const bool isPlace = vtkMath::Distance2BetweenPoints(image->GetPoint(i), place) < 1e-12;
    values->InsertNextValue(isPlace ? 0.01 : 1.0);
  }
  image->GetPointData()->AddArray(values);
  vtkNew<vtkDataSetTriangleFilter> tetrahedra;
  tetrahedra->SetInputData(image);
  tetrahedra->Update();
  for (vtkDataSet* sizing :
    { static_cast<vtkDataSet*>(image.Get()), static_cast<vtkDataSet*>(tetrahedra->GetOutput()) })
  {
    vtkNew<vtkConformingDelaunayMesher> filter;
    filter->SetMeshForToFewestPoints();
    filter->SetInputData(MakeCube());
    filter->SetInputData(2, sizing);
    filter->AddSteinerPointsOn();
    vtkNew<EventRecorder> recorder;
    recorder->Watch(filter);
    filter->Update();
    EXPECT_EQ(recorder->GetFaults(), "");
    vtkUnstructuredGrid* mesh = filter->GetOutput();
    EXPECT_EQ(mesh->GetCellData()->GetArray("RefinementFault"), nullptr);
    // Positions along all edges, and all over the tetrahedra, with the longest edge there.
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    std::vector<double> lengths;
    const auto add = [&](const std::array<double, 4>& weights, vtkCell* cell, double length)
    {
      double x[3] = { 0.0, 0.0, 0.0 };
      for (int i = 0; i < 12; ++i)
      {
        x[i % 3] += weights[i / 3] * cell->GetPoints()->GetPoint(i / 3)[i % 3];
      }
      points->InsertNextPoint(x);
      lengths.push_back(length);
    };
    for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
    {
      vtkCell* cell = mesh->GetCell(t);
      double longest = 0.0;
      for (int e = 0; e < 6; ++e)
      {
        longest = std::max(longest, std::sqrt(cell->GetEdge(e)->GetLength2()));
      }
      for (int i = 0; i <= 8; ++i)
      {
        for (int j = 0; i + j <= 8; ++j)
        {
          for (int k = 0; i + j + k <= 8; ++k)
          {
            add({ i / 8.0, j / 8.0, k / 8.0, (8 - i - j - k) / 8.0 }, cell, longest);
          }
        }
      }
    }
    vtkNew<vtkPolyData> samples;
    samples->SetPoints(points);
    vtkNew<vtkProbeFilter> probe;
    probe->SetInputData(samples);
    probe->SetSourceData(sizing);
    probe->Update();
    vtkDataArray* sizes = probe->GetOutput()->GetPointData()->GetArray("Sizing");
    vtkDataArray* isValid =
      probe->GetOutput()->GetPointData()->GetArray(probe->GetValidPointMaskArrayName());
    double worst = 0.0;
    vtkIdType number = 0;
    for (vtkIdType i = 0; i < samples->GetNumberOfPoints(); ++i)
    {
      if (isValid->GetComponent(i, 0) != 0.0)
      {
        worst = std::max(worst, lengths[i] / sizes->GetComponent(i, 0));
        ++number;
      }
    }
    std::cout << mesh->GetNumberOfCells() << " tetrahedra; longest edge to sizing, at " << number
              << " positions: up to " << worst << "\n";
    EXPECT_GT(number, samples->GetNumberOfPoints() / 2);
    EXPECT_LE(worst, 1.0 + 1e-9);
  }
}

TEST(ConformingDelaunayMesherFilter, RefusesBadInputAndNamesItsOwnCells)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  vtkNew<vtkPolyData> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "vtkConformingDelaunayMesher", "empty" });
  filter->SetInputData(MakeCubeWithNaN());
  ExpectFailure(filter, { "not finite", "Points: 6 (0, nan, 1)" });
  filter->SetInputData(MakeCrossingBoxes());
  ExpectFailure(filter, { "Cells: 5, " }, 3);
  ExpectEmptyOutputs(filter, 3);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_EQ(GetSurface(filter, 1)->GetNumberOfCells(), 0);
  EXPECT_GT(GetSurface(filter, 2)->GetNumberOfCells(), 0);

  // Squares 6 to 8 stand apart from the cube; only their polygons have open edges.
  SurfaceBuilder builder;
  for (int i = 0; i < 3; ++i)
  {
    const vtkIdType first = builder.AddPoint(0, 0, i);
    builder.AddPoint(1, 0, i);
    builder.AddPoint(1, 1, i);
    builder.AddPoint(0, 1, i);
    builder.AddPolygon({ first, first + 1, first + 2, first + 3 });
  }
  filter->SetInputData(builder.Build());
  ExpectFailure(filter, { "encloses nothing", "Cells: 0, 1, 2 (3 in all)" }, 3);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(GetSurface(filter, 1)->GetNumberOfPoints(), 0);

  filter->SetInputData(MakeCube());
  filter->Update();
  EXPECT_NEAR(GetVolume(filter->GetOutput()), 1.0, 1e-13);
}

TEST(ConformingDelaunayMesherFilter, RepairsPolygonsWithRepeatedPoints)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  builder.AddPolygon({ 0, 1, 1, 0 });
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(builder.Build());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "Cells: 6 (1 in all)")) << recorder->Warnings;
  EXPECT_NEAR(GetVolume(filter->GetOutput()), 1.0, 1e-13);
}

TEST(ConformingDelaunayMesherFilter, ResolvesSelfIntersections)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(MakeCrossingBoxes());
  filter->ResolveSelfIntersectionsOn();
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  // The union, then the same with the part of the second box inside of the first one.
  EXPECT_NEAR(GetVolume(filter->GetOutput(), 0), 1.125, 1e-12);
  EXPECT_GT(GetSurface(filter, 2)->GetNumberOfCells(), 0);
  filter->KeepInternalPiecesOn();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_NEAR(GetVolume(filter->GetOutput()), 1.125, 1e-12);
  EXPECT_GT(GetVolume(filter->GetOutput(), 2), 0.0);
}

TEST(ConformingDelaunayMesherFilter, ClosesGapsAndOpenBoundaries)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 }, -1, 0, 1);
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(builder.Build());
  ExpectFailure(filter, { "Cells: " }, 3);
  filter->SetMaximumGapEdges(4);
  filter->Update();
  EXPECT_NEAR(GetVolume(filter->GetOutput()), 1.0, 1e-13);
  filter->SetMaximumGapEdges(0);
  filter->CloseOpenBoundaryOn();
  filter->Update();
  EXPECT_NEAR(GetVolume(filter->GetOutput()), 1.0, 1e-13);
}

TEST(ConformingDelaunayMesherFilter, IsDeterministic)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(12);
  sphere->SetPhiResolution(12);
  vtkNew<vtkConformingDelaunayMesher> first;
  first->SetMeshForToFewestPoints();
  vtkNew<vtkConformingDelaunayMesher> second;
  second->SetMeshForToFewestPoints();
  for (vtkConformingDelaunayMesher* filter : { first.Get(), second.Get() })
  {
    filter->SetInputConnection(sphere->GetOutputPort());
    filter->Update();
  }
  ExpectSameCells(first->GetOutput(), second->GetOutput());
}

TEST(ConformingDelaunayMesherFilter, ReportsProgressOfItsStagesAndAborts)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(40);
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputConnection(sphere->GetOutputPort());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectProgress(recorder);
  for (const char* stage :
    { "Boundary triangulation", "Surface refinement", "Tetrahedralization", "Sliver removal" })
  {
    EXPECT_TRUE(std::any_of(recorder->Texts.begin(), recorder->Texts.end(),
      [stage](const std::string& text) { return Contains(text, stage); }))
      << stage;
  }
  for (double abortAt : { 0.02, 0.3, 0.7 })
  {
    recorder->AbortAt = abortAt;
    filter->SetAbortExecute(0);
    filter->Modified();
    filter->Update();
    EXPECT_EQ(recorder->Errors, "");
    ExpectEmptyOutputs(filter);
  }
  recorder->AbortAt = 2.0;
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST(ConformingDelaunayMesherFilter, AddsSteinerPoints)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(MakeTwoBoxes(true));
  mesher->SetInputData(1, MakePoints({ { 0.51, 0.52, 0.53 }, { 0.51, 0.52, 0.55 } }));
  mesher->AddSteinerPointsOn();
  mesher->SetMaximumEdgeLength(0.3);
  for (const bool isGenerating : { false, true })
  {
    mesher->SetGenerateMeshPoints(isGenerating);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(mesher);
    mesher->Update();
    mesher->RemoveObserver(recorder);
    EXPECT_EQ(recorder->GetFaults(), "");
    ExpectProgress(recorder);
    vtkUnstructuredGrid* output = mesher->GetOutput();
    ExpectLinear(output);
    EXPECT_NEAR(GetVolume(output), 3.0, 1e-12);
    EXPECT_TRUE(Contains(GetCertificate(output), "DELAUNAY\n"));
    // The points given stay where they are, though they are close to each other.
    int given = 0;
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      const double* p = output->GetPoint(i);
      given += p[0] == 0.51 && p[1] == 0.52 && (p[2] == 0.53 || p[2] == 0.55);
    }
    EXPECT_EQ(given, 2);
    EXPECT_EQ(output->GetCellData()->GetArray("RefinementFault"), nullptr);
    for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
    {
      vtkPoints* p = output->GetCell(cell)->GetPoints();
      for (int edge = 0; edge < 6; ++edge)
      {
        const vtkIdType* ends = vtkTetra::GetEdgeArray(edge);
        EXPECT_LE(vtkMath::Distance2BetweenPoints(p->GetPoint(ends[0]), p->GetPoint(ends[1])),
          0.3 * 0.3 * (1.0 + 1e-12));
      }
    }
  }
}

/** The sliver remover is not run after them: there is nothing left for it to do. */
TEST(ConformingDelaunayMesherFilter, SteinerPointsRemoveSliversIfAsked)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(MakeTwoBoxes(true));
  mesher->AddSteinerPointsOn();
  mesher->SetMaximumEdgeLength(0.15);
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputConnection(0, mesher->GetOutputPort(0));
  criteria->SetInputConnection(1, mesher->GetOutputPort(1));
  for (const bool isRemoving : { false, true })
  {
    mesher->SetRemoveSlivers(isRemoving);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(mesher);
    criteria->Update();
    mesher->RemoveObserver(recorder);
    EXPECT_EQ(recorder->GetFaults(), "");
    const double angle =
      criteria->GetOutput()->GetCellData()->GetArray("SmallestDihedralAngle")->GetRange()[0];
    EXPECT_EQ(angle >= 15.0, isRemoving) << angle;
    EXPECT_TRUE(criteria->GetIsClean()) << criteria->GetCertificate();
    EXPECT_TRUE(std::none_of(recorder->Texts.begin(), recorder->Texts.end(),
      [](const std::string& text) { return Contains(text, "Sliver removal"); }));
  }
}

/** In the bulk, where points can move; the gate oxide has none. */
TEST(ConformingDelaunayMesherFilter, SmoothsForSolversWithoutSigns)
{
  vtkNew<vtkTechnologyStructureSource> source;
  source->SetStructure(vtkTechnologyStructureSource::MOS_TRANSISTOR);
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetInputConnection(source->GetOutputPort());
  // In a lattice most circumcenters lie well as they are.
  mesher->GenerateMeshPointsOff();
  std::vector<std::array<double, 2>> found;
  for (const int rounds : { 0, 4 })
  {
    mesher->SetSmoothingRounds(rounds);
    mesher->Update();
    vtkFieldData* fields = mesher->GetOutput()->GetFieldData();
    EXPECT_TRUE(Contains(GetCertificate(mesher->GetOutput()), "CLEAN FOR FINITE VOLUMES"));
    vtkNew<vtkDelaunayMeshCriteria> criteria;
    criteria->SetInputConnection(0, mesher->GetOutputPort(0));
    criteria->SetInputConnection(1, mesher->GetOutputPort(1));
    criteria->Update();
    found.push_back({ fields->GetArray("RegionUnsignedBoxRatios")->GetComponent(0, 0),
      static_cast<double>(CountSlivers(criteria)) });
    std::cout << rounds << " rounds: ratio " << found.back()[0] << "\n";
  }
  EXPECT_GT(found[0][0], 1.1);
  EXPECT_LT(found[1][0], 1.04);
  EXPECT_LE(found[1][1], found[0][1]);
}

namespace
{
double GetLongestEdge(vtkUnstructuredGrid* mesh, int region)
{
  vtkDataArray* regions = mesh->GetCellData()->GetArray("RegionId");
  double longest = 0.0;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    if (regions->GetComponent(cell, 0) == region)
    {
      vtkIdList* ids = mesh->GetCell(cell)->GetPointIds();
      for (int i = 0; i < 4; ++i)
      {
        for (int j = 0; j < i; ++j)
        {
          double a[3];
          double b[3];
          mesh->GetPoint(ids->GetId(i), a);
          mesh->GetPoint(ids->GetId(j), b);
          longest = std::max(longest, std::sqrt(vtkMath::Distance2BetweenPoints(a, b)));
        }
      }
    }
  }
  return longest;
}

/** Region 3 is called Oxide. */
vtkSmartPointer<vtkPolyData> MakeNamedBoxes()
{
  auto boxes = MakeTwoBoxes(true);
  vtkNew<vtkStringArray> names;
  names->SetName("RegionNames");
  names->SetNumberOfValues(4);
  names->SetValue(3, "Oxide");
  boxes->GetFieldData()->AddArray(names);
  return boxes;
}
} // namespace

TEST(ConformingDelaunayMesherFilter, KeepsSizesOfRegions)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetInputData(MakeNamedBoxes());
  filter->SetMaximumEdgeLength(0.5);
  filter->AddRegionSize("Oxide", 0.2);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  EXPECT_LE(GetLongestEdge(filter->GetOutput(), 3), 0.2 * (1.0 + 1e-12));
  EXPECT_GT(GetLongestEdge(filter->GetOutput(), 7), 0.25);
  vtkNew<vtkUnstructuredGrid> named;
  named->DeepCopy(filter->GetOutput());

  filter->RemoveAllRegionSizes();
  filter->AddRegionSize(3, 0.2);
  filter->Update();
  ExpectSameCells(filter->GetOutput(), named);

  // Edges that may grow faster fill less of the other region.
  filter->SetGrowth(2.0);
  filter->Update();
  EXPECT_LT(filter->GetOutput()->GetNumberOfCells(), named->GetNumberOfCells());
  EXPECT_LE(GetLongestEdge(filter->GetOutput(), 3), 0.2 * (1.0 + 1e-12));

  filter->SetGrowth(0.0);
  ExpectFailure(filter, { "Growth" }, 0);
  filter->SetGrowth(1.0);
  filter->AddRegionSize("Gas", 0.2);
  ExpectFailure(filter, { "RegionSizes", "Gas", "Oxide" }, 0);
}

TEST(ConformingDelaunayMesherFilter, NamesRegionsOfLayers)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(MakeNamedBoxes());
  filter->SetMaximumEdgeLength(0.25);
  filter->GenerateMeshPointsOn();
  filter->AddLayers(3, 7, 2, 0.01, 2.0);
  filter->Update();
  vtkNew<vtkUnstructuredGrid> numbered;
  numbered->DeepCopy(filter->GetOutput());
  filter->RemoveAllLayers();
  filter->AddLayers("Oxide", "7", 2, 0.01, 2.0);
  filter->Update();
  ExpectSameCells(filter->GetOutput(), numbered);
  filter->AddLayers("Gas", "7", 2, 0.01, 2.0);
  ExpectFailure(filter, { "Layers 1", "Gas", "Oxide" }, 0);
}

TEST(ConformingDelaunayMesherFilter, EmptiesLayersByIdAndByNameOneByOne)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(MakeNamedBoxes());
  filter->SetMaximumEdgeLength(0.25);
  filter->GenerateMeshPointsOn();
  const auto count = [&]
  {
    filter->Update();
    return filter->GetOutput()->GetNumberOfPoints();
  };
  const vtkIdType none = count();
  filter->AddLayers(3, 7, 1, 0.01, 1.0);
  const vtkIdType byId = count();
  filter->AddLayers("7", "Oxide", 1, 0.01, 1.0);
  const vtkIdType both = count();
  EXPECT_GT(byId, none);
  EXPECT_GT(both, byId);
  filter->RemoveAllLayersByName();
  EXPECT_EQ(count(), byId);
  filter->AddLayers("7", "Oxide", 1, 0.01, 1.0);
  filter->RemoveAllLayersById();
  const vtkIdType byName = count();
  EXPECT_GT(byName, none);
  EXPECT_LT(byName, both);
  filter->AddLayers(3, 7, 1, 0.01, 1.0);
  EXPECT_EQ(count(), both);
  filter->RemoveAllLayers();
  EXPECT_EQ(count(), none);
}

TEST(ConformingDelaunayMesherFilter, NamesArraysThatMeshPointsLack)
{
  vtkSmartPointer<vtkPolyData> points = MakePoints({ { 0.51, 0.52, 0.53 } });
  points->GetPointData()->Initialize();
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetInputData(MakeTwoBoxes(true));
  filter->SetInputData(1, points);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_TRUE(Contains(recorder->Warnings, "that the mesh points lack is not kept: Linear."));
}

TEST(ConformingDelaunayMesherFilter, GeneratesMeshPoints)
{
  vtkNew<vtkConformingDelaunayMesher> filter;
  filter->SetMeshForToFewestPoints();
  filter->SetInputData(MakeTwoBoxes(true));
  filter->SetMaximumEdgeLength(0.25);
  filter->Update();
  const vtkIdType without = filter->GetOutput()->GetNumberOfPoints();

  // An octree as fine as the boundary, and layers on both sides of the interface.
  filter->GenerateMeshPointsOn();
  filter->AddLayers(3, 7, 2, 0.01, 2.0);
  filter->AddLayers(7, 3, 1, 0.02, 1.0);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->GetFaults(), "");
  ExpectProgress(recorder);
  vtkUnstructuredGrid* mesh = filter->GetOutput();
  ExpectLinear(mesh);
  EXPECT_GT(mesh->GetNumberOfPoints(), without + 50);
  EXPECT_NEAR(GetVolume(mesh, 3), 1.0, 1e-12);
  EXPECT_NEAR(GetVolume(mesh, 7), 2.0, 1e-12);
  EXPECT_EQ(GetCertificate(mesh).find("DELAUNAY\n"), 0u) << GetCertificate(mesh);
  const auto countAt = [mesh](double x)
  {
    vtkIdType count = 0;
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      double p[3];
      mesh->GetPoint(i, p);
      count += std::abs(p[0] - x) < 1e-12 && p[1] > 0.0 && p[1] < 1.0 && p[2] > 0.0 && p[2] < 1.0;
    }
    return count;
  };
  const vtkIdType inLayer = countAt(0.99);
  EXPECT_GT(inLayer, 4);
  EXPECT_EQ(countAt(0.97), inLayer);
  EXPECT_EQ(countAt(1.02), inLayer);

  // A layer nearer than the clearance is dropped, with a warning, unless that is lowered.
  filter->RemoveAllLayers();
  filter->SetPlacement(vtkMeshPointGenerator::NONE);
  filter->AddLayers(3, 7, 1, 0.001, 1.0);
  filter->Update();
  EXPECT_TRUE(Contains(recorder->Warnings, "MeshPointClearanceRatio"));
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), without);
  recorder->Warnings.clear();
  filter->SetMeshPointClearanceRatio(1e-6);
  filter->Update();
  EXPECT_EQ(recorder->GetFaults(), "");
  EXPECT_EQ(countAt(0.999), inLayer);

  // Points of the second port are used as well; a wrong layer is this filter's error.
  filter->SetInputData(1, MakePoints({ { 2.2, 0.4, 0.6 } }));
  filter->Update();
  EXPECT_EQ(countAt(2.2), 1);
  EXPECT_EQ(countAt(0.999), inLayer);
  filter->AddLayers(3, 8, 1, 0.1, 1.0);
  ExpectFailure(filter, { "3", "8" }, 0);
}
