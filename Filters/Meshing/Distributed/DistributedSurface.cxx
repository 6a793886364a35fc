// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedSurface.h"

#include "CoreBridge/Inputs.h"
#include "CoreBridge/Reports.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Delaunay/PartRegions.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/DuplicateTriangles.h"
#include "Core/Meshes/FacetPolygons.h"
#include "Core/Sizing/RegionLocator.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <set>
#include <string>

namespace vtkDistributed
{
namespace
{
/** Triangles that a message names. */
constexpr std::size_t NamedTriangles = 10;

struct SurfaceTriangle
{
  /** Places among the points that its process sent. */
  cdm::TriangleIds Points;
  cdm::RegionPair Labels;
  std::int64_t Cell;
};

/** A point of the surface, and its place among the points of all processes. */
struct SurfacePoint
{
  cdm::NumberedPoint Point;
  std::size_t Place;
};

/**
 * Merges points at the same position into one, which has their lowest number. Returns the index of
 * each place among the positions, which are in the order of the numbers; NoId for unused places.
 */
std::vector<cdm::Id> MergePoints(std::vector<SurfacePoint> points, const std::vector<char>& isUsed,
  std::vector<cdm::Vec3>& positions)
{
  std::sort(points.begin(), points.end(),
    [](const SurfacePoint& p, const SurfacePoint& q)
    {
      return p.Point.Position != q.Point.Position ? p.Point.Position < q.Point.Position
                                                  : p.Point.Number < q.Point.Number;
    });
  std::vector<std::pair<cdm::NumberedPoint, std::vector<std::size_t>>> used;
  for (auto begin = points.begin(), end = begin; begin != points.end(); begin = end)
  {
    std::vector<std::size_t> places;
    for (; end != points.end() && end->Point.Position == begin->Point.Position; ++end)
    {
      if (isUsed[end->Place])
      {
        places.push_back(end->Place);
      }
    }
    if (!places.empty())
    {
      used.emplace_back(begin->Point, std::move(places));
    }
  }
  std::sort(used.begin(), used.end(),
    [](const auto& p, const auto& q) { return p.first.Number < q.first.Number; });
  std::vector<cdm::Id> ids(isUsed.size(), cdm::NoId);
  for (const auto& [point, places] : used)
  {
    for (std::size_t place : places)
    {
      ids[place] = static_cast<cdm::Id>(positions.size());
    }
    positions.push_back(point.Position);
  }
  return ids;
}
} // namespace

//--------------------------------------------------------------------------------------------------
/** The triangles of this process, with places among its points. Ghosts belong to another one. */
cdm::Status DistributedSurface::Read(vtkPolyData* input)
{
  if (!input || input->GetNumberOfPolys() + input->GetNumberOfStrips() == 0)
  {
    return {};
  }
  cdm::Status status = vtkCoreBridge::ToTriangleMesh(input, this->Mesh);
  const vtkIdType first = vtkCoreBridge::GetFirstPolygon(input);
  vtkCoreBridge::OffsetCells(status.Cells, first);
  vtkUnsignedCharArray* ghosts = input->GetCellGhostArray();
  std::size_t kept = 0;
  for (std::size_t t = 0; t < this->Mesh.Triangles.size() && status.IsOk(); ++t)
  {
    const vtkIdType cell = first + static_cast<vtkIdType>(t);
    if (ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) != 0)
    {
      continue;
    }
    this->Mesh.Triangles[kept] = this->Mesh.Triangles[t];
    if (!this->Mesh.Labels.empty())
    {
      this->Mesh.Labels[kept] = this->Mesh.Labels[t];
    }
    ++kept;
    this->OwnCells.push_back(cell);
  }
  this->Mesh.Triangles.resize(kept);
  this->Mesh.Labels.resize(this->Mesh.Labels.empty() ? 0 : kept);
  return status;
}

//--------------------------------------------------------------------------------------------------
/** All of the surface on each process, as it is small beside the tetrahedra. */
cdm::Status DistributedSurface::Gather(
  vtkPolyData* input, const std::vector<cdm::NumberedPoint>& points)
{
  const bool hasTriangles = !this->Mesh.Triangles.empty();
  const bool hasLabels = !this->Mesh.Labels.empty();
  const std::int64_t withLabels = this->Processes.Sum(hasTriangles && hasLabels ? 1 : 0);
  const std::int64_t withoutLabels = this->Processes.Sum(hasTriangles && !hasLabels ? 1 : 0);
  this->IsThere = withLabels + withoutLabels > 0;
  if (!this->IsThere)
  {
    return {};
  }
  if (withLabels > 0 && withoutLabels > 0)
  {
    return cdm::Status::InvalidInput(
      "Only some processes have the cell array BoundaryLabels on their surface.");
  }
  std::vector<Row> rows;
  cdm::Status status = this->GatherTriangles(points, withLabels > 0, rows);
  const std::vector<vtkSmartPointer<vtkTable>> tables = this->GatherCellData(input);
  if (status.IsOk())
  {
    status = this->RemoveCopiedTriangles(rows);
    this->CellData = vtkSmartPointer<vtkTable>::New();
    Merge(tables, rows, this->CellData->GetRowData());
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
/** rows: for each triangle its process, and its number among the triangles of that one. */
cdm::Status DistributedSurface::GatherTriangles(
  const std::vector<cdm::NumberedPoint>& points, bool hasLabels, std::vector<Row>& rows)
{
  std::vector<SurfaceTriangle> own;
  for (std::size_t t = 0; t < this->Mesh.Triangles.size(); ++t)
  {
    own.push_back({ this->Mesh.Triangles[t], hasLabels ? this->Mesh.Labels[t] : cdm::RegionPair(),
      this->OwnCells[t] });
  }
  std::vector<std::vector<SurfaceTriangle>> pieces;
  std::size_t numberOfTriangles = 0;
  for (const ProcessGroup::Bytes& bytes : this->Processes.Gather(ProcessGroup::Pack(own)))
  {
    pieces.push_back(ProcessGroup::Unpack<SurfaceTriangle>(bytes));
    numberOfTriangles += pieces.back().size();
  }
  std::vector<SurfacePoint> all;
  std::vector<std::size_t> starts;
  for (const ProcessGroup::Bytes& bytes : this->Processes.Gather(ProcessGroup::Pack(points)))
  {
    starts.push_back(all.size());
    for (const cdm::NumberedPoint& point : ProcessGroup::Unpack<cdm::NumberedPoint>(bytes))
    {
      all.push_back({ point, all.size() });
    }
  }
  cdm::Status status = cdm::CheckIdRange(all.size(), "points of the surface")
                         .Then([&] { return cdm::CheckNumberOfTriangles(numberOfTriangles); });
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<char> isUsed(all.size(), 0);
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    for (const SurfaceTriangle& triangle : pieces[rank])
    {
      for (cdm::Id point : triangle.Points)
      {
        isUsed[starts[rank] + point] = 1;
      }
    }
  }
  this->Mesh = cdm::TriangleMesh();
  const std::vector<cdm::Id> ids = MergePoints(std::move(all), isUsed, this->Mesh.Points);
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    for (std::size_t t = 0; t < pieces[rank].size(); ++t)
    {
      cdm::TriangleIds triangle = pieces[rank][t].Points;
      for (cdm::Id& point : triangle)
      {
        point = ids[starts[rank] + point];
      }
      this->Mesh.Triangles.push_back(triangle);
      if (hasLabels)
      {
        this->Mesh.Labels.push_back(pieces[rank][t].Labels);
      }
      this->Sources.emplace_back(static_cast<int>(rank), pieces[rank][t].Cell);
      rows.emplace_back(rank, static_cast<vtkIdType>(t));
    }
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
/** The cell arrays that all processes with triangles have: a table for each process, or none. */
std::vector<vtkSmartPointer<vtkTable>> DistributedSurface::GatherCellData(vtkPolyData* input) const
{
  const bool hasTriangles = !this->OwnCells.empty();
  const std::set<std::string> arrays = Intersect(this->Processes,
    hasTriangles ? GetSignatures(input->GetCellData()) : std::set<std::string>(), hasTriangles);
  std::vector<vtkSmartPointer<vtkTable>> tables;
  if (arrays.empty())
  {
    return tables;
  }
  vtkNew<vtkDataSetAttributes> data;
  if (hasTriangles)
  {
    PassArrays(input->GetCellData(), arrays, data);
  }
  for (const ProcessGroup::Bytes& bytes : this->Processes.Gather(
         hasTriangles ? Pack(Select(data, this->OwnCells)) : ProcessGroup::Bytes()))
  {
    tables.emplace_back(Unpack(bytes));
  }
  return tables;
}

//--------------------------------------------------------------------------------------------------
/**
 * Removes copies of triangles: if two processes have the same triangle, that of the first one
 * stays.
 */
cdm::Status DistributedSurface::RemoveCopiedTriangles(std::vector<Row>& rows)
{
  std::vector<char> isCopy(this->Mesh.Triangles.size(), 0);
  cdm::Status status;
  for (const cdm::DuplicateTriangle& copy : cdm::FindDuplicateTriangles(this->Mesh.Triangles))
  {
    isCopy[copy.Triangle] = 1;
    if (this->Sources[copy.Triangle].first == this->Sources[copy.Original].first)
    {
      status = cdm::Status::InvalidInput("Two triangles of the surface have the same points; clean "
                                         "the surface with vtkBoundaryTriangulator first.",
        { copy.Triangle });
    }
  }
  this->NameTriangles(status);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < isCopy.size(); ++t)
  {
    if (!isCopy[t])
    {
      this->Mesh.Triangles[kept] = this->Mesh.Triangles[t];
      this->Sources[kept] = this->Sources[t];
      if (!this->Mesh.Labels.empty())
      {
        this->Mesh.Labels[kept] = this->Mesh.Labels[t];
      }
      rows[kept++] = rows[t];
    }
  }
  this->Mesh.Triangles.resize(kept);
  this->Mesh.Labels.resize(this->Mesh.Labels.empty() ? 0 : kept);
  this->Sources.resize(kept);
  rows.resize(kept);
  return status;
}

//--------------------------------------------------------------------------------------------------
void DistributedSurface::NameTriangles(cdm::Status& status) const
{
  if (status.Cells.empty())
  {
    return;
  }
  if (this->Processes.IsAlone())
  {
    for (cdm::Id& cell : status.Cells)
    {
      cell = static_cast<cdm::Id>(this->Sources[cell].second);
    }
    return;
  }
  status.Message += " Cells: ";
  for (std::size_t i = 0; i < std::min(status.Cells.size(), NamedTriangles); ++i)
  {
    const auto& [rank, cell] = this->Sources[status.Cells[i]];
    status.Message +=
      (i > 0 ? ", " : "") + std::to_string(cell) + " of process " + std::to_string(rank);
  }
  status.Message += (status.Cells.size() > NamedTriangles ? ", ... (" : " (") +
    std::to_string(status.Cells.size()) + " in all).";
  status.Cells.clear();
}

//--------------------------------------------------------------------------------------------------
/** The regions that the surface encloses, and the diagonals that a mesh has in its flat facets. */
cdm::Status DistributedSurface::Check()
{
  const std::vector<cdm::Vec3>& points = this->Mesh.Points;
  std::vector<cdm::TriangleIds>& triangles = this->Mesh.Triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (cdm::AreCollinear(
          points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]))
    {
      return cdm::Status::InvalidInput("A triangle of the surface has no area; clean the surface "
                                       "with vtkBoundaryTriangulator first.",
        { static_cast<cdm::Id>(t) });
    }
  }
  cdm::RegionLocator locator(this->Mesh);
  cdm::Status status = locator.Build();
  for (std::size_t t = 0; t < triangles.size() && status.IsOk(); ++t)
  {
    cdm::RegionPair regions = locator.GetRegions(static_cast<cdm::Id>(t));
    // Without labels the outer side of a component does not know what is around it.
    if (this->Mesh.Labels.empty())
    {
      regions.Front =
        regions.Front == cdm::OutsideRegion ? cdm::PartRegions::Unknown : regions.Front;
      regions.Back = regions.Back == cdm::OutsideRegion ? cdm::PartRegions::Unknown : regions.Back;
    }
    this->SideRegions.push_back(regions);
  }
  const cdm::FacetPolygons polygons(this->Mesh, this->Mesh.Points.size());
  std::vector<char> isDone(triangles.size(), 0);
  std::vector<cdm::Id> polygon;
  for (std::size_t t = 0; t < triangles.size() && status.IsOk(); ++t)
  {
    if (isDone[t])
    {
      continue;
    }
    const cdm::TriangleIds ids = triangles[t];
    const auto isCocircular = [&](cdm::Id point)
    {
      return cdm::Orientation(points[ids[0]], points[ids[1]], points[ids[2]], points[point]) == 0 &&
        cdm::InEquatorialSphere(points[ids[0]], points[ids[1]], points[ids[2]], points[point]) == 0;
    };
    const std::vector<cdm::Id> others =
      polygons.Collect(static_cast<cdm::Id>(t), isCocircular, polygon);
    if (others.empty())
    {
      continue;
    }
    const std::vector<cdm::TriangleIds> fan = cdm::MakePulledFan(points, ids, others);
    if (fan.size() != polygon.size())
    {
      return cdm::Status::InvalidInput("Triangles of a flat facet overlap; check the surface with "
                                       "vtkBoundaryTriangulator.",
        polygon);
    }
    const cdm::RegionPair regions = this->SideRegions[t];
    for (std::size_t i = 0; i < fan.size(); ++i)
    {
      triangles[polygon[i]] = fan[i];
      this->SideRegions[polygon[i]] = regions;
      isDone[polygon[i]] = 1;
    }
  }
  // From here on the sides have regions, and labels are not looked at any more.
  this->Mesh.Labels.clear();
  return status;
}
} // namespace vtkDistributed
