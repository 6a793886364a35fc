// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/OptimalDelaunaySmoothing.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <vector>

namespace cdm
{
namespace
{
constexpr Id MovesBetweenChecks = 64;
/** Longest move, in distances to the nearest neighbor. */
constexpr double LongestMove = 0.25;
/** A shorter move, in the same unit, changes nothing that is worth its time. */
constexpr double ShortestMove = 0.005;
/** Places that are tried, in moves to the best one. */
constexpr std::array<double, 3> Parts{ 1.0, 0.5, 0.25 };

/** What counts of the tetrahedra that a move replaces, or makes, beside their excess. */
struct Quality
{
  double SmallestAngle = 180.0;
  Id Slivers = 0;
  Id TooLarge = 0;
  Id BadlyShaped = 0;
};

struct Measures
{
  Quality Shapes;
  double Excess = 0.0;
};

double GetExcess(const std::array<Vec3, 4>& corners)
{
  const auto& [a, b, c, d] = corners;
  return GetUnsignedBoxVolume(a, b, c, d) - GetSignedVolume(a, b, c, d);
}

class Smoothing
{
public:
  Smoothing(double target, RefinedMesh& mesh)
    : Target(target), Mesh(mesh), Tetrahedra(mesh.GetTetrahedra()),
      NextStamps(mesh.GetTetrahedra().GetNumberOfPoints(), 0)
  {
  }

  /** Whether the point has been moved. */
  bool Move(Id point);

private:
  void Add(double angle, TetrahedronFault fault, Quality& quality) const;
  void AddTetrahedron(Id tetrahedron, Quality& quality) const;
  bool IsNoWorse(const Quality& after, const Quality& before) const;
  double GetExcess(Id tetrahedron) const;
  bool IsUnchanged(Id point) const;
  Vec3 GetStep(Id point) const;
  bool FindCavity(Id point, const Vec3& position, Id near);
  bool Fits(const Vec3& position, const std::vector<Id>& filled, Measures before) const;
  bool MakesNegativeCoupling(const std::vector<Id>& tetrahedra) const;
  bool Place(Id point, const Vec3& position, const std::vector<Id>& filled);
  bool MoveBy(Id point, const Vec3& step);

  const double Target;
  RefinedMesh& Mesh;
  DynamicTetrahedralization& Tetrahedra;
  /** When each point was last tried in vain: the next stamp of the mesh then. */
  std::vector<std::int64_t> NextStamps;
  /** The tetrahedra around the point. */
  std::vector<Id> Star;
  /** What FindCavity() has found. */
  PointCavity Found;
  /** Work space. */
  BoundarySpheres::Encroached Encroached;
};

void Smoothing::Add(double angle, TetrahedronFault fault, Quality& quality) const
{
  quality.SmallestAngle = std::min(quality.SmallestAngle, angle);
  quality.Slivers += angle < this->Target;
  quality.TooLarge += fault == TetrahedronFault::Size;
  quality.BadlyShaped += fault == TetrahedronFault::Shape;
}

void Smoothing::AddTetrahedron(Id tetrahedron, Quality& quality) const
{
  this->Add(this->Mesh.GetAngle(tetrahedron), this->Mesh.GetFault(tetrahedron), quality);
}

bool Smoothing::IsNoWorse(const Quality& after, const Quality& before) const
{
  return after.SmallestAngle >= std::min(before.SmallestAngle, this->Target) &&
    after.Slivers <= before.Slivers && after.TooLarge == 0 &&
    after.BadlyShaped <= before.BadlyShaped;
}

double Smoothing::GetExcess(Id tetrahedron) const
{
  return cdm::GetExcess(this->Tetrahedra.GetCorners(tetrahedron));
}

/** Whether the tetrahedra of the star are those of the last try. */
bool Smoothing::IsUnchanged(Id point) const
{
  return std::all_of(this->Star.begin(), this->Star.end(),
    [&](Id t) { return this->Tetrahedra.GetStamp(t) < this->NextStamps[point]; });
}

/** To the mean of the circumcenters of the star; zero if that is too near to matter. */
Vec3 Smoothing::GetStep(Id point) const
{
  const Vec3 old = this->Tetrahedra.GetPoint(point);
  Vec3 sum;
  double volume = 0.0;
  double nearest = Infinity;
  for (Id t : this->Star)
  {
    const auto [a, b, c, d] = this->Tetrahedra.GetCorners(t);
    const double weight = GetSignedVolume(a, b, c, d);
    sum = sum + weight * (GetCircumcenter(a, b, c, d) - old);
    volume += weight;
    for (Id id : this->Mesh.GetMesh().Tetrahedra[t])
    {
      nearest =
        id == point ? nearest : std::min(nearest, Distance(old, this->Tetrahedra.GetPoint(id)));
    }
  }
  const Vec3 step = (1.0 / volume) * sum;
  const double length = Norm(step);
  return IsFinite(step) && length > ShortestMove * nearest
    ? std::min(1.0, LongestMove * nearest / length) * step
    : Vec3();
}

/** The cavity of a removed point at a position. */
bool Smoothing::FindCavity(Id point, const Vec3& position, Id near)
{
  const Id first = this->Tetrahedra.Locate(position, near);
  return first != NoId && this->Tetrahedra.FindCavity(position, point, first, this->Found);
}

/**
 * Whether the cavity may be filled from the position.
 * @param filled tetrahedra in place of the removed point: where they stay they count as made
 * @param before the tetrahedra around the point before it was removed
 */
bool Smoothing::Fits(const Vec3& position, const std::vector<Id>& filled, Measures before) const
{
  const PointCavity& cavity = this->Found;
  Quality after;
  Vec3 target;
  double severity = 0.0;
  std::vector<std::array<Vec3, 4>> made;
  for (const TriangleIds& facet : cavity.Facets)
  {
    made.push_back({ this->Tetrahedra.GetPoint(facet[0]), this->Tetrahedra.GetPoint(facet[1]),
      this->Tetrahedra.GetPoint(facet[2]), position });
    const auto& [a, b, c, d] = made.back();
    this->Add(GetSmallestDihedralAngle(a, b, c, d),
      this->Mesh.GetLimits().Find(made.back(), true, target, severity), after);
  }
  for (Id t : filled)
  {
    if (!Contains(cavity.Tetrahedra, t))
    {
      made.push_back(this->Tetrahedra.GetCorners(t));
      this->AddTetrahedron(t, after);
    }
  }
  for (Id t : cavity.Tetrahedra)
  {
    if (!Contains(filled, t))
    {
      before.Excess += this->GetExcess(t);
      this->AddTetrahedron(t, before.Shapes);
    }
  }
  return this->IsNoWorse(after, before.Shapes) &&
    std::accumulate(made.begin(), made.end(), 0.0,
      [](double sum, const std::array<Vec3, 4>& corners)
      { return sum + cdm::GetExcess(corners); }) < before.Excess;
}

bool Smoothing::MakesNegativeCoupling(const std::vector<Id>& tetrahedra) const
{
  const TriangleMesh& surface = this->Mesh.GetBoundary().Surface;
  const IdLists& pointTriangles = this->Mesh.GetShape().PointTriangles;
  std::vector<EdgeIds> tested;
  for (Id t : tetrahedra)
  {
    const TetrahedronIds& ids = this->Mesh.GetMesh().Tetrahedra[t];
    for (int i = 0; i < 6; ++i)
    {
      const EdgeIds edge = MakeEdge(ids[TetrahedronEdges[i][0]], ids[TetrahedronEdges[i][1]]);
      if (this->Mesh.IsInside(edge[1]) || !IsBoundaryEdge(surface, pointTriangles, edge) ||
        Contains(tested, edge))
      {
        continue;
      }
      tested.push_back(edge);
      if (HasNegativeCoupling(this->Tetrahedra, t, i))
      {
        return true;
      }
    }
  }
  return false;
}

/** Inserts a removed point at a position, whose cavity is found, unless that spoils a coupling. */
bool Smoothing::Place(Id point, const Vec3& position, const std::vector<Id>& filled)
{
  const Vec3 old = this->Tetrahedra.GetPoint(point);
  std::vector<Id> made;
  std::copy_if(filled.begin(), filled.end(), std::back_inserter(made),
    [&](Id t) { return !Contains(this->Found.Tetrahedra, t); });
  this->Tetrahedra.Restore(point, position, this->Found);
  made.insert(
    made.end(), this->Tetrahedra.GetChanged().begin(), this->Tetrahedra.GetChanged().end());
  if (!this->MakesNegativeCoupling(made))
  {
    this->Mesh.NoteMove(point);
    return true;
  }
  this->Tetrahedra.Remove(point);
  this->FindCavity(point, old, this->Tetrahedra.GetChanged().front());
  this->Tetrahedra.Restore(point, old, this->Found);
  return false;
}

/** Moves a point by the largest part of the step that fits. */
bool Smoothing::MoveBy(Id point, const Vec3& step)
{
  Measures before;
  for (Id t : this->Star)
  {
    before.Excess += this->GetExcess(t);
    this->AddTetrahedron(t, before.Shapes);
  }
  const Vec3 old = this->Tetrahedra.GetPoint(point);
  if (!this->Tetrahedra.Remove(point))
  {
    return false;
  }
  const std::vector<Id> filled = this->Tetrahedra.GetChanged();
  for (double part : Parts)
  {
    const Vec3 position = old + part * step;
    if (this->FindCavity(point, position, filled.front()) &&
      this->Mesh.IsClear(this->Found, position) &&
      !this->Mesh.EncroachesOnBoundary(this->Found, position, this->Encroached) &&
      this->Fits(position, filled, before))
    {
      return this->Place(point, position, filled);
    }
  }
  this->Tetrahedra.UndoRemove();
  return false;
}

bool Smoothing::Move(Id point)
{
  if (!this->Tetrahedra.FindStar(point, this->Star) || this->IsUnchanged(point))
  {
    return false;
  }
  const Vec3 step = this->GetStep(point);
  const bool isMoved = step != Vec3() && this->MoveBy(point, step);
  if (!isMoved)
  {
    this->NextStamps[point] = this->Tetrahedra.GetNextStamp();
  }
  return isMoved;
}
} // namespace

Status SmoothOptimalDelaunay(
  int rounds, double target, const ExecutionContext& context, RefinedMesh& mesh)
{
  Smoothing smoothing(target, mesh);
  const Id count = mesh.GetTetrahedra().GetNumberOfPoints();
  bool isMoved = true;
  for (int round = 0; round < rounds && isMoved; ++round)
  {
    isMoved = false;
    for (Id point = 0; point < count; ++point)
    {
      if (point % MovesBetweenChecks == 0 &&
        !context.Continue(
          (round + static_cast<double>(point) / count) / rounds, "Smoothing points inside"))
      {
        return Status::Aborted();
      }
      if (point % MovesBetweenChecks == 0 && context.IsLate())
      {
        return Status();
      }
      isMoved = (mesh.IsFree(point) && smoothing.Move(point)) || isMoved;
    }
  }
  return Status();
}
} // namespace cdm
