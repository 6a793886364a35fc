// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Reports.h"

#include "CoreBridge/ArrayNames.h"

#include <vtkAlgorithm.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkInformationVector.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <functional>
#include <sstream>
#include <string>

namespace
{
constexpr std::size_t NamedIds = 10;

/** Triangles that a stage made by itself have no cell to name. */
void DropNoId(std::vector<cdm::Id>& ids)
{
  ids.erase(std::remove(ids.begin(), ids.end(), cdm::NoId), ids.end());
}

std::string ListIds(const char* what, const std::vector<vtkIdType>& ids,
  const std::function<void(std::ostream&, vtkIdType)>& describe)
{
  if (ids.empty())
  {
    return {};
  }
  std::ostringstream text;
  text.precision(17);
  text << ' ' << what << ": ";
  for (std::size_t i = 0; i < std::min(ids.size(), NamedIds); ++i)
  {
    text << (i ? ", " : "") << ids[i];
    describe(text, ids[i]);
  }
  text << (ids.size() > NamedIds ? ", ..." : "") << " (" << ids.size() << " in all).";
  return text.str();
}

std::string Describe(const cdm::Status& status, vtkDataSet* input)
{
  std::vector<vtkIdType> cells(status.Cells.begin(), status.Cells.end());
  vtkDataArray* names =
    input ? input->GetCellData()->GetArray(vtkCoreBridge::InputCellName) : nullptr;
  if (names)
  {
    for (vtkIdType& cell : cells)
    {
      cell = static_cast<vtkIdType>(names->GetComponent(cell, 0));
    }
  }
  const std::vector<vtkIdType> points(status.Points.begin(), status.Points.end());
  auto writePosition = [input](std::ostream& text, vtkIdType point)
  {
    if (input && point < input->GetNumberOfPoints())
    {
      double x[3];
      input->GetPoint(point, x);
      text << " (" << x[0] << ", " << x[1] << ", " << x[2] << ')';
    }
  };
  const bool isBug = status.Code == cdm::StatusCode::InternalError;
  return (isBug ? "Internal error, please report it: " : "") + status.Message +
    vtkCoreBridge::ListCells(std::move(cells)) + ListIds("Points", points, writePosition);
}
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
int ReportFailure(
  vtkAlgorithm* filter, vtkInformationVector* outputs, const cdm::Status& status, vtkDataSet* input)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
  if (status.IsAborted())
  {
    return 1;
  }
  ReportError(filter, status, input);
  return 0;
}

//--------------------------------------------------------------------------------------------------
void ReportError(vtkAlgorithm* filter, const cdm::Status& status, vtkDataSet* input)
{
  const std::string text = Describe(status, input);
  vtkErrorWithObjectMacro(filter, << text);
}

//--------------------------------------------------------------------------------------------------
std::string ListCells(std::vector<vtkIdType> cells)
{
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return ListIds("Cells", cells, [](std::ostream&, vtkIdType) {});
}

//--------------------------------------------------------------------------------------------------
void OffsetCells(cdm::Status& status, vtkIdType offset)
{
  DropNoId(status.Cells);
  for (cdm::Id& cell : status.Cells)
  {
    cell = static_cast<cdm::Id>(cell + offset);
  }
}

//--------------------------------------------------------------------------------------------------
void MapCells(cdm::Status& status, const std::vector<vtkIdType>& cells)
{
  DropNoId(status.Cells);
  for (cdm::Id& cell : status.Cells)
  {
    cell = static_cast<cdm::Id>(cells[cell]);
  }
  // The triangles of one strip are one cell.
  status.Cells.erase(std::unique(status.Cells.begin(), status.Cells.end()), status.Cells.end());
}

//--------------------------------------------------------------------------------------------------
vtkIdType GetFirstPolygon(vtkPolyData* surface)
{
  return surface->GetNumberOfVerts() + surface->GetNumberOfLines();
}
} // namespace vtkCoreBridge
