// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/RegionLocator.h"

#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SurfaceSides.h"
#include "Core/Search/BoxTree.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
/** A segment meets an edge by chance only; a point on the surface does so with each of them. */
constexpr int NumberOfSegments = 24;

/** The k-th end of a segment, far outside: nearly along an axis, so that its box is thin. */
Vec3 GetOutside(const Vec3& point, const Vec3& low, const Vec3& high, int k)
{
  // Multiples of irrational numbers modulo 1 fill the interval evenly (Roberts' sequence).
  const auto spread = [k](double factor)
  { return (k + 1) * factor - std::floor((k + 1) * factor) - 0.5; };
  const double size = Distance(low, high);
  const int axis = k % 3;
  Vec3 outside = point;
  outside[axis] = k / 3 % 2 == 0 ? high[axis] + 0.1 * size : low[axis] - 0.1 * size;
  outside[(axis + 1) % 3] += 2e-3 * size * spread(0.7548776662466927);
  outside[(axis + 2) % 3] += 2e-3 * size * spread(0.5698402909980532);
  return outside;
}

enum class Crossing
{
  None,
  /** The point lies in front of the triangle, or behind it. */
  ToFront,
  ToBack,
  /** An edge or a vertex is in the way, or the point lies on the triangle. */
  Degenerate
};

Crossing FindCrossing(
  const Vec3& point, const Vec3& outside, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const int side = Orientation(a, b, c, point);
  if (side != 0 && side == Orientation(a, b, c, outside))
  {
    return Crossing::None;
  }
  const int turns[3] = { Orientation(point, outside, a, b), Orientation(point, outside, b, c),
    Orientation(point, outside, c, a) };
  const auto [lowest, highest] = std::minmax_element(turns, turns + 3);
  if (*lowest < 0 && *highest > 0)
  {
    return Crossing::None;
  }
  if (side == 0 || turns[0] == 0 || turns[1] == 0 || turns[2] == 0)
  {
    return Crossing::Degenerate;
  }
  return side > 0 ? Crossing::ToFront : Crossing::ToBack;
}
} // namespace

RegionLocator::RegionLocator(const TriangleMesh& surface) : Surface(surface) {}

RegionLocator::~RegionLocator() = default;

Status RegionLocator::Build()
{
  std::vector<Box> boxes = MakeBoxes(this->Surface.Points, this->Surface.Triangles);
  Box bounds;
  for (const Box& box : boxes)
  {
    bounds.Add(box);
  }
  this->Low = bounds.Low;
  this->High = bounds.High;
  this->Tree = std::make_unique<BoxTree>(boxes);
  const Status status = this->FindRegions();
  if (status.IsOk())
  {
    this->FindDepths();
  }
  return status;
}

Status RegionLocator::FindRegions()
{
  const SurfaceSides sides = FindSurfaceSides(this->Surface);
  this->Shells = sides.Shells;
  this->IsOuter = sides.IsOuter;
  this->Components = sides.Components;
  this->ShellComponents.assign(this->IsOuter.size(), NoId);
  this->Regions.assign(this->IsOuter.size(), OutsideRegion);
  std::vector<char> isSeen(this->IsOuter.size(), 0);
  Id segments = 0;
  std::vector<Id> wrong;
  for (std::size_t side = 0; side < this->Shells.size(); ++side)
  {
    const Id shell = this->Shells[side];
    const std::size_t triangle = side / 2;
    const Id label = this->Surface.Labels.empty() ? NoId
      : side % 2 == 0                             ? this->Surface.Labels[triangle].Front
                                                  : this->Surface.Labels[triangle].Back;
    if (!isSeen[shell])
    {
      isSeen[shell] = 1;
      this->ShellComponents[shell] = this->Components[triangle];
      segments += !this->IsOuter[shell];
      this->Regions[shell] = !this->Surface.Labels.empty() ? label
        : this->IsOuter[shell]                             ? OutsideRegion
                                                           : segments - 1;
    }
    else if (!this->Surface.Labels.empty() && this->Regions[shell] != label)
    {
      wrong.push_back(static_cast<Id>(triangle));
    }
  }
  wrong.erase(std::unique(wrong.begin(), wrong.end()), wrong.end());
  if (!wrong.empty())
  {
    return Status::Failure(StatusCode::NotClosed,
      "BoundaryLabels contradict each other: triangles that look into the same space have "
      "different regions on that side. Correct them, or close the surface if it has openings.",
      std::move(wrong));
  }
  if (segments == 0)
  {
    return Status::Failure(StatusCode::NotClosed,
      "The surface encloses nothing: it has " + std::to_string(sides.OpenTriangles.size()) +
        " triangles with an open edge. Close it (MaximumGapEdges of the boundary triangulator "
        "patches gaps).",
      sides.OpenTriangles);
  }
  return {};
}

void RegionLocator::FindDepths()
{
  Id numberOfComponents = 0;
  for (const Id component : this->Components)
  {
    numberOfComponents = std::max(numberOfComponents, component + 1);
  }
  this->Depths.assign(numberOfComponents, NoId);
  std::vector<std::vector<Id>> around(numberOfComponents);
  for (std::size_t t = 0; t < this->Components.size() && numberOfComponents > 1; ++t)
  {
    const Id component = this->Components[t];
    // A vertex may touch another component; not all of them do.
    for (int i = 0; i < 3 && this->Depths[component] == NoId; ++i)
    {
      bool isOnSurface = false;
      around[component] = this->FindShells(
        this->Surface.Points[this->Surface.Triangles[t][i]], component, isOnSurface);
      if (!isOnSurface)
      {
        this->Depths[component] = static_cast<Id>(around[component].size());
      }
    }
  }
  for (std::size_t shell = 0; shell < this->Regions.size() && this->Surface.Labels.empty(); ++shell)
  {
    if (this->IsOuter[shell])
    {
      this->Regions[shell] = this->GetInnermostRegion(around[this->ShellComponents[shell]]);
    }
  }
}

Id RegionLocator::GetInnermostRegion(const std::vector<Id>& shells) const
{
  Id innermost = NoId;
  for (const Id shell : shells)
  {
    if (innermost == NoId ||
      this->Depths[this->ShellComponents[shell]] > this->Depths[this->ShellComponents[innermost]])
    {
      innermost = shell;
    }
  }
  return innermost == NoId ? OutsideRegion : this->Regions[innermost];
}

RegionPair RegionLocator::GetRegions(Id triangle) const
{
  return { this->Regions[this->Shells[2 * triangle]],
    this->Regions[this->Shells[2 * triangle + 1]] };
}

bool RegionLocator::CountCrossings(
  const Vec3& point, const Vec3& outside, Id except, std::vector<ShellCount>& counts) const
{
  counts.clear();
  const auto add = [&counts](Id shell, int change)
  {
    const auto place = std::find_if(counts.begin(), counts.end(),
      [shell](const ShellCount& count) { return count.Shell == shell; });
    if (place == counts.end())
    {
      counts.push_back({ shell, change });
    }
    else
    {
      place->Count += change;
    }
  };
  Box box;
  box.Add(point);
  box.Add(outside);
  bool isDegenerate = false;
  const auto visit = [&](Id t)
  {
    if (isDegenerate || this->Components[t] == except)
    {
      return;
    }
    const TriangleIds& ids = this->Surface.Triangles[t];
    const Crossing crossing = FindCrossing(point, outside, this->Surface.Points[ids[0]],
      this->Surface.Points[ids[1]], this->Surface.Points[ids[2]]);
    isDegenerate = crossing == Crossing::Degenerate;
    if (crossing == Crossing::ToFront || crossing == Crossing::ToBack)
    {
      const Id entered = 2 * t + (crossing == Crossing::ToFront ? 0 : 1);
      add(this->Shells[entered], 1);
      add(this->Shells[entered ^ 1], -1);
    }
  };
  this->Tree->VisitOverlaps(box, visit);
  return !isDegenerate;
}

std::vector<Id> RegionLocator::FindShells(const Vec3& point, Id except, bool& isOnSurface) const
{
  std::vector<ShellCount> counts;
  std::vector<Id> shells;
  for (int k = 0; k < NumberOfSegments; ++k)
  {
    if (this->CountCrossings(point, GetOutside(point, this->Low, this->High, k), except, counts))
    {
      for (const ShellCount& count : counts)
      {
        if (count.Count > 0 && !this->IsOuter[count.Shell])
        {
          shells.push_back(count.Shell);
        }
      }
      isOnSurface = false;
      return shells;
    }
  }
  isOnSurface = true;
  return shells;
}

Id RegionLocator::Locate(const Vec3& point) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(point[axis] > this->Low[axis] && point[axis] < this->High[axis]))
    {
      return OutsideRegion;
    }
  }
  bool isOnSurface = false;
  return this->GetInnermostRegion(this->FindShells(point, NoId, isOnSurface));
}

bool RegionLocator::MayTouch(const Vec3& low, const Vec3& high) const
{
  bool isTouched = false;
  this->Tree->VisitOverlaps({ low, high }, [&isTouched](Id) { isTouched = true; });
  return isTouched;
}

double RegionLocator::GetDistance(const Vec3& point, double limit) const
{
  return this->Tree->FindDistance(point, limit,
    [&](Id t)
    {
      const TriangleIds& ids = this->Surface.Triangles[t];
      return GetDistanceToTriangle(point, this->Surface.Points[ids[0]],
        this->Surface.Points[ids[1]], this->Surface.Points[ids[2]]);
    });
}

namespace
{
template <typename Filter>
bool IsClearOf(const BoxTree& tree, const TriangleMesh& surface, const Vec3& point,
  const LocalSpacing& spacing, double distance, Filter&& isMeant)
{
  // Rounding must not tell points of the same distance apart.
  distance *= 1.0 - 1e-12;
  const Vec3 reach = distance * spacing.GetExtents();
  bool isClear = true;
  const auto visit = [&](Id t)
  {
    if (isClear && isMeant(t))
    {
      Vec3 corners[3];
      for (int i = 0; i < 3; ++i)
      {
        corners[i] = spacing.ToUnits(surface.Points[surface.Triangles[t][i]] - point);
      }
      isClear = GetDistanceToTriangle({}, corners[0], corners[1], corners[2]) >= distance;
    }
  };
  tree.VisitOverlaps({ point - reach, point + reach }, visit);
  return isClear;
}
} // namespace

bool RegionLocator::IsClear(const Vec3& point, const LocalSpacing& spacing, double distance) const
{
  return IsClearOf(*this->Tree, this->Surface, point, spacing, distance, [](Id) { return true; });
}

bool RegionLocator::IsClear(
  const Vec3& point, const LocalSpacing& spacing, double distance, const RegionPair& between) const
{
  const RegionPair reverse{ between.Back, between.Front };
  return IsClearOf(*this->Tree, this->Surface, point, spacing, distance,
    [&](Id t)
    {
      const RegionPair regions = this->GetRegions(t);
      return regions == between || regions == reverse;
    });
}
} // namespace cdm
