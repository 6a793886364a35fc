// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkBoundaryTriangulator.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkPolygon.h>
#include <vtkSphereSource.h>

#include <map>
#include <set>

using namespace testing_filters;

namespace
{
/** A surface through the boundary triangulator and the refiner. */
struct Pipeline
{
  explicit Pipeline(vtkPolyData* surface)
  {
    this->Triangulator->SetInputData(surface);
    this->Refiner->SetInputConnection(this->Triangulator->GetOutputPort());
    this->Recorder->Watch(this->Refiner);
  }
  vtkPolyData* GetOutput(int port) const
  {
    return vtkPolyData::SafeDownCast(this->Refiner->GetOutputDataObject(port));
  }
  vtkNew<vtkBoundaryTriangulator> Triangulator;
  vtkNew<vtkDelaunaySurfaceRefiner> Refiner;
  vtkNew<EventRecorder> Recorder;
};

double GetLongestEdge(vtkPolyData* surface)
{
  double longest = 0.0;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    vtkIdList* ids = surface->GetCell(cell)->GetPointIds();
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      double a[3];
      double b[3];
      surface->GetPoint(ids->GetId(i), a);
      surface->GetPoint(ids->GetId((i + 1) % ids->GetNumberOfIds()), b);
      longest = std::max(longest, std::sqrt(vtkMath::Distance2BetweenPoints(a, b)));
    }
  }
  return longest;
}

/** Every triangle of the unit cube lies on the side that its PolygonId names. */
void ExpectSourcesOnCube(vtkPolyData* surface)
{
  vtkDataArray* ids = FindArray(surface->GetCellData(), "PolygonId", 1, VTK_INT);
  ASSERT_NE(ids, nullptr);
  // The sides of SurfaceBuilder::AddBox(): z low, z high, y low, y high, x low, x high.
  static const int axes[6] = { 2, 2, 1, 1, 0, 0 };
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    const int side = static_cast<int>(ids->GetComponent(cell, 0));
    double bounds[6];
    surface->GetCellBounds(cell, bounds);
    EXPECT_EQ(bounds[2 * axes[side]], side % 2);
    EXPECT_EQ(bounds[2 * axes[side] + 1], side % 2);
  }
}
} // namespace

TEST(DelaunaySurfaceRefinerFilter, LeavesADelaunaySurfaceAsItIs)
{
  Pipeline run(MakeCube(true));
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors + run.Recorder->Warnings, "");
  EXPECT_EQ(run.GetOutput(0)->GetNumberOfPoints(), 8);
  EXPECT_EQ(run.GetOutput(0)->GetNumberOfPolys(), 12);
  EXPECT_FALSE(run.GetOutput(0)->GetCellData()->HasArray("Unresolved"));
  FindArray(run.GetOutput(0)->GetCellData(), "BoundaryLabels", 2, VTK_INT);
  EXPECT_NEAR(GetArea(run.GetOutput(0), -1, 0), 6.0, 1e-14);
  EXPECT_EQ(run.GetOutput(1)->GetNumberOfLines(), 12);
  EXPECT_EQ(run.GetOutput(2)->GetNumberOfPoints(), 0);
}

TEST(DelaunaySurfaceRefinerFilter, RefinesToAnEdgeLength)
{
  Pipeline run(MakeCube(true));
  run.Refiner->SetMaximumEdgeLength(0.3);
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors + run.Recorder->Warnings, "");
  vtkPolyData* output = run.GetOutput(0);
  EXPECT_LE(GetLongestEdge(output), 0.3);
  EXPECT_EQ(output->GetNumberOfPoints(),
    8 + run.Refiner->GetNumberOfEdgePoints() + run.Refiner->GetNumberOfFacetPoints());
  EXPECT_NEAR(GetArea(output, -1, 0), 6.0, 1e-12);
  ExpectLinear(output);
  ExpectSourcesOnCube(output);
  // Input points come first and stay where they are.
  for (vtkIdType i = 0; i < 8; ++i)
  {
    EXPECT_EQ(vtkMath::Distance2BetweenPoints(
                output->GetPoint(i), run.Triangulator->GetOutput()->GetPoint(i)),
      0.0);
  }
  // The pieces of the twelve edges, with the chains of the edges.
  vtkPolyData* edges = run.GetOutput(1);
  EXPECT_EQ(edges->GetNumberOfLines(), 12 + run.Refiner->GetNumberOfEdgePoints());
  vtkDataArray* chains = FindArray(edges->GetCellData(), "ChainId", 1, VTK_INT);
  std::set<double> ids;
  for (vtkIdType i = 0; i < edges->GetNumberOfLines(); ++i)
  {
    ids.insert(chains->GetComponent(i, 0));
  }
  EXPECT_EQ(ids.size(), 12u);
  ExpectLinear(edges);
}

TEST(DelaunaySurfaceRefinerFilter, MarksNewPointsAsFree)
{
  Pipeline run(MakeCube(true));
  run.Refiner->SetMaximumEdgeLength(0.3);
  run.Refiner->Update();
  EXPECT_FALSE(run.GetOutput(0)->GetPointData()->HasArray("FreePoint"));

  // Only if it is known which of the points before are.
  vtkNew<vtkPolyData> cube;
  cube->ShallowCopy(MakeCube(true));
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName("FreePoint");
  for (int i = 0; i < 8; ++i)
  {
    flags->InsertNextValue(i == 5);
  }
  cube->GetPointData()->AddArray(flags);
  Pipeline marked(cube);
  marked.Refiner->SetMaximumEdgeLength(0.3);
  marked.Refiner->Update();
  vtkDataArray* isFree =
    FindArray(marked.GetOutput(0)->GetPointData(), "FreePoint", 1, VTK_UNSIGNED_CHAR);
  ASSERT_NE(isFree, nullptr);
  ASSERT_GT(isFree->GetNumberOfTuples(), 8);
  for (vtkIdType i = 0; i < isFree->GetNumberOfTuples(); ++i)
  {
    EXPECT_EQ(isFree->GetComponent(i, 0), i == 5 || i >= 8 ? 1.0 : 0.0);
  }
}

TEST(DelaunaySurfaceRefinerFilter, RefinesToAnArea)
{
  Pipeline run(MakeTwoBoxes(true));
  run.Refiner->SetMaximumArea(0.05);
  run.Refiner->Update();
  vtkPolyData* output = run.GetOutput(0);
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    EXPECT_LE(vtkTriangle::SafeDownCast(output->GetCell(cell))->ComputeArea(), 0.05);
  }
  EXPECT_NEAR(GetArea(output, 3, 7), 1.0, 1e-12);
  EXPECT_NEAR(GetArea(output, -1, 3), 5.0, 1e-12);
  EXPECT_NEAR(GetArea(output, -1, 7), 9.0, 1e-12);
  ExpectLinear(output);
}

TEST(DelaunaySurfaceRefinerFilter, FollowsTheSizing)
{
  // Edge lengths of 0.1 at x = 0, of 0.6 at x = 1.
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 3);
  image->SetSpacing(0.5, 0.5, 0.5);
  vtkNew<vtkDoubleArray> sizing;
  sizing->SetName("Sizing");
  for (vtkIdType i = 0; i < 27; ++i)
  {
    sizing->InsertNextValue(0.1 + 0.5 * image->GetPoint(i)[0]);
  }
  image->GetPointData()->AddArray(sizing);
  Pipeline run(MakeCube());
  run.Refiner->SetInputData(2, image);
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors + run.Recorder->Warnings, "");
  int left = 0;
  int right = 0;
  for (vtkIdType i = 0; i < run.GetOutput(0)->GetNumberOfPoints(); ++i)
  {
    const double x = run.GetOutput(0)->GetPoint(i)[0];
    left += x == 0.0;
    right += x == 1.0;
  }
  EXPECT_GT(left, 100);
  EXPECT_LT(right, left / 2);

  // Without cells the nearest point counts.
  auto cloud = MakePoints({ { 0.5, 0.5, 0.5 } });
  vtkNew<vtkDoubleArray> single;
  single->SetName("Sizing");
  single->InsertNextValue(0.3);
  cloud->GetPointData()->AddArray(single);
  run.Refiner->SetInputData(2, cloud);
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_GT(run.GetOutput(0)->GetNumberOfPoints(), 50);
  EXPECT_LE(GetLongestEdge(run.GetOutput(0)), 0.6);
}

TEST(DelaunaySurfaceRefinerFilter, FollowsTheLargestOfSeveralLengths)
{
  // Principal lengths of 0.3, 0.3 and 0.01, along the axes and as a tensor askew, as good as 0.3.
  const double part = 0.5 * (0.3 - 0.01);
  const std::vector<std::vector<double>> sizings{ { 0.3 }, { 0.3, 0.01, 0.3 },
    { 0.3 - part, 0.3 - part, 0.3, part, 0.0, 0.0 } };
  vtkIdType expected = 0;
  for (const std::vector<double>& lengths : sizings)
  {
    auto cloud = MakePoints({ { 0.5, 0.5, 0.5 } });
    vtkNew<vtkDoubleArray> sizing;
    sizing->SetName("Sizing");
    sizing->SetNumberOfComponents(static_cast<int>(lengths.size()));
    sizing->InsertNextTuple(lengths.data());
    cloud->GetPointData()->AddArray(sizing);
    Pipeline run(MakeCube());
    run.Refiner->SetInputData(2, cloud);
    run.Refiner->Update();
    EXPECT_EQ(run.Recorder->Errors + run.Recorder->Warnings, "");
    EXPECT_LE(GetLongestEdge(run.GetOutput(0)), 0.3 + 1e-12);
    expected = expected > 0 ? expected : run.GetOutput(0)->GetNumberOfPoints();
    EXPECT_EQ(run.GetOutput(0)->GetNumberOfPoints(), expected);
  }
}

TEST(DelaunaySurfaceRefinerFilter, RefusesBadSizing)
{
  Pipeline run(MakeCube());
  auto cloud = MakePoints({ { 0.5, 0.5, 0.5 } });
  run.Refiner->SetInputData(2, cloud);
  ExpectFailure(run.Refiner, { "point array Sizing" });
  vtkNew<vtkDoubleArray> sizing;
  sizing->SetName("Sizing");
  sizing->InsertNextValue(0.0);
  cloud->GetPointData()->AddArray(sizing);
  cloud->Modified();
  ExpectFailure(run.Refiner, { "positive", "point 0" });
}

TEST(DelaunaySurfaceRefinerFilter, KeepsMeshPointsWithTheirData)
{
  Pipeline run(MakeCube());
  run.Refiner->SetInputData(
    1, MakePoints({ { 0.5, 0.5, 0.5 }, { 0.5, 0.5, 1e-7 }, { 0.25, 0.5, 0.75 }, { 0, 0.5, 0.5 } }));
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_TRUE(Contains(run.Recorder->Warnings, "Dropped 2 mesh points")) << run.Recorder->Warnings;
  EXPECT_EQ(run.Refiner->GetNumberOfDroppedMeshPoints(), 2);
  vtkPolyData* kept = run.GetOutput(2);
  ASSERT_EQ(kept->GetNumberOfPoints(), 2);
  EXPECT_EQ(kept->GetNumberOfVerts(), 2);
  EXPECT_EQ(kept->GetPoint(1)[0], 0.25);
  ExpectLinear(kept, 0.0);
}

TEST(DelaunaySurfaceRefinerFilter, NumbersFacetsAndKeepsThem)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  Pipeline run(builder.Build());
  run.Refiner->SetMaximumEdgeLength(0.3);
  run.Refiner->Update();
  vtkPolyData* output = run.GetOutput(0);
  vtkDataArray* facets = FindArray(output->GetCellData(), "StructuralFacetId", 1, VTK_INT);
  ASSERT_NE(facets, nullptr);
  // One number for each side of the box.
  std::map<double, Point> normals;
  for (vtkIdType i = 0; i < output->GetNumberOfCells(); ++i)
  {
    Point normal;
    vtkPolygon::ComputeNormal(output->GetCell(i)->GetPoints(), normal.data());
    const Point& first = normals.emplace(facets->GetComponent(i, 0), normal).first->second;
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_NEAR(normal[axis], first[axis], 1e-12);
    }
  }
  EXPECT_EQ(normals.size(), 6u);
  EXPECT_EQ(normals.begin()->first, 0.0);
  EXPECT_EQ(normals.rbegin()->first, 5.0);

  // Given facets are kept: each triangle its own, and all edges are structural.
  vtkNew<vtkPolyData> given;
  given->ShallowCopy(output);
  vtkNew<vtkIntArray> own;
  own->SetName("StructuralFacetId");
  for (vtkIdType i = 0; i < given->GetNumberOfCells(); ++i)
  {
    own->InsertNextValue(static_cast<int>(i));
  }
  given->GetCellData()->AddArray(own);
  vtkNew<vtkDelaunaySurfaceRefiner> again;
  again->SetInputData(given);
  again->Update();
  const vtkIdType triangles = given->GetNumberOfCells();
  EXPECT_GE(vtkPolyData::SafeDownCast(again->GetOutputDataObject(1))->GetNumberOfLines(),
    3 * triangles / 2);
  EXPECT_EQ(again->GetOutput()->GetCellData()->GetArray("StructuralFacetId")->GetRange()[1],
    triangles - 1.0);

  vtkNew<vtkIntArray> pairs;
  pairs->SetName("StructuralFacetId");
  pairs->SetNumberOfComponents(2);
  pairs->SetNumberOfTuples(triangles);
  given->GetCellData()->AddArray(pairs);
  ExpectFailure(again, { "StructuralFacetId" });
}

TEST(DelaunaySurfaceRefinerFilter, ReportsUnresolvedTriangles)
{
  // A thin box whose large sides disturb each other.
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 0.01 });
  builder.AddBox({ 0.3, 0.3, 0.02 }, { 0.6, 0.6, 0.5 });
  Pipeline run(builder.Build());
  run.Refiner->SetCriterionToSmallestSphere();
  run.Refiner->SetMaximumNewPoints(1);
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  const vtkIdType unresolved = run.Refiner->GetNumberOfUnresolvedTriangles();
  EXPECT_GT(unresolved, 0);
  EXPECT_TRUE(Contains(run.Recorder->Warnings, std::to_string(unresolved) + " triangles"))
    << run.Recorder->Warnings;
  EXPECT_TRUE(Contains(run.Recorder->Warnings, "come from these cells of the input. Cells: "))
    << run.Recorder->Warnings;
  vtkDataArray* array =
    FindArray(run.GetOutput(0)->GetCellData(), "Unresolved", 1, VTK_UNSIGNED_CHAR);
  ASSERT_NE(array, nullptr);
  double sum = 0.0;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    sum += array->GetComponent(i, 0);
  }
  EXPECT_EQ(sum, unresolved);

  run.Refiner->SetMaximumNewPoints(0);
  run.Refiner->SetMaximumTime(1e-9);
  run.Recorder->Warnings.clear();
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  EXPECT_GT(run.Refiner->GetNumberOfUnresolvedTriangles(), 0);
  EXPECT_TRUE(Contains(run.Recorder->Warnings, "MaximumTime")) << run.Recorder->Warnings;

  run.Refiner->SetMaximumTime(0.0);
  run.Refiner->Update();
  EXPECT_EQ(run.Refiner->GetNumberOfUnresolvedTriangles(), 0);
  EXPECT_FALSE(run.GetOutput(0)->GetCellData()->HasArray("Unresolved"));
}

TEST(DelaunaySurfaceRefinerFilter, RefusesBadInput)
{
  vtkNew<vtkDelaunaySurfaceRefiner> filter;
  vtkNew<vtkPolyData> nothing;
  filter->SetInputData(nothing);
  ExpectFailure(filter, { "empty" });
  filter->SetInputData(MakeCube());
  ExpectFailure(filter, { "vtkBoundaryTriangulator", "Cells: 0, 1, 2, 3, 4, 5 (6 in all)" });
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(MakeCube());
  triangulator->Update();
  vtkNew<vtkPolyData> surface;
  surface->DeepCopy(triangulator->GetOutput());
  surface->GetPoints()->SetPoint(3, std::numeric_limits<double>::infinity(), 0.0, 0.0);
  filter->SetInputData(surface);
  ExpectFailure(filter, { "finite", "Points: 3" });
  filter->SetInputData(triangulator->GetOutput());
  filter->SetInputData(1, MakePoints({ { 0.5, 0.5, std::numeric_limits<double>::quiet_NaN() } }));
  ExpectFailure(filter, { "Point 0 of the mesh points", "not finite" });
}

TEST(DelaunaySurfaceRefinerFilter, ReportsProgressAndAborts)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(40);
  sphere->Update();
  Pipeline run(sphere->GetOutput());
  run.Refiner->Update();
  ExpectProgress(run.Recorder);
  run.Recorder->AbortAt = 0.05;
  run.Refiner->Modified();
  run.Refiner->Update();
  EXPECT_EQ(run.Recorder->Errors, "");
  ExpectEmptyOutputs(run.Refiner);
}
