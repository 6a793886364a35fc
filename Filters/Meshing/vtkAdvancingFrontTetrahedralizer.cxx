// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAdvancingFrontTetrahedralizer.h"

#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"
#include "vtkConformingDelaunayCompatibility.h"

#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkAdvancingFrontTetrahedralizer);

//--------------------------------------------------------------------------------------------------
vtkAdvancingFrontTetrahedralizer::vtkAdvancingFrontTetrahedralizer()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(3);
}

//--------------------------------------------------------------------------------------------------
int vtkAdvancingFrontTetrahedralizer::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  if (port > 0)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkAdvancingFrontTetrahedralizer::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkAdvancingFrontTetrahedralizer::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPointSet* points = vtkPointSet::GetData(inputVector[0]);
  vtkPolyData* input = vtkPolyData::SafeDownCast(points);
  vtkNew<vtkPolyData> cloud;
  if (!input)
  {
    cloud->SetPoints(points->GetPoints());
    cloud->GetPointData()->ShallowCopy(points->GetPointData());
    input = cloud;
  }
  vtkPointSet* pointInput = vtkPointSet::GetData(inputVector[1]);
  vtkPointSet* seedInput = vtkPointSet::GetData(inputVector[2]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TriangleMesh surface;
  std::vector<cdm::Vec3> meshPoints;
  std::vector<cdm::RegionSeed> seeds;
  cdm::AdvancingFrontTetrahedralizerOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = input->GetNumberOfPolys() + input->GetNumberOfStrips() > 0
        ? vtkCoreBridge::ToTriangleMesh(input, surface)
        : vtkCoreBridge::ToPoints(input, "points", surface.Points);
      if (step.IsOk() && pointInput)
      {
        step = vtkCoreBridge::ToPoints(pointInput, "mesh points", meshPoints);
      }
      if (step.IsOk() && seedInput)
      {
        step = vtkCoreBridge::ToSeeds(seedInput, seeds);
      }
      if (step.IsOk())
      {
        cdm::AdvancingFrontTetrahedralizerOptions options;
        options.CloseOpenBoundary = this->CloseOpenBoundary;
        options.MaximumNumberOfTetrahedra = this->MaximumNumberOfTetrahedra;
        step = cdm::TetrahedralizeByAdvancingFront(
          { &surface, &meshPoints, &seeds }, options, vtkCoreBridge::MakeContext(this), result);
        vtkCoreBridge::OffsetCells(step.Cells, vtkCoreBridge::GetFirstPolygon(input));
      }
      return step;
    });
  this->NumberOfRegions = result.Report.NumberOfRegions;
  this->NumberOfUnusedMeshPoints = result.Report.UnusedMeshPoints;
  this->NumberOfUnusedTriangles = static_cast<vtkIdType>(result.Report.UnusedTriangles.size());
  this->NumberOfTurnedDiagonals = result.Report.TurnedDiagonals;
  if (!status.IsOk() && !status.IsAborted())
  {
    // With seeds the points of a message may be seeds: then it names no coordinates.
    return vtkCoreBridge::ReportFailure(this, outputVector, status, seedInput ? nullptr : input);
  }

  // The partial mesh of an aborted run is worth keeping.
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkPolyData* boundary = vtkPolyData::GetData(outputVector, 1);
  vtkCoreBridge::FromTetMesh(result.Mesh, output);
  vtkCoreBridge::AppendTuples(input->GetPointData(),
    pointInput ? pointInput->GetPointData() : nullptr, result.MeshPointSources,
    output->GetPointData());
  vtkCoreBridge::FromTriangleMesh(result.Boundary, boundary);
  boundary->GetPointData()->ShallowCopy(output->GetPointData());
  vtkCoreBridge::CopyTriangleTuples(input, result.Boundary.SourceCells, boundary);
  vtkCoreBridge::FromFront(result.Front, result.Mesh.Points, vtkPolyData::GetData(outputVector, 2));
  if (status.IsAborted())
  {
    vtkConformingDelaunayCompatibility::KeepOutputsOfAbortedRun(this);
  }
  vtkCoreBridge::OffsetCells(result.Warnings, vtkCoreBridge::GetFirstPolygon(input));
  vtkCoreBridge::ReportWarnings(this, result.Warnings);
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkAdvancingFrontTetrahedralizer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CloseOpenBoundary: " << this->CloseOpenBoundary << "\n";
  os << indent << "MaximumNumberOfTetrahedra: " << this->MaximumNumberOfTetrahedra << "\n";
  os << indent << "NumberOfRegions: " << this->NumberOfRegions << "\n";
  os << indent << "NumberOfUnusedMeshPoints: " << this->NumberOfUnusedMeshPoints << "\n";
  os << indent << "NumberOfUnusedTriangles: " << this->NumberOfUnusedTriangles << "\n";
  os << indent << "NumberOfTurnedDiagonals: " << this->NumberOfTurnedDiagonals << "\n";
}
