// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Measures.h"

#include "Core/Basics/Types.h"

#include <algorithm>

namespace cdm
{
namespace
{
/** Infinite instead of a division by zero, which a debugger or a sanitizer would report. */
Vec3 Divide(const Vec3& vector, double divisor)
{
  if (divisor == 0.0)
  {
    return { Infinity, Infinity, Infinity };
  }
  return { vector.X / divisor, vector.Y / divisor, vector.Z / divisor };
}

/**
 * Sines and cosines, up to a factor, of the dihedral angles at the edges ab, ac, ad, bc, bd, cd.
 */
struct DihedralSides
{
  DihedralSides(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
  {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ad = d - a;
    const Vec3 bc = c - b;
    const Vec3 bd = d - b;
    // Normals of the facets opposite to a, b, c, d, all to the same side (inside or outside).
    const Vec3 normalA = Cross(bc, bd);
    const Vec3 normalB = Cross(ad, ac);
    const Vec3 normalC = Cross(ab, ad);
    const Vec3 normalD = Cross(ac, ab);
    this->SixVolumes = std::abs(Dot(normalD, ad));
    this->SquaredLengths = { SquaredNorm(ab), SquaredNorm(ac), SquaredNorm(ad), SquaredNorm(bc),
      SquaredNorm(bd), SquaredNorm(d - c) };
    this->Products = { Dot(normalC, normalD), Dot(normalB, normalD), Dot(normalB, normalC),
      Dot(normalA, normalD), Dot(normalA, normalC), Dot(normalA, normalB) };
  }

  double GetAngle(int edge) const
  {
    // n x m of the facets' normals is the edge times six volumes: that is the sine.
    const double length = std::sqrt(this->SquaredLengths[edge]);
    return std::atan2(this->SixVolumes * length, 0.0 - this->Products[edge]) * DegreesPerRadian;
  }

  double SixVolumes;
  std::array<double, 6> SquaredLengths;
  /** Scalar product of the normals of the two facets at each edge. */
  std::array<double, 6> Products;
};
} // namespace

double GetSignedVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  return Dot(Cross(b - a, c - a), d - a) / 6.0;
}

double GetTriangleArea(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return 0.5 * Norm(Cross(b - a, c - a));
}

std::array<double, 6> GetDihedralAngles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const DihedralSides sides(a, b, c, d);
  return { sides.GetAngle(0), sides.GetAngle(1), sides.GetAngle(2), sides.GetAngle(3),
    sides.GetAngle(4), sides.GetAngle(5) };
}

double GetDihedralAngle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int edge)
{
  return DihedralSides(a, b, c, d).GetAngle(edge);
}

double GetSmallestDihedralTangent2(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const DihedralSides sides(a, b, c, d);
  if (sides.SixVolumes == 0.0)
  {
    return 0.0;
  }
  // The smallest angle is acute, and has the largest cotangent.
  double cotangent2 = 0.0;
  for (int i = 0; i < 6; ++i)
  {
    const double product = std::min(sides.Products[i], 0.0);
    cotangent2 = std::max(cotangent2, product / sides.SquaredLengths[i] * product);
  }
  return sides.SixVolumes * sides.SixVolumes / cotangent2;
}

double GetSmallestDihedralAngle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  return std::atan(std::sqrt(GetSmallestDihedralTangent2(a, b, c, d))) * DegreesPerRadian;
}

double GetSmallestHeight(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const double largestArea = std::max({ GetTriangleArea(b, c, d), GetTriangleArea(a, c, d),
    GetTriangleArea(a, b, d), GetTriangleArea(a, b, c) });
  return largestArea == 0.0 ? 0.0 : 3.0 * std::abs(GetSignedVolume(a, b, c, d)) / largestArea;
}

Vec3 GetCircumcenterOffset(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 normal = Cross(ab, ac);
  return Divide(
    Cross(normal, SquaredNorm(ac) * ab - SquaredNorm(ab) * ac), 2.0 * SquaredNorm(normal));
}

Vec3 GetCircumcenter(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return a + GetCircumcenterOffset(a, b, c);
}

double GetDistanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 normal = Cross(b - a, c - a);
  const Vec3 edges[3] = { b - a, c - b, a - c };
  const Vec3 arms[3] = { p - a, p - b, p - c };
  bool isAbove = true;
  for (int i = 0; i < 3; ++i)
  {
    isAbove = isAbove && Dot(normal, Cross(edges[i], arms[i])) >= 0.0;
  }
  if (isAbove)
  {
    return std::abs(Dot(normal, arms[0])) / Norm(normal);
  }
  double square = Infinity;
  for (int i = 0; i < 3; ++i)
  {
    const double along =
      std::min(std::max(Dot(arms[i], edges[i]) / SquaredNorm(edges[i]), 0.0), 1.0);
    square = std::min(square, SquaredNorm(arms[i] - along * edges[i]));
  }
  return std::sqrt(square);
}

Vec3 GetBarycentricWeights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 normal = Cross(b - a, c - a);
  const double square = SquaredNorm(normal);
  const double weightB = Dot(normal, Cross(p - a, c - a)) / square;
  const double weightC = Dot(normal, Cross(b - a, p - a)) / square;
  return { 1.0 - weightB - weightC, weightB, weightC };
}

Vec3 GetCircumcenter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ad = d - a;
  const Vec3 sum = SquaredNorm(ad) * Cross(ab, ac) + SquaredNorm(ac) * Cross(ad, ab) +
    SquaredNorm(ab) * Cross(ac, ad);
  return a + Divide(sum, 2.0 * Dot(ab, Cross(ac, ad)));
}
} // namespace cdm
