// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSizingFromSolution.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/SizingInputs.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Sizing/SizingField.h"

#include <vtkCellType.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkGradientFilter.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSizingFromSolution);

namespace
{
/** Checks the solution: one finite number for each point of a data set that can have a gradient. */
cdm::Status CheckSolution(vtkDataSet* input, vtkDataArray* solution)
{
  const cdm::Status status = cdm::CheckIdRange(input->GetNumberOfPoints(), "points");
  if (!status.IsOk())
  {
    return status;
  }
  bool hasCells = false;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells() && !hasCells; ++cell)
  {
    const int type = input->GetCellType(cell);
    hasCells = type != VTK_EMPTY_CELL && type != VTK_VERTEX && type != VTK_POLY_VERTEX;
  }
  if (!hasCells)
  {
    return cdm::Status::InvalidInput(
      "The input has no cells but points: a solution has no gradient on points alone.");
  }
  if (!solution || solution->GetNumberOfComponents() != 1 ||
    solution->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    return cdm::Status::InvalidInput("The array to process has to be a point array with one "
                                     "component: choose one (SetInputArrayToProcess).");
  }
  for (vtkIdType i = 0; i < solution->GetNumberOfTuples(); ++i)
  {
    const double value = solution->GetComponent(i, 0);
    if (!std::isfinite(value))
    {
      return cdm::Status::InvalidInput(
        "The solution is not finite.", {}, { static_cast<cdm::Id>(i) });
    }
  }
  return {};
}

/** The gradient of the solution at each point. */
vtkSmartPointer<vtkDataArray> ComputeGradient(vtkDataSet* input, vtkDataArray* solution)
{
  static const char* const name = "Solution";
  auto data = vtk::TakeSmartPointer(input->NewInstance());
  data->CopyStructure(input);
  // The gradient of whole numbers is not made of whole numbers.
  vtkNew<vtkDoubleArray> values;
  values->DeepCopy(solution);
  values->SetName(name);
  data->GetPointData()->AddArray(values);
  vtkNew<vtkGradientFilter> filter;
  filter->SetInputData(data);
  filter->SetInputScalars(vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
  filter->SetResultArrayName("Gradient");
  filter->Update();
  auto output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  return output->GetPointData()->GetArray("Gradient");
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkSizingFromSolution::vtkSizingFromSolution()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

//--------------------------------------------------------------------------------------------------
cdm::Status vtkSizingFromSolution::ComputeSizes(
  vtkDataSet* data, vtkDataArray* solution, std::vector<double>* sizes)
{
  if (this->MaximumSize > 0.0 && this->MinimumSize > this->MaximumSize)
  {
    return cdm::Status::InvalidInput("MinimumSize is larger than MaximumSize.");
  }
  const vtkSmartPointer<vtkDataArray> gradient = ComputeGradient(data, solution);
  if (!vtkCoreBridge::MakeContext(this).Continue(0.5, "Limiting sizes"))
  {
    return cdm::Status::Aborted();
  }
  double range[2];
  solution->GetFiniteRange(range, 0);
  // A constant solution wants no edge shorter than any other.
  const double spread = range[1] > range[0] ? range[1] - range[0] : 1.0;
  const double increase = this->MaximumIncrease > 0.0 ? this->MaximumIncrease : 0.1 * spread;
  const double regularization =
    this->Regularization > 0.0 ? this->Regularization : increase / data->GetLength();
  const double largest =
    this->MaximumSize > 0.0 ? this->MaximumSize : std::numeric_limits<double>::max();
  const int components = this->GetNumberOfSizes();
  for (int i = 0; i < components; ++i)
  {
    sizes[i].resize(data->GetNumberOfPoints());
  }
  vtkCoreBridge::ForEach(sizes[0].size(),
    [&](std::size_t point)
    {
      double slopes[3];
      gradient->GetTuple(static_cast<vtkIdType>(point), slopes);
      slopes[0] = this->Anisotropic ? slopes[0] : vtkMath::Norm(slopes);
      for (int i = 0; i < components; ++i)
      {
        const double size = increase / (regularization + std::abs(slopes[i]));
        sizes[i][point] = std::min(std::max(size, this->MinimumSize), largest);
      }
    });
  for (std::size_t point = 0; point < sizes[0].size(); ++point)
  {
    for (int i = 0; i < components; ++i)
    {
      if (!(sizes[i][point] > 0.0 && std::isfinite(sizes[i][point])))
      {
        return cdm::Status::InvalidInput(
          "The solution has no finite gradient: its cells are degenerate there.", {},
          { static_cast<cdm::Id>(point) });
      }
    }
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status vtkSizingFromSolution::BoundGradation(vtkDataSet* data, std::vector<double>* sizes)
{
  if (this->Gradation <= 0.0)
  {
    return {};
  }
  const cdm::ExecutionContext context = vtkCoreBridge::MakeContext(this);
  cdm::SizingCells cells;
  cdm::Status status = vtkCoreBridge::ToSizingCells(data, cells);
  const int components = this->GetNumberOfSizes();
  for (int i = 0; i < components && status.IsOk(); ++i)
  {
    status = cdm::BoundGradation(cells, { this->Gradation },
      context.Part(0.5 + 0.5 * i / components, 0.5 + 0.5 * (i + 1) / components), sizes[i]);
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
int vtkSizingFromSolution::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataSet* input = vtkDataSet::GetData(inputVector[0]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }
  const vtkSmartPointer<vtkDataSet> data = vtkCoreBridge::CopyWithoutBlanking(input);
  vtkDataArray* solution = this->GetInputArrayToProcess(0, inputVector);
  const int components = this->GetNumberOfSizes();
  std::vector<double> sizes[3];
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      return CheckSolution(data, solution)
        .Then([&] { return this->ComputeSizes(data, solution, sizes); })
        .Then([&] { return this->BoundGradation(data, sizes); });
    });
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }

  vtkDataSet* output = vtkDataSet::GetData(outputVector);
  output->ShallowCopy(input);
  vtkNew<vtkDoubleArray> sizing;
  sizing->SetName(vtkCoreBridge::SizingName);
  sizing->SetNumberOfComponents(components);
  sizing->SetNumberOfTuples(output->GetNumberOfPoints());
  double* const values = sizing->GetPointer(0);
  vtkCoreBridge::ForEach(sizes[0].size(),
    [&](std::size_t point)
    {
      for (int i = 0; i < components; ++i)
      {
        values[components * point + i] = sizes[i][point];
      }
    });
  output->GetPointData()->AddArray(sizing);
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkSizingFromSolution::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumIncrease: " << this->MaximumIncrease << "\n";
  os << indent << "Regularization: " << this->Regularization << "\n";
  os << indent << "Anisotropic: " << this->Anisotropic << "\n";
  os << indent << "MinimumSize: " << this->MinimumSize << "\n";
  os << indent << "MaximumSize: " << this->MaximumSize << "\n";
  os << indent << "Gradation: " << this->Gradation << "\n";
}
