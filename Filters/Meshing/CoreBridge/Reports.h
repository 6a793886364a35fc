// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Reports.h
 * @brief What is wrong, in the words of VTK's users: with ids of their cells and points.
 *
 * Cells of a Status and of a Warning count polygons; OffsetCells() and MapCells() turn them into ids
 * of VTK cells (which count vertices and lines before polygons).
 */
#ifndef CoreBridge_Reports_h
#define CoreBridge_Reports_h

#include "Core/Basics/Status.h"
#include "Core/Basics/Warning.h"

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

/** The status with the cells and points named in its message, and no longer listed. */
cdm::Status SpellOut(cdm::Status status, vtkDataSet* input);

/** Emit the error only, as writers do, which have no outputs. */
void ReportError(vtkAlgorithm* filter, const cdm::Status& status, vtkDataSet* input);

/**
 * Emit warnings of a stage, each with the first of its cells.
 * @param prefix comes before each text
 */
void ReportWarnings(
  vtkAlgorithm* filter, const std::vector<cdm::Warning>& warnings, const std::string& prefix = {});

void OffsetCells(std::vector<cdm::Id>& cells, vtkIdType offset);
void MapCells(std::vector<cdm::Id>& cells, const std::vector<vtkIdType>& names);
void OffsetCells(std::vector<cdm::Warning>& warnings, vtkIdType offset);
void MapCells(std::vector<cdm::Warning>& warnings, const std::vector<vtkIdType>& names);

/** Warn of vertices and lines, which no stage uses. */
void WarnOfOtherCells(vtkAlgorithm* filter, vtkPolyData* input);

/** First cell of a vtkPolyData that is a polygon. */
vtkIdType GetFirstPolygon(vtkPolyData* surface);
} // namespace vtkCoreBridge

#endif
