// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkStructureOutput.h
 * @brief The output of the sources of structures: polygons and their arrays.
 */
#ifndef vtkStructureOutput_h
#define vtkStructureOutput_h

#include "Core/Meshes/PolygonSoup.h"

#include <vector>

class vtkPolyData;

namespace vtkStructureOutput
{
/** Polygons with the cell arrays BoundaryLabels and FacetId. */
void SetPolygons(
  const cdm::PolygonSoup& boundary, const std::vector<cdm::Id>& facetIds, vtkPolyData* output);

/** A cell array of one integer for each polygon. */
void AddIds(const char* arrayName, const std::vector<cdm::Id>& ids, vtkPolyData* output);
} // namespace vtkStructureOutput

#endif
