// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkDataSetTriangleFilter.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkPlaneSource.h>
#include <vtkRectilinearGrid.h>
#include <vtkSizingFromSolution.h>

#include <cmath>
#include <functional>

using namespace testing_filters;

namespace
{
void SetSolution(vtkDataSet* data, const std::function<double(const double x[3])>& function)
{
  vtkNew<vtkDoubleArray> solution;
  solution->SetName("Solution");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    solution->InsertNextValue(function(data->GetPoint(i)));
  }
  data->GetPointData()->SetScalars(solution);
}

vtkSmartPointer<vtkImageData> MakeImage(
  const std::function<double(const double x[3])>& function, int points = 9)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(points, points, points);
  image->SetSpacing(1.0 / (points - 1), 1.0 / (points - 1), 1.0 / (points - 1));
  SetSolution(image, function);
  return image;
}

vtkDataArray* GetSizing(vtkSizingFromSolution* filter, int components)
{
  auto output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  return FindArray(output->GetPointData(), "Sizing", components, VTK_DOUBLE);
}
} // namespace

TEST(SizingFromSolutionFilter, IsTheClosedFormForALinearSolution)
{
  // The gradient of FilterTesting's Linear is (2, -3, 0.5).
  auto image = MakeImage(Linear);
  vtkNew<vtkDataSetTriangleFilter> tetrahedra;
  tetrahedra->SetInputData(image);
  tetrahedra->Update();
  vtkNew<vtkDoubleArray> ticks;
  for (const double tick : { 0.0, 0.1, 0.4, 1.0 })
  {
    ticks->InsertNextValue(tick);
  }
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(4, 4, 4);
  grid->SetXCoordinates(ticks);
  grid->SetYCoordinates(ticks);
  grid->SetZCoordinates(ticks);
  SetSolution(grid, Linear);
  const double slope = std::sqrt(4.0 + 9.0 + 0.25);
  for (vtkDataSet* data :
    std::initializer_list<vtkDataSet*>{ image, tetrahedra->GetOutput(), grid })
  {
    vtkNew<vtkSizingFromSolution> filter;
    filter->SetInputData(data);
    filter->SetMaximumIncrease(0.4);
    filter->SetRegularization(0.01);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(filter);
    filter->Update();
    EXPECT_EQ(recorder->Errors + recorder->Warnings, "");
    EXPECT_STREQ(filter->GetOutputDataObject(0)->GetClassName(), data->GetClassName());
    vtkDataArray* sizing = GetSizing(filter, 1);
    ASSERT_EQ(sizing->GetNumberOfTuples(), data->GetNumberOfPoints());
    for (vtkIdType i = 0; i < sizing->GetNumberOfTuples(); ++i)
    {
      EXPECT_NEAR(sizing->GetComponent(i, 0), 0.4 / (0.01 + slope), 1e-12);
    }
    EXPECT_FALSE(data->GetPointData()->HasArray("Sizing"));
    EXPECT_TRUE(filter->GetOutput()->GetPointData()->HasArray("Solution"));

    filter->AnisotropicOn();
    filter->Update();
    sizing = GetSizing(filter, 3);
    for (vtkIdType i = 0; i < sizing->GetNumberOfTuples(); ++i)
    {
      EXPECT_NEAR(sizing->GetComponent(i, 0), 0.4 / 2.01, 1e-12);
      EXPECT_NEAR(sizing->GetComponent(i, 1), 0.4 / 3.01, 1e-12);
      EXPECT_NEAR(sizing->GetComponent(i, 2), 0.4 / 0.51, 1e-12);
    }
  }

  // On a surface the gradient along it counts.
  vtkNew<vtkPlaneSource> plane;
  plane->SetResolution(5, 5);
  plane->Update();
  SetSolution(plane->GetOutput(), Linear);
  vtkNew<vtkSizingFromSolution> filter;
  filter->SetInputData(plane->GetOutput());
  filter->SetMaximumIncrease(1.0);
  filter->SetRegularization(1e-9);
  filter->Update();
  EXPECT_NEAR(GetSizing(filter, 1)->GetComponent(7, 0), 1.0 / std::sqrt(13.0), 1e-6);
}

TEST(SizingFromSolutionFilter, DefaultsAreRelativeToTheData)
{
  // From 0 to 50 over a length of 1: a tenth of the range is reached in a tenth of the length.
  vtkNew<vtkSizingFromSolution> filter;
  filter->SetInputData(MakeImage([](const double x[3]) { return 50.0 * x[0]; }));
  filter->Update();
  const double alpha = 5.0 / std::sqrt(3.0);
  EXPECT_NEAR(GetSizing(filter, 1)->GetComponent(0, 0), 5.0 / (alpha + 50.0), 1e-12);
  // A constant has no gradient: as long as the diagonal. Whole numbers work as well.
  auto image = MakeImage([](const double*) { return 0.0; });
  vtkNew<vtkIntArray> constant;
  constant->SetNumberOfTuples(image->GetNumberOfPoints());
  constant->FillValue(3);
  image->GetPointData()->SetScalars(constant);
  filter->SetInputData(image);
  filter->Update();
  EXPECT_NEAR(GetSizing(filter, 1)->GetComponent(0, 0), std::sqrt(3.0), 1e-12);
}

TEST(SizingFromSolutionFilter, KeepsLimitsAndGradation)
{
  // A step in the middle.
  constexpr int n = 21;
  auto image = MakeImage([](const double x[3]) { return std::tanh((x[0] - 0.5) / 0.02); }, n);
  vtkNew<vtkSizingFromSolution> filter;
  filter->SetInputData(image);
  filter->SetGradation(0.25);
  filter->SetMinimumSize(0.02);
  filter->SetMaximumSize(0.11);
  filter->Update();
  vtkDataArray* sizing = GetSizing(filter, 1);
  double range[2];
  sizing->GetRange(range);
  EXPECT_EQ(range[0], 0.02);
  EXPECT_EQ(range[1], 0.11);
  for (vtkIdType i = 0; i < sizing->GetNumberOfTuples(); ++i)
  {
    // The size grows with the distance from where it is smallest: the planes beside the step.
    const double distance = std::max(0.0, std::abs(image->GetPoint(i)[0] - 0.5) - 0.05);
    EXPECT_LE(sizing->GetComponent(i, 0), 0.02 + 0.25 * distance + 1e-12);
  }
  for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
  {
    vtkIdList* ids = image->GetCell(cell)->GetPointIds();
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      for (vtkIdType j = 0; j < i; ++j)
      {
        double a[3];
        double b[3];
        image->GetPoint(ids->GetId(i), a);
        image->GetPoint(ids->GetId(j), b);
        EXPECT_LE(
          std::abs(sizing->GetComponent(ids->GetId(i), 0) - sizing->GetComponent(ids->GetId(j), 0)),
          0.25 * std::sqrt(vtkMath::Distance2BetweenPoints(a, b)) + 1e-15);
      }
    }
  }
  filter->SetGradation(0.0);
  filter->SetMaximumSize(0.0);
  filter->Update();
  GetSizing(filter, 1)->GetRange(range);
  EXPECT_GT(range[1], 1.0);
}

TEST(SizingFromSolutionFilter, RefusesBadInput)
{
  vtkNew<vtkSizingFromSolution> filter;
  auto cloud = MakePoints({ { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0 } });
  cloud->GetPointData()->SetActiveScalars("Linear");
  filter->SetInputData(cloud);
  ExpectFailure(filter, { "no cells" });
  vtkNew<vtkCellArray> vertices;
  for (const vtkIdType id : { 0, 1 })
  {
    vertices->InsertNextCell(1, &id);
  }
  cloud->SetVerts(vertices);
  cloud->Modified();
  ExpectFailure(filter, { "no cells" });
  auto image = MakeImage(Linear);
  filter->SetInputData(image);
  filter->SetMinimumSize(2.0);
  filter->SetMaximumSize(1.0);
  ExpectFailure(filter, { "MinimumSize" });
  filter->SetMinimumSize(0.0);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Missing");
  ExpectFailure(filter, { "array to process" });
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Solution");
  image->GetPointData()->GetArray("Solution")->SetComponent(5, 0, std::nan(""));
  image->Modified();
  ExpectFailure(filter, { "not finite", "Points: 5" });
}

TEST(SizingFromSolutionFilter, ReportsProgressAndAborts)
{
  vtkNew<vtkSizingFromSolution> filter;
  filter->SetInputData(MakeImage(Linear, 30));
  filter->AnisotropicOn();
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectProgress(recorder);
  recorder->AbortAt = 0.5;
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(filter);
}
