// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkImageData.h>
#include <vtkMaterialInterfaceExtractor.h>
#include <vtkMatrix3x3.h>
#include <vtkRectilinearGrid.h>

#include <functional>
#include <iostream>
#include <map>
#include <random>

using namespace testing_filters;

namespace
{
using Volumes = std::map<int, double>;

/** An image of unit voxels. */
vtkSmartPointer<vtkImageData> MakeImage(
  int nx, int ny, int nz, const std::function<int(int, int, int)>& getLabel)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(nx + 1, ny + 1, nz + 1);
  vtkNew<vtkIntArray> labels;
  labels->SetName("Material");
  for (int k = 0; k < nz; ++k)
  {
    for (int j = 0; j < ny; ++j)
    {
      for (int i = 0; i < nx; ++i)
      {
        labels->InsertNextValue(getLabel(i, j, k));
      }
    }
  }
  image->GetCellData()->SetScalars(labels);
  return image;
}

/** A ball of label 2 in a box of label 1, of 9 x 8 x 7 voxels. */
vtkSmartPointer<vtkImageData> MakeBall()
{
  return MakeImage(9, 8, 7,
    [](int i, int j, int k)
    { return (i - 4) * (i - 4) + (j - 4) * (j - 4) + (k - 3) * (k - 3) < 8 ? 2 : 1; });
}

Volumes CountVoxels(vtkImageData* image, int background = -1)
{
  Volumes counts;
  vtkDataArray* labels = image->GetCellData()->GetScalars();
  for (vtkIdType i = 0; i < labels->GetNumberOfTuples(); ++i)
  {
    counts[static_cast<int>(labels->GetComponent(i, 0))] += 1.0;
  }
  counts.erase(-1);
  counts.erase(background);
  return counts;
}

/** The volumes that the labelled sides enclose. */
Volumes GetEnclosedVolumes(vtkPolyData* surface)
{
  Volumes volumes;
  vtkDataArray* labels = FindArray(surface->GetCellData(), "BoundaryLabels", 2, VTK_INT);
  for (vtkIdType cell = 0; labels && cell < surface->GetNumberOfCells(); ++cell)
  {
    double x[3][3];
    vtkIdList* ids = surface->GetCell(cell)->GetPointIds();
    EXPECT_EQ(ids->GetNumberOfIds(), 3);
    for (int i = 0; i < 3; ++i)
    {
      surface->GetPoint(ids->GetId(i), x[i]);
    }
    double origin[3] = { 0.0, 0.0, 0.0 };
    const double volume = vtkTetra::ComputeVolume(origin, x[0], x[1], x[2]);
    volumes[static_cast<int>(labels->GetComponent(cell, 1))] += volume;
    volumes[static_cast<int>(labels->GetComponent(cell, 0))] -= volume;
  }
  volumes.erase(-1);
  return volumes;
}

void ExpectNear(const Volumes& volumes, const Volumes& expected, double tolerance = 1e-12)
{
  ASSERT_EQ(volumes.size(), expected.size());
  for (const auto& [label, volume] : expected)
  {
    ASSERT_EQ(volumes.count(label), 1u) << "label " << label;
    EXPECT_NEAR(volumes.at(label), volume, tolerance * volume) << "label " << label;
  }
}

/** All of the mesher on the interfaces: a valid mesh whose regions have these volumes. */
void ExpectMesh(vtkMaterialInterfaceExtractor* extractor, const Volumes& expected)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  vtkNew<EventRecorder> recorder;
  recorder->Watch(mesher);
  mesher->SetInputConnection(extractor->GetOutputPort());
  mesher->Update();
  // A mesh that its own check finds at fault comes with a warning.
  EXPECT_EQ(recorder->GetFaults(), "");
  auto mesh = vtkUnstructuredGrid::SafeDownCast(mesher->GetOutputDataObject(0));
  Volumes volumes;
  vtkDataArray* regions = FindArray(mesh->GetCellData(), "RegionId", 1, VTK_INT);
  ASSERT_NE(regions, nullptr);
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    double x[4][3];
    vtkIdList* ids = mesh->GetCell(cell)->GetPointIds();
    for (int i = 0; i < 4; ++i)
    {
      mesh->GetPoint(ids->GetId(i), x[i]);
    }
    const double volume = vtkTetra::ComputeVolume(x[0], x[1], x[2], x[3]);
    volumes[static_cast<int>(regions->GetComponent(cell, 0))] += volume;
  }
  ExpectNear(volumes, expected, 1e-11);
}
} // namespace

TEST(MaterialInterfaceExtractorFilter, HasTheVolumesOfTheVoxels)
{
  auto image = MakeBall();
  image->SetExtent(2, 11, -3, 5, 0, 7);
  image->SetOrigin(10.0, 20.0, 30.0);
  image->SetSpacing(0.5, 1.0, 2.0);
  vtkNew<vtkMaterialInterfaceExtractor> filter;
  filter->SetInputData(image);
  filter->SetSmoothingLength(0.0);
  filter->SetMaximumDeviation(0.0);
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  const double* bounds = output->GetBounds();
  const double expected[6] = { 11.0, 15.5, 17.0, 25.0, 30.0, 44.0 };
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(bounds[i], expected[i]);
  }
  // A voxel has the volume 1 here as well.
  ExpectNear(GetEnclosedVolumes(output), CountVoxels(image));
  EXPECT_EQ(filter->GetLargestDeviation(), 0.0);
  const vtkIdType faces = filter->GetNumberOfFaces();
  EXPECT_GT(filter->GetNumberOfRemovedPoints(), 0);
  EXPECT_LT(output->GetNumberOfCells(), 2 * faces);
  filter->ReduceSurfaceOff();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfFaces(), faces);
  EXPECT_EQ(filter->GetNumberOfRemovedPoints(), 0);
  EXPECT_EQ(output->GetNumberOfCells(), 2 * faces);
  // Six sides, and the ball's squares: as many as there are voxels under it along each axis.
  EXPECT_NEAR(GetArea(output, -1, 1), 2.0 * (4.5 * 8.0 + 4.5 * 14.0 + 8.0 * 14.0), 1e-9);
}

TEST(MaterialInterfaceExtractorFilter, RandomImagesAreMeshedToTheVoxel)
{
  const auto seed = std::random_device{}();
  std::cout << "seed " << seed << "\n";
  RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 generator(seed);
  const auto pick = [&](int low, int high)
  { return std::uniform_int_distribution<int>(low, high)(generator); };
  for (int round = 0; round < 60 && !HasFailure(); ++round)
  {
    SCOPED_TRACE(round);
    const int labels = pick(2, 5);
    // Label 0 is outside in one half of the images.
    const int background = pick(-1, 0);
    const int nx = pick(2, 6);
    const int ny = pick(2, 6);
    const int nz = pick(2, 6);
    auto image = MakeImage(
      nx, ny, nz, [&](int i, int j, int k) { return i + j + k == 0 ? 1 : pick(0, labels - 1); });
    vtkNew<vtkMaterialInterfaceExtractor> filter;
    filter->SetInputData(image);
    filter->SetBackgroundLabel(background);
    filter->SetSmoothingLength(0.0);
    filter->SetMaximumDeviation(0.0);
    filter->SetReduceSurface(round % 2 == 0);
    ExpectMesh(filter, CountVoxels(image, background));
    // Smoothed and reduced: what the surface encloses, by the divergence theorem.
    filter->SetSmoothingLength(10.0);
    filter->SetMaximumDeviation(0.25 * pick(0, 2));
    filter->Update();
    ExpectMesh(filter, GetEnclosedVolumes(filter->GetOutput()));
  }
}

TEST(MaterialInterfaceExtractorFilter, TakesLabelsOfPointsAndGradedGrids)
{
  // The corners of 2 x 2 x 2 voxels around points 0, 1 and 3 along each axis: 1, 1.5 and 2 wide.
  vtkNew<vtkDoubleArray> ticks;
  for (const double tick : { 0.0, 1.0, 3.0 })
  {
    ticks->InsertNextValue(tick);
  }
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(3, 3, 3);
  grid->SetXCoordinates(ticks);
  grid->SetYCoordinates(ticks);
  grid->SetZCoordinates(ticks);
  vtkNew<vtkDoubleArray> labels;
  labels->SetName("Material");
  labels->SetNumberOfTuples(27);
  labels->FillValue(4.0);
  labels->SetValue(13, 7.0);
  grid->GetPointData()->SetScalars(labels);
  vtkNew<vtkMaterialInterfaceExtractor> filter;
  filter->SetInputData(grid);
  filter->SetSmoothingLength(0.0);
  filter->Update();
  const double whole = 4.5 * 4.5 * 4.5;
  const double middle = 1.5 * 1.5 * 1.5;
  ExpectNear(GetEnclosedVolumes(filter->GetOutput()), { { 4, whole - middle }, { 7, middle } });
  ExpectMesh(filter, { { 4, whole - middle }, { 7, middle } });

  // The same array on cells, which is not the active one.
  vtkNew<vtkIntArray> cells;
  cells->SetName("Cells");
  for (int i = 0; i < 8; ++i)
  {
    cells->InsertNextValue(i == 7 ? 1 : 0);
  }
  grid->GetCellData()->AddArray(cells);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Cells");
  filter->Update();
  ExpectNear(GetEnclosedVolumes(filter->GetOutput()), { { 0, 27.0 - 8.0 }, { 1, 8.0 } });
}

TEST(MaterialInterfaceExtractorFilter, TurnsWithTheImage)
{
  auto image = MakeBall();
  for (const double mirror : { 1.0, -1.0 })
  {
    const double matrix[9] = { 0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, mirror };
    image->SetDirectionMatrix(matrix);
    vtkNew<vtkMaterialInterfaceExtractor> filter;
    filter->SetInputData(image);
    filter->SetSmoothingLength(0.0);
    filter->SetMaximumDeviation(0.0);
    filter->Update();
    ExpectNear(GetEnclosedVolumes(filter->GetOutput()), CountVoxels(image));
    EXPECT_NEAR(filter->GetOutput()->GetBounds()[0], -0.8 * 8.0, 1e-12);
    EXPECT_NEAR(filter->GetOutput()->GetBounds()[mirror > 0.0 ? 5 : 4], 7.0 * mirror, 1e-12);
  }
}

TEST(MaterialInterfaceExtractorFilter, SaysWhatIsWrongWithTheInput)
{
  vtkNew<vtkMaterialInterfaceExtractor> filter;
  auto image = MakeBall();
  image->GetCellData()->GetScalars()->SetComponent(17, 0, -2.0);
  filter->SetInputData(image);
  ExpectFailure(filter, { "whole numbers", "Cells: 17" });

  vtkNew<vtkDoubleArray> half;
  half->SetNumberOfTuples(image->GetNumberOfPoints());
  half->FillValue(1.0);
  half->SetValue(5, 0.5);
  half->SetValue(6, std::numeric_limits<double>::quiet_NaN());
  half->SetValue(7, 3e9);
  image->GetPointData()->SetScalars(half);
  filter->Modified();
  ExpectFailure(filter, { "whole numbers", "Points: 5", "6", "7" });

  image = MakeBall();
  image->GetCellData()->SetScalars(nullptr);
  filter->SetInputData(image);
  ExpectFailure(filter, { "SetInputArrayToProcess" });

  filter->SetInputData(MakeImage(2, 2, 2, [](int, int, int) { return 6; }));
  filter->SetBackgroundLabel(6);
  ExpectFailure(filter, { "All cells are outside" });
  filter->SetBackgroundLabel(-1);

  vtkNew<vtkImageData> slice;
  slice->SetDimensions(3, 3, 1);
  vtkNew<vtkIntArray> labels;
  labels->SetNumberOfTuples(4);
  labels->FillValue(1);
  slice->GetCellData()->SetScalars(labels);
  filter->SetInputData(slice);
  ExpectFailure(filter, { "no cells along z", "volume" });

  vtkNew<vtkImageData> empty;
  filter->SetInputData(empty);
  ExpectFailure(filter, {});

  // And after all that it works.
  filter->SetInputData(MakeBall());
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST(MaterialInterfaceExtractorFilter, IsMadeWholeByTheFirstOfSeveralProcesses)
{
  vtkNew<vtkMaterialInterfaceExtractor> filter;
  filter->SetInputData(MakeBall());
  filter->Update();
  const vtkIdType cells = filter->GetOutput()->GetNumberOfCells();
  EXPECT_GT(cells, 0);
  filter->UpdatePiece(0, 2, 0);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), cells);
  filter->UpdatePiece(1, 2, 0);
  ExpectEmptyOutputs(filter);
}

TEST(MaterialInterfaceExtractorFilter, ReportsProgressAndAborts)
{
  vtkNew<vtkMaterialInterfaceExtractor> filter;
  filter->SetInputData(MakeImage(
    40, 40, 40, [](int i, int j, int k) { return (i * i + j * j + k * k) % 3000 < 1500 ? 0 : 1; }));
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectProgress(recorder);
  for (const double place : { 0.05, 0.2, 0.35, 0.6 })
  {
    SCOPED_TRACE(place);
    recorder->AbortAt = place;
    filter->Modified();
    filter->Update();
    ExpectEmptyOutputs(filter);
    filter->SetAbortExecute(0);
  }
  EXPECT_EQ(recorder->Errors, "");
}
