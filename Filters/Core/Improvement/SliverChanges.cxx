// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverChanges.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
/** First step of the search for a new point's position, in radii of the sphere that it destroys. */
constexpr double FirstInsertion = 0.3;

double GetTangent2(double degrees)
{
  const double tangent = std::tan(degrees / DegreesPerRadian);
  return degrees < 90.0 ? tangent * tangent : Infinity;
}
} // namespace

SliverChanges::SliverChanges(const SliverAim& aim, const RefinedMesh& mesh, CavitySearch& search)
  : Goal(aim), Mesh(mesh), Search(search), TargetTangent2(GetTangent2(aim.Target))
{
}

/**
 * Includes an angle in what the change is to improve, or in the rest. Angles over the target always
 * count.
 * @param isSharp () whether the tetrahedron is across a sharp angle
 */
template <typename IsSharp>
void SliverChanges::Include(double angle, IsSharp&& isSharp, SmallestAngles& smallest) const
{
  double& one = angle >= this->Goal.Target || isSharp() == this->Goal.IsSharp() ? smallest.Aimed
                                                                                : smallest.Other;
  one = std::min(one, angle);
}

void SliverChanges::IncludeTetrahedron(Id tetrahedron, SmallestAngles& smallest) const
{
  this->Include(
    this->Mesh.GetAngle(tetrahedron),
    [&] { return this->Mesh.IsAcrossSharp(tetrahedron, SharpAngleUse::Sliver); }, smallest);
}

/** The angle that tetrahedra which the change is not meant to improve have to keep. */
double SliverChanges::GetFloor(const SmallestAngles& before) const
{
  return this->Goal.IsSharp() ? std::min(before.Other, this->Goal.Target)
                              : std::min(before.Aimed, before.Other);
}

/**
 * Sets what the tetrahedra have to be that would fill a cavity.
 * @param floor degrees that tetrahedra which are not aimed at have to keep; 0: not known yet
 * @param required degrees that the others have to surpass
 */
void SliverChanges::SetBounds(double floor, double required)
{
  if (this->Floor.Degrees != floor)
  {
    // Rounding must not make a tetrahedron fail that stays as it is.
    this->Floor = { floor, (1.0 - 1e-14) * GetTangent2(floor) };
  }
  if (this->Required.Degrees != required)
  {
    this->Required = { required, GetTangent2(required) };
  }
}

/** Whether the change is to improve the tetrahedron of a facet of the cavity and the new point. */
bool SliverChanges::IsAimed(const TriangleIds& facet, double tangent2) const
{
  constexpr Id inside = std::numeric_limits<Id>::max();
  return tangent2 >= this->TargetTangent2 ||
    this->Mesh.GetShape().Sharp.IsAcross(
      { facet[0], facet[1], facet[2], inside }, SharpAngleUse::Sliver) == this->Goal.IsSharp();
}

/** Whether the tetrahedron of a facet of the cavity and the new point is not too flat. */
bool SliverChanges::IsEnough(double tangent2, const TriangleIds& facet) const
{
  return tangent2 > this->Required.Tangent2 ||
    (tangent2 >= this->Floor.Tangent2 && !this->IsAimed(facet, tangent2));
}

/** Forgets what was wrong with positions before: a search of positions begins. */
void SliverChanges::StartSearch()
{
  this->Spoilers.fill({});
  this->EncroachedBefore.Clear();
}

void SliverChanges::NoteSpoiler(Id facet, bool isByLimit)
{
  std::rotate(this->Spoilers.begin(), this->Spoilers.end() - 1, this->Spoilers.end());
  this->Spoilers.front() = { facet, isByLimit };
}

/**
 * Whether a position is no good for the same reason as one before. That holds for three quarters of
 * them, and takes a tenth of the time of a search for the cavity.
 */
bool SliverChanges::IsSpoiled(const Vec3& position, Id number)
{
  const DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
  const auto isNoGood = [&](const Spoiler& spoiler)
  {
    const auto [a, c, b] = GetFacet(this->Search.GetIds(spoiler.Facet / 4), spoiler.Facet % 4);
    const TriangleIds facet{ a, b, c };
    return spoiler.IsByLimit ? this->Mesh.BreaksLimit(facet, position)
                             : !this->IsEnough(GetSmallestDihedralTangent2(mesh.GetPoint(a),
                                                 mesh.GetPoint(b), mesh.GetPoint(c), position),
                                 facet);
  };
  return this->Mesh.GetShape().Spheres.IsOnOneOf(this->EncroachedBefore, position) ||
    std::any_of(this->Spoilers.begin(), this->Spoilers.end(),
      [&](const Spoiler& spoiler)
      {
        return spoiler.Facet != NoId && isNoGood(spoiler) &&
          this->Search.IsAroundCavity(spoiler.Facet, position, number);
      });
}

/**
 * Finds a cavity. False as soon as a tetrahedron that would fill it is too flat: most positions
 * fail by one of the first, and the search is what rating them takes long for.
 */
bool SliverChanges::FindCavity(const Vec3& position, Id first, Id number)
{
  const DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
  this->Tangents2.clear();
  return this->Search.FindCavity(position, number, first, this->Found,
    [&]
    {
      const TriangleIds& facet = this->Found.Facets.back();
      this->Tangents2.push_back(GetSmallestDihedralTangent2(
        mesh.GetPoint(facet[0]), mesh.GetPoint(facet[1]), mesh.GetPoint(facet[2]), position));
      const bool isEnough = this->IsEnough(this->Tangents2.back(), facet);
      if (!isEnough)
      {
        this->NoteSpoiler(this->Found.Inner.back(), false);
      }
      return isEnough;
    });
}

/** Whether the mesh may have a point at the position, with the cavity that was found. */
bool SliverChanges::IsAllowed(const Vec3& position, bool mayBreakLimits)
{
  if (!this->Mesh.IsClear(this->Found, position))
  {
    return false;
  }
  const std::size_t broken =
    mayBreakLimits ? this->Found.Facets.size() : this->Mesh.FindBroken(this->Found, position);
  if (broken < this->Found.Facets.size())
  {
    this->NoteSpoiler(this->Found.Inner[broken], true);
    return false;
  }
  const bool isAllowed = !this->Mesh.EncroachesOnBoundary(this->Found, position, this->Encroached);
  if (!this->Encroached.IsEmpty())
  {
    std::swap(this->Encroached, this->EncroachedBefore);
  }
  return isAllowed;
}

/**
 * Smallest angle among the tetrahedra aimed at if the cavity that was found were filled. 0 if
 * another tetrahedron falls below the floor, or if the angle is not larger than required.
 */
double SliverChanges::RateCavity() const
{
  double smallest = Infinity;
  for (std::size_t i = 0; i < this->Found.Facets.size(); ++i)
  {
    const double tangent2 = this->Tangents2[i];
    const bool isAimed = this->IsAimed(this->Found.Facets[i], tangent2);
    if (isAimed ? tangent2 <= this->Required.Tangent2 : tangent2 < this->Floor.Tangent2)
    {
      return 0.0;
    }
    smallest = isAimed ? std::min(smallest, tangent2) : smallest;
  }
  return smallest < Infinity ? DegreesPerRadian * std::atan(std::sqrt(smallest)) : 180.0;
}

/** Number of tetrahedra below the target that would fill the cavity that was found. */
Id SliverChanges::CountFlatFound() const
{
  return static_cast<Id>(std::count_if(this->Tangents2.begin(), this->Tangents2.end(),
    [this](double tangent2) { return tangent2 < this->TargetTangent2; }));
}

/**
 * Whether the move into the cavity that was found would leave more tetrahedra below the target than
 * there are now. Cells in place of the point that stay count, those of the cavity do not.
 */
bool SliverChanges::LeavesMoreFlat() const
{
  const Id firstCell = this->Search.GetFirstCell();
  Id more = this->CountFlatFound() - this->Before.Flat +
    static_cast<Id>(std::count(this->Cells.IsFlat.begin(), this->Cells.IsFlat.end(), 1));
  for (const Id t : this->Found.Tetrahedra)
  {
    const bool isFlat = t < firstCell ? this->IsFlat(t) : this->Cells.IsFlat[t - firstCell] != 0;
    more -= isFlat ? 1 : 0;
  }
  return more > 0;
}

/** Keeps the cavity that was found: its position is better than all before. */
double SliverChanges::KeepBest(double angle)
{
  std::swap(this->Found, this->Best);
  return angle;
}

void SliverChanges::MeasureStar(Id point)
{
  const DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
  const Vec3& position = mesh.GetPoint(point);
  this->Before = {};
  this->Before.Nearest = Infinity;
  Vec3 sum;
  double count = 0.0;
  for (const Id t : this->Search.GetStar())
  {
    this->Before.Broken += this->Mesh.BreaksLimit(t) ? 1 : 0;
    this->Before.Flat += this->IsFlat(t) ? 1 : 0;
    this->IncludeTetrahedron(t, this->Before.Angles);
    for (const Id id : mesh.GetMesh().Tetrahedra[t])
    {
      if (id != point)
      {
        const Vec3& neighbor = mesh.GetPoint(id);
        this->Before.Nearest = std::min(this->Before.Nearest, Distance(position, neighbor));
        sum = sum + neighbor;
        count += 1.0;
      }
    }
  }
  this->Before.Mean = (1.0 / count) * sum;
}

void SliverChanges::MeasureCells(double floor)
{
  this->Cells.Angles.clear();
  this->Cells.IsBroken.clear();
  this->Cells.IsFlat.clear();
  for (const CavityCell& cell : this->Search.GetCells())
  {
    const std::array<Vec3, 4> corners = GetCorners(this->Mesh.GetMesh().Points, cell.Ids);
    const double angle = GetSmallestDihedralAngle(corners[0], corners[1], corners[2], corners[3]);
    SmallestAngles after;
    this->Include(
      angle, [&] { return this->Mesh.GetShape().Sharp.IsAcross(cell.Ids, SharpAngleUse::Sliver); },
      after);
    this->Cells.Angles.push_back(after.Other < floor ? 0.0 : after.Aimed);
    this->Cells.IsBroken.push_back(this->Mesh.BreaksLimit(cell.Ids, corners) ? 1 : 0);
    this->Cells.IsFlat.push_back(angle < this->Goal.Target ? 1 : 0);
  }
  this->Cells.Flattest.resize(this->Cells.Angles.size());
  std::iota(this->Cells.Flattest.begin(), this->Cells.Flattest.end(), 0);
  std::sort(this->Cells.Flattest.begin(), this->Cells.Flattest.end(),
    [this](Id a, Id b) { return this->Cells.Angles[a] < this->Cells.Angles[b]; });
}

/**
 * Whether a cell that is too flat would stay. Such cells spoil most positions, the flattest first.
 * One test of each shows that; the search would need a walk and a cavity.
 */
bool SliverChanges::LeavesFlatter(Id point, const Vec3& position, double required) const
{
  for (const Id i : this->Cells.Flattest)
  {
    if (this->Cells.Angles[i] > required)
    {
      return false;
    }
    if (!this->Search.IsInConflict(this->Search.GetFirstCell() + i, position, point))
    {
      return true;
    }
  }
  return false;
}

double SliverChanges::RateMove(Id point, const Vec3& position, double floor, double required)
{
  this->SetBounds(floor, required);
  if (this->LeavesFlatter(point, position, required) || this->IsSpoiled(position, point))
  {
    return 0.0;
  }
  const Id first = this->Search.Locate(position, this->Search.GetFirstCell());
  if (first == NoId || !this->FindCavity(position, first, point))
  {
    return 0.0;
  }
  // Cells in place of the point that is left out, which stay, count as well.
  Id broken = 0;
  for (std::size_t i = 0; i < this->Cells.Angles.size(); ++i)
  {
    if ((this->Cells.Angles[i] <= required || this->Cells.IsBroken[i] != 0) &&
      !Contains(this->Found.Tetrahedra, this->Search.GetFirstCell() + static_cast<Id>(i)))
    {
      if (this->Cells.Angles[i] <= required)
      {
        return 0.0;
      }
      ++broken;
    }
  }
  const double angle = this->RateCavity();
  return angle > required && (this->Before.Broken > 0 || broken == 0) &&
      !(this->Goal.IsSharp() && this->LeavesMoreFlat()) &&
      this->IsAllowed(position, this->Before.Broken > 0)
    ? this->KeepBest(angle)
    : 0.0;
}

bool SliverChanges::FindMove(Id point, SliverChange& change)
{
  if (!this->Search.LeaveOut(point))
  {
    return false;
  }
  this->StartSearch();
  this->MeasureStar(point);
  const double floor = this->GetFloor(this->Before.Angles);
  this->MeasureCells(floor);
  const Vec3& old = this->Mesh.GetTetrahedra().GetPoint(point);
  Place best{ old, this->Before.Angles.Aimed + SmallestGain, false };
  SearchMove(
    old, this->Before.Mean, this->Before.Nearest, this->Goal.Target,
    [&](const Vec3& position, double required)
    { return this->RateMove(point, position, floor, required); },
    best, this->Goal.Effort);
  this->Search.TakeBack();
  const std::vector<char>& isBroken = this->Cells.IsBroken;
  const std::vector<char>& isFlat = this->Cells.IsFlat;
  if (this->Goal.MayRemove &&
    std::count(isBroken.begin(), isBroken.end(), 1) <= this->Before.Broken &&
    *std::min_element(this->Cells.Angles.begin(), this->Cells.Angles.end()) > best.Angle &&
    !(this->Goal.IsSharp() && std::count(isFlat.begin(), isFlat.end(), 1) > this->Before.Flat))
  {
    change.What = SliverChange::Kind::Removal;
  }
  else if (best.IsFound)
  {
    change.What = SliverChange::Kind::Move;
    change.Position = best.Position;
    change.Cavity = std::move(this->Best);
    change.FirstCell = this->Search.GetFirstCell();
  }
  else
  {
    return false;
  }
  change.Point = point;
  change.Star = this->Search.GetStar();
  change.Cells = this->Search.GetCells();
  return true;
}

double SliverChanges::RateInsertion(Id tetrahedron, const Vec3& position, double required)
{
  const Id number = this->Mesh.GetTetrahedra().GetNumberOfPoints();
  this->SetBounds(0.0, required);
  if (this->IsSpoiled(position, number) || !this->FindCavity(position, tetrahedron, number))
  {
    return 0.0;
  }
  SmallestAngles before;
  Id flat = 0;
  for (const Id t : this->Found.Tetrahedra)
  {
    this->IncludeTetrahedron(t, before);
    flat += this->IsFlat(t) ? 1 : 0;
  }
  this->SetBounds(this->GetFloor(before), required);
  const double angle = this->RateCavity();
  return angle > required && !(this->Goal.IsSharp() && this->CountFlatFound() > flat) &&
      this->IsAllowed(position, false)
    ? this->KeepBest(angle)
    : 0.0;
}

void SliverChanges::FindInsertion(Id tetrahedron, SliverChange& change)
{
  const auto [a, b, c, d] = this->Mesh.GetTetrahedra().GetCorners(tetrahedron);
  const Vec3 center = GetCircumcenter(a, b, c, d);
  if (!IsFinite(center) || this->Mesh.IsFull())
  {
    return;
  }
  const auto rate = [&](const Vec3& position, double required)
  { return this->RateInsertion(tetrahedron, position, required); };
  this->StartSearch();
  Place best{ center, this->Mesh.GetAngle(tetrahedron) + SmallestGain, false };
  TryPlace(center, rate, best);
  SearchPlace(center, FirstInsertion * Distance(center, a), MakeCubeDirections(), this->Goal.Target,
    rate, best, this->Goal.Effort);
  if (best.IsFound)
  {
    change.What = SliverChange::Kind::Insertion;
    change.Position = best.Position;
    change.Cavity = std::move(this->Best);
  }
}

bool SliverChanges::IsImmovable(Id point)
{
  const bool isImmovable = this->Mesh.IsImmovable(point, this->Goal.Place);
  if (isImmovable)
  {
    // For the record: the answer depends on the tetrahedra at the point.
    this->Search.FindStar(point, this->Star);
  }
  return isImmovable;
}

SliverChange SliverChanges::Find(Id tetrahedron, SliverAttempt last)
{
  this->Search.StartRecord();
  SliverChange change;
  for (const Id id : this->Mesh.GetMesh().Tetrahedra[tetrahedron])
  {
    if (!this->Mesh.IsFree(id) || this->IsImmovable(id))
    {
      continue;
    }
    if (this->FindMove(id, change))
    {
      return change;
    }
    change.Immovable.push_back(id);
  }
  if (last == SliverAttempt::Insertion)
  {
    this->FindInsertion(tetrahedron, change);
  }
  return change;
}
} // namespace cdm
