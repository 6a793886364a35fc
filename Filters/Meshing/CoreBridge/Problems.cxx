// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Problems.h"

#include "vtkBoundaryTriangulator.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <set>
#include <tuple>

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
    const int kind = static_cast<int>(problem.Kind);
    if (problem.SegmentBegin == problem.SegmentEnd)
    {
      const vtkIdType id = this->AddPoint(problem.SegmentBegin);
      this->AddCell(this->Vertices, 1, &id, kind, problem.Cell, problem.OtherCell);
    }
    else
    {
      const vtkIdType ids[2] = { this->AddPoint(problem.SegmentBegin),
        this->AddPoint(problem.SegmentEnd) };
      this->AddCell(this->Lines, 2, ids, kind, problem.Cell, problem.OtherCell);
    }
    // Self-intersections are lines on polygons, which would hide them in the same color.
    const int polygonKind = problem.Kind == cdm::SurfaceProblemKind::SelfIntersection
      ? vtkBoundaryTriangulator::IntersectingPolygon
      : kind;
    this->AddPolygon(polygonKind, problem.Cell, problem.OtherCell);
    this->AddPolygon(polygonKind, problem.OtherCell, problem.Cell);
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

  Key MakeKey(int kind, cdm::Id cell, cdm::Id otherCell) const
  {
    return { kind, cell == cdm::NoId ? -1 : this->SourceCells[cell],
      otherCell == cdm::NoId ? -1 : this->SourceCells[otherCell] };
  }

  void AddCell(CellGroup& group, vtkIdType size, const vtkIdType* ids, int kind, cdm::Id cell,
    cdm::Id otherCell)
  {
    group.Cells->InsertNextCell(size, ids);
    group.Keys.push_back(this->MakeKey(kind, cell, otherCell));
  }

  void AddPolygon(int kind, cdm::Id cell, cdm::Id otherCell)
  {
    // A polygon has one cell for all the problems of a kind that it has with another one.
    if (cell == cdm::NoId || !this->Known.insert({ kind, cell, otherCell }).second)
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
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
void FromProblems(const cdm::PolygonSoup& soup, const std::vector<vtkIdType>& cells,
  const std::vector<cdm::SurfaceProblem>& problems, vtkPolyData* output)
{
  ProblemCollector collector(soup, cells);
  for (const cdm::SurfaceProblem& problem : problems)
  {
    collector.Add(problem);
  }
  collector.Finish(output);
}
} // namespace vtkCoreBridge
