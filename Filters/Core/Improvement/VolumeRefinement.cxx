// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/VolumeRefinement.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/NegativeCouplings.h"
#include "Core/Improvement/SurfacePointMoves.h"
#include "Core/Search/PlaceSearch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t ReportInterval = 256;

/** Points are moved where angles are below this multiple of the target: it leaves some room. */
constexpr double MoveRatio = 1.1;
/** Free points closer to others than this part of the sizing are removed. */
constexpr double CloseRatio = 0.3;
/** Degrees: tetrahedra of boundary points with a smaller angle are flat but for rounding. */
constexpr double FlatAngle = 1e-6;
/** First step of the search for a new point's place, in radii of the sphere that it destroys. */
constexpr double FirstInsertion = 0.3;
/**
 * What is left of a point's size between it and a new one. With a tenth more slivers are left, with
 * less, more at needles in the surface.
 */
constexpr double SizeRatio = 0.05;
/** Passes over the slivers that are left. */
constexpr int MaximumPasses = 20;

/** Places for more points after the first ones, which no tetrahedron has. */
TetMesh ReservePoints(TetMesh mesh, std::size_t first, Id reserve)
{
  if (reserve > 0)
  {
    mesh.Points.insert(mesh.Points.begin() + static_cast<std::ptrdiff_t>(first), reserve, Vec3());
    for (TetrahedronIds& ids : mesh.Tetrahedra)
    {
      for (Id& id : ids)
      {
        id += id >= static_cast<Id>(first) ? reserve : 0;
      }
    }
  }
  return mesh;
}
/** One triangle of each source cell. */
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

VolumeRefinement::VolumeRefinement(TetMesh mesh, TriangleMesh& surface,
  std::vector<StructuralEdge>& edges, const std::vector<StructuralEdge>& keptEdges,
  const std::vector<double>& surfaceSizes, const std::vector<InteriorPoint>& interior,
  SliverMemory& memory, const VolumeRefinementOptions& options)
  : Mesh(ReservePoints(std::move(mesh), surface.Points.size(), options.Reserve)), Surface(surface),
    Edges(edges), KeptEdges(keptEdges), Limits(options.Limits),
    FirstInside(static_cast<Id>(surface.Points.size()) + options.Reserve),
    MaximumNewPoints(options.MaximumNewPoints), Memory(memory),
    Shape(std::make_unique<BoundaryShape>(surface, edges, keptEdges, options.SharpPlaneAngle)),
    Requests(surface, keptEdges,
      [this](Id point, double distance)
      { return distance >= SizeRatio * this->Points[point].Size; }),
    Facts(this->Mesh, this->Limits)
{
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    this->Points.push_back({ surface.Points[p], surfaceSizes.empty() ? 0.0 : surfaceSizes[p], false,
      NoId, static_cast<Id>(p) });
  }
  this->Points.resize(this->FirstInside);
  this->Points.insert(this->Points.end(), interior.begin(), interior.end());
  std::vector<Id> all(this->Mesh.GetNumberOfTetrahedra());
  std::iota(all.begin(), all.end(), 0);
  this->BoundSizes(all);
}

/** No size is larger than another one and the way there, along edges, beginning with some. */
void VolumeRefinement::BoundSizes(const std::vector<Id>& tetrahedra)
{
  std::vector<Id> changed;
  const auto bound = [&](Id t)
  {
    const TetrahedronIds& ids = this->GetMesh().Tetrahedra[t];
    for (const auto& edge : TetrahedronEdges)
    {
      InteriorPoint* first = &this->Points[ids[edge[0]]];
      InteriorPoint* second = &this->Points[ids[edge[1]]];
      Id larger = ids[edge[1]];
      if (first->Size > second->Size)
      {
        std::swap(first, second);
        larger = ids[edge[0]];
      }
      const double size = first->Size + Distance(first->Position, second->Position);
      if (second->Size > size)
      {
        second->Size = size;
        changed.push_back(larger);
      }
    }
  };
  std::for_each(tetrahedra.begin(), tetrahedra.end(), bound);
  std::vector<Id> star;
  while (!changed.empty())
  {
    const Id point = changed.back();
    changed.pop_back();
    this->Mesh.FindStar(point, star);
    std::for_each(star.begin(), star.end(), bound);
  }
}

std::vector<InteriorPoint> VolumeRefinement::GetInterior() const
{
  std::vector<InteriorPoint> interior;
  for (Id p = this->FirstInside; p < this->Mesh.GetNumberOfPoints(); ++p)
  {
    if (this->Mesh.GetTetrahedronAt(p) != NoId)
    {
      interior.push_back(this->Points[p]);
    }
  }
  return interior;
}

TetMesh VolumeRefinement::MakeMesh() const
{
  TetMesh mesh = this->GetMesh();
  RemoveDeadTetrahedra(mesh);
  std::vector<Id> newIds(mesh.Points.size(), NoId);
  Id count = 0;
  for (Id p = 0; p < static_cast<Id>(newIds.size()); ++p)
  {
    const bool isOnSurface = p < static_cast<Id>(this->Surface.Points.size());
    if (isOnSurface || (p >= this->FirstInside && this->Mesh.GetTetrahedronAt(p) != NoId))
    {
      mesh.Points[count] = mesh.Points[p];
      newIds[p] = count++;
    }
  }
  mesh.Points.resize(count);
  for (TetrahedronIds& ids : mesh.Tetrahedra)
  {
    ids = { newIds[ids[0]], newIds[ids[1]], newIds[ids[2]], newIds[ids[3]] };
  }
  return mesh;
}

std::vector<Id> VolumeRefinement::FindFlatTetrahedra() const
{
  std::vector<Id> flat;
  for (Id t = 0; t < this->Mesh.GetNumberOfTetrahedra(); ++t)
  {
    if (!this->Mesh.IsDead(t) && this->IsFlat(t))
    {
      flat.push_back(t);
    }
  }
  return flat;
}

bool VolumeRefinement::IsFree(Id point) const
{
  return point >= this->FirstInside && this->Points[point].IsFree &&
    this->Mesh.GetTetrahedronAt(point) != NoId;
}

std::array<Vec3, 4> VolumeRefinement::GetVertices(const TetrahedronIds& ids) const
{
  return { this->Mesh.GetPoint(ids[0]), this->Mesh.GetPoint(ids[1]), this->Mesh.GetPoint(ids[2]),
    this->Mesh.GetPoint(ids[3]) };
}

/**
 * By rounding: its four points, which are all on the surface, would have no tetrahedron otherwise.
 */
bool VolumeRefinement::IsFlat(Id tetrahedron) const
{
  const TetrahedronIds& ids = this->GetMesh().Tetrahedra[tetrahedron];
  return *std::max_element(ids.begin(), ids.end()) < this->FirstInside &&
    this->GetAngle(tetrahedron) < FlatAngle;
}

/** Angles over the target always count. */
void VolumeRefinement::Include(const Aim& aim, Id tetrahedron, SmallestAngles& smallest) const
{
  const double angle = this->GetAngle(tetrahedron);
  const bool isAimed = angle >= aim.Target || this->IsAcrossSharp(tetrahedron) == aim.IsSharp;
  double& one = isAimed ? smallest.Aimed : smallest.Other;
  one = std::min(one, angle);
}

/** What tetrahedra that a change is not for have to keep. */
double VolumeRefinement::GetFloor(const Aim& aim, const SmallestAngles& before)
{
  return aim.IsSharp ? std::min(before.Other, aim.Target) : std::min(before.Aimed, before.Other);
}

/**
 * Smallest angle that the hole's cone would have among those aimed at; 0 if another one falls below
 * the floor, or as soon as it is not larger than required.
 */
double VolumeRefinement::RateHole(
  const Vec3& position, const Aim& aim, double floor, double required) const
{
  constexpr Id inside = std::numeric_limits<Id>::max();
  double smallest = 180.0;
  for (const TriangleIds& facet : this->Hole.Facets)
  {
    const double angle = GetSmallestDihedralAngle(this->Mesh.GetPoint(facet[0]),
      this->Mesh.GetPoint(facet[1]), this->Mesh.GetPoint(facet[2]), position);
    const bool isAimed = angle >= aim.Target ||
      this->Shape->Sharp.IsAcross({ facet[0], facet[1], facet[2], inside }) == aim.IsSharp;
    if (isAimed ? angle <= required : angle < floor)
    {
      return 0.0;
    }
    smallest = isAimed ? std::min(smallest, angle) : smallest;
  }
  return smallest;
}

/** Of what is refined for; ids of points inside do not matter. */
bool VolumeRefinement::BreaksLimit(
  const TetrahedronIds& ids, const std::array<Vec3, 4>& vertices) const
{
  Vec3 target;
  double severity = 0.0;
  const TetrahedronFault fault = this->Limits.Find(vertices, true, target, severity);
  return fault == TetrahedronFault::Size ||
    (fault == TetrahedronFault::Shape && !this->Shape->Sharp.IsAcross(ids));
}

bool VolumeRefinement::BreaksLimit(Id tetrahedron) const
{
  double severity = 0.0;
  const TetrahedronFault fault = this->Facts.GetFault(tetrahedron, severity);
  return fault == TetrahedronFault::Size ||
    (fault == TetrahedronFault::Shape && !this->IsAcrossSharp(tetrahedron));
}

/** How many tetrahedra of the hole's cone would break a limit. */
Id VolumeRefinement::CountBroken(const Vec3& position) const
{
  constexpr Id inside = std::numeric_limits<Id>::max();
  return static_cast<Id>(std::count_if(this->Hole.Facets.begin(), this->Hole.Facets.end(),
    [&](const TriangleIds& facet)
    {
      return this->BreaksLimit({ facet[0], facet[1], facet[2], inside },
        { this->Mesh.GetPoint(facet[0]), this->Mesh.GetPoint(facet[1]),
          this->Mesh.GetPoint(facet[2]), position });
    }));
}

/** Whether the point keeps the distances that the sizes of its neighbors ask for. */
bool VolumeRefinement::IsClear(const Vec3& position) const
{
  for (const TriangleIds& facet : this->Hole.Facets)
  {
    for (Id id : facet)
    {
      if (Distance(position, this->Mesh.GetPoint(id)) < SizeRatio * this->Points[id].Size)
      {
        return false;
      }
    }
  }
  return true;
}

bool VolumeRefinement::DisturbsBoundary(const Vec3& position)
{
  // What would be disturbed is part of the hole.
  const bool isNear = std::any_of(this->Hole.Facets.begin(), this->Hole.Facets.end(),
    [&](const TriangleIds& facet)
    { return *std::min_element(facet.begin(), facet.end()) < this->FirstInside; });
  if (!isNear)
  {
    return false;
  }
  this->Shape->Spheres.Find(position, this->Disturbed);
  return !this->Disturbed.IsEmpty() || this->TouchesOpenFacet();
}

/**
 * Whether the hole ends at an outer facet that is no triangle of the surface: its smallest sphere
 * is not known to be empty, so a point on this side may be in conflict with what lies beyond, which
 * the mesh does not have.
 */
bool VolumeRefinement::TouchesOpenFacet() const
{
  for (std::size_t i = 0; i < this->Hole.Facets.size(); ++i)
  {
    if (this->Hole.Outer[i] != NoId)
    {
      continue;
    }
    if (!IsTriangle(this->Surface.Triangles, this->Shape->PointTriangles, this->Hole.Facets[i]))
    {
      return true;
    }
  }
  return false;
}

/** Sorted. */
TetrahedronIds VolumeRefinement::GetNames(const TetrahedronIds& ids) const
{
  TetrahedronIds names{ this->Points[ids[0]].Name, this->Points[ids[1]].Name,
    this->Points[ids[2]].Name, this->Points[ids[3]].Name };
  std::sort(names.begin(), names.end());
  return names;
}

/** To what the last change of the mesh has made. */
void VolumeRefinement::NoteChanges()
{
  for (Id t : this->Mesh.GetChanged())
  {
    this->Memory.SetChanged(this->GetNames(this->GetMesh().Tetrahedra[t]));
  }
}

void VolumeRefinement::NoteNewPoints(const std::vector<char>& isNew)
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

/** Into the hole. */
void VolumeRefinement::AddPoint(const Vec3& position)
{
  double size = Infinity;
  for (const TriangleIds& facet : this->Hole.Facets)
  {
    for (Id id : facet)
    {
      size = std::min(size, this->Points[id].Size + Distance(position, this->Mesh.GetPoint(id)));
    }
  }
  this->Mesh.Insert(position, this->Hole);
  this->Points.push_back({ position, size, true, NoId, this->Memory.MakeName() });
  this->NoteChanges();
  ++this->Report.InsertedPoints;
}

void VolumeRefinement::SetSizes(const std::vector<double>& sizes)
{
  for (std::size_t p = 0; p < sizes.size(); ++p)
  {
    this->Points[p].Size = sizes[p];
  }
}

void VolumeRefinement::RemoveClosePoints(double smallest, const SizingField& sizing)
{
  std::vector<Id> star;
  for (Id p = this->FirstInside; p < this->Mesh.GetNumberOfPoints(); ++p)
  {
    if (!this->IsFree(p) || !this->Mesh.FindStar(p, star))
    {
      continue;
    }
    const Vec3& position = this->Mesh.GetPoint(p);
    const double limit =
      std::max(smallest, sizing ? CloseRatio * sizing(position).GetSmallest() : 0.0);
    const bool isClose = std::any_of(star.begin(), star.end(),
      [&](Id t)
      {
        const TetrahedronIds& ids = this->GetMesh().Tetrahedra[t];
        return std::any_of(ids.begin(), ids.end(),
          [&](Id id) { return id != p && Distance(position, this->Mesh.GetPoint(id)) < limit; });
      });
    if (isClose && this->Mesh.Remove(p))
    {
      ++this->Report.RemovedPoints;
    }
  }
}

Status VolumeRefinement::RefineByLimits(bool isShapeTested, const ExecutionContext& context)
{
  std::priority_queue<Task> tasks;
  const auto schedule = [&](Id t)
  {
    double severity = 0.0;
    const TetrahedronFault fault = this->Facts.GetFault(t, severity);
    if (fault == TetrahedronFault::Size ||
      (fault == TetrahedronFault::Shape && isShapeTested && !this->IsAcrossSharp(t) &&
        !this->IsInLayer(t) && !this->IsFlat(t)))
    {
      tasks.push({ fault, severity, t, this->Mesh.GetStamp(t) });
    }
  };
  for (Id t = 0; t < this->Mesh.GetNumberOfTetrahedra(); ++t)
  {
    if (!this->Mesh.IsDead(t))
    {
      schedule(t);
    }
  }
  for (std::size_t done = 0; !tasks.empty() && !this->IsFull(); ++done)
  {
    if (done % ReportInterval == 0 &&
      !context.Continue(static_cast<double>(done) / static_cast<double>(done + tasks.size()),
        "Refining tetrahedra"))
    {
      return Status::Aborted();
    }
    const Task task = tasks.top();
    tasks.pop();
    if (task.Stamp != this->Mesh.GetStamp(task.Tetrahedron))
    {
      continue;
    }
    Vec3 target;
    double severity = 0.0;
    this->Limits.Find(this->GetVertices(this->GetMesh().Tetrahedra[task.Tetrahedron]),
      isShapeTested, target, severity);
    if (!IsFinite(target))
    {
      continue;
    }
    const bool isSizeKept = task.Fault == TetrahedronFault::Shape;
    this->Shape->Spheres.Find(target, this->Disturbed);
    if (!this->Disturbed.IsEmpty())
    {
      this->Requests.AddDisturbed(target, this->Disturbed, isSizeKept);
    }
    else if (this->Mesh.FindHole(
               target, this->Mesh.GetNumberOfPoints(), task.Tetrahedron, this->Hole) &&
      (!isSizeKept || this->IsClear(target)))
    {
      this->AddPoint(target);
      for (Id t : this->Mesh.GetChanged())
      {
        schedule(t);
      }
    }
  }
  return Status();
}

bool VolumeRefinement::SplitBoundary(const DelaunaySurfaceRefinerOptions& options,
  const SizingField& sizing, const ExecutionContext& context, Status& status)
{
  if (!this->Splits)
  {
    this->Splits = std::make_unique<BoundarySplits>(
      this->Mesh, this->FirstInside, this->Surface, this->Edges, options, sizing);
  }
  const Id first = static_cast<Id>(this->Surface.Points.size());
  const std::vector<Id> sourceTriangles = ListSourceTriangles(this->Surface);
  status = this->Splits->Run(this->Requests.Triangles, this->Requests.Edges, context);
  const Id end = static_cast<Id>(this->Surface.Points.size());
  for (Id p = first; p < end; ++p)
  {
    this->Points[p] = { this->Surface.Points[p], 0.0, false, NoId, p };
  }
  this->MaximumNewPoints -= end - first;
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
  std::vector<Id> parents;
  for (Id source : this->Surface.SourceCells)
  {
    parents.push_back(sourceTriangles[source]);
  }
  this->Shape = std::make_unique<BoundaryShape>(
    std::move(*this->Shape), this->Surface, this->Edges, this->KeptEdges, parents);
  if (this->AreFactsPreliminary)
  {
    this->Facts.Forget();
    this->AreFactsPreliminary = false;
  }
  this->Requests.Clear();
  return true;
}

void VolumeRefinement::SetSurfaceSizes(Id first, const std::vector<double>& sizes)
{
  for (std::size_t p = first; p < sizes.size(); ++p)
  {
    this->Points[p].Size = sizes[p];
  }
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

bool VolumeRefinement::Move(Id point, const Aim& aim)
{
  std::vector<Id> star;
  if (!this->Mesh.FindStar(point, star))
  {
    return false;
  }
  const Vec3 old = this->Mesh.GetPoint(point);
  Id broken = 0;
  SmallestAngles before;
  double nearest = Infinity;
  Vec3 sum;
  double count = 0.0;
  for (Id t : star)
  {
    const TetrahedronIds& ids = this->GetMesh().Tetrahedra[t];
    broken += this->BreaksLimit(t);
    this->Include(aim, t, before);
    for (Id id : ids)
    {
      if (id != point)
      {
        nearest = std::min(nearest, Distance(old, this->Mesh.GetPoint(id)));
        sum = sum + this->Mesh.GetPoint(id);
        count += 1.0;
      }
    }
  }
  if (!this->Mesh.Remove(point))
  {
    return false;
  }
  const std::vector<Id> filled = this->Mesh.GetChanged();
  const double floor = GetFloor(aim, before);
  // Of those aimed at; the others are either fine or bad.
  std::vector<double> angles;
  std::vector<char> isBroken;
  for (Id t : filled)
  {
    SmallestAngles after;
    this->Include(aim, t, after);
    angles.push_back(after.Other < floor ? 0.0 : after.Aimed);
    isBroken.push_back(this->BreaksLimit(t));
  }
  const auto rate = [&](const Vec3& position, double required)
  {
    const Id first = this->Mesh.Locate(position, filled.front());
    if (first == NoId || !this->Mesh.FindHole(position, point, first, this->Hole))
    {
      return 0.0;
    }
    // What stays of the tetrahedra that fill the place of the point counts as well.
    Id brokenThere = 0;
    for (std::size_t i = 0; i < filled.size(); ++i)
    {
      if ((angles[i] <= required || isBroken[i]) &&
        std::find(this->Hole.Tetrahedra.begin(), this->Hole.Tetrahedra.end(), filled[i]) ==
          this->Hole.Tetrahedra.end())
      {
        if (angles[i] <= required)
        {
          return 0.0;
        }
        ++brokenThere;
      }
    }
    const double angle = this->RateHole(position, aim, floor, required);
    return angle > required && this->IsClear(position) &&
        (broken > 0 || brokenThere + this->CountBroken(position) == 0) &&
        !this->DisturbsBoundary(position)
      ? angle
      : 0.0;
  };
  Place best{ old, before.Aimed + SmallestGain, false };
  SearchMove(old, (1.0 / count) * sum, nearest, aim.Target, rate, best);

  if (this->Means != SliverMeans::Moves &&
    std::count(isBroken.begin(), isBroken.end(), 1) <= broken &&
    *std::min_element(angles.begin(), angles.end()) > best.Angle)
  {
    ++this->Report.RemovedPoints;
    this->NoteChanges();
    return true;
  }
  if (!best.IsFound)
  {
    this->Mesh.UndoRemove();
    return false;
  }
  const Id first = this->Mesh.Locate(best.Position, filled.front());
  this->Mesh.FindHole(best.Position, point, first, this->Hole);
  this->Mesh.Restore(point, best.Position, this->Hole);
  this->Points[point].Position = best.Position;
  this->Points[point].Source = NoId;
  ++this->Report.MovedPoints;
  this->NoteChanges();
  return true;
}

bool VolumeRefinement::InsertBest(Id tetrahedron, const Aim& aim)
{
  const std::array<Vec3, 4> vertices = this->GetVertices(this->GetMesh().Tetrahedra[tetrahedron]);
  const Vec3 center = GetCircumcenter(vertices[0], vertices[1], vertices[2], vertices[3]);
  if (!IsFinite(center) || this->IsFull())
  {
    return false;
  }
  const Id number = this->Mesh.GetNumberOfPoints();
  const auto rate = [&](const Vec3& position, double required)
  {
    if (!this->Mesh.FindHole(position, number, tetrahedron, this->Hole))
    {
      return 0.0;
    }
    SmallestAngles before;
    for (Id t : this->Hole.Tetrahedra)
    {
      this->Include(aim, t, before);
    }
    const double angle = this->RateHole(position, aim, GetFloor(aim, before), required);
    return angle > required && this->IsClear(position) && this->CountBroken(position) == 0 &&
        !this->DisturbsBoundary(position)
      ? angle
      : 0.0;
  };
  Place best{ center, this->GetAngle(tetrahedron) + SmallestGain, false };
  TryPlace(center, rate, best);
  SearchPlace(center, FirstInsertion * Distance(center, vertices[0]), MakeCubeDirections(),
    aim.Target, rate, best);
  if (!best.IsFound || !this->Mesh.FindHole(best.Position, number, tetrahedron, this->Hole))
  {
    return false;
  }
  this->AddPoint(best.Position);
  return true;
}

/** False if nothing helps, or is known not to; then nothing has changed. */
bool VolumeRefinement::Mend(const Sliver& sliver, const Aim& aim, SliverAttempt last)
{
  const TetrahedronIds ids = this->GetMesh().Tetrahedra[sliver.Tetrahedron];
  const TetrahedronIds names = this->GetNames(ids);
  if (this->Memory.IsHopeless(names, last))
  {
    return false;
  }
  if (std::any_of(
        ids.begin(), ids.end(), [&](Id id) { return this->IsFree(id) && this->Move(id, aim); }) ||
    (last == SliverAttempt::Insertion && this->InsertBest(sliver.Tetrahedron, aim)))
  {
    return true;
  }
  this->Memory.SetHopeless(names, last);
  return false;
}

/** Those that an aim is for, worst first; without those across thin layers. */
/** Whether a change is to be for it. */
bool VolumeRefinement::IsSliver(const Aim& aim, Id tetrahedron) const
{
  return !this->Mesh.IsDead(tetrahedron) && this->GetAngle(tetrahedron) < aim.Target &&
    this->IsAcrossSharp(tetrahedron) == aim.IsSharp && !this->IsInLayer(tetrahedron);
}

std::vector<VolumeRefinement::Sliver> VolumeRefinement::FindSlivers(const Aim& aim) const
{
  std::vector<Sliver> slivers;
  for (Id t = 0; t < this->Mesh.GetNumberOfTetrahedra(); ++t)
  {
    if (this->IsSliver(aim, t))
    {
      slivers.push_back({ this->GetAngle(t), t, this->Mesh.GetStamp(t) });
    }
  }
  std::sort(slivers.begin(), slivers.end(),
    [](const Sliver& a, const Sliver& b)
    { return a.Angle != b.Angle ? a.Angle < b.Angle : a.Tetrahedron < b.Tetrahedron; });
  return slivers;
}

std::size_t VolumeRefinement::CountSlivers(double target) const
{
  std::size_t count = 0;
  for (Id t = 0; t < this->Mesh.GetNumberOfTetrahedra(); ++t)
  {
    count += this->IsSliver({ target, false }, t);
  }
  return count;
}

std::vector<Vec3> VolumeRefinement::MoveSurfacePoints(
  double target, const std::vector<char>& isFree, bool areEdgesKept)
{
  SurfacePointMoves::Rules rules;
  rules.HasAngle = [this](const TetrahedronIds& ids, Id region)
  { return !this->Shape->Layers.IsAcross(ids, region) && !this->Shape->Sharp.IsAcross(ids); };
  rules.BreaksLimit = [this](const TetrahedronIds& ids, const std::array<Vec3, 4>& vertices)
  { return this->BreaksLimit(ids, vertices); };
  rules.GetClearance = [this](Id point) { return SizeRatio * this->Points[point].Size; };
  const std::vector<StructuralEdge> none;
  SurfacePointMoves moves(this->Mesh, this->Surface, this->Shape->PointTriangles, this->Edges,
    areEdgesKept ? this->KeptEdges : none, rules);

  bool isMended = true;
  for (int pass = 0; pass < MaximumPasses && isMended; ++pass)
  {
    isMended = false;
    for (const Sliver& sliver : this->FindSlivers({ target, false }))
    {
      if (this->Mesh.GetStamp(sliver.Tetrahedron) != sliver.Stamp)
      {
        continue;
      }
      const TetrahedronIds ids = this->GetMesh().Tetrahedra[sliver.Tetrahedron];
      const TetrahedronIds names = this->GetNames(ids);
      if (this->Memory.IsHopeless(names, SliverAttempt::SurfaceMove))
      {
        continue;
      }
      const bool isMoved = std::any_of(ids.begin(), ids.end(),
        [&](Id id) {
          return id < this->FirstInside && isFree[id] != 0 &&
            moves.Move(id, ids, MoveRatio * target);
        });
      if (isMoved)
      {
        this->NoteChanges();
        this->AreFactsPreliminary = true;
        isMended = true;
      }
      else
      {
        this->Memory.SetHopeless(names, SliverAttempt::SurfaceMove);
      }
    }
  }
  return moves.GetPoints();
}

Status VolumeRefinement::PerturbSlivers(
  double target, SliverMeans means, const ExecutionContext& context)
{
  this->Means = means;
  const Aim aim{ MoveRatio * target, false };
  // First moves, then new points as well; when neither helps any more, requests.
  bool mayInsert = false;
  bool isLast = false;
  std::vector<TetrahedronIds> unmet;
  for (int pass = 0; pass < MaximumPasses; ++pass)
  {
    const std::vector<Sliver> slivers = this->FindSlivers(aim);
    bool isMended = false;
    for (std::size_t i = 0; i < slivers.size(); ++i)
    {
      if (i % (ReportInterval / 16) == 0 &&
        !context.Continue((pass + static_cast<double>(i) / slivers.size()) / MaximumPasses,
          "Moving points of slivers"))
      {
        return Status::Aborted();
      }
      const Sliver& sliver = slivers[i];
      if (this->Mesh.GetStamp(sliver.Tetrahedron) != sliver.Stamp)
      {
        continue;
      }
      const TetrahedronIds ids = this->GetMesh().Tetrahedra[sliver.Tetrahedron];
      const bool isBad = sliver.Angle < target;
      if (this->Mend(
            sliver, aim, isBad && mayInsert ? SliverAttempt::Insertion : SliverAttempt::Move))
      {
        isMended = isMended || isBad;
        continue;
      }
      if (isBad && isLast && means == SliverMeans::Requests)
      {
        unmet.push_back(ids);
        const std::array<Vec3, 4> v = this->GetVertices(ids);
        const Vec3 center = GetCircumcenter(v[0], v[1], v[2], v[3]);
        if (!this->Requests.AddEdgeOfTwoTriangles(ids, this->Shape->PointTriangles) &&
          IsFinite(center))
        {
          this->Shape->Spheres.Find(center, this->Disturbed);
          this->Requests.AddDisturbed(center, this->Disturbed, true);
        }
      }
    }
    const bool isMoving = means == SliverMeans::Moves;
    if (isLast || slivers.empty() || (isMoving && !isMended))
    {
      break;
    }
    isLast = mayInsert && !isMended;
    mayInsert = !isMoving;
  }
  // No edge or triangle of the boundary is at fault: another point at one of them gives a
  // sliver beside it another chance; one for those that have a point in common.
  if (this->Requests.GetNumber() == 0)
  {
    std::vector<Id> near;
    for (const TetrahedronIds& ids : unmet)
    {
      if (std::none_of(ids.begin(), ids.end(),
            [&near](Id id) { return std::find(near.begin(), near.end(), id) != near.end(); }))
      {
        this->Requests.AddLargestTriangle(ids, this->Shape->PointTriangles);
        near.insert(near.end(), ids.begin(), ids.end());
      }
    }
  }
  return Status();
}

std::size_t VolumeRefinement::RequestNegativeCouplings()
{
  const std::vector<EdgeIds> edges = FindNegativeCouplings(this->GetMesh(), this->Surface);
  for (const EdgeIds& edge : edges)
  {
    this->Requests.AddEdgeOrTriangle(edge, this->Shape->PointTriangles);
  }
  return edges.size();
}

Status VolumeRefinement::PerturbSharp(double target, const ExecutionContext& context)
{
  this->Means = SliverMeans::Moves;
  const Aim aim{ MoveRatio * target, true };
  const std::vector<Sliver> slivers = this->FindSlivers(aim);
  for (std::size_t i = 0; i < slivers.size(); ++i)
  {
    if (i % ReportInterval == 0 &&
      !context.Continue(static_cast<double>(i) / slivers.size(), "Moving points at sharp angles"))
    {
      return Status::Aborted();
    }
    if (this->Mesh.GetStamp(slivers[i].Tetrahedron) == slivers[i].Stamp)
    {
      this->Mend(slivers[i], aim, SliverAttempt::Move);
    }
  }
  return Status();
}
} // namespace cdm
