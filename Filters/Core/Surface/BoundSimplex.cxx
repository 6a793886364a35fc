// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/BoundSimplex.h"

#include "Core/Geometry/Box.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Surface/StructuralEdges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
namespace
{
/** A height above a plane or line has an error of so many times the largest coordinate. */
constexpr double Rounding = 8.0 * std::numeric_limits<double>::epsilon();

Vec3 FindNearestOnSegment(const Vec3& a, const Vec3& b, const Vec3& position)
{
  const Vec3 edge = b - a;
  const double square = SquaredNorm(edge);
  const double along = square > 0.0 ? Dot(position - a, edge) / square : 0.0;
  return along <= 0.0 ? a : along >= 1.0 ? b : a + along * edge;
}

/** Height above a plane of the farthest corner; infinity if a triangle is turned over. */
double GetThickness(
  const std::vector<BoundSimplex>& triangles, const Vec3& origin, const Vec3& normal)
{
  double thickness = 0.0;
  for (const BoundSimplex& triangle : triangles)
  {
    const auto& [a, b, c] = triangle.Corners;
    if (!(Dot(GetAreaVector(a, b, c), normal) > 0.0))
    {
      return Infinity;
    }
    for (const Vec3& corner : triangle.Corners)
    {
      thickness = std::max(thickness, std::abs(Dot(corner - origin, normal)));
    }
  }
  return thickness;
}

/** The ends of a path of segments in any order; more or less than two if it is none. */
std::vector<Vec3> GetEnds(const std::vector<BoundSimplex>& segments)
{
  std::vector<Vec3> ends;
  for (const BoundSimplex& segment : segments)
  {
    for (int i = 0; i < 2; ++i)
    {
      const auto same = std::find(ends.begin(), ends.end(), segment.Corners[i]);
      if (same == ends.end())
      {
        ends.push_back(segment.Corners[i]);
      }
      else
      {
        ends.erase(same);
      }
    }
  }
  return ends;
}

/** How far some segments are from the one between two ends. */
double GetThickness(const std::vector<BoundSimplex>& segments, const std::vector<Vec3>& ends)
{
  double thickness = 0.0;
  for (const BoundSimplex& segment : segments)
  {
    for (int i = 0; i < 2; ++i)
    {
      const Vec3& corner = segment.Corners[i];
      thickness =
        std::max(thickness, Distance(corner, FindNearestOnSegment(ends[0], ends[1], corner)));
    }
  }
  return thickness;
}

double GetSegmentShift(
  const std::vector<BoundSimplex>& removed, const std::vector<BoundSimplex>& added)
{
  const std::vector<Vec3> ends = GetEnds(removed);
  const std::vector<Vec3> addedEnds = GetEnds(added);
  const auto isEnd = [&ends](const Vec3& end)
  { return std::find(ends.begin(), ends.end(), end) != ends.end(); };
  return ends.size() == 2 && addedEnds.size() == 2 &&
      std::all_of(addedEnds.begin(), addedEnds.end(), isEnd)
    ? GetThickness(removed, ends) + GetThickness(added, ends)
    : Infinity;
}

double GetTriangleShift(
  const std::vector<BoundSimplex>& removed, const std::vector<BoundSimplex>& added)
{
  Vec3 normal;
  for (const BoundSimplex& triangle : removed)
  {
    const auto& [a, b, c] = triangle.Corners;
    normal = normal + GetAreaVector(a, b, c);
  }
  const double length = Norm(normal);
  if (!(length > 0.0))
  {
    return Infinity;
  }
  normal = (1.0 / length) * normal;
  const Vec3& origin = removed.front().Corners[0];
  return GetThickness(removed, origin, normal) + GetThickness(added, origin, normal);
}
} // namespace

// The position lies in the Voronoi region of a corner, of an edge or of the inside of the triangle.
// Reference: C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5.
Vec3 FindNearestPoint(const std::array<Vec3, 3>& corners, const Vec3& position)
{
  const auto& [a, b, c] = corners;
  if (IsSegment(corners))
  {
    return FindNearestOnSegment(a, b, position);
  }
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = position - a;
  const double abp = Dot(ab, ap);
  const double acp = Dot(ac, ap);
  if (abp <= 0.0 && acp <= 0.0)
  {
    return a;
  }
  const double abab = SquaredNorm(ab);
  const double abac = Dot(ab, ac);
  const double acac = SquaredNorm(ac);
  const double weightB = acac * abp - abac * acp;
  const double weightC = abab * acp - abac * abp;
  const double sum = abab * acac - abac * abac;
  if (sum > 0.0 && weightB > 0.0 && weightC > 0.0 && weightB + weightC < sum)
  {
    return a + (weightB / sum) * ab + (weightC / sum) * ac;
  }
  Vec3 nearest = FindNearestOnSegment(a, b, position);
  for (const Vec3& other :
    { FindNearestOnSegment(b, c, position), FindNearestOnSegment(c, a, position) })
  {
    nearest = SquaredNorm(other - position) < SquaredNorm(nearest - position) ? other : nearest;
  }
  return nearest;
}

double GetShift(const std::vector<BoundSimplex>& removed, const std::vector<BoundSimplex>& added)
{
  if (removed.empty() || added.empty())
  {
    return removed.empty() && added.empty() ? 0.0 : Infinity;
  }
  Box box;
  for (const auto* simplices : { &removed, &added })
  {
    for (const BoundSimplex& simplex : *simplices)
    {
      box.Add(simplex.Corners[0]);
      box.Add(simplex.Corners[1]);
      box.Add(simplex.Corners[2]);
    }
  }
  return Rounding * GetLargestCoordinate({ box.Low, box.High }) +
    (IsSegment(removed.front().Corners) ? GetSegmentShift(removed, added)
                                        : GetTriangleShift(removed, added));
}
} // namespace cdm
