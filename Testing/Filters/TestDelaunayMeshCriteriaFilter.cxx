// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkTechnologyStructureSource.h>

#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkMeshQuality.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>

using namespace testing_filters;

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> MakeTetrahedra(
  const std::vector<Point>& points, const std::vector<std::array<vtkIdType, 4>>& tetrahedra)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataTypeToDouble();
  for (const Point& point : points)
  {
    coordinates->InsertNextPoint(point.data());
  }
  grid->SetPoints(coordinates);
  grid->AllocateEstimate(static_cast<vtkIdType>(tetrahedra.size()), 4);
  for (const auto& tetrahedron : tetrahedra)
  {
    grid->InsertNextCell(VTK_TETRA, 4, tetrahedron.data());
  }
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> MakeTransistor()
{
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToMosTransistor();
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputConnection(device->GetOutputPort());
  mesher->SetCriterionToSmallestSphereAndEdges();
  mesher->Update();
  return mesher->GetOutput();
}

double GetFieldValue(vtkDataObject* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  EXPECT_NE(nullptr, array) << name;
  return array ? array->GetComponent(0, 0) : std::nan("");
}
} // namespace

TEST(DelaunayMeshCriteriaFilter, DeviceOfTheSuiteIsClean)
{
  const auto mesh = MakeTransistor();
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(criteria);
  criteria->SetInputData(mesh);
  criteria->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  ExpectProgress(recorder);
  EXPECT_TRUE(criteria->GetIsClean()) << criteria->GetCertificate();
  for (const char* name : { "FacetSphereViolations", "EdgeSphereViolations", "OpenControlVolumes" })
  {
    EXPECT_EQ(0.0, GetFieldValue(criteria->GetOutput(), name)) << name;
  }

  vtkUnstructuredGrid* output = criteria->GetOutput();
  ASSERT_EQ(mesh->GetNumberOfCells(), output->GetNumberOfCells());
  EXPECT_EQ(1.0, GetFieldValue(output, "IsClean"));
  const std::vector<std::string> text = GetTexts(output, "Certificate");
  ASSERT_EQ(text.size(), 3u);
  EXPECT_EQ(criteria->GetCertificate(), text[0] + "\n" + text[1] + "\n" + text[2]);
  // The field data of the input are left alone: the mesher compared the boundary, too.
  EXPECT_EQ(GetTexts(mesh, "Certificate").at(0), "CLEAN FOR FINITE VOLUMES");
  EXPECT_EQ(nullptr, mesh->GetCellData()->GetArray("IsDelaunay"));
  EXPECT_EQ(5, output->GetFieldData()->GetArray("RegionVolumes")->GetNumberOfTuples());
  for (int region = 0; region < 5; ++region)
  {
    EXPECT_NEAR(GetVolume(output, region),
      output->GetFieldData()->GetArray("RegionVolumes")->GetComponent(region, 0), 1e-14);
  }
}

TEST(DelaunayMeshCriteriaFilter, QualitiesAgreeWithVtk)
{
  const auto mesh = MakeTransistor();
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputData(mesh);
  criteria->Update();
  vtkCellData* data = criteria->GetOutput()->GetCellData();
  vtkDataArray* aspect = FindArray(data, "AspectRatio", 1, VTK_DOUBLE);
  vtkDataArray* q[5];
  for (int i = 0; i < 5; ++i)
  {
    q[i] = FindArray(data, ("Q" + std::to_string(i + 1)).c_str(), 1, VTK_DOUBLE);
  }
  vtkDataArray* edgeRatio = FindArray(data, "RadiusEdgeRatio", 1, VTK_DOUBLE);
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    vtkCell* cell = mesh->GetCell(i);
    // VTK's radius ratio is R / (3 r), its edge ratio the longest over the shortest.
    EXPECT_NEAR(3.0 * vtkMeshQuality::TetRadiusRatio(cell) / aspect->GetComponent(i, 0), 1.0, 1e-8);
    EXPECT_NEAR(vtkMeshQuality::TetEdgeRatio(cell) * q[3]->GetComponent(i, 0), 1.0, 1e-12);
    EXPECT_NEAR(q[2]->GetComponent(i, 0) * aspect->GetComponent(i, 0), 1.0, 1e-12);
    EXPECT_NEAR(q[0]->GetComponent(i, 0) * edgeRatio->GetComponent(i, 0), 1.0, 1e-12);
    EXPECT_NEAR(q[1]->GetComponent(i, 0) / q[2]->GetComponent(i, 0),
      edgeRatio->GetComponent(i, 0) * q[3]->GetComponent(i, 0), 1e-9);
  }
}

TEST(DelaunayMeshCriteriaFilter, FaultsAreShownAndCounted)
{
  // Two flat-topped tetrahedra that want a flip, one inverted, one flat.
  const auto grid =
    MakeTetrahedra({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.3, 0.1 }, { 0.3, 0.3, -0.1 },
                     { 5, 0, 0 }, { 6, 0, 0 }, { 5, 1, 0 }, { 5, 0, 1 }, { 6, 1, 0 } },
      { { 0, 1, 2, 3 }, { 0, 2, 1, 4 }, { 5, 7, 6, 8 }, { 5, 6, 9, 7 } });
  vtkNew<vtkIntArray> regions;
  regions->SetName("RegionId");
  for (const int region : { 4, 4, 6, 6 })
  {
    regions->InsertNextValue(region);
  }
  grid->GetCellData()->AddArray(regions);
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputData(grid);
  criteria->Update();
  EXPECT_FALSE(criteria->GetIsClean());
  EXPECT_EQ(
    criteria->GetCertificate().find("INVALID\n1 inverted tetrahedron, 1 flat tetrahedron"), 0u)
    << criteria->GetCertificate();
  EXPECT_TRUE(
    Contains(criteria->GetCertificate(), "2 tetrahedra have a point in their circumsphere"));
  vtkUnstructuredGrid* faults = vtkUnstructuredGrid::SafeDownCast(criteria->GetOutputDataObject(1));
  vtkDataArray* kinds = FindArray(faults->GetCellData(), "Fault", 1, VTK_INT);
  vtkDataArray* faultRegions = FindArray(faults->GetCellData(), "RegionId", 1, VTK_INT);
  vtkDataArray* cellIds = FindArray(faults->GetCellData(), "CellId", 1, VTK_ID_TYPE);
  ASSERT_NE(nullptr, kinds);
  std::array<int, 10> counts{};
  for (vtkIdType i = 0; i < faults->GetNumberOfCells(); ++i)
  {
    const int kind = static_cast<int>(kinds->GetComponent(i, 0));
    ++counts[kind];
    if (kind == vtkDelaunayMeshCriteria::INVERTED_TETRAHEDRON)
    {
      EXPECT_EQ(2, cellIds->GetComponent(i, 0));
      EXPECT_EQ(6, faultRegions->GetComponent(i, 0));
      EXPECT_EQ(VTK_TETRA, faults->GetCellType(i));
    }
    if (kind == vtkDelaunayMeshCriteria::FLAT_TETRAHEDRON)
    {
      EXPECT_EQ(3, cellIds->GetComponent(i, 0));
    }
    if (kind == vtkDelaunayMeshCriteria::NON_DELAUNAY_FACET)
    {
      EXPECT_EQ(VTK_TRIANGLE, faults->GetCellType(i));
      double bounds[6];
      faults->GetCell(i)->GetBounds(bounds);
      EXPECT_EQ(0.0, bounds[5]) << "the facet between the two";
    }
    if (kind == vtkDelaunayMeshCriteria::NEGATIVE_COUPLING)
    {
      EXPECT_EQ(VTK_LINE, faults->GetCellType(i));
    }
  }
  const char* names[] = { "InvertedTetrahedra", "FlatTetrahedra", "OverfullFacets",
    "NonDelaunayTetrahedra", "NonDelaunayFacets", "FacetSphereViolations", "EdgeSphereViolations",
    "OpenControlVolumes", "NegativeCouplings", "NegativeCotangentSums" };
  for (int i = 0; i < 10; ++i)
  {
    EXPECT_EQ(counts[i], GetFieldValue(criteria->GetOutput(), names[i])) << names[i];
  }
  EXPECT_EQ(1, counts[vtkDelaunayMeshCriteria::INVERTED_TETRAHEDRON]);
  EXPECT_EQ(1, counts[vtkDelaunayMeshCriteria::FLAT_TETRAHEDRON]);
  EXPECT_EQ(1, counts[vtkDelaunayMeshCriteria::NON_DELAUNAY_FACET]);
  EXPECT_EQ(3, counts[vtkDelaunayMeshCriteria::NEGATIVE_COUPLING]);
  vtkDataArray* isDelaunay =
    FindArray(criteria->GetOutput()->GetCellData(), "IsDelaunay", 1, VTK_UNSIGNED_CHAR);
  EXPECT_EQ(0, isDelaunay->GetComponent(0, 0));
  EXPECT_EQ(1, isDelaunay->GetComponent(2, 0));
}

TEST(DelaunayMeshCriteriaFilter, CellsOfLowerDimensionArePassedOver)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points; // single precision, as files have it
  for (const Point& point :
    std::vector<Point>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } })
  {
    points->InsertNextPoint(point.data());
  }
  grid->SetPoints(points);
  const vtkIdType ids[4] = { 0, 1, 2, 3 };
  grid->AllocateEstimate(4, 4);
  grid->InsertNextCell(VTK_VERTEX, 1, ids);
  grid->InsertNextCell(VTK_LINE, 2, ids);
  grid->InsertNextCell(VTK_TRIANGLE, 3, ids);
  grid->InsertNextCell(VTK_TETRA, 4, ids);
  vtkNew<vtkIntArray> tags;
  tags->SetName("Tag");
  for (int i = 0; i < 4; ++i)
  {
    tags->InsertNextValue(10 + i);
  }
  grid->GetCellData()->AddArray(tags);
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputData(grid);
  criteria->Update();
  ASSERT_EQ(1, criteria->GetOutput()->GetNumberOfCells());
  EXPECT_EQ(13, criteria->GetOutput()->GetCellData()->GetArray("Tag")->GetComponent(0, 0));
  EXPECT_EQ(0.0, GetFieldValue(criteria->GetOutput(), "NonDelaunayTetrahedra"));
  // The corner of a cube: its circumcenter lies beyond the oblique facet.
  EXPECT_EQ(1.0, GetFieldValue(criteria->GetOutput(), "OpenControlVolumes"));
}

TEST(DelaunayMeshCriteriaFilter, VolumesAreComparedWithTheBoundary)
{
  const auto boxes = MakeTwoBoxes(true);
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(boxes);
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputConnection(mesher->GetOutputPort());
  criteria->SetInputData(1, boxes);
  criteria->Update();
  EXPECT_TRUE(criteria->GetIsClean()) << criteria->GetCertificate();

  // The same tetrahedra against a larger box on the right: volume 3 instead of 2.
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 }, -1, 3);
  builder.AddBox({ 1, 0, 0 }, { 4, 1, 1 }, -1, 7);
  criteria->SetInputData(1, builder.Build(true));
  criteria->Update();
  EXPECT_FALSE(criteria->GetIsClean()) << criteria->GetCertificate();
  vtkDataArray* errors = criteria->GetOutput()->GetFieldData()->GetArray("RegionVolumeErrors");
  ASSERT_EQ(2, errors->GetNumberOfTuples());
  EXPECT_NEAR(0.0, errors->GetComponent(0, 0), 1e-15);
  EXPECT_NEAR(1.0 / 3.0, errors->GetComponent(1, 0), 1e-15);

  criteria->SetInputData(1, builder.Build(false));
  ExpectFailure(criteria, { "BoundaryLabels" });
}

TEST(DelaunayMeshCriteriaFilter, BadInputIsRefused)
{
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  vtkNew<vtkUnstructuredGrid> empty;
  criteria->SetInputData(empty);
  ExpectFailure(criteria, { "empty" });

  auto grid = MakeTetrahedra(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, std::nan("") } }, { { 0, 1, 2, 3 } });
  criteria->SetInputData(grid);
  ExpectFailure(criteria, { "not finite", "Points: 3" });

  grid =
    MakeTetrahedra({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } },
      { { 0, 1, 2, 3 } });
  const vtkIdType wedge[6] = { 0, 1, 2, 3, 4, 5 };
  grid->InsertNextCell(VTK_WEDGE, 6, wedge);
  criteria->SetInputData(grid);
  ExpectFailure(criteria, { "not linear tetrahedra", "Cells: 1" });

  vtkNew<vtkUnstructuredGrid> triangle;
  triangle->SetPoints(grid->GetPoints());
  triangle->AllocateEstimate(1, 3);
  triangle->InsertNextCell(VTK_TRIANGLE, 3, wedge);
  criteria->SetInputData(triangle);
  ExpectFailure(criteria, { "no tetrahedra" });
}

TEST(DelaunayMeshCriteriaFilter, AbortLeavesNothing)
{
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(criteria);
  recorder->AbortAt = 0.1;
  criteria->SetInputData(MakeTransistor());
  criteria->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(criteria);
}
