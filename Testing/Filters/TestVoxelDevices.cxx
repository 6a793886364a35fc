// SPDX-License-Identifier: BSD-3-Clause
// Devices of boxes in rows of very different widths, as they are and turned: layers, gaps, and
// materials that meet at edges and corners only. No tetrahedron misses what was asked for.
#include "FilterTesting.h"
#include "MeshCertificate.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkMaterialInterfaceExtractor.h>
#include <vtkRectilinearGrid.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>
#include <string>
#include <vector>

using namespace testing_filters;

namespace
{
/** Coordinates of the boxes along each axis; their materials, x fastest, -1 outside. */
struct VoxelDevice
{
  std::array<std::vector<double>, 3> Ticks;
  std::vector<int> Materials;
};

vtkSmartPointer<vtkRectilinearGrid> MakeGrid(const VoxelDevice& device)
{
  const auto makeTicks = [](const std::vector<double>& ticks)
  {
    auto array = vtkSmartPointer<vtkDoubleArray>::New();
    for (const double tick : ticks)
    {
      array->InsertNextValue(tick);
    }
    return array;
  };
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetDimensions(static_cast<int>(device.Ticks[0].size()),
    static_cast<int>(device.Ticks[1].size()), static_cast<int>(device.Ticks[2].size()));
  grid->SetXCoordinates(makeTicks(device.Ticks[0]));
  grid->SetYCoordinates(makeTicks(device.Ticks[1]));
  grid->SetZCoordinates(makeTicks(device.Ticks[2]));
  vtkNew<vtkIntArray> materials;
  materials->SetName("Material");
  for (const int material : device.Materials)
  {
    materials->InsertNextValue(material);
  }
  grid->GetCellData()->SetScalars(materials);
  return grid;
}

/** Two to five ticks along each axis; boxes up to so many times as wide as others. */
VoxelDevice MakeRandomDevice(std::mt19937_64& generator, double largestRatio)
{
  VoxelDevice device;
  std::uniform_int_distribution<int> numberOfBoxes(1, 4);
  std::uniform_real_distribution<double> exponent(-std::log(largestRatio), 0.0);
  std::size_t count = 1;
  for (std::vector<double>& ticks : device.Ticks)
  {
    ticks.push_back(0.0);
    for (int i = numberOfBoxes(generator); i > 0; --i)
    {
      ticks.push_back(ticks.back() + std::exp(exponent(generator)));
    }
    count *= ticks.size() - 1;
  }
  std::discrete_distribution<int> material({ 15.0, 35.0, 30.0, 20.0 });
  while (device.Materials.size() < count)
  {
    device.Materials.push_back(material(generator) - 1);
  }
  // Not all outside.
  device.Materials.front() = std::max(device.Materials.front(), 0);
  return device;
}

/** Turned by an angle about (1, 2, 3), meshed with either criterion. */
void ExpectAllThatWasAskedFor(const VoxelDevice& device, double angle)
{
  vtkNew<vtkMaterialInterfaceExtractor> interfaces;
  interfaces->SetInputData(MakeGrid(device));
  interfaces->SetSmoothingLength(0.0);
  interfaces->SetMaximumDeviation(0.0);
  vtkNew<vtkTransform> rotation;
  rotation->RotateWXYZ(angle, 1.0, 2.0, 3.0);
  vtkNew<vtkTransformPolyDataFilter> turned;
  turned->SetInputConnection(interfaces->GetOutputPort());
  turned->SetTransform(rotation);
  turned->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  for (const int criterion : { vtkConformingDelaunayMesher::SmallestSphere,
         vtkConformingDelaunayMesher::SmallestSphereAndEdges })
  {
    vtkNew<vtkConformingDelaunayMesher> mesher;
    mesher->SetMeshForToFewestPoints();
    mesher->SetInputConnection(turned->GetOutputPort());
    mesher->SetCriterion(criterion);
    mesher->AddSteinerPointsOn();
    mesher->SetDihedralAngleTarget(SliverAngle);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(mesher);
    vtkNew<vtkDelaunayMeshCriteria> criteria;
    criteria->SetInputConnection(0, mesher->GetOutputPort(0));
    criteria->SetInputConnection(1, mesher->GetOutputPort(1));
    criteria->Update();
    ASSERT_GT(mesher->GetOutput()->GetNumberOfCells(), 0);
    EXPECT_EQ(recorder->GetFaults(), "");
    ExpectClean(criteria, criterion);
    EXPECT_EQ(CountSlivers(criteria), 0);
    EXPECT_EQ(CountMissed(mesher->GetOutput()), 0);
    std::cout << "turned by " << angle << ", criterion " << criterion << ": "
              << mesher->GetOutput()->GetNumberOfCells() << " tetrahedra\n";
  }
}
} // namespace

/**
 * Points in the middle of the layers get partners on the sheets above and below. Where these are
 * close to each other, the sheets have to become finer than far away edges would tell.
 */
TEST(VoxelDevices, SheetsCloseToEachOther)
{
  const VoxelDevice device{ { { { 0.0, 0.016, 0.03, 0.06, 0.4 }, { 0.0, 0.75 }, { 0.0, 0.3 } } },
    { 0, -1, 2, 0 } };
  for (const double angle : { 0.0, 20.0, 33.0 })
  {
    ExpectAllThatWasAskedFor(device, angle);
  }
}

TEST(VoxelDevices, RandomOnes)
{
  for (unsigned int seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const VoxelDevice device = MakeRandomDevice(generator, seed % 3 == 0 ? 300.0 : 50.0);
    ExpectAllThatWasAskedFor(device, seed % 2 == 0 ? 0.0 : 7.0 * seed);
  }
}
