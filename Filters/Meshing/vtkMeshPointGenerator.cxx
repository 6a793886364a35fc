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
#include <numeric>
#include <string>

vtkStandardNewMacro(vtkMeshPointGenerator);

namespace
{
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
  this->Layers.push_back(
    vtkCoreBridge::MakeLayerRow(region, neighbor, { numberOfLayers, firstDistance, growthRatio }));
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::AddLayers(const char* region, const char* neighbor,
  double numberOfLayers, double firstDistance, double growthRatio)
{
  this->LayersByName.push_back({ { region ? region : "", neighbor ? neighbor : "" },
    { numberOfLayers, firstDistance, growthRatio } });
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::RemoveAllLayers()
{
  this->RemoveAllLayersById();
  this->RemoveAllLayersByName();
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::RemoveAllLayersById()
{
  this->Layers.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkMeshPointGenerator::RemoveAllLayersByName()
{
  this->LayersByName.clear();
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
  options.Spacing = { this->Spacing[0], this->Spacing[1], this->Spacing[2] };
  options.SmoothingIterations = this->SmoothingIterations;
  options.Seed = static_cast<std::uint64_t>(this->Seed);
  options.BoundaryClearance = this->BoundaryClearance;
  options.MaximumNumberOfPoints = this->MaximumNumberOfPoints;
  cdm::MeshPointGeneratorOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTriangleMesh(input, surface);
      if (step.IsOk() && sizingInput)
      {
        step = vtkCoreBridge::ToSizing(sizingInput, engineInput.Sizing);
      }
      if (step.IsOk())
      {
        step = vtkCoreBridge::ToLayers(input, this->Layers, options.Layers)
                 .Then([&]
                   { return vtkCoreBridge::ToLayers(input, this->LayersByName, options.Layers); });
      }
      if (step.IsOk())
      {
        step =
          cdm::GenerateMeshPoints(engineInput, options, vtkCoreBridge::MakeContext(this), result);
        vtkCoreBridge::OffsetCells(step.Cells, vtkCoreBridge::GetFirstPolygon(input));
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
  vtkCoreBridge::ReportWarnings(this, result.Warnings);
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
  for (const auto* rows : { &this->Layers, &this->LayersByName })
  {
    for (const auto& [regions, numbers] : *rows)
    {
      os << indent << "Layers: region " << regions[0] << ", neighbor " << regions[1] << ", number "
         << numbers[0] << ", first distance " << numbers[1] << ", growth ratio " << numbers[2]
         << "\n";
    }
  }
  os << indent << "BoundaryClearance: " << this->BoundaryClearance << "\n";
  os << indent << "MaximumNumberOfPoints: " << this->MaximumNumberOfPoints << "\n";
  os << indent << "NumberOfLayerPoints: " << this->NumberOfLayerPoints << "\n";
  os << indent << "NumberOfDroppedLayerPoints: " << this->NumberOfDroppedLayerPoints << "\n";
}
