// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Inputs.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Texts.h"
#include "vtkConformingDelaunayCompatibility.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Meshes/MeshInvariants.h"

#include <vtkAbstractArray.h>
#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace
{
/** A whole number from -1 on that fits into an id; otherwise false. */
bool ToRegion(double value, cdm::Id& region)
{
  if (!(value >= cdm::OutsideRegion && value <= static_cast<double>(cdm::LargestId)) ||
    value != std::floor(value))
  {
    return false;
  }
  region = static_cast<cdm::Id>(value);
  return true;
}

cdm::Status ToVectors(vtkPoints* input, std::vector<cdm::Vec3>& points)
{
  const vtkIdType count = input ? input->GetNumberOfPoints() : 0;
  const cdm::Status status = cdm::CheckIdRange(count, "points");
  if (!status.IsOk())
  {
    return status;
  }
  points.resize(count);
  vtkCoreBridge::ForEach(points.size(),
    [&](std::size_t i)
    {
      double x[3];
      input->GetPoint(static_cast<vtkIdType>(i), x);
      points[i] = { x[0], x[1], x[2] };
    });
  return status;
}

/** Labels of the given cells; empty without the array. */
cdm::Status ToLabels(
  vtkPolyData* input, const std::vector<vtkIdType>& cells, std::vector<cdm::RegionPair>& labels)
{
  vtkAbstractArray* any = input->GetCellData()->GetAbstractArray(vtkCoreBridge::BoundaryLabelsName);
  labels.clear();
  if (!any)
  {
    return {};
  }
  auto array = vtkDataArray::SafeDownCast(any);
  if (!array || array->GetNumberOfComponents() != 2 ||
    array->GetNumberOfTuples() != input->GetNumberOfCells())
  {
    return cdm::Status::InvalidInput(
      "The cell array BoundaryLabels must hold two integers for each cell: the region ids on its "
      "front and on its back side, -1 for outside. Correct, rename or remove it.");
  }
  labels.resize(cells.size());
  std::vector<cdm::Id> wrong;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    if (!ToRegion(array->GetComponent(cells[i], 0), labels[i].Front) ||
      !ToRegion(array->GetComponent(cells[i], 1), labels[i].Back))
    {
      wrong.push_back(static_cast<cdm::Id>(cells[i]));
    }
  }
  if (!wrong.empty())
  {
    wrong.erase(std::unique(wrong.begin(), wrong.end()), wrong.end());
    return cdm::Status::InvalidInput(
      "The cell array BoundaryLabels holds values that are no region ids: they are whole numbers "
      "from 0 on, or -1 for outside.",
      std::move(wrong));
  }
  return {};
}

cdm::Status NotTetrahedra(std::vector<cdm::Id> cells)
{
  return cdm::Status::InvalidInput(
    "The input has cells that are not linear tetrahedra (VTK_TETRA). Remove or split them.",
    std::move(cells));
}

int GetCellDimension(int type)
{
  const auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  // A cell type that this VTK does not know counts as three-dimensional.
  return cell ? cell->GetCellDimension() : 3;
}

/** Checks that both conversions of a surface make before they look at a cell. */
cdm::Status CheckSurface(vtkPolyData* input)
{
  for (const cdm::Status& status : { cdm::CheckIdRange(input->GetNumberOfCells(), "cells"),
         cdm::CheckNumberOfTriangles(input->GetNumberOfPolys() + input->GetNumberOfStrips()) })
  {
    if (!status.IsOk())
    {
      return status;
    }
  }
  if (input->GetNumberOfPolys() + input->GetNumberOfStrips() == 0)
  {
    return cdm::Status::InvalidInput(
      "The input is empty: it has no polygons. A closed polygonal surface is needed.");
  }
  return vtkCoreBridge::CheckArrays(input);
}

void AddPolygon(cdm::PolygonSoup& soup, vtkIdType size, const vtkIdType* ids)
{
  for (vtkIdType i = 0; i < size; ++i)
  {
    soup.Connectivity.push_back(static_cast<cdm::Id>(ids[i]));
  }
  soup.Offsets.push_back(static_cast<cdm::Id>(soup.Connectivity.size()));
}

/** An array with one value for each point or cell; null without one, and if it does not fit. */
cdm::Status FindScalars(vtkDataSetAttributes* data, const std::string& name,
  const std::string& owner, vtkIdType numberOfOwners, vtkDataArray*& array)
{
  array = data->GetArray(name.c_str());
  if (array &&
    (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != numberOfOwners))
  {
    array = nullptr;
    return cdm::Status::InvalidInput("The " + owner + " array " + name +
      " needs one component and one value for each " + owner + ": correct or remove it.");
  }
  return {};
}

/** Ids of cells that several threads find, in the order of the cells. */
class FoundCells
{
public:
  explicit FoundCells(std::size_t numberOfBlocks) : Blocks(numberOfBlocks) {}

  void Add(std::size_t block, std::size_t cell)
  {
    this->Blocks[block].push_back(static_cast<cdm::Id>(cell));
  }

  std::vector<cdm::Id> Collect() const
  {
    std::vector<cdm::Id> all;
    for (const std::vector<cdm::Id>& block : this->Blocks)
    {
      all.insert(all.end(), block.begin(), block.end());
    }
    return all;
  }

private:
  std::vector<std::vector<cdm::Id>> Blocks;
};

/** The cells that are tetrahedra. Other cells with a volume are an error. */
cdm::Status FindTetrahedra(vtkUnstructuredGrid* input, std::vector<vtkIdType>& cells)
{
  const std::size_t count = static_cast<std::size_t>(input->GetNumberOfCells());
  const cdm::ParallelLoopOptions loop{ vtkCoreBridge::GetNumberOfThreads(), std::size_t(1) << 14 };
  FoundCells tetrahedra(cdm::GetNumberOfBlocks(count, loop));
  FoundCells others(cdm::GetNumberOfBlocks(count, loop));
  const auto sortCells = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    for (std::size_t cell = begin; cell < end; ++cell)
    {
      const int type = input->GetCellType(static_cast<vtkIdType>(cell));
      if (type == VTK_TETRA)
      {
        tetrahedra.Add(block, cell);
      }
      else if (GetCellDimension(type) > 2)
      {
        others.Add(block, cell);
      }
    }
  };
  cdm::ParallelLoop(count, loop, {}, "", sortCells);
  std::vector<cdm::Id> notTetrahedra = others.Collect();
  if (!notTetrahedra.empty())
  {
    return NotTetrahedra(std::move(notTetrahedra));
  }
  const std::vector<cdm::Id> found = tetrahedra.Collect();
  cells.assign(found.begin(), found.end());
  if (cells.empty())
  {
    return cdm::Status::InvalidInput(count == 0
        ? "The input is empty: it has no cells."
        : "The input has no tetrahedra. Choose a tetrahedral mesh.");
  }
  return {};
}

/** Points and regions of tetrahedra. */
cdm::Status CopyTetrahedra(
  vtkUnstructuredGrid* input, const std::vector<vtkIdType>& cells, cdm::TetMesh& mesh)
{
  vtkDataArray* regions = input->GetCellData()->GetArray(vtkCoreBridge::RegionIdName);
  mesh.Tetrahedra.resize(cells.size());
  mesh.Regions.resize(cells.size(), 0);
  const cdm::ParallelLoopOptions loop{ vtkCoreBridge::GetNumberOfThreads(), std::size_t(1) << 14 };
  FoundCells missingPoints(cdm::GetNumberOfBlocks(cells.size(), loop));
  FoundCells wrongRegions(cdm::GetNumberOfBlocks(cells.size(), loop));
  const auto copy = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    vtkNew<vtkIdList> ids;
    for (std::size_t i = begin; i < end; ++i)
    {
      const vtkIdType cell = cells[i];
      input->GetCellPoints(cell, ids);
      std::copy_n(ids->GetPointer(0), 4, mesh.Tetrahedra[i].begin());
      if (vtkCoreBridge::UsesMissingPoints(4, ids->GetPointer(0), input->GetNumberOfPoints()))
      {
        missingPoints.Add(block, static_cast<std::size_t>(cell));
      }
      if (regions &&
        (!ToRegion(regions->GetComponent(cell, 0), mesh.Regions[i]) || mesh.Regions[i] < 0))
      {
        wrongRegions.Add(block, static_cast<std::size_t>(cell));
      }
    }
  };
  cdm::ParallelLoop(cells.size(), loop, {}, "", copy);
  std::vector<cdm::Id> missing = missingPoints.Collect();
  if (!missing.empty())
  {
    return vtkCoreBridge::MissingPoints(std::move(missing));
  }
  std::vector<cdm::Id> wrong = wrongRegions.Collect();
  if (!wrong.empty())
  {
    return cdm::Status::InvalidInput(
      "The cell array RegionId holds values that are no whole numbers from 0 on.",
      std::move(wrong));
  }
  return {};
}
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
bool UsesMissingPoints(vtkIdType size, const vtkIdType* ids, vtkIdType numberOfPoints)
{
  return std::any_of(ids, ids + size, [=](vtkIdType id) { return id < 0 || id >= numberOfPoints; });
}

//--------------------------------------------------------------------------------------------------
cdm::Status MissingPoints(std::vector<cdm::Id> cells)
{
  return cdm::Status::InvalidInput(
    "Cells of the input use points that do not exist.", std::move(cells));
}

//--------------------------------------------------------------------------------------------------
cdm::Status CheckArrays(vtkDataSet* input)
{
  if (input->CheckAttributes())
  {
    return cdm::Status::InvalidInput(
      "An array of the input has fewer tuples than the input has points or cells.");
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToPolygonSoup(vtkPolyData* input, cdm::PolygonSoup& soup, std::vector<vtkIdType>& cells)
{
  cdm::Status status = CheckSurface(input);
  const vtkIdType corners = input->GetPolys()->GetNumberOfConnectivityIds() +
    3 * input->GetStrips()->GetNumberOfConnectivityIds();
  if (status.IsOk())
  {
    status = cdm::CheckIdRange(corners, "polygon corners");
  }
  if (status.IsOk())
  {
    status = ToVectors(input->GetPoints(), soup.Points);
  }
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<cdm::Id> wrong;
  vtkIdType cell = GetFirstPolygon(input);
  vtkNew<vtkIdList> ids;
  auto addCells = [&](vtkCellArray* array, auto addCell)
  {
    auto iterator = vtk::TakeSmartPointer(array->NewIterator());
    for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
    {
      iterator->GetCurrentCell(ids);
      if (UsesMissingPoints(ids->GetNumberOfIds(), ids->GetPointer(0), input->GetNumberOfPoints()))
      {
        wrong.push_back(static_cast<cdm::Id>(cell));
      }
      addCell(ids->GetNumberOfIds(), ids->GetPointer(0));
      ++cell;
    }
  };
  addCells(input->GetPolys(),
    [&](vtkIdType size, const vtkIdType* polygon)
    {
      AddPolygon(soup, size, polygon);
      cells.push_back(cell);
    });
  addCells(input->GetStrips(),
    [&](vtkIdType size, const vtkIdType* strip)
    {
      for (vtkIdType i = 0; i + 2 < size; ++i)
      {
        const vtkIdType odd = i % 2;
        const vtkIdType triangle[3] = { strip[i], strip[i + 1 + odd], strip[i + 2 - odd] };
        AddPolygon(soup, 3, triangle);
        cells.push_back(cell);
      }
    });
  if (!wrong.empty())
  {
    return MissingPoints(std::move(wrong));
  }
  return ToLabels(input, cells, soup.Labels);
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToTriangleMesh(vtkPolyData* input, cdm::TriangleMesh& surface)
{
  cdm::Status status = CheckSurface(input);
  if (status.IsOk())
  {
    status = ToVectors(input->GetPoints(), surface.Points);
  }
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<cdm::Id> notTriangles;
  std::vector<cdm::Id> missingPoints;
  std::vector<vtkIdType> cells;
  vtkIdType cell = GetFirstPolygon(input);
  vtkNew<vtkIdList> ids;
  auto iterator = vtk::TakeSmartPointer(input->GetPolys()->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    iterator->GetCurrentCell(ids);
    const vtkIdType* corner = ids->GetPointer(0);
    if (ids->GetNumberOfIds() != 3)
    {
      notTriangles.push_back(static_cast<cdm::Id>(cell));
    }
    else if (UsesMissingPoints(3, corner, input->GetNumberOfPoints()))
    {
      missingPoints.push_back(static_cast<cdm::Id>(cell));
    }
    else
    {
      surface.Triangles.push_back({ static_cast<cdm::Id>(corner[0]),
        static_cast<cdm::Id>(corner[1]), static_cast<cdm::Id>(corner[2]) });
    }
    cells.push_back(cell++);
  }
  for (vtkIdType strip = 0; strip < input->GetNumberOfStrips(); ++strip)
  {
    notTriangles.push_back(static_cast<cdm::Id>(cell++));
  }
  if (!notTriangles.empty())
  {
    return cdm::Status::InvalidInput("The surface has cells that are not triangles. Run "
                                     "vtkBoundaryTriangulator first.",
      std::move(notTriangles));
  }
  if (!missingPoints.empty())
  {
    return MissingPoints(std::move(missingPoints));
  }
  return ToLabels(input, cells, surface.Labels);
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToPoints(vtkPointSet* input, const char* name, std::vector<cdm::Vec3>& points)
{
  cdm::Status status = CheckArrays(input);
  if (status.IsOk())
  {
    status = ToVectors(input->GetPoints(), points);
  }
  const auto wrong = std::find_if_not(points.begin(), points.end(), cdm::IsFinite);
  if (status.IsOk() && wrong != points.end())
  {
    // Not in Status::Points, which are points of the surface.
    status = cdm::Status::InvalidInput("Point " + std::to_string(wrong - points.begin()) +
      " of the " + name + " has coordinates that are not finite: remove or correct it.");
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToFlags(vtkPointSet* input, const char* name, std::vector<char>& flags)
{
  vtkDataArray* array = nullptr;
  const cdm::Status status =
    FindScalars(input->GetPointData(), name, "point", input->GetNumberOfPoints(), array);
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    flags.push_back(array->GetComponent(i, 0) != 0.0);
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToFacets(vtkPolyData* input, std::vector<cdm::Id>& facets)
{
  const vtkIdType first = GetFirstPolygon(input);
  std::vector<vtkIdType> cells;
  for (vtkIdType i = 0; i < input->GetNumberOfPolys(); ++i)
  {
    cells.push_back(first + i);
  }
  return ToFacets(input, cells, facets);
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToFacets(
  vtkPolyData* input, const std::vector<vtkIdType>& cells, std::vector<cdm::Id>& facets)
{
  vtkDataArray* arrays[2] = { nullptr, nullptr };
  constexpr const char* Names[2] = { StructuralFacetIdName, ContactIdName };
  for (int i = 0; i < 2; ++i)
  {
    const cdm::Status status =
      FindScalars(input->GetCellData(), Names[i], "cell", input->GetNumberOfCells(), arrays[i]);
    if (!status.IsOk())
    {
      return status;
    }
  }
  if (!arrays[1])
  {
    for (std::size_t i = 0; arrays[0] && i < cells.size(); ++i)
    {
      facets.push_back(static_cast<cdm::Id>(arrays[0]->GetComponent(cells[i], 0)));
    }
    return {};
  }
  // A number for each pair of both.
  std::map<std::pair<double, double>, cdm::Id> numbers;
  for (const vtkIdType cell : cells)
  {
    const double facet = arrays[0] ? arrays[0]->GetComponent(cell, 0) : 0.0;
    const std::pair<double, double> pair{ facet, arrays[1]->GetComponent(cell, 0) };
    facets.push_back(numbers.emplace(pair, static_cast<cdm::Id>(numbers.size())).first->second);
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
std::vector<cdm::Id> ToCellGroups(vtkPolyData* input, const std::vector<vtkIdType>& cells)
{
  std::vector<cdm::Id> groups;
  vtkCellData* const data = input->GetCellData();
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = data->GetArray(i);
    if (!array || array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE ||
      array == data->GetArray(BoundaryLabelsName) ||
      array->GetNumberOfTuples() != input->GetNumberOfCells())
    {
      continue;
    }
    // The group so far and the tuple, as a key.
    std::map<std::vector<double>, cdm::Id> numbers;
    std::vector<cdm::Id> finer;
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
    {
      std::vector<double> key(array->GetNumberOfComponents() + 1);
      array->GetTuple(cells[cell], key.data());
      key.back() = groups.empty() ? 0 : groups[cell];
      finer.push_back(numbers.emplace(key, static_cast<cdm::Id>(numbers.size())).first->second);
    }
    // Numbers of the cells themselves divide nothing.
    if (2 * numbers.size() <= cells.size())
    {
      groups = std::move(finer);
    }
  }
  return groups;
}

//--------------------------------------------------------------------------------------------------
cdm::Status FindRegion(vtkDataSet* data, const std::string& name, cdm::Id& region)
{
  const std::vector<std::string> names = GetTexts(RegionNamesName, data->GetFieldData());
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end())
  {
    region = static_cast<cdm::Id>(found - names.begin());
    return {};
  }
  char* end = nullptr;
  const double value = std::strtod(name.c_str(), &end);
  if (name.empty() || *end != '\0' || !(std::abs(value) <= VTK_INT_MAX) ||
    value != std::floor(value))
  {
    std::string list;
    for (const std::string& other : names)
    {
      list += (list.empty() ? "" : ", ") + other;
    }
    return cdm::Status::Failure(cdm::StatusCode::InvalidOption,
      "There is no region '" + name + "': give a whole number" +
        (list.empty() ? "; the input has no names of regions." : ", or one of: " + list + "."));
  }
  region = static_cast<cdm::Id>(value);
  return {};
}

//--------------------------------------------------------------------------------------------------
LayerRow MakeLayerRow(double region, double neighbor, const std::array<double, 3>& numbers)
{
  using vtkConformingDelaunayCompatibility::ToText;
  return { { ToText(region), ToText(neighbor) }, numbers };
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToLayers(
  vtkDataSet* data, const std::vector<LayerRow>& rows, std::vector<cdm::PointLayers>& layers)
{
  for (const auto& [regions, numbers] : rows)
  {
    const std::string row = "Layers " + std::to_string(layers.size()) + " are not right: ";
    cdm::PointLayers one;
    cdm::Status status = FindRegion(data, regions[0], one.Region);
    if (status.IsOk())
    {
      status = FindRegion(data, regions[1], one.Neighbor);
    }
    if (!status.IsOk())
    {
      status.Message = row + status.Message;
      return status;
    }
    if (!(std::abs(numbers[0]) <= VTK_INT_MAX) || numbers[0] != std::floor(numbers[0]))
    {
      return cdm::Status::Failure(
        cdm::StatusCode::InvalidOption, row + "the number of layers is a whole number.");
    }
    one.NumberOfLayers = static_cast<cdm::Id>(numbers[0]);
    one.FirstDistance = numbers[1];
    one.GrowthRatio = numbers[2];
    layers.push_back(one);
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToRegionSizes(
  vtkDataSet* data, const std::vector<RegionSizeRow>& rows, std::vector<cdm::RegionSize>& sizes)
{
  for (const auto& [name, length] : rows)
  {
    cdm::Id region = 0;
    cdm::Status status = FindRegion(data, name, region);
    if (!status.IsOk())
    {
      status.Message = "RegionSizes: " + status.Message;
      return status;
    }
    sizes.push_back({ region, length });
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToSeeds(vtkPointSet* input, std::vector<cdm::RegionSeed>& seeds)
{
  std::vector<cdm::Vec3> points;
  cdm::Status status = ToPoints(input, "seeds", points);
  if (!status.IsOk())
  {
    return status;
  }
  vtkDataArray* regions = input->GetPointData()->GetArray(RegionIdName);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    cdm::RegionSeed seed{ points[i], static_cast<cdm::Id>(i) };
    const double region =
      regions ? regions->GetComponent(static_cast<vtkIdType>(i), 0) : static_cast<double>(i);
    if (!ToRegion(region, seed.Region) || seed.Region < 0)
    {
      return cdm::Status::InvalidInput("The point array RegionId of the seeds must hold whole "
                                       "numbers from 0 on; its value at seed " +
        std::to_string(i) + " is " + std::to_string(region) + ".");
    }
    seeds.push_back(seed);
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToTetrahedra(
  vtkUnstructuredGrid* input, cdm::TetMesh& mesh, std::vector<vtkIdType>& cells)
{
  mesh = {};
  cdm::Status status =
    cdm::CheckNumberOfTetrahedra(input->GetNumberOfCells())
      .Then([&] { return cdm::CheckIdRange(input->GetNumberOfPoints(), "points"); })
      .Then([&] { return CheckArrays(input); })
      .Then([&] { return FindTetrahedra(input, cells); })
      .Then([&] { return CopyTetrahedra(input, cells, mesh); })
      .Then([&] { return ToVectors(input->GetPoints(), mesh.Points); });
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<cdm::Id> notFinite;
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    if (!cdm::IsFinite(mesh.Points[i]))
    {
      notFinite.push_back(static_cast<cdm::Id>(i));
    }
  }
  if (!notFinite.empty())
  {
    return cdm::Status::InvalidInput(
      "Points have coordinates that are not finite: remove or correct them.", {}, notFinite);
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToTetMesh(vtkUnstructuredGrid* input, cdm::TetMesh& mesh)
{
  std::vector<vtkIdType> cells;
  const cdm::Status status = ToTetrahedra(input, mesh, cells);
  const vtkIdType count = input->GetNumberOfCells();
  if (status.IsOk() && static_cast<vtkIdType>(cells.size()) == count)
  {
    return cdm::BuildNeighbors(mesh, GetNumberOfThreads());
  }
  std::vector<cdm::Id> others;
  for (vtkIdType cell = 0; cell < std::min<vtkIdType>(count, cdm::LargestId); ++cell)
  {
    if (input->GetCellType(cell) != VTK_TETRA)
    {
      others.push_back(static_cast<cdm::Id>(cell));
    }
  }
  return others.empty() ? status : NotTetrahedra(std::move(others));
}
} // namespace vtkCoreBridge
