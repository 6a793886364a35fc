// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/CanonicalNumbering.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SurfaceSides.h"
#include "Core/Search/SpatialSort.h"
#include "Core/Volume/SurfaceFacets.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <string>

namespace cdm
{
namespace
{
/** Tetrahedra between two calls of the context. */
constexpr std::size_t ReportInterval = 4096;

class AdvancingFront
{
public:
  AdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
    const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
    AdvancingFrontTetrahedralizerOutput& output)
    : Input(input), Options(options), Context(context), Output(output),
      NumberOfThreads(context.GetNumberOfThreads()), Surface(output.Boundary),
      Points(output.Mesh.Points)
  {
  }

  Status Run();

private:
  /** A start of the front: a tetrahedron, and the surface triangle at which it was found. */
  struct Seed
  {
    Id Tetrahedron;
    Id Region;
    Id Triangle;
  };
  /** States of the tetrahedra of all points while the front advances. */
  enum State : unsigned char
  {
    Unreached,
    InFront,
    Meshed,
    BeyondHull
  };

  Status CollectPoints();
  Status TetrahedralizePoints();
  Status FindSeeds();
  Status FindGivenSeeds();
  Status FindSeedsOfShells();
  static Status MakeNothingEnclosedError(const SurfaceSides& sides);
  Status MeshRegions();
  Status Advance(const Seed& seed);
  void TakeAll();
  Status CheckSideLabel(Id side, Id region);
  Status MakeHullError(const Seed& seed, const TriangleIds& points) const;
  void CollectFront();
  void Finish();
  void CollectPointsUsed();
  void AppendHull();
  void CompleteBoundary();
  void LeaveOutUnusedTriangles();
  Id GetSideLabel(Id side) const
  {
    const RegionPair& labels = this->Surface.Labels[side / 2];
    return side % 2 == 0 ? labels.Front : labels.Back;
  }
  bool IsLimitReached() const
  {
    return this->Options.MaximumNumberOfTetrahedra > 0 &&
      this->NumberOfTetrahedra >= this->Options.MaximumNumberOfTetrahedra;
  }
  /** A facet in points, the lowest one first. */
  TriangleIds GetFacetPoints(Id facet) const
  {
    const TriangleIds ids = GetFacet(this->All.Tetrahedra[facet / 4], facet % 4);
    TriangleIds points{ this->Order[ids[0]], this->Order[ids[1]], this->Order[ids[2]] };
    std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
    return points;
  }
  bool HasSurface() const { return this->NumberOfSurfaceTriangles > 0; }
  bool HasSeeds() const { return this->Input.Seeds != nullptr && !this->Input.Seeds->empty(); }

  /** Neighbors beyond a side of the surface are this, less the side. */
  static constexpr Id FirstBarrier = -2;

  const AdvancingFrontTetrahedralizerInput& Input;
  const AdvancingFrontTetrahedralizerOptions& Options;
  const ExecutionContext& Context;
  AdvancingFrontTetrahedralizerOutput& Output;
  const int NumberOfThreads;

  /** Works on the output's boundary, with points still empty. */
  TriangleMesh& Surface;
  std::vector<Vec3>& Points;
  bool HasLabels = false;
  Id NumberOfSurfacePoints = 0;
  Id NumberOfSurfaceTriangles = 0;

  /** Vertices are points in the order of a Hilbert curve, without copies: the point of each. */
  std::vector<Id> Order;
  RawVector<Vec3> VertexPoints;
  DelaunayTetrahedralization All;
  RawVector<unsigned char> States;
  /** NoId if a tetrahedron is not meshed. */
  RawVector<Id> Regions;

  SurfaceFacets Facets;
  std::vector<Seed> Seeds;
  /** Tetrahedra that the front has reached. */
  std::vector<Id> Front;
  Id NumberOfTetrahedra = 0;
  bool IsStopped = false;
  /** Facets that close an open boundary. */
  std::vector<Id> HullFacets;
};

Status AdvancingFront::CollectPoints()
{
  const TriangleMesh none;
  const TriangleMesh& surface = this->Input.Surface != nullptr ? *this->Input.Surface : none;
  const Status range = CheckNumberOfPoints(
    surface.Points.size(), this->Input.MeshPoints != nullptr ? this->Input.MeshPoints->size() : 0);
  if (!range.IsOk())
  {
    return range;
  }
  this->Surface = surface;
  this->HasLabels = !surface.Labels.empty();
  this->Surface.SourceCells.resize(surface.Triangles.size());
  std::iota(this->Surface.SourceCells.begin(), this->Surface.SourceCells.end(), 0);
  this->NumberOfSurfaceTriangles = static_cast<Id>(surface.Triangles.size());
  this->NumberOfSurfacePoints = static_cast<Id>(surface.Points.size());

  this->Points = std::move(this->Surface.Points);
  this->Surface.Points.clear();
  if (this->Input.MeshPoints != nullptr)
  {
    this->Points.insert(
      this->Points.end(), this->Input.MeshPoints->begin(), this->Input.MeshPoints->end());
  }
  if (surface.Triangles.empty() && !this->Options.CloseOpenBoundary)
  {
    return Status::InvalidInput(
      "The surface is empty: it has no triangles. Switch CloseOpenBoundary on to mesh the convex "
      "hull of points.");
  }
  const bool areFinite = HoldForAll(this->Points.size(), this->NumberOfThreads,
    [this](std::size_t i) { return IsFinite(this->Points[i]); });
  for (std::size_t i = 0; i < this->Points.size() && !areFinite; ++i)
  {
    if (!IsFinite(this->Points[i]))
    {
      const bool isMeshPoint = static_cast<Id>(i) >= this->NumberOfSurfacePoints;
      return Status::InvalidInput(isMeshPoint
          ? "A mesh point has a coordinate that is not a finite number; remove it."
          : "A point has a coordinate that is not a finite number; remove or repair it.",
        {}, { static_cast<Id>(i) - (isMeshPoint ? this->NumberOfSurfacePoints : 0) });
    }
  }
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    if (AreCollinear(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]))
    {
      return Status::InvalidInput("A triangle of the surface has no area; clean the surface with "
                                  "the boundary triangulator first.",
        { t });
    }
  }

  // Copies of a point cannot be told apart: they are an error on the surface, and left out
  // among the mesh points. The lower number wins. Along the curve they follow each other.
  this->Order.resize(this->Points.size());
  std::iota(this->Order.begin(), this->Order.end(), 0);
  SortAlongHilbertCurve(this->Points, this->Order, this->NumberOfThreads);
  this->VertexPoints.resize(this->Order.size());
  ForEach(this->Order.size(), this->NumberOfThreads,
    [this](std::size_t i) { this->VertexPoints[i] = this->Points[this->Order[i]]; });
  const bool areDistinct = HoldForAll(this->Order.size(), this->NumberOfThreads,
    [this](std::size_t i) { return i == 0 || this->VertexPoints[i] != this->VertexPoints[i - 1]; });
  if (areDistinct)
  {
    return Status();
  }
  std::vector<Id> coincident;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < this->Order.size(); ++i)
  {
    const Id point = this->Order[i];
    if (kept == 0 || this->VertexPoints[i] != this->VertexPoints[kept - 1])
    {
      this->Order[kept] = point;
      this->VertexPoints[kept++] = this->VertexPoints[i];
    }
    else if (point < this->NumberOfSurfacePoints && this->HasSurface())
    {
      coincident.push_back(this->Order[kept - 1]);
      coincident.push_back(point);
    }
  }
  this->Order.resize(kept);
  this->VertexPoints.resize(kept);
  if (!coincident.empty())
  {
    SortUnique(coincident);
    return Status::InvalidInput("Points of the surface coincide; merge them with "
                                "the boundary triangulator first.",
      {}, std::move(coincident));
  }
  return Status();
}

Status AdvancingFront::TetrahedralizePoints()
{
  // Where a front goes first depends on the order in which tetrahedra and their vertices were
  // listed: if it may be stopped, several threads would leave another part of the mesh.
  const int numberOfThreads =
    this->Options.MaximumNumberOfTetrahedra > 0 ? 1 : this->NumberOfThreads;
  const Status status = BuildDelaunayTetrahedralization(this->VertexPoints, this->Order,
    FindGridBlock(this->VertexPoints), numberOfThreads, this->Context.Part(0.05, 0.6), this->All);
  if (!status.IsOk())
  {
    // A surface of a few points or in a plane has nothing within.
    return status.Code == StatusCode::InvalidInput && this->HasSurface()
      ? MakeNothingEnclosedError(
          FindSurfaceSides({ this->Points, this->Surface.Triangles, {}, {} }))
      : status;
  }
  const Id infinite = static_cast<Id>(this->Order.size());
  this->States.resize(this->All.Tetrahedra.size());
  ForEach(this->States.size(), this->NumberOfThreads,
    [this, infinite](std::size_t t)
    {
      const TetrahedronIds& ids = this->All.Tetrahedra[t];
      const bool isBeyondHull = ids[0] != NoId && Contains(ids, infinite);
      this->States[t] = isBeyondHull ? BeyondHull : Unreached;
    });
  return status;
}

Status AdvancingFront::FindGivenSeeds()
{
  for (const RegionSeed& seed : *this->Input.Seeds)
  {
    const Id t = IsFinite(seed.Position)
      ? LocateInTetrahedralization(this->VertexPoints, this->All, seed.Position)
      : NoId;
    if (t == NoId)
    {
      return Status::InvalidInput("A region seed lies outside of all points; move it into the "
                                  "region that it is to mark.",
        {}, { static_cast<Id>(&seed - this->Input.Seeds->data()) });
    }
    this->Seeds.push_back({ t, seed.Region, NoId });
  }
  return Status();
}

Status AdvancingFront::MakeNothingEnclosedError(const SurfaceSides& sides)
{
  return Status::Failure(StatusCode::NotClosed,
    "The surface encloses nothing: it has " + std::to_string(sides.OpenTriangles.size()) +
      " triangles with an open edge. Close it (MaximumGapEdges of the boundary triangulator "
      "patches "
      "gaps), or switch CloseOpenBoundary on to mesh up to the convex hull.",
    sides.OpenTriangles);
}

Status AdvancingFront::FindSeedsOfShells()
{
  const TriangleMesh withPoints{ this->Points, this->Surface.Triangles, {}, {} };
  const SurfaceSides sides = FindSurfaceSides(withPoints);
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id shell = sides.Shells[side];
    if (!sides.IsOuter[shell] || (this->Options.CloseOpenBoundary && sides.IsOpen[shell]))
    {
      this->Seeds.push_back({ this->Facets.Sides[side] / 4, NoId, side / 2 });
    }
  }
  return this->Seeds.empty() ? MakeNothingEnclosedError(sides) : Status();
}

Status AdvancingFront::FindSeeds()
{
  if (this->HasSeeds())
  {
    return this->FindGivenSeeds();
  }
  if (!this->HasSurface())
  {
    Id first = 0;
    while (this->All.Tetrahedra[first][0] == NoId || this->States[first] == BeyondHull)
    {
      ++first;
    }
    this->Seeds.push_back({ first, 0, NoId });
    return Status();
  }
  if (!this->HasLabels)
  {
    return this->FindSeedsOfShells();
  }
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id label = this->GetSideLabel(side);
    if (label != OutsideRegion)
    {
      this->Seeds.push_back({ this->Facets.Sides[side] / 4, label, side / 2 });
    }
  }
  return this->Seeds.empty()
    ? Status::InvalidInput("All BoundaryLabels are -1 (outside): no region is left to be meshed.")
    : Status();
}

Status AdvancingFront::CheckSideLabel(Id side, Id region)
{
  if (this->HasLabels && !this->HasSeeds() && this->GetSideLabel(side) != region)
  {
    return Status::Failure(StatusCode::NotClosed,
      "Region " + std::to_string(region) +
        " is not closed, or its BoundaryLabels contradict each other: it reaches a triangle whose "
        "label on that side is " +
        std::to_string(this->GetSideLabel(side)) + ".",
      { side / 2 });
  }
  return Status();
}

/**
 * Attaches to each facet of the front its fourth point until the front is empty. What the front
 * reaches first comes first if it may be stopped: then it can be looked at.
 */
Status AdvancingFront::Advance(const Seed& seed)
{
  const bool isInOrder = this->Options.MaximumNumberOfTetrahedra > 0;
  const ExecutionContext part = this->Context.Part(0.75, 0.9);
  const double expected = static_cast<double>(this->All.Tetrahedra.size());
  this->Front.assign(1, seed.Tetrahedron);
  this->States[seed.Tetrahedron] = InFront;
  for (std::size_t next = 0; next < this->Front.size();)
  {
    if (this->IsLimitReached())
    {
      this->IsStopped = true;
      return Status();
    }
    if (this->NumberOfTetrahedra % ReportInterval == 0 &&
      !part.Continue(this->NumberOfTetrahedra / expected, "Advancing the front"))
    {
      return Status::Aborted();
    }
    const Id t = isInOrder ? this->Front[next++] : this->Front.back();
    if (!isInOrder)
    {
      this->Front.pop_back();
    }
    this->States[t] = Meshed;
    this->Regions[t] = seed.Region;
    ++this->NumberOfTetrahedra;
    for (int i = 0; i < 4; ++i)
    {
      const Id beyond = this->All.Neighbors[t][i];
      if (beyond < 0)
      {
        const Status status = this->CheckSideLabel(FirstBarrier - beyond, seed.Region);
        if (!status.IsOk())
        {
          return status;
        }
        continue;
      }
      unsigned char& state = this->States[beyond / 4];
      if (state == Unreached)
      {
        state = InFront;
        this->Front.push_back(beyond / 4);
      }
      else if (state == BeyondHull)
      {
        if (!this->Options.CloseOpenBoundary)
        {
          return this->MakeHullError(seed, this->GetFacetPoints(4 * t + i));
        }
        this->HullFacets.push_back(4 * t + i);
      }
    }
  }
  return Status();
}

/** Takes all tetrahedra of the hull at once, as the front would reach them if nothing stops it. */
void AdvancingFront::TakeAll()
{
  this->Regions.resize(this->States.size());
  const Id infinite = static_cast<Id>(this->Order.size());
  std::mutex mutex;
  ForAll(this->States.size(), this->NumberOfThreads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<Id> hull;
      Id count = 0;
      for (std::size_t t = begin; t < end; ++t)
      {
        const TetrahedronIds& ids = this->All.Tetrahedra[t];
        this->Regions[t] = NoId;
        if (this->States[t] == BeyondHull)
        {
          const auto place = std::find(ids.begin(), ids.end(), infinite) - ids.begin();
          hull.push_back(this->All.Neighbors[t][place]);
        }
        else if (ids[0] != NoId)
        {
          this->States[t] = Meshed;
          this->Regions[t] = 0;
          ++count;
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      this->HullFacets.insert(this->HullFacets.end(), hull.begin(), hull.end());
      this->NumberOfTetrahedra += count;
    });
  this->Output.Report.NumberOfRegions = 1;
}

Status AdvancingFront::MakeHullError(const Seed& seed, const TriangleIds& points) const
{
  return Status::Failure(StatusCode::NotClosed,
    "Region " + std::to_string(seed.Region) +
      " is not closed: the front reached the convex hull of the points. Close the surface, correct "
      "its BoundaryLabels, or switch CloseOpenBoundary on.",
    seed.Triangle == NoId ? std::vector<Id>() : std::vector<Id>{ seed.Triangle },
    { points[0], points[1], points[2] });
}

void AdvancingFront::CollectFront()
{
  for (std::size_t t = 0; t < this->States.size(); ++t)
  {
    for (int i = 0; i < 4 && this->States[t] == Meshed; ++i)
    {
      const Id beyond = this->All.Neighbors[t][i];
      if (beyond >= 0 && this->States[beyond / 4] != Meshed &&
        this->States[beyond / 4] != BeyondHull)
      {
        this->Output.Front.push_back(this->GetFacetPoints(static_cast<Id>(4 * t + i)));
      }
    }
  }
  std::sort(this->Output.Front.begin(), this->Output.Front.end());
}

/** Drops mesh points that are not used. Afterwards Order has the final points. */
void AdvancingFront::CollectPointsUsed()
{
  std::vector<Id> places(this->Points.size(), NoId);
  if (!this->HasSurface() && !this->IsStopped)
  {
    // The mesh of the convex hull has all points.
    ForEach(this->Order.size(), this->NumberOfThreads,
      [&](std::size_t i) { places[this->Order[i]] = 0; });
  }
  else
  {
    for (std::size_t t = 0; t < this->States.size(); ++t)
    {
      if (this->States[t] == Meshed)
      {
        for (Id vertex : this->All.Tetrahedra[t])
        {
          places[this->Order[vertex]] = 0;
        }
      }
    }
  }
  Id count = this->NumberOfSurfacePoints;
  this->Output.MeshPointSources.reserve(places.size() - static_cast<std::size_t>(count));
  for (Id i = 0; i < static_cast<Id>(places.size()); ++i)
  {
    if (i < this->NumberOfSurfacePoints)
    {
      this->Output.Report.UnusedMeshPoints += !this->HasSurface() && places[i] == NoId ? 1 : 0;
      places[i] = i;
    }
    else if (places[i] != NoId)
    {
      this->Output.MeshPointSources.push_back(i - this->NumberOfSurfacePoints);
      this->Points[count] = this->Points[i];
      places[i] = count++;
    }
    else
    {
      ++this->Output.Report.UnusedMeshPoints;
    }
  }
  this->Points.resize(count);
  ForEach(this->Order.size(), this->NumberOfThreads,
    [&](std::size_t i) { this->Order[i] = places[this->Order[i]]; });
}

/**
 * Appends the facets of the hull to the surface, in the order of their points: a counting sort by the
 * first one. Sorting all at once took a tenth of the time for points on a sphere; lists of ids for
 * each point are slower than this, too.
 */
void AdvancingFront::AppendHull()
{
  if (this->HullFacets.empty())
  {
    return;
  }
  using Facet = std::pair<TriangleIds, Id>;
  std::vector<Id> ends(this->Points.size() + 1, 0);
  std::vector<Facet> facets;
  facets.reserve(this->HullFacets.size());
  for (Id facet : this->HullFacets)
  {
    facets.emplace_back(this->GetFacetPoints(facet), this->Regions[facet / 4]);
    ++ends[facets.back().first[0] + 1];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  // The number of each point is where its facets begin; once they are placed, it is where they end.
  std::vector<Facet> sorted(facets.size());
  for (const Facet& facet : facets)
  {
    sorted[ends[facet.first[0]]++] = facet;
  }
  facets = {};
  const std::size_t first = this->Surface.Triangles.size();
  this->Surface.Triangles.resize(first + sorted.size());
  this->Surface.SourceCells.resize(first + sorted.size(), NoId);
  this->Surface.Labels.resize(first + sorted.size());
  ForEach(this->Points.size(), this->NumberOfThreads,
    [&](std::size_t point)
    {
      const Id begin = point == 0 ? 0 : ends[point - 1];
      std::sort(sorted.begin() + begin, sorted.begin() + ends[point]);
      for (Id i = begin; i < ends[point]; ++i)
      {
        this->Surface.Triangles[first + i] = sorted[i].first;
        this->Surface.Labels[first + i] = { OutsideRegion, sorted[i].second };
      }
    });
}

void AdvancingFront::CompleteBoundary()
{
  // It carries what its sides really border on. Sides that the front has not reached keep their
  // label.
  this->Surface.Labels.resize(static_cast<std::size_t>(this->NumberOfSurfaceTriangles));
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id t = this->Facets.Sides[side] / 4;
    if (this->States[t] == Meshed)
    {
      RegionPair& labels = this->Surface.Labels[side / 2];
      (side % 2 == 0 ? labels.Front : labels.Back) = this->Regions[t];
    }
  }
  this->LeaveOutUnusedTriangles();
  this->AppendHull();
}

/** Triangles with no meshed region on either side are no part of the boundary of a finished mesh. */
void AdvancingFront::LeaveOutUnusedTriangles()
{
  Id kept = 0;
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    const auto isMeshed = [&](Id side)
    { return this->States[this->Facets.Sides[side] / 4] == Meshed; };
    const bool isUsed = isMeshed(2 * t) || isMeshed(2 * t + 1);
    if (!isUsed)
    {
      this->Output.Report.UnusedTriangles.push_back(this->Surface.SourceCells[t]);
    }
    if (isUsed || this->IsStopped)
    {
      this->Surface.Triangles[kept] = this->Surface.Triangles[t];
      this->Surface.Labels[kept] = this->Surface.Labels[t];
      this->Surface.SourceCells[kept] = this->Surface.SourceCells[t];
      ++kept;
    }
  }
  this->Surface.Triangles.resize(kept);
  this->Surface.Labels.resize(kept);
  this->Surface.SourceCells.resize(kept);
}

void AdvancingFront::Finish()
{
  this->CollectPointsUsed();
  this->CompleteBoundary();
  if (this->IsStopped)
  {
    this->CollectFront();
  }
  this->VertexPoints = RawVector<Vec3>();
  this->States = RawVector<unsigned char>();
  if (this->NumberOfTetrahedra > 0)
  {
    for (std::size_t side = 0; side < this->Facets.Sides.size(); ++side)
    {
      // What was behind the barrier.
      const Id facet = this->Facets.Sides[side];
      this->All.Neighbors[facet / 4][facet % 4] = this->Facets.Sides[side ^ 1];
    }
    CollectTetrahedra(
      this->All, this->Regions, this->Order, this->NumberOfThreads, this->Output.Mesh);
  }
  // Not before: the old and the new tetrahedra side by side are the peak of memory.
  this->All = DelaunayTetrahedralization();
  this->Surface.Points = this->Points;
}

Status AdvancingFront::MeshRegions()
{
  Status status;
  if (this->HasSurface())
  {
    status = FindSurfaceFacets(
      { this->Points, this->Order, this->VertexPoints, this->All, this->NumberOfThreads },
      this->Context.Part(0.6, 0.75), this->Surface, this->Facets);
    this->Output.Report.TurnedDiagonals = this->Facets.TurnedDiagonals;
  }
  status = std::move(status).Then([&] { return this->FindSeeds(); });
  if (!status.IsOk())
  {
    return status;
  }
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id facet = this->Facets.Sides[side];
    this->All.Neighbors[facet / 4][facet % 4] = FirstBarrier - side;
  }
  this->Regions.assign(this->States.size(), NoId);
  std::vector<Id> regions;
  Id nextRegion = 0;
  for (Seed seed : this->Seeds)
  {
    const bool isBeyondHull = this->States[seed.Tetrahedron] == BeyondHull;
    if (isBeyondHull && !this->Options.CloseOpenBoundary)
    {
      return this->MakeHullError(seed, this->Surface.Triangles[seed.Triangle]);
    }
    if (isBeyondHull || this->States[seed.Tetrahedron] == Meshed)
    {
      continue;
    }
    seed.Region = seed.Region == NoId ? nextRegion++ : seed.Region;
    regions.push_back(seed.Region);
    status = this->Advance(seed);
    if (!status.IsOk() || this->IsStopped)
    {
      break;
    }
  }
  this->IsStopped = this->IsStopped || status.IsAborted();
  SortUnique(regions);
  this->Output.Report.NumberOfRegions = static_cast<Id>(regions.size());
  return status;
}

Status AdvancingFront::Run()
{
  Status status = this->CollectPoints().Then([&] { return this->TetrahedralizePoints(); });
  if (!status.IsOk())
  {
    return status;
  }
  if (this->HasSurface() || this->HasSeeds() || this->Options.MaximumNumberOfTetrahedra > 0)
  {
    status = this->MeshRegions();
  }
  else
  {
    this->TakeAll();
  }
  if (status.IsOk() || status.IsAborted())
  {
    this->Finish();
  }
  return status;
}

std::vector<Warning> MakeWarnings(const AdvancingFrontTetrahedralizerReport& report, bool hasSeeds)
{
  std::vector<Warning> warnings;
  if (report.UnusedMeshPoints > 0)
  {
    warnings.push_back({ "Left out " + std::to_string(report.UnusedMeshPoints) +
      " mesh points that lie in no meshed region." });
  }
  if (!report.UnusedTriangles.empty() && !hasSeeds)
  {
    warnings.push_back({ "Left out " + std::to_string(report.UnusedTriangles.size()) +
        " triangles of the surface that bound no meshed region. If they should, close the surface "
        "that they are part of.",
      report.UnusedTriangles });
  }
  return warnings;
}
} // namespace

Status TetrahedralizeByAdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
  const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
  AdvancingFrontTetrahedralizerOutput& output)
{
  return RunGuarded(
    [&]() -> Status
    {
      output = AdvancingFrontTetrahedralizerOutput();
      const Status status = AdvancingFront(input, options, context, output).Run();
      if (!status.IsOk() && !status.IsAborted())
      {
        output = AdvancingFrontTetrahedralizerOutput();
      }
      // What an unfinished mesh does not use it may use yet.
      if (status.IsOk() && output.Front.empty())
      {
        const bool hasSeeds = input.Seeds != nullptr && !input.Seeds->empty();
        output.Warnings = MakeWarnings(output.Report, hasSeeds);
      }
      return status;
    });
}
} // namespace cdm
