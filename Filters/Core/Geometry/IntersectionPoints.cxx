// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/IntersectionPoints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace cdm
{
namespace
{
// Determinants are trusted up to this relative error.
constexpr double DeterminantError = 1e-14;

/** Exact sums: numbers that do not overlap, in the order of growing size (Shewchuk 1997). */
using Expansion = std::vector<double>;

void AddNumber(Expansion& sum, double number)
{
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sum.size(); ++i)
  {
    const double total = number + sum[i];
    const double virtualPart = total - number;
    const double rest = (number - (total - virtualPart)) + (sum[i] - virtualPart);
    number = total;
    if (rest != 0.0)
    {
      sum[kept++] = rest;
    }
  }
  sum.resize(kept);
  if (number != 0.0)
  {
    sum.push_back(number);
  }
}

Expansion Subtract(double a, double b)
{
  Expansion difference;
  AddNumber(difference, a);
  AddNumber(difference, -b);
  return difference;
}

/** Adds the product of a and b, times sign, to a sum. */
void AddProduct(Expansion& sum, const Expansion& a, const Expansion& b, double sign)
{
  for (const double x : a)
  {
    for (const double y : b)
    {
      const double product = sign * x * y;
      AddNumber(sum, std::fma(sign * x, y, -product));
      AddNumber(sum, product);
    }
  }
}

double Round(const Expansion& sum)
{
  return std::accumulate(sum.begin(), sum.end(), 0.0);
}

/** Twice the area of the triangle projected along an axis; hardly any relative error. */
double GetProjectedArea(int axis, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Expansion sum;
  AddProduct(sum, Subtract(b[u], a[u]), Subtract(c[v], a[v]), 1.0);
  AddProduct(sum, Subtract(b[v], a[v]), Subtract(c[u], a[u]), -1.0);
  return Round(sum);
}

/** Six times the volume of the tetrahedron; hardly any relative error. */
double GetVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  const Vec3 r = d - a;
  const double value = Dot(p, Cross(q, r));
  const auto size = [](double x, double y) { return std::abs(x) + std::abs(y); };
  const double permanent = std::abs(p.X) * size(q.Y * r.Z, q.Z * r.Y) +
    std::abs(p.Y) * size(q.Z * r.X, q.X * r.Z) + std::abs(p.Z) * size(q.X * r.Y, q.Y * r.X);
  if (8.0 * std::numeric_limits<double>::epsilon() * permanent < DeterminantError * std::abs(value))
  {
    return value;
  }
  std::array<Expansion, 3> ab;
  std::array<Expansion, 3> ac;
  std::array<Expansion, 3> ad;
  for (int i = 0; i < 3; ++i)
  {
    ab[i] = Subtract(b[i], a[i]);
    ac[i] = Subtract(c[i], a[i]);
    ad[i] = Subtract(d[i], a[i]);
  }
  Expansion sum;
  for (int i = 0; i < 3; ++i)
  {
    Expansion minor;
    AddProduct(minor, ac[(i + 1) % 3], ad[(i + 2) % 3], 1.0);
    AddProduct(minor, ac[(i + 2) % 3], ad[(i + 1) % 3], -1.0);
    AddProduct(sum, ab[i], minor, 1.0);
  }
  return Round(sum);
}
} // namespace

Vec3 DivideSegment(const Vec3& a, const Vec3& b, double heightA, double heightB)
{
  const double ratio = heightA == heightB ? 0.5 : heightA / (heightA - heightB);
  return ratio <= 0.5 ? a + std::max(ratio, 0.0) * (b - a)
                      : b + std::max(0.0, 1.0 - ratio) * (a - b);
}

Vec3 PierceTriangle(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& triangle)
{
  const auto& [c, d, e] = triangle;
  return DivideSegment(a, b, GetVolume(c, d, e, a), GetVolume(c, d, e, b));
}

Vec3 CrossSegments(int axis, const std::array<Vec3, 2>& segment, const std::array<Vec3, 2>& other)
{
  const auto& [a, b] = segment;
  const auto& [c, d] = other;
  Vec3 p = DivideSegment(a, b, GetProjectedArea(axis, c, d, a), GetProjectedArea(axis, c, d, b));
  // A segment across an axis keeps the point at its level.
  for (int i = 0; i < 3; ++i)
  {
    p[i] = c[i] == d[i] ? c[i] : p[i];
  }
  return p;
}
} // namespace cdm
