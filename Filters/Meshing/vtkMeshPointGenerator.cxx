// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshPointGenerator.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/SizingInputs.h"

#include "Core/MeshPoints/MeshPointGenerator.h"

#include <vtkCellArray.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

vtkStandardNewMacro(vtkMeshPointGenerator);

namespace
{
constexpr double MaximumNumberOfLayers = 1000.0;

bool IsWhole(double value, double smallest, double largest)
{
  return value >= smallest && value <= largest && value == std::floor(value);
}

cdm::Status ToLayers(
  const std::vector<std::array<double, 5>>& rows, std::vector<cdm::PointLayers>& layers)
{
  for (const std::array<double, 5>& row : rows)
  {
    if (!IsWhole(row[0], 0.0, VTK_INT_MAX) || !IsWhole(row[1], -1.0, VTK_INT_MAX) ||
      !IsWhole(row[2], 1.0, MaximumNumberOfLayers) || !(row[3] > 0.0 && std::isfinite(row[3])) ||
      !(row[4] > 0.0 && std::isfinite(row[4])))
    {
      return cdm::Status::InvalidInput("Layers " + std::to_string(layers.size()) +
        " are not right: they need a region from 0 on, a neighbor from -1 on, 1 to 1000 layers, a "
        "first distance and a growth ratio above 0.");
    }
    layers.push_back({ static_cast<cdm::Id>(row[0]), static_cast<cdm::Id>(row[1]),
      static_cast<cdm::Id>(row[2]), row[3], row[4] });
  }
  return {};
}

cdm::Status CheckTicks(const std::array<std::vector<double>, 3>& ticks)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!std::all_of(
          ticks[axis].begin(), ticks[axis].end(), [](double t) { return std::isfinite(t); }))
    {
      return cdm::Status::InvalidInput(
        std::string("A tick of the ") + "xyz"[axis] + " axis is not finite: correct it.");
    }
  }
  return {};
}

/** The lengths that hold without a sizing input; 0 is a tenth of the longest side. */
cdm::Status ToSpacing(const double (&spacing)[3], vtkPolyData* surface, cdm::SizingField& sizing)
{
  double bounds[6];
  surface->GetBounds(bounds);
  const double side =
    std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] });
  cdm::Vec3 lengths;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(spacing[axis] >= 0.0 && std::isfinite(spacing[axis])))
    {
      return cdm::Status::InvalidInput("Spacing must not be negative, and finite.");
    }
    lengths[axis] = spacing[axis] > 0.0 ? spacing[axis] : 0.1 * side;
  }
  const cdm::LocalSpacing constant(lengths);
  sizing = [constant](const cdm::Vec3&) { return constant; };
  return {};
}

void AddIntArray(const char* name, const std::vector<cdm::Id>& values, vtkPolyData* output)
{
  output->GetPointData()->AddArray(vtkCoreBridge::MakeArray<vtkIntArray>(
    name, values.size(), [&](std::size_t i) { return values[i]; }));
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkMeshPointGenerator::vtkMeshPointGenerator()
{
  this->SetNumberOfInputPorts(2);
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::AddTick(int axis, double position)
{
  this->Ticks[axis].push_back(position);
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::RemoveAllTicks(int axis)
{
  this->Ticks[axis].clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::AddLayers(
  double region, double neighbor, double numberOfLayers, double firstDistance, double growthRatio)
{
  this->Layers.push_back({ region, neighbor, numberOfLayers, firstDistance, growthRatio });
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::RemoveAllLayers()
{
  this->Layers.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
int vtkMeshPointGenerator::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillInputPortInformation(port, info);
  }
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkMeshPointGenerator::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkDataSet* sizingInput = vtkDataSet::GetData(inputVector[1]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TriangleMesh surface;
  cdm::MeshPointGeneratorInput engineInput;
  engineInput.Surface = &surface;
  cdm::MeshPointGeneratorOptions options;
  options.Placement = static_cast<cdm::PointPlacement>(this->Placement);
  options.Template = static_cast<cdm::PointTemplate>(this->Template);
  options.MaximumLevelDifference = this->MaximumLevelDifference;
  options.Ticks = this->Ticks;
  options.SmoothingIterations = this->SmoothingIterations;
  options.Seed = static_cast<std::uint64_t>(this->Seed);
  options.BoundaryClearance = this->BoundaryClearance;
  options.MaximumNumberOfPoints = this->MaximumNumberOfPoints;
  cdm::MeshPointGeneratorOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTriangleMesh(input, surface);
      if (step.IsOk())
      {
        step = sizingInput ? vtkCoreBridge::ToSizing(sizingInput, engineInput.Sizing)
                           : ToSpacing(this->Spacing, input, engineInput.Sizing);
      }
      if (step.IsOk())
      {
        step = ToLayers(this->Layers, options.Layers);
      }
      if (step.IsOk())
      {
        step = CheckTicks(options.Ticks);
      }
      if (step.IsOk())
      {
        step =
          cdm::GenerateMeshPoints(engineInput, options, vtkCoreBridge::MakeContext(this), result);
        vtkCoreBridge::OffsetCells(step, vtkCoreBridge::GetFirstPolygon(input));
      }
      return step;
    });
  this->NumberOfLayerPoints = static_cast<vtkIdType>(result.Points.size()) -
    std::count(result.Layers.begin(), result.Layers.end(), 0);
  this->NumberOfDroppedLayerPoints = result.DroppedLayerPoints;
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }

  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  output->SetPoints(vtkCoreBridge::FromPoints(result.Points));
  output->SetVerts(vtkCoreBridge::MakeCells(
    result.Points.size(), 1, [](std::size_t i, int) { return static_cast<vtkIdType>(i); }));
  AddIntArray(vtkCoreBridge::RegionIdName, result.Regions, output);
  AddIntArray("Layer", result.Layers, output);
  if (result.Points.empty())
  {
    vtkWarningMacro("No point has place inside: the spacing is too large for the regions.");
  }
  else if (!options.Layers.empty() && this->NumberOfLayerPoints == 0)
  {
    vtkWarningMacro("The layers have no points: the surface has no vertices inside of their "
                    "interfaces at this spacing, or the layers do not fit into the regions.");
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Placement: " << this->Placement << "\n";
  os << indent << "Template: " << this->Template << "\n";
  os << indent << "Spacing: " << this->Spacing[0] << ", " << this->Spacing[1] << ", "
     << this->Spacing[2] << "\n";
  os << indent << "MaximumLevelDifference: " << this->MaximumLevelDifference << "\n";
  for (int axis = 0; axis < 3; ++axis)
  {
    os << indent << "xyz"[axis] << " ticks: " << this->Ticks[axis].size() << "\n";
  }
  os << indent << "SmoothingIterations: " << this->SmoothingIterations << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  for (const std::array<double, 5>& row : this->Layers)
  {
    os << indent << "Layers: region " << row[0] << ", neighbor " << row[1] << ", number " << row[2]
       << ", first distance " << row[3] << ", growth ratio " << row[4] << "\n";
  }
  os << indent << "BoundaryClearance: " << this->BoundaryClearance << "\n";
  os << indent << "MaximumNumberOfPoints: " << this->MaximumNumberOfPoints << "\n";
  os << indent << "NumberOfLayerPoints: " << this->NumberOfLayerPoints << "\n";
  os << indent << "NumberOfDroppedLayerPoints: " << this->NumberOfDroppedLayerPoints << "\n";
}
