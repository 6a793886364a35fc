// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Reports.h
 * @brief What is wrong, in the words of VTK's users: with ids of their cells and points.
 *
 * Status::Cells of an engine run count polygons; OffsetCells() and MapCells() turn them into ids of
 * VTK cells (which count vertices and lines before polygons).
 */
#ifndef CoreBridge_Reports_h
#define CoreBridge_Reports_h

#include "Core/Basics/Status.h"

#include <vtkType.h>

#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataSet;
class vtkInformationVector;
class vtkPolyData;

namespace vtkCoreBridge
{
/** Emit the error and empty all outputs; what RequestData has to return (1 after an abort). */
int ReportFailure(vtkAlgorithm* filter, vtkInformationVector* outputs, const cdm::Status& status,
  vtkDataSet* input);

/** Emit the error only, as writers do, which have no outputs. */
void ReportError(vtkAlgorithm* filter, const cdm::Status& status, vtkDataSet* input);

/** " Cells: 1, 2, ... (n in all).": the first ten of them; empty without cells. */
std::string ListCells(std::vector<vtkIdType> cells);

void OffsetCells(cdm::Status& status, vtkIdType offset);
void MapCells(cdm::Status& status, const std::vector<vtkIdType>& cells);

/** First cell of a vtkPolyData that is a polygon. */
vtkIdType GetFirstPolygon(vtkPolyData* surface);
} // namespace vtkCoreBridge

#endif
