// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointHistories.h
 * @brief Point data of the input at the points of a mesh that was made in one run.
 */
#ifndef CoreBridge_PointHistories_h
#define CoreBridge_PointHistories_h

#include "Core/Pipeline/ConformingMesher.h"

class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkCoreBridge
{
/**
 * Copies and interpolates point data as the stages do one after the other. Where mesh points are
 * given, the arrays are those that surface and mesh points have both.
 * @param meshPoints the given ones; may be null
 */
void CarryPointData(const cdm::PointHistory& history, vtkPolyData* input, vtkPointSet* meshPoints,
  vtkUnstructuredGrid* output);
} // namespace vtkCoreBridge

#endif
