// SPDX-License-Identifier: BSD-3-Clause
#include "AdvancingFrontTetrahedralizer.h"

#include "DelaunayTetrahedralization.h"
#include "DuplicateTriangles.h"
#include "FacetPolygons.h"
#include "IdLimits.h"
#include "ParallelLoop.h"
#include "Predicates.h"
#include "SpatialSort.h"
#include "SurfaceDelaunayTest.h"
#include "SurfaceSides.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <string>

namespace cdm
{
namespace
{
/** How often the context is asked, in tetrahedra or triangles. */
constexpr std::size_t ReportInterval = 4096;

void SortUnique(std::vector<Id>& ids)
{
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/** +1 if two orders of the same three points turn the same way, else -1. */
int GetRelativeTurn(const TriangleIds& s, const TriangleIds& t)
{
  const int first = s[0] == t[0] ? 0 : s[0] == t[1] ? 1 : 2;
  return s[1] == t[(first + 1) % 3] ? 1 : -1;
}

class AdvancingFront
{
public:
  AdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
    const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
    AdvancingFrontTetrahedralizerOutput& output)
    : Input(input), Options(options), Context(context), Output(output), Surface(output.Boundary),
      Points(output.Mesh.Points)
  {
  }

  Status Run();

private:
  /** Where the front starts: a tetrahedron, and the surface triangle that it was found by. */
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
  Status CheckSurface();
  Status TurnDiagonals(const std::vector<Id>& doubtful);
  void FindFacetsOfSurface();
  bool IsSurelyStronglyDelaunay(Id triangle) const;
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
  void CollectTetrahedra();
  void CollectPointsUsed();
  void CompleteBoundary();
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
  /**
   * work(begin, end) for parts of the numbers below size, on all threads. The parts are large: what is
   * close in number is close in memory, and threads that write to the same place wait for each other.
   */
  template <typename Work>
  void ForAll(std::size_t size, const Work& work) const
  {
    const int numberOfThreads = std::max(1, this->Options.NumberOfThreads);
    const std::size_t part =
      std::max(std::size_t(1) << 15, size / (8 * static_cast<std::size_t>(numberOfThreads)) + 1);
    ParallelLoop(size, { numberOfThreads, part }, {}, "",
      [&work](std::size_t begin, std::size_t end, std::size_t) { work(begin, end); });
  }
  /** work(i) for the numbers below size, on all threads. */
  template <typename Work>
  void ForEach(std::size_t size, const Work& work) const
  {
    this->ForAll(size,
      [&work](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          work(i);
        }
      });
  }
  /** Whether a condition holds for all numbers below size. */
  template <typename Condition>
  bool HoldForAll(std::size_t size, const Condition& condition) const
  {
    std::atomic<bool> isTrue{ true };
    this->ForAll(size,
      [&](std::size_t begin, std::size_t end)
      {
        bool isTrueHere = true;
        for (std::size_t i = begin; i < end && isTrueHere; ++i)
        {
          isTrueHere = condition(i);
        }
        if (!isTrueHere)
        {
          isTrue = false;
        }
      });
    return isTrue;
  }
  bool HasSurface() const { return this->NumberOfSurfaceTriangles > 0; }
  bool HasSeeds() const { return this->Input.Seeds != nullptr && !this->Input.Seeds->empty(); }

  /** Neighbors beyond a side of the surface are this, less the side. */
  static constexpr Id FirstBarrier = -2;

  const AdvancingFrontTetrahedralizerInput& Input;
  const AdvancingFrontTetrahedralizerOptions& Options;
  const ExecutionContext& Context;
  AdvancingFrontTetrahedralizerOutput& Output;

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
  RawVector<Id> Regions;

  /** For each side of the surface: the facet of the tetrahedron there, or NoId. */
  std::vector<Id> SideFacets;
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
  const bool areFinite = this->HoldForAll(
    this->Points.size(), [this](std::size_t i) { return IsFinite(this->Points[i]); });
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
                                  "vtkBoundaryTriangulator first.",
        { t });
    }
  }

  // Copies of a point cannot be told apart: they are an error on the surface, and left out
  // among the mesh points. The lower number wins. Along the curve they follow each other.
  this->Order.resize(this->Points.size());
  std::iota(this->Order.begin(), this->Order.end(), 0);
  SortAlongHilbertCurve(this->Points, this->Order, std::max(1, this->Options.NumberOfThreads));
  this->VertexPoints.resize(this->Order.size());
  this->ForEach(this->Order.size(),
    [this](std::size_t i) { this->VertexPoints[i] = this->Points[this->Order[i]]; });
  const bool areDistinct = this->HoldForAll(this->Order.size(),
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
                                "vtkBoundaryTriangulator first.",
      {}, std::move(coincident));
  }
  return Status();
}

Status AdvancingFront::TurnDiagonals(const std::vector<Id>& doubtful)
{
  const FacetPolygons polygons(this->Surface);
  PointOctree octree;
  for (Id point : this->Order)
  {
    octree.Insert(point, this->Points[point]);
  }
  SurfaceDelaunayTest test(this->Points, octree);
  SurfaceDelaunayTest::Result result;
  std::vector<Id> offending;
  std::vector<char> isDone(this->Surface.Triangles.size(), 0);
  std::vector<Id> polygonTriangles;
  const ExecutionContext part = this->Context.Part(0.6, 0.75);
  for (std::size_t i = 0; i < doubtful.size(); ++i)
  {
    if (i % ReportInterval == 0 &&
      !part.Continue(double(i) / double(doubtful.size()), "Checking the surface"))
    {
      return Status::Aborted();
    }
    const Id t = doubtful[i];
    if (isDone[t])
    {
      continue;
    }
    test.Run(this->Surface.Triangles[t], result);
    const std::vector<Id>& cocircular = result.Cocircular;
    const auto isCocircular = [&cocircular](Id point)
    { return std::binary_search(cocircular.begin(), cocircular.end(), point); };
    if (!result.IsDelaunay ||
      (!cocircular.empty() && polygons.Collect(t, isCocircular, polygonTriangles) != cocircular))
    {
      offending.push_back(t);
      continue;
    }
    if (cocircular.empty())
    {
      continue;
    }

    const std::vector<TriangleIds> fan =
      MakePulledFan(this->Points, this->Surface.Triangles[t], cocircular);
    if (fan.size() != polygonTriangles.size())
    {
      return Status::InvalidInput("Triangles of a flat facet overlap; check the surface with "
                                  "vtkBoundaryTriangulator.",
        polygonTriangles);
    }
    const RegionPair labels = this->HasLabels ? this->Surface.Labels[t] : RegionPair{};
    for (std::size_t k = 0; k < fan.size(); ++k)
    {
      const Id triangle = polygonTriangles[k];
      TriangleIds before = this->Surface.Triangles[triangle];
      TriangleIds after = fan[k];
      std::sort(before.begin(), before.end());
      std::sort(after.begin(), after.end());
      this->Output.Report.TurnedDiagonals += before != after;
      this->Surface.Triangles[triangle] = fan[k];
      if (this->HasLabels)
      {
        this->Surface.Labels[triangle] = labels;
      }
      isDone[triangle] = 1;
    }
  }
  if (!offending.empty())
  {
    const std::string count = std::to_string(offending.size());
    return Status::InvalidInput(count +
        " triangles of the surface are not strongly Delaunay; refine the surface with "
        "vtkDelaunaySurfaceRefiner first (mesh points on its second port, if there are any).",
      std::move(offending));
  }
  return Status();
}

Status AdvancingFront::TetrahedralizePoints()
{
  const Status status = BuildDelaunayTetrahedralization(this->VertexPoints, this->Order,
    FindGridBlock(this->VertexPoints), std::max(1, this->Options.NumberOfThreads),
    this->Context.Part(0.05, 0.6), this->All);
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
  this->ForEach(this->States.size(),
    [this, infinite](std::size_t t)
    {
      const TetrahedronIds& ids = this->All.Tetrahedra[t];
      const bool isBeyondHull = (ids[0] != NoId) &
        ((ids[0] == infinite) | (ids[1] == infinite) | (ids[2] == infinite) | (ids[3] == infinite));
      this->States[t] = isBeyondHull ? BeyondHull : Unreached;
    });
  return status;
}

void AdvancingFront::FindFacetsOfSurface()
{
  // The triangles by their first vertex.
  const std::size_t count = this->Order.size();
  std::vector<Id> vertices(this->Points.size(), NoId);
  for (std::size_t vertex = 0; vertex < count; ++vertex)
  {
    vertices[this->Order[vertex]] = static_cast<Id>(vertex);
  }
  std::vector<Id> starts(count + 2, 0);
  std::vector<char> isOnSurface(count + 1, 0);
  const auto getFirst = [&vertices](const TriangleIds& ids) {
    return std::min({ vertices[ids[0]], vertices[ids[1]], vertices[ids[2]] });
  };
  for (const TriangleIds& ids : this->Surface.Triangles)
  {
    ++starts[getFirst(ids) + 2];
    for (Id point : ids)
    {
      isOnSurface[vertices[point]] = 1;
    }
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Id> triangles(this->Surface.Triangles.size());
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    triangles[starts[getFirst(this->Surface.Triangles[t]) + 1]++] = t;
  }

  this->SideFacets.assign(2 * this->Surface.Triangles.size(), NoId);
  const auto find = [&](std::size_t t)
  {
    const TetrahedronIds& tetrahedron = this->All.Tetrahedra[t];
    if (tetrahedron[0] == NoId ||
      isOnSurface[tetrahedron[0]] + isOnSurface[tetrahedron[1]] + isOnSurface[tetrahedron[2]] +
          isOnSurface[tetrahedron[3]] <
        3)
    {
      return;
    }
    for (int i = 0; i < 4; ++i)
    {
      const TriangleIds ids = GetFacet(tetrahedron, i);
      if (!isOnSurface[ids[0]] || !isOnSurface[ids[1]] || !isOnSurface[ids[2]])
      {
        continue;
      }
      const Id first = std::min({ ids[0], ids[1], ids[2] });
      TriangleIds points{ this->Order[ids[0]], this->Order[ids[1]], this->Order[ids[2]] };
      const TriangleIds outward = points;
      std::sort(points.begin(), points.end());
      for (Id k = starts[first]; k < starts[first + 1]; ++k)
      {
        const TriangleIds& triangle = this->Surface.Triangles[triangles[k]];
        TriangleIds sorted = triangle;
        std::sort(sorted.begin(), sorted.end());
        if (sorted == points)
        {
          // The tetrahedron lies behind its outward facet.
          const bool isInFront = GetRelativeTurn(triangle, outward) < 0;
          this->SideFacets[2 * triangles[k] + (isInFront ? 0 : 1)] = static_cast<Id>(4 * t + i);
          break;
        }
      }
    }
  };
  // A side of a triangle is a facet of one tetrahedron: threads never write to the same place.
  this->ForEach(this->All.Tetrahedra.size(), find);
}

/** True if one of the two tetrahedra at the triangle is a cell of four points. */
bool AdvancingFront::IsSurelyStronglyDelaunay(Id triangle) const
{
  if (this->SideFacets[2 * triangle] == NoId || this->SideFacets[2 * triangle + 1] == NoId)
  {
    return false;
  }
  if (!this->All.HasCosphericalPoints)
  {
    return true;
  }
  const auto& p = this->VertexPoints;
  for (Id side = 2 * triangle; side < 2 * triangle + 2; ++side)
  {
    const Id t = this->SideFacets[side] / 4;
    bool isAlone = this->States[t] != BeyondHull;
    const TetrahedronIds& ids = this->All.Tetrahedra[t];
    for (int i = 0; i < 4 && isAlone; ++i)
    {
      const Id facet = this->All.Neighbors[t][i];
      isAlone = this->States[facet / 4] == BeyondHull ||
        InSphere(p[ids[0]], p[ids[1]], p[ids[2]], p[ids[3]],
          p[this->All.Tetrahedra[facet / 4][facet % 4]]) != 0;
    }
    if (isAlone)
    {
      return true;
    }
  }
  return false;
}

Status AdvancingFront::CheckSurface()
{
  const std::vector<DuplicateTriangle> duplicates = FindDuplicateTriangles(this->Surface.Triangles);
  if (!duplicates.empty())
  {
    return Status::InvalidInput("Two triangles of the surface have the same points; clean the "
                                "surface with vtkBoundaryTriangulator first.",
      { duplicates.front().Triangle });
  }
  this->FindFacetsOfSurface();
  std::vector<Id> doubtful;
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    if (!this->IsSurelyStronglyDelaunay(t))
    {
      doubtful.push_back(t);
    }
  }
  if (!doubtful.empty())
  {
    const Status status = this->TurnDiagonals(doubtful);
    if (!status.IsOk())
    {
      return status;
    }
    this->FindFacetsOfSurface();
  }
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    if (this->SideFacets[side] == NoId)
    {
      return Status::InternalError("A boundary triangle is no facet of the mesh.", { side / 2 });
    }
  }
  return Status();
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
  return Status::InvalidInput("The surface encloses nothing: it has " +
      std::to_string(sides.OpenTriangles.size()) +
      " triangles with an open edge. Close it (MaximumGapEdges of vtkBoundaryTriangulator patches "
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
      this->Seeds.push_back({ this->SideFacets[side] / 4, NoId, side / 2 });
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
      this->Seeds.push_back({ this->SideFacets[side] / 4, label, side / 2 });
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
    return Status::InvalidInput("Region " + std::to_string(region) +
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

/** Where the front would end up if there is nothing to stop it. */
void AdvancingFront::TakeAll()
{
  this->Regions.resize(this->States.size());
  const Id infinite = static_cast<Id>(this->Order.size());
  std::mutex mutex;
  this->ForAll(this->States.size(),
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<Id> hull;
      Id count = 0;
      for (std::size_t t = begin; t < end; ++t)
      {
        const TetrahedronIds& ids = this->All.Tetrahedra[t];
        this->Regions[t] = 0;
        if (this->States[t] == BeyondHull)
        {
          const auto place = std::find(ids.begin(), ids.end(), infinite) - ids.begin();
          hull.push_back(this->All.Neighbors[t][place]);
        }
        else if (ids[0] != NoId)
        {
          this->States[t] = Meshed;
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
  return Status::InvalidInput("Region " + std::to_string(seed.Region) +
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

/** Only mesh points that are used stay. Afterwards Order has the final points. */
void AdvancingFront::CollectPointsUsed()
{
  std::vector<Id> places(this->Points.size(), NoId);
  if (!this->HasSurface() && !this->IsStopped)
  {
    // The mesh of the convex hull has all points.
    this->ForEach(this->Order.size(), [&](std::size_t i) { places[this->Order[i]] = 0; });
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
  this->ForEach(
    this->Order.size(), [&](std::size_t i) { this->Order[i] = places[this->Order[i]]; });
}

/**
 * Numbers the tetrahedra by their vertices alone: each starts with its first vertex along the curve,
 * then the first of the others, and all are in the order of their vertices.
 */
void AdvancingFront::CollectTetrahedra()
{
  TetMesh& mesh = this->Output.Mesh;
  const std::size_t slots = this->States.size();
  const std::size_t count = static_cast<std::size_t>(this->NumberOfTetrahedra);
  // How each is turned: the place of its first vertex and, after that, of the second one.
  static constexpr unsigned char Turns[12][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 },
    { 1, 0, 3, 2 }, { 1, 3, 2, 0 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 2, 1, 3, 0 }, { 2, 3, 0, 1 },
    { 3, 0, 2, 1 }, { 3, 2, 1, 0 }, { 3, 1, 0, 2 } };
  constexpr unsigned char NotMeshed = 12;
  // Their order within a vertex is left to chance here; it is settled below.
  std::vector<std::atomic<Id>> counts(this->Order.size());
  RawVector<Id> ranks(slots);
  const bool isAlone = this->Options.NumberOfThreads <= 1;
  const auto increment = [isAlone](std::atomic<Id>& counter)
  {
    if (!isAlone)
    {
      return counter.fetch_add(1, std::memory_order_relaxed);
    }
    // Without the lock, which would take as long as the rest of the loop.
    const Id value = counter.load(std::memory_order_relaxed);
    counter.store(value + 1, std::memory_order_relaxed);
    return value;
  };
  this->ForAll(slots,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (this->States[t] != Meshed)
        {
          this->States[t] = NotMeshed;
          continue;
        }
        const TetrahedronIds& ids = this->All.Tetrahedra[t];
        int first = ids[1] < ids[0] ? 1 : 0;
        first = ids[2] < ids[first] ? 2 : first;
        first = ids[3] < ids[first] ? 3 : first;
        int turn = 3 * first;
        turn = ids[Turns[3 * first + 1][1]] < ids[Turns[turn][1]] ? 3 * first + 1 : turn;
        turn = ids[Turns[3 * first + 2][1]] < ids[Turns[turn][1]] ? 3 * first + 2 : turn;
        this->States[t] = static_cast<unsigned char>(turn);
        ranks[t] = increment(counts[ids[first]]);
      }
    });
  std::vector<Id> starts(this->Order.size() + 1, 0);
  for (std::size_t vertex = 0; vertex < this->Order.size(); ++vertex)
  {
    starts[vertex + 1] = starts[vertex] + counts[vertex].load(std::memory_order_relaxed);
  }
  // Where the tetrahedra of a vertex will be: the others of their vertices, and where they are now.
  mesh.Tetrahedra.resize(count);
  this->ForAll(slots,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (this->States[t] != NotMeshed)
        {
          const TetrahedronIds& ids = this->All.Tetrahedra[t];
          const unsigned char* const turn = Turns[this->States[t]];
          mesh.Tetrahedra[starts[ids[turn[0]]] + ranks[t]] = { ids[turn[1]], ids[turn[2]],
            ids[turn[3]], static_cast<Id>(t) };
        }
      }
    });
  this->All.Tetrahedra = RawVector<TetrahedronIds>();
  ranks = RawVector<Id>();
  mesh.Regions.resize(count);
  this->ForAll(this->Order.size(),
    [&](std::size_t begin, std::size_t end)
    {
      // Two tetrahedra with the same first three vertices would lie on the same side of a facet.
      const auto isLess = [](const TetrahedronIds& s, const TetrahedronIds& t)
      { return s[0] != t[0] ? s[0] < t[0] : s[1] < t[1]; };
      constexpr Id Many = 32;
      for (std::size_t vertex = begin; vertex < end; ++vertex)
      {
        TetrahedronIds* const items = mesh.Tetrahedra.data() + starts[vertex];
        const Id size = starts[vertex + 1] - starts[vertex];
        if (size > Many)
        {
          std::sort(items, items + size, isLess);
        }
        for (Id i = 1; i < size && size <= Many; ++i)
        {
          // They are few: seven, on average.
          const TetrahedronIds item = items[i];
          Id k = i;
          for (; k > 0 && isLess(item, items[k - 1]); --k)
          {
            items[k] = items[k - 1];
          }
          items[k] = item;
        }
        for (Id i = 0; i < size; ++i)
        {
          const TetrahedronIds item = items[i];
          items[i] = { this->Order[vertex], this->Order[item[0]], this->Order[item[1]],
            this->Order[item[2]] };
          const Id place = starts[vertex] + i;
          mesh.Regions[place] = this->Regions[item[3]];
          // From here on its place.
          this->Regions[item[3]] = place;
        }
      }
    });
  const RawVector<Id>& places = this->Regions;
  unsigned char inverse[12][4];
  for (int turn = 0; turn < 12; ++turn)
  {
    for (int i = 0; i < 4; ++i)
    {
      inverse[turn][Turns[turn][i]] = static_cast<unsigned char>(i);
    }
  }
  mesh.Neighbors.resize(count);
  this->ForAll(slots,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (this->States[t] == NotMeshed)
        {
          continue;
        }
        TetrahedronIds& neighbors = mesh.Neighbors[places[t]];
        for (int i = 0; i < 4; ++i)
        {
          Id facet = this->All.Neighbors[t][Turns[this->States[t]][i]];
          facet = facet < 0 ? this->SideFacets[(FirstBarrier - facet) ^ 1] : facet;
          const unsigned char turn = this->States[facet / 4];
          neighbors[i] =
            turn == NotMeshed ? NoId : 4 * places[facet / 4] + inverse[turn][facet % 4];
        }
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
    const Id t = this->SideFacets[side] / 4;
    if (this->States[t] == Meshed)
    {
      RegionPair& labels = this->Surface.Labels[side / 2];
      (side % 2 == 0 ? labels.Front : labels.Back) = this->Regions[t];
    }
  }
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; side += 2)
  {
    this->Output.Report.UnusedTriangles += this->States[this->SideFacets[side] / 4] != Meshed &&
        this->States[this->SideFacets[side + 1] / 4] != Meshed
      ? 1
      : 0;
  }
  std::vector<std::pair<TriangleIds, Id>> hull;
  hull.reserve(this->HullFacets.size());
  for (Id facet : this->HullFacets)
  {
    hull.emplace_back(this->GetFacetPoints(facet), this->Regions[facet / 4]);
  }
  std::sort(hull.begin(), hull.end());
  for (const auto& [ids, region] : hull)
  {
    this->Surface.Triangles.push_back(ids);
    this->Surface.SourceCells.push_back(NoId);
    this->Surface.Labels.push_back({ OutsideRegion, region });
  }
  this->Surface.Points = this->Points;
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
  this->CollectTetrahedra();
}

Status AdvancingFront::MeshRegions()
{
  Status status = this->HasSurface() ? this->CheckSurface() : Status();
  if (status.IsOk())
  {
    status = this->FindSeeds();
  }
  if (!status.IsOk())
  {
    return status;
  }
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id facet = this->SideFacets[side];
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
  Status status = this->CollectPoints();
  if (status.IsOk())
  {
    status = this->TetrahedralizePoints();
  }
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
} // namespace

Status TetrahedralizeByAdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
  const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
  AdvancingFrontTetrahedralizerOutput& output)
{
  output = AdvancingFrontTetrahedralizerOutput();
  const Status status = AdvancingFront(input, options, context, output).Run();
  if (!status.IsOk() && !status.IsAborted())
  {
    output = AdvancingFrontTetrahedralizerOutput();
  }
  return status;
}
} // namespace cdm
