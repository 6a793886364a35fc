// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Outputs.h
 * @brief Meshes of the engine as VTK's data sets.
 */
#ifndef CoreBridge_Outputs_h
#define CoreBridge_Outputs_h

#include "CoreBridge/Execution.h"

#include "Core/Improvement/SteinerPointRefiner.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/StructuralEdges.h"

#include <vtkCellArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <vector>

class vtkDataSetAttributes;
class vtkPoints;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkCoreBridge
{
/** Cells with the same number of points: getPoint(i, j) is point j of cell i. */
template <typename Function>
vtkSmartPointer<vtkCellArray> MakeCells(std::size_t count, int size, const Function& getPoint)
{
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(count) + 1);
  vtkNew<vtkIdTypeArray> points;
  points->SetNumberOfValues(size * static_cast<vtkIdType>(count));
  vtkIdType* const offset = offsets->GetPointer(0);
  vtkIdType* const point = points->GetPointer(0);
  offset[0] = 0;
  ForEach(count,
    [&](std::size_t i)
    {
      offset[i + 1] = size * (static_cast<vtkIdType>(i) + 1);
      for (int j = 0; j < size; ++j)
      {
        point[size * i + j] = getPoint(i, j);
      }
    });
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, points);
  return cells;
}

/** An array of one component. */
template <typename Array, typename Function>
vtkSmartPointer<Array> MakeArray(const char* name, std::size_t count, const Function& getValue)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(count));
  auto* const values = array->GetPointer(0);
  ForEach(count, [&](std::size_t i) { values[i] = getValue(i); });
  return array;
}

vtkSmartPointer<vtkPoints> FromPoints(const std::vector<cdm::Vec3>& points);

/** Points, triangles and, if there are any, labels. */
void FromTriangleMesh(const cdm::TriangleMesh& surface, vtkPolyData* output);

/** Points, tetrahedra and RegionId. */
void FromTetMesh(const cdm::TetMesh& mesh, vtkUnstructuredGrid* output);

/** Cell array StructuralFacetId: one value for each triangle. */
void FromFacets(const std::vector<cdm::Id>& facets, vtkPolyData* output);

/** Cell array Unresolved: 1 for the triangles given, 0 for the others. */
void FromUnresolved(const std::vector<cdm::Id>& triangles, vtkPolyData* output);

/** An array of 0 and 1. */
void FromFlags(const char* name, const std::vector<char>& flags, vtkDataSetAttributes* output);

/** Cell array RefinementFault, if there are any faults. */
void FromFaults(const std::vector<cdm::SteinerFault>& faults, vtkUnstructuredGrid* output);

/**
 * Lines with Kind, DihedralAngle and ChainId, on the points of the surface that they use. The
 * points have their point data and SurfacePointId.
 */
void FromStructuralEdges(
  const std::vector<cdm::StructuralEdge>& edges, vtkPolyData* surface, vtkPolyData* output);

/** A triangle for each front facet on the points that are used. */
void FromFront(const std::vector<cdm::TriangleIds>& front, const std::vector<cdm::Vec3>& points,
  vtkPolyData* output);

/** A vertex cell for each point, with the data of the points sources[i] of the input. */
void FromKeptPoints(vtkPointSet* input, const std::vector<cdm::Id>& sources, vtkPolyData* output);
} // namespace vtkCoreBridge

#endif
