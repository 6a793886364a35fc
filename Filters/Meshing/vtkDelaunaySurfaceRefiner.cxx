// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDelaunaySurfaceRefiner.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/SizingInputs.h"
#include "CoreBridge/Tuples.h"

#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <numeric>

vtkStandardNewMacro(vtkDelaunaySurfaceRefiner);

namespace
{
cdm::DelaunaySurfaceRefinerOptions MakeOptions(vtkDelaunaySurfaceRefiner* filter)
{
  cdm::DelaunaySurfaceRefinerOptions options;
  options.Criterion = static_cast<cdm::SurfaceCriterion>(filter->GetCriterion());
  options.StructuralEdges.AccuracyAngle = filter->GetAccuracyAngle();
  options.StructuralEdges.FlatnessRatio = filter->GetFlatnessRatio();
  options.MinimumAngle = filter->GetMinimumAngle();
  options.MaximumArea = filter->GetMaximumArea();
  options.MaximumEdgeLength = filter->GetMaximumEdgeLength();
  options.MeshPointClearanceRatio = filter->GetMeshPointClearanceRatio();
  options.MinimumEdgeRatio = filter->GetMinimumEdgeRatio();
  options.MaximumNewPoints = filter->GetMaximumNewPoints();
  options.MaximumTime = filter->GetMaximumTime();
  return options;
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkDelaunaySurfaceRefiner::vtkDelaunaySurfaceRefiner()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(3);
}

//--------------------------------------------------------------------------------------------------
int vtkDelaunaySurfaceRefiner::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillInputPortInformation(port, info);
  }
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 1 ? "vtkPointSet" : "vtkDataSet");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkDelaunaySurfaceRefiner::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPointSet* pointInput = vtkPointSet::GetData(inputVector[1]);
  vtkDataSet* sizingInput = vtkDataSet::GetData(inputVector[2]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TriangleMesh surface;
  std::vector<cdm::Vec3> meshPoints;
  cdm::DelaunaySurfaceRefinerInput engineInput{ &surface, &meshPoints, {} };
  cdm::DelaunaySurfaceRefinerOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTriangleMesh(input, surface);
      if (step.IsOk() && pointInput)
      {
        step = vtkCoreBridge::ToPoints(pointInput, "mesh points", meshPoints);
      }
      if (step.IsOk() && sizingInput)
      {
        step = vtkCoreBridge::ToSizing(sizingInput, engineInput.Sizing);
      }
      cdm::DelaunaySurfaceRefinerOptions options = MakeOptions(this);
      if (step.IsOk())
      {
        step = vtkCoreBridge::ToFacets(input, options.StructuralEdges.Facets);
      }
      if (step.IsOk())
      {
        step = cdm::RefineDelaunaySurface(
          engineInput, options, vtkCoreBridge::MakeContext(this), result);
        vtkCoreBridge::OffsetCells(step.Cells, vtkCoreBridge::GetFirstPolygon(input));
      }
      return step;
    });
  this->NumberOfEdgePoints = result.Report.EdgePoints;
  this->NumberOfFacetPoints = result.Report.FacetPoints;
  this->NumberOfFlips = result.Report.Flips;
  this->NumberOfDroppedMeshPoints = result.Report.DroppedMeshPoints;
  this->NumberOfUnresolvedTriangles = static_cast<vtkIdType>(result.UnresolvedTriangles.size());
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }

  vtkPolyData* output = vtkPolyData::GetData(outputVector, 0);
  vtkCoreBridge::FromTriangleMesh(result.Surface, output);
  vtkCoreBridge::CopyTriangleTuples(input, result.Surface.SourceCells, output);
  vtkCoreBridge::FromFacets(
    cdm::NumberFacets(cdm::SortEdgeUses(result.Surface.Triangles, result.Surface.Points.size()),
      result.StructuralEdges),
    output);
  std::vector<vtkIdType> inputPoints(surface.Points.size());
  std::iota(inputPoints.begin(), inputPoints.end(), 0);
  vtkCoreBridge::InterpolateTuples(input->GetPointData(), inputPoints, result.NewPoints,
    vtkCoreBridge::ParentIds::Output, output->GetPointData());
  if (vtkDataArray* isFree = output->GetPointData()->GetArray(vtkCoreBridge::FreePointName))
  {
    for (vtkIdType p = input->GetNumberOfPoints(); p < output->GetNumberOfPoints(); ++p)
    {
      isFree->SetComponent(p, 0, 1.0);
    }
  }
  vtkCoreBridge::FromStructuralEdges(
    result.StructuralEdges, output, vtkPolyData::GetData(outputVector, 1));
  vtkCoreBridge::FromKeptPoints(
    pointInput, result.KeptMeshPoints, vtkPolyData::GetData(outputVector, 2));
  if (this->NumberOfUnresolvedTriangles > 0)
  {
    vtkCoreBridge::FromUnresolved(result.UnresolvedTriangles, output);
  }
  vtkCoreBridge::OffsetCells(result.Warnings, vtkCoreBridge::GetFirstPolygon(input));
  vtkCoreBridge::ReportWarnings(this, result.Warnings);
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkDelaunaySurfaceRefiner::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Criterion: " << this->Criterion << "\n";
  os << indent << "AccuracyAngle: " << this->AccuracyAngle << "\n";
  os << indent << "FlatnessRatio: " << this->FlatnessRatio << "\n";
  os << indent << "MinimumAngle: " << this->MinimumAngle << "\n";
  os << indent << "MaximumArea: " << this->MaximumArea << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MeshPointClearanceRatio: " << this->MeshPointClearanceRatio << "\n";
  os << indent << "MinimumEdgeRatio: " << this->MinimumEdgeRatio << "\n";
  os << indent << "MaximumNewPoints: " << this->MaximumNewPoints << "\n";
  os << indent << "MaximumTime: " << this->MaximumTime << "\n";
  os << indent << "NumberOfEdgePoints: " << this->NumberOfEdgePoints << "\n";
  os << indent << "NumberOfFacetPoints: " << this->NumberOfFacetPoints << "\n";
  os << indent << "NumberOfFlips: " << this->NumberOfFlips << "\n";
  os << indent << "NumberOfDroppedMeshPoints: " << this->NumberOfDroppedMeshPoints << "\n";
  os << indent << "NumberOfUnresolvedTriangles: " << this->NumberOfUnresolvedTriangles << "\n";
}
