// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSteinerPointRefiner.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Certificates.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/SizingInputs.h"
#include "CoreBridge/Tuples.h"

#include "Core/Improvement/SteinerPointRefiner.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkSteinerPointRefiner);

namespace
{
constexpr const char* RemovePointName = "RemovePoint";
} // namespace

//--------------------------------------------------------------------------------------------------
vtkSteinerPointRefiner::vtkSteinerPointRefiner()
{
  this->SetNumberOfInputPorts(4);
  this->SetNumberOfOutputPorts(2);
}

//--------------------------------------------------------------------------------------------------
int vtkSteinerPointRefiner::FillInputPortInformation(int port, vtkInformation* info)
{
  static const char* const types[4] = { "vtkUnstructuredGrid", "vtkDataSet", "vtkPolyData",
    "vtkPointSet" };
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), types[port]);
  if (port > 0)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkSteinerPointRefiner::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkSteinerPointRefiner::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  vtkDataSet* sizingInput = vtkDataSet::GetData(inputVector[1]);
  vtkPolyData* boundaryInput = vtkPolyData::GetData(inputVector[2]);
  vtkPointSet* pointInput = vtkPointSet::GetData(inputVector[3]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TetMesh mesh;
  cdm::TriangleMesh boundary;
  cdm::SteinerPointRefinerInput engineInput;
  engineInput.Mesh = &mesh;
  cdm::SteinerPointRefinerOutput result;
  // Errors count cells of the boundary if there is one.
  vtkDataSet* namedInput = input;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTetMesh(input, mesh);
      if (step.IsOk() && sizingInput)
      {
        step = vtkCoreBridge::ToSizing(sizingInput, engineInput.Sizing);
      }
      if (step.IsOk())
      {
        step = vtkCoreBridge::ToFlags(input, vtkCoreBridge::FreePointName, engineInput.IsFree);
      }
      if (step.IsOk())
      {
        step = vtkCoreBridge::ToFlags(input, RemovePointName, engineInput.IsRemoved);
      }
      if (step.IsOk() && pointInput)
      {
        step = vtkCoreBridge::ToPoints(pointInput, "points to be put in", engineInput.NewPoints);
      }
      if (step.IsOk() && boundaryInput && boundaryInput->GetNumberOfCells() > 0)
      {
        namedInput = boundaryInput;
        step = vtkCoreBridge::ToTriangleMesh(boundaryInput, boundary);
        engineInput.Boundary = &boundary;
      }
      cdm::SteinerPointRefinerOptions options;
      if (step.IsOk() && engineInput.Boundary)
      {
        step = vtkCoreBridge::ToFacets(boundaryInput, options.StructuralEdges.Facets);
      }
      if (!step.IsOk())
      {
        return step;
      }
      engineInput.AreInteriorPointsFree = this->FreeInteriorPoints;
      options.RadiusEdgeRatio = this->RadiusEdgeRatio;
      options.DihedralAngleTarget = this->DihedralAngleTarget;
      options.MaximumVolume = this->MaximumVolume;
      options.MaximumEdgeLength = this->MaximumEdgeLength;
      options.MinimumEdgeLength = this->MinimumEdgeLength;
      options.Criterion = static_cast<cdm::SurfaceCriterion>(this->Criterion);
      options.StructuralEdges.AccuracyAngle = this->AccuracyAngle;
      options.StructuralEdges.FlatnessRatio = this->FlatnessRatio;
      options.MaximumNewPoints = this->MaximumNewPoints;
      step =
        cdm::RefineBySteinerPoints(engineInput, options, vtkCoreBridge::MakeContext(this), result);
      if (boundaryInput)
      {
        vtkCoreBridge::OffsetCells(step.Cells, vtkCoreBridge::GetFirstPolygon(boundaryInput));
      }
      return step;
    });
  const cdm::SteinerPointRefinerReport& report = result.Report;
  this->NumberOfBoundaryPoints = report.BoundaryPoints;
  this->NumberOfInteriorPoints = report.InteriorPoints;
  this->NumberOfMovedPoints = report.MovedPoints;
  this->NumberOfRemovedPoints = report.RemovedPoints;
  this->NumberOfRounds = report.Rounds;
  this->NumberOfTooLargeTetrahedra = report.TooLarge;
  this->NumberOfBadlyShapedTetrahedra = report.BadlyShaped;
  this->NumberOfSlivers = report.Slivers;
  this->NumberOfInevitableFaults = report.Inevitable;
  this->NumberOfNegativeCouplings = report.NegativeCouplings;
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, namedInput);
  }

  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkCoreBridge::RemoveCertificate(output->GetFieldData());
  vtkCoreBridge::FromTetMesh(result.Mesh, output);
  vtkCoreBridge::InterpolateTuplesInCells(input, result.PointSources, output);
  output->GetPointData()->RemoveArray(RemovePointName);
  vtkCoreBridge::FromFlags(vtkCoreBridge::FreePointName, result.IsFree, output->GetPointData());
  vtkPolyData* boundaryOutput = vtkPolyData::GetData(outputVector, 1);
  vtkCoreBridge::FromTriangleMesh(result.Boundary, boundaryOutput);
  boundaryOutput->GetPointData()->PassData(output->GetPointData());
  if (engineInput.Boundary)
  {
    vtkCoreBridge::CopyTriangleTuples(boundaryInput, result.Boundary.SourceCells, boundaryOutput);
  }

  vtkCoreBridge::FromFaults(result.Faults, output);
  vtkCoreBridge::ReportWarnings(this, result.Warnings);
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkSteinerPointRefiner::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "RadiusEdgeRatio: " << this->RadiusEdgeRatio << "\n";
  os << indent << "DihedralAngleTarget: " << this->DihedralAngleTarget << "\n";
  os << indent << "MaximumVolume: " << this->MaximumVolume << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MinimumEdgeLength: " << this->MinimumEdgeLength << "\n";
  os << indent << "FreeInteriorPoints: " << this->FreeInteriorPoints << "\n";
  os << indent << "AccuracyAngle: " << this->AccuracyAngle << "\n";
  os << indent << "FlatnessRatio: " << this->FlatnessRatio << "\n";
  os << indent << "MaximumNewPoints: " << this->MaximumNewPoints << "\n";
  os << indent << "NumberOfBoundaryPoints: " << this->NumberOfBoundaryPoints << "\n";
  os << indent << "NumberOfInteriorPoints: " << this->NumberOfInteriorPoints << "\n";
  os << indent << "NumberOfMovedPoints: " << this->NumberOfMovedPoints << "\n";
  os << indent << "NumberOfRemovedPoints: " << this->NumberOfRemovedPoints << "\n";
  os << indent << "NumberOfRounds: " << this->NumberOfRounds << "\n";
  os << indent << "NumberOfTooLargeTetrahedra: " << this->NumberOfTooLargeTetrahedra << "\n";
  os << indent << "NumberOfBadlyShapedTetrahedra: " << this->NumberOfBadlyShapedTetrahedra << "\n";
  os << indent << "NumberOfSlivers: " << this->NumberOfSlivers << "\n";
  os << indent << "NumberOfInevitableFaults: " << this->NumberOfInevitableFaults << "\n";
  os << indent << "NumberOfNegativeCouplings: " << this->NumberOfNegativeCouplings << "\n";
}
