// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SurfacePointMoves.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Box.h"
#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Improvement/LookAhead.h"
#include "Core/Improvement/PointRounding.h"
#include "Core/Improvement/SurfaceSpheres.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

namespace cdm
{
namespace
{
/**
 * Triangles within this part of the surface's diagonal of a plane lie in it: far more than
 * rounding.
 */
constexpr double PlaneRatio = 1e-12;
/** Edges that bend by less than this, in radians, are one line. */
constexpr double LineAngle = 1e-9;
/** Larger cavities mean that the point has come close to something far away. */
constexpr std::size_t LargestCavity = 500;
/** Points with more tetrahedra and triangles of the surface are hubs. */
constexpr std::size_t LargestStar = 64;
/**
 * At sharp angles. With the effort for other slivers the mesher takes 6 % more time, and leaves 1 %
 * fewer there.
 */
constexpr SearchEffort SharpEffort{ 1, 1 };
/**
 * A pass there ends after so many slivers of which less than this part was mended. In cdt_bracket, with
 * 18,600 of them, the whole pass took a quarter of the mesher's time, and mended eighteen.
 */
constexpr std::size_t FewestSlivers = 300;
constexpr double LeastRatio = 0.02;
/** Passes there go on as long as one mends more than this part. */
constexpr int MaximumSharpMoves = 5;
constexpr double WorthwhileMoves = 0.05;

/** Unit vectors along a coordinate axis are exact: a factor of 1 / norm would be rounded. */
Vec3 GetUnitVector(const Vec3& v)
{
  const double norm = Norm(v);
  return { v.X / norm, v.Y / norm, v.Z / norm };
}

/** The point of a plane or line through the origin nearest to a position; along the axes exact. */
Vec3 Project(const Vec3& position, const Vec3& origin, const Vec3& axis, bool isLine)
{
  Vec3 projected = isLine ? origin + Dot(position - origin, axis) * axis
                          : position + Dot(origin - position, axis) * axis;
  for (int i = 0; i < 3; ++i)
  {
    if (std::abs(axis[i]) == 1.0)
    {
      projected[i] = isLine ? position[i] : origin[i];
    }
    else if (axis[i] == 0.0)
    {
      projected[i] = isLine ? origin[i] : position[i];
    }
  }
  return projected;
}
} // namespace

SurfacePointMoves::SurfacePointMoves(const DynamicTetrahedralization& mesh,
  const TriangleMesh& surface, const std::vector<Vec3>& points, const IdLists& pointTriangles,
  const std::vector<StructuralEdge>& edges, const std::vector<StructuralEdge>& keptEdges,
  Rules rules, bool isRecording)
  : Mesh(mesh), Surface(surface), Points(points), PointTriangles(pointTriangles), Edges(edges),
    KeptEdges(keptEdges), Given(std::move(rules)), IsCorner(points.size(), 0),
    IsRecording(isRecording)
{
  Box box;
  for (const Vec3& point : surface.Points)
  {
    box.Add(point);
  }
  this->Flatness = PlaneRatio * Distance(box.Low, box.High);
}

/** The other ends of the structural edges at a point. */
std::vector<Id> SurfacePointMoves::FindEdgeEnds(Id point) const
{
  std::vector<Id> ends;
  for (Id t : this->PointTriangles[point])
  {
    for (Id other : this->Surface.Triangles[t])
    {
      if (other != point && FindStructuralEdge(this->Edges, MakeEdge(point, other)) != nullptr)
      {
        ends.push_back(other);
      }
    }
  }
  SortUnique(ends);
  return ends;
}

/** Whether triangles at a point that are connected across its smooth edges lie in one plane. */
bool SurfacePointMoves::ArePlanar(Id point, const std::vector<Id>& ends) const
{
  const std::vector<Vec3>& points = this->Points;
  for (Id t : this->PointTriangles[point])
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    Vec3 normal = Cross(points[ids[1]] - points[ids[0]], points[ids[2]] - points[ids[0]]);
    normal = (1.0 / Norm(normal)) * normal;
    for (Id other : this->PointTriangles[point])
    {
      const TriangleIds& others = this->Surface.Triangles[other];
      // Neighbors share an edge at the point that is no structural one.
      const bool areNeighbors = std::any_of(others.begin(), others.end(),
        [&](Id id) {
          return id != point && Contains(ids, id) &&
            !std::binary_search(ends.begin(), ends.end(), id);
        });
      if (areNeighbors &&
        std::any_of(others.begin(), others.end(),
          [&](Id id)
          { return std::abs(Dot(points[id] - points[point], normal)) > this->Flatness; }))
      {
        return false;
      }
    }
  }
  return true;
}

bool SurfacePointMoves::FindSupport(Id point, Support& support)
{
  if (this->IsCorner[point] != 0)
  {
    return false;
  }
  const std::vector<Id> ends = this->FindEdgeEnds(point);
  const Vec3& origin = this->Points[point];
  support.IsLine = ends.size() == 2;
  if (support.IsLine)
  {
    const Vec3 u = this->Points[ends[0]] - origin;
    const Vec3 v = this->Points[ends[1]] - origin;
    if (Dot(u, v) > 0.0 || Norm(Cross(u, v)) > LineAngle * Norm(u) * Norm(v))
    {
      return false;
    }
    support.Axis = GetUnitVector(u - v);
  }
  else if (ends.empty())
  {
    double largest = 0.0;
    for (Id t : this->PointTriangles[point])
    {
      const TriangleIds& ids = this->Surface.Triangles[t];
      const Vec3 normal = Cross(
        this->Points[ids[1]] - this->Points[ids[0]], this->Points[ids[2]] - this->Points[ids[0]]);
      if (Norm(normal) > largest)
      {
        largest = Norm(normal);
        support.Axis = GetUnitVector(normal);
      }
    }
  }
  else
  {
    this->IsCorner[point] = 1;
    return false;
  }
  support.Directions = MakeDirections(support.Axis, support.IsLine);
  return this->ArePlanar(point, ends);
}

/**
 * What is known of the tetrahedra at a point, as long as no other point is explored. There may be too
 * many of them for a cavity: hubs of thin disks have thousands, and to list them all took two fifths
 * of the time of a model with such ones.
 */
SurfacePointMoves::Neighborhood& SurfacePointMoves::Explore(Id point)
{
  const auto hub = this->Hubs.find(point);
  Neighborhood& around = hub != this->Hubs.end() ? hub->second : this->Last;
  if (hub == this->Hubs.end())
  {
    around.IsMovable = this->FindSupport(point, around.Free);
    around.Star.clear();
    if (around.IsMovable)
    {
      around.IsMovable = this->Mesh.FindWholeStar(point, LargestCavity, around.Star);
    }
    if (around.IsMovable)
    {
      this->Tetrahedra = around.Star;
      this->MarkInside();
      this->CollectFacets(point, around.AtPoint);
      this->CollectPoints(point, this->Points[point], around.AtPoint.Inside);
      this->MeasureStar(point, around);
    }
  }
  if (this->IsRecording)
  {
    this->Visited.insert(this->Visited.end(), around.Star.begin(), around.Star.end());
  }
  const bool isNewHub = hub == this->Hubs.end() &&
    this->PointTriangles[point].size() + around.Star.size() > LargestStar;
  return isNewHub ? this->Hubs.emplace(point, around).first->second : around;
}

std::vector<Id> SurfacePointMoves::TakeVisited()
{
  SortUnique(this->Visited);
  return std::exchange(this->Visited, {});
}

void SurfacePointMoves::MeasureStar(Id point, Neighborhood& around) const
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  around.Smallest = 180.0;
  around.Nearest = Infinity;
  for (Id t : around.Star)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    for (Id id : ids)
    {
      if (id != point)
      {
        around.Nearest = std::min(around.Nearest, Distance(mesh.Points[id], mesh.Points[point]));
      }
    }
    around.Smallest = this->Given.GetSmallerAngle(t, around.Smallest);
  }
}

/** Whether each triangle at the point keeps its orientation. */
bool SurfacePointMoves::KeepsOrientations(Id point, const Vec3& position) const
{
  const auto isKept = [&](Id t)
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    const auto getNormal = [&](const Vec3& moved)
    {
      std::array<Vec3, 3> v;
      for (int i = 0; i < 3; ++i)
      {
        v[i] = ids[i] == point ? moved : this->Points[ids[i]];
      }
      return Cross(v[1] - v[0], v[2] - v[0]);
    };
    return Dot(getNormal(this->Points[point]), getNormal(position)) > 0.0;
  };
  const IdLists::Range triangles = this->PointTriangles[point];
  return std::all_of(triangles.begin(), triangles.end(), isKept);
}

/** Whether a facet is one of the surface's triangles. */
bool SurfacePointMoves::IsOnSurface(const TriangleIds& ids) const
{
  return IsTriangle(this->Surface.Triangles, this->PointTriangles, ids);
}

/**
 * Collects the tetrahedra of the star and those in conflict with the position; false if these are too
 * many.
 */
bool SurfacePointMoves::CollectConflicts(const std::vector<Id>& star, const Vec3& position)
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  this->Tetrahedra = star;
  this->MarkInside();
  const Id inside = this->LastMark;
  const Id outside = inside - 1;
  for (std::size_t k = 0; k < this->Tetrahedra.size(); ++k)
  {
    for (Id neighbor : mesh.Neighbors[this->Tetrahedra[k]])
    {
      const Id t = neighbor == NoId ? NoId : neighbor / 4;
      if (t == NoId || this->Marks[t] >= outside)
      {
        continue;
      }
      if (this->IsRecording)
      {
        this->Visited.push_back(t);
      }
      const auto [a, b, c, d] = GetCorners(mesh.Points, mesh.Tetrahedra[t]);
      const bool isInside = InSphere(a, b, c, d, position) >= 0;
      this->Marks[t] = isInside ? inside : outside;
      if (isInside)
      {
        this->Tetrahedra.push_back(t);
      }
    }
    if (this->Tetrahedra.size() > LargestCavity)
    {
      return false;
    }
  }
  return true;
}

/** Gives the tetrahedra collected so far, and no other ones, the mark of those inside. */
void SurfacePointMoves::MarkInside()
{
  this->Marks.resize(this->Mesh.GetMesh().Tetrahedra.size(), 0);
  this->LastMark += 2;
  for (const Id t : this->Tetrahedra)
  {
    this->Marks[t] = this->LastMark;
  }
}

/** Makes a cavity of the marked tetrahedra; false if they reach beyond the boundary. */
bool SurfacePointMoves::CollectFacets(Id point, Surroundings& around) const
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  Cavity& cavity = around.Inside;
  cavity.Border.clear();
  cavity.Regions.clear();
  cavity.Walls.clear();
  around.Outer.clear();
  around.Triangles.clear();
  const auto isAtPoint = [&](const TriangleIds& ids) { return Contains(ids, point); };
  for (Id t : this->Tetrahedra)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    for (int i = 0; i < 4; ++i)
    {
      const TriangleIds facet = GetFacet(ids, i);
      const Id neighbor = mesh.Neighbors[t][i];
      const bool isInside = neighbor != NoId && this->Marks[neighbor / 4] == this->LastMark;
      if (isInside && neighbor / 4 < t)
      {
        // Was looked at from the other side.
        continue;
      }
      const bool isTriangle = this->IsOnSurface(facet);
      if (!isInside && !isTriangle &&
        (neighbor == NoId || mesh.Regions[neighbor / 4] != mesh.Regions[t]))
      {
        // What lies beyond may be in conflict with the new tetrahedra.
        return false;
      }
      if (isTriangle)
      {
        around.Triangles.push_back(facet);
      }
      if (!isInside && !isAtPoint(facet))
      {
        cavity.Border.push_back({ facet[0], facet[2], facet[1] });
        cavity.Regions.push_back(mesh.Regions[t]);
        around.Outer.push_back(neighbor);
      }
      else if (isTriangle)
      {
        cavity.Walls.push_back(facet);
      }
    }
  }
  // Tetrahedra that meet the others in an edge only would be left out.
  return std::count_if(cavity.Walls.begin(), cavity.Walls.end(), isAtPoint) ==
    static_cast<std::ptrdiff_t>(this->PointTriangles[point].size());
}

/** Collects the points of the marked tetrahedra. */
void SurfacePointMoves::CollectPoints(Id point, const Vec3& position, Cavity& cavity)
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  this->PointMarks.resize(mesh.Points.size(), 0);
  cavity.Numbers.clear();
  for (Id t : this->Tetrahedra)
  {
    for (Id id : mesh.Tetrahedra[t])
    {
      if (this->PointMarks[id] != this->LastMark)
      {
        this->PointMarks[id] = this->LastMark;
        cavity.Numbers.push_back(id);
      }
    }
  }
  std::sort(cavity.Numbers.begin(), cavity.Numbers.end());
  cavity.Points.clear();
  for (Id id : cavity.Numbers)
  {
    cavity.Points.push_back(id == point ? position : mesh.Points[id]);
  }
}

/**
 * Collects what the position changes; false if that is too much or reaches beyond the boundary.
 */
bool SurfacePointMoves::CollectCavity(Id point, const std::vector<Id>& star, const Vec3& position)
{
  if (!this->CollectConflicts(star, position) || !this->CollectFacets(point, this->Around))
  {
    return false;
  }
  this->CollectPoints(point, position, this->Around.Inside);
  return true;
}

/** Whether the position is as far as it has to be from the points of a cavity. */
bool SurfacePointMoves::IsClear(Id point, const Vec3& position, const Cavity& cavity) const
{
  for (std::size_t i = 0; i < cavity.Numbers.size(); ++i)
  {
    const Id id = cavity.Numbers[i];
    if (id != point && Distance(position, cavity.Points[i]) < this->Given.GetClearance(id))
    {
      return false;
    }
  }
  return true;
}

/**
 * Whether the smallest spheres of the triangles at a cavity, and of their kept edges, are empty. A
 * triangle for which they are not comes to the front: it is likely to be the next one, too.
 */
bool SurfacePointMoves::AreSpheresEmpty(Id point, const Vec3& position, Surroundings& around) const
{
  const Cavity& cavity = around.Inside;
  const auto getPoint = [&](Id id) { return id == point ? position : this->Points[id]; };
  const auto isEmpty = [&](const auto& ids, const auto& isInside)
  {
    if (!Contains(ids, point))
    {
      return !isInside(position);
    }
    for (std::size_t i = 0; i < cavity.Numbers.size(); ++i)
    {
      if (!Contains(ids, cavity.Numbers[i]) && isInside(cavity.Points[i]))
      {
        return false;
      }
    }
    return true;
  };
  const auto isTriangleEmpty = [&](const TriangleIds& ids)
  {
    const std::array<Vec3, 3> v{ getPoint(ids[0]), getPoint(ids[1]), getPoint(ids[2]) };
    const EnclosingBall ball(v[0], v[1], v[2]);
    const auto isInside = [&](const Vec3& other)
    {
      return (!ball.IsUsable() || ball.MayHold(other)) &&
        InEquatorialSphere(v[0], v[1], v[2], other) > 0;
    };
    if (!isEmpty(ids, isInside))
    {
      return false;
    }
    for (int i = 0; i < 3; ++i)
    {
      const EdgeIds edge = MakeEdge(ids[i], ids[(i + 1) % 3]);
      const Vec3& a = v[i];
      const Vec3& b = v[(i + 1) % 3];
      if (FindStructuralEdge(this->KeptEdges, edge) != nullptr &&
        !isEmpty(edge, [&](const Vec3& other) { return InDiametralSphere(a, b, other) > 0; }))
      {
        return false;
      }
    }
    return true;
  };
  const auto full =
    std::find_if_not(around.Triangles.begin(), around.Triangles.end(), isTriangleEmpty);
  if (full == around.Triangles.end())
  {
    return true;
  }
  std::iter_swap(full, around.Triangles.begin());
  return false;
}

/** The smaller one of an angle and that of a tetrahedron, if it counts. */
double SurfacePointMoves::GetSmallerAngle(
  double angle, const TetrahedronIds& ids, Id region, const std::array<Vec3, 4>& corners) const
{
  const double own = GetSmallestDihedralAngle(corners[0], corners[1], corners[2], corners[3]);
  // In that order: whether an angle counts takes longer than the angle.
  return own < std::max(angle, this->Given.WeighedBelow)
    ? std::min(angle, this->Given.Weigh(ids, region, own))
    : angle;
}

/** The corners of a tetrahedron with the point moved. */
std::array<Vec3, 4> SurfacePointMoves::GetMovedCorners(
  const TetrahedronIds& ids, Id point, const Vec3& position) const
{
  std::array<Vec3, 4> v;
  for (int i = 0; i < 4; ++i)
  {
    v[i] = ids[i] == point ? position : this->Mesh.GetPoint(ids[i]);
  }
  return v;
}

/**
 * Whether a tetrahedron that made another position too bad is one of those of the cavity, and makes
 * this position too bad as well.
 */
bool SurfacePointMoves::IsFlatAgain(
  const Spoiler& spoiler, Id point, const Vec3& position, double required) const
{
  const TetrahedronIds& ids = spoiler.Ids;
  const Cavity& cavity = this->Around.Inside;
  const auto isThere = [&](Id id) { return this->PointMarks[id] == this->LastMark; };
  if (spoiler.Region == NoId || !std::all_of(ids.begin(), ids.end(), isThere))
  {
    return false;
  }
  const std::array<Vec3, 4> v = this->GetMovedCorners(ids, point, position);
  if (this->GetSmallerAngle(180.0, ids, spoiler.Region, v) > required ||
    Orientation(v[0], v[1], v[2], v[3]) <= 0)
  {
    return false;
  }
  for (std::size_t i = 0; i < cavity.Numbers.size(); ++i)
  {
    if (!Contains(ids, cavity.Numbers[i]) &&
      InSphere(v[0], v[1], v[2], v[3], cavity.Points[i]) >= 0)
    {
      return false;
    }
  }
  return true;
}

/** Whether a position is too bad for the same reason as one before. */
bool SurfacePointMoves::IsSpoiled(Id point, const Vec3& position, double required) const
{
  return std::any_of(this->Spoilers.begin(), this->Spoilers.end(),
    [&](const Spoiler& spoiler) { return this->IsFlatAgain(spoiler, point, position, required); });
}

double SurfacePointMoves::Rate(
  Id point, const Vec3& position, double required, Neighborhood& around)
{
  // Most positions fail by what is known of the tetrahedra at the point.
  if (!this->KeepsOrientations(point, position) ||
    !this->IsClear(point, position, around.AtPoint.Inside) ||
    !this->AreSpheresEmpty(point, position, around.AtPoint) ||
    !this->CollectCavity(point, around.Star, position) ||
    this->IsSpoiled(point, position, required) ||
    !this->IsClear(point, position, this->Around.Inside) ||
    !this->AreSpheresEmpty(point, position, this->Around))
  {
    return 0.0;
  }
  double smallest = 180.0;
  const auto isLarger = [&](const TetrahedronIds& ids, Id region)
  {
    smallest =
      this->GetSmallerAngle(smallest, ids, region, this->GetMovedCorners(ids, point, position));
    if (smallest <= required && Contains(ids, point))
    {
      std::rotate(this->Spoilers.begin(), this->Spoilers.end() - 1, this->Spoilers.end());
      this->Spoilers.front() = { ids, region };
    }
    return smallest > required;
  };
  if (!this->Filling.Run(this->Around.Inside, isLarger))
  {
    return 0.0;
  }
  const TetMesh& mesh = this->Mesh.GetMesh();
  Id broken = 0;
  for (const CavityCell& cell : this->Filling.GetCells())
  {
    broken += this->Given.BreaksLimit(cell.Ids, this->GetMovedCorners(cell.Ids, point, position));
  }
  for (std::size_t k = 0; k < this->Tetrahedra.size() && broken > 0; ++k)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[this->Tetrahedra[k]];
    broken -= this->Given.BreaksLimit(ids, GetCorners(mesh.Points, ids));
  }
  const bool isAllowed =
    broken <= 0 && (!this->Given.IsAllowed || this->Given.IsAllowed(point, position));
  return isAllowed ? smallest : 0.0;
}

bool SurfacePointMoves::Find(Id point, const TetrahedronIds& sliver, double target, Vec3& position)
{
  Neighborhood& around = this->Explore(point);
  if (!around.IsMovable)
  {
    return false;
  }
  const Vec3& old = this->Points[point];
  const Support& support = around.Free;
  this->Spoilers.fill({});
  Place best{ old, around.Smallest + SmallestGain, false };
  const auto rate = [&](const Vec3& place, double required)
  { return this->Rate(point, place, required, around); };
  for (Id other : sliver)
  {
    if (other != point)
    {
      TryPlace(Project(this->Mesh.GetPoint(other), old, support.Axis, support.IsLine), rate, best);
    }
  }
  if (best.IsFound || !this->Given.IsImmovable(point))
  {
    SearchPlace(
      old, FirstMove * around.Nearest, support.Directions, target, rate, best, this->Given.Effort);
  }
  position = best.Position;
  return best.IsFound;
}

const std::vector<Id>& SurfacePointMoves::Make(
  Id point, const Vec3& position, DynamicTetrahedralization& mesh)
{
  this->CollectCavity(point, this->Explore(point).Star, position);
  this->Filling.Run(this->Around.Inside);
  mesh.SetPoint(point, position);
  mesh.Replace(this->Tetrahedra, this->Around.Outer, this->Filling.GetCells());
  return this->Around.Inside.Numbers;
}

void SurfacePointMoves::Forget(const std::vector<Id>& points)
{
  for (const Id point : points)
  {
    this->Hubs.erase(point);
  }
}

namespace
{
/** A point of the surface and its new position; no point: nothing is moved. */
struct SurfaceMove
{
  Id Point = NoId;
  Vec3 Position;
  /** Points of the sliver for which no better position was found. */
  std::vector<Id> Immovable;
};

/** Moves points of slivers, one sliver after the other; threads look ahead. */
class SliverSurfaceMoves
{
public:
  SliverSurfaceMoves(double target, SliverPlace place, const std::vector<char>& isFree,
    bool areEdgesKept, RefinedMesh& mesh);

  /** Passes over all slivers as long as that is worthwhile. */
  void Run();
  std::vector<Vec3>& GetPoints() { return this->Points; }

private:
  /** Whether a sliver is still there, and not known to be hopeless. */
  bool IsOpen(const Sliver& sliver) const
  {
    return !IsGone(sliver, this->Mesh) && !IsHopeless(sliver, this->GetAttempt(), this->Mesh);
  }
  bool IsSharp() const { return this->Place == SliverPlace::SharpAngle; }
  SliverAttempt GetAttempt() const
  {
    return this->IsSharp() ? SliverAttempt::SharpSurfaceMove : SliverAttempt::SurfaceMove;
  }
  SurfacePointMoves::Rules MakeRules() const;
  const SurfaceMove& Find(std::size_t i);
  bool Mend(std::size_t i);
  /** Whether a pass with so few mended slivers so far is not worth its time. */
  bool IsInVain(std::size_t mended, std::size_t seen) const
  {
    return this->IsSharp() && seen >= FewestSlivers &&
      static_cast<double>(mended) < LeastRatio * static_cast<double>(seen);
  }

  const double Target;
  const SliverPlace Place;
  const std::vector<char>& IsFree;
  RefinedMesh& Mesh;
  const std::vector<StructuralEdge> NoEdges;
  std::vector<Vec3> Points;
  /** Null as long as there are no slivers at sharp angles to be moved. */
  std::unique_ptr<SurfaceSpheres> Spheres;
  /** One for each thread. */
  std::vector<SurfacePointMoves> Searches;
  std::vector<Sliver> Slivers;
  LookAhead<SurfaceMove> Ahead;
};

SliverSurfaceMoves::SliverSurfaceMoves(double target, SliverPlace place,
  const std::vector<char>& isFree, bool areEdgesKept, RefinedMesh& mesh)
  : Target(target), Place(place), IsFree(isFree), Mesh(mesh),
    Points(mesh.GetBoundary().Surface.Points), Ahead(mesh, SliversPerThread, TetrahedraPerSliver)
{
  const RefinedBoundary& boundary = mesh.GetBoundary();
  const BoundaryShape& shape = mesh.GetShape();
  const SurfacePointMoves::Rules rules = this->MakeRules();
  const int numberOfThreads = mesh.GetThreads().GetNumberOfThreads();
  for (int i = 0; i < numberOfThreads; ++i)
  {
    this->Searches.emplace_back(mesh.GetTetrahedra(), boundary.Surface, this->Points,
      shape.PointTriangles, boundary.Edges, areEdgesKept ? boundary.KeptEdges : this->NoEdges,
      rules, numberOfThreads > 1);
  }
}

SurfacePointMoves::Rules SliverSurfaceMoves::MakeRules() const
{
  const RefinedMesh& mesh = this->Mesh;
  const BoundaryShape& shape = mesh.GetShape();
  const bool isSharp = this->IsSharp();
  SurfacePointMoves::Rules rules;
  rules.Weigh = [&shape, isSharp, this](const TetrahedronIds& ids, Id region, double angle)
  {
    if (isSharp && angle >= this->Target)
    {
      return 180.0;
    }
    const bool isAimed = shape.Sharp.IsAcross(ids, SharpAngleUse::Sliver) == isSharp;
    const double weight = isAimed ? angle : isSharp ? 0.0 : 180.0;
    return weight < 180.0 && shape.Layers.IsAcross(ids, region) ? 180.0 : weight;
  };
  rules.GetSmallerAngle = [&mesh, isSharp](Id t, double angle)
  {
    const double own = mesh.GetAngle(t);
    return own < angle && mesh.IsAcrossSharp(t, SharpAngleUse::Sliver) == isSharp &&
        !mesh.IsInLayer(t)
      ? own
      : angle;
  };
  rules.BreaksLimit = [&mesh](const TetrahedronIds& ids, const std::array<Vec3, 4>& corners)
  { return mesh.BreaksLimit(ids, corners); };
  rules.GetClearance = [&mesh](Id point) { return mesh.GetClearance(point); };
  rules.IsImmovable = [this](Id point) { return this->Mesh.IsImmovable(point, this->Place); };
  if (isSharp)
  {
    rules.WeighedBelow = this->Target;
    rules.IsAllowed = [this](Id point, const Vec3& position)
    { return this->Spheres->StayEmpty(point, position); };
    rules.Effort = SharpEffort;
  }
  return rules;
}

const SurfaceMove& SliverSurfaceMoves::Find(std::size_t i)
{
  const auto find = [this](int thread, std::size_t k, LookAhead<SurfaceMove>::Found& result)
  {
    SurfacePointMoves& search = this->Searches[static_cast<std::size_t>(thread)];
    const TetrahedronIds& ids = this->Mesh.GetMesh().Tetrahedra[this->Slivers[k].Tetrahedron];
    SurfaceMove move;
    search.StartRecord();
    for (const Id id : ids)
    {
      if (this->Mesh.IsInside(id) || this->IsFree[id] == 0)
      {
        continue;
      }
      if (search.Find(id, ids, MoveRatio * this->Target, move.Position))
      {
        move.Point = id;
        break;
      }
      move.Immovable.push_back(id);
    }
    result = { std::move(move), search.TakeVisited() };
  };
  return this->Ahead.Get(
    i, this->Slivers.size(),
    [this](std::size_t k)
    { return this->IsOpen(this->Slivers[k]) ? this->Slivers[k].Tetrahedron : NoId; },
    find);
}

bool SliverSurfaceMoves::Mend(std::size_t i)
{
  const Sliver& sliver = this->Slivers[i];
  if (!this->IsOpen(sliver))
  {
    return false;
  }
  const SurfaceMove& move = this->Find(i);
  this->Mesh.SetImmovable(move.Immovable, this->Place);
  if (move.Point == NoId)
  {
    SetHopeless(sliver, this->GetAttempt(), this->Mesh);
    return false;
  }
  const std::vector<Id>& changed =
    this->Searches.front().Make(move.Point, move.Position, this->Mesh.GetTetrahedra());
  for (SurfacePointMoves& search : this->Searches)
  {
    search.Forget(changed);
  }
  this->Points[move.Point] = move.Position;
  this->Mesh.NoteSurfaceMove();
  return true;
}

void SliverSurfaceMoves::Run()
{
  const int maximum = this->IsSharp() ? MaximumSharpMoves : MaximumSliverPasses;
  const double part = this->IsSharp() ? WorthwhileMoves : 0.0;
  bool isWorthwhile = true;
  for (int pass = 0; pass < maximum && isWorthwhile; ++pass)
  {
    this->Slivers = FindSlivers(this->Target, this->Place, this->Mesh);
    this->Ahead.Clear();
    if (this->IsSharp() && !this->Spheres && !this->Slivers.empty())
    {
      const BoundaryShape& shape = this->Mesh.GetShape();
      this->Spheres = std::make_unique<SurfaceSpheres>(
        this->Mesh.GetBoundary().Surface, shape.PointTriangles, shape.Spheres);
    }
    std::size_t mended = 0;
    for (std::size_t i = 0; i < this->Slivers.size() && !this->IsInVain(mended, i); ++i)
    {
      mended += this->Mend(i) ? 1 : 0;
    }
    isWorthwhile = static_cast<double>(mended) > part * static_cast<double>(this->Slivers.size());
  }
}
} // namespace

std::vector<Vec3> MoveSurfacePoints(double target, SliverPlace place,
  const std::vector<char>& isFree, bool areEdgesKept, RefinedMesh& mesh)
{
  SliverSurfaceMoves moves(target, place, isFree, areEdgesKept, mesh);
  moves.Run();
  return std::move(moves.GetPoints());
}

std::vector<Vec3> RoundSurfacePoints(
  const std::vector<Id>& flat, const std::vector<char>& isFree, RefinedMesh& mesh)
{
  const TriangleMesh& surface = mesh.GetBoundary().Surface;
  SliverMemory& memory = mesh.GetMemory();
  const auto getNames = [&mesh](Id t) { return mesh.GetNames(mesh.GetMesh().Tetrahedra[t]); };
  std::vector<Vec3> positions = surface.Points;
  std::vector<Id> wanted;
  std::copy_if(flat.begin(), flat.end(), std::back_inserter(wanted),
    [&](Id t) { return !memory.IsUnroundable(getNames(t)); });
  if (!wanted.empty())
  {
    const PointRounding rounding(mesh.GetMesh(), surface, flat, wanted, mesh.GetThreads());
    for (Id t : rounding.Move(isFree, positions))
    {
      memory.SetUnroundable(getNames(t));
    }
  }
  return positions;
}
} // namespace cdm
