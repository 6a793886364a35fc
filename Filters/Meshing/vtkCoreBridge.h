// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkCoreBridge.h
 * @brief The one place where VTK's data sets and the engine's meshes are turned into each other.
 *
 * Private to this module. Conventions:
 *  - a conversion from VTK checks what the engine takes for granted (ids in range, 32 bits, array
 *    types), and says in its Status what is wrong, with the ids of VTK cells and points;
 *  - Status::Cells of an engine run count polygons; OffsetCells() and MapCells() turn them into ids
 *    of VTK cells (which count vertices and lines before polygons);
 *  - a source id of -1 means "none": the tuple made for it is zero, or the empty string.
 */
#ifndef vtkCoreBridge_h
#define vtkCoreBridge_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/PolygonSoup.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Sizing/SizingField.h"
#include "Core/Surface/StructuralEdges.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <vtkCellArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataSet;
class vtkDataSetAttributes;
class vtkInformationVector;
class vtkPoints;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkCoreBridge
{
/** Cell array: region ids on the front and on the back side of a polygon. */
constexpr const char* BoundaryLabelsName = "BoundaryLabels";
/** Cell array of tetrahedra, point array of seeds. */
constexpr const char* RegionIdName = "RegionId";
/** Point array of the sizing input: a length, one for each axis, or a tensor. */
constexpr const char* SizingName = "Sizing";
/** Point array: not 0 for points that may be moved. */
constexpr const char* FreePointName = "FreePoint";
/** Point array of structural edges: ids of the surface's points. */
constexpr const char* SurfacePointIdName = "SurfacePointId";
/**
 * Cell array that vtkConformingDelaunayMesher adds inside of its pipeline: the cell of the user's
 * input. Where a surface carries it, error messages name those cells.
 */
constexpr const char* InputCellName = "ConformingDelaunayInputCell";

/** Progress and abort of a filter for the engine. */
cdm::ExecutionContext MakeContext(vtkAlgorithm* filter);

/** Call an engine function; running out of memory becomes a Status. */
cdm::Status Guard(const std::function<cdm::Status()>& function);

/** For the engine: as many as vtkSMPTools is allowed. */
int GetNumberOfThreads();

/** body(i) for all items, on so many threads; for short work, without progress. */
template <typename Body>
void ForEach(std::size_t count, const Body& body)
{
  cdm::ParallelLoop(count, { GetNumberOfThreads(), std::size_t(1) << 14 }, {}, "",
    [&body](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        body(i);
      }
    });
}

/** Cells with the same number of points: getPoint(i, j) is point j of cell i. */
template <typename Function>
vtkSmartPointer<vtkCellArray> MakeCells(std::size_t count, int size, const Function& getPoint)
{
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(count + 1));
  vtkNew<vtkIdTypeArray> points;
  points->SetNumberOfValues(static_cast<vtkIdType>(size * count));
  vtkIdType* const offset = offsets->GetPointer(0);
  vtkIdType* const point = points->GetPointer(0);
  offset[0] = 0;
  ForEach(count,
    [&](std::size_t i)
    {
      offset[i + 1] = static_cast<vtkIdType>(size * (i + 1));
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

/** Emit the error and empty all outputs; what RequestData has to return (1 after an abort). */
int ReportFailure(vtkAlgorithm* filter, vtkInformationVector* outputs, const cdm::Status& status,
  vtkDataSet* input);

/** Emit the error only, as writers do, which have no outputs. */
void ReportError(vtkAlgorithm* filter, const cdm::Status& status, vtkDataSet* input);

/** " Cells: 1, 2, ... (n in all).": the first ten of them; empty without cells. */
std::string ListCells(std::vector<vtkIdType> cells);

/**
 * True for an empty input on a process of a parallel run: readers that are not parallel fill the
 * first process only, and the others have nothing to do and nothing to complain about.
 */
bool IsIdleProcess(vtkDataSet* input, vtkInformationVector* outputs);

void OffsetCells(cdm::Status& status, vtkIdType offset);
void MapCells(cdm::Status& status, const std::vector<vtkIdType>& cells);

/** First cell of a vtkPolyData that is a polygon. */
vtkIdType GetFirstPolygon(vtkPolyData* surface);

/** Polygons and the triangles of strips; cells receives the VTK cell of each. */
cdm::Status ToPolygonSoup(
  vtkPolyData* input, cdm::PolygonSoup& soup, std::vector<vtkIdType>& cells);

/** All polygons must be triangles. */
cdm::Status ToTriangleMesh(vtkPolyData* input, cdm::TriangleMesh& surface);

/** Finite points; name says in messages which input they are. */
cdm::Status ToPoints(vtkPointSet* input, const char* name, std::vector<cdm::Vec3>& points);

/** Where a point array is not zero; empty without the array. */
cdm::Status ToFlags(vtkUnstructuredGrid* input, const char* name, std::vector<char>& flags);

/** Points as seeds; regions from the point array RegionId, or from 0 on by order. */
cdm::Status ToSeeds(vtkPointSet* input, std::vector<cdm::RegionSeed>& seeds);

/**
 * The tetrahedra among the cells, with the VTK cell of each; cells of up to two dimensions are
 * passed over. Regions are 0 without the array RegionId; neighbors are left empty.
 */
cdm::Status ToTetrahedra(
  vtkUnstructuredGrid* input, cdm::TetMesh& mesh, std::vector<vtkIdType>& cells);

/** All cells must be tetrahedra. Regions are 0 without the array RegionId; makes neighbors. */
cdm::Status ToTetMesh(vtkUnstructuredGrid* input, cdm::TetMesh& mesh);

/**
 * The point array Sizing as a field: interpolated in the cell that holds the position, outside of
 * the cells at the nearest point of them, or taken from the nearest point if there are no cells.
 * One component: a length; 3: one for each axis; 6 (xx, yy, zz, xy, yz, xz) or 9: a symmetric
 * tensor with the lengths as its principal values. The field keeps what it needs of the input.
 */
cdm::Status ToSizing(vtkDataSet* input, cdm::SizingField& sizing);

/** Points and cells of any data set. */
cdm::Status ToSizingCells(vtkDataSet* input, cdm::SizingCells& cells);

vtkSmartPointer<vtkPoints> FromPoints(const std::vector<cdm::Vec3>& points);

/** Points, triangles and, if there are any, labels. */
void FromTriangleMesh(const cdm::TriangleMesh& surface, vtkPolyData* output);

/** Points, tetrahedra and RegionId. */
void FromTetMesh(const cdm::TetMesh& mesh, vtkUnstructuredGrid* output);

/**
 * Lines with Kind, DihedralAngle and ChainId on those points of the surface that they use, with
 * their point data and SurfacePointId.
 */
void FromStructuralEdges(
  const std::vector<cdm::StructuralEdge>& edges, vtkPolyData* surface, vtkPolyData* output);

/** A triangle for each front facet on the points that are used. */
void FromFront(const std::vector<cdm::TriangleIds>& front, const std::vector<cdm::Vec3>& points,
  vtkPolyData* output);

/** A vertex cell for each point, with the data of the points sources[i] of the input. */
void FromKeptPoints(vtkPointSet* input, const std::vector<cdm::Id>& sources, vtkPolyData* output);

/**
 * Copy the tuple sources[i] to i for all arrays but the named ones, which a stage writes itself.
 */
void CopyTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  vtkDataSetAttributes* to, const std::vector<const char*>& except = {});

/** Cell data of a surface by source cell; keeps the array BoundaryLabels that is there already. */
void CopyCellTuples(vtkPolyData* from, const std::vector<vtkIdType>& sources, vtkPolyData* to);

/** The same with sources counted from the first polygon of the surface; cdm::NoId stays none. */
void CopyTriangleTuples(vtkPolyData* from, const std::vector<cdm::Id>& sources, vtkPolyData* to);

/** What the parents of new points are ids of. */
enum class ParentIds
{
  Input,
  Output
};

/**
 * Copy the tuple sources[i] to i; the tuples of new points are interpolated after them. Arrays of
 * global and pedigree ids are left out: there is no id between two ids.
 */
void InterpolateTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  const std::vector<cdm::PointParents>& newPoints, ParentIds parentIds, vtkDataSetAttributes* to);

/**
 * Point data of a mesh made from another one: of the input point sources[i], or interpolated where
 * the output's point i lies in the input's cells if there is none. Arrays of ids are left out, and
 * FreePoint, which is no property of a place.
 */
void InterpolateTuplesInCells(
  vtkUnstructuredGrid* input, const std::vector<cdm::Id>& sources, vtkUnstructuredGrid* output);

/**
 * All tuples of first, then the tuples sources[i] of second: the arrays that both have (same name,
 * type and number of components). second may be null if there are no sources.
 */
void AppendTuples(vtkDataSetAttributes* first, vtkDataSetAttributes* second,
  const std::vector<cdm::Id>& sources, vtkDataSetAttributes* to);
} // namespace vtkCoreBridge

#endif
