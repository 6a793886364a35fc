// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMesh.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Tuples.h"
#include "Distributed/GhostLevels.h"

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
#include <iterator>
#include <numeric>
#include <set>
#include <string>
#include <utility>

namespace vtkDistributed
{
namespace
{
/** The region of a tetrahedron that another process has as well. */
struct SharedTetrahedron
{
  /** The numbers of its points, ascending. */
  std::array<std::int64_t, 4> Key;
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

/**
 * Exchanges answers that each consist of flags and points: HaloPoints or ConflictAnswers, one for each
 * process.
 */
template <typename Answer>
cdm::Status Exchange(
  ProcessGroup& processes, std::vector<Answer>& answers, std::vector<Answer>& received)
{
  std::vector<std::vector<char>> flags;
  std::vector<std::vector<cdm::NumberedPoint>> points;
  for (auto& [ownFlags, ownPoints] : answers)
  {
    flags.push_back(std::move(ownFlags));
    points.push_back(std::move(ownPoints));
  }
  std::vector<std::vector<char>> flagsThere;
  std::vector<std::vector<cdm::NumberedPoint>> pointsThere;
  return processes.Exchange(flags, flagsThere)
    .Then([&] { return processes.Exchange(points, pointsThere); })
    .Then(
      [&]
      {
        for (std::size_t i = 0; i < flagsThere.size(); ++i)
        {
          received.push_back({ std::move(flagsThere[i]), std::move(pointsThere[i]) });
        }
        return cdm::Status();
      });
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
  const auto makePart = [&]
  {
    cdm::Status range = cdm::CheckIdRange(this->OwnPoints.size(), "points on one process");
    if (!range.IsOk())
    {
      return range;
    }
    this->Part = std::make_unique<cdm::PartTetrahedralization>(
      std::move(this->OwnPoints), this->Processes.GetRank(), allBounds, this->Input.GetCell());
    this->Part->AddPoints(simplex);
    boxes = this->Part->GetHaloBoxes();
    return range;
  };
  std::vector<std::vector<cdm::Box>> wanted;
  std::vector<cdm::HaloPoints> halo;
  const auto answer = [&]
  {
    for (const std::vector<cdm::Box>& boxesThere : wanted)
    {
      halo.push_back(this->Part->GetPointsIn(boxesThere));
    }
    return cdm::Status();
  };
  std::vector<cdm::HaloPoints> received;
  const auto takeAnswers = [&]
  {
    this->Part->TakeHalo(received);
    return cdm::Status();
  };
  return this->Processes.Do(makePart)
    .Then([&] { return this->Processes.Exchange(boxes, wanted); })
    .Then([&] { return this->Processes.Do(answer); })
    .Then([&] { return Exchange(this->Processes, halo, received); })
    .Then([&] { return this->Processes.Do(takeAnswers); });
}

//--------------------------------------------------------------------------------------------------
/**
 * One round of making tetrahedra and asking the other processes about them. isFinal: nobody has a
 * point that changes them.
 */
cdm::Status DistributedMesh::UpdateTetrahedra(const cdm::ExecutionContext& context, bool& isFinal)
{
  std::vector<std::vector<cdm::ConflictQuery>> queries;
  std::vector<cdm::ConflictAnswers> answers;
  const auto answer = [&]
  {
    cdm::Status step;
    for (std::size_t i = 0; i < queries.size() && step.IsOk(); ++i)
    {
      answers.emplace_back();
      step = this->Part->Answer(queries[i], context.Part(0.9, 1.0), answers.back());
    }
    return step;
  };
  cdm::Status status =
    this->Processes.Do([&] { return this->Part->Update(context.Part(0.0, 0.9)); })
      .Then([&] { return this->Processes.Exchange(this->Part->GetQueries(), queries); })
      .Then([&] { return this->Processes.Do(answer); });
  if (!status.IsOk())
  {
    return status;
  }
  if (this->Processes.Maximum(this->Part->GaveUp() ? 1 : 0) > 0)
  {
    this->Part->CompareStars();
    isFinal = false;
    return status;
  }
  bool isOwnFinal = false;
  std::vector<cdm::ConflictAnswers> received;
  const auto takeAnswers = [&]
  {
    isOwnFinal = this->Part->TakeAnswers(received);
    return cdm::Status();
  };
  status = Exchange(this->Processes, answers, received)
             .Then([&] { return this->Processes.Do(takeAnswers); });
  if (status.IsOk())
  {
    isFinal = this->Processes.Sum(isOwnFinal ? 0 : 1) == 0;
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedMesh::Tetrahedralize()
{
  // The first round takes most of the time; each of the others a part of what is left.
  double begin = 0.1;
  double end = 0.7;
  for (bool isFinal = false; !isFinal;)
  {
    const cdm::Status status = this->UpdateTetrahedra(this->Context.Part(begin, end), isFinal);
    if (!status.IsOk())
    {
      return status;
    }
    begin = end;
    end += 0.5 * (0.85 - end);
    ++this->NumberOfRounds;
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
/** The triangles of the surface that have all their points in the part, with those points. */
std::vector<cdm::TriangleIds> DistributedMesh::CollectPartTriangles()
{
  this->FindSurfacePlaces();
  std::vector<cdm::TriangleIds> triangles;
  for (std::size_t t = 0; t < this->Surface.GetMesh().Triangles.size(); ++t)
  {
    cdm::TriangleIds ids = this->Surface.GetMesh().Triangles[t];
    std::transform(
      ids.begin(), ids.end(), ids.begin(), [this](cdm::Id id) { return this->SurfacePlaces[id]; });
    if (std::find(ids.begin(), ids.end(), cdm::NoId) == ids.end())
    {
      triangles.push_back(ids);
      this->PartTriangles.push_back(static_cast<cdm::Id>(t));
    }
  }
  return triangles;
}

//--------------------------------------------------------------------------------------------------
/** The numbers of a tetrahedron's points, ascending: the same on all processes. */
DistributedMesh::Numbers DistributedMesh::GetKey(cdm::Id tetrahedron) const
{
  Numbers key;
  const cdm::TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
  std::transform(
    ids.begin(), ids.end(), key.begin(), [this](cdm::Id id) { return this->Points[id].Number; });
  std::sort(key.begin(), key.end());
  return key;
}

//--------------------------------------------------------------------------------------------------
/** The tetrahedra of this process that others have as well, ascending by their keys. */
std::vector<DistributedMesh::KeyedTetrahedron> DistributedMesh::CollectShared() const
{
  std::vector<KeyedTetrahedron> shared;
  for (std::size_t t = 0; t < this->Mesh.Tetrahedra.size(); ++t)
  {
    const cdm::TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
    if (*std::max_element(ids.begin(), ids.end()) >= this->NumberOfOwnPoints)
    {
      shared.emplace_back(this->GetKey(static_cast<cdm::Id>(t)), static_cast<cdm::Id>(t));
    }
  }
  std::sort(shared.begin(), shared.end());
  return shared;
}

//--------------------------------------------------------------------------------------------------
/** Tells the owners of the points of shared tetrahedra which regions these have got, and hears it. */
cdm::Status DistributedMesh::ExchangeRegions(const std::vector<KeyedTetrahedron>& shared,
  const std::vector<cdm::Id>& news, cdm::PartRegions& regions)
{
  std::vector<std::vector<SharedTetrahedron>> messages(
    static_cast<std::size_t>(this->Processes.GetSize()));
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
      messages[owner].push_back({ this->GetKey(t), regions.GetRegion(t) });
    }
  }
  std::vector<std::vector<SharedTetrahedron>> received;
  const auto setRegions = [&]
  {
    cdm::Status step;
    for (const std::vector<SharedTetrahedron>& message : received)
    {
      for (const SharedTetrahedron& item : message)
      {
        const auto place =
          std::lower_bound(shared.begin(), shared.end(), std::make_pair(item.Key, cdm::Id(0)));
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
  };
  return this->Processes.Exchange(messages, received)
    .Then([&] { return this->Processes.Do(setRegions); });
}

//--------------------------------------------------------------------------------------------------
/** Regions go from the surface to what it bounds, and on to the processes that share that. */
cdm::Status DistributedMesh::FindRegions()
{
  std::vector<cdm::TriangleIds> triangles;
  std::vector<cdm::RegionPair> sides;
  cdm::Status status = this->Processes.Do(
    [&]
    {
      for (const cdm::NumberedPoint& point : this->Points)
      {
        this->Mesh.Points.push_back(point.Position);
      }
      triangles = this->CollectPartTriangles();
      for (cdm::Id t : this->PartTriangles)
      {
        sides.push_back(this->Surface.GetSideRegions()[t]);
      }
      return cdm::BuildNeighbors(this->Mesh, this->Context.GetNumberOfThreads());
    });
  if (!status.IsOk())
  {
    return status;
  }
  cdm::PartRegions regions(this->Mesh, this->NumberOfOwnPoints, triangles, sides);
  std::vector<KeyedTetrahedron> shared;
  std::vector<cdm::Id> sharedIds;
  status = this->Processes.Do(
    [&]
    {
      shared = this->CollectShared();
      std::transform(shared.begin(), shared.end(), std::back_inserter(sharedIds),
        [](const KeyedTetrahedron& tetrahedron) { return tetrahedron.second; });
      std::sort(sharedIds.begin(), sharedIds.end());
      cdm::Status step = regions.Start();
      for (cdm::Id& cell : step.Cells)
      {
        cell = this->PartTriangles[cell];
      }
      this->Surface.NameTriangles(step);
      return step;
    });
  for (bool hasNews = true; status.IsOk() && hasNews;)
  {
    const std::vector<cdm::Id> news = regions.TakeNews(sharedIds);
    status = this->ExchangeRegions(shared, news, regions);
    hasNews = this->Processes.Sum(static_cast<std::int64_t>(news.size())) > 0;
  }
  status = std::move(status).Then(
    [&] { return this->Processes.Do([&] { return regions.Finish(this->Mesh.Regions); }); });
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
cdm::Status DistributedMesh::AddGhosts()
{
  GhostLevels levels(*this);
  cdm::Status status = this->Processes.Do(
    [&]
    {
      levels.Start();
      return cdm::Status();
    });
  for (int level = 0; level < this->NumberOfGhostLevels && status.IsOk(); ++level)
  {
    status = levels.AddLevel();
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
  const auto read = [&]
  {
    return this->Input.Read(input, "input", 0)
      .Then([&] { return this->Input.Read(meshPoints, "mesh points", 1); })
      .Then([&] { return this->Surface.Read(surface); });
  };
  const auto checkSurface = [&]
  {
    return this->Surface.Exists() ? this->Processes.Do([&] { return this->Surface.Check(); })
                                  : cdm::Status();
  };
  const auto distribute = [&]
  {
    // Copies on the surface are what its pieces share.
    return this->Input.Distribute(this->Surface.Exists() ? this->Input.GetFirstMeshPoint() : 0,
      this->OwnPoints, this->NumberOfUnusedMeshPoints);
  };
  const auto collect = [&]
  {
    this->CollectOwn();
    this->CollectBoundary();
    return cdm::Status();
  };
  cdm::Status status =
    this->Processes.Do(read)
      .Then([&] { return this->Input.Number(input, meshPoints); })
      .Then([&] { return this->Surface.Gather(surface, this->Input.GetPiece(0)); })
      .Then(checkSurface)
      .Then(distribute)
      .Then([&] { return this->MakePart(); })
      .Then([&] { return this->Tetrahedralize(); })
      .Then([&] { return this->Surface.Exists() ? this->FindRegions() : cdm::Status(); })
      .Then([&] { return this->Processes.Do(collect); })
      .Then([&] { return this->Processes.IsAlone() ? cdm::Status() : this->AddGhosts(); })
      .Then([&]
        { return this->Input.FetchData(this->Points, this->NumberOfOwnPoints, this->FindUsed()); });
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
