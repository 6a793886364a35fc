// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Outputs.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Texts.h"
#include "CoreBridge/Tuples.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace
{
/** Numbers the points that are used in the order of their first use. */
class PointSelection
{
public:
  explicit PointSelection(std::size_t numberOfPoints) : NewIds(numberOfPoints, -1) {}
  vtkIdType Add(cdm::Id point)
  {
    if (this->NewIds[point] < 0)
    {
      this->NewIds[point] = static_cast<vtkIdType>(this->Sources.size());
      this->Sources.push_back(point);
    }
    return this->NewIds[point];
  }
  const std::vector<vtkIdType>& GetSources() const { return this->Sources; }

private:
  std::vector<vtkIdType> NewIds;
  std::vector<vtkIdType> Sources;
};
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkPoints> FromPoints(const std::vector<cdm::Vec3>& points)
{
  auto output = vtkSmartPointer<vtkPoints>::New();
  output->SetDataTypeToDouble();
  output->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  double* const coordinates = vtkDoubleArray::SafeDownCast(output->GetData())->GetPointer(0);
  ForEach(points.size(),
    [&](std::size_t i)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        coordinates[3 * i + axis] = points[i][axis];
      }
    });
  return output;
}

//--------------------------------------------------------------------------------------------------
void FromTriangleMesh(const cdm::TriangleMesh& surface, vtkPolyData* output)
{
  output->SetPoints(FromPoints(surface.Points));
  const auto count = static_cast<vtkIdType>(surface.Triangles.size());
  output->SetPolys(
    MakeCells(count, 3, [&](std::size_t i, int j) { return surface.Triangles[i][j]; }));
  if (!surface.Labels.empty())
  {
    vtkNew<vtkIntArray> labels;
    labels->SetName(BoundaryLabelsName);
    labels->SetNumberOfComponents(2);
    labels->SetNumberOfTuples(count);
    for (vtkIdType i = 0; i < count; ++i)
    {
      labels->SetTypedComponent(i, 0, surface.Labels[i].Front);
      labels->SetTypedComponent(i, 1, surface.Labels[i].Back);
    }
    output->GetCellData()->AddArray(labels);
  }
  EncodeNames(output->GetFieldData());
}

//--------------------------------------------------------------------------------------------------
void FromTetMesh(const cdm::TetMesh& mesh, vtkUnstructuredGrid* output)
{
  output->SetPoints(FromPoints(mesh.Points));
  const std::size_t count = mesh.Tetrahedra.size();
  output->SetCells(
    VTK_TETRA, MakeCells(count, 4, [&](std::size_t i, int j) { return mesh.Tetrahedra[i][j]; }));
  output->GetCellData()->SetScalars(
    MakeArray<vtkIntArray>(RegionIdName, count, [&](std::size_t i) { return mesh.Regions[i]; }));
  EncodeNames(output->GetFieldData());
}

//--------------------------------------------------------------------------------------------------
void FromFacets(const std::vector<cdm::Id>& facets, vtkPolyData* output)
{
  output->GetCellData()->AddArray(MakeArray<vtkIntArray>(
    StructuralFacetIdName, facets.size(), [&](std::size_t i) { return facets[i]; }));
}

//--------------------------------------------------------------------------------------------------
void FromUnresolved(const std::vector<cdm::Id>& triangles, vtkPolyData* output)
{
  std::vector<char> flags(static_cast<std::size_t>(output->GetNumberOfPolys()), 0);
  for (const cdm::Id triangle : triangles)
  {
    flags[triangle] = 1;
  }
  FromFlags("Unresolved", flags, output->GetCellData());
}

//--------------------------------------------------------------------------------------------------
void FromFlags(const char* name, const std::vector<char>& flags, vtkDataSetAttributes* output)
{
  output->AddArray(MakeArray<vtkUnsignedCharArray>(
    name, flags.size(), [&](std::size_t i) { return static_cast<unsigned char>(flags[i]); }));
}

//--------------------------------------------------------------------------------------------------
void FromFaults(const std::vector<cdm::SteinerFault>& faults, vtkUnstructuredGrid* output)
{
  if (std::any_of(faults.begin(), faults.end(),
        [](cdm::SteinerFault fault) { return fault != cdm::SteinerFault::None; }))
  {
    output->GetCellData()->AddArray(MakeArray<vtkUnsignedCharArray>("RefinementFault",
      faults.size(), [&](std::size_t i) { return static_cast<unsigned char>(faults[i]); }));
  }
}

//--------------------------------------------------------------------------------------------------
void FromStructuralEdges(
  const std::vector<cdm::StructuralEdge>& edges, vtkPolyData* surface, vtkPolyData* output)
{
  const auto count = static_cast<vtkIdType>(edges.size());
  vtkNew<vtkCellArray> lines;
  lines->AllocateExact(count, 2 * count);
  vtkNew<vtkIntArray> kinds;
  kinds->SetName("Kind");
  vtkNew<vtkDoubleArray> angles;
  angles->SetName("DihedralAngle");
  vtkNew<vtkIntArray> chains;
  chains->SetName("ChainId");
  PointSelection selection(surface->GetNumberOfPoints());
  for (const cdm::StructuralEdge& edge : edges)
  {
    const vtkIdType ids[2] = { selection.Add(edge.Points[0]), selection.Add(edge.Points[1]) };
    lines->InsertNextCell(2, ids);
    kinds->InsertNextValue(static_cast<int>(edge.Kind));
    angles->InsertNextValue(edge.DihedralAngle);
    chains->InsertNextValue(edge.Chain);
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> surfacePoints;
  surfacePoints->SetName(SurfacePointIdName);
  for (vtkIdType source : selection.GetSources())
  {
    points->InsertNextPoint(surface->GetPoint(source));
    surfacePoints->InsertNextValue(source);
  }
  output->SetPoints(points);
  output->SetLines(lines);
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ kinds.Get(), angles.Get(), chains.Get() })
  {
    output->GetCellData()->AddArray(array);
  }
  output->GetCellData()->SetScalars(kinds);
  CopyTuples(surface->GetPointData(), selection.GetSources(), output->GetPointData(),
    { SurfacePointIdName });
  output->GetPointData()->AddArray(surfacePoints);
}

//--------------------------------------------------------------------------------------------------
void FromFront(const std::vector<cdm::TriangleIds>& front, const std::vector<cdm::Vec3>& points,
  vtkPolyData* output)
{
  PointSelection selection(points.size());
  vtkNew<vtkCellArray> cells;
  for (const cdm::TriangleIds& triangle : front)
  {
    const vtkIdType ids[3] = { selection.Add(triangle[0]), selection.Add(triangle[1]),
      selection.Add(triangle[2]) };
    cells->InsertNextCell(3, ids);
  }
  std::vector<cdm::Vec3> used;
  for (vtkIdType source : selection.GetSources())
  {
    used.push_back(points[source]);
  }
  output->SetPoints(FromPoints(used));
  output->SetPolys(cells);
}

//--------------------------------------------------------------------------------------------------
void FromKeptPoints(vtkPointSet* input, const std::vector<cdm::Id>& sources, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  for (cdm::Id source : sources)
  {
    const vtkIdType id = points->InsertNextPoint(input->GetPoint(source));
    vertices->InsertNextCell(1, &id);
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
  if (input)
  {
    CopyTuples(input->GetPointData(), { sources.begin(), sources.end() }, output->GetPointData());
  }
}
} // namespace vtkCoreBridge
