// SPDX-License-Identifier: BSD-3-Clause
#include "Devices/vtkStructureOutput.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Outputs.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

namespace vtkStructureOutput
{
void SetPolygons(
  const cdm::PolygonSoup& boundary, const std::vector<cdm::Id>& facetIds, vtkPolyData* output)
{
  const vtkIdType numberOfPolygons = boundary.GetNumberOfPolygons();
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkIntArray> labels;
  labels->SetName(vtkCoreBridge::BoundaryLabelsName);
  labels->SetNumberOfComponents(2);
  labels->SetComponentName(0, "front");
  labels->SetComponentName(1, "back");
  labels->SetNumberOfTuples(numberOfPolygons);
  for (cdm::Id polygon = 0; polygon < numberOfPolygons; ++polygon)
  {
    polygons->InsertNextCell(boundary.GetPolygonSize(polygon));
    for (cdm::Id i = 0; i < boundary.GetPolygonSize(polygon); ++i)
    {
      polygons->InsertCellPoint(boundary.GetPolygon(polygon)[i]);
    }
    labels->SetTypedComponent(polygon, 0, boundary.Labels[polygon].Front);
    labels->SetTypedComponent(polygon, 1, boundary.Labels[polygon].Back);
  }
  output->SetPoints(vtkCoreBridge::FromPoints(boundary.Points));
  output->SetPolys(polygons);
  output->GetCellData()->AddArray(labels);
  AddIds("FacetId", facetIds, output);
}

void AddIds(const char* arrayName, const std::vector<cdm::Id>& ids, vtkPolyData* output)
{
  vtkNew<vtkIntArray> array;
  array->SetName(arrayName);
  for (const cdm::Id id : ids)
  {
    array->InsertNextValue(id);
  }
  output->GetCellData()->AddArray(array);
}
} // namespace vtkStructureOutput
