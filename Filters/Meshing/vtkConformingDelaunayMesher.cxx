// SPDX-License-Identifier: BSD-3-Clause
#include "vtkConformingDelaunayMesher.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Certificates.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/PointHistories.h"
#include "CoreBridge/Problems.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/SizingInputs.h"
#include "CoreBridge/Tuples.h"
#include "Distributed/BlockDistribution.h"
#include "Distributed/ProcessGroup.h"

#include "Core/Pipeline/ConformingMesher.h"

#include <vtkAbstractArray.h>
#include <vtkDataObjectTree.h>
#include <vtkDataObjectTypes.h>
#include <vtkDataSet.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <optional>
#include <string>

vtkStandardNewMacro(vtkConformingDelaunayMesher);

namespace
{
/** Mesh and boundary with the data of the input. */
void MakeOutputs(const cdm::ConformingMesherOutput& result, vtkPolyData* input,
  const std::vector<vtkIdType>& cells, vtkPointSet* meshPoints, vtkUnstructuredGrid* mesh,
  vtkPolyData* boundary)
{
  vtkCoreBridge::FromTetMesh(result.Mesh, mesh);
  vtkCoreBridge::CarryPointData(result.Points, input, meshPoints, mesh);
  if (!result.IsFree.empty())
  {
    vtkCoreBridge::FromFlags(vtkCoreBridge::FreePointName, result.IsFree, mesh->GetPointData());
  }
  vtkCoreBridge::FromFaults(result.Faults, mesh);

  vtkCoreBridge::FromTriangleMesh(result.Boundary, boundary);
  boundary->GetPointData()->PassData(mesh->GetPointData());
  std::vector<vtkIdType> sources(result.Boundary.SourceCells.size());
  std::transform(result.Boundary.SourceCells.begin(), result.Boundary.SourceCells.end(),
    sources.begin(), [&](cdm::Id polygon) { return polygon == cdm::NoId ? -1 : cells[polygon]; });
  vtkCoreBridge::CopyCellTuples(input, sources, boundary);
  vtkCoreBridge::FromFacets(result.Facets, boundary);
  if (!result.UnresolvedTriangles.empty())
  {
    vtkCoreBridge::FromUnresolved(result.UnresolvedTriangles, boundary);
  }
}

/** A number in its range, or nothing for vtkConformingDelaunayMesher::AUTOMATIC. */
cdm::Status ToChoice(const char* name, double value, double largest, std::optional<double>& choice)
{
  if (value == vtkConformingDelaunayMesher::AUTOMATIC)
  {
    return {};
  }
  if (!(value >= 0.0 && value <= largest))
  {
    return cdm::Status::Failure(cdm::StatusCode::InvalidOption,
      std::string(name) + " is " + std::to_string(value) + ": give a number from 0 " +
        (largest < VTK_DOUBLE_MAX ? "to " + std::to_string(static_cast<int>(largest)) : "on") +
        ", or -1 for what the purpose of the mesh asks for.");
  }
  choice = value;
  return {};
}

/** What the mesh is for, and the longest edge that was asked for. */
void AddSettings(int purpose, const cdm::MeshSettings& settings, vtkFieldData* data)
{
  data->AddArray(vtkCoreBridge::MakeArray<vtkIntArray>(
    "MeshFor", 1, [purpose](std::size_t) { return purpose; }));
  data->AddArray(vtkCoreBridge::MakeArray<vtkDoubleArray>(
    "MaximumEdgeLength", 1, [&settings](std::size_t) { return settings.MaximumEdgeLength; }));
}

/** Names the point arrays of the input that the mesh does not have: mesh points may lack them. */
void WarnOfLostArrays(
  vtkAlgorithm* filter, const std::string& prefix, vtkPolyData* input, vtkUnstructuredGrid* output)
{
  std::string names;
  vtkPointData* const data = input->GetPointData();
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    const int attribute = data->IsArrayAnAttribute(i);
    const char* const name = data->GetAbstractArray(i)->GetName();
    if (name && attribute != vtkDataSetAttributes::GLOBALIDS &&
      attribute != vtkDataSetAttributes::PEDIGREEIDS && !output->GetPointData()->HasArray(name))
    {
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
  }
  if (!names.empty())
  {
    vtkWarningWithObjectMacro(
      filter, << prefix << "Point data that the mesh points lack is not kept: " << names << ".");
  }
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkConformingDelaunayMesher::vtkConformingDelaunayMesher()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(3);
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::AddLayers(
  double region, double neighbor, double numberOfLayers, double firstDistance, double growthRatio)
{
  this->Layers.push_back(
    vtkCoreBridge::MakeLayerRow(region, neighbor, { numberOfLayers, firstDistance, growthRatio }));
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::AddLayers(const char* region, const char* neighbor,
  double numberOfLayers, double firstDistance, double growthRatio)
{
  this->LayersByName.push_back({ { region ? region : "", neighbor ? neighbor : "" },
    { numberOfLayers, firstDistance, growthRatio } });
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::RemoveAllLayers()
{
  this->RemoveAllLayersById();
  this->RemoveAllLayersByName();
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::RemoveAllLayersById()
{
  this->Layers.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::RemoveAllLayersByName()
{
  this->LayersByName.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::AddRegionSize(int region, double length)
{
  this->AddRegionSize(std::to_string(region).c_str(), length);
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::AddRegionSize(const char* region, double length)
{
  this->RegionSizes.emplace_back(region ? region : "", length);
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::RemoveAllRegionSizes()
{
  this->RegionSizes.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
int vtkConformingDelaunayMesher::FillInputPortInformation(int port, vtkInformation* info)
{
  static const char* const types[3] = { "vtkPolyData", "vtkPointSet", "vtkDataSet" };
  if (port == 0)
  {
    // First, as only then the executive leaves the blocks to this filter.
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  }
  else
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), types[port]);
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkConformingDelaunayMesher::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//--------------------------------------------------------------------------------------------------
vtkTypeBool vtkConformingDelaunayMesher::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
    ? this->RequestDataObject(inputs, outputs)
    : this->Superclass::ProcessRequest(request, inputs, outputs);
}

//--------------------------------------------------------------------------------------------------
int vtkConformingDelaunayMesher::RequestDataObject(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* const input = vtkDataObject::GetData(inputVector[0]);
  const bool isComposite = input && input->IsA("vtkCompositeDataSet");
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* info = outputVector->GetInformationObject(port);
    const char* type = isComposite ? input->GetClassName()
      : port == 0                  ? "vtkUnstructuredGrid"
                                   : "vtkPolyData";
    // The executive replaces an output that is not of the type of its port.
    this->GetOutputPortInformation(port)->Set(vtkDataObject::DATA_TYPE_NAME(), type);
    vtkDataObject* output = vtkDataObject::GetData(info);
    if (!output || !output->IsA(type))
    {
      info->Set(vtkDataObject::DATA_OBJECT(),
        vtkSmartPointer<vtkDataObject>::Take(vtkDataObjectTypes::NewDataObject(type)));
    }
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkConformingDelaunayMesher::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (vtkDataObject::GetData(inputVector[0])->IsA("vtkCompositeDataSet"))
  {
    return this->MeshBlocks(inputVector, outputVector);
  }
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }
  vtkNew<vtkPolyData> problems;
  const cdm::Status status = this->MeshPolygons("", input, vtkPointSet::GetData(inputVector[1]),
    vtkDataSet::GetData(inputVector[2]), vtkUnstructuredGrid::GetData(outputVector, 0),
    vtkPolyData::GetData(outputVector, 1), problems);
  const int success =
    status.IsOk() ? 1 : vtkCoreBridge::ReportFailure(this, outputVector, status, nullptr);
  if (!status.IsAborted())
  {
    vtkPolyData::GetData(outputVector, 2)->ShallowCopy(problems);
  }
  return success;
}

//--------------------------------------------------------------------------------------------------
int vtkConformingDelaunayMesher::MeshBlocks(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObjectTree* input = vtkDataObjectTree::GetData(inputVector[0]);
  if (!input)
  {
    return vtkCoreBridge::ReportFailure(this, outputVector,
      cdm::Status::InvalidInput("Composite data of this kind cannot be meshed: give a "
                                "vtkPartitionedDataSetCollection or a vtkMultiBlockDataSet."),
      nullptr);
  }
  vtkDistributed::ProcessGroup processes(vtkMultiProcessController::GetGlobalController());
  vtkDistributed::BlockDistribution distribution;
  cdm::Status status = distribution.Run(processes, input);
  vtkSmartPointer<vtkDataSet> points;
  vtkSmartPointer<vtkDataSet> sizing;
  vtkDataObjectTree* outputs[3];
  for (int port = 0; port < 3; ++port)
  {
    outputs[port] = vtkDataObjectTree::GetData(outputVector, port);
  }
  std::vector<vtkSmartPointer<vtkPolyData>> problems;
  if (status.IsOk())
  {
    points = vtkDistributed::GatherDataSet(processes, vtkDataSet::GetData(inputVector[1]));
    sizing = vtkDistributed::GatherDataSet(processes, vtkDataSet::GetData(inputVector[2]));
    for (vtkDataObjectTree* output : outputs)
    {
      vtkDistributed::BlockDistribution::CopyStructure(input, output);
    }
    const std::vector<vtkDistributed::BlockDistribution::Block>& blocks = distribution.GetBlocks();
    const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, blocks.size()));
    for (const vtkDistributed::BlockDistribution::Block& block : blocks)
    {
      // A block that fails does not keep the others from showing what is wrong with them.
      this->SetProgressShiftScale(share * static_cast<double>(problems.size()), share);
      vtkNew<vtkUnstructuredGrid> mesh;
      vtkNew<vtkPolyData> boundary;
      problems.push_back(vtkSmartPointer<vtkPolyData>::New());
      const cdm::Status step = this->MeshPolygons(block.Name + ": ", block.Polygons,
        vtkPointSet::SafeDownCast(points), sizing, mesh, boundary, problems.back());
      vtkDistributed::BlockDistribution::SetBlock(outputs[0], block.Index, mesh);
      vtkDistributed::BlockDistribution::SetBlock(outputs[1], block.Index, boundary);
      if (step.IsAborted())
      {
        status = step;
        break;
      }
      if (!step.IsOk())
      {
        status.Code = step.Code;
        status.Message += (status.Message.empty() ? "" : "\n") + block.Name + ": " + step.Message;
      }
    }
    this->SetProgressShiftScale(0.0, 1.0);
    status = processes.Agree(status);
  }
  const int success =
    status.IsOk() ? 1 : vtkCoreBridge::ReportFailure(this, outputVector, status, nullptr);
  if (!status.IsAborted() && outputs[2])
  {
    vtkDistributed::BlockDistribution::CopyStructure(input, outputs[2]);
    for (std::size_t i = 0; i < problems.size(); ++i)
    {
      vtkDistributed::BlockDistribution::SetBlock(
        outputs[2], distribution.GetBlocks()[i].Index, problems[i]);
    }
  }
  return success;
}

//--------------------------------------------------------------------------------------------------
cdm::Status vtkConformingDelaunayMesher::MakeChoices(cdm::MeshOptionChoices& choices) const
{
  if (this->Criterion != AUTOMATIC)
  {
    choices.Criterion = static_cast<cdm::SurfaceCriterion>(this->Criterion);
  }
  if (this->AddSteinerPoints != AUTOMATIC)
  {
    choices.AddsSteinerPoints = this->AddSteinerPoints != 0;
  }
  if (this->RemoveSlivers != AUTOMATIC)
  {
    choices.RemovesSlivers = this->RemoveSlivers != 0;
  }
  if (this->GenerateMeshPoints != AUTOMATIC)
  {
    choices.GeneratesMeshPoints = this->GenerateMeshPoints != 0;
  }
  return ToChoice(
    "DihedralAngleTarget", this->DihedralAngleTarget, 70.0, choices.DihedralAngleTarget)
    .Then(
      [&]
      {
        return ToChoice(
          "RadiusEdgeRatio", this->RadiusEdgeRatio, VTK_DOUBLE_MAX, choices.RadiusEdgeRatio);
      })
    .Then(
      [&]
      {
        return ToChoice(
          "MaximumEdgeLength", this->MaximumEdgeLength, VTK_DOUBLE_MAX, choices.MaximumEdgeLength);
      });
}

//--------------------------------------------------------------------------------------------------
cdm::Status vtkConformingDelaunayMesher::MakeOptions(
  vtkPolyData* input, cdm::ConformingMesherOptions& options) const
{
  options.MeshFor = static_cast<cdm::MeshPurpose>(this->MeshFor);
  options.Boundary.MergeTolerance = this->MergeTolerance;
  options.Boundary.MaximumGapEdges = this->MaximumGapEdges;
  options.Boundary.ResolveSelfIntersections = this->ResolveSelfIntersections;
  options.Boundary.Pieces =
    this->KeepInternalPieces ? cdm::ResolvedPieces::All : cdm::ResolvedPieces::OutsideOnly;
  options.Surface.StructuralEdges.AccuracyAngle = this->AccuracyAngle;
  options.Surface.MinimumAngle = this->MinimumAngle;
  options.Surface.MaximumArea = this->MaximumArea;
  options.Surface.MeshPointClearanceRatio = this->MeshPointClearanceRatio;
  options.MeshPoints.Placement = static_cast<cdm::PointPlacement>(this->Placement);
  options.MeshPoints.Spacing = { this->Spacing[0], this->Spacing[1], this->Spacing[2] };
  options.RegionSizes.Growth = this->Growth;
  options.CloseOpenBoundary = this->CloseOpenBoundary;
  options.MaximumVolume = this->MaximumVolume;
  options.LayerAspectRatio = this->LayerAspectRatio;
  options.TetrahedraAcrossLayers = this->TetrahedraAcrossLayers;
  options.SmoothingRounds = this->SmoothingRounds;
  options.Surface.MaximumTime = this->MaximumTime;
  return this->MakeChoices(options.Choices)
    .Then(
      [&]
      {
        return ToChoice(
          "MaximumDeviation", this->MaximumDeviation, VTK_DOUBLE_MAX, options.MaximumDeviation);
      })
    .Then([&] { return vtkCoreBridge::ToLayers(input, this->Layers, options.MeshPoints.Layers); })
    .Then(
      [&] { return vtkCoreBridge::ToLayers(input, this->LayersByName, options.MeshPoints.Layers); })
    .Then(
      [&] {
        return vtkCoreBridge::ToRegionSizes(input, this->RegionSizes, options.RegionSizes.Sizes);
      });
}

//--------------------------------------------------------------------------------------------------
cdm::Status vtkConformingDelaunayMesher::MeshPolygons(const std::string& prefix, vtkPolyData* input,
  vtkPointSet* givenPoints, vtkDataSet* sizing, vtkUnstructuredGrid* mesh, vtkPolyData* boundary,
  vtkPolyData* problems)
{
  vtkCoreBridge::WarnOfOtherCells(this, input);
  cdm::PolygonSoup soup;
  std::vector<vtkIdType> cells;
  std::vector<cdm::Vec3> points;
  cdm::ConformingMesherInput engineInput;
  engineInput.Polygons = &soup;
  engineInput.MeshPoints = &points;
  engineInput.HasPointData = input->GetPointData()->GetNumberOfArrays() > 0;
  cdm::ConformingMesherOptions options;
  const cdm::Status converted = cdm::RunGuarded(
    [&]
    {
      return this->MakeOptions(input, options)
        .Then([&] { return vtkCoreBridge::ToPolygonSoup(input, soup, cells); })
        .Then([&] { return vtkCoreBridge::ToFacets(input, cells, engineInput.Facets); })
        .Then(
          [&]
          {
            engineInput.CellGroups = vtkCoreBridge::ToCellGroups(input, cells);
            return cdm::Status();
          })
        .Then(
          [&]
          {
            return givenPoints ? vtkCoreBridge::ToPoints(givenPoints, "mesh points", points)
                               : cdm::Status();
          })
        .Then(
          [&]
          {
            return givenPoints ? vtkCoreBridge::ToFlags(givenPoints, vtkCoreBridge::FreePointName,
                                   engineInput.AreMeshPointsFree)
                               : cdm::Status();
          })
        .Then([&]
          { return sizing ? vtkCoreBridge::ToSizing(sizing, engineInput.Sizing) : cdm::Status(); });
    });
  if (!converted.IsOk())
  {
    return vtkCoreBridge::SpellOut(converted, input);
  }
  cdm::ConformingMesherOutput result;
  cdm::Status status =
    cdm::MeshPolygons(engineInput, options, vtkCoreBridge::MakeContext(this), result);
  vtkCoreBridge::MapCells(result.Warnings, cells);
  vtkCoreBridge::ReportWarnings(this, result.Warnings, prefix);
  if (!status.IsAborted())
  {
    vtkCoreBridge::FromProblems(soup, cells, result.Problems, problems);
  }
  if (!status.IsOk())
  {
    vtkCoreBridge::MapCells(status.Cells, cells);
    return vtkCoreBridge::SpellOut(std::move(status), input);
  }
  return cdm::RunGuarded(
    [&]() -> cdm::Status
    {
      MakeOutputs(result, input, cells, givenPoints, mesh, boundary);
      vtkCoreBridge::AddCertificate(result.Certificate, mesh->GetFieldData());
      AddSettings(this->MeshFor, result.Settings, mesh->GetFieldData());
      WarnOfLostArrays(this, prefix, input, mesh);
      return {};
    });
}

//--------------------------------------------------------------------------------------------------
vtkPointSet* vtkConformingDelaunayMesher::GetOutput(int port)
{
  return vtkPointSet::SafeDownCast(this->GetOutputDataObject(port));
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MeshFor: " << this->MeshFor << "\n";
  os << indent << "MergeTolerance: " << this->MergeTolerance << "\n";
  os << indent << "MaximumGapEdges: " << this->MaximumGapEdges << "\n";
  os << indent << "ResolveSelfIntersections: " << this->ResolveSelfIntersections << "\n";
  os << indent << "KeepInternalPieces: " << this->KeepInternalPieces << "\n";
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "AccuracyAngle: " << this->AccuracyAngle << "\n";
  os << indent << "MinimumAngle: " << this->MinimumAngle << "\n";
  os << indent << "MaximumArea: " << this->MaximumArea << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MaximumDeviation: " << this->MaximumDeviation << "\n";
  for (const auto& [region, length] : this->RegionSizes)
  {
    os << indent << "RegionSizes: region " << region << ", length " << length << "\n";
  }
  os << indent << "Growth: " << this->Growth << "\n";
  os << indent << "GenerateMeshPoints: " << this->GenerateMeshPoints << "\n";
  os << indent << "Placement: " << this->Placement << "\n";
  os << indent << "Spacing: " << this->Spacing[0] << ", " << this->Spacing[1] << ", "
     << this->Spacing[2] << "\n";
  for (const auto* rows : { &this->Layers, &this->LayersByName })
  {
    for (const auto& [regions, numbers] : *rows)
    {
      os << indent << "Layers: region " << regions[0] << ", neighbor " << regions[1] << ", number "
         << numbers[0] << ", first distance " << numbers[1] << ", growth ratio " << numbers[2]
         << "\n";
    }
  }
  os << indent << "MeshPointClearanceRatio: " << this->MeshPointClearanceRatio << "\n";
  os << indent << "CloseOpenBoundary: " << this->CloseOpenBoundary << "\n";
  os << indent << "RemoveSlivers: " << this->RemoveSlivers << "\n";
  os << indent << "AddSteinerPoints: " << this->AddSteinerPoints << "\n";
  os << indent << "RadiusEdgeRatio: " << this->RadiusEdgeRatio << "\n";
  os << indent << "MaximumVolume: " << this->MaximumVolume << "\n";
  os << indent << "DihedralAngleTarget: " << this->DihedralAngleTarget << "\n";
  os << indent << "LayerAspectRatio: " << this->LayerAspectRatio << "\n";
  os << indent << "TetrahedraAcrossLayers: " << this->TetrahedraAcrossLayers << "\n";
  os << indent << "SmoothingRounds: " << this->SmoothingRounds << "\n";
  os << indent << "MaximumTime: " << this->MaximumTime << "\n";
}
