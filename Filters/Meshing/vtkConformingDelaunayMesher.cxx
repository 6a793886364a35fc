// SPDX-License-Identifier: BSD-3-Clause
#include "vtkConformingDelaunayMesher.h"

#include "BlockDistribution.h"
#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"
#include "ProcessGroup.h"
#include "vtkAdvancingFrontTetrahedralizer.h"
#include "vtkBoundaryTriangulator.h"
#include "vtkConformingDelaunayCompatibility.h"
#include "vtkDelaunaySurfaceRefiner.h"
#include "vtkMeshPointGenerator.h"
#include "vtkSliverRemover.h"
#include "vtkSteinerPointRefiner.h"

#include "Core/Certificate/MeshChecks.h"
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Surface/StructuralEdges.h"

#include <vtkAppendFilter.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataObjectTree.h>
#include <vtkDataObjectTypes.h>
#include <vtkDataSet.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <string>

vtkStandardNewMacro(vtkConformingDelaunayMesher);

namespace
{
/** Text of an error or warning event without VTK's "ERROR: In file, line, class (address): ". */
std::string GetMessage(void* callData)
{
  std::string text = callData ? static_cast<const char*>(callData) : "";
  const std::size_t address = text.find("): ");
  text = address == std::string::npos ? text : text.substr(address + 3);
  return text.substr(0, text.find_last_not_of(" \n") + 1);
}

/** Hears what a stage says while it runs, and passes it on to the filter around it. */
class StageObserver : public vtkCommand
{
public:
  static StageObserver* New() { return new StageObserver; }

  void Execute(vtkObject* caller, unsigned long event, void* callData) override
  {
    auto stage = vtkAlgorithm::SafeDownCast(caller);
    if (event == vtkCommand::WarningEvent)
    {
      const std::string text = this->Prefix + GetMessage(callData);
      vtkWarningWithObjectMacro(this->Filter, << text);
    }
    else if (event == vtkCommand::ErrorEvent)
    {
      // The executive complains as well, after the stage itself.
      this->Error = this->Error.empty() ? GetMessage(callData) : this->Error;
    }
    else if (stage && event == vtkCommand::ProgressEvent)
    {
      const char* activity = stage->GetProgressText();
      const std::string text =
        this->Name + (activity && *activity ? std::string(": ") + activity : std::string());
      this->Filter->SetProgressText(text.c_str());
      this->Filter->UpdateProgress(
        this->Begin + (this->End - this->Begin) * *static_cast<double*>(callData));
      if (vtkConformingDelaunayCompatibility::CheckAbort(this->Filter))
      {
        stage->SetAbortExecute(1);
      }
    }
  }

  vtkAlgorithm* Filter = nullptr;
  std::string Name;
  /** What comes before its warnings: the block that is meshed. */
  std::string Prefix;
  double Begin = 0.0;
  double End = 1.0;
  std::string Error;
};

/** What all stages of one run have in common. */
struct Run
{
  vtkAlgorithm* Filter;
  std::string Prefix;
};

/** Update a stage of the pipeline; its progress is [begin, end] of the filter's. */
cdm::Status RunStage(
  const Run& run, vtkAlgorithm* stage, const char* name, double begin, double end)
{
  vtkNew<StageObserver> observer;
  observer->Filter = run.Filter;
  observer->Name = name;
  observer->Prefix = run.Prefix;
  observer->Begin = begin;
  observer->End = end;
  for (unsigned long event :
    { vtkCommand::ProgressEvent, vtkCommand::WarningEvent, vtkCommand::ErrorEvent })
  {
    stage->AddObserver(event, observer);
  }
  stage->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
  stage->Update();
  stage->RemoveObserver(observer);
  stage->GetExecutive()->RemoveObserver(observer);
  if (vtkConformingDelaunayCompatibility::CheckAbort(run.Filter))
  {
    return cdm::Status::Aborted();
  }
  return observer->Error.empty() ? cdm::Status{} : cdm::Status::InvalidInput(observer->Error);
}

using SortedTriangle = std::array<cdm::Id, 3>;

SortedTriangle Sort(SortedTriangle ids)
{
  std::sort(ids.begin(), ids.end());
  return ids;
}

cdm::EdgeIds GetEdge(const cdm::TriangleIds& triangle, int i)
{
  const auto ends = std::minmax(triangle[i], triangle[(i + 1) % 3]);
  return { ends.first, ends.second };
}

/** Of one interface, whichever side is in front. */
bool AreSameRegions(const cdm::RegionPair& a, const cdm::RegionPair& b)
{
  return a == b || (a.Front == b.Back && a.Back == b.Front);
}

/**
 * The boundary of a mesh from which flat tetrahedra were peeled off: triangles of the boundary
 * before that are still there, then the new ones, with an old triangle of the same patch as their
 * source.
 */
cdm::TriangleMesh UpdateBoundary(const cdm::TetMesh& mesh, const cdm::TriangleMesh& before)
{
  const cdm::TriangleMesh facets = cdm::ExtractBoundary(mesh);
  std::map<SortedTriangle, std::size_t> interfaces;
  for (std::size_t i = 0; i < facets.Triangles.size(); ++i)
  {
    interfaces[Sort(facets.Triangles[i])] = i;
  }

  cdm::TriangleMesh after;
  after.Points = mesh.Points;
  std::map<cdm::EdgeIds, std::vector<cdm::Id>> goneByEdge;
  for (std::size_t i = 0; i < before.Triangles.size(); ++i)
  {
    const cdm::TriangleIds& ids = before.Triangles[i];
    const auto found = interfaces.find(Sort(ids));
    // A sheet inside of one region is no interface, and nothing is peeled off at it.
    if (found != interfaces.end() || before.Labels[i].Front == before.Labels[i].Back)
    {
      after.Triangles.push_back(ids);
      after.Labels.push_back(before.Labels[i]);
      after.SourceCells.push_back(static_cast<cdm::Id>(i));
      if (found != interfaces.end())
      {
        interfaces.erase(found);
      }
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      goneByEdge[GetEdge(ids, k)].push_back(static_cast<cdm::Id>(i));
    }
  }
  for (const auto& item : interfaces)
  {
    const cdm::TriangleIds& added = facets.Triangles[item.second];
    const cdm::RegionPair& labels = facets.Labels[item.second];
    cdm::Id source = cdm::NoId;
    for (int k = 0; k < 3 && source == cdm::NoId; ++k)
    {
      const std::vector<cdm::Id>& gone = goneByEdge[GetEdge(added, k)];
      const auto found = std::find_if(gone.begin(), gone.end(),
        [&](cdm::Id i) { return AreSameRegions(before.Labels[i], labels); });
      source = found == gone.end() ? cdm::NoId : *found;
    }
    after.Triangles.push_back(added);
    after.Labels.push_back(labels);
    after.SourceCells.push_back(source);
  }
  return after;
}

/** How much of a region peeling may take, at most: a layer as thin as what counts as flat. */
double GetPeeledVolumeRatio(
  const cdm::TriangleMesh& boundary, const cdm::MeshCheckReport& report, double flatnessRatio)
{
  double area = 0.0;
  for (const cdm::TriangleIds& ids : boundary.Triangles)
  {
    area += cdm::GetTriangleArea(
      boundary.Points[ids[0]], boundary.Points[ids[1]], boundary.Points[ids[2]]);
  }
  double smallest = std::numeric_limits<double>::max();
  for (const cdm::RegionVolume& region : report.Regions)
  {
    smallest = std::min(smallest, region.Volume);
  }
  return flatnessRatio * cdm::GetBoundingBoxDiagonal(boundary.Points) * area / smallest;
}

/** The spacing of mesh points along the axes; 0 is the longest edge of the boundary. */
std::array<double, 3> ChooseSpacing(const double (&spacing)[3], double longestEdge)
{
  std::array<double, 3> lengths;
  std::transform(spacing, spacing + 3, lengths.begin(),
    [longestEdge](double length) { return length == 0.0 ? longestEdge : length; });
  return lengths;
}

/** Check the mesh, bring its boundary up to date if tetrahedra were peeled off, make outputs. */
cdm::Status Finish(const Run& run, int criterion, vtkUnstructuredGrid* grid, vtkPolyData* surface,
  vtkSliverRemover* remover, vtkUnstructuredGrid* output, vtkPolyData* boundaryOutput)
{
  cdm::TetMesh mesh;
  cdm::TriangleMesh boundary;
  cdm::MeshCheckReport report;
  cdm::Status status = vtkCoreBridge::ToTetMesh(grid, mesh);
  if (status.IsOk())
  {
    status = vtkCoreBridge::ToTriangleMesh(surface, boundary);
  }
  if (!status.IsOk())
  {
    return status;
  }
  const cdm::ExecutionContext context = vtkCoreBridge::MakeContext(run.Filter).Part(0.95, 1.0);
  if (remover->GetNumberOfPeeledTetrahedra() > 0)
  {
    cdm::MeshCheckReport before;
    status = cdm::CheckTetMesh(mesh, &boundary, context.Part(0.0, 0.5), before);
    const double allowed = GetPeeledVolumeRatio(boundary, before, remover->GetFlatnessRatio());
    boundary = UpdateBoundary(mesh, boundary);
    if (status.IsOk())
    {
      status = cdm::CheckTetMesh(mesh, &boundary, context.Part(0.5, 1.0), report);
    }
    // The new facets are the mesh's own: only those before tell whether more is missing.
    if (before.LargestVolumeError > allowed)
    {
      report.Regions = before.Regions;
      report.LargestVolumeError = before.LargestVolumeError;
    }
    vtkCoreBridge::FromTriangleMesh(boundary, boundaryOutput);
    vtkCoreBridge::CopyTriangleTuples(surface, boundary.SourceCells, boundaryOutput);
    boundaryOutput->GetPointData()->PassData(grid->GetPointData());
  }
  else
  {
    status = cdm::CheckTetMesh(mesh, &boundary, context, report);
    boundaryOutput->ShallowCopy(surface);
  }
  boundaryOutput->GetCellData()->RemoveArray(vtkCoreBridge::InputCellName);

  output->ShallowCopy(grid);
  vtkNew<vtkStringArray> certificate;
  certificate->SetName("Certificate");
  // The verdict comes last: scripts look for it there.
  certificate->InsertNextValue(
    (criterion == vtkConformingDelaunayMesher::Delaunay ? "" : report.GetSphereSummary() + "; ") +
    report.GetSummary());
  output->GetFieldData()->AddArray(certificate);
  if (status.IsOk() && !report.IsValid())
  {
    vtkWarningWithObjectMacro(
      run.Filter, << run.Prefix << "The check finds fault with the mesh: " << report.GetSummary());
  }
  return status;
}

/** Marks the points as ones that vtkSteinerPointRefiner may move and take out, or must not. */
void SetFree(vtkPointSet* points, bool isFree)
{
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkCoreBridge::FreePointName);
  flags->SetNumberOfTuples(points->GetNumberOfPoints());
  flags->FillValue(isFree ? 1 : 0);
  points->GetPointData()->AddArray(flags);
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
  this->Layers.push_back({ region, neighbor, numberOfLayers, firstDistance, growthRatio });
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::RemoveAllLayers()
{
  this->Layers.clear();
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
  ProcessGroup processes(vtkMultiProcessController::GetGlobalController());
  BlockDistribution distribution;
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
    points = GatherDataSet(processes, vtkDataSet::GetData(inputVector[1]));
    sizing = GatherDataSet(processes, vtkDataSet::GetData(inputVector[2]));
    for (vtkDataObjectTree* output : outputs)
    {
      BlockDistribution::CopyStructure(input, output);
    }
    const std::vector<BlockDistribution::Block>& blocks = distribution.GetBlocks();
    const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, blocks.size()));
    for (const BlockDistribution::Block& block : blocks)
    {
      // A block that fails does not keep the others from showing what is wrong with them.
      this->SetProgressShiftScale(share * static_cast<double>(problems.size()), share);
      vtkNew<vtkUnstructuredGrid> mesh;
      vtkNew<vtkPolyData> boundary;
      problems.push_back(vtkSmartPointer<vtkPolyData>::New());
      const cdm::Status step = this->MeshPolygons(block.Name + ": ", block.Polygons,
        vtkPointSet::SafeDownCast(points), sizing, mesh, boundary, problems.back());
      BlockDistribution::SetBlock(outputs[0], block.Index, mesh);
      BlockDistribution::SetBlock(outputs[1], block.Index, boundary);
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
    BlockDistribution::CopyStructure(input, outputs[2]);
    for (std::size_t i = 0; i < problems.size(); ++i)
    {
      BlockDistribution::SetBlock(outputs[2], distribution.GetBlocks()[i].Index, problems[i]);
    }
  }
  return success;
}

//--------------------------------------------------------------------------------------------------
cdm::Status vtkConformingDelaunayMesher::MeshPolygons(const std::string& prefix, vtkPolyData* input,
  vtkPointSet* givenPoints, vtkDataSet* sizing, vtkUnstructuredGrid* mesh, vtkPolyData* boundary,
  vtkPolyData* problems)
{
  // Error messages of later stages name the cells of this input.
  vtkNew<vtkPolyData> surface;
  surface->ShallowCopy(input);
  vtkNew<vtkIdTypeArray> inputCells;
  inputCells->SetName(vtkCoreBridge::InputCellName);
  inputCells->SetNumberOfTuples(input->GetNumberOfCells());
  std::iota(inputCells->GetPointer(0), inputCells->GetPointer(input->GetNumberOfCells()), 0);
  surface->GetCellData()->AddArray(inputCells);
  if (this->AddSteinerPoints)
  {
    SetFree(surface, false);
  }

  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(surface);
  triangulator->SetMergeTolerance(this->MergeTolerance);
  triangulator->SetMaximumGapEdges(this->MaximumGapEdges);
  triangulator->SetResolveSelfIntersections(this->ResolveSelfIntersections);
  triangulator->SetKeepInternalPieces(this->KeepInternalPieces);
  vtkSmartPointer<vtkPointSet> pointInput;
  if (givenPoints)
  {
    pointInput.TakeReference(givenPoints->NewInstance());
    pointInput->ShallowCopy(givenPoints);
    if (this->AddSteinerPoints)
    {
      SetFree(pointInput, false);
    }
  }
  vtkNew<vtkMeshPointGenerator> generator;
  generator->SetInputConnection(triangulator->GetOutputPort());
  generator->SetInputDataObject(1, sizing);
  generator->SetPlacement(this->Placement);
  generator->SetSpacing(ChooseSpacing(this->Spacing, this->MaximumEdgeLength).data());
  for (const std::array<double, 5>& row : this->Layers)
  {
    generator->AddLayers(row[0], row[1], row[2], row[3], row[4]);
  }
  vtkNew<vtkAppendFilter> meshPoints;
  meshPoints->AddInputDataObject(pointInput);
  const bool hasMeshPoints = pointInput || this->GenerateMeshPoints;
  vtkNew<vtkDelaunaySurfaceRefiner> refiner;
  refiner->SetInputConnection(triangulator->GetOutputPort());
  if (hasMeshPoints)
  {
    refiner->SetInputConnection(1, meshPoints->GetOutputPort());
  }
  refiner->SetInputDataObject(2, sizing);
  refiner->SetMeshPointClearanceRatio(this->MeshPointClearanceRatio);
  refiner->SetCriterion(this->Criterion);
  refiner->SetAccuracyAngle(this->AccuracyAngle);
  refiner->SetMinimumAngle(this->MinimumAngle);
  refiner->SetMaximumArea(this->MaximumArea);
  refiner->SetMaximumEdgeLength(this->MaximumEdgeLength);
  vtkNew<vtkAdvancingFrontTetrahedralizer> tetrahedralizer;
  tetrahedralizer->SetInputConnection(refiner->GetOutputPort());
  if (hasMeshPoints)
  {
    tetrahedralizer->SetInputConnection(1, refiner->GetOutputPort(2));
  }
  tetrahedralizer->SetCloseOpenBoundary(this->CloseOpenBoundary);
  vtkNew<vtkSteinerPointRefiner> steiner;
  steiner->SetInputConnection(tetrahedralizer->GetOutputPort());
  steiner->SetInputDataObject(1, sizing);
  steiner->SetInputConnection(2, tetrahedralizer->GetOutputPort(1));
  steiner->SetCriterion(this->Criterion);
  steiner->SetAccuracyAngle(this->AccuracyAngle);
  steiner->SetRadiusEdgeRatio(this->RadiusEdgeRatio);
  steiner->SetDihedralAngleTarget(this->RemoveSlivers ? this->DihedralAngleTarget : 0.0);
  steiner->SetMaximumVolume(this->MaximumVolume);
  steiner->SetMaximumEdgeLength(this->MaximumEdgeLength);
  vtkNew<vtkSliverRemover> remover;
  remover->SetInputConnection(tetrahedralizer->GetOutputPort());
  remover->SetDihedralAngleTarget(this->DihedralAngleTarget);
  if (this->Criterion != Delaunay)
  {
    // Peeling turns a diagonal of the boundary, which the stronger criteria do not allow.
    remover->SetFlatnessRatio(0.0);
  }

  const Run run{ this, prefix };
  cdm::Status status = RunStage(run, triangulator, "Boundary triangulation", 0.0, 0.1);
  if (status.IsOk() && this->GenerateMeshPoints)
  {
    status = RunStage(run, generator, "Mesh points", 0.1, 0.2);
    vtkNew<vtkPolyData> points;
    points->ShallowCopy(generator->GetOutput());
    if (this->AddSteinerPoints)
    {
      SetFree(points, true);
    }
    meshPoints->AddInputDataObject(points);
  }
  if (status.IsOk())
  {
    status =
      RunStage(run, refiner, "Surface refinement", this->GenerateMeshPoints ? 0.2 : 0.1, 0.5);
  }
  if (status.IsOk())
  {
    status = RunStage(
      run, tetrahedralizer, "Tetrahedralization", 0.5, this->AddSteinerPoints ? 0.6 : 0.85);
  }
  // The last stages that make tetrahedra, and their boundary.
  vtkAlgorithm* last = tetrahedralizer;
  vtkAlgorithm* lastWithBoundary = tetrahedralizer;
  if (status.IsOk() && this->AddSteinerPoints)
  {
    status = RunStage(run, steiner, "Steiner points", 0.6, 0.95);
    last = lastWithBoundary = steiner;
  }
  else if (status.IsOk() && this->RemoveSlivers)
  {
    status = RunStage(run, remover, "Sliver removal", 0.85, 0.95);
    last = remover;
  }
  if (status.IsOk())
  {
    status = cdm::RunGuarded(
      [&]
      {
        return Finish(run, this->Criterion,
          vtkUnstructuredGrid::SafeDownCast(last->GetOutputDataObject(0)),
          vtkPolyData::SafeDownCast(lastWithBoundary->GetOutputDataObject(1)), remover, mesh,
          boundary);
      });
  }
  problems->ShallowCopy(triangulator->GetOutputDataObject(1));
  return status;
}

//--------------------------------------------------------------------------------------------------
void vtkConformingDelaunayMesher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MergeTolerance: " << this->MergeTolerance << "\n";
  os << indent << "MaximumGapEdges: " << this->MaximumGapEdges << "\n";
  os << indent << "ResolveSelfIntersections: " << this->ResolveSelfIntersections << "\n";
  os << indent << "KeepInternalPieces: " << this->KeepInternalPieces << "\n";
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "AccuracyAngle: " << this->AccuracyAngle << "\n";
  os << indent << "MinimumAngle: " << this->MinimumAngle << "\n";
  os << indent << "MaximumArea: " << this->MaximumArea << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "GenerateMeshPoints: " << this->GenerateMeshPoints << "\n";
  os << indent << "Placement: " << this->Placement << "\n";
  os << indent << "Spacing: " << this->Spacing[0] << ", " << this->Spacing[1] << ", "
     << this->Spacing[2] << "\n";
  for (const std::array<double, 5>& row : this->Layers)
  {
    os << indent << "Layers: region " << row[0] << ", neighbor " << row[1] << ", number " << row[2]
       << ", first distance " << row[3] << ", growth ratio " << row[4] << "\n";
  }
  os << indent << "MeshPointClearanceRatio: " << this->MeshPointClearanceRatio << "\n";
  os << indent << "CloseOpenBoundary: " << this->CloseOpenBoundary << "\n";
  os << indent << "RemoveSlivers: " << this->RemoveSlivers << "\n";
  os << indent << "AddSteinerPoints: " << this->AddSteinerPoints << "\n";
  os << indent << "RadiusEdgeRatio: " << this->RadiusEdgeRatio << "\n";
  os << indent << "MaximumVolume: " << this->MaximumVolume << "\n";
  os << indent << "DihedralAngleTarget: " << this->DihedralAngleTarget << "\n";
}
