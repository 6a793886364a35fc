// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMesh.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Tuples.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Delaunay/PartRegions.h"
#include "Core/Meshes/MeshInvariants.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
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
#include <numeric>
#include <set>
#include <string>
#include <unordered_map>

namespace vtkDistributed
{
namespace
{
using Numbers = std::array<std::int64_t, 4>;

/** The region of a tetrahedron that another process has as well. */
struct SharedTetrahedron
{
  /** The numbers of its points, ascending. */
  Numbers Key;
  std::int64_t Region;
};

/** A tetrahedron with its points, for a process that has none of them. */
struct GhostTetrahedron
{
  std::array<cdm::NumberedPoint, 4> Points;
  std::int64_t Region;
};

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
DistributedMesh::DistributedMesh(
  ProcessGroup& processes, const cdm::ExecutionContext& context, int numberOfGhostLevels)
  : Processes(processes), Context(context), NumberOfGhostLevels(numberOfGhostLevels),
    Input(processes), Surface(processes)
{
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
  status = this->Processes.Do(
    [&]
    {
      const cdm::Status range = cdm::CheckIdRange(this->OwnPoints.size(), "points on one process");
      if (!range.IsOk())
      {
        return range;
      }
      this->Part = std::make_unique<cdm::PartTetrahedralization>(
        std::move(this->OwnPoints), this->Processes.GetRank(), allBounds, this->Input.GetCell());
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
    status = this->Processes.Do(
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
    status = this->Processes.Do(
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
      this->Processes.Do([&] { return this->Part->Update(part.Part(0.0, 0.9)); });
    std::vector<std::vector<cdm::ConflictQuery>> queries;
    if (status.IsOk())
    {
      status = this->Processes.Exchange(this->Part->GetQueries(), queries);
    }
    std::vector<std::vector<char>> hasConflict(count);
    std::vector<std::vector<cdm::NumberedPoint>> points(count);
    if (status.IsOk())
    {
      status = this->Processes.Do(
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
    if (status.IsOk() && this->Processes.Maximum(this->Part->GaveUp() ? 1 : 0) > 0)
    {
      this->Part->CompareStars();
      continue;
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
      status = this->Processes.Do(
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
  for (const cdm::Vec3& position : this->Surface.GetMesh().Points)
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
  cdm::Status status = this->Processes.Do(
    [&]
    {
      for (const cdm::NumberedPoint& point : this->Points)
      {
        this->Mesh.Points.push_back(point.Position);
      }
      this->FindSurfacePlaces();
      for (std::size_t t = 0; t < this->Surface.GetMesh().Triangles.size(); ++t)
      {
        cdm::TriangleIds ids = this->Surface.GetMesh().Triangles[t];
        std::transform(ids.begin(), ids.end(), ids.begin(),
          [this](cdm::Id id) { return this->SurfacePlaces[id]; });
        if (std::find(ids.begin(), ids.end(), cdm::NoId) == ids.end())
        {
          triangles.push_back(ids);
          sides.push_back(this->Surface.GetSideRegions()[t]);
          this->PartTriangles.push_back(static_cast<cdm::Id>(t));
        }
      }
      return cdm::BuildNeighbors(this->Mesh, this->Context.GetNumberOfThreads());
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
    this->Surface.NameTriangles(failure);
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
  status = this->Processes.Do(
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
          owners.insert(this->Input.GetOwner(this->Points[id].Position));
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
      status = this->Processes.Do(
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
    status = this->Processes.Do([&] { return regions.Finish(this->Mesh.Regions); });
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
/**
 * Sorts cells by the numbers of their points, so that the order does not depend on how they were
 * found.
 */
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
    this->NumberOfUnusedMeshPoints +=
      !isUsed[i] && this->Points[i].Number >= this->Input.GetFirstMeshPoint();
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
  cdm::Status status = this->Processes.Do(
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
          requests[this->Input.GetOwner(this->Points[id].Position)].push_back(
            this->Points[id].Number);
        }
      }
    }
    std::vector<std::vector<std::int64_t>> asked;
    status = this->Processes.Exchange(requests, asked);
    std::vector<std::vector<GhostTetrahedron>> answers(count);
    if (status.IsOk())
    {
      status = this->Processes.Do(
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
      status = this->Processes.Do(
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
    cdm::TriangleIds ids = this->Surface.GetMesh().Triangles[this->PartTriangles[i]];
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
    if (!this->Surface.Exists() && this->OwnsLowest(ids))
    {
      std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end(), isLess), ids.end());
      this->Boundary.Triangles.push_back(ids);
      this->Boundary.Labels.push_back({ cdm::OutsideRegion, 0 });
    }
  }
  if (!this->Surface.Exists())
  {
    std::sort(this->Boundary.Triangles.begin(), this->Boundary.Triangles.end(),
      [&isLess](const cdm::TriangleIds& s, const cdm::TriangleIds& t)
      { return std::lexicographical_compare(s.begin(), s.end(), t.begin(), t.end(), isLess); });
  }
}

//--------------------------------------------------------------------------------------------------
/** Marks the points that are in the outputs. */
std::vector<char> DistributedMesh::FindUsed() const
{
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
  return isUsed;
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedMesh::Run(vtkPointSet* input, vtkPointSet* meshPoints)
{
  vtkPolyData* surface = vtkPolyData::SafeDownCast(input);
  cdm::Status status = this->Processes.Do(
    [&]
    {
      cdm::Status step = this->Input.Read(input, "input", 0);
      step = step.IsOk() ? this->Input.Read(meshPoints, "mesh points", 1) : step;
      return step.IsOk() ? this->Surface.Read(surface) : step;
    });
  const auto next = [&status](const auto& step)
  {
    if (status.IsOk())
    {
      status = step();
    }
  };
  next([&] { return this->Input.Number(input, meshPoints); });
  next([&] { return this->Surface.Gather(surface, this->Input.GetPiece(0)); });
  if (this->Surface.Exists())
  {
    next([&] { return this->Processes.Do([&] { return this->Surface.Check(); }); });
  }
  next(
    [&]
    {
      // Copies on the surface are what its pieces share.
      return this->Input.Distribute(this->Surface.Exists() ? this->Input.GetFirstMeshPoint() : 0,
        this->OwnPoints, this->NumberOfUnusedMeshPoints);
    });
  next([&] { return this->MakePart(); });
  next([&] { return this->Tetrahedralize(); });
  if (this->Surface.Exists())
  {
    next([&] { return this->FindRegions(); });
  }
  next(
    [&]
    {
      return this->Processes.Do(
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
  next(
    [&] { return this->Input.FetchData(this->Points, this->NumberOfOwnPoints, this->FindUsed()); });
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
  auto ghosts = MakeGhostArray(used.size());
  for (cdm::Id place : used)
  {
    const std::size_t i = positions.size();
    newPlaces[place] = static_cast<cdm::Id>(i);
    positions.push_back(this->Points[place].Position);
    numbers.push_back(this->Points[place].Number);
    if (place >= this->NumberOfOwnPoints)
    {
      ghosts->SetValue(static_cast<vtkIdType>(i), vtkDataSetAttributes::DUPLICATEPOINT);
    }
  }
  output->SetPoints(vtkCoreBridge::FromPoints(positions));
  this->Input.CopyData(used, output->GetPointData());
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
  if (this->Surface.Exists())
  {
    const std::vector<vtkIdType> sources(
      this->Boundary.SourceCells.begin(), this->Boundary.SourceCells.end());
    vtkCoreBridge::CopyTuples(this->Surface.GetCellData()->GetRowData(), sources,
      output->GetCellData(), { vtkCoreBridge::BoundaryLabelsName });
  }
}
} // namespace vtkDistributed
