// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Inputs.h
 * @brief VTK's data sets as meshes of the engine.
 *
 * A conversion checks what the engine takes for granted (ids in range, 32 bits, array types), and
 * says in its Status what is wrong, with the ids of VTK cells and points.
 */
#ifndef CoreBridge_Inputs_h
#define CoreBridge_Inputs_h

#include "Core/Basics/Status.h"
#include "Core/MeshPoints/MeshPointGenerator.h"
#include "Core/Meshes/PolygonSoup.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Sizing/RegionSizes.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <vtkType.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

class vtkDataSet;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkCoreBridge
{
/** Polygons and the triangles of strips; cells receives the VTK cell of each. */
cdm::Status ToPolygonSoup(
  vtkPolyData* input, cdm::PolygonSoup& soup, std::vector<vtkIdType>& cells);

/** All polygons must be triangles. */
cdm::Status ToTriangleMesh(vtkPolyData* input, cdm::TriangleMesh& surface);

/**
 * Structural facet of each triangle, from the cell arrays StructuralFacetId and ContactId: contacts
 * end at structural edges, also within a plane. Empty without both.
 */
cdm::Status ToFacets(vtkPolyData* input, std::vector<cdm::Id>& facets);

/** The same for polygons, by their cells. */
cdm::Status ToFacets(
  vtkPolyData* input, const std::vector<vtkIdType>& cells, std::vector<cdm::Id>& facets);

/**
 * A number for each polygon that says which others have the same cell data, in integer arrays other
 * than BoundaryLabels whose values repeat: the values of at least half of the polygons are those of
 * others, too. Empty without such arrays.
 */
std::vector<cdm::Id> ToCellGroups(vtkPolyData* input, const std::vector<vtkIdType>& cells);

/** The region of a name in the field array RegionNames of the data, or of a whole number. */
cdm::Status FindRegion(vtkDataSet* data, const std::string& name, cdm::Id& region);

/** Region and neighbor, each a name or a number; number of layers, first distance, growth ratio. */
using LayerRow = std::pair<std::array<std::string, 2>, std::array<double, 3>>;
LayerRow MakeLayerRow(double region, double neighbor, const std::array<double, 3>& numbers);
cdm::Status ToLayers(
  vtkDataSet* data, const std::vector<LayerRow>& rows, std::vector<cdm::PointLayers>& layers);

/** A region, by its name or number, and a size. */
using RegionSizeRow = std::pair<std::string, double>;
cdm::Status ToRegionSizes(
  vtkDataSet* data, const std::vector<RegionSizeRow>& rows, std::vector<cdm::RegionSize>& sizes);

/** Finite points; name says in messages which input they are. */
cdm::Status ToPoints(vtkPointSet* input, const char* name, std::vector<cdm::Vec3>& points);

/** Flags where a point array is not zero; empty without the array. */
cdm::Status ToFlags(vtkPointSet* input, const char* name, std::vector<char>& flags);

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

/** Arrays that are shorter than the data set would be read behind their end. */
cdm::Status CheckArrays(vtkDataSet* input);

/** The error of cells that use points which do not exist. */
cdm::Status MissingPoints(std::vector<cdm::Id> cells);
bool UsesMissingPoints(vtkIdType size, const vtkIdType* ids, vtkIdType numberOfPoints);
} // namespace vtkCoreBridge

#endif
