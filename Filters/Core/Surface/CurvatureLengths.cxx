// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/CurvatureLengths.h"

#include "Core/Basics/IdLists.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cdm
{
namespace
{
/** Secants are compared from this part of the reach on, and the shorter ones do not count. */
constexpr double ShortestSecantRatio = 0.5;
/** A length stands for the points within this part of the reach. */
constexpr double CoveredRatio = 0.25;
/** The part of the secants that may be bent more. */
constexpr double OutlierRatio = 0.1;

/** Bends of the surface around points, and the points that are near. */
class SecantSearch
{
public:
  SecantSearch(const TriangleMesh& surface, const std::vector<StructuralEdge>& chains)
    : Points(surface.Points), Triangles(surface.Triangles),
      PointTriangles(ListTrianglesAtPoints(surface.Triangles, surface.Points.size())),
      Normals(surface.Points.size()), IsOnChain(surface.Points.size(), 0),
      SeenFrom(surface.Points.size(), NoId)
  {
    for (const StructuralEdge& edge : chains)
    {
      this->IsOnChain[edge.Points[0]] = 1;
      this->IsOnChain[edge.Points[1]] = 1;
    }
    for (const TriangleIds& ids : surface.Triangles)
    {
      const Vec3 normal = Cross(
        this->Points[ids[1]] - this->Points[ids[0]], this->Points[ids[2]] - this->Points[ids[0]]);
      for (const Id id : ids)
      {
        this->Normals[id] = this->Normals[id] + normal;
      }
    }
    for (Vec3& normal : this->Normals)
    {
      const double length = Norm(normal);
      normal = length > 0.0 ? (1.0 / length) * normal : normal;
    }
  }

  bool HasNormal(Id point) const { return !this->IsOnChain[point]; }

  /** Finds the points of the facet within a reach of one of them; returns the curvature. */
  double Find(Id point, double reach)
  {
    this->Near = { point };
    this->SeenFrom[point] = point;
    std::vector<double> curvatures;
    for (std::size_t i = 0; i < this->Near.size(); ++i)
    {
      for (const Id triangle : this->PointTriangles[this->Near[i]])
      {
        for (const Id next : this->Triangles[triangle])
        {
          this->See(next, point, reach, curvatures);
        }
      }
    }
    if (curvatures.empty())
    {
      return 0.0;
    }
    const auto place = curvatures.begin() +
      static_cast<std::ptrdiff_t>(
        (1.0 - OutlierRatio) * static_cast<double>(curvatures.size() - 1));
    std::nth_element(curvatures.begin(), place, curvatures.end());
    return *place;
  }

  /** What Find() found. */
  const std::vector<Id>& GetNear() const { return this->Near; }

private:
  /** A point that may be near, and not be seen yet. */
  void See(Id next, Id point, double reach, std::vector<double>& curvatures)
  {
    const double distance = Distance(this->Points[next], this->Points[point]);
    if (this->IsOnChain[next] || this->SeenFrom[next] == point || distance > reach)
    {
      return;
    }
    this->SeenFrom[next] = point;
    this->Near.push_back(next);
    if (distance > ShortestSecantRatio * reach)
    {
      curvatures.push_back(Norm(this->Normals[next] - this->Normals[point]) / distance);
    }
  }

  const std::vector<Vec3>& Points;
  const std::vector<TriangleIds>& Triangles;
  const IdLists PointTriangles;
  std::vector<Vec3> Normals;
  std::vector<char> IsOnChain;
  /** The point from which each one was seen last. */
  std::vector<Id> SeenFrom;
  std::vector<Id> Near;
};
} // namespace

std::vector<double> GetCurvatureLengths(const TriangleMesh& surface,
  const std::vector<StructuralEdge>& chains, const std::vector<double>& reaches, double deviation)
{
  const Id numberOfPoints = static_cast<Id>(surface.Points.size());
  std::vector<double> lengths(numberOfPoints, Infinity);
  std::vector<char> isCovered(numberOfPoints, 0);
  SecantSearch search(surface, chains);
  for (Id point = 0; point < numberOfPoints; ++point)
  {
    if (isCovered[point] || !search.HasNormal(point))
    {
      continue;
    }
    const double bend = std::min(1.0, deviation * search.Find(point, reaches[point]));
    const double length = bend > 0.0 ? deviation * std::sqrt(6.0 / bend - 3.0) : Infinity;
    for (const Id near : search.GetNear())
    {
      if (Distance(surface.Points[near], surface.Points[point]) <= CoveredRatio * reaches[point])
      {
        isCovered[near] = 1;
        lengths[near] = std::min(lengths[near], length);
      }
    }
  }
  return lengths;
}
} // namespace cdm
