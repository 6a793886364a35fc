// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundarySplits.h"

#include "Core/Basics/HandOver.h"
#include "Core/Basics/IdLimits.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
/**
 * One run may make so many points, and so many for each split. What makes more has run away: it is in
 * thin stacks, for which the usual rules are not enough.
 */
constexpr std::size_t MostPoints = 1000;
constexpr std::size_t MostPerSplit = 20;
/** A second thread helps with at least so many splits: it hardly wakes before fewer are done. */
constexpr std::size_t FewestForThreads = 4;

bool IsInSorted(const std::vector<TriangleIds>& sorted, const TriangleIds& key)
{
  return std::binary_search(sorted.begin(), sorted.end(), key);
}

std::vector<Vec3> CollectPointsInside(const DynamicTetrahedralization& mesh, Id firstInside)
{
  std::vector<Vec3> points;
  for (Id p = firstInside; p < mesh.GetNumberOfPoints(); ++p)
  {
    if (mesh.GetTetrahedronAt(p) != NoId)
    {
      points.push_back(mesh.GetPoint(p));
    }
  }
  return points;
}

/** A plan with the usual rules, which gives up where a run makes too many points. */
SurfaceRefinementPlan MakePlan()
{
  SurfaceRefinementPlan plan;
  plan.GivesUp = true;
  plan.MostNeedles = LargestId;
  return plan;
}
} // namespace

BoundarySplits::BoundarySplits(DynamicTetrahedralization& mesh, Id firstInside,
  TriangleMesh& surface, std::vector<StructuralEdge>& edges,
  const DelaunaySurfaceRefinerOptions& options, const SizingField& sizing)
  : Mesh(mesh), FirstInside(firstInside), Surface(surface), Edges(edges),
    Refinement(
      surface, edges, CollectPointsInside(mesh, firstInside), options, sizing, true, MakePlan()),
    SourceCells(surface.SourceCells)
{
  this->SurfacePoints.resize(surface.Points.size());
  std::iota(this->SurfacePoints.begin(), this->SurfacePoints.end(), 0);
  this->RefinementSurfacePoints = this->SurfacePoints;
  for (Id p = firstInside; p < mesh.GetNumberOfPoints(); ++p)
  {
    const bool isThere = mesh.GetTetrahedronAt(p) != NoId;
    this->RefinementPoints.push_back(isThere ? static_cast<Id>(this->SurfacePoints.size()) : NoId);
    if (isThere)
    {
      this->SurfacePoints.push_back(NoId);
    }
  }
  this->Segments.resize(edges.size());
  std::iota(this->Segments.begin(), this->Segments.end(), 0);
  for (const StructuralEdge& edge : edges)
  {
    this->SegmentEdges.push_back(edge.Points);
  }
}

/** Tells the refinement which points have come, moved or gone since the last run. */
Status BoundarySplits::FollowPoints(const ChangedPoints& changed, const ExecutionContext& context)
{
  const std::vector<Vec3>& points = this->Refinement.GetPoints();
  SurfaceRefinement::PointChanges changes;
  this->Moved.clear();
  for (Id point : changed.OnSurface)
  {
    const Vec3& position = this->Surface.Points[point];
    const Id known = this->RefinementSurfacePoints[point];
    if (points[known] != position)
    {
      changes.MovedOnSurface.emplace_back(known, position);
    }
    if (this->Mesh.GetPoint(point) != position)
    {
      this->Moved.push_back(point);
    }
  }
  this->RefinementPoints.resize(this->Mesh.GetNumberOfPoints() - this->FirstInside, NoId);
  for (Id p : changed.Inside)
  {
    Id& known = this->RefinementPoints[p - this->FirstInside];
    const bool isThere = this->Mesh.GetTetrahedronAt(p) != NoId;
    if (known != NoId && !isThere)
    {
      changes.Removed.push_back(known);
      known = NoId;
    }
    else if (known == NoId && isThere)
    {
      known = static_cast<Id>(points.size() + changes.Added.size());
      changes.Added.push_back(this->Mesh.GetPoint(p));
      this->SurfacePoints.push_back(NoId);
    }
    else if (isThere && points[known] != this->Mesh.GetPoint(p))
    {
      changes.Moved.emplace_back(known, this->Mesh.GetPoint(p));
    }
  }
  this->Refinement.ChangePoints(changes, *context.GetTeam());
  return this->Refinement.Refine(context);
}

Id BoundarySplits::FindSegment(const EdgeIds& edge) const
{
  const StructuralEdge* const found = FindStructuralEdge(this->Edges, MakeEdge(edge[0], edge[1]));
  return found != nullptr ? this->Segments[found - this->Edges.data()] : NoId;
}

Status BoundarySplits::Run(const ChangedPoints& changed, std::vector<Id>& triangles,
  std::vector<EdgeIds>& edges, const ExecutionContext& context)
{
  this->Changed.clear();
  this->ChangedTriangles.clear();
  const std::size_t count = triangles.size() + edges.size();
  this->Refinement.AllowNewPoints(MostPoints + MostPerSplit * count);
  this->NextPoint = static_cast<Id>(this->Surface.Points.size());
  Status status = this->FollowPoints(changed, context);
  if (!status.IsOk())
  {
    this->CanGoOn = false;
    return status;
  }
  ThreadTeam* const team = count >= FewestForThreads ? context.GetThreads().get() : nullptr;
  std::size_t done = count;
  HandOver<SurfaceChange>(
    team, [&](const auto& put) { status = this->Split(triangles, edges, context, put); },
    [&](const SurfaceChange& change)
    {
      this->CanGoOn = this->Follow(change);
      if (!this->CanGoOn)
      {
        done = change.Place;
        this->RanAway = change.HasRunAway;
      }
      return this->CanGoOn;
    });
  this->CanGoOn = this->CanGoOn && status.IsOk();
  const auto doneEdges = static_cast<std::ptrdiff_t>(std::min(done, edges.size()));
  const auto doneTriangles = static_cast<std::ptrdiff_t>(done) - doneEdges;
  edges.erase(edges.begin(), edges.begin() + doneEdges);
  triangles.erase(triangles.begin(), triangles.begin() + doneTriangles);
  SortUnique(this->ChangedTriangles);
  if (this->IsUsable())
  {
    this->UpdateEdges();
  }
  return status;
}

/**
 * Splits edges, then triangles, of the surface. What it puts first is what the points that have
 * changed have led to.
 */
Status BoundarySplits::Split(const std::vector<Id>& triangles, const std::vector<EdgeIds>& edges,
  const ExecutionContext& context, const std::function<bool(SurfaceChange)>& put)
{
  // Segments by then: their edges are listed anew at the end.
  std::vector<Id> segments;
  for (const EdgeIds& edge : edges)
  {
    segments.push_back(this->FindSegment(edge));
  }
  const RefinableSurface& refined = this->Refinement.GetSurface();
  Status status;
  bool isGoingOn = put(this->TakeChange(0));
  const Id firstNew = this->NextPoint;
  for (std::size_t i = 0; i < edges.size() && isGoingOn; ++i)
  {
    if (segments[i] == NoId)
    {
      continue;
    }
    const EdgeIds& ends = refined.GetSegment(segments[i]).Points;
    if (MakeEdge(this->SurfacePoints[ends[0]], this->SurfacePoints[ends[1]]) ==
      MakeEdge(edges[i][0], edges[i][1]))
    {
      status = this->Refinement.SplitSegment(segments[i], context);
      isGoingOn = status.IsOk() && put(this->TakeChange(i));
    }
  }
  for (std::size_t i = 0; i < triangles.size() && isGoingOn; ++i)
  {
    const TriangleIds ids = this->Translate(refined.GetTriangle(triangles[i]).Points);
    if (*std::max_element(ids.begin(), ids.end()) < firstNew)
    {
      status = this->Refinement.SplitTriangle(triangles[i], context);
      isGoingOn = status.IsOk() && put(this->TakeChange(edges.size() + i));
    }
  }
  return status;
}

TriangleIds BoundarySplits::Translate(const TriangleIds& refined) const
{
  return { this->SurfacePoints[refined[0]], this->SurfacePoints[refined[1]],
    this->SurfacePoints[refined[2]] };
}

/** What the refinement has done to the surface since this was last asked for. */
BoundarySplits::SurfaceChange BoundarySplits::TakeChange(std::size_t place)
{
  SurfaceChange change;
  change.Place = place;
  const std::vector<Vec3>& refined = this->Refinement.GetPoints();
  change.Points.assign(
    refined.begin() + static_cast<std::ptrdiff_t>(this->SurfacePoints.size()), refined.end());
  for (std::size_t i = 0; i < change.Points.size(); ++i)
  {
    this->RefinementSurfacePoints.push_back(static_cast<Id>(this->SurfacePoints.size()));
    this->SurfacePoints.push_back(this->NextPoint++);
  }
  std::vector<Id> touched = this->Refinement.TakeTouched();
  const bool isResolved = std::none_of(
    touched.begin(), touched.end(), [this](Id t) { return this->Refinement.IsUnresolved(t); });
  change.HasRunAway = this->Refinement.IsFull();
  change.IsPossible = isResolved && !change.HasRunAway && this->NextPoint <= this->FirstInside;
  if (!change.IsPossible)
  {
    return change;
  }
  this->Refinement.PullCocircular(touched);
  const std::vector<Id> pulled = this->Refinement.TakeTouched();
  touched.insert(touched.end(), pulled.begin(), pulled.end());
  SortUnique(touched);
  change.NumberOfTriangles = this->Refinement.GetSurface().GetNumberOfTriangles();
  for (Id t : touched)
  {
    const RefinableSurface::Triangle& triangle = this->Refinement.GetSurface().GetTriangle(t);
    change.Triangles.push_back(
      { t, this->Translate(triangle.Points), triangle.Labels, this->SourceCells[triangle.Source] });
    if (triangle.IsReversed)
    {
      NewTriangle& turned = change.Triangles.back();
      std::swap(turned.Ids[1], turned.Ids[2]);
      std::swap(turned.Labels.Front, turned.Labels.Back);
    }
  }
  return change;
}

/** Makes the mesh fit the refined surface. False if that is impossible; then nothing changes. */
bool BoundarySplits::Follow(const SurfaceChange& change)
{
  if (!change.IsPossible)
  {
    return false;
  }
  for (const NewTriangle& triangle : change.Triangles)
  {
    this->ChangedTriangles.push_back(triangle.Index);
  }
  this->CollectTriangles(change);
  if (this->Triangles.empty() && this->Moved.empty())
  {
    return change.Points.empty();
  }
  if (!this->CollectConflicts(change))
  {
    return false;
  }
  this->CollectCavity();
  const bool isFilled = this->FillByCone(change.Points);
  if (!isFilled)
  {
    this->CollectPoints(change.Points);
    if (!this->Filling.Run(this->Around) || !this->AreWallsComplete())
    {
      return false;
    }
  }
  this->Adopt(change, isFilled ? this->Cone.GetCells() : this->Filling.GetCells());
  this->Moved.clear();
  return true;
}

/** Collects the triangles of the surface that have changed. */
void BoundarySplits::CollectTriangles(const SurfaceChange& change)
{
  const Id count = static_cast<Id>(this->Surface.Triangles.size());
  this->Triangles.clear();
  this->Vanished.clear();
  this->Made.clear();
  for (const NewTriangle& triangle : change.Triangles)
  {
    const TriangleIds key = Sorted(triangle.Ids);
    const Id t = triangle.Index;
    if (t < count && Sorted(this->Surface.Triangles[t]) == key)
    {
      continue;
    }
    this->Triangles.push_back(triangle);
    this->Made.push_back(key);
    if (t < count)
    {
      this->Vanished.push_back(Sorted(this->Surface.Triangles[t]));
    }
  }
  // A flip sequence may leave a triangle under another index: it has neither vanished nor been
  // made.
  SortUnique(this->Made);
  SortUnique(this->Vanished);
  std::vector<TriangleIds> both;
  std::set_intersection(this->Made.begin(), this->Made.end(), this->Vanished.begin(),
    this->Vanished.end(), std::back_inserter(both));
  const auto isInBoth = [&both](const TriangleIds& key) { return IsInSorted(both, key); };
  this->Made.erase(
    std::remove_if(this->Made.begin(), this->Made.end(), isInBoth), this->Made.end());
  this->Vanished.erase(
    std::remove_if(this->Vanished.begin(), this->Vanished.end(), isInBoth), this->Vanished.end());
  this->MadeFrom.resize(this->Made.size());
  for (std::size_t i = 0; i < this->Triangles.size(); ++i)
  {
    const TriangleIds key = Sorted(this->Triangles[i].Ids);
    const auto made = std::lower_bound(this->Made.begin(), this->Made.end(), key);
    if (made != this->Made.end() && *made == key)
    {
      this->MadeFrom[made - this->Made.begin()] = i;
    }
  }
}

/**
 * Finds the tetrahedron facets that are this triangle, and adds them to Sides. False if there are
 * none.
 */
bool BoundarySplits::FindSides(const TriangleIds& ids)
{
  // Tetrahedra at a point are connected across facets, unless outer facets meet in an edge only.
  // New points come first: they have few tetrahedra, while corners of the input may have thousands.
  const TetMesh& mesh = this->Mesh.GetMesh();
  for (auto point = ids.rbegin(); point != ids.rend(); ++point)
  {
    ++this->Search;
    this->Open.assign(1, this->Mesh.GetTetrahedronAt(*point));
    this->Visits[this->Open.front()] = this->Search;
    while (!this->Open.empty())
    {
      const Id t = this->Open.back();
      this->Open.pop_back();
      const TetrahedronIds& vertices = mesh.Tetrahedra[t];
      const bool isFacet =
        std::all_of(ids.begin(), ids.end(), [&vertices](Id id) { return Contains(vertices, id); });
      for (int i = 0; i < 4; ++i)
      {
        const Id neighbor = mesh.Neighbors[t][i];
        if (isFacet && !Contains(ids, vertices[i]))
        {
          this->Sides.push_back(4 * t + i);
          if (neighbor != NoId)
          {
            this->Sides.push_back(neighbor);
          }
          this->Open.clear();
          return true;
        }
        if (neighbor != NoId && vertices[i] != *point && this->Visits[neighbor / 4] != this->Search)
        {
          this->Visits[neighbor / 4] = this->Search;
          this->Open.push_back(neighbor / 4);
        }
      }
    }
  }
  return false;
}

/**
 * Adds the tetrahedron to the cavity if it has the point or if its closed circumsphere holds the
 * position, unless this search has looked at it before.
 */
void BoundarySplits::Visit(Id tetrahedron, Id point, const Vec3& position)
{
  if (this->Visits[tetrahedron] == this->Search)
  {
    return;
  }
  this->Visits[tetrahedron] = this->Search;
  const TetMesh& mesh = this->Mesh.GetMesh();
  const TetrahedronIds& ids = mesh.Tetrahedra[tetrahedron];
  const auto [a, b, c, d] = GetCorners(mesh.Points, ids);
  const int side = InSphere(a, b, c, d, position);
  this->IsNoCone = this->IsNoCone || side == 0;
  if (side < 0 && !Contains(ids, point))
  {
    return;
  }
  this->Open.push_back(tetrahedron);
  if (this->IsInCavity[tetrahedron] == 0)
  {
    this->IsInCavity[tetrahedron] = 1;
    this->Tetrahedra.push_back(tetrahedron);
  }
}

/** All tetrahedra of any region at points that are moved, or whose spheres hold new positions. */
bool BoundarySplits::CollectConflicts(const SurfaceChange& change)
{
  this->Sides.clear();
  this->Visits.resize(this->Mesh.GetNumberOfTetrahedra(), 0);
  for (const TriangleIds& ids : this->Vanished)
  {
    if (!this->FindSides(ids))
    {
      return false;
    }
  }
  this->IsNoCone = false;
  this->Tetrahedra.clear();
  this->IsInCavity.resize(this->Mesh.GetNumberOfTetrahedra(), 0);
  const auto search = [this](const std::vector<Id>& sides, Id point, const Vec3& position)
  {
    ++this->Search;
    for (Id side : sides)
    {
      this->Visit(side / 4, point, position);
    }
    while (!this->Open.empty())
    {
      const Id t = this->Open.back();
      this->Open.pop_back();
      for (Id neighbor : this->Mesh.GetMesh().Neighbors[t])
      {
        if (neighbor != NoId)
        {
          this->Visit(neighbor / 4, point, position);
        }
      }
    }
  };
  for (const Vec3& position : change.Points)
  {
    search(this->Sides, NoId, position);
  }
  // All triangles at a point that is moved are touched.
  std::vector<std::pair<Id, Id>> around;
  for (const NewTriangle& triangle : change.Triangles)
  {
    const Id t = triangle.Index;
    for (int i = 0; i < 3 && t < static_cast<Id>(this->Surface.Triangles.size()); ++i)
    {
      const Id point = this->Surface.Triangles[t][i];
      if (std::binary_search(this->Moved.begin(), this->Moved.end(), point))
      {
        around.emplace_back(point, t);
      }
    }
  }
  std::sort(around.begin(), around.end());
  const std::size_t numberOfSides = this->Sides.size();
  for (std::size_t k = 0; k < around.size(); ++k)
  {
    const auto [point, t] = around[k];
    if (!this->FindSides(Sorted(this->Surface.Triangles[t])))
    {
      return false;
    }
    if (k + 1 == around.size() || around[k + 1].first != point)
    {
      search(
        { this->Sides.begin() + static_cast<std::ptrdiff_t>(numberOfSides), this->Sides.end() },
        point, this->Surface.Points[point]);
      this->Sides.resize(numberOfSides);
    }
  }
  return true;
}

/** The region in front of a new triangle, whose points are given in either orientation. */
Id BoundarySplits::GetRegionInFront(const TriangleIds& ids) const
{
  const auto made = std::lower_bound(this->Made.begin(), this->Made.end(), Sorted(ids));
  const NewTriangle& triangle = this->Triangles[this->MadeFrom[made - this->Made.begin()]];
  // Orientations are equal if each point is followed by the same one.
  const TriangleIds& others = triangle.Ids;
  const auto first = std::find(others.begin(), others.end(), ids[0]) - others.begin();
  return others[(first + 1) % 3] == ids[1] ? triangle.Labels.Front : triangle.Labels.Back;
}

/** Collects the facets around the tetrahedra that are replaced, and the walls within. */
void BoundarySplits::CollectCavity()
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  Cavity& cavity = this->Around;
  cavity.Clear();
  cavity.Walls = this->Made;
  this->Outer.clear();
  this->WallRegions.clear();
  this->FoundRegions.clear();
  this->Bared.clear();
  for (Id t : this->Tetrahedra)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    for (int i = 0; i < 4; ++i)
    {
      const TriangleIds facet = GetFacet(ids, i);
      const TriangleIds key = Sorted(facet);
      const Id neighbor = mesh.Neighbors[t][i];
      const bool isInside = neighbor != NoId && this->IsInCavity[neighbor / 4] != 0;
      const bool isOnSurface = key[2] < this->FirstInside;
      const bool isVanished = isOnSurface && IsInSorted(this->Vanished, key);
      if (isInside && !isVanished && mesh.Regions[neighbor / 4] != mesh.Regions[t])
      {
        this->IsNoCone = true;
        this->WallRegions.emplace_back(key, mesh.Regions[t]);
        if (neighbor / 4 > t)
        {
          cavity.Walls.push_back(facet);
        }
      }
      else if (!isInside && !isVanished)
      {
        const TriangleIds border{ facet[0], facet[2], facet[1] };
        const bool isMade = isOnSurface && IsInSorted(this->Made, key);
        const Id region = isMade ? this->GetRegionInFront(border) : mesh.Regions[t];
        if (region < 0)
        {
          // The surface is now on the other side of a flat tetrahedron, which is gone.
          this->Bared.push_back(neighbor);
        }
        else
        {
          cavity.Border.push_back(border);
          cavity.Regions.push_back(region);
          this->Outer.push_back(neighbor);
        }
        if (neighbor != NoId && isMade)
        {
          this->FoundRegions.emplace_back(key, mesh.Regions[neighbor / 4]);
        }
      }
    }
  }
  // A new point that rounding has put beside the plane leaves a tetrahedron there as it is: a flat
  // one comes between it and the surface.
  for (Id side : this->Sides)
  {
    if (this->IsInCavity[side / 4] == 0)
    {
      const TriangleIds facet = GetFacet(mesh.Tetrahedra[side / 4], side % 4);
      this->IsNoCone = true;
      cavity.Border.push_back(facet);
      cavity.Regions.push_back(mesh.Regions[side / 4]);
      this->Outer.push_back(side);
    }
  }
  for (Id t : this->Tetrahedra)
  {
    this->IsInCavity[t] = 0;
  }
  for (std::size_t k = 0; k < this->Made.size(); ++k)
  {
    const RegionPair& labels = this->Triangles[this->MadeFrom[k]].Labels;
    for (Id region : { labels.Back, labels.Front })
    {
      if (region >= 0)
      {
        this->WallRegions.emplace_back(this->Made[k], region);
      }
    }
  }
  std::sort(this->WallRegions.begin(), this->WallRegions.end());
}

const Vec3& BoundarySplits::GetPosition(Id point, const std::vector<Vec3>& points) const
{
  const Id first = static_cast<Id>(this->Surface.Points.size());
  return point < first          ? this->Surface.Points[point]
    : point < this->FirstInside ? points[point - first]
                                : this->Mesh.GetPoint(point);
}

/** Collects the points of the cavity and of its border. */
void BoundarySplits::CollectPoints(const std::vector<Vec3>& points)
{
  Cavity& cavity = this->Around;
  for (Id t : this->Tetrahedra)
  {
    const TetrahedronIds& ids = this->Mesh.GetMesh().Tetrahedra[t];
    cavity.Numbers.insert(cavity.Numbers.end(), ids.begin(), ids.end());
  }
  for (const TriangleIds& facet : cavity.Border)
  {
    cavity.Numbers.insert(cavity.Numbers.end(), facet.begin(), facet.end());
  }
  const Id first = static_cast<Id>(this->Surface.Points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    cavity.Numbers.push_back(first + static_cast<Id>(i));
  }
  SortUnique(cavity.Numbers);
  cavity.Points.reserve(cavity.Numbers.size());
  for (Id id : cavity.Numbers)
  {
    cavity.Points.push_back(this->GetPosition(id, points));
  }
}

/** Fills the cavity of a single point, if no other one lies on a sphere there. */
bool BoundarySplits::FillByCone(const std::vector<Vec3>& points)
{
  const Id apex = static_cast<Id>(this->Surface.Points.size());
  return points.size() == 1 && this->Moved.empty() && !this->IsNoCone &&
    std::all_of(this->Made.begin(), this->Made.end(),
      [apex](const TriangleIds& ids) { return Contains(ids, apex); }) &&
    this->Cone.Run(this->Around, apex, this->WallRegions,
      [&](Id point) -> const Vec3& { return this->GetPosition(point, points); });
}

/** Whether all regions at walls have cells there: a region may lie between walls alone. */
bool BoundarySplits::AreWallsComplete()
{
  for (const CavityCell& cell : this->Filling.GetCells())
  {
    for (int i = 0; i < 4; ++i)
    {
      const TriangleIds key = Sorted(GetFacet(cell.Ids, i));
      const auto wall = std::lower_bound(
        this->WallRegions.begin(), this->WallRegions.end(), std::pair<TriangleIds, Id>(key, NoId));
      if (wall != this->WallRegions.end() && wall->first == key)
      {
        this->FoundRegions.emplace_back(key, cell.Region);
      }
    }
  }
  std::sort(this->FoundRegions.begin(), this->FoundRegions.end());
  return this->FoundRegions == this->WallRegions;
}

void BoundarySplits::Adopt(const SurfaceChange& change, const std::vector<CavityCell>& cells)
{
  for (const Vec3& position : change.Points)
  {
    this->Mesh.SetPoint(static_cast<Id>(this->Surface.Points.size()), position);
    this->Surface.Points.push_back(position);
  }
  for (Id point : this->Moved)
  {
    this->Mesh.SetPoint(point, this->Surface.Points[point]);
  }
  for (Id facet : this->Bared)
  {
    this->Mesh.MakeOuter(facet);
  }
  this->Mesh.Replace(this->Tetrahedra, this->Outer, cells);
  const std::vector<Id>& changed = this->Mesh.GetChanged();
  this->Changed.insert(this->Changed.end(), changed.begin(), changed.end());

  this->Surface.Triangles.resize(change.NumberOfTriangles);
  this->Surface.Labels.resize(change.NumberOfTriangles);
  this->Surface.SourceCells.resize(change.NumberOfTriangles);
  for (const NewTriangle& triangle : this->Triangles)
  {
    this->Surface.Triangles[triangle.Index] = triangle.Ids;
    this->Surface.Labels[triangle.Index] = triangle.Labels;
    this->Surface.SourceCells[triangle.Index] = triangle.Source;
  }
}

/** Segments that are new or have got another end, by their edges now; ascending. */
std::vector<std::pair<EdgeIds, Id>> BoundarySplits::FindChangedSegments()
{
  const RefinableSurface& refined = this->Refinement.GetSurface();
  std::vector<Id> touched;
  for (Id t : this->ChangedTriangles)
  {
    for (int i = 0; i < 3; ++i)
    {
      const Id segment = refined.GetSegmentAt(t, i);
      if (segment != NoId)
      {
        touched.push_back(segment);
      }
    }
  }
  SortUnique(touched);
  std::vector<std::pair<EdgeIds, Id>> changed;
  this->SegmentEdges.resize(refined.GetNumberOfSegments(), { NoId, NoId });
  for (Id s : touched)
  {
    const EdgeIds& ends = refined.GetSegment(s).Points;
    const EdgeIds edge = MakeEdge(this->SurfacePoints[ends[0]], this->SurfacePoints[ends[1]]);
    if (this->SegmentEdges[s] != edge)
    {
      this->SegmentEdges[s] = edge;
      changed.emplace_back(edge, s);
    }
  }
  std::sort(changed.begin(), changed.end());
  return changed;
}

/** Brings the pieces of segments that were split into the sorted list of structural edges. */
void BoundarySplits::UpdateEdges()
{
  this->ChangedEdges.clear();
  const std::vector<std::pair<EdgeIds, Id>> changed = this->FindChangedSegments();
  if (changed.empty())
  {
    return;
  }
  this->IsChangedSegment.resize(this->SegmentEdges.size(), 0);
  for (const auto& [edge, segment] : changed)
  {
    this->IsChangedSegment[segment] = 1;
  }
  // The lists change places, and keep their memory.
  std::swap(this->Edges, this->FormerEdges);
  std::swap(this->Segments, this->FormerSegments);
  this->Edges.clear();
  this->Segments.clear();
  auto next = changed.begin();
  const auto addChangedBefore = [&](const EdgeIds* end)
  {
    for (; next != changed.end() && (end == nullptr || next->first < *end); ++next)
    {
      const RefinableSurface::Segment& segment =
        this->Refinement.GetSurface().GetSegment(next->second);
      this->ChangedEdges.push_back(static_cast<Id>(this->Edges.size()));
      this->Edges.push_back({ next->first, segment.Kind, segment.Chain, segment.DihedralAngle });
      this->Segments.push_back(next->second);
    }
  };
  for (std::size_t e = 0; e < this->FormerEdges.size(); ++e)
  {
    const Id segment = this->FormerSegments[e];
    if (this->IsChangedSegment[segment] == 0)
    {
      addChangedBefore(&this->FormerEdges[e].Points);
      this->Edges.push_back(this->FormerEdges[e]);
      this->Segments.push_back(segment);
    }
  }
  addChangedBefore(nullptr);
  for (const auto& [edge, segment] : changed)
  {
    this->IsChangedSegment[segment] = 0;
  }
}
} // namespace cdm
