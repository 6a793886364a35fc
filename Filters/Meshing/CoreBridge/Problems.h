// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Problems.h
 * @brief Findings of the boundary triangulator as a data set to look at.
 */
#ifndef CoreBridge_Problems_h
#define CoreBridge_Problems_h

#include "Core/Meshes/PolygonSoup.h"
#include "Core/Repair/BoundaryTriangulator.h"

#include <vtkType.h>

#include <vector>

class vtkPolyData;

namespace vtkCoreBridge
{
/**
 * The polygons that have problems, and the segments and points where they are, with ProblemKind,
 * Cell and OtherCell.
 * @param cells VTK's cell for each polygon of the soup
 */
void FromProblems(const cdm::PolygonSoup& soup, const std::vector<vtkIdType>& cells,
  const std::vector<cdm::SurfaceProblem>& problems, vtkPolyData* output);
} // namespace vtkCoreBridge

#endif
