// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBoundaryTriangulator.h"

#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"

#include "Core/Surface/BoundaryTriangulator.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <set>
#include <string>
#include <tuple>

vtkStandardNewMacro(vtkBoundaryTriangulator);

namespace
{
/**
 * Collects the cells of output port 1. vtkPolyData numbers vertices before lines before polygons,
 * so the values of the cell arrays are kept apart until the end.
 */
class ProblemCollector
{
public:
  ProblemCollector(const cdm::PolygonSoup& soup, const std::vector<vtkIdType>& cells)
    : Soup(soup), SourceCells(cells)
  {
    this->Points->SetDataTypeToDouble();
  }

  void Add(const cdm::SurfaceProblem& problem)
  {
    if (problem.SegmentBegin == problem.SegmentEnd)
    {
      const vtkIdType id = this->AddPoint(problem.SegmentBegin);
      this->AddCell(this->Vertices, 1, &id, problem.Kind, problem.Cell, problem.OtherCell);
    }
    else
    {
      const vtkIdType ids[2] = { this->AddPoint(problem.SegmentBegin),
        this->AddPoint(problem.SegmentEnd) };
      this->AddCell(this->Lines, 2, ids, problem.Kind, problem.Cell, problem.OtherCell);
    }
    this->AddPolygon(problem.Kind, problem.Cell, problem.OtherCell);
    this->AddPolygon(problem.Kind, problem.OtherCell, problem.Cell);
  }

  void Finish(vtkPolyData* output)
  {
    vtkNew<vtkIntArray> kinds;
    kinds->SetName("ProblemKind");
    vtkNew<vtkIdTypeArray> cells;
    cells->SetName("Cell");
    vtkNew<vtkIdTypeArray> otherCells;
    otherCells->SetName("OtherCell");
    for (const CellGroup* group : { &this->Vertices, &this->Lines, &this->Polygons })
    {
      for (const Key& key : group->Keys)
      {
        kinds->InsertNextValue(std::get<0>(key));
        cells->InsertNextValue(std::get<1>(key));
        otherCells->InsertNextValue(std::get<2>(key));
      }
    }
    output->SetPoints(this->Points);
    output->SetVerts(this->Vertices.Cells);
    output->SetLines(this->Lines.Cells);
    output->SetPolys(this->Polygons.Cells);
    output->GetCellData()->SetScalars(kinds);
    output->GetCellData()->AddArray(cells);
    output->GetCellData()->AddArray(otherCells);
  }

private:
  /** Kind, cell and other cell. */
  using Key = std::tuple<int, vtkIdType, vtkIdType>;
  struct CellGroup
  {
    vtkNew<vtkCellArray> Cells;
    std::vector<Key> Keys;
  };

  vtkIdType AddPoint(const cdm::Vec3& point)
  {
    return this->Points->InsertNextPoint(point.X, point.Y, point.Z);
  }

  Key MakeKey(cdm::SurfaceProblemKind kind, cdm::Id cell, cdm::Id otherCell) const
  {
    return { static_cast<int>(kind), cell == cdm::NoId ? -1 : this->SourceCells[cell],
      otherCell == cdm::NoId ? -1 : this->SourceCells[otherCell] };
  }

  void AddCell(CellGroup& group, vtkIdType size, const vtkIdType* ids, cdm::SurfaceProblemKind kind,
    cdm::Id cell, cdm::Id otherCell)
  {
    group.Cells->InsertNextCell(size, ids);
    group.Keys.push_back(this->MakeKey(kind, cell, otherCell));
  }

  void AddPolygon(cdm::SurfaceProblemKind kind, cdm::Id cell, cdm::Id otherCell)
  {
    // A polygon has one cell for all the problems of a kind that it has with another one.
    if (cell == cdm::NoId ||
      !this->Known.insert({ static_cast<int>(kind), cell, otherCell }).second)
    {
      return;
    }
    std::vector<vtkIdType> ids;
    for (cdm::Id i = 0; i < this->Soup.GetPolygonSize(cell); ++i)
    {
      ids.push_back(this->AddPoint(this->Soup.Points[this->Soup.GetPolygon(cell)[i]]));
    }
    this->AddCell(
      this->Polygons, static_cast<vtkIdType>(ids.size()), ids.data(), kind, cell, otherCell);
  }

  const cdm::PolygonSoup& Soup;
  const std::vector<vtkIdType>& SourceCells;
  vtkNew<vtkPoints> Points;
  CellGroup Vertices;
  CellGroup Lines;
  CellGroup Polygons;
  std::set<std::tuple<int, cdm::Id, cdm::Id>> Known;
};

void WriteProblems(const cdm::PolygonSoup& soup, const std::vector<vtkIdType>& cells,
  const std::vector<cdm::SurfaceProblem>& problems, vtkPolyData* output)
{
  ProblemCollector collector(soup, cells);
  for (const cdm::SurfaceProblem& problem : problems)
  {
    collector.Add(problem);
  }
  collector.Finish(output);
}

/** One sentence for each kind of repair that dropped something, with its cells; empty for none. */
std::string DescribeRepairs(const cdm::PolygonSoup& soup, const std::vector<vtkIdType>& cells,
  const cdm::BoundaryTriangulatorOutput& result)
{
  std::vector<vtkIdType> repeating;
  for (cdm::Id polygon = 0; polygon < soup.GetNumberOfPolygons(); ++polygon)
  {
    const cdm::Id* ids = soup.GetPolygon(polygon);
    const cdm::Id size = soup.GetPolygonSize(polygon);
    for (cdm::Id i = 0; i < size; ++i)
    {
      if (ids[i] == ids[(i + 1) % size])
      {
        repeating.push_back(cells[polygon]);
      }
    }
  }
  std::vector<vtkIdType> degenerate;
  std::vector<vtkIdType> duplicate;
  for (const cdm::SurfaceProblem& problem : result.Problems)
  {
    if (problem.Kind == cdm::SurfaceProblemKind::DegeneratePolygon)
    {
      degenerate.push_back(cells[problem.Cell]);
    }
    else if (problem.Kind == cdm::SurfaceProblemKind::DuplicatePolygon)
    {
      duplicate.push_back(cells[problem.Cell]);
    }
  }
  std::string text;
  if (!repeating.empty())
  {
    text += " Dropped repeated points of polygons." + vtkCoreBridge::ListCells(repeating);
  }
  if (!degenerate.empty())
  {
    text += " Dropped polygons without area." + vtkCoreBridge::ListCells(degenerate);
  }
  if (!duplicate.empty())
  {
    text += " Dropped polygons that repeat others." + vtkCoreBridge::ListCells(duplicate);
  }
  return text;
}
} // namespace

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
  if (vtkCoreBridge::GetFirstPolygon(input) > 0)
  {
    vtkWarningMacro("Ignored " << input->GetNumberOfVerts() << " vertex cells and "
                               << input->GetNumberOfLines()
                               << " lines of the input: only polygons and strips are used.");
  }

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
        vtkCoreBridge::MapCells(step, cells);
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
    const std::string repairs = DescribeRepairs(soup, cells, result);
    if (!repairs.empty())
    {
      vtkWarningMacro("Repaired the input:" << repairs);
    }
  }
  else
  {
    success = vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }
  if (!status.IsAborted())
  {
    WriteProblems(soup, cells, result.Problems, vtkPolyData::GetData(outputVector, 1));
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
