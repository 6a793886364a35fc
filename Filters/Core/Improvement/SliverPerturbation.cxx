// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverPerturbation.h"

#include "Core/Geometry/Measures.h"
#include "Core/Improvement/SliverList.h"
#include "Core/Search/PlaceSearch.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace cdm
{
namespace
{
constexpr std::size_t ReportInterval = 16;
/** First step of the search for a new point's position, in radii of the sphere that it destroys. */
constexpr double FirstInsertion = 0.3;
/**
 * How many steps of a search for a position may find nothing at a sharp angle. Most searches there
 * are in vain; with the other steps they take twice as long, and find little more.
 */
constexpr int PatienceAtSharpAngles = 2;

/** Which tetrahedra the changes are to improve, and by which means. */
struct Aim
{
  /** Degrees; larger angles are as good. */
  double Target;
  /** True: only tetrahedra across sharp angles are improved; false: only the others. */
  bool IsSharp = false;
  SliverMeans Means = SliverMeans::Moves;
};

/** Changes points inside, one sliver after the other. */
class Perturbation
{
public:
  Perturbation(const Aim& aim, RefinedMesh& mesh)
    : Goal(aim), Mesh(mesh), Tetrahedra(mesh.GetTetrahedra())
  {
  }

  /** False if nothing helps, or is known not to; then nothing has changed. */
  bool Mend(const Sliver& sliver, SliverAttempt last);

private:
  /** The smallest angles of tetrahedra that a change replaces, or makes. */
  struct SmallestAngles
  {
    /** The smallest angle of tetrahedra that the change is to improve. */
    double Aimed = 180.0;
    double Other = 180.0;
  };
  void Include(Id tetrahedron, SmallestAngles& smallest) const;
  double GetFloor(const SmallestAngles& before) const;
  bool IsAimed(const TriangleIds& facet, double angle) const;
  bool FindCavity(const Vec3& position, Id first, Id number, double floor, double required);
  double RateCavity(double floor, double required) const;
  bool Move(Id point, int patience);
  bool InsertBest(Id tetrahedron, int patience);

  const Aim Goal;
  RefinedMesh& Mesh;
  DynamicTetrahedralization& Tetrahedra;
  /** Smallest angles of the tetrahedra that would fill the mesh's cavity, facet by facet. */
  std::vector<double> Angles;
};

/** Angles over the target always count. */
void Perturbation::Include(Id tetrahedron, SmallestAngles& smallest) const
{
  const double angle = this->Mesh.GetAngle(tetrahedron);
  const bool isAimed = angle >= this->Goal.Target ||
    this->Mesh.IsAcrossSharp(tetrahedron, SharpAngleUse::Sliver) == this->Goal.IsSharp;
  double& one = isAimed ? smallest.Aimed : smallest.Other;
  one = std::min(one, angle);
}

/** The angle that tetrahedra which the change is not meant to improve have to keep. */
double Perturbation::GetFloor(const SmallestAngles& before) const
{
  return this->Goal.IsSharp ? std::min(before.Other, this->Goal.Target)
                            : std::min(before.Aimed, before.Other);
}

/** Whether the change is to improve the tetrahedron of a facet of the cavity and the new point. */
bool Perturbation::IsAimed(const TriangleIds& facet, double angle) const
{
  constexpr Id inside = std::numeric_limits<Id>::max();
  return angle >= this->Goal.Target ||
    this->Mesh.GetShape().Sharp.IsAcross(
      { facet[0], facet[1], facet[2], inside }, SharpAngleUse::Sliver) == this->Goal.IsSharp;
}

/**
 * Finds the mesh's cavity. False as soon as a tetrahedron that would fill it is too flat: most
 * positions fail by one of the first, and the search is what rating them takes long for.
 * @param floor the angle that tetrahedra which are not aimed at have to keep; 0: not known yet
 * @param required the angle that the others have to surpass
 */
bool Perturbation::FindCavity(
  const Vec3& position, Id first, Id number, double floor, double required)
{
  this->Angles.clear();
  return this->Mesh.FindCavity(position, first, number,
    [&](const TriangleIds& facet)
    {
      const double angle = GetSmallestDihedralAngle(this->Tetrahedra.GetPoint(facet[0]),
        this->Tetrahedra.GetPoint(facet[1]), this->Tetrahedra.GetPoint(facet[2]), position);
      this->Angles.push_back(angle);
      return angle > required || (angle >= floor && !this->IsAimed(facet, angle));
    });
}

/**
 * Smallest angle among the tetrahedra aimed at if the cavity that was found were filled. 0 if
 * another tetrahedron falls below the floor, or if the angle is not larger than required.
 */
double Perturbation::RateCavity(double floor, double required) const
{
  const std::vector<TriangleIds>& facets = this->Mesh.GetCavity().Facets;
  double smallest = 180.0;
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    const double angle = this->Angles[i];
    const bool isAimed = this->IsAimed(facets[i], angle);
    if (isAimed ? angle <= required : angle < floor)
    {
      return 0.0;
    }
    smallest = isAimed ? std::min(smallest, angle) : smallest;
  }
  return smallest;
}

bool Perturbation::Move(Id point, int patience)
{
  std::vector<Id> star;
  if (!this->Tetrahedra.FindStar(point, star))
  {
    return false;
  }
  const Vec3 old = this->Tetrahedra.GetPoint(point);
  Id broken = 0;
  SmallestAngles before;
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 sum;
  double count = 0.0;
  for (Id t : star)
  {
    broken += this->Mesh.BreaksLimit(t);
    this->Include(t, before);
    for (Id id : this->Mesh.GetMesh().Tetrahedra[t])
    {
      if (id != point)
      {
        const Vec3& neighbor = this->Tetrahedra.GetPoint(id);
        nearest = std::min(nearest, Distance(old, neighbor));
        sum = sum + neighbor;
        count += 1.0;
      }
    }
  }
  if (!this->Tetrahedra.Remove(point))
  {
    return false;
  }
  const std::vector<Id> filled = this->Tetrahedra.GetChanged();
  const double floor = this->GetFloor(before);
  // Angles of the tetrahedra aimed at; the others are either good enough or not.
  std::vector<double> angles;
  std::vector<char> isBroken;
  for (Id t : filled)
  {
    SmallestAngles after;
    this->Include(t, after);
    angles.push_back(after.Other < floor ? 0.0 : after.Aimed);
    isBroken.push_back(this->Mesh.BreaksLimit(t));
  }
  // Tetrahedra that stay as they are spoil most positions, the flattest first. One test of each
  // shows that; the search would need a walk and a cavity.
  std::vector<std::size_t> flattest(filled.size());
  std::iota(flattest.begin(), flattest.end(), std::size_t(0));
  std::sort(flattest.begin(), flattest.end(),
    [&angles](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
  const auto leavesFlatter = [&](const Vec3& position, double required)
  {
    for (std::size_t i : flattest)
    {
      if (angles[i] > required)
      {
        return false;
      }
      if (!this->Tetrahedra.IsInConflict(filled[i], position, point))
      {
        return true;
      }
    }
    return false;
  };
  const auto locate = [&](const Vec3& position)
  { return this->Tetrahedra.Locate(position, filled.front()); };
  const auto findCavity = [&](const Vec3& position, double required)
  {
    const Id first = locate(position);
    return first != NoId && this->FindCavity(position, first, point, floor, required);
  };
  const auto rate = [&](const Vec3& position, double required)
  {
    if (leavesFlatter(position, required) || !findCavity(position, required))
    {
      return 0.0;
    }
    // Tetrahedra that fill the cavity of the removed point, and stay, count as well.
    const std::vector<Id>& replaced = this->Mesh.GetCavity().Tetrahedra;
    Id brokenThere = 0;
    for (std::size_t i = 0; i < filled.size(); ++i)
    {
      if ((angles[i] <= required || isBroken[i]) &&
        std::find(replaced.begin(), replaced.end(), filled[i]) == replaced.end())
      {
        if (angles[i] <= required)
        {
          return 0.0;
        }
        ++brokenThere;
      }
    }
    const double angle = this->RateCavity(floor, required);
    return angle > required && this->Mesh.IsClear(position) &&
        (broken > 0 || brokenThere + this->Mesh.CountBroken(position) == 0) &&
        !this->Mesh.EncroachesOnBoundary(position)
      ? angle
      : 0.0;
  };
  Place best{ old, before.Aimed + SmallestGain, false };
  SearchMove(old, (1.0 / count) * sum, nearest, this->Goal.Target, rate, best, patience);

  if (this->Goal.Means != SliverMeans::Moves &&
    std::count(isBroken.begin(), isBroken.end(), 1) <= broken &&
    *std::min_element(angles.begin(), angles.end()) > best.Angle)
  {
    this->Mesh.NoteRemoval();
    return true;
  }
  if (!best.IsFound)
  {
    this->Tetrahedra.UndoRemove();
    return false;
  }
  this->Mesh.FindCavity(best.Position, locate(best.Position), point);
  this->Mesh.Restore(point, best.Position);
  return true;
}

bool Perturbation::InsertBest(Id tetrahedron, int patience)
{
  const auto [a, b, c, d] = this->Tetrahedra.GetCorners(tetrahedron);
  const Vec3 center = GetCircumcenter(a, b, c, d);
  if (!IsFinite(center) || this->Mesh.IsFull())
  {
    return false;
  }
  const auto rate = [&](const Vec3& position, double required)
  {
    if (!this->FindCavity(position, tetrahedron, NoId, 0.0, required))
    {
      return 0.0;
    }
    SmallestAngles before;
    for (Id t : this->Mesh.GetCavity().Tetrahedra)
    {
      this->Include(t, before);
    }
    const double angle = this->RateCavity(this->GetFloor(before), required);
    return angle > required && this->Mesh.IsClear(position) &&
        this->Mesh.CountBroken(position) == 0 && !this->Mesh.EncroachesOnBoundary(position)
      ? angle
      : 0.0;
  };
  Place best{ center, this->Mesh.GetAngle(tetrahedron) + SmallestGain, false };
  TryPlace(center, rate, best);
  SearchPlace(center, FirstInsertion * Distance(center, a), MakeCubeDirections(), this->Goal.Target,
    rate, best, patience);
  if (!best.IsFound || !this->Mesh.FindCavity(best.Position, tetrahedron))
  {
    return false;
  }
  this->Mesh.Insert(best.Position);
  return true;
}

bool Perturbation::Mend(const Sliver& sliver, SliverAttempt last)
{
  const TetrahedronIds ids = this->Mesh.GetMesh().Tetrahedra[sliver.Tetrahedron];
  const TetrahedronIds names = this->Mesh.GetNames(ids);
  if (this->Mesh.GetMemory().IsHopeless(names, last))
  {
    return false;
  }
  const int patience = this->Mesh.IsAcrossSharp(sliver.Tetrahedron, SharpAngleUse::Shape)
    ? PatienceAtSharpAngles
    : MaximumSearchSteps;
  if (std::any_of(ids.begin(), ids.end(),
        [&](Id id) { return this->Mesh.IsFree(id) && this->Move(id, patience); }) ||
    (last == SliverAttempt::Insertion && this->InsertBest(sliver.Tetrahedron, patience)))
  {
    return true;
  }
  this->Mesh.GetMemory().SetHopeless(names, last);
  return false;
}
} // namespace

Status PerturbSlivers(
  double target, SliverMeans means, const ExecutionContext& context, RefinedMesh& mesh)
{
  const Aim aim{ MoveRatio * target, false, means };
  Perturbation perturbation(aim, mesh);
  const IdLists& pointTriangles = mesh.GetShape().PointTriangles;
  BoundaryRequests& requests = mesh.GetRequests();
  // First moves, then new points as well; when neither helps any more, requests.
  bool mayInsert = false;
  bool isLast = false;
  std::vector<TetrahedronIds> unmet;
  for (int pass = 0; pass < MaximumSliverPasses; ++pass)
  {
    const std::vector<Sliver> slivers = FindSlivers(aim.Target, aim.IsSharp, mesh);
    bool isMended = false;
    for (std::size_t i = 0; i < slivers.size(); ++i)
    {
      if (i % ReportInterval == 0 &&
        !context.Continue((pass + static_cast<double>(i) / slivers.size()) / MaximumSliverPasses,
          "Moving points of slivers"))
      {
        return Status::Aborted();
      }
      const Sliver& sliver = slivers[i];
      if (IsGone(sliver, mesh))
      {
        continue;
      }
      const TetrahedronIds ids = mesh.GetMesh().Tetrahedra[sliver.Tetrahedron];
      const bool isBad = sliver.Angle < target;
      if (perturbation.Mend(
            sliver, isBad && mayInsert ? SliverAttempt::Insertion : SliverAttempt::Move))
      {
        isMended = isMended || isBad;
        continue;
      }
      if (isBad && isLast && means == SliverMeans::Requests)
      {
        unmet.push_back(ids);
        const auto [a, b, c, d] = mesh.GetTetrahedra().GetCorners(sliver.Tetrahedron);
        const Vec3 center = GetCircumcenter(a, b, c, d);
        if (!requests.AddEdgeOfTwoTriangles(ids, pointTriangles) && IsFinite(center))
        {
          mesh.RequestEncroached(center, true);
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
  // No edge or triangle of the boundary is in the way. A point on a boundary triangle beside the
  // sliver may still help: request one for all slivers that have a point in common.
  if (requests.GetNumber() == 0)
  {
    std::vector<Id> near;
    for (const TetrahedronIds& ids : unmet)
    {
      if (std::none_of(ids.begin(), ids.end(),
            [&near](Id id) { return std::find(near.begin(), near.end(), id) != near.end(); }))
      {
        requests.AddLargestTriangle(ids, pointTriangles);
        near.insert(near.end(), ids.begin(), ids.end());
      }
    }
  }
  return Status();
}

Status PerturbSharp(double target, const ExecutionContext& context, RefinedMesh& mesh)
{
  const Aim aim{ MoveRatio * target, true };
  Perturbation perturbation(aim, mesh);
  const std::vector<Sliver> slivers = FindSlivers(aim.Target, aim.IsSharp, mesh);
  for (std::size_t i = 0; i < slivers.size(); ++i)
  {
    if (i % ReportInterval == 0 &&
      !context.Continue(static_cast<double>(i) / slivers.size(), "Moving points at sharp angles"))
    {
      return Status::Aborted();
    }
    if (!IsGone(slivers[i], mesh))
    {
      perturbation.Mend(slivers[i], SliverAttempt::Move);
    }
  }
  return Status();
}
} // namespace cdm
