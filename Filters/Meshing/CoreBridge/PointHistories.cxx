// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/PointHistories.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Tuples.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <numeric>

namespace
{
/** Data of the refined surface's points. */
void RefineTuples(const cdm::PointHistory& history, vtkPolyData* input, vtkPointData* output)
{
  vtkNew<vtkPointData> clean;
  vtkCoreBridge::InterpolateTuples(input->GetPointData(),
    { history.SurfaceSources.begin(), history.SurfaceSources.end() }, history.SurfacePoints,
    vtkCoreBridge::ParentIds::Input, clean);
  std::vector<vtkIdType> same(history.SurfaceSources.size() + history.SurfacePoints.size());
  std::iota(same.begin(), same.end(), 0);
  vtkCoreBridge::InterpolateTuples(
    clean, same, history.RefinedPoints, vtkCoreBridge::ParentIds::Output, output);
  if (vtkDataArray* isFree = output->GetArray(vtkCoreBridge::FreePointName))
  {
    for (auto p = static_cast<vtkIdType>(same.size()); p < isFree->GetNumberOfTuples(); ++p)
    {
      isFree->SetComponent(p, 0, 1.0);
    }
  }
}
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
void CarryPointData(const cdm::PointHistory& history, vtkPolyData* input, vtkPointSet* meshPoints,
  vtkUnstructuredGrid* output)
{
  vtkNew<vtkPointData> refined;
  RefineTuples(history, input, refined);
  vtkNew<vtkPointData> first;
  AppendTuples(
    refined, meshPoints ? meshPoints->GetPointData() : nullptr, history.MeshPointSources, first);
  if (!history.HasBefore)
  {
    output->GetPointData()->PassData(first);
    return;
  }
  vtkNew<vtkUnstructuredGrid> before;
  FromTetMesh(history.Before, before);
  before->GetPointData()->ShallowCopy(first);
  InterpolateTuplesInCells(before, history.Sources, output);
  if (vtkDataArray* isFree = first->GetArray(FreePointName))
  {
    // A property of the points, wherever they are; with Steiner points it is written anew.
    if (isFree->GetNumberOfTuples() == output->GetNumberOfPoints())
    {
      output->GetPointData()->AddArray(isFree);
    }
  }
}
} // namespace vtkCoreBridge
