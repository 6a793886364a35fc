// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/PointRounding.h"

#include "Core/Basics/CollectItems.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Search/PlaceSearch.h"
#include "Core/Surface/StructuralEdges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace cdm
{
namespace
{
/**
 * A fourth point is cocircular if it is this close to the plane and the circle, in radii: far more
 * than rounding.
 */
constexpr double RoundingRatio = 1e-8;
/** Cells whose centers are closer, in radii, are one degenerate cell. */
constexpr double SameCellRatio = 1e-3;
/** Largest move along each axis, in units in the last place. */
constexpr int MaximumSteps = 4;
/** Distance of a sphere's center from the span of the others, in lengths of it, that is enough. */
constexpr double EnoughMargin = 1.0;
/** A thread lists so many tetrahedra at a time. */
constexpr std::size_t TetrahedraInPart = 8192;

/** The circle through three points. */
class Circle
{
public:
  Circle(const Vec3& a, const Vec3& b, const Vec3& c)
    : A(a), B(b), C(c), Normal(Cross(b - a, c - a))
  {
    // The radius is the product of all edges by twice the length of the normal.
    const double height2 = 0.25 * SquaredNorm(b - a) * SquaredNorm(c - a) * SquaredNorm(b - c);
    this->LargestHeight2 = RoundingRatio * RoundingRatio * height2;
  }

  /** Whether a point is on it but for rounding. Most are not even in the plane. */
  bool IsOn(const Vec3& point) const
  {
    const double height = Dot(point - this->A, this->Normal);
    if (!(height * height < this->LargestHeight2))
    {
      return false;
    }
    const Vec3 center = GetCircumcenter(this->A, this->B, this->C);
    const double radius = Distance(center, this->A);
    return std::abs(Distance(point, center) - radius) < RoundingRatio * radius;
  }

private:
  const Vec3 A;
  const Vec3 B;
  const Vec3 C;
  const Vec3 Normal;
  /**
   * The largest height above the plane that counts as none, times the length of the normal, squared.
   */
  double LargestHeight2;
};

/** Lists points of the surface that are used, each with a tetrahedron at it, by tetrahedra. */
std::vector<std::pair<Id, Id>> ListStars(
  const TetMesh& mesh, const std::vector<char>& isUsed, ThreadTeam& team)
{
  using Pair = std::pair<Id, Id>;
  const Id numberOfPoints = static_cast<Id>(isUsed.size());
  const auto list = [&](std::size_t begin, std::size_t end, std::vector<Pair>& pairs)
  {
    for (std::size_t t = begin; t < end; ++t)
    {
      const TetrahedronIds& ids = mesh.Tetrahedra[t];
      for (int i = 0; i < 4 && ids[0] != NoId; ++i)
      {
        if (ids[i] < numberOfPoints && isUsed[ids[i]] != 0)
        {
          pairs.emplace_back(ids[i], static_cast<Id>(t));
        }
      }
    }
  };
  return CollectItems<Pair>(team, mesh.Tetrahedra.size(), TetrahedraInPart, list);
}
} // namespace

PointRounding::PointRounding(const TetMesh& mesh, const TriangleMesh& surface,
  const std::vector<Id>& flat, const std::vector<Id>& wanted, ThreadTeam& team)
  : Mesh(mesh), Surface(surface), Wanted(wanted), IsFlat(mesh.Tetrahedra.size(), 0)
{
  const Id numberOfPoints = static_cast<Id>(surface.Points.size());
  std::vector<char> isUsed(surface.Points.size(), 0);
  for (Id t : flat)
  {
    this->IsFlat[t] = 1;
  }
  for (Id t : wanted)
  {
    for (Id point : mesh.Tetrahedra[t])
    {
      isUsed[point] = 1;
    }
  }
  this->Stars.Build(numberOfPoints, ListStars(mesh, isUsed, team));
  std::vector<std::pair<Id, Id>> pairs;
  for (Id t = 0; t < static_cast<Id>(surface.Triangles.size()); ++t)
  {
    for (Id point : surface.Triangles[t])
    {
      if (isUsed[point])
      {
        pairs.emplace_back(point, t);
      }
    }
  }
  this->Triangles.Build(numberOfPoints, pairs);
}

Vec3 PointRounding::GetCenter(Id tetrahedron) const
{
  const auto [a, b, c, d] = GetCorners(this->Mesh.Points, this->Mesh.Tetrahedra[tetrahedron]);
  return GetCircumcenter(a, b, c, d);
}

/**
 * @param cells on both sides of the quadrangle that are not flat
 * @param isComplete whether these are all; at an outer facet the other side is as if mirrored
 * @return false if both sides are one degenerate cell, or none is known
 */
bool PointRounding::AddQuadrangle(const std::vector<Vec3>& points, const std::array<Id, 3>& others,
  const std::vector<Id>& cells, bool isComplete, std::vector<Quadrangle>& quadrangles) const
{
  Quadrangle quadrangle;
  quadrangle.Corner = points[others[0]];
  const WideVec3 u = WideVec3::FromDifference(points[others[1]], quadrangle.Corner);
  const WideVec3 v = WideVec3::FromDifference(points[others[2]], quadrangle.Corner);
  const WideVec3 normal = Cross(u, v);
  const long double square = Dot(normal, normal);
  const WideVec3 first = Cross(normal, u);
  const WideVec3 second = Cross(v, normal);
  quadrangle.Center = (Dot(v, v) * first + Dot(u, u) * second) / (2.0L * square);
  quadrangle.Normal = normal / std::sqrt(square);
  const Vec3 center = quadrangle.Corner + quadrangle.Center.Round();
  if (cells.empty() || !IsFinite(center))
  {
    return false;
  }
  const double smallest = SameCellRatio * Norm(quadrangle.Center.Round());
  quadrangle.Low = Infinity;
  quadrangle.High = -quadrangle.Low;
  for (Id cell : cells)
  {
    const double height = Dot(this->GetCenter(cell) - center, quadrangle.Normal.Round());
    quadrangle.Low = std::min(quadrangle.Low, height);
    quadrangle.High = std::max(quadrangle.High, height);
  }
  if (!isComplete)
  {
    quadrangle.High = std::max(std::abs(quadrangle.Low), std::abs(quadrangle.High)) + smallest;
    quadrangle.Low = -quadrangle.High;
  }
  if (!(quadrangle.High - quadrangle.Low >= smallest))
  {
    return false;
  }
  quadrangles.push_back(quadrangle);
  return true;
}

std::vector<PointRounding::Quadrangle> PointRounding::FindQuadrangles(
  Id point, const std::vector<Vec3>& points) const
{
  const Id numberOfPoints = static_cast<Id>(points.size());
  std::vector<Id> around;
  for (Id t : this->Stars[point])
  {
    for (Id id : this->Mesh.Tetrahedra[t])
    {
      if (id != point && id < numberOfPoints)
      {
        around.push_back(id);
      }
    }
  }
  SortUnique(around);

  std::vector<Quadrangle> quadrangles;
  std::set<std::array<Id, 3>> known;
  const auto add = [&](std::array<Id, 3> others, const std::vector<Id>& cells, bool isComplete)
  {
    std::sort(others.begin(), others.end());
    if (known.count(others) == 0 &&
      this->AddQuadrangle(points, others, cells, isComplete, quadrangles))
    {
      known.insert(others);
    }
  };
  std::vector<Id> cells;
  for (Id t : this->Stars[point])
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
    const std::array<Id, 4>& neighbors = this->Mesh.Neighbors[t];
    const auto addCell = [&](Id neighbor)
    {
      if (neighbor != NoId && !this->IsFlat[neighbor / 4])
      {
        cells.push_back(neighbor / 4);
      }
    };
    const std::size_t place = std::find(ids.begin(), ids.end(), point) - ids.begin();
    const std::array<Id, 3> others{ ids[(place + 1) % 4], ids[(place + 2) % 4],
      ids[(place + 3) % 4] };
    cells.clear();
    if (this->IsFlat[t])
    {
      std::for_each(neighbors.begin(), neighbors.end(), addCell);
      add(others, cells, cells.size() == neighbors.size());
      continue;
    }
    for (std::size_t i = 1; i < 4; ++i)
    {
      // A facet at the point, and what lies with it on a circle.
      const std::array<Id, 2> ends{ others[i % 3], others[(i + 1) % 3] };
      const Id beyond = neighbors[(place + 1 + (i + 2) % 3) % 4];
      const bool isDone = beyond != NoId && beyond / 4 < t && !this->IsFlat[beyond / 4];
      if (isDone || std::max(ends[0], ends[1]) >= numberOfPoints)
      {
        continue;
      }
      cells.assign(1, t);
      addCell(beyond);
      const Circle circle(points[point], points[ends[0]], points[ends[1]]);
      for (Id other : around)
      {
        if (other != ends[0] && other != ends[1] && circle.IsOn(points[other]))
        {
          add({ ends[0], ends[1], other }, cells, cells.size() == 2);
        }
      }
    }
  }
  return quadrangles;
}

/**
 * Ways to the corners, edges and facets of a cube around the point, along axes on which it may move:
 * no facet at it lies across them. All positions within the cube, seven times as many, found no
 * more.
 */
std::vector<Vec3> PointRounding::FindDirections(Id point) const
{
  std::array<bool, 3> isFree{ true, true, true };
  for (Id t : this->Triangles[point])
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    const Vec3& a = this->Surface.Points[ids[0]];
    const Vec3& b = this->Surface.Points[ids[1]];
    const Vec3& c = this->Surface.Points[ids[2]];
    for (int axis = 0; axis < 3; ++axis)
    {
      isFree[axis] = isFree[axis] && !(a[axis] == b[axis] && a[axis] == c[axis]);
    }
  }
  std::vector<Vec3> directions = MakeCubeDirections();
  directions.erase(std::remove_if(directions.begin(), directions.end(),
                     [&isFree](const Vec3& direction)
                     {
                       return (!isFree[0] && direction.X != 0.0) ||
                         (!isFree[1] && direction.Y != 0.0) || (!isFree[2] && direction.Z != 0.0);
                     }),
    directions.end());
  return directions;
}

/**
 * Distance of the spheres' centers from the span of the two cells' centers, in lengths of that
 * span: the smallest over all quadrangles. Not positive if a flat tetrahedron fits in.
 *
 * Most positions do not reach what is required: then any smaller value is returned, as soon as a
 * quadrangle shows it. That one comes first for the next position, which is near.
 */
double PointRounding::Rate(
  const Vec3& position, double required, std::vector<Quadrangle>& quadrangles)
{
  double smallest = EnoughMargin;
  for (std::size_t i = 0; i < quadrangles.size(); ++i)
  {
    const Quadrangle& quadrangle = quadrangles[i];
    const WideVec3 way = WideVec3::FromDifference(position, quadrangle.Corner);
    const long double power = 0.5L * Dot(way, way) - Dot(way, quadrangle.Center);
    const long double height = Dot(way, quadrangle.Normal);
    if (height == 0.0L && power != 0.0L)
    {
      continue;
    }
    // Not a number if the position is exact.
    const double center = static_cast<double>(power / height);
    const double span = quadrangle.High - quadrangle.Low;
    const double margin = center < quadrangle.Low ? (quadrangle.Low - center) / span
      : center > quadrangle.High                  ? (center - quadrangle.High) / span
                                                  : 0.0;
    smallest = std::min(smallest, margin);
    if (smallest <= required)
    {
      std::swap(quadrangles.front(), quadrangles[i]);
      break;
    }
  }
  return smallest;
}

std::vector<Id> PointRounding::Move(
  const std::vector<char>& isFree, std::vector<Vec3>& points) const
{
  const double largest = GetLargestCoordinate(points);
  const double step =
    std::ldexp(std::numeric_limits<double>::epsilon(), largest > 0.0 ? std::ilogb(largest) : 0);
  std::vector<char> isMoved(points.size(), 0);
  std::vector<Id> left;
  for (Id t : this->Wanted)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
    if (std::any_of(ids.begin(), ids.end(), [&](Id id) { return isMoved[id]; }))
    {
      continue;
    }
    Id moved = NoId;
    Vec3 best;
    double margin = 0.0;
    for (Id point : ids)
    {
      if (!isFree[point])
      {
        continue;
      }
      std::vector<Quadrangle> quadrangles = this->FindQuadrangles(point, points);
      const std::vector<Vec3> directions = this->FindDirections(point);
      for (int length = 1; length <= MaximumSteps && margin < EnoughMargin; ++length)
      {
        for (const Vec3& direction : directions)
        {
          const Vec3 position = points[point] + (length * step) * direction;
          const double rating = Rate(position, margin, quadrangles);
          if (rating > margin)
          {
            margin = rating;
            best = position;
            moved = point;
          }
        }
      }
    }
    if (moved == NoId)
    {
      left.push_back(t);
      continue;
    }
    points[moved] = best;
    isMoved[moved] = 1;
  }
  return left;
}
} // namespace cdm
