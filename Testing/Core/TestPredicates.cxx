// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Predicates.h"

#include <gtest/gtest.h>

#include <gmpxx.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace
{
using namespace cdm;
using Rational = mpq_class;
using Vector = std::array<Rational, 3>;

Vector GetDifference(const Vec3& a, const Vec3& b)
{
  return { Rational(a.X) - Rational(b.X), Rational(a.Y) - Rational(b.Y),
    Rational(a.Z) - Rational(b.Z) };
}

Rational GetDot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Rational GetDeterminant(const Vector& a, const Vector& b, const Vector& c)
{
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
    a[2] * (b[0] * c[1] - b[1] * c[0]);
}

int GetOrientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  return sgn(GetDeterminant(GetDifference(b, a), GetDifference(c, a), GetDifference(d, a)));
}

int GetProjectedOrientation(int axis, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const int x = (axis + 1) % 3;
  const int y = (axis + 2) % 3;
  const Vector u = GetDifference(b, a);
  const Vector v = GetDifference(c, a);
  return sgn(u[x] * v[y] - u[y] * v[x]);
}

int GetInSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e)
{
  const std::array<Vector, 4> p{ GetDifference(a, e), GetDifference(b, e), GetDifference(c, e),
    GetDifference(d, e) };
  const Rational sum = GetDot(p[0], p[0]) * GetDeterminant(p[1], p[2], p[3]) -
    GetDot(p[1], p[1]) * GetDeterminant(p[0], p[2], p[3]) +
    GetDot(p[2], p[2]) * GetDeterminant(p[0], p[1], p[3]) -
    GetDot(p[3], p[3]) * GetDeterminant(p[0], p[1], p[2]);
  return sgn(sum);
}

int GetInDiametralSphere(const Vec3& a, const Vec3& b, const Vec3& p)
{
  return -sgn(GetDot(GetDifference(a, p), GetDifference(b, p)));
}

/** Computed by the circumcenter, a rational point. */
int GetInEquatorialSphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p)
{
  const Vector u = GetDifference(b, a);
  const Vector v = GetDifference(c, a);
  const Vector x = GetDifference(p, a);
  const Rational uu = GetDot(u, u);
  const Rational vv = GetDot(v, v);
  const Rational uv = GetDot(u, v);
  const Rational unit = 2 * (uu * vv - uv * uv);
  const Rational s = vv * (uu - uv) / unit;
  const Rational t = uu * (vv - uv) / unit;
  const Vector center{ s * u[0] + t * v[0], s * u[1] + t * v[1], s * u[2] + t * v[2] };
  return sgn(2 * GetDot(x, center) - GetDot(x, x));
}

/** Sets of five points, most of which are degenerate or nearly so, of all sizes of numbers. */
class NearlyDegeneratePoints
{
public:
  explicit NearlyDegeneratePoints(std::uint64_t seed) : Generator(seed) {}

  std::array<Vec3, 5> Get()
  {
    std::array<Vec3, 5> points;
    const int bits = 2 + this->GetInteger(51);
    const int kind = this->GetInteger(6);
    const double scale = std::ldexp(1.0, this->GetInteger(80) - 40);
    const Vec3 corner = this->GetPoint(bits);
    const Vec3 size = this->GetPoint(bits);
    const double angle = this->GetUniform();
    for (Vec3& p : points)
    {
      p = this->GetPoint(bits);
      if (kind == 1 || kind == 2)
      {
        // Corners of a box.
        p = { corner.X + this->GetInteger(2) * size.X, corner.Y + this->GetInteger(2) * size.Y,
          corner.Z + this->GetInteger(2) * size.Z };
      }
      if (kind == 2 || kind == 3)
      {
        // Turned, which rounds them.
        p = { std::cos(angle) * p.X - std::sin(angle) * p.Y,
          std::sin(angle) * p.X + std::cos(angle) * p.Y, p.Z };
      }
      if (kind == 4)
      {
        p = (1.0 / std::sqrt(SquaredNorm(p) + 1e-300)) * p;
      }
      if (kind == 5)
      {
        p.Z = corner.Z;
      }
      p = scale * p;
    }
    if (this->GetInteger(4) == 0)
    {
      double& x = points[this->GetInteger(5)][this->GetInteger(3)];
      x = std::nextafter(x, 2.0 * x + 1.0);
    }
    return points;
  }

private:
  int GetInteger(int count) { return static_cast<int>(this->Generator() % count); }
  double GetUniform() { return std::ldexp(double(this->Generator() >> 11), -53); }
  /** Multiples of two to the power of minus the bits, in [-1, 1]. */
  Vec3 GetPoint(int bits)
  {
    const auto get = [this, bits]()
    { return std::ldexp(std::floor(std::ldexp(2.0 * this->GetUniform() - 1.0, bits)), -bits); };
    const double x = get();
    const double y = get();
    return { x, y, get() };
  }

  std::mt19937_64 Generator;
};

TEST(Predicates, AreExact)
{
  const std::uint64_t seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  NearlyDegeneratePoints sets(seed);
  int zeros = 0;
  int equatorialZeros = 0;
  int diametralZeros = 0;
  int projectedZeros = 0;
  for (int i = 0; i < 50000; ++i)
  {
    const auto [a, b, c, d, e] = sets.Get();
    const int side = GetOrientation(a, b, c, d);
    ASSERT_EQ(Orientation(a, b, c, d), side) << i;
    ASSERT_EQ(ExactOrientation(a, b, c, d), side) << i;
    const int position = GetInSphere(a, b, c, d, e);
    ASSERT_EQ(InSphere(a, b, c, d, e), position) << i;
    ASSERT_EQ(ExactInSphere(a, b, c, d, e), position) << i;
    zeros += position == 0 ? 1 : 0;
    const int diametral = GetInDiametralSphere(a, b, c);
    ASSERT_EQ(InDiametralSphere(a, b, c), diametral) << i;
    diametralZeros += diametral == 0 ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      // The middle of two points is on a line with them, but for rounding.
      for (const Vec3& p : { c, 0.5 * (a + b) })
      {
        const int projected = GetProjectedOrientation(axis, a, b, p);
        ASSERT_EQ(ProjectedOrientation(axis, a, b, p), projected) << i;
        projectedZeros += projected == 0 ? 1 : 0;
      }
    }
    if (!AreCollinear(a, b, c))
    {
      const int equatorial = GetInEquatorialSphere(a, b, c, d);
      ASSERT_EQ(InEquatorialSphere(a, b, c, d), equatorial) << i;
      equatorialZeros += equatorial == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(zeros, 5000);
  EXPECT_GT(diametralZeros, 1000);
  EXPECT_GT(equatorialZeros, 1000);
  EXPECT_GT(projectedZeros, 20000);
}

TEST(Predicates, HaveTheSignsTheyAreDocumentedWith)
{
  const Vec3 a{ 0.0, 0.0, 0.0 };
  const Vec3 b{ 1.0, 0.0, 0.0 };
  const Vec3 c{ 0.0, 1.0, 0.0 };
  const Vec3 d{ 0.0, 0.0, 1.0 };
  EXPECT_EQ(Orientation(a, b, c, d), 1);
  EXPECT_EQ(InSphere(a, b, c, d, { 0.5, 0.5, 0.5 }), 1);
  EXPECT_EQ(InSphere(a, b, c, d, { 1.0, 1.0, 1.0 }), 0);
  EXPECT_EQ(InSphere(a, b, c, d, { 1.0, 1.0, 1.5 }), -1);
}

TEST(Predicates, CopeWithTheLimitsOfDoubles)
{
  // Denormal numbers, and determinants that overflow or vanish in floating point.
  for (const double scale : { 4.9406564584124654e-324, 1e-300, 1e-150, 1e150, 1e300 })
  {
    const Vec3 a{ 0.0, 0.0, 0.0 };
    const Vec3 b{ scale, 0.0, 0.0 };
    const Vec3 c{ 0.0, scale, 0.0 };
    const Vec3 d{ 0.0, 0.0, scale };
    EXPECT_EQ(Orientation(a, b, c, d), 1) << scale;
    EXPECT_EQ(Orientation(a, c, b, d), -1) << scale;
    EXPECT_EQ(InSphere(a, b, c, d, { scale, scale, scale }), 0) << scale;
    EXPECT_EQ(InSphere(a, b, c, d, { scale, scale, 2.0 * scale }), -1) << scale;
    EXPECT_EQ(InDiametralSphere(b, c, a), 0) << scale;
    EXPECT_EQ(InDiametralSphere(a, b, c), -1) << scale;
    EXPECT_EQ(InEquatorialSphere(a, b, c, { scale, scale, 0.0 }), 0) << scale;
    EXPECT_EQ(InEquatorialSphere(b, c, d, a), 1) << scale;
    EXPECT_EQ(InEquatorialSphere(b, c, d, { scale, scale, scale }), -1) << scale;
  }
}
} // namespace
