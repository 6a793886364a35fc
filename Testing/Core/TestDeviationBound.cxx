// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/DeviationBound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
constexpr int Corners = 7;

/** Points around the origin: no triangle of them with a point near the origin is turned over. */
std::vector<Vec3> MakeRing(std::mt19937& random)
{
  std::uniform_real_distribution<double> radius(0.7, 1.0);
  std::vector<Vec3> ring;
  for (int i = 0; i < Corners; ++i)
  {
    const double angle = 2.0 * 3.14159265358979 * i / Corners;
    const double r = radius(random);
    ring.push_back({ r * std::cos(angle), r * std::sin(angle), 0.0 });
  }
  return ring;
}

/** Moves a position of the ring to a plane that is turned, and away from the origin. */
Vec3 Place(const Vec3& position)
{
  const Vec3 u{ 2.0 / 3.0, -2.0 / 3.0, 1.0 / 3.0 };
  const Vec3 v{ 1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0 };
  const Vec3 w{ -2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0 };
  return Vec3{ 5.0, 6.0, 7.0 } + position.X * u + position.Y * v + position.Z * w;
}

std::vector<BoundSimplex> MakeFan(const std::vector<Vec3>& ring, const Vec3& center)
{
  std::vector<BoundSimplex> fan;
  for (std::size_t i = 0; i < ring.size(); ++i)
  {
    fan.push_back({ { Place(center), Place(ring[i]), Place(ring[(i + 1) % ring.size()]) }, 0 });
  }
  return fan;
}

std::vector<BoundSimplex> MakePath(const std::vector<Vec3>& points)
{
  std::vector<BoundSimplex> path;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    path.push_back({ { Place(points[i - 1]), Place(points[i]), Place(points[i]) }, 0 });
  }
  return path;
}

double GetDistance(const std::vector<BoundSimplex>& simplices, const Vec3& position)
{
  double smallest = Infinity;
  for (const BoundSimplex& simplex : simplices)
  {
    smallest = std::min(smallest, Distance(FindNearestPoint(simplex.Corners, position), position));
  }
  return smallest;
}
} // namespace

/** A point that moves in its plane: sampled points of either fan lie on the other one. */
TEST(DeviationBound, FansInAPlaneCoverTheSame)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> offset(-0.25, 0.25);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 200; ++i)
  {
    SCOPED_TRACE("fan " + std::to_string(i) + " of seed 5");
    const std::vector<Vec3> ring = MakeRing(random);
    const auto removed = MakeFan(ring, { offset(random), offset(random), 0.0 });
    const auto added = MakeFan(ring, { offset(random), offset(random), 0.0 });
    const double shift = GetShift(removed, added);
    ASSERT_LT(shift, 1e-13);
    for (int k = 0; k < 50; ++k)
    {
      const double a = unit(random);
      const double b = (1.0 - a) * unit(random);
      const auto& corners = removed[k % Corners].Corners;
      const Vec3 sample = a * corners[0] + b * corners[1] + (1.0 - a - b) * corners[2];
      EXPECT_LE(GetDistance(added, sample), shift + 1e-14);
    }
  }
}

TEST(DeviationBound, OtherFansDoNotShift)
{
  std::mt19937 random(6);
  const std::vector<Vec3> ring = MakeRing(random);
  const auto fan = MakeFan(ring, {});
  // Above its plane, it is as far as it is high, or more.
  const double shift = GetShift(fan, MakeFan(ring, { 0.1, 0.0, 0.01 }));
  EXPECT_GE(shift, 0.01);
  EXPECT_LE(shift, 0.02);
  // Outside of its ring a triangle is turned over.
  EXPECT_EQ(GetShift(fan, MakeFan(ring, { 2.0, 0.0, 0.0 })), Infinity);
  EXPECT_EQ(GetShift(fan, {}), Infinity);
}

TEST(DeviationBound, PathsOnALineCoverTheSame)
{
  const Vec3 a{ -1.0, 0.3, 0.0 };
  const Vec3 b{ 1.0, 0.3, 0.0 };
  const auto path = MakePath({ a, { 0.2, 0.3, 0.0 }, b });
  EXPECT_LT(GetShift(path, MakePath({ a, b })), 1e-13);
  EXPECT_LT(GetShift(path, MakePath({ b, { -0.7, 0.3, 0.0 }, { -0.9, 0.3, 0.0 }, a })), 1e-13);
  // Off the line, beyond an end, and with another end.
  EXPECT_GE(GetShift(path, MakePath({ a, { 0.2, 0.31, 0.0 }, b })), 0.01 - 1e-14);
  EXPECT_GE(GetShift(path, MakePath({ a, { 1.2, 0.3, 0.0 }, b })), 0.2 - 1e-14);
  EXPECT_EQ(GetShift(path, MakePath({ a, { 0.9, 0.3, 0.0 } })), Infinity);
}

/**
 * The center of a fan moves in its plane ever farther: no more is searched, and every original
 * triangle stays within the bound of those that prove it.
 */
TEST(DeviationBound, ShiftsAreProvenWithoutSearch)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-0.25, 0.25);
  const std::vector<Vec3> ring = MakeRing(random);
  const auto original = MakeFan(ring, {});
  ThreadTeam threads(2);
  DeviationBound bound(original, 0.01, threads);
  BoundChange change;
  std::vector<Id> ids;
  for (Id i = 0; i < Corners; ++i)
  {
    change.Removed.push_back(i);
    ids.push_back(i);
  }
  DeviationBound::ChangeProof proof;
  for (int i = 0; i < 100; ++i)
  {
    change.Added = MakeFan(ring, { offset(random), offset(random), 0.0 });
    ASSERT_TRUE(bound.Prove(change, proof));
    EXPECT_TRUE(proof.IsShift);
    ASSERT_EQ(proof.Originals.size(), original.size());
    for (const DeviationBound::Proof& single : proof.Originals)
    {
      std::vector<BoundSimplex> witnesses;
      for (const Id witness : single.NewWitnesses)
      {
        ASSERT_LT(witness, 0);
        witnesses.push_back(change.Added[~witness]);
      }
      const auto& [a, b, c] = original[single.Original].Corners;
      for (const Vec3& sample : { a, b, c, 0.5 * (a + b), (1.0 / 3.0) * (a + b + c) })
      {
        EXPECT_LE(GetDistance(witnesses, sample), 0.01);
      }
    }
    bound.Replace(change, ids, proof);
  }
  // The same a little above the plane has to be searched, far above it is refused.
  change.Added = MakeFan(ring, { 0.0, 0.0, 0.005 });
  EXPECT_TRUE(bound.Prove(change, proof));
  EXPECT_FALSE(proof.IsShift);
  change.Added = MakeFan(ring, { 0.0, 0.0, 0.02 });
  EXPECT_FALSE(bound.Prove(change, proof));
  // Where the border moves in a way that is not known, everything is searched.
  change.Added = MakeFan(ring, { 0.1, 0.0, 0.0 });
  change.BorderShift = Infinity;
  EXPECT_TRUE(bound.Prove(change, proof));
  EXPECT_FALSE(proof.IsShift);
}
