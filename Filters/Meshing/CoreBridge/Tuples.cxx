// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Tuples.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Reports.h"

#include "Core/Meshes/TetrahedronWalk.h"

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace
{
/** The cells of a mesh of tetrahedra in which points of another one lie. */
class CellsOfPoints
{
public:
  /** Points with a source are left out. */
  CellsOfPoints(
    vtkUnstructuredGrid* input, const std::vector<cdm::Id>& sources, vtkUnstructuredGrid* output);

  /** The cell of a point, or the nearest one, and the weights of its points there. */
  void Get(vtkIdType point, vtkGenericCell* cell, double* weights) const;

private:
  /** A copy of its own: locators build caches in the data set that they search. */
  vtkNew<vtkUnstructuredGrid> Cells;
  vtkNew<vtkStaticCellLocator> Locator;
  vtkUnstructuredGrid* const Output;
  /** For each point of the output; NoId if it has a source, or was not found. */
  std::vector<cdm::Id> Found;
};

CellsOfPoints::CellsOfPoints(
  vtkUnstructuredGrid* input, const std::vector<cdm::Id>& sources, vtkUnstructuredGrid* output)
  : Output(output), Found(sources.size(), cdm::NoId)
{
  std::vector<cdm::Id> points;
  std::vector<cdm::Vec3> positions;
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    if (sources[i] == cdm::NoId)
    {
      double x[3];
      output->GetPoint(static_cast<vtkIdType>(i), x);
      points.push_back(static_cast<cdm::Id>(i));
      positions.push_back({ x[0], x[1], x[2] });
    }
  }
  cdm::TetMesh mesh;
  if (vtkCoreBridge::ToTetMesh(input, mesh).IsOk())
  {
    const std::vector<cdm::Id> cells =
      cdm::FindTetrahedra(mesh, positions, vtkCoreBridge::GetNumberOfThreads());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      this->Found[points[i]] = cells[i];
    }
  }
  this->Cells->ShallowCopy(input);
  if (std::any_of(points.begin(), points.end(),
        [this](cdm::Id point) { return this->Found[point] == cdm::NoId; }))
  {
    this->Locator->SetDataSet(this->Cells);
    this->Locator->BuildLocator();
  }
}

void CellsOfPoints::Get(vtkIdType point, vtkGenericCell* cell, double* weights) const
{
  double x[3];
  double nearest[3];
  double parametric[3];
  double distance2 = 0.0;
  int subId = 0;
  this->Output->GetPoint(point, x);
  vtkIdType found = this->Found[static_cast<std::size_t>(point)];
  if (found >= 0)
  {
    this->Cells->GetCell(found, cell);
    cell->EvaluatePosition(x, nullptr, subId, parametric, distance2, weights);
  }
  else if (this->Locator->FindCell(x, 0.0, cell, parametric, weights) < 0)
  {
    // On the boundary rounding decides whether a position is inside: the nearest cell is right. To
    // look for it takes ten times longer than for one that holds the position.
    this->Locator->FindClosestPoint(x, nearest, cell, found, subId, distance2);
    cell->EvaluatePosition(nearest, nullptr, subId, parametric, distance2, weights);
  }
}
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
void CopyTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  vtkDataSetAttributes* to, const std::vector<const char*>& except)
{
  // Apart from the output, which others would copy with the flags of CopyFieldOff().
  vtkNew<vtkDataSetAttributes> copied;
  for (const char* name : except)
  {
    copied->CopyFieldOff(name);
  }
  const auto count = static_cast<vtkIdType>(sources.size());
  copied->CopyAllocate(from, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (sources[i] >= 0)
    {
      copied->CopyData(from, sources[i], i);
    }
    else
    {
      copied->NullData(i);
    }
  }
  to->PassData(copied);
}

//--------------------------------------------------------------------------------------------------
void CopyCellTuples(vtkPolyData* from, const std::vector<vtkIdType>& sources, vtkPolyData* to)
{
  CopyTuples(from->GetCellData(), sources, to->GetCellData(), { BoundaryLabelsName });
}

//--------------------------------------------------------------------------------------------------
void CopyTriangleTuples(vtkPolyData* from, const std::vector<cdm::Id>& sources, vtkPolyData* to)
{
  const vtkIdType first = GetFirstPolygon(from);
  std::vector<vtkIdType> cells(sources.size());
  std::transform(sources.begin(), sources.end(), cells.begin(),
    [first](cdm::Id source) { return source == cdm::NoId ? -1 : first + source; });
  CopyCellTuples(from, cells, to);
}

//--------------------------------------------------------------------------------------------------
void InterpolateTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  const std::vector<cdm::PointParents>& newPoints, ParentIds parentIds, vtkDataSetAttributes* to)
{
  const auto count = static_cast<vtkIdType>(sources.size());
  vtkNew<vtkIdList> ids;
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* source = from->GetAbstractArray(i);
    const int attribute = from->IsArrayAnAttribute(i);
    if (attribute == vtkDataSetAttributes::GLOBALIDS ||
      attribute == vtkDataSetAttributes::PEDIGREEIDS)
    {
      continue;
    }
    auto target = vtk::TakeSmartPointer(source->NewInstance());
    target->SetName(source->GetName());
    target->SetNumberOfComponents(source->GetNumberOfComponents());
    target->CopyComponentNames(source);
    target->SetNumberOfTuples(count + static_cast<vtkIdType>(newPoints.size()));
    for (vtkIdType j = 0; j < count; ++j)
    {
      target->SetTuple(j, sources[j], source);
    }
    // Parents in the output may be new points themselves: the array is then its own source.
    vtkAbstractArray* parentArray = parentIds == ParentIds::Input ? source : target.Get();
    for (std::size_t j = 0; j < newPoints.size(); ++j)
    {
      const cdm::PointParents& parents = newPoints[j];
      const auto number = std::count_if(
        parents.Ids.begin(), parents.Ids.end(), [](cdm::Id id) { return id != cdm::NoId; });
      ids->SetNumberOfIds(number);
      std::copy_n(parents.Ids.begin(), number, ids->GetPointer(0));
      target->InterpolateTuple(count + static_cast<vtkIdType>(j), ids, parentArray,
        const_cast<double*>(parents.Weights.data()));
    }
    const int index = to->AddArray(target);
    if (attribute >= 0)
    {
      to->SetActiveAttribute(index, attribute);
    }
  }
}

//--------------------------------------------------------------------------------------------------
void InterpolateTuplesInCells(
  vtkUnstructuredGrid* input, const std::vector<cdm::Id>& sources, vtkUnstructuredGrid* output)
{
  vtkPointData* from = input->GetPointData();
  vtkPointData* to = output->GetPointData();
  to->CopyAllOff(vtkDataSetAttributes::INTERPOLATE);
  to->CopyAllOn(vtkDataSetAttributes::INTERPOLATE);
  to->SetCopyGlobalIds(0, vtkDataSetAttributes::INTERPOLATE);
  to->SetCopyPedigreeIds(0, vtkDataSetAttributes::INTERPOLATE);
  to->CopyFieldOff(FreePointName);
  const auto count = static_cast<vtkIdType>(sources.size());
  to->InterpolateAllocate(from, count);
  if (to->GetNumberOfArrays() == 0)
  {
    return;
  }
  const CellsOfPoints cells(input, sources, output);
  vtkNew<vtkGenericCell> cell;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (sources[i] != cdm::NoId)
    {
      to->CopyData(from, sources[i], i);
      continue;
    }
    double weights[4];
    cells.Get(i, cell, weights);
    to->InterpolatePoint(from, i, cell->GetPointIds(), weights);
  }
}

//--------------------------------------------------------------------------------------------------
void AppendTuples(vtkDataSetAttributes* first, vtkDataSetAttributes* second,
  const std::vector<cdm::Id>& sources, vtkDataSetAttributes* to)
{
  const bool hasSecond = second && !sources.empty();
  vtkDataSetAttributes::FieldList fields;
  fields.IntersectFieldList(first);
  if (hasSecond)
  {
    fields.IntersectFieldList(second);
  }
  const vtkIdType count = first->GetNumberOfTuples();
  fields.CopyAllocate(
    to, vtkDataSetAttributes::COPYTUPLE, count + static_cast<vtkIdType>(sources.size()), 0);
  for (vtkIdType i = 0; i < count; ++i)
  {
    fields.CopyData(0, first, i, to, i);
  }
  for (std::size_t i = 0; hasSecond && i < sources.size(); ++i)
  {
    fields.CopyData(1, second, sources[i], to, count + static_cast<vtkIdType>(i));
  }
}
} // namespace vtkCoreBridge
