// SPDX-License-Identifier: BSD-3-Clause
#include "vtkStructuralEdgeExtractor.h"

#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"

#include "Core/Surface/StructuralEdges.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

vtkStandardNewMacro(vtkStructuralEdgeExtractor);

//--------------------------------------------------------------------------------------------------
vtkStructuralEdgeExtractor::vtkStructuralEdgeExtractor()
{
  this->SetNumberOfOutputPorts(2);
}

//--------------------------------------------------------------------------------------------------
int vtkStructuralEdgeExtractor::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TriangleMesh surface;
  cdm::StructuralEdgesOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTriangleMesh(input, surface);
      if (step.IsOk())
      {
        cdm::StructuralEdgeOptions options;
        options.AccuracyAngle = this->AccuracyAngle;
        step =
          cdm::ExtractStructuralEdges(surface, options, vtkCoreBridge::MakeContext(this), result);
        vtkCoreBridge::OffsetCells(step.Cells, vtkCoreBridge::GetFirstPolygon(input));
      }
      return step;
    });
  this->NumberOfChains = result.NumberOfChains;
  this->NumberOfCorners = static_cast<vtkIdType>(result.Corners.size());
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }

  vtkPolyData::GetData(outputVector, 0)->ShallowCopy(input);
  vtkCoreBridge::FromStructuralEdges(result.Edges, input, vtkPolyData::GetData(outputVector, 1));
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkStructuralEdgeExtractor::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "AccuracyAngle: " << this->AccuracyAngle << "\n";
  os << indent << "NumberOfChains: " << this->NumberOfChains << "\n";
  os << indent << "NumberOfCorners: " << this->NumberOfCorners << "\n";
}
