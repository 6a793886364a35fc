// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedMesh.h"

#include "vtkCoreBridge.h"

#include "Core/DuplicateTriangles.h"
#include "Core/FacetPolygons.h"
#include "Core/MeshChecks.h"
#include "Core/PartRegions.h"
#include "Core/Predicates.h"
#include "Core/RegionLocator.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkDataSetAttributesFieldList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <set>
#include <string>
#include <unordered_map>

namespace
{
/** Points that the cuts of space are found with, at least and for each process. */
constexpr std::int64_t SampleSize = 20000;
constexpr std::int64_t SampleSizeOfProcess = 1000;
/** Triangles that a message names. */
constexpr std::size_t NamedTriangles = 10;

using Numbers = std::array<std::int64_t, 4>;

struct SharedTetrahedron
{
  Numbers Key;
  std::int64_t Region;
};

/** A tetrahedron with its points, for a process that has none of them. */
struct GhostTetrahedron
{
  std::array<cdm::NumberedPoint, 4> Points;
  std::int64_t Region;
};

struct SurfaceTriangle
{
  /** Places among the points that its process sent. */
  cdm::TriangleIds Points;
  cdm::RegionPair Labels;
  std::int64_t Cell;
};

bool IsLessByNumber(const cdm::NumberedPoint& p, const cdm::NumberedPoint& q)
{
  return p.Number < q.Number;
}

std::string GetSignature(vtkAbstractArray* array)
{
  return std::to_string(array->GetDataType()) + ' ' +
    std::to_string(array->GetNumberOfComponents()) + ' ' +
    (array->GetName() ? array->GetName() : "");
}

/** Arrays other than ids and marks of ghosts, which the output has of its own. */
std::set<std::string> GetSignatures(vtkDataSetAttributes* data)
{
  std::set<std::string> signatures;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    if (array != data->GetGlobalIds() && array->GetName() &&
      std::string(array->GetName()) != vtkDataSetAttributes::GhostArrayName())
    {
      signatures.insert(GetSignature(array));
    }
  }
  return signatures;
}

/** Those that all processes have which have anything; hasAny: this one has. */
std::set<std::string> Intersect(
  const ProcessGroup& processes, const std::set<std::string>& own, bool hasAny)
{
  std::string text = hasAny ? "+" : "";
  for (const std::string& signature : own)
  {
    text += signature + '\n';
  }
  std::set<std::string> common;
  bool isFirst = true;
  for (const ProcessGroup::Bytes& bytes :
    processes.Gather(ProcessGroup::Bytes(text.begin(), text.end())))
  {
    if (bytes.empty())
    {
      continue;
    }
    std::set<std::string> there;
    for (auto begin = bytes.begin() + 1; begin != bytes.end();)
    {
      const auto end = std::find(begin, bytes.end(), '\n');
      there.emplace(begin, end);
      begin = end + 1;
    }
    std::set<std::string> both;
    std::set_intersection(
      common.begin(), common.end(), there.begin(), there.end(), std::inserter(both, both.begin()));
    common = isFirst ? there : both;
    isFirst = false;
  }
  return common;
}

void PassArrays(
  vtkDataSetAttributes* from, const std::set<std::string>& signatures, vtkDataSetAttributes* to)
{
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    if (signatures.count(GetSignature(from->GetAbstractArray(i))) != 0)
    {
      to->AddArray(from->GetAbstractArray(i));
    }
  }
}

vtkSmartPointer<vtkTable> SelectRows(vtkDataSetAttributes* from, const std::vector<vtkIdType>& rows)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  vtkCoreBridge::CopyTuples(from, rows, table->GetRowData());
  return table;
}

/** Rows of several tables, each given by its table and its row there. */
void MergeRows(const std::vector<vtkSmartPointer<vtkTable>>& tables,
  const std::vector<std::pair<std::size_t, vtkIdType>>& rows, vtkDataSetAttributes* to)
{
  vtkDataSetAttributes::FieldList fields;
  std::vector<int> places(tables.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < tables.size(); ++i)
  {
    if (tables[i] && tables[i]->GetNumberOfRows() > 0)
    {
      fields.IntersectFieldList(tables[i]->GetRowData());
      places[i] = count++;
    }
  }
  if (count == 0)
  {
    return;
  }
  fields.CopyAllocate(to, vtkDataSetAttributes::COPYTUPLE, static_cast<vtkIdType>(rows.size()), 0);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const auto& [table, row] = rows[i];
    fields.CopyData(places[table], tables[table]->GetRowData(), row, to, static_cast<vtkIdType>(i));
  }
}

vtkSmartPointer<vtkIdTypeArray> MakeGlobalIds(const std::vector<std::int64_t>& numbers)
{
  auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
  ids->SetName("GlobalPointIds");
  ids->SetNumberOfTuples(static_cast<vtkIdType>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    ids->SetValue(static_cast<vtkIdType>(i), numbers[i]);
  }
  return ids;
}

vtkSmartPointer<vtkUnsignedCharArray> MakeGhostArray(std::size_t count)
{
  auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(static_cast<vtkIdType>(count));
  ghosts->FillValue(0);
  return ghosts;
}
} // namespace

//--------------------------------------------------------------------------------------------------
DistributedMesh::DistributedMesh(ProcessGroup& processes, const cdm::ExecutionContext& context,
  int numberOfThreads, int numberOfGhostLevels)
  : Processes(processes), Context(context), NumberOfThreads(numberOfThreads),
    NumberOfGhostLevels(numberOfGhostLevels)
{
}

//--------------------------------------------------------------------------------------------------
/** Work of this process alone; all agree on how it ended. */
template <typename Work>
cdm::Status DistributedMesh::Do(const Work& work)
{
  return this->Processes.Agree(vtkCoreBridge::Guard(work));
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedMesh::ReadPoints(vtkPointSet* input, const char* name, int port)
{
  std::vector<cdm::Vec3> positions;
  const cdm::Status status =
    input ? vtkCoreBridge::ToPoints(input, name, positions) : cdm::Status();
  for (const cdm::Vec3& position : positions)
  {
    this->Pieces[port].Points.push_back({ position, 0 });
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
/** By their global ids if all of the input's points have them, otherwise one process after another. */
cdm::Status DistributedMesh::NumberPoints(vtkPointSet* input, int port)
{
  std::vector<cdm::NumberedPoint>& points = this->Pieces[port].Points;
  vtkDataArray* ids = points.empty() ? nullptr : input->GetPointData()->GetGlobalIds();
  const bool hasIds = this->Processes.Sum(points.empty() || ids ? 0 : 1) == 0;
  this->HasGlobalIds = this->HasGlobalIds || hasIds;
  std::int64_t highest = -1;
  for (const cdm::NumberedPoint& point : this->Pieces[0].Points)
  {
    highest = std::max(highest, point.Number);
  }
  std::int64_t next = port == 0 ? 0 : this->Processes.Maximum(highest) + 1;
  if (port == 1)
  {
    this->FirstMeshPoint = next;
  }
  const std::vector<std::int64_t> counts = this->Processes.GatherAll(
    std::vector<std::int64_t>{ static_cast<std::int64_t>(points.size()) });
  if (!hasIds)
  {
    next = std::accumulate(counts.begin(), counts.begin() + this->Processes.GetRank(), next);
  }
  bool isNegative = false;
  vtkIdTypeArray* exact = vtkIdTypeArray::SafeDownCast(ids);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const vtkIdType place = static_cast<vtkIdType>(i);
    const std::int64_t id = !hasIds ? place
      : exact                       ? exact->GetValue(place)
                                    : static_cast<std::int64_t>(ids->GetTuple1(place));
    isNegative = isNegative || id < 0;
    points[i].Number = next + id;
  }
  return isNegative ? cdm::Status::InvalidInput(
                        "Global point ids of the input are negative. Correct or remove them.")
                    : cdm::Status();
}

//--------------------------------------------------------------------------------------------------
/** Global ids of the input must not be those of two points. */
cdm::Status DistributedMesh::CheckNumbers()
{
  std::vector<std::vector<cdm::NumberedPoint>> messages(
    static_cast<std::size_t>(this->Processes.GetSize()));
  for (const Piece& piece : this->Pieces)
  {
    for (const cdm::NumberedPoint& point : piece.Points)
    {
      messages[point.Number % this->Processes.GetSize()].push_back(point);
    }
  }
  std::vector<std::vector<cdm::NumberedPoint>> received;
  const cdm::Status status = this->Processes.Exchange(messages, received);
  if (!status.IsOk())
  {
    return status;
  }
  return this->Do(
    [&]
    {
      std::vector<cdm::NumberedPoint> points;
      for (const auto& message : received)
      {
        points.insert(points.end(), message.begin(), message.end());
      }
      std::sort(points.begin(), points.end(), IsLessByNumber);
      const auto wrong = std::adjacent_find(points.begin(), points.end(),
        [](const cdm::NumberedPoint& p, const cdm::NumberedPoint& q)
        { return p.Number == q.Number && p.Position != q.Position; });
      return wrong == points.end()
        ? cdm::Status()
        : cdm::Status::InvalidInput("Two points of the input at different places have the global "
                                    "id " +
            std::to_string(wrong->Number) + ". Correct or remove the global ids.");
    });
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedMesh::ChooseArrays(vtkPointSet* input, vtkPointSet* meshPoints)
{
  std::set<std::string> common;
  bool isFirst = true;
  vtkPointSet* const inputs[2] = { input, meshPoints };
  for (vtkPointSet* points : inputs)
  {
    const bool hasPoints = points && points->GetNumberOfPoints() > 0;
    const std::set<std::string> here = Intersect(this->Processes,
      hasPoints ? GetSignatures(points->GetPointData()) : std::set<std::string>(), hasPoints);
    if (this->Processes.Sum(hasPoints ? 1 : 0) == 0)
    {
      continue;
    }
    std::set<std::string> both;
    std::set_intersection(
      common.begin(), common.end(), here.begin(), here.end(), std::inserter(both, both.begin()));
    common = isFirst ? here : both;
    isFirst = false;
  }
  this->HasPointData = !common.empty();
  for (int port = 0; port < 2; ++port)
  {
    this->Pieces[port].Data = vtkSmartPointer<vtkDataSetAttributes>::New();
    if (inputs[port])
    {
      PassArrays(inputs[port]->GetPointData(), common, this->Pieces[port].Data);
    }
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
/** The triangles of this process, with places among its points. Ghosts belong to another one. */
cdm::Status DistributedMesh::ReadSurface(vtkPolyData* input)
{
  if (!input || input->GetNumberOfPolys() + input->GetNumberOfStrips() == 0)
  {
    return {};
  }
  cdm::Status status = vtkCoreBridge::ToTriangleMesh(input, this->Surface);
  const vtkIdType first = vtkCoreBridge::GetFirstPolygon(input);
  vtkCoreBridge::OffsetCells(status, first);
  vtkUnsignedCharArray* ghosts = input->GetCellGhostArray();
  std::size_t kept = 0;
  for (std::size_t t = 0; t < this->Surface.Triangles.size() && status.IsOk(); ++t)
  {
    const vtkIdType cell = first + static_cast<vtkIdType>(t);
    if (ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) != 0)
    {
      continue;
    }
    this->Surface.Triangles[kept] = this->Surface.Triangles[t];
    if (!this->Surface.Labels.empty())
    {
      this->Surface.Labels[kept] = this->Surface.Labels[t];
    }
    ++kept;
    this->SurfaceCells.push_back(cell);
  }
  this->Surface.Triangles.resize(kept);
  this->Surface.Labels.resize(this->Surface.Labels.empty() ? 0 : kept);
  return status;
}

//--------------------------------------------------------------------------------------------------
/** All of the surface on each process, as it is small beside the tetrahedra. */
cdm::Status DistributedMesh::GatherSurface(vtkPolyData* input)
{
  const bool hasTriangles = !this->Surface.Triangles.empty();
  const bool hasLabels = !this->Surface.Labels.empty();
  const std::int64_t withLabels = this->Processes.Sum(hasTriangles && hasLabels ? 1 : 0);
  const std::int64_t withoutLabels = this->Processes.Sum(hasTriangles && !hasLabels ? 1 : 0);
  this->HasSurface = withLabels + withoutLabels > 0;
  if (!this->HasSurface)
  {
    return {};
  }
  if (withLabels > 0 && withoutLabels > 0)
  {
    return cdm::Status::InvalidInput(
      "Only some processes have the cell array BoundaryLabels on their surface.");
  }
  std::vector<SurfaceTriangle> own;
  for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
  {
    own.push_back({ this->Surface.Triangles[t],
      hasLabels ? this->Surface.Labels[t] : cdm::RegionPair(), this->SurfaceCells[t] });
  }
  const std::vector<ProcessGroup::Bytes> triangles =
    this->Processes.Gather(ProcessGroup::Pack(own));
  const std::vector<ProcessGroup::Bytes> points =
    this->Processes.Gather(ProcessGroup::Pack(this->Pieces[0].Points));
  const std::set<std::string> arrays = Intersect(this->Processes,
    hasTriangles ? GetSignatures(input->GetCellData()) : std::set<std::string>(), hasTriangles);
  std::vector<ProcessGroup::Bytes> tables;
  if (!arrays.empty())
  {
    vtkNew<vtkDataSetAttributes> data;
    if (hasTriangles)
    {
      PassArrays(input->GetCellData(), arrays, data);
    }
    tables =
      this->Processes.Gather(hasTriangles ? ProcessGroup::Pack(SelectRows(data, this->SurfaceCells))
                                          : ProcessGroup::Bytes());
  }

  // Points at the same place are one, which has their lowest number.
  struct Entry
  {
    cdm::NumberedPoint Point;
    std::size_t Place;
  };
  std::vector<Entry> entries;
  std::vector<std::size_t> starts;
  for (const ProcessGroup::Bytes& bytes : points)
  {
    starts.push_back(entries.size());
    for (const cdm::NumberedPoint& point : ProcessGroup::Unpack<cdm::NumberedPoint>(bytes))
    {
      entries.push_back({ point, entries.size() });
    }
  }
  std::vector<char> isUsed(entries.size(), 0);
  std::vector<std::vector<SurfaceTriangle>> pieces;
  for (std::size_t rank = 0; rank < triangles.size(); ++rank)
  {
    pieces.push_back(ProcessGroup::Unpack<SurfaceTriangle>(triangles[rank]));
    for (const SurfaceTriangle& triangle : pieces.back())
    {
      for (cdm::Id point : triangle.Points)
      {
        isUsed[starts[rank] + point] = 1;
      }
    }
  }
  std::sort(entries.begin(), entries.end(),
    [](const Entry& p, const Entry& q)
    {
      return p.Point.Position != q.Point.Position ? p.Point.Position < q.Point.Position
                                                  : p.Point.Number < q.Point.Number;
    });
  std::vector<std::pair<cdm::NumberedPoint, std::vector<std::size_t>>> used;
  for (auto begin = entries.begin(), end = begin; begin != entries.end(); begin = end)
  {
    std::vector<std::size_t> places;
    for (; end != entries.end() && end->Point.Position == begin->Point.Position; ++end)
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
    [](const auto& p, const auto& q) { return IsLessByNumber(p.first, q.first); });
  std::vector<cdm::Id> ids(entries.size(), cdm::NoId);
  this->Surface = cdm::TriangleMesh();
  for (const auto& [point, places] : used)
  {
    for (std::size_t place : places)
    {
      ids[place] = static_cast<cdm::Id>(this->Surface.Points.size());
    }
    this->Surface.Points.push_back(point.Position);
  }
  std::vector<Row> rows;
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    for (std::size_t t = 0; t < pieces[rank].size(); ++t)
    {
      cdm::TriangleIds triangle = pieces[rank][t].Points;
      for (cdm::Id& point : triangle)
      {
        point = ids[starts[rank] + point];
      }
      this->Surface.Triangles.push_back(triangle);
      if (withLabels > 0)
      {
        this->Surface.Labels.push_back(pieces[rank][t].Labels);
      }
      this->SurfaceSources.emplace_back(static_cast<int>(rank), pieces[rank][t].Cell);
      rows.emplace_back(rank, static_cast<vtkIdType>(t));
    }
  }
  const cdm::Status status = this->RemoveCopiedTriangles(rows);
  this->SurfaceCellData = vtkSmartPointer<vtkTable>::New();
  std::vector<vtkSmartPointer<vtkTable>> parts;
  for (const ProcessGroup::Bytes& bytes : tables)
  {
    parts.emplace_back(
      bytes.empty() ? nullptr : vtkTable::SafeDownCast(ProcessGroup::UnpackData(bytes)));
  }
  MergeRows(parts, rows, this->SurfaceCellData->GetRowData());
  return status;
}

//--------------------------------------------------------------------------------------------------
/** Where two processes have the same triangle, that of the first one stays. */
cdm::Status DistributedMesh::RemoveCopiedTriangles(std::vector<Row>& rows)
{
  std::vector<char> isCopy(this->Surface.Triangles.size(), 0);
  cdm::Status status;
  for (const cdm::DuplicateTriangle& copy : cdm::FindDuplicateTriangles(this->Surface.Triangles))
  {
    isCopy[copy.Triangle] = 1;
    if (this->SurfaceSources[copy.Triangle].first == this->SurfaceSources[copy.Original].first)
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
      this->Surface.Triangles[kept] = this->Surface.Triangles[t];
      this->SurfaceSources[kept] = this->SurfaceSources[t];
      if (!this->Surface.Labels.empty())
      {
        this->Surface.Labels[kept] = this->Surface.Labels[t];
      }
      rows[kept++] = rows[t];
    }
  }
  this->Surface.Triangles.resize(kept);
  this->Surface.Labels.resize(this->Surface.Labels.empty() ? 0 : kept);
  this->SurfaceSources.resize(kept);
  rows.resize(kept);
  return status;
}

//--------------------------------------------------------------------------------------------------
/** Triangles of a status as cells of the input, or in the message with the process they are of. */
void DistributedMesh::NameTriangles(cdm::Status& status) const
{
  if (status.Cells.empty())
  {
    return;
  }
  if (this->Processes.IsAlone())
  {
    for (cdm::Id& cell : status.Cells)
    {
      cell = static_cast<cdm::Id>(this->SurfaceSources[cell].second);
    }
    return;
  }
  status.Message += " Cells: ";
  for (std::size_t i = 0; i < std::min(status.Cells.size(), NamedTriangles); ++i)
  {
    const auto& [rank, cell] = this->SurfaceSources[status.Cells[i]];
    status.Message +=
      (i > 0 ? ", " : "") + std::to_string(cell) + " of process " + std::to_string(rank);
  }
  status.Message += (status.Cells.size() > NamedTriangles ? ", ... (" : " (") +
    std::to_string(status.Cells.size()) + " in all).";
  status.Cells.clear();
}

//--------------------------------------------------------------------------------------------------
/** The regions that the surface encloses, and the diagonals that a mesh has in its flat facets. */
cdm::Status DistributedMesh::CheckSurface()
{
  const std::vector<cdm::Vec3>& points = this->Surface.Points;
  std::vector<cdm::TriangleIds>& triangles = this->Surface.Triangles;
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
  cdm::RegionLocator locator(this->Surface);
  cdm::Status status = locator.Build();
  for (std::size_t t = 0; t < triangles.size() && status.IsOk(); ++t)
  {
    cdm::RegionPair regions = locator.GetRegions(static_cast<cdm::Id>(t));
    // Without labels the outer side of a component does not know what is around it.
    if (this->Surface.Labels.empty())
    {
      regions.Front =
        regions.Front == cdm::OutsideRegion ? cdm::PartRegions::Unknown : regions.Front;
      regions.Back = regions.Back == cdm::OutsideRegion ? cdm::PartRegions::Unknown : regions.Back;
    }
    this->SideRegions.push_back(regions);
  }
  const cdm::FacetPolygons polygons(this->Surface);
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
  this->Surface.Labels.clear();
  return status;
}

//--------------------------------------------------------------------------------------------------
/** Cuts space, and sends each point with its data to the process in whose cell it lies. */
cdm::Status DistributedMesh::Distribute()
{
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  const std::int64_t own =
    static_cast<std::int64_t>(this->Pieces[0].Points.size() + this->Pieces[1].Points.size());
  const std::int64_t size =
    std::max(SampleSize, SampleSizeOfProcess * static_cast<std::int64_t>(count));
  const std::int64_t step = std::max<std::int64_t>(1, this->Processes.Sum(own) / size);
  std::vector<cdm::Vec3> sample;
  std::int64_t next = 0;
  for (const Piece& piece : this->Pieces)
  {
    for (const cdm::NumberedPoint& point : piece.Points)
    {
      if (next++ % step == 0)
      {
        sample.push_back(point.Position);
      }
    }
  }
  this->Partition = std::make_unique<cdm::SpacePartition>(
    this->Processes.GatherAll(sample), this->Processes.GetSize());

  std::vector<cdm::NumberedPoint> all;
  std::vector<std::int64_t> numbersByRow;
  std::vector<Row> rows;
  for (const Piece& piece : this->Pieces)
  {
    std::vector<std::vector<cdm::NumberedPoint>> messages(count);
    std::vector<std::vector<vtkIdType>> rowsOfPart(count);
    for (std::size_t i = 0; i < piece.Points.size(); ++i)
    {
      const std::size_t part = static_cast<std::size_t>(this->GetOwner(piece.Points[i].Position));
      messages[part].push_back(piece.Points[i]);
      rowsOfPart[part].push_back(static_cast<vtkIdType>(i));
    }
    std::vector<ProcessGroup::Bytes> tables(count);
    cdm::Status status = this->Do(
      [&]
      {
        for (std::size_t part = 0; part < count; ++part)
        {
          if (!rowsOfPart[part].empty() && piece.Data->GetNumberOfArrays() > 0)
          {
            tables[part] = ProcessGroup::Pack(SelectRows(piece.Data, rowsOfPart[part]));
          }
        }
        return cdm::Status();
      });
    std::vector<std::vector<cdm::NumberedPoint>> points;
    std::vector<ProcessGroup::Bytes> receivedTables;
    if (status.IsOk())
    {
      status = this->Processes.Exchange(messages, points);
    }
    if (status.IsOk())
    {
      status = this->Processes.Exchange(std::move(tables), receivedTables);
    }
    if (!status.IsOk())
    {
      return status;
    }
    for (std::size_t part = 0; part < count; ++part)
    {
      for (std::size_t i = 0; i < points[part].size(); ++i)
      {
        all.push_back(points[part][i]);
        rows.emplace_back(this->Tables.size(), static_cast<vtkIdType>(i));
      }
      const ProcessGroup::Bytes& bytes = receivedTables[part];
      this->Tables.emplace_back(
        bytes.empty() ? nullptr : vtkTable::SafeDownCast(ProcessGroup::UnpackData(bytes)));
    }
  }
  this->OwnPoints = all;
  cdm::RemoveCopies(this->OwnPoints);
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
    [&all](std::size_t a, std::size_t b) { return all[a].Number < all[b].Number; });
  std::size_t place = 0;
  for (const cdm::NumberedPoint& point : this->OwnPoints)
  {
    while (all[order[place]].Number != point.Number)
    {
      ++place;
    }
    this->Rows.push_back(rows[order[place]]);
  }
  // Copies on the surface are what its pieces share.
  const std::int64_t first = this->HasSurface ? this->FirstMeshPoint : 0;
  const auto countFrom = [first](const std::vector<cdm::NumberedPoint>& points)
  {
    return std::count_if(points.begin(), points.end(),
      [first](const cdm::NumberedPoint& point) { return point.Number >= first; });
  };
  this->NumberOfUnusedMeshPoints = countFrom(all) - countFrom(this->OwnPoints);
  return {};
}

//--------------------------------------------------------------------------------------------------
/** Four points that are not in one plane, the same for all processes. */
cdm::Status DistributedMesh::FindSimplex(std::vector<cdm::NumberedPoint>& simplex)
{
  static const char* const messages[4] = { "The input has no points.",
    "A mesh needs four points that do not coincide.",
    "All points lie on one line: they have no tetrahedra.",
    "All points lie in one plane: they have no tetrahedra." };
  for (const char* message : messages)
  {
    std::vector<cdm::NumberedPoint> found;
    const cdm::Id point = cdm::FindIndependentPoint(this->OwnPoints, simplex);
    if (point != cdm::NoId)
    {
      found.push_back(this->OwnPoints[point]);
    }
    found = this->Processes.GatherAll(found);
    if (found.empty())
    {
      return cdm::Status::InvalidInput(message);
    }
    simplex.push_back(found.front());
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedMesh::MakePart()
{
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  std::vector<cdm::NumberedPoint> simplex;
  cdm::Status status = this->FindSimplex(simplex);
  if (!status.IsOk())
  {
    return status;
  }
  cdm::Box bounds;
  for (const cdm::NumberedPoint& point : this->OwnPoints)
  {
    bounds.Add(point.Position);
  }
  const std::vector<cdm::Box> allBounds =
    this->Processes.GatherAll(std::vector<cdm::Box>{ bounds });
  std::vector<std::vector<cdm::Box>> boxes;
  status = this->Do(
    [&]
    {
      this->Part = std::make_unique<cdm::PartTetrahedralization>(std::move(this->OwnPoints),
        this->Processes.GetRank(), allBounds, this->Partition->GetCell(this->Processes.GetRank()));
      this->Part->AddPoints(simplex);
      boxes = this->Part->GetHaloBoxes();
      return cdm::Status();
    });
  std::vector<std::vector<cdm::Box>> wanted;
  if (status.IsOk())
  {
    status = this->Processes.Exchange(boxes, wanted);
  }
  std::vector<std::vector<char>> isComplete(count);
  std::vector<std::vector<cdm::NumberedPoint>> points(count);
  if (status.IsOk())
  {
    status = this->Do(
      [&]
      {
        for (std::size_t part = 0; part < count; ++part)
        {
          cdm::HaloPoints halo = this->Part->GetPointsIn(wanted[part]);
          isComplete[part] = std::move(halo.IsComplete);
          points[part] = std::move(halo.Points);
        }
        return cdm::Status();
      });
  }
  std::vector<std::vector<char>> completeThere;
  std::vector<std::vector<cdm::NumberedPoint>> pointsThere;
  if (status.IsOk())
  {
    status = this->Processes.Exchange(isComplete, completeThere);
  }
  if (status.IsOk())
  {
    status = this->Processes.Exchange(points, pointsThere);
  }
  if (status.IsOk())
  {
    status = this->Do(
      [&]
      {
        std::vector<cdm::HaloPoints> halo(count);
        for (std::size_t part = 0; part < count; ++part)
        {
          halo[part] = { std::move(completeThere[part]), std::move(pointsThere[part]) };
        }
        this->Part->TakeHalo(halo);
        return cdm::Status();
      });
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
/** Rounds of making tetrahedra and asking the other processes about them. */
cdm::Status DistributedMesh::Tetrahedralize()
{
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  // The first round takes most of the time; each of the others a part of what is left.
  double begin = 0.1;
  double end = 0.7;
  for (bool isFinal = false; !isFinal;)
  {
    const cdm::ExecutionContext part = this->Context.Part(begin, end);
    begin = end;
    end += 0.5 * (0.85 - end);
    ++this->NumberOfRounds;
    cdm::Status status =
      this->Do([&] { return this->Part->Update(this->NumberOfThreads, part.Part(0.0, 0.9)); });
    std::vector<std::vector<cdm::ConflictQuery>> queries;
    if (status.IsOk())
    {
      status = this->Processes.Exchange(this->Part->GetQueries(), queries);
    }
    std::vector<std::vector<char>> hasConflict(count);
    std::vector<std::vector<cdm::NumberedPoint>> points(count);
    if (status.IsOk())
    {
      status = this->Do(
        [&]
        {
          cdm::Status step;
          for (std::size_t i = 0; i < count && step.IsOk(); ++i)
          {
            cdm::ConflictAnswers answers;
            step = this->Part->Answer(queries[i], part.Part(0.9, 1.0), answers);
            hasConflict[i] = std::move(answers.HasConflict);
            points[i] = std::move(answers.Points);
          }
          return step;
        });
    }
    std::vector<std::vector<char>> conflictsThere;
    std::vector<std::vector<cdm::NumberedPoint>> pointsThere;
    if (status.IsOk())
    {
      status = this->Processes.Exchange(hasConflict, conflictsThere);
    }
    if (status.IsOk())
    {
      status = this->Processes.Exchange(points, pointsThere);
    }
    if (status.IsOk())
    {
      status = this->Do(
        [&]
        {
          std::vector<cdm::ConflictAnswers> answers(count);
          for (std::size_t i = 0; i < count; ++i)
          {
            answers[i] = { std::move(conflictsThere[i]), std::move(pointsThere[i]) };
          }
          isFinal = this->Part->TakeAnswers(answers);
          return cdm::Status();
        });
    }
    if (!status.IsOk())
    {
      return status;
    }
    isFinal = this->Processes.Sum(isFinal ? 0 : 1) == 0;
  }
  this->NumberOfOwnPoints = this->Part->GetNumberOfOwnPoints();
  this->Points = this->Part->GetPoints();
  this->NumberOfHaloPoints = static_cast<vtkIdType>(this->Points.size()) - this->NumberOfOwnPoints;
  this->Mesh.Tetrahedra = std::move(this->Part->GetTetrahedra());
  this->Hull = std::move(this->Part->GetHull());
  this->Part.reset();
  this->Mesh.Regions.assign(this->Mesh.Tetrahedra.size(), 0);
  return {};
}

//--------------------------------------------------------------------------------------------------
void DistributedMesh::FindSurfacePlaces()
{
  std::vector<cdm::Id> order(this->Points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [this](cdm::Id a, cdm::Id b) { return this->Points[a].Position < this->Points[b].Position; });
  for (const cdm::Vec3& position : this->Surface.Points)
  {
    const auto place = std::lower_bound(order.begin(), order.end(), position,
      [this](cdm::Id a, const cdm::Vec3& p) { return this->Points[a].Position < p; });
    this->SurfacePlaces.push_back(
      place != order.end() && this->Points[*place].Position == position ? *place : cdm::NoId);
  }
}

//--------------------------------------------------------------------------------------------------
/** Regions go from the surface to what it bounds, and on to the processes that share that. */
cdm::Status DistributedMesh::FindRegions()
{
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  std::vector<cdm::TriangleIds> triangles;
  std::vector<cdm::RegionPair> sides;
  cdm::Status status = this->Do(
    [&]
    {
      for (const cdm::NumberedPoint& point : this->Points)
      {
        this->Mesh.Points.push_back(point.Position);
      }
      this->FindSurfacePlaces();
      for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
      {
        cdm::TriangleIds ids = this->Surface.Triangles[t];
        std::transform(ids.begin(), ids.end(), ids.begin(),
          [this](cdm::Id id) { return this->SurfacePlaces[id]; });
        if (std::find(ids.begin(), ids.end(), cdm::NoId) == ids.end())
        {
          triangles.push_back(ids);
          sides.push_back(this->SideRegions[t]);
          this->PartTriangles.push_back(static_cast<cdm::Id>(t));
        }
      }
      return cdm::BuildNeighbors(this->Mesh);
    });
  if (!status.IsOk())
  {
    return status;
  }
  const auto nameTriangles = [&](cdm::Status& failure)
  {
    for (cdm::Id& cell : failure.Cells)
    {
      cell = this->PartTriangles[cell];
    }
    this->NameTriangles(failure);
    return failure;
  };
  cdm::PartRegions regions(this->Mesh, this->NumberOfOwnPoints, triangles, sides);
  const auto getKey = [this](cdm::Id tetrahedron)
  {
    Numbers key;
    const cdm::TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
    std::transform(
      ids.begin(), ids.end(), key.begin(), [this](cdm::Id id) { return this->Points[id].Number; });
    std::sort(key.begin(), key.end());
    return key;
  };
  std::vector<std::pair<Numbers, cdm::Id>> shared;
  std::vector<cdm::Id> sharedIds;
  status = this->Do(
    [&]
    {
      for (std::size_t t = 0; t < this->Mesh.Tetrahedra.size(); ++t)
      {
        const cdm::TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
        if (*std::max_element(ids.begin(), ids.end()) >= this->NumberOfOwnPoints)
        {
          shared.emplace_back(getKey(static_cast<cdm::Id>(t)), static_cast<cdm::Id>(t));
          sharedIds.push_back(static_cast<cdm::Id>(t));
        }
      }
      std::sort(shared.begin(), shared.end());
      cdm::Status step = regions.Start();
      return nameTriangles(step);
    });
  for (bool hasNews = true; status.IsOk() && hasNews;)
  {
    const std::vector<cdm::Id> news = regions.TakeNews(sharedIds);
    std::vector<std::vector<SharedTetrahedron>> messages(count);
    for (cdm::Id t : news)
    {
      std::set<int> owners;
      for (cdm::Id id : this->Mesh.Tetrahedra[t])
      {
        if (id >= this->NumberOfOwnPoints)
        {
          owners.insert(this->GetOwner(this->Points[id].Position));
        }
      }
      for (int owner : owners)
      {
        messages[owner].push_back({ getKey(t), regions.GetRegion(t) });
      }
    }
    std::vector<std::vector<SharedTetrahedron>> received;
    status = this->Processes.Exchange(messages, received);
    if (status.IsOk())
    {
      status = this->Do(
        [&]
        {
          cdm::Status step;
          for (const std::vector<SharedTetrahedron>& message : received)
          {
            for (const SharedTetrahedron& item : message)
            {
              const auto place = std::lower_bound(
                shared.begin(), shared.end(), std::make_pair(item.Key, cdm::Id(0)));
              if (place == shared.end() || place->first != item.Key)
              {
                return cdm::Status::InternalError("Processes do not agree on a tetrahedron.");
              }
              step = regions.SetRegion(place->second, static_cast<cdm::Id>(item.Region));
              if (!step.IsOk())
              {
                return step;
              }
            }
          }
          return step;
        });
    }
    hasNews = this->Processes.Sum(static_cast<std::int64_t>(news.size())) > 0;
  }
  if (status.IsOk())
  {
    status = this->Do([&] { return regions.Finish(this->Mesh.Regions); });
  }
  for (std::size_t t = 0; t < triangles.size() && status.IsOk(); ++t)
  {
    const cdm::Id side = static_cast<cdm::Id>(2 * t);
    this->PartLabels.push_back({ regions.GetSideRegion(side), regions.GetSideRegion(side + 1) });
  }
  this->Mesh.Neighbors = cdm::RawVector<cdm::TetrahedronIds>();
  return status;
}

//--------------------------------------------------------------------------------------------------
DistributedMesh::Cell DistributedMesh::MakeCell(
  const cdm::TetrahedronIds& ids, cdm::Id region) const
{
  // The lowest number first, then the lowest of the others, with the same orientation.
  static constexpr int Turns[4][4] = { { 0, 1, 2, 3 }, { 1, 0, 3, 2 }, { 2, 3, 0, 1 },
    { 3, 2, 1, 0 } };
  const auto isLess = [this](cdm::Id a, cdm::Id b)
  { return this->Points[a].Number < this->Points[b].Number; };
  const auto first = std::min_element(ids.begin(), ids.end(), isLess) - ids.begin();
  Cell cell{ {}, region };
  std::transform(Turns[first], Turns[first] + 4, cell.Ids.begin(), [&](int i) { return ids[i]; });
  const auto others = cell.Ids.begin() + 1;
  std::rotate(others, std::min_element(others, cell.Ids.end(), isLess), cell.Ids.end());
  return cell;
}

//--------------------------------------------------------------------------------------------------
/** By the numbers of their points: so the order does not depend on how they were found. */
void DistributedMesh::SortCells(std::ptrdiff_t begin, std::ptrdiff_t end)
{
  std::sort(this->Cells.begin() + begin, this->Cells.begin() + end,
    [this](const Cell& a, const Cell& b)
    {
      return std::lexicographical_compare(a.Ids.begin(), a.Ids.end(), b.Ids.begin(), b.Ids.end(),
        [this](cdm::Id p, cdm::Id q) { return this->Points[p].Number < this->Points[q].Number; });
    });
}

//--------------------------------------------------------------------------------------------------
template <typename Ids>
bool DistributedMesh::OwnsLowest(const Ids& ids) const
{
  return *std::min_element(ids.begin(), ids.end(),
           [this](cdm::Id a, cdm::Id b)
           { return this->Points[a].Number < this->Points[b].Number; }) < this->NumberOfOwnPoints;
}

//--------------------------------------------------------------------------------------------------
void DistributedMesh::CollectOwn()
{
  std::vector<char> isUsed(static_cast<std::size_t>(this->NumberOfOwnPoints), 0);
  std::vector<cdm::Id> starts(static_cast<std::size_t>(this->NumberOfOwnPoints) + 1, 0);
  for (std::size_t t = 0; t < this->Mesh.Tetrahedra.size(); ++t)
  {
    const cdm::TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
    if (this->Mesh.Regions[t] == cdm::OutsideRegion)
    {
      continue;
    }
    for (cdm::Id id : ids)
    {
      if (id < this->NumberOfOwnPoints)
      {
        isUsed[id] = 1;
      }
    }
    if (this->OwnsLowest(ids))
    {
      this->Cells.push_back(this->MakeCell(ids, this->Mesh.Regions[t]));
      ++starts[this->Cells.back().Ids[0] + 1];
    }
  }
  // Own points are in the order of their numbers: so are the cells after this, but for those of one
  // point.
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Cell> sorted(this->Cells.size());
  std::vector<cdm::Id> next(starts);
  for (const Cell& cell : this->Cells)
  {
    sorted[next[cell.Ids[0]]++] = cell;
  }
  this->Cells.swap(sorted);
  for (cdm::Id i = 0; i < this->NumberOfOwnPoints; ++i)
  {
    this->SortCells(starts[i], starts[i + 1]);
  }
  this->NumberOfOwnCells = this->Cells.size();
  for (cdm::Id i = 0; i < this->NumberOfOwnPoints; ++i)
  {
    this->NumberOfUnusedMeshPoints += !isUsed[i] && this->Points[i].Number >= this->FirstMeshPoint;
  }
}

//--------------------------------------------------------------------------------------------------
/** Level by level all tetrahedra at the points of those before. */
cdm::Status DistributedMesh::AddGhosts()
{
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  // The tetrahedra of this process at each of its points. Those at its own points are all.
  std::vector<cdm::Id> starts(this->Points.size() + 1, 0);
  std::vector<cdm::Id> stars;
  std::unordered_map<std::int64_t, cdm::Id> places;
  std::vector<char> isTaken(this->Mesh.Tetrahedra.size(), 0);
  cdm::Status status = this->Do(
    [&]
    {
      const auto isMeshed = [this](std::size_t t)
      { return this->Mesh.Regions[t] != cdm::OutsideRegion; };
      for (std::size_t t = 0; t < isTaken.size(); ++t)
      {
        isTaken[t] = isMeshed(t) && this->OwnsLowest(this->Mesh.Tetrahedra[t]);
        for (cdm::Id id : this->Mesh.Tetrahedra[t])
        {
          starts[id] += isMeshed(t);
        }
      }
      std::partial_sum(starts.begin(), starts.end(), starts.begin());
      stars.resize(static_cast<std::size_t>(starts.back()));
      for (std::size_t t = isTaken.size(); t-- > 0;)
      {
        for (cdm::Id id : this->Mesh.Tetrahedra[t])
        {
          if (isMeshed(t))
          {
            stars[--starts[id]] = static_cast<cdm::Id>(t);
          }
        }
      }
      for (std::size_t i = 0; i < this->Points.size(); ++i)
      {
        places.emplace(this->Points[i].Number, static_cast<cdm::Id>(i));
      }
      return cdm::Status();
    });
  const cdm::Id numberOfPartPoints = static_cast<cdm::Id>(this->Points.size());
  std::vector<char> isReached(this->Points.size(), 0);
  std::set<Numbers> ghosts;
  std::size_t firstOfLevel = 0;
  for (int level = 0; level < this->NumberOfGhostLevels && status.IsOk(); ++level)
  {
    std::vector<std::vector<std::int64_t>> requests(count);
    const std::size_t endOfLevel = this->Cells.size();
    for (; firstOfLevel < endOfLevel; ++firstOfLevel)
    {
      for (cdm::Id id : cdm::TetrahedronIds(this->Cells[firstOfLevel].Ids))
      {
        if (isReached[id])
        {
          continue;
        }
        isReached[id] = 1;
        for (cdm::Id i = id < numberOfPartPoints ? starts[id] : 0;
             id < numberOfPartPoints && i < starts[id + 1]; ++i)
        {
          if (!isTaken[stars[i]])
          {
            isTaken[stars[i]] = 1;
            this->Cells.push_back(
              this->MakeCell(this->Mesh.Tetrahedra[stars[i]], this->Mesh.Regions[stars[i]]));
          }
        }
        if (id >= this->NumberOfOwnPoints)
        {
          requests[this->GetOwner(this->Points[id].Position)].push_back(this->Points[id].Number);
        }
      }
    }
    std::vector<std::vector<std::int64_t>> asked;
    status = this->Processes.Exchange(requests, asked);
    std::vector<std::vector<GhostTetrahedron>> answers(count);
    if (status.IsOk())
    {
      status = this->Do(
        [&]
        {
          for (std::size_t i = 0; i < count; ++i)
          {
            std::set<cdm::Id> sent;
            for (std::int64_t number : asked[i])
            {
              const cdm::Id id = places.at(number);
              for (cdm::Id k = starts[id]; k < starts[id + 1]; ++k)
              {
                if (sent.insert(stars[k]).second)
                {
                  const cdm::TetrahedronIds& ids = this->Mesh.Tetrahedra[stars[k]];
                  answers[i].push_back({ { this->Points[ids[0]], this->Points[ids[1]],
                                           this->Points[ids[2]], this->Points[ids[3]] },
                    this->Mesh.Regions[stars[k]] });
                }
              }
            }
          }
          return cdm::Status();
        });
    }
    std::vector<std::vector<GhostTetrahedron>> received;
    if (status.IsOk())
    {
      status = this->Processes.Exchange(answers, received);
    }
    if (status.IsOk())
    {
      status = this->Do(
        [&]
        {
          for (const std::vector<GhostTetrahedron>& message : received)
          {
            for (const GhostTetrahedron& item : message)
            {
              cdm::TetrahedronIds ids;
              Numbers key;
              for (int i = 0; i < 4; ++i)
              {
                const auto place =
                  places.emplace(item.Points[i].Number, static_cast<cdm::Id>(this->Points.size()));
                if (place.second)
                {
                  this->Points.push_back(item.Points[i]);
                  isReached.push_back(0);
                }
                ids[i] = place.first->second;
                key[i] = item.Points[i].Number;
              }
              std::sort(key.begin(), key.end());
              // Those at own points are known.
              if (*std::min_element(ids.begin(), ids.end()) >= this->NumberOfOwnPoints &&
                ghosts.insert(key).second)
              {
                this->Cells.push_back(this->MakeCell(ids, static_cast<cdm::Id>(item.Region)));
              }
            }
          }
          return cdm::Status();
        });
    }
  }
  if (status.IsOk())
  {
    this->SortCells(static_cast<std::ptrdiff_t>(this->NumberOfOwnCells),
      static_cast<std::ptrdiff_t>(this->Cells.size()));
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
void DistributedMesh::CollectBoundary()
{
  for (std::size_t i = 0; i < this->PartTriangles.size(); ++i)
  {
    cdm::TriangleIds ids = this->Surface.Triangles[this->PartTriangles[i]];
    std::transform(
      ids.begin(), ids.end(), ids.begin(), [this](cdm::Id id) { return this->SurfacePlaces[id]; });
    const cdm::RegionPair& labels = this->PartLabels[i];
    if (this->OwnsLowest(ids) && labels != cdm::RegionPair())
    {
      this->Boundary.Triangles.push_back(ids);
      this->Boundary.Labels.push_back(labels);
      this->Boundary.SourceCells.push_back(this->PartTriangles[i]);
    }
  }
  const auto isLess = [this](cdm::Id a, cdm::Id b)
  { return this->Points[a].Number < this->Points[b].Number; };
  for (cdm::TriangleIds ids : this->Hull)
  {
    if (!this->HasSurface && this->OwnsLowest(ids))
    {
      std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end(), isLess), ids.end());
      this->Boundary.Triangles.push_back(ids);
      this->Boundary.Labels.push_back({ cdm::OutsideRegion, 0 });
    }
  }
  if (!this->HasSurface)
  {
    std::sort(this->Boundary.Triangles.begin(), this->Boundary.Triangles.end(),
      [&isLess](const cdm::TriangleIds& s, const cdm::TriangleIds& t)
      { return std::lexicographical_compare(s.begin(), s.end(), t.begin(), t.end(), isLess); });
  }
}

//--------------------------------------------------------------------------------------------------
/** Point data of the points of others that are in the outputs. */
cdm::Status DistributedMesh::FetchPointData()
{
  if (!this->HasPointData)
  {
    return {};
  }
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  std::vector<char> isUsed(this->Points.size(), 0);
  for (const Cell& cell : this->Cells)
  {
    for (cdm::Id id : cell.Ids)
    {
      isUsed[id] = 1;
    }
  }
  for (const cdm::TriangleIds& triangle : this->Boundary.Triangles)
  {
    for (cdm::Id id : triangle)
    {
      isUsed[id] = 1;
    }
  }
  this->Rows.resize(this->Points.size());
  std::vector<std::vector<std::int64_t>> requests(count);
  for (std::size_t i = static_cast<std::size_t>(this->NumberOfOwnPoints); i < isUsed.size(); ++i)
  {
    if (isUsed[i])
    {
      std::vector<std::int64_t>& request = requests[this->GetOwner(this->Points[i].Position)];
      this->Rows[i] = { static_cast<std::size_t>(this->GetOwner(this->Points[i].Position)) +
          this->Tables.size(),
        static_cast<vtkIdType>(request.size()) };
      request.push_back(this->Points[i].Number);
    }
  }
  std::vector<std::vector<std::int64_t>> asked;
  cdm::Status status = this->Processes.Exchange(requests, asked);
  std::vector<ProcessGroup::Bytes> answers(count);
  if (status.IsOk())
  {
    status = this->Do(
      [&]
      {
        for (std::size_t i = 0; i < count; ++i)
        {
          std::vector<Row> rows;
          for (std::int64_t number : asked[i])
          {
            const auto place =
              std::lower_bound(this->Points.begin(), this->Points.begin() + this->NumberOfOwnPoints,
                cdm::NumberedPoint{ {}, number }, IsLessByNumber);
            rows.push_back(this->Rows[place - this->Points.begin()]);
          }
          if (!rows.empty())
          {
            vtkNew<vtkTable> table;
            MergeRows(this->Tables, rows, table->GetRowData());
            answers[i] = ProcessGroup::Pack(table);
          }
        }
        return cdm::Status();
      });
  }
  std::vector<ProcessGroup::Bytes> received;
  if (status.IsOk())
  {
    status = this->Processes.Exchange(std::move(answers), received);
  }
  for (const ProcessGroup::Bytes& bytes : received)
  {
    this->Tables.emplace_back(
      bytes.empty() ? nullptr : vtkTable::SafeDownCast(ProcessGroup::UnpackData(bytes)));
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedMesh::Run(vtkPointSet* input, vtkPointSet* meshPoints)
{
  vtkPolyData* surface = vtkPolyData::SafeDownCast(input);
  cdm::Status status = this->Do(
    [&]
    {
      cdm::Status step = this->ReadPoints(input, "input", 0);
      step = step.IsOk() ? this->ReadPoints(meshPoints, "mesh points", 1) : step;
      return step.IsOk() ? this->ReadSurface(surface) : step;
    });
  for (int port = 0; port < 2 && status.IsOk(); ++port)
  {
    status = this->Processes.Agree(this->NumberPoints(port == 0 ? input : meshPoints, port));
  }
  const auto next = [&status](const auto& step)
  {
    if (status.IsOk())
    {
      status = step();
    }
  };
  if (this->HasGlobalIds)
  {
    next([&] { return this->CheckNumbers(); });
  }
  next([&] { return this->ChooseArrays(input, meshPoints); });
  next([&] { return this->GatherSurface(surface); });
  if (this->HasSurface)
  {
    next(
      [&]
      {
        return this->Do(
          [&]
          {
            cdm::Status step = this->CheckSurface();
            this->NameTriangles(step);
            return step;
          });
      });
  }
  next([&] { return this->Distribute(); });
  next([&] { return this->MakePart(); });
  next([&] { return this->Tetrahedralize(); });
  if (this->HasSurface)
  {
    next([&] { return this->FindRegions(); });
  }
  next(
    [&]
    {
      return this->Do(
        [&]
        {
          this->CollectOwn();
          this->CollectBoundary();
          return cdm::Status();
        });
    });
  if (!this->Processes.IsAlone())
  {
    next([&] { return this->AddGhosts(); });
  }
  next([&] { return this->FetchPointData(); });
  this->NumberOfUnusedMeshPoints = this->Processes.Sum(this->NumberOfUnusedMeshPoints);
  return status;
}

//--------------------------------------------------------------------------------------------------
/** Puts the given places, in the order of their numbers, into a data set; returns where each is. */
std::vector<cdm::Id> DistributedMesh::CompressPoints(
  const std::vector<cdm::Id>& places, vtkPointSet* output) const
{
  std::vector<char> isUsed(this->Points.size(), 0);
  for (cdm::Id place : places)
  {
    isUsed[place] = 1;
  }
  std::vector<cdm::Id> used;
  for (std::size_t i = 0; i < isUsed.size(); ++i)
  {
    if (isUsed[i])
    {
      used.push_back(static_cast<cdm::Id>(i));
    }
  }
  std::sort(used.begin(), used.end(),
    [this](cdm::Id a, cdm::Id b) { return this->Points[a].Number < this->Points[b].Number; });
  std::vector<cdm::Id> newPlaces(this->Points.size(), cdm::NoId);
  std::vector<cdm::Vec3> positions;
  std::vector<std::int64_t> numbers;
  std::vector<Row> rows;
  auto ghosts = MakeGhostArray(used.size());
  for (cdm::Id place : used)
  {
    const std::size_t i = positions.size();
    newPlaces[place] = static_cast<cdm::Id>(i);
    positions.push_back(this->Points[place].Position);
    numbers.push_back(this->Points[place].Number);
    if (this->HasPointData)
    {
      rows.push_back(this->Rows[place]);
    }
    if (place >= this->NumberOfOwnPoints)
    {
      ghosts->SetValue(static_cast<vtkIdType>(i), vtkDataSetAttributes::DUPLICATEPOINT);
    }
  }
  output->SetPoints(vtkCoreBridge::FromPoints(positions));
  MergeRows(this->Tables, rows, output->GetPointData());
  output->GetPointData()->SetGlobalIds(MakeGlobalIds(numbers));
  if (!this->Processes.IsAlone())
  {
    output->GetPointData()->AddArray(ghosts);
  }
  return newPlaces;
}

//--------------------------------------------------------------------------------------------------
void DistributedMesh::MakeMesh(vtkUnstructuredGrid* output) const
{
  cdm::TetMesh mesh;
  std::vector<cdm::Id> places;
  for (const Cell& cell : this->Cells)
  {
    mesh.Tetrahedra.push_back(cell.Ids);
    mesh.Regions.push_back(cell.Region);
    places.insert(places.end(), cell.Ids.begin(), cell.Ids.end());
  }
  vtkNew<vtkUnstructuredGrid> points;
  const std::vector<cdm::Id> newPlaces = this->CompressPoints(places, points);
  for (cdm::TetrahedronIds& ids : mesh.Tetrahedra)
  {
    std::transform(
      ids.begin(), ids.end(), ids.begin(), [&newPlaces](cdm::Id id) { return newPlaces[id]; });
  }
  vtkCoreBridge::FromTetMesh(mesh, output);
  output->SetPoints(points->GetPoints());
  output->GetPointData()->ShallowCopy(points->GetPointData());
  if (!this->Processes.IsAlone())
  {
    auto ghosts = MakeGhostArray(this->Cells.size());
    for (std::size_t i = this->NumberOfOwnCells; i < this->Cells.size(); ++i)
    {
      ghosts->SetValue(static_cast<vtkIdType>(i), vtkDataSetAttributes::DUPLICATECELL);
    }
    output->GetCellData()->AddArray(ghosts);
  }
}

//--------------------------------------------------------------------------------------------------
void DistributedMesh::MakeBoundary(vtkPolyData* output) const
{
  cdm::TriangleMesh boundary;
  boundary.Labels = this->Boundary.Labels;
  std::vector<cdm::Id> places;
  for (const cdm::TriangleIds& ids : this->Boundary.Triangles)
  {
    places.insert(places.end(), ids.begin(), ids.end());
  }
  vtkNew<vtkPolyData> points;
  const std::vector<cdm::Id> newPlaces = this->CompressPoints(places, points);
  for (const cdm::TriangleIds& ids : this->Boundary.Triangles)
  {
    boundary.Triangles.push_back({ newPlaces[ids[0]], newPlaces[ids[1]], newPlaces[ids[2]] });
  }
  vtkCoreBridge::FromTriangleMesh(boundary, output);
  output->SetPoints(points->GetPoints());
  output->GetPointData()->ShallowCopy(points->GetPointData());
  if (this->HasSurface)
  {
    const std::vector<vtkIdType> sources(
      this->Boundary.SourceCells.begin(), this->Boundary.SourceCells.end());
    vtkCoreBridge::CopyTuples(this->SurfaceCellData->GetRowData(), sources, output->GetCellData(),
      { vtkCoreBridge::BoundaryLabelsName });
  }
}
