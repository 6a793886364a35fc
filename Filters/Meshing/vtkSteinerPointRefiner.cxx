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

#include <vector>

vtkStandardNewMacro(vtkSteinerPointRefiner);

namespace
{
constexpr const char* RemovePointName = "RemovePoint";

/** What the engine's input refers to, of the data sets at the four ports. */
struct PortInputs
{
  vtkUnstructuredGrid* Mesh;
  vtkDataSet* Sizing;
  vtkPolyData* Boundary;
  vtkPointSet* NewPoints;

  cdm::TetMesh EngineMesh;
  cdm::TriangleMesh EngineBoundary;

  bool HasBoundary() const { return this->Boundary && this->Boundary->GetNumberOfCells() > 0; }
};

cdm::Status ReadInputs(
  PortInputs& ports, cdm::SteinerPointRefinerInput& input, std::vector<cdm::Id>& facets)
{
  input.Mesh = &ports.EngineMesh;
  return vtkCoreBridge::ToTetMesh(ports.Mesh, ports.EngineMesh)
    .Then(
      [&] {
        return ports.Sizing ? vtkCoreBridge::ToSizing(ports.Sizing, input.Sizing) : cdm::Status();
      })
    .Then([&]
      { return vtkCoreBridge::ToFlags(ports.Mesh, vtkCoreBridge::FreePointName, input.IsFree); })
    .Then([&] { return vtkCoreBridge::ToFlags(ports.Mesh, RemovePointName, input.IsRemoved); })
    .Then(
      [&]
      {
        return ports.NewPoints
          ? vtkCoreBridge::ToPoints(ports.NewPoints, "points to be put in", input.NewPoints)
          : cdm::Status();
      })
    .Then(
      [&]
      {
        if (!ports.HasBoundary())
        {
          return cdm::Status();
        }
        input.Boundary = &ports.EngineBoundary;
        return vtkCoreBridge::ToTriangleMesh(ports.Boundary, ports.EngineBoundary)
          .Then([&] { return vtkCoreBridge::ToFacets(ports.Boundary, facets); });
      });
}
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
  PortInputs ports{ vtkUnstructuredGrid::GetData(inputVector[0]),
    vtkDataSet::GetData(inputVector[1]), vtkPolyData::GetData(inputVector[2]),
    vtkPointSet::GetData(inputVector[3]), {}, {} };
  if (vtkCoreBridge::IsIdleProcess(ports.Mesh, outputVector))
  {
    return 1;
  }

  cdm::SteinerPointRefinerInput engineInput;
  cdm::SteinerPointRefinerOptions options;
  options.RadiusEdgeRatio = this->RadiusEdgeRatio;
  options.DihedralAngleTarget = this->DihedralAngleTarget;
  options.LayerAspectRatio = this->LayerAspectRatio;
  options.TetrahedraAcrossLayers = this->TetrahedraAcrossLayers;
  options.MaximumVolume = this->MaximumVolume;
  options.MaximumEdgeLength = this->MaximumEdgeLength;
  options.MinimumEdgeLength = this->MinimumEdgeLength;
  options.Criterion = static_cast<cdm::SurfaceCriterion>(this->Criterion);
  options.StructuralEdges.AccuracyAngle = this->AccuracyAngle;
  options.StructuralEdges.FlatnessRatio = this->FlatnessRatio;
  options.MaximumNewPoints = this->MaximumNewPoints;
  options.MaximumTime = this->MaximumTime;
  engineInput.AreInteriorPointsFree = this->FreeInteriorPoints;
  cdm::SteinerPointRefinerOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      return ReadInputs(ports, engineInput, options.StructuralEdges.Facets)
        .Then(
          [&]
          {
            cdm::Status step = cdm::RefineBySteinerPoints(
              engineInput, options, vtkCoreBridge::MakeContext(this), result);
            if (ports.Boundary)
            {
              vtkCoreBridge::OffsetCells(
                step.Cells, vtkCoreBridge::GetFirstPolygon(ports.Boundary));
            }
            return step;
          });
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
    // Errors count cells of the boundary once it is read.
    return vtkCoreBridge::ReportFailure(this, outputVector, status,
      engineInput.Boundary ? static_cast<vtkDataSet*>(ports.Boundary) : ports.Mesh);
  }

  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkCoreBridge::RemoveCertificate(output->GetFieldData());
  vtkCoreBridge::FromTetMesh(result.Mesh, output);
  vtkCoreBridge::InterpolateTuplesInCells(ports.Mesh, result.PointSources, output);
  output->GetPointData()->RemoveArray(RemovePointName);
  vtkCoreBridge::FromFlags(vtkCoreBridge::FreePointName, result.IsFree, output->GetPointData());
  vtkPolyData* boundaryOutput = vtkPolyData::GetData(outputVector, 1);
  vtkCoreBridge::FromTriangleMesh(result.Boundary, boundaryOutput);
  boundaryOutput->GetPointData()->PassData(output->GetPointData());
  if (engineInput.Boundary)
  {
    vtkCoreBridge::CopyTriangleTuples(ports.Boundary, result.Boundary.SourceCells, boundaryOutput);
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
  os << indent << "LayerAspectRatio: " << this->LayerAspectRatio << "\n";
  os << indent << "TetrahedraAcrossLayers: " << this->TetrahedraAcrossLayers << "\n";
  os << indent << "MaximumVolume: " << this->MaximumVolume << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MinimumEdgeLength: " << this->MinimumEdgeLength << "\n";
  os << indent << "FreeInteriorPoints: " << this->FreeInteriorPoints << "\n";
  os << indent << "AccuracyAngle: " << this->AccuracyAngle << "\n";
  os << indent << "FlatnessRatio: " << this->FlatnessRatio << "\n";
  os << indent << "MaximumNewPoints: " << this->MaximumNewPoints << "\n";
  os << indent << "MaximumTime: " << this->MaximumTime << "\n";
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
