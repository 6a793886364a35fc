// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMovingBoundaryRemesher.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Certificates.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"

#include "Core/Meshes/MeshBoundary.h"
#include "Core/MovingBoundary/MovingBoundaryRemesher.h"

#include <vtkCellData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <numeric>

vtkStandardNewMacro(vtkMovingBoundaryRemesher);

namespace
{
cdm::Status ToDisplacements(
  vtkUnstructuredGrid* input, vtkDataArray* array, std::vector<cdm::Vec3>& displacements)
{
  if (!array || array->GetNumberOfComponents() != 3 ||
    array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    return cdm::Status::InvalidInput(
      "The array to process has to be a point array with three components, the displacement of "
      "each point in model units: choose one (SetInputArrayToProcess).");
  }
  displacements.resize(array->GetNumberOfTuples());
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    double x[3];
    array->GetTuple(i, x);
    displacements[i] = { x[0], x[1], x[2] };
  }
  return {};
}

/** Data of all points that there ever were, new ones interpolated, then those of the mesh. */
void InterpolatePointData(
  vtkUnstructuredGrid* input, const cdm::MovingBoundaryOutput& result, vtkUnstructuredGrid* output)
{
  std::vector<vtkIdType> inputPoints(input->GetNumberOfPoints());
  std::iota(inputPoints.begin(), inputPoints.end(), 0);
  vtkNew<vtkPointData> all;
  vtkCoreBridge::InterpolateTuples(
    input->GetPointData(), inputPoints, result.NewPoints, vtkCoreBridge::ParentIds::Output, all);
  vtkCoreBridge::CopyTuples(
    all, { result.Origins.begin(), result.Origins.end() }, output->GetPointData());
}

void MakeBoundary(const cdm::TetMesh& mesh, vtkUnstructuredGrid* grid, vtkPolyData* output)
{
  cdm::TriangleMesh boundary = cdm::ExtractBoundary(mesh);
  const std::vector<cdm::Id> points = cdm::RemoveUnusedPoints(boundary);
  vtkCoreBridge::FromTriangleMesh(boundary, output);
  vtkCoreBridge::CopyTuples(
    grid->GetPointData(), { points.begin(), points.end() }, output->GetPointData());
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkMovingBoundaryRemesher::vtkMovingBoundaryRemesher()
{
  this->SetNumberOfOutputPorts(2);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::VECTORS);
}

//--------------------------------------------------------------------------------------------------
int vtkMovingBoundaryRemesher::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkMovingBoundaryRemesher::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkMovingBoundaryRemesher::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TetMesh mesh;
  std::vector<cdm::Vec3> displacements;
  cdm::MovingBoundaryOptions options;
  options.NumberOfSteps = this->NumberOfSteps;
  options.FollowRatio = this->FollowRatio;
  options.PointClearance = this->PointClearance;
  options.Refinement.Criterion = static_cast<cdm::SurfaceCriterion>(this->Criterion);
  options.Refinement.StructuralEdges.AccuracyAngle = this->AccuracyAngle;
  options.Refinement.MinimumAngle = this->MinimumAngle;
  options.Refinement.MaximumEdgeLength = this->MaximumEdgeLength;
  options.Refinement.MaximumNewPoints = this->MaximumNewPoints;
  options.Refinement.MaximumTime = this->MaximumTime;
  cdm::MovingBoundaryOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTetMesh(input, mesh);
      if (step.IsOk())
      {
        step = ToDisplacements(input, this->GetInputArrayToProcess(0, inputVector), displacements);
      }
      if (step.IsOk())
      {
        step = cdm::RemeshMovingBoundary(
          { &mesh, &displacements }, options, vtkCoreBridge::MakeContext(this), result);
      }
      return step;
    });
  this->NumberOfStepsTaken = result.Report.Steps;
  this->NumberOfTopologyChanges = result.Report.TopologyChanges;
  this->NumberOfRemovedPoints = result.Report.RemovedPoints;
  this->NumberOfNewPoints = result.Report.NewPoints;
  this->NumberOfUnresolvedTriangles = result.Report.UnresolvedTriangles;
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }

  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkCoreBridge::RemoveCertificate(output->GetFieldData());
  vtkCoreBridge::CopyTuples(input->GetCellData(),
    { result.TetrahedronSources.begin(), result.TetrahedronSources.end() }, output->GetCellData(),
    { vtkCoreBridge::RegionIdName });
  vtkCoreBridge::FromTetMesh(result.Mesh, output);
  InterpolatePointData(input, result, output);
  MakeBoundary(result.Mesh, output, vtkPolyData::GetData(outputVector, 1));
  if (this->NumberOfUnresolvedTriangles > 0)
  {
    vtkWarningMacro(<< this->NumberOfUnresolvedTriangles
                    << " triangles of the boundary do not fulfil the criterion.");
  }
  if (result.Report.PointsBeyondLimits > 0)
  {
    vtkWarningMacro(<< result.Report.PointsBeyondLimits
                    << " new points are beyond the limits (MaximumNewPoints, MaximumTime): there "
                       "is no mesh without them.");
  }
  if (result.Report.TooCoarse > 0)
  {
    vtkWarningMacro(<< result.Report.TooCoarse
                    << " triangles of the boundary are larger than asked for: a limit is reached "
                       "(MaximumNewPoints, MaximumTime).");
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkMovingBoundaryRemesher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfSteps: " << this->NumberOfSteps << "\n";
  os << indent << "FollowRatio: " << this->FollowRatio << "\n";
  os << indent << "PointClearance: " << this->PointClearance << "\n";
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "AccuracyAngle: " << this->AccuracyAngle << "\n";
  os << indent << "MinimumAngle: " << this->MinimumAngle << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MaximumNewPoints: " << this->MaximumNewPoints << "\n";
  os << indent << "MaximumTime: " << this->MaximumTime << "\n";
  os << indent << "NumberOfStepsTaken: " << this->NumberOfStepsTaken << "\n";
  os << indent << "NumberOfTopologyChanges: " << this->NumberOfTopologyChanges << "\n";
  os << indent << "NumberOfRemovedPoints: " << this->NumberOfRemovedPoints << "\n";
  os << indent << "NumberOfNewPoints: " << this->NumberOfNewPoints << "\n";
  os << indent << "NumberOfUnresolvedTriangles: " << this->NumberOfUnresolvedTriangles << "\n";
}
