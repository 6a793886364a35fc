// SPDX-License-Identifier: BSD-3-Clause
/**
 * The NMOS transistor of the thesis (section 7.4, Figures 7.21 to 7.23): a gate oxide of 5 nm over
 * a channel of 0.18 um x 0.18 um between field oxides, all under 30 nm of oxide. Its mesh there has
 * 134374 tetrahedra. With layers of points in the gate oxide and below it ours has to be smaller,
 * with a clean certificate, and fine in the channel.
 */
#include "FilterTesting.h"

#include <vtkAdvancingFrontTetrahedralizer.h>
#include <vtkBoundaryTriangulator.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkImageData.h>
#include <vtkMeshPointGenerator.h>
#include <vtkSliverRemover.h>
#include <vtkTechnologyStructureSource.h>

#include <algorithm>
#include <cmath>
#include <iostream>

using namespace testing_filters;

namespace
{
constexpr vtkIdType ThesisTetrahedra = 134374;
constexpr double Width = 0.6;
constexpr double Channel = 0.18;
constexpr double OxideThickness = 0.005;
/** Edges at the channel, and by how much they grow per unit of length away from it. */
constexpr double FinestEdge = 0.02;
constexpr double Gradation = 0.3;

/** The sizing: finest in the channel, the square in the middle of the silicon's surface. */
vtkSmartPointer<vtkImageData> MakeSizing(vtkPolyData* device)
{
  constexpr int side = 41;
  auto image = vtkSmartPointer<vtkImageData>::New();
  double bounds[6];
  device->GetBounds(bounds);
  image->SetDimensions(side, side, side);
  image->SetOrigin(bounds[0], bounds[2], bounds[4]);
  image->SetSpacing((bounds[1] - bounds[0]) / (side - 1), (bounds[3] - bounds[2]) / (side - 1),
    (bounds[5] - bounds[4]) / (side - 1));
  vtkNew<vtkDoubleArray> sizing;
  sizing->SetName("Sizing");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double x[3];
    image->GetPoint(i, x);
    const double dx = std::max(0.0, std::abs(x[0]) - 0.5 * Channel);
    const double dy = std::max(0.0, std::abs(x[1] - 0.5 * Width) - 0.5 * Channel);
    sizing->InsertNextValue(std::min(0.1, FinestEdge + Gradation * std::hypot(dx, dy, x[2])));
  }
  image->GetPointData()->AddArray(sizing);
  return image;
}

vtkIdType GetCount(vtkDataSet* certified, const char* name)
{
  vtkDataArray* array = certified->GetFieldData()->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  return array ? static_cast<vtkIdType>(array->GetComponent(0, 0)) : -1;
}
} // namespace

TEST(NmosTransistor, ThinOxideIsMeshedInLayers)
{
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToNmosWithFieldOxide();
  device->SetDeviceWidth(Width);
  device->SetChannelWidth(Channel);
  device->SetGateLength(Channel);
  device->SetGateOxideThickness(OxideThickness);
  device->SetCoverOxideThickness(0.03);
  device->Update();
  auto sizing = MakeSizing(device->GetOutput());
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputConnection(device->GetOutputPort());
  vtkNew<vtkMeshPointGenerator> generator;
  generator->SetInputConnection(triangulator->GetOutputPort());
  generator->SetInputData(1, sizing);
  constexpr int bulk = 0;
  constexpr int gateOxide = 3;
  generator->AddLayers(gateOxide, bulk, 3, OxideThickness / 4.0, 1.0);
  generator->AddLayers(bulk, gateOxide, 8, 0.0004, 1.6);
  vtkNew<vtkDelaunaySurfaceRefiner> refiner;
  refiner->SetInputConnection(triangulator->GetOutputPort());
  refiner->SetInputConnection(1, generator->GetOutputPort());
  refiner->SetInputData(2, sizing);
  refiner->SetMeshPointClearanceRatio(0.0);
  refiner->SetCriterionToSmallestSphereAndEdges();
  vtkNew<vtkAdvancingFrontTetrahedralizer> tetrahedralizer;
  tetrahedralizer->SetInputConnection(refiner->GetOutputPort());
  tetrahedralizer->SetInputConnection(1, refiner->GetOutputPort(2));
  vtkNew<vtkSliverRemover> remover;
  remover->SetInputConnection(tetrahedralizer->GetOutputPort());
  remover->SetFlatnessRatio(0.0);
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputConnection(0, remover->GetOutputPort());
  criteria->SetInputConnection(1, device->GetOutputPort());
  criteria->Update();
  std::cout << criteria->GetCertificate() << "\n";

  EXPECT_EQ(refiner->GetNumberOfUnresolvedTriangles(), 0);
  EXPECT_EQ(generator->GetNumberOfDroppedLayerPoints(), 0);
  EXPECT_EQ(refiner->GetNumberOfDroppedMeshPoints(), 0);
  vtkUnstructuredGrid* mesh = criteria->GetOutput();
  EXPECT_GT(mesh->GetNumberOfCells(), 0);
  EXPECT_LT(mesh->GetNumberOfCells(), ThesisTetrahedra);
  EXPECT_EQ(criteria->GetCertificate().find("CLEAN FOR FINITE VOLUMES"), 0u);
  for (const char* name :
    { "InvertedTetrahedra", "FlatTetrahedra", "NonDelaunayTetrahedra", "FacetSphereViolations",
      "EdgeSphereViolations", "NegativeCouplings", "OpenControlVolumes" })
  {
    EXPECT_EQ(GetCount(mesh, name), 0) << name;
  }
  EXPECT_NEAR(
    GetVolume(mesh, gateOxide), Channel * Channel * OxideThickness, 1e-12 * OxideThickness);

  // The gate oxide is there to be resolved: points on each of its three layers, and edges as fine
  // as the sizing asks for on the silicon below.
  std::array<vtkIdType, 3> layers{};
  vtkIdType inChannel = 0;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double x[3];
    mesh->GetPoint(i, x);
    for (int layer = 0; layer < 3; ++layer)
    {
      layers[layer] += std::abs(x[2] - (layer + 1) * OxideThickness / 4.0) < 1e-12;
    }
    inChannel += x[2] == 0.0 && std::abs(x[0]) <= 0.5 * Channel &&
      std::abs(x[1] - 0.5 * Width) <= 0.5 * Channel;
  }
  EXPECT_EQ(layers[0], layers[1]);
  EXPECT_EQ(layers[1], layers[2]);
  const double edgesAcross = Channel / FinestEdge;
  EXPECT_GT(inChannel, edgesAcross * edgesAcross);
}
