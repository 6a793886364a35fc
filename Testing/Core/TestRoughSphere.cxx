// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/RoughSphere.h"
#include "Core/Geometry/Predicates.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace
{
using namespace cdm;

/** What the single precision says of a point, where it is certain. */
struct Counts
{
  int Certain = 0;
  int Wrong = 0;

  void Add(const RoughSphere& sphere, const Vec3& difference, int inside)
  {
    const Determinant<double> power = GetPower(sphere, difference);
    if (std::abs(power.Value) > power.Bound)
    {
      ++this->Certain;
      // The power is negative inside.
      this->Wrong += power.GetSign() != -inside ? 1 : 0;
    }
  }
};

/** Tetrahedra of any size, place and flatness in a box, and points as close to them as one likes. */
class Tetrahedra
{
public:
  explicit Tetrahedra(unsigned seed) : Generator(seed) {}

  void Next()
  {
    const double scale = std::pow(10.0, this->Draw(-9.0, 9.0));
    // Half of them far from the origin, where differences of coordinates are rounded.
    this->Origin = this->Draw(-1.0, 1.0) < 0.0 ? Vec3() : scale * (1e4 * this->DrawPoint());
    const double size = scale * std::pow(10.0, this->Draw(-6.0, 0.0));
    const double flatness = std::pow(10.0, this->Draw(-6.0, 0.0));
    const Vec3 axis = this->DrawPoint();
    for (Vec3& vertex : this->Vertices)
    {
      const Vec3 offset = this->DrawPoint();
      vertex = this->Origin +
        size * (offset - ((1.0 - flatness) * Dot(offset, axis) / SquaredNorm(axis)) * axis);
    }
    this->Size = size;
    // All points are within twice the scale of the origin.
    this->Extent = 4.0 * scale;
    this->Scale = scale;
  }

  /** Anywhere in the box, or near a combination of the vertices by any part of their size. */
  Vec3 DrawNearby()
  {
    if (this->Draw(0.0, 1.0) < 0.2)
    {
      return this->Origin + this->Scale * this->DrawPoint();
    }
    const double s = this->Draw(-2.0, 2.0);
    const double t = this->Draw(-2.0, 2.0);
    return this->Vertices[3] + s * (this->Vertices[0] - this->Vertices[3]) +
      t * (this->Vertices[1] - this->Vertices[3]) +
      std::pow(10.0, this->Draw(-17.0, 0.0)) * this->Size * this->DrawPoint();
  }

  std::array<RelativeVertex, 3> GetRelative(double& size) const
  {
    std::array<RelativeVertex, 3> relative;
    size = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const Vec3 d = this->Vertices[i] - this->Vertices[3];
      relative[i] = { i, d, SquaredNorm(d) };
      size = GetLargest(std::max(size, std::abs(d.X)), std::abs(d.Y), std::abs(d.Z));
    }
    return relative;
  }

  std::array<Vec3, 4> Vertices;
  Vec3 Origin;
  double Size = 0.0;
  double Scale = 0.0;
  double Extent = 0.0;

private:
  double Draw(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Generator);
  }
  Vec3 DrawPoint()
  {
    return { this->Draw(-1.0, 1.0), this->Draw(-1.0, 1.0), this->Draw(-1.0, 1.0) };
  }

  std::mt19937 Generator;
};
} // namespace

TEST(RoughSphere, IsNeverWrongWhereItIsCertain)
{
  const unsigned seed = 4711;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Tetrahedra tetrahedra(seed);
  Counts counts;
  const int total = 200000;
  for (int i = 0; i < total; ++i)
  {
    tetrahedra.Next();
    std::array<Vec3, 4>& v = tetrahedra.Vertices;
    const int orientation = Orientation(v[0], v[1], v[2], v[3]);
    if (orientation == 0)
    {
      continue;
    }
    double size = 0.0;
    const auto relative = tetrahedra.GetRelative(size);
    const Vec3 p = tetrahedra.DrawNearby();
    counts.Add(MakeRoughSphere(relative[0], relative[1], relative[2], size), p - v[3],
      orientation * InSphere(v[0], v[1], v[2], v[3], p));
  }
  EXPECT_EQ(counts.Wrong, 0);
  EXPECT_GT(counts.Certain, total / 3);
}

TEST(RoughSphere, HalfSpacesAreNeverWrongWhereTheyAreCertain)
{
  const unsigned seed = 4712;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Tetrahedra tetrahedra(seed);
  Counts counts;
  const int total = 200000;
  for (int i = 0; i < total; ++i)
  {
    tetrahedra.Next();
    const std::array<Vec3, 4>& v = tetrahedra.Vertices;
    double size = 0.0;
    const auto relative = tetrahedra.GetRelative(size);
    const Vec3 p = tetrahedra.DrawNearby();
    // The vertex at infinity comes first, and the triangle turns counter-clockwise seen from within.
    counts.Add(MakeRoughHalfSpace(relative[0], relative[1], size, tetrahedra.Extent), p - v[3],
      -Orientation(v[0], v[1], v[3], p));
  }
  EXPECT_EQ(counts.Wrong, 0);
  EXPECT_GT(counts.Certain, total / 2);
}

/** Vertices on a line have no half space, and those without size neither. */
TEST(RoughSphere, WithoutAPlaneNothingIsCertain)
{
  const RelativeVertex a{ 0, { 1.0, 2.0, 3.0 }, 14.0 };
  const RelativeVertex b{ 1, { 2.0, 4.0, 6.0 }, 56.0 };
  EXPECT_EQ(MakeRoughHalfSpace(a, b, 6.0, 10.0).Tolerance, NoSphere.Tolerance);
  const RelativeVertex tiny{ 2, { 0.0, 1e-160, 0.0 }, 0.0 };
  const RelativeVertex other{ 3, { 1e-160, 0.0, 0.0 }, 0.0 };
  EXPECT_EQ(MakeRoughHalfSpace(tiny, other, 1e-160, 1.0).Tolerance, NoSphere.Tolerance);
  EXPECT_EQ(MakeRoughHalfSpace(a, tiny, 3.0, 1e-31).Tolerance, NoSphere.Tolerance);
}
