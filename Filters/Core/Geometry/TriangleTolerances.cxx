// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/TriangleTolerances.h"

#include "Core/Geometry/IntersectionPoints.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
double GetHeight(const std::vector<Vec3>& points, Id point, const TriangleIds& t)
{
  const Vec3& a = points[t[0]];
  const Vec3 normal = Cross(points[t[1]] - a, points[t[2]] - a);
  const double length = Norm(normal);
  return length > 0.0 ? std::abs(Dot(normal, points[point] - a)) / length : 0.0;
}

bool IsNearPlane(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t, double tolerance)
{
  return std::all_of(
    s.begin(), s.end(), [&](Id id) { return GetHeight(points, id, t) <= tolerance; });
}

double GetOverlapWidth(const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t)
{
  // Cut s along the edges of t, with heights above them in the plane of t.
  const Vec3& origin = points[t[0]];
  const Vec3 normal = Cross(points[t[1]] - origin, points[t[2]] - origin);
  std::vector<Vec3> polygon{ points[s[0]], points[s[1]], points[s[2]] };
  std::vector<Vec3> rest;
  for (int i = 0; i < 3 && !polygon.empty(); ++i)
  {
    const Vec3& a = points[t[i]];
    const Vec3 inwards = Cross(normal, points[t[(i + 1) % 3]] - a);
    rest.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k)
    {
      const Vec3& p = polygon[k];
      const Vec3& q = polygon[(k + 1) % polygon.size()];
      const double heightP = Dot(inwards, p - a);
      const double heightQ = Dot(inwards, q - a);
      if (heightP >= 0.0)
      {
        rest.push_back(p);
      }
      if ((heightP < 0.0) != (heightQ < 0.0))
      {
        rest.push_back(DivideSegment(p, q, heightP, heightQ));
      }
    }
    polygon.swap(rest);
  }
  Vec3 area;
  double longest = 0.0;
  for (std::size_t k = 1; k < polygon.size(); ++k)
  {
    area = area + Cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
    longest =
      std::max({ longest, Distance(polygon[k], polygon[k - 1]), Distance(polygon[k], polygon[0]) });
  }
  return longest > 0.0 ? Norm(area) / longest : 0.0;
}

int FindLongestEdge(const std::vector<Vec3>& points, const TriangleIds& t)
{
  int longest = 0;
  double length = -1.0;
  for (int i = 0; i < 3; ++i)
  {
    const double candidate = SquaredNorm(points[t[(i + 1) % 3]] - points[t[i]]);
    if (candidate > length)
    {
      longest = i;
      length = candidate;
    }
  }
  return longest;
}

bool IsNeedle(const std::vector<Vec3>& points, const TriangleIds& t, double tolerance)
{
  const int i = FindLongestEdge(points, t);
  const Vec3& a = points[t[i]];
  const Vec3& b = points[t[(i + 1) % 3]];
  const Vec3& apex = points[t[(i + 2) % 3]];
  return Norm(Cross(b - a, apex - a)) <= tolerance * Distance(a, b) &&
    std::min(Distance(apex, a), Distance(apex, b)) > 2.0 * tolerance;
}
} // namespace cdm
