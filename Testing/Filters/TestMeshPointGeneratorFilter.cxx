// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkAdvancingFrontTetrahedralizer.h>
#include <vtkBoundaryTriangulator.h>
#include <vtkConformingDelaunayMesher.h>
#include <vtkDataSetTriangleFilter.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkMeshPointGenerator.h>
#include <vtkRectilinearGrid.h>
#include <vtkSMPTools.h>
#include <vtkSphereSource.h>
#include <vtkTechnologyStructureSource.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <set>
#include <tuple>

using namespace testing_filters;

namespace
{
using Field = std::function<std::vector<double>(const double x[3])>;

vtkSmartPointer<vtkDoubleArray> MakeSizing(vtkDataSet* data, const Field& field)
{
  auto sizing = vtkSmartPointer<vtkDoubleArray>::New();
  sizing->SetName("Sizing");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    const std::vector<double> tuple = field(data->GetPoint(i));
    sizing->SetNumberOfComponents(static_cast<int>(tuple.size()));
    sizing->InsertNextTuple(tuple.data());
  }
  data->GetPointData()->AddArray(sizing);
  return sizing;
}

vtkSmartPointer<vtkImageData> MakeImage(const Field& field, int points = 11)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(points, points, points);
  image->SetSpacing(1.0 / (points - 1), 1.0 / (points - 1), 1.0 / (points - 1));
  MakeSizing(image, field);
  return image;
}

/** A grid over the unit cube with planes ever closer to the middle. */
vtkSmartPointer<vtkRectilinearGrid> MakeGradedGrid(const Field& field, double first)
{
  vtkNew<vtkDoubleArray> ticks;
  std::vector<double> offsets{ 0.5 };
  while (offsets.back() > first)
  {
    offsets.push_back(0.75 * offsets.back());
  }
  for (const double offset : offsets)
  {
    ticks->InsertNextValue(0.5 - offset);
  }
  ticks->InsertNextValue(0.5);
  for (auto offset = offsets.rbegin(); offset != offsets.rend(); ++offset)
  {
    ticks->InsertNextValue(0.5 + *offset);
  }
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  const int count = static_cast<int>(ticks->GetNumberOfTuples());
  grid->SetDimensions(count, count, count);
  grid->SetXCoordinates(ticks);
  grid->SetYCoordinates(ticks);
  grid->SetZCoordinates(ticks);
  MakeSizing(grid, field);
  return grid;
}

struct Pipeline
{
  explicit Pipeline(vtkPolyData* surface)
  {
    this->Triangulator->SetInputData(surface);
    this->Generator->SetInputConnection(this->Triangulator->GetOutputPort());
    this->Recorder->Watch(this->Generator);
  }
  vtkPolyData* Run()
  {
    this->Generator->Update();
    EXPECT_EQ(this->Recorder->Errors, "");
    return this->Generator->GetOutput();
  }
  vtkNew<vtkBoundaryTriangulator> Triangulator;
  vtkNew<vtkMeshPointGenerator> Generator;
  vtkNew<EventRecorder> Recorder;
};

std::vector<Point> GetPositions(vtkPointSet* data)
{
  std::vector<Point> positions;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    Point x;
    data->GetPoint(i, x.data());
    positions.push_back(x);
  }
  return positions;
}

/** Lengths of the edges of a mesh divided by the sizing at their middles, in rising order. */
std::vector<double> GetEdgeRatios(vtkUnstructuredGrid* mesh, const Field& field)
{
  std::set<std::pair<vtkIdType, vtkIdType>> edges;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    vtkIdList* ids = mesh->GetCell(cell)->GetPointIds();
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < i; ++j)
      {
        edges.insert(std::minmax(ids->GetId(i), ids->GetId(j)));
      }
    }
  }
  std::vector<double> ratios;
  for (const auto& edge : edges)
  {
    double a[3];
    double b[3];
    mesh->GetPoint(edge.first, a);
    mesh->GetPoint(edge.second, b);
    const double middle[3] = { 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]) };
    ratios.push_back(std::sqrt(vtkMath::Distance2BetweenPoints(a, b)) / field(middle)[0]);
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}
} // namespace

TEST(MeshPointGeneratorFilter, MakesVerticesWithRegions)
{
  Pipeline run(MakeTwoBoxes(true));
  run.Generator->SetPlacementToOrthoProduct();
  run.Generator->SetTemplateToCorners();
  run.Generator->SetSpacing(0.25, 0.25, 0.25);
  vtkPolyData* output = run.Run();
  EXPECT_EQ(run.Recorder->Warnings, "");
  // 3 x 3 planes across y and z; across x 3 in the box of length 1, and 7 in that of length 2.
  EXPECT_EQ(output->GetNumberOfPoints(), 9 * (3 + 7));
  EXPECT_EQ(output->GetNumberOfVerts(), output->GetNumberOfPoints());
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  vtkDataArray* regions = FindArray(output->GetPointData(), "RegionId", 1, VTK_INT);
  vtkDataArray* layers = FindArray(output->GetPointData(), "Layer", 1, VTK_INT);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    EXPECT_EQ(regions->GetComponent(i, 0), output->GetPoint(i)[0] < 1.0 ? 3 : 7);
    EXPECT_EQ(layers->GetComponent(i, 0), 0);
  }
  // Its points are good for the mesher: it drops none.
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(MakeTwoBoxes(true));
  mesher->SetInputConnection(1, run.Generator->GetOutputPort());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(mesher);
  mesher->Update();
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_FALSE(Contains(recorder->Warnings, "Dropped")) << recorder->Warnings;
  EXPECT_NEAR(GetVolume(mesher->GetOutput()), 3.0, 1e-12);

  // The default spacing is a tenth of the longest side: planes at 0.25, 0.5, 0.75 across y and z,
  // at 0.3, 0.6, ... across x, where 0.9 is too close to the interface.
  run.Generator->SetSpacing(0.0, 0.0, 0.0);
  EXPECT_EQ(run.Run()->GetNumberOfPoints(), 9 * (2 + 6));
}

TEST(MeshPointGeneratorFilter, EdgesFollowASizingOfOneToThousand)
{
  // From the middle to the corners of the unit cube.
  const Field field = [](const double x[3])
  {
    const double middle[3] = { 0.5, 0.5, 0.5 };
    return std::vector<double>{ 0.00025 +
      0.3 * std::sqrt(vtkMath::Distance2BetweenPoints(x, middle)) };
  };
  const double corner[3] = { 0.0, 0.0, 0.0 };
  const double middle[3] = { 0.5, 0.5, 0.5 };
  EXPECT_GT(field(corner)[0] / field(middle)[0], 1000.0);
  auto grid = MakeGradedGrid(field, 0.00005);
  using Generator = vtkMeshPointGenerator;
  const std::array<int, 2> kinds[] = { { Generator::OCTREE, Generator::BODY_CENTERED },
    { Generator::OCTREE, Generator::CORNERS }, { Generator::RANDOM, Generator::BODY_CENTERED } };
  for (const auto& [placement, kind] : kinds)
  {
    Pipeline run(MakeCube());
    run.Generator->SetInputData(1, grid);
    run.Generator->SetPlacement(placement);
    run.Generator->SetTemplate(kind);
    run.Run();
    vtkNew<vtkConformingDelaunayMesher> mesher;
    mesher->SetMeshForToFewestPoints();
    mesher->SetInputData(MakeCube());
    mesher->SetInputConnection(1, run.Generator->GetOutputPort());
    mesher->SetInputData(2, grid);
    mesher->Update();
    const std::vector<double> ratios = GetEdgeRatios(mesher->GetOutput(), field);
    ASSERT_FALSE(ratios.empty());
    std::cout << "placement " << placement << ", template " << kind << ": "
              << mesher->GetOutput()->GetNumberOfPoints()
              << " points, edges to sizing: " << ratios.front() << " to " << ratios.back()
              << ", median " << ratios[ratios.size() / 2] << "\n";
    EXPECT_GE(ratios[ratios.size() / 2], 0.7);
    EXPECT_LE(ratios[ratios.size() / 2], 1.0);
    EXPECT_LE(ratios.back(), 1.5);
  }
}

TEST(MeshPointGeneratorFilter, ReadsSizingsOfAllKinds)
{
  const auto getPoints = [](vtkDataSet* sizing)
  {
    Pipeline run(MakeCube());
    run.Generator->SetInputData(1, sizing);
    return GetPositions(run.Run());
  };
  // Linear in space: all data sets interpolate it exactly, and all forms of it say the same.
  const auto length = [](const double x[3]) { return 0.1 + 0.1 * x[0]; };
  auto image = MakeImage([&](const double x[3]) { return std::vector<double>{ length(x) }; });
  const std::vector<Point> expected = getPoints(image);
  EXPECT_GT(expected.size(), 300u);
  EXPECT_EQ(
    getPoints(MakeImage([&](const double x[3]) { return std::vector<double>(3, length(x)); })),
    expected);
  EXPECT_EQ(getPoints(MakeImage(
              [&](const double x[3]) {
                return std::vector<double>{ length(x), length(x), length(x), 0.0, 0.0, 0.0 };
              })),
    expected);
  EXPECT_EQ(
    getPoints(MakeImage(
      [&](const double x[3]) {
        return std::vector<double>{ length(x), 0.0, 0.0, 0.0, length(x), 0.0, 0.0, 0.0, length(x) };
      })),
    expected);
  vtkNew<vtkDataSetTriangleFilter> tetrahedra;
  tetrahedra->SetInputData(image);
  tetrahedra->Update();
  EXPECT_EQ(getPoints(tetrahedra->GetOutput()), expected);

  // Outside of the data set the nearest value holds.
  auto part = MakeImage([&](const double x[3]) { return std::vector<double>{ length(x) }; });
  part->SetOrigin(0.0, 0.4, 0.4);
  part->SetSpacing(0.1, 0.01, 0.01);
  EXPECT_EQ(getPoints(part), expected);

  // One length for each axis: cells of 1/4 x 1/4 x 1/16.
  auto flat = MakeImage([](const double*) { return std::vector<double>{ 0.25, 0.25, 0.0625 }; }, 2);
  Pipeline run(MakeCube());
  run.Generator->SetInputData(1, flat);
  run.Generator->SetTemplateToCenters();
  // Leaves of an octree are nine tenths as large at most: 1/5 x 1/5 x 1/18.
  for (const auto& [placement, across, along] :
    { std::tuple(vtkMeshPointGenerator::ORTHO_PRODUCT, 4u, 16u),
      std::tuple(vtkMeshPointGenerator::OCTREE, 5u, 18u) })
  {
    run.Generator->SetPlacement(placement);
    std::array<std::set<double>, 3> planes;
    for (const Point& x : GetPositions(run.Run()))
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        planes[axis].insert(x[axis]);
      }
    }
    EXPECT_EQ(planes[0].size(), across);
    EXPECT_EQ(planes[1].size(), across);
    EXPECT_EQ(planes[2].size(), along);
  }
}

TEST(MeshPointGeneratorFilter, TheSameWithOneThreadAndTwo)
{
  // Cells found by the data set itself, by a locator, and only the nearest ones.
  auto image =
    MakeImage([](const double x[3]) { return std::vector<double>{ 0.03 + 0.1 * x[0] }; });
  vtkNew<vtkDataSetTriangleFilter> tetrahedra;
  tetrahedra->SetInputData(image);
  tetrahedra->Update();
  vtkNew<vtkPolyData> points;
  points->SetPoints(tetrahedra->GetOutput()->GetPoints());
  points->GetPointData()->ShallowCopy(image->GetPointData());
  for (vtkDataSet* sizing :
    std::initializer_list<vtkDataSet*>{ image, tetrahedra->GetOutput(), points })
  {
    std::vector<Point> expected;
    for (const int threads : { 1, 2 })
    {
      vtkSMPTools::SetBackend("STDThread");
      vtkSMPTools::Initialize(threads);
      Pipeline run(MakeCube());
      run.Generator->SetInputData(1, sizing);
      const std::vector<Point> found = GetPositions(run.Run());
      EXPECT_GT(found.size(), 1000u);
      expected = threads == 1 ? found : expected;
      EXPECT_EQ(found, expected);
    }
  }
  vtkSMPTools::SetBackend("Sequential");
}

TEST(MeshPointGeneratorFilter, MeshesATransistorWithLayers)
{
  // A gate oxide of 5 nm over a channel of 0.18 um: three layers in the oxide, eight from 0.4 nm on
  // in the silicon below; edges along the interface are up to 50 times as long as the gaps.
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToMosTransistor();
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputConnection(device->GetOutputPort());
  vtkNew<vtkMeshPointGenerator> generator;
  generator->SetInputConnection(triangulator->GetOutputPort());
  constexpr double spacing = 0.06;
  generator->SetSpacing(spacing, spacing, spacing);
  generator->AddLayers(1, 0, 3, 0.00125, 1.0);
  generator->AddLayers(0, 1, 8, 0.0004, 1.6);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(generator);
  generator->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  EXPECT_EQ(generator->GetNumberOfDroppedLayerPoints(), 0);
  vtkPolyData* points = generator->GetOutput();
  vtkDataArray* regions = points->GetPointData()->GetArray("RegionId");
  vtkDataArray* layers = points->GetPointData()->GetArray("Layer");
  vtkIdType counts[2] = { 0, 0 };
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    const double z = points->GetPoint(i)[2];
    const double layer = layers->GetComponent(i, 0);
    if (layer > 0)
    {
      const bool isOxide = regions->GetComponent(i, 0) == 1;
      EXPECT_NEAR(
        z, isOxide ? 0.00125 * layer : -0.0004 * (std::pow(1.6, layer) - 1.0) / 0.6, 1e-15);
      ++counts[isOxide];
    }
  }
  EXPECT_GT(counts[1], 0);
  // Whole columns: in the silicon also below the gate's edges, in the oxide these are walls.
  EXPECT_EQ(counts[0] % 8, 0);
  EXPECT_EQ(counts[1] % 3, 0);
  EXPECT_GT(counts[0] / 8, counts[1] / 3);

  vtkNew<vtkDelaunaySurfaceRefiner> refiner;
  refiner->SetInputConnection(triangulator->GetOutputPort());
  refiner->SetInputConnection(1, generator->GetOutputPort());
  refiner->SetMaximumEdgeLength(spacing);
  // The first layer is nearer to the interface than the default clearance.
  refiner->SetMeshPointClearanceRatio(0.0);
  vtkNew<EventRecorder> refinerRecorder;
  refinerRecorder->Watch(refiner);
  vtkNew<vtkAdvancingFrontTetrahedralizer> tetrahedralizer;
  tetrahedralizer->SetInputConnection(refiner->GetOutputPort());
  tetrahedralizer->SetInputConnection(1, refiner->GetOutputPort(2));
  tetrahedralizer->Update();
  EXPECT_EQ(refinerRecorder->Errors + refinerRecorder->Warnings, "");
  vtkUnstructuredGrid* mesh = tetrahedralizer->GetOutput();
  EXPECT_EQ(refiner->GetNumberOfDroppedMeshPoints(), 0);
  const vtkIdType surfacePoints = refiner->GetOutput()->GetNumberOfPoints();
  EXPECT_EQ(mesh->GetNumberOfPoints(), surfacePoints + points->GetNumberOfPoints());
  EXPECT_NEAR(GetVolume(mesh, 0), 0.8 * 0.3 * 0.5, 1e-12);
  EXPECT_NEAR(GetVolume(mesh, 1), 0.34 * 0.3 * 0.005, 1e-12);

  // The layers cost the surface next to nothing.
  refiner->RemoveAllInputConnections(1);
  refiner->Update();
  std::cout << points->GetNumberOfPoints() << " mesh points, " << counts[0] + counts[1]
            << " of them in layers; " << mesh->GetNumberOfCells() << " tetrahedra of "
            << mesh->GetNumberOfPoints() << " points; surface " << surfacePoints
            << " points, without layers " << refiner->GetOutput()->GetNumberOfPoints() << "\n";
  EXPECT_LT(surfacePoints, 1.1 * refiner->GetOutput()->GetNumberOfPoints());
}

TEST(MeshPointGeneratorFilter, RefusesBadInput)
{
  vtkNew<vtkMeshPointGenerator> filter;
  vtkNew<vtkPolyData> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "empty" });
  filter->SetInputData(MakeCube());
  ExpectFailure(filter, { "vtkBoundaryTriangulator" });

  Pipeline open(MakeSquare());
  ExpectFailure(open.Generator, { "encloses nothing" });

  Pipeline run(MakeTwoBoxes(true));
  run.Generator->AddLayers(3, 7, 2.5, 0.01, 1.0);
  ExpectFailure(run.Generator, { "Layers 0", "not right" });
  run.Generator->RemoveAllLayers();
  run.Generator->AddLayers(3, 8, 2, 0.01, 1.0);
  ExpectFailure(run.Generator, { "region 3", "region 8", "no interface" });
  run.Generator->RemoveAllLayersById();
  run.Generator->AddLayers("Gas", "7", 2, 0.01, 1.0);
  ExpectFailure(run.Generator, { "Layers 0", "no region 'Gas'" });
  run.Generator->RemoveAllLayersByName();
  run.Generator->AddYTick(std::numeric_limits<double>::infinity());
  ExpectFailure(run.Generator, { "tick of the y axis" });
  run.Generator->RemoveAllYTicks();
  run.Generator->SetSpacing(0.1, -1.0, 0.1);
  ExpectFailure(run.Generator, { "Spacing" });
  run.Generator->SetSpacing(0.001, 0.001, 0.001);
  run.Generator->SetMaximumNumberOfPoints(100000);
  ExpectFailure(run.Generator, { "more than 100000 points" });
  run.Generator->SetSpacing(0.0, 0.0, 0.0);

  auto cloud = MakePoints({ { 0.5, 0.5, 0.5 }, { 0.6, 0.5, 0.5 } });
  run.Generator->SetInputData(1, cloud);
  ExpectFailure(run.Generator, { "point array Sizing" });
  for (const std::vector<double>& wrong : std::vector<std::vector<double>>{ { -1.0 },
         { 1.0, std::numeric_limits<double>::quiet_NaN(), 1.0 },
         // Not positive definite: 1 and 3, and 2 beside the diagonal.
         { 1.0, 3.0, 1.0, 2.0, 0.0, 0.0 }, { 1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 } })
  {
    MakeSizing(cloud, [&wrong](const double*) { return wrong; });
    cloud->Modified();
    ExpectFailure(run.Generator, { "positive", "point 0" });
  }
  MakeSizing(cloud, [](const double*) { return std::vector<double>{ 0.2 }; });
  Pipeline good(MakeTwoBoxes(true));
  good.Generator->SetInputData(1, cloud);
  EXPECT_GT(good.Run()->GetNumberOfPoints(), 0);
}

TEST(MeshPointGeneratorFilter, WarnsIfThereIsNoPlace)
{
  Pipeline run(MakeCube());
  run.Generator->SetSpacing(50.0, 50.0, 50.0);
  run.Generator->SetTemplateToCorners();
  EXPECT_EQ(run.Run()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(Contains(run.Recorder->Warnings, "No point has place"));

  Pipeline nothing(MakeCube());
  nothing.Generator->SetPlacementToNone();
  EXPECT_EQ(nothing.Run()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(Contains(nothing.Recorder->Warnings, "there are no layers"));

  // Only the row that has no points is named.
  Pipeline layers(MakeTwoBoxes(true));
  layers.Generator->SetPlacementToNone();
  layers.Generator->SetSpacing(0.2, 0.2, 0.2);
  layers.Generator->AddLayers(3, 7, 1, 0.05, 1.0);
  layers.Generator->AddLayers(7, 3, 1, 50.0, 1.0);
  EXPECT_GT(layers.Run()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(Contains(layers.Recorder->Warnings, "Layers 1, in region 7 off region 3, have no"));
  EXPECT_FALSE(Contains(layers.Recorder->Warnings, "Layers 0"));
}

TEST(MeshPointGeneratorFilter, ReportsProgressAndAborts)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(60);
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputConnection(sphere->GetOutputPort());
  vtkNew<vtkMeshPointGenerator> filter;
  filter->SetInputConnection(triangulator->GetOutputPort());
  filter->SetSpacing(0.05, 0.05, 0.05);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
  ExpectProgress(recorder);
  const std::vector<Point> points = GetPositions(filter->GetOutput());
  EXPECT_GT(points.size(), 1000u);
  for (const Point& x : points)
  {
    EXPECT_LT(vtkMath::Norm(x.data()), 0.5);
  }
  for (const double abortAt : { 0.3, 0.7 })
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
  EXPECT_EQ(GetPositions(filter->GetOutput()), points);
}
