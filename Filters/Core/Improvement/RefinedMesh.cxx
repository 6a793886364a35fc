// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/RefinedMesh.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace cdm
{
namespace
{
/** Degrees: tetrahedra of boundary points with a smaller angle are flat but for rounding. */
constexpr double FlatAngle = 1e-6;
/**
 * A new point keeps this part of a point's size as its distance. A larger part (a tenth) leaves
 * more slivers, a smaller one leaves more of them at needles of the surface.
 */
constexpr double SizeRatio = 0.05;

/** Point ids that are reserved for splits: so many for each request, and so many more. */
constexpr std::size_t ReservedPerRequest = 4;
constexpr std::size_t FewestReserved = 256;

/** For each source cell one triangle that comes from it. */
std::vector<Id> ListSourceTriangles(const TriangleMesh& surface)
{
  const std::vector<Id>& sources = surface.SourceCells;
  std::vector<Id> triangles(
    sources.empty() ? 0 : *std::max_element(sources.begin(), sources.end()) + 1, NoId);
  for (std::size_t t = 0; t < sources.size(); ++t)
  {
    triangles[sources[t]] = static_cast<Id>(t);
  }
  return triangles;
}
} // namespace

RefinedMesh::RefinedMesh(TetMesh mesh, const RefinedBoundary& boundary,
  const std::vector<InteriorPoint>& interior, SliverMemory& memory,
  const RefinedMeshOptions& options)
  : Mesh(std::move(mesh)), Boundary(boundary), Limits(options.Limits),
    FirstInside(static_cast<Id>(boundary.Surface.Points.size())),
    MaximumNewPoints(options.MaximumNewPoints), TimeLimit(options.TimeLimit),
    Threads(options.Threads), Memory(memory),
    Shape(std::make_unique<BoundaryShape>(boundary.Surface, boundary.Edges, boundary.KeptEdges,
      options.SharpPlaneAngle, options.LayerAspectRatio)),
    Requests(boundary.Surface, boundary.KeptEdges,
      [this](Id point, double distance) { return distance >= this->GetClearance(point); }),
    Facts(this->Mesh, this->Limits)
{
  const int numberOfThreads = this->Threads->GetNumberOfThreads();
  for (int i = 0; i < numberOfThreads; ++i)
  {
    this->Searches.push_back(this->Mesh.MakeSearch(numberOfThreads > 1));
  }
  const std::vector<Vec3>& positions = boundary.Surface.Points;
  const std::vector<double>& sizes = options.SurfaceSizes;
  for (std::size_t p = 0; p < positions.size(); ++p)
  {
    this->Points.push_back(
      { positions[p], sizes.empty() ? 0.0 : sizes[p], false, NoId, static_cast<Id>(p) });
  }
  this->Points.insert(this->Points.end(), interior.begin(), interior.end());
  this->Work.Triangles = static_cast<std::int64_t>(boundary.Surface.Triangles.size());
  this->Work.Tetrahedra = this->Mesh.GetNumberOfTetrahedra();
  std::vector<Id> all(this->Mesh.GetNumberOfTetrahedra());
  std::iota(all.begin(), all.end(), 0);
  this->BoundSizes(all);
}

/**
 * No size is larger than another one and the way there, along edges, beginning with some. The
 * smallest one goes on first (Dijkstra), so that none is bounded twice from the same side.
 */
void RefinedMesh::BoundSizes(const std::vector<Id>& tetrahedra)
{
  using Bound = std::pair<double, Id>;
  std::priority_queue<Bound, std::vector<Bound>, std::greater<>> changed;
  const auto bound = [&](const InteriorPoint& by, Id point)
  {
    InteriorPoint& bounded = this->Points[point];
    if (by.Size >= bounded.Size)
    {
      return;
    }
    const double size = by.Size + Distance(by.Position, bounded.Position);
    if (size < bounded.Size)
    {
      bounded.Size = size;
      changed.emplace(size, point);
    }
  };
  this->Work.Sizes += static_cast<std::int64_t>(tetrahedra.size());
  for (Id t : tetrahedra)
  {
    const TetrahedronIds& ids = this->GetMesh().Tetrahedra[t];
    for (const auto& [i, j] : TetrahedronEdges)
    {
      bound(this->Points[ids[i]], ids[j]);
      bound(this->Points[ids[j]], ids[i]);
    }
  }
  std::vector<Id> star;
  while (!changed.empty())
  {
    const auto [size, point] = changed.top();
    changed.pop();
    if (size > this->Points[point].Size)
    {
      continue;
    }
    this->Mesh.FindStar(point, star);
    this->Work.Sizes += static_cast<std::int64_t>(star.size());
    for (Id t : star)
    {
      for (Id other : this->GetMesh().Tetrahedra[t])
      {
        bound(this->Points[point], other);
      }
    }
  }
}

void RefinedMesh::NoteNewPoints(const std::vector<char>& isNew)
{
  for (const TetrahedronIds& ids : this->GetMesh().Tetrahedra)
  {
    if (std::any_of(
          ids.begin(), ids.end(), [&](Id id) { return id < this->FirstInside && isNew[id] != 0; }))
    {
      this->Memory.SetChanged(this->GetNames(ids));
    }
  }
}

void RefinedMesh::SetSizes(const std::vector<double>& sizes)
{
  for (std::size_t p = 0; p < sizes.size(); ++p)
  {
    this->Points[p].Size = sizes[p];
  }
}

void RefinedMesh::HalveSizes(const std::vector<Id>& points, const std::vector<Id>& tetrahedra)
{
  for (Id p : points)
  {
    this->Points[p].Size *= 0.5;
  }
  this->BoundSizes(tetrahedra);
}

void RefinedMesh::SetSurfaceSizes(Id first, const std::vector<double>& sizes)
{
  for (std::size_t p = first; p < sizes.size(); ++p)
  {
    this->Points[p].Size = sizes[p];
  }
}

/** Bounds the sizes of points by those that the last splits have made. */
void RefinedMesh::BoundSizesAtSplits()
{
  std::vector<Id> changed;
  for (Id t : this->Splits->GetChanged())
  {
    if (!this->Mesh.IsDead(t))
    {
      changed.push_back(t);
    }
  }
  this->BoundSizes(changed);
}

void RefinedMesh::GetInterior(std::vector<InteriorPoint>& interior) const
{
  interior.clear();
  interior.reserve(this->Points.size() - this->FirstInside);
  for (Id p = this->FirstInside; p < this->Mesh.GetNumberOfPoints(); ++p)
  {
    if (this->Mesh.GetTetrahedronAt(p) != NoId)
    {
      interior.push_back(this->Points[p]);
    }
  }
}

RefinementWork RefinedMesh::GetWork() const
{
  RefinementWork work = this->Work;
  work.Tetrahedra += this->Mesh.CountMade();
  work.Spheres = this->Shape->Spheres.GetNumberOfVisits();
  work.SharpAngles = this->Shape->Sharp.GetNumberOfVisits();
  work.Layers = this->Shape->Layers.GetNumberOfVisits();
  work.Couplings = this->Couplings.GetNumberOfVisits();
  work.Faults = this->Flatter.GetNumberOfVisits() + this->Slivers.GetNumberOfVisits() +
    this->Faulty.GetNumberOfVisits();
  return work;
}

TetMesh RefinedMesh::TakeMesh()
{
  this->Facts.Forget();
  TetMesh mesh = this->Mesh.TakeMesh();
  RemoveDeadTetrahedra(mesh);
  const Id onSurface = static_cast<Id>(this->Boundary.Surface.Points.size());
  std::vector<Id> newIds(mesh.Points.size(), NoId);
  Id count = 0;
  for (Id p = 0; p < static_cast<Id>(newIds.size()); ++p)
  {
    if (p < onSurface || (p >= this->FirstInside && this->Mesh.GetTetrahedronAt(p) != NoId))
    {
      mesh.Points[count] = mesh.Points[p];
      newIds[p] = count++;
    }
  }
  mesh.Points.resize(count);
  for (TetrahedronIds& ids : mesh.Tetrahedra)
  {
    ids = Renumber(ids, newIds);
  }
  return mesh;
}

bool RefinedMesh::RequestEncroached(const Vec3& position, bool isSizeKept)
{
  this->Shape->Spheres.Find(position, this->Encroached);
  if (this->Encroached.IsEmpty())
  {
    return false;
  }
  this->Requests.AddEncroached(position, this->Encroached, isSizeKept);
  return true;
}

std::size_t RefinedMesh::RequestNegativeCouplings()
{
  const std::vector<EdgeIds>& edges = this->Couplings.Update(
    this->Mesh, this->Boundary.Surface, this->Shape->PointTriangles, *this->Threads);
  const std::size_t before = this->Requests.GetNumber();
  for (const EdgeIds& edge : edges)
  {
    this->Requests.AddEdgeOrTriangle(edge, this->Shape->PointTriangles, true);
  }
  for (std::size_t i = 0; i < edges.size() && this->Requests.GetNumber() == before; ++i)
  {
    this->Requests.AddEdgeOrTriangle(edges[i], this->Shape->PointTriangles, false);
  }
  return edges.size();
}

/** Reserves point ids for the requested splits, and as many more as half of the surface has. */
void RefinedMesh::ReservePoints()
{
  const std::size_t onSurface = this->Boundary.Surface.Points.size();
  const std::size_t wanted = FewestReserved + ReservedPerRequest * this->Requests.GetNumber();
  if (this->FirstInside >= static_cast<Id>(onSurface + wanted))
  {
    return;
  }
  const Id count = static_cast<Id>(wanted + onSurface / 2);
  this->Mesh.ReservePoints(this->FirstInside, count);
  this->Points.insert(this->Points.begin() + this->FirstInside, count, InteriorPoint());
  for (Id& point : this->ChangedInside)
  {
    point += count;
  }
  this->FirstInside += count;
  if (this->Splits)
  {
    this->Splits->SetFirstInside(this->FirstInside);
  }
}

bool RefinedMesh::SplitBoundary(std::vector<Id> moved, const DelaunaySurfaceRefinerOptions& options,
  const SizingField& sizing, const std::function<bool()>& setSizes, const ExecutionContext& context,
  Status& status)
{
  this->ReservePoints();
  for (Id p : moved)
  {
    this->Points[p].Position = this->Boundary.Surface.Points[p];
  }
  ChangedPoints changed{ std::move(moved), std::exchange(this->ChangedInside, {}) };
  SortUnique(changed.Inside);
  if (!this->Splits)
  {
    this->Splits = std::make_unique<BoundarySplits>(
      this->Mesh, this->FirstInside, this->Boundary.Surface, this->Boundary.Edges, options, sizing);
    this->SourceTriangles = ListSourceTriangles(this->Boundary.Surface);
  }
  const Id first = static_cast<Id>(this->Boundary.Surface.Points.size());
  status = this->Splits->Run(changed, this->Requests.Triangles, this->Requests.Edges, context);
  const Id end = static_cast<Id>(this->Boundary.Surface.Points.size());
  for (Id p = first; p < end; ++p)
  {
    this->Points[p] = { this->Boundary.Surface.Points[p], 0.0, false, NoId, p };
  }
  this->MaximumNewPoints -= end - first;
  this->Work.PointsInMesh += end - first;
  for (Id t : this->Splits->GetChanged())
  {
    if (!this->Mesh.IsDead(t))
    {
      this->Memory.SetChanged(this->GetNames(this->GetMesh().Tetrahedra[t]));
    }
  }
  if (!status.IsOk() || !this->Splits->IsUsable())
  {
    return false;
  }
  const bool haveSizes = setSizes();
  this->Threads->RunBoth([&] { this->FollowBoundary(changed.OnSurface); },
    [&]
    {
      if (haveSizes)
      {
        this->BoundSizesAtSplits();
      }
    });
  this->Requests.Clear();
  return true;
}

/** The structural edges of some triangles of the surface that end at some points, which ascend. */
std::vector<Id> RefinedMesh::FindEdgesAt(
  const std::vector<Id>& points, const std::vector<Id>& triangles) const
{
  const std::vector<StructuralEdge>& all = this->Boundary.Edges;
  const auto isAmong = [&points](Id id)
  { return std::binary_search(points.begin(), points.end(), id); };
  std::vector<Id> edges;
  for (Id t : triangles)
  {
    const TriangleIds& ids = this->Boundary.Surface.Triangles[t];
    for (int i = 0; i < 3; ++i)
    {
      const EdgeIds ends = MakeEdge(ids[i], ids[(i + 1) % 3]);
      const StructuralEdge* const edge =
        isAmong(ends[0]) || isAmong(ends[1]) ? FindStructuralEdge(all, ends) : nullptr;
      if (edge != nullptr)
      {
        edges.push_back(static_cast<Id>(edge - all.data()));
      }
    }
  }
  return edges;
}

/** Brings what is known of the boundary up to date. */
void RefinedMesh::FollowBoundary(const std::vector<Id>& moved)
{
  const TriangleMesh& surface = this->Boundary.Surface;
  BoundaryChange change{ this->Splits->GetChangedTriangles(), {}, this->Splits->GetChangedEdges(),
    this->Splits->GetSegments() };
  for (Id point : moved)
  {
    const IdLists::Range triangles = this->Shape->PointTriangles[point];
    change.Triangles.insert(change.Triangles.end(), triangles.begin(), triangles.end());
  }
  SortUnique(change.Triangles);
  const std::vector<Id> movedEdges = this->FindEdgesAt(moved, change.Triangles);
  change.Edges.insert(change.Edges.end(), movedEdges.begin(), movedEdges.end());
  SortUnique(change.Edges);
  for (Id t : change.Triangles)
  {
    change.Parents.push_back(this->SourceTriangles[surface.SourceCells[t]]);
  }
  this->Work.Triangles += static_cast<std::int64_t>(change.Triangles.size());
  this->Shape->Follow(change);
  this->Couplings.NoteTriangles(surface, change.Triangles);
  if (this->BeforeMoves)
  {
    this->Facts.Forget(*this->BeforeMoves);
    for (TetrahedronWatch* const watch : { &this->Flatter, &this->Slivers, &this->Faulty })
    {
      watch->Forget(*this->BeforeMoves);
    }
    this->BeforeMoves.reset();
  }
}

void RefinedMesh::SetImmovable(const std::vector<Id>& points, SliverPlace place)
{
  for (const Id point : points)
  {
    this->Memory.SetImmovable(this->Points[point].Name, place);
  }
}

bool RefinedMesh::IsFree(Id point) const
{
  return point >= this->FirstInside && this->Points[point].IsFree &&
    this->Mesh.GetTetrahedronAt(point) != NoId;
}

double RefinedMesh::GetClearance(Id point) const
{
  return SizeRatio * this->Points[point].Size;
}

bool RefinedMesh::IsFlat(Id tetrahedron) const
{
  const TetrahedronIds& ids = this->GetMesh().Tetrahedra[tetrahedron];
  return *std::max_element(ids.begin(), ids.end()) < this->FirstInside &&
    this->GetAngle(tetrahedron) < FlatAngle;
}

std::vector<Id> RefinedMesh::FindFlatTetrahedra() const
{
  std::vector<Id> flat = this->FindFlatter(FlatAngle);
  flat.erase(std::remove_if(flat.begin(), flat.end(), [this](Id t) { return !this->IsFlat(t); }),
    flat.end());
  std::sort(flat.begin(), flat.end());
  return flat;
}

/** Finds tetrahedra that have a property and an angle below the target. */
template <typename Property>
std::vector<Id> RefinedMesh::FindBelow(
  double target, TetrahedronWatch& watch, Property&& hasProperty) const
{
  if (target > this->FlatterTarget)
  {
    this->FlatterTarget = target;
    this->Flatter.Forget({});
    this->Slivers.Forget({});
  }
  this->Facts.MakeRoom();
  std::vector<Id> found = watch.Update(this->Mesh, *this->Threads,
    [&](Id t) { return this->GetAngle(t) < this->FlatterTarget && hasProperty(t); });
  found.erase(
    std::remove_if(found.begin(), found.end(), [&](Id t) { return !(this->GetAngle(t) < target); }),
    found.end());
  return found;
}

std::vector<Id> RefinedMesh::FindFlatter(double target) const
{
  return this->FindBelow(target, this->Flatter, [](Id) { return true; });
}

std::vector<Id> RefinedMesh::FindSlivers(double target) const
{
  return this->FindBelow(target, this->Slivers,
    [this](Id t) { return !this->IsAcrossSharp(t, SharpAngleUse::Sliver) && !this->IsInLayer(t); });
}

bool RefinedMesh::IsFaulty(Id tetrahedron, bool isShapeTested) const
{
  const TetrahedronFault fault = this->GetFault(tetrahedron);
  return fault == TetrahedronFault::Size ||
    (fault == TetrahedronFault::Shape && isShapeTested &&
      !this->IsAcrossSharp(tetrahedron, SharpAngleUse::Shape) && !this->IsInLayer(tetrahedron) &&
      !this->IsFlat(tetrahedron));
}

std::vector<char> RefinedMesh::FindExcusedTriangles() const
{
  const std::vector<TriangleIds>& triangles = this->Boundary.Surface.Triangles;
  const std::vector<Id>& facets = this->Shape->Sharp.GetFacets();
  std::vector<char> isMarked = this->Shape->Sharp.MarkFacets();
  for (Id t = 0; t < this->Mesh.GetNumberOfTetrahedra(); ++t)
  {
    for (int i = 0; i < 4 && !this->Mesh.IsDead(t) && this->IsInLayer(t); ++i)
    {
      const Id triangle = FindTriangle(
        triangles, this->Shape->PointTriangles, GetFacet(this->GetMesh().Tetrahedra[t], i));
      if (triangle != NoId)
      {
        isMarked[facets[triangle]] = 1;
      }
    }
  }
  std::vector<char> isExcused(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    isExcused[t] = isMarked[facets[t]];
  }
  return isExcused;
}

const std::vector<Id>& RefinedMesh::FindFaulty(bool isShapeTested) const
{
  if (isShapeTested != this->IsFaultyShape)
  {
    this->IsFaultyShape = isShapeTested;
    this->Faulty.Forget({});
  }
  this->Facts.MakeRoom();
  return this->Faulty.Update(
    this->Mesh, *this->Threads, [&](Id t) { return this->IsFaulty(t, isShapeTested); });
}

bool RefinedMesh::BreaksLimit(Id tetrahedron) const
{
  const TetrahedronFault fault = this->GetFault(tetrahedron);
  return fault == TetrahedronFault::Size ||
    (fault == TetrahedronFault::Shape && !this->IsAcrossSharp(tetrahedron, SharpAngleUse::Shape));
}

bool RefinedMesh::BreaksLimit(const TetrahedronIds& ids, const std::array<Vec3, 4>& corners) const
{
  Vec3 target;
  double severity = 0.0;
  const TetrahedronFault fault = this->Limits.Find(corners, true, target, severity);
  return fault == TetrahedronFault::Size ||
    (fault == TetrahedronFault::Shape && !this->Shape->Sharp.IsAcross(ids));
}

bool RefinedMesh::BreaksLimit(const TriangleIds& facet, const Vec3& inside) const
{
  constexpr Id other = std::numeric_limits<Id>::max();
  return this->BreaksLimit({ facet[0], facet[1], facet[2], other },
    { this->Mesh.GetPoint(facet[0]), this->Mesh.GetPoint(facet[1]), this->Mesh.GetPoint(facet[2]),
      inside });
}

void RefinedMesh::NoteChanges()
{
  for (Id t : this->Mesh.GetChanged())
  {
    this->Memory.SetChanged(this->GetNames(this->GetMesh().Tetrahedra[t]));
  }
}

void RefinedMesh::NoteSurfaceMove()
{
  this->NoteChanges();
  if (!this->BeforeMoves)
  {
    this->BeforeMoves = this->Mesh.GetMomentBeforeChange();
  }
}

TetrahedronIds RefinedMesh::GetNames(const TetrahedronIds& ids) const
{
  return { this->Points[ids[0]].Name, this->Points[ids[1]].Name, this->Points[ids[2]].Name,
    this->Points[ids[3]].Name };
}

std::size_t RefinedMesh::FindBroken(const PointCavity& cavity, const Vec3& position) const
{
  const auto found = std::find_if(cavity.Facets.begin(), cavity.Facets.end(),
    [&](const TriangleIds& facet) { return this->BreaksLimit(facet, position); });
  return static_cast<std::size_t>(found - cavity.Facets.begin());
}

bool RefinedMesh::IsClear(const PointCavity& cavity, const Vec3& position) const
{
  for (const TriangleIds& facet : cavity.Facets)
  {
    for (Id id : facet)
    {
      if (Distance(position, this->Mesh.GetPoint(id)) < this->GetClearance(id))
      {
        return false;
      }
    }
  }
  return true;
}

bool RefinedMesh::EncroachesOnBoundary(
  const PointCavity& cavity, const Vec3& position, BoundarySpheres::Encroached& scratch) const
{
  // An encroached boundary triangle has its corners at the cavity.
  const bool isNear = std::any_of(cavity.Facets.begin(), cavity.Facets.end(),
    [&](const TriangleIds& facet)
    { return *std::min_element(facet.begin(), facet.end()) < this->FirstInside; });
  if (!isNear)
  {
    scratch.Clear();
    return false;
  }
  this->Shape->Spheres.Find(position, scratch);
  return !scratch.IsEmpty() || this->TouchesOpenFacet(cavity);
}

/**
 * Whether the cavity ends at an outer facet that is no triangle of the surface. The smallest sphere
 * of such a facet need not be empty. So a point on this side may be in conflict with points beyond,
 * which the mesh does not know.
 */
bool RefinedMesh::TouchesOpenFacet(const PointCavity& cavity) const
{
  for (std::size_t i = 0; i < cavity.Facets.size(); ++i)
  {
    if (cavity.Outer[i] != NoId)
    {
      continue;
    }
    if (!IsTriangle(
          this->Boundary.Surface.Triangles, this->Shape->PointTriangles, cavity.Facets[i]))
    {
      return true;
    }
  }
  return false;
}

void RefinedMesh::Insert(const Vec3& position, const PointCavity& cavity)
{
  double size = Infinity;
  for (const TriangleIds& facet : cavity.Facets)
  {
    for (Id id : facet)
    {
      size = std::min(size, this->Points[id].Size + Distance(position, this->Mesh.GetPoint(id)));
    }
  }
  this->ChangedInside.push_back(this->Mesh.Insert(position, cavity));
  this->Points.push_back({ position, size, true, NoId, this->Memory.MakeName() });
  this->NoteChanges();
  ++this->Report.InsertedPoints;
}

void RefinedMesh::NoteMove(Id point)
{
  this->Points[point].Position = this->Mesh.GetPoint(point);
  this->Points[point].Source = NoId;
  ++this->Report.MovedPoints;
  this->ChangedInside.push_back(point);
  this->NoteChanges();
}

void RefinedMesh::NoteRemoval(Id point)
{
  this->ChangedInside.push_back(point);
  ++this->Report.RemovedPoints;
  this->NoteChanges();
}
} // namespace cdm
