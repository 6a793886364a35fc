// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Reports.h"

#include <vtkAlgorithm.h>
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

/** " Cells: 1, 2, ... (n in all).": the first ten, ascending; empty without cells. */
std::string ListCells(const std::vector<cdm::Id>& cells)
{
  std::vector<vtkIdType> ids(cells.begin(), cells.end());
  std::sort(ids.begin(), ids.end());
  // The triangles of one strip are one cell.
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ListIds("Cells", ids, [](std::ostream&, vtkIdType) {});
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
cdm::Status SpellOut(cdm::Status status, vtkDataSet* input)
{
  const auto writePosition = [input](std::ostream& text, vtkIdType point)
  {
    if (input && point < input->GetNumberOfPoints())
    {
      double x[3];
      input->GetPoint(point, x);
      text << " (" << x[0] << ", " << x[1] << ", " << x[2] << ')';
    }
  };
  const std::vector<vtkIdType> points(status.Points.begin(), status.Points.end());
  status.Message += ListCells(status.Cells) + ListIds("Points", points, writePosition);
  status.Cells.clear();
  status.Points.clear();
  return status;
}

//--------------------------------------------------------------------------------------------------
void ReportError(vtkAlgorithm* filter, const cdm::Status& status, vtkDataSet* input)
{
  const bool isBug = status.Code == cdm::StatusCode::InternalError;
  const std::string text =
    (isBug ? "Internal error, please report it: " : "") + SpellOut(status, input).Message;
  vtkErrorWithObjectMacro(filter, << text);
}

//--------------------------------------------------------------------------------------------------
void ReportWarnings(
  vtkAlgorithm* filter, const std::vector<cdm::Warning>& warnings, const std::string& prefix)
{
  for (const cdm::Warning& warning : warnings)
  {
    const std::string text = prefix + warning.Message + ListCells(warning.Cells);
    vtkWarningWithObjectMacro(filter, << text);
  }
}

//--------------------------------------------------------------------------------------------------
void OffsetCells(std::vector<cdm::Id>& cells, vtkIdType offset)
{
  DropNoId(cells);
  for (cdm::Id& cell : cells)
  {
    cell = static_cast<cdm::Id>(cell + offset);
  }
}

//--------------------------------------------------------------------------------------------------
void MapCells(std::vector<cdm::Id>& cells, const std::vector<vtkIdType>& names)
{
  DropNoId(cells);
  for (cdm::Id& cell : cells)
  {
    cell = static_cast<cdm::Id>(names[cell]);
  }
}

//--------------------------------------------------------------------------------------------------
void OffsetCells(std::vector<cdm::Warning>& warnings, vtkIdType offset)
{
  for (cdm::Warning& warning : warnings)
  {
    OffsetCells(warning.Cells, offset);
  }
}

//--------------------------------------------------------------------------------------------------
void MapCells(std::vector<cdm::Warning>& warnings, const std::vector<vtkIdType>& names)
{
  for (cdm::Warning& warning : warnings)
  {
    MapCells(warning.Cells, names);
  }
}

//--------------------------------------------------------------------------------------------------
void WarnOfOtherCells(vtkAlgorithm* filter, vtkPolyData* input)
{
  if (GetFirstPolygon(input) > 0)
  {
    vtkWarningWithObjectMacro(filter,
      "Ignored " << input->GetNumberOfVerts() << " vertex cells and " << input->GetNumberOfLines()
                 << " lines of the input: only polygons and strips are used.");
  }
}

//--------------------------------------------------------------------------------------------------
vtkIdType GetFirstPolygon(vtkPolyData* surface)
{
  return surface->GetNumberOfVerts() + surface->GetNumberOfLines();
}
} // namespace vtkCoreBridge
