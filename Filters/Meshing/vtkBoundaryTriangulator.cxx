// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBoundaryTriangulator.h"

#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Problems.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"

#include "Core/Repair/BoundaryTriangulator.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

vtkStandardNewMacro(vtkBoundaryTriangulator);

//--------------------------------------------------------------------------------------------------
vtkBoundaryTriangulator::vtkBoundaryTriangulator()
{
  this->SetNumberOfOutputPorts(2);
}

//--------------------------------------------------------------------------------------------------
int vtkBoundaryTriangulator::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, 0);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }
  vtkCoreBridge::WarnOfOtherCells(this, input);

  cdm::PolygonSoup soup;
  std::vector<vtkIdType> cells;
  cdm::BoundaryTriangulatorOutput result;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToPolygonSoup(input, soup, cells);
      if (step.IsOk())
      {
        cdm::BoundaryTriangulatorOptions options;
        options.MergeTolerance = this->MergeTolerance;
        options.MaximumGapEdges = this->MaximumGapEdges;
        options.RefuseSelfIntersections = this->RefuseSelfIntersections;
        options.ResolveSelfIntersections = this->ResolveSelfIntersections;
        options.Pieces =
          this->KeepInternalPieces ? cdm::ResolvedPieces::All : cdm::ResolvedPieces::OutsideOnly;
        step = cdm::TriangulateBoundary(soup, options, vtkCoreBridge::MakeContext(this), result);
        vtkCoreBridge::MapCells(step.Cells, cells);
      }
      return step;
    });

  this->TakeReport(result.Report);
  int success = 1;
  if (status.IsOk())
  {
    vtkCoreBridge::FromTriangleMesh(result.Surface, output);
    std::vector<vtkIdType> sources;
    for (cdm::Id polygon : result.Surface.SourceCells)
    {
      sources.push_back(polygon == cdm::NoId ? -1 : cells[polygon]);
    }
    vtkCoreBridge::CopyCellTuples(input, sources, output);
    vtkCoreBridge::InterpolateTuples(input->GetPointData(),
      { result.PointSources.begin(), result.PointSources.end() }, result.NewPoints,
      vtkCoreBridge::ParentIds::Input, output->GetPointData());
    vtkCoreBridge::MapCells(result.Warnings, cells);
    vtkCoreBridge::ReportWarnings(this, result.Warnings);
  }
  else
  {
    success = vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }
  if (!status.IsAborted())
  {
    vtkCoreBridge::FromProblems(
      soup, cells, result.Problems, vtkPolyData::GetData(outputVector, 1));
  }
  return success;
}

//--------------------------------------------------------------------------------------------------
void vtkBoundaryTriangulator::TakeReport(const cdm::BoundaryTriangulatorReport& report)
{
  this->NumberOfMergedPoints = report.MergedPoints;
  this->NumberOfUnusedPoints = report.UnusedPoints;
  this->NumberOfRepeatedVertices = report.RepeatedVertices;
  this->NumberOfDegeneratePolygons = report.DegeneratePolygons;
  this->NumberOfDuplicatePolygons = report.DuplicatePolygons;
  this->NumberOfTJunctions = report.TJunctions;
  this->NumberOfNonPlanarPolygons = report.NonPlanarPolygons;
  this->NumberOfPatchedRings = report.PatchedRings;
  this->NumberOfOpenEdges = report.OpenEdges;
  this->NumberOfNonManifoldEdges = report.NonManifoldEdges;
  this->NumberOfReversedPolygons = report.ReversedPolygons;
  this->NumberOfSelfIntersections = report.SelfIntersections;
}

//--------------------------------------------------------------------------------------------------
void vtkBoundaryTriangulator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MergeTolerance: " << this->MergeTolerance << "\n";
  os << indent << "MaximumGapEdges: " << this->MaximumGapEdges << "\n";
  os << indent << "RefuseSelfIntersections: " << this->RefuseSelfIntersections << "\n";
  os << indent << "ResolveSelfIntersections: " << this->ResolveSelfIntersections << "\n";
  os << indent << "KeepInternalPieces: " << this->KeepInternalPieces << "\n";
  os << indent << "NumberOfMergedPoints: " << this->NumberOfMergedPoints << "\n";
  os << indent << "NumberOfUnusedPoints: " << this->NumberOfUnusedPoints << "\n";
  os << indent << "NumberOfRepeatedVertices: " << this->NumberOfRepeatedVertices << "\n";
  os << indent << "NumberOfDegeneratePolygons: " << this->NumberOfDegeneratePolygons << "\n";
  os << indent << "NumberOfDuplicatePolygons: " << this->NumberOfDuplicatePolygons << "\n";
  os << indent << "NumberOfTJunctions: " << this->NumberOfTJunctions << "\n";
  os << indent << "NumberOfNonPlanarPolygons: " << this->NumberOfNonPlanarPolygons << "\n";
  os << indent << "NumberOfPatchedRings: " << this->NumberOfPatchedRings << "\n";
  os << indent << "NumberOfOpenEdges: " << this->NumberOfOpenEdges << "\n";
  os << indent << "NumberOfNonManifoldEdges: " << this->NumberOfNonManifoldEdges << "\n";
  os << indent << "NumberOfReversedPolygons: " << this->NumberOfReversedPolygons << "\n";
  os << indent << "NumberOfSelfIntersections: " << this->NumberOfSelfIntersections << "\n";
}
