// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

using cdm::Vec3;

namespace
{
constexpr double Degrees = 57.29577951308232;

/** A regular tetrahedron: alternate corners of the cube [-1, 1]^3. */
const Vec3 A{ -1, -1, -1 };
const Vec3 B{ 1, 1, -1 };
const Vec3 C{ -1, 1, 1 };
const Vec3 D{ 1, -1, 1 };
} // namespace

TEST(Measures, VolumeHasTheSignOfTheOrientation)
{
  EXPECT_DOUBLE_EQ(1.0 / 6.0, cdm::GetSignedVolume({}, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }));
  EXPECT_DOUBLE_EQ(-1.0 / 6.0, cdm::GetSignedVolume({}, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 }));
  EXPECT_DOUBLE_EQ(8.0 / 3.0, std::abs(cdm::GetSignedVolume(A, B, C, D)));
}

TEST(Measures, TriangleArea)
{
  EXPECT_DOUBLE_EQ(3.0, cdm::GetTriangleArea({ 1, 1, 1 }, { 3, 1, 1 }, { 1, 1, 4 }));
  EXPECT_EQ(0.0, cdm::GetTriangleArea({ 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 }));
}

TEST(Measures, RegularTetrahedronHasEqualAngles)
{
  for (const double angle : cdm::GetDihedralAngles(A, B, C, D))
  {
    EXPECT_NEAR(std::acos(1.0 / 3.0) * Degrees, angle, 1e-12);
  }
  for (const double angle : cdm::GetDihedralAngles(A, C, B, D))
  {
    EXPECT_NEAR(std::acos(1.0 / 3.0) * Degrees, angle, 1e-12);
  }
}

TEST(Measures, AnglesComeInTheOrderOfTheEdges)
{
  // A cube's corner: right angles at the three edges of the origin.
  const auto angles = cdm::GetDihedralAngles({}, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 });
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_NEAR(90.0, angles[i], 1e-12);
    EXPECT_NEAR(std::atan(std::sqrt(2.0)) * Degrees, angles[3 + i], 1e-12);
  }
  // With d at height h over the origin only the edge bc changes: tan = h / (1 / sqrt(2)).
  const auto low = cdm::GetDihedralAngles({}, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 0.1 });
  EXPECT_NEAR(std::atan(0.1 * std::sqrt(2.0)) * Degrees, low[3], 1e-12);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(low[i], cdm::GetDihedralAngle({}, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 0.1 }, i));
  }
}

TEST(Measures, SliverAnglesKeepTheirRelativeAccuracy)
{
  // Two perpendicular diagonals of a square at distance h: tan of the angles at the diagonals'
  // halves is h over half the diagonal.
  const double h = 1e-12;
  const auto angles = cdm::GetDihedralAngles({ -1, 0, 0 }, { 1, 0, 0 }, { 0, -1, h }, { 0, 1, h });
  EXPECT_NEAR(180.0, angles[0], 1e-9);
  EXPECT_NEAR(180.0, angles[5], 1e-9);
  const double smallest = *std::min_element(angles.begin(), angles.end());
  EXPECT_GT(smallest, 0.0);
  // Facets through x + y = +-1 planes: the sliver's other angles are sqrt(2) h.
  EXPECT_NEAR(1.0, smallest / (std::sqrt(2.0) * h * Degrees), 1e-9);
  EXPECT_NEAR(1.0,
    cdm::GetSmallestDihedralAngle({ -1, 0, 0 }, { 1, 0, 0 }, { 0, -1, h }, { 0, 1, h }) / smallest,
    1e-14);
}

TEST(Measures, TheSmallestAngleIsTheSmallestOfAll)
{
  constexpr unsigned int seed = 20261125;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i)
  {
    // Half of them flat, and of all sizes.
    const double size = std::pow(10.0, 12.0 * uniform(generator));
    const double height = i % 2 == 0 ? size : std::pow(10.0, -8.0) * size;
    std::array<cdm::Vec3, 4> v;
    for (cdm::Vec3& p : v)
    {
      p = { size * uniform(generator), size * uniform(generator), height * uniform(generator) };
    }
    const auto angles = cdm::GetDihedralAngles(v[0], v[1], v[2], v[3]);
    const double smallest = *std::min_element(angles.begin(), angles.end());
    EXPECT_NEAR(1.0, cdm::GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]) / smallest, 1e-12);
    const double tangent2 = cdm::GetSmallestDihedralTangent2(v[0], v[1], v[2], v[3]);
    EXPECT_NEAR(1.0, std::atan(std::sqrt(tangent2)) * Degrees / smallest, 1e-12);
  }
}

TEST(Measures, FlatAndDegenerateTetrahedraHaveTheirLimits)
{
  for (const double angle :
    cdm::GetDihedralAngles({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }))
  {
    EXPECT_TRUE(angle == 0.0 || angle == 180.0) << angle;
  }
  EXPECT_EQ(0.0, cdm::GetDihedralAngles({}, {}, { 0, 1, 0 }, { 1, 1, 0 })[0]);
  EXPECT_EQ(0.0, cdm::GetSmallestHeight({}, {}, {}, {}));
}

TEST(Measures, SmallestHeight)
{
  EXPECT_NEAR(
    1.0 / std::sqrt(3.0), cdm::GetSmallestHeight({}, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }), 1e-15);
  EXPECT_NEAR(1e-3, cdm::GetSmallestHeight({}, { 5, 0, 0 }, { 0, 5, 0 }, { 1, 1, 1e-3 }), 1e-10);
}

TEST(Measures, Circumcentres)
{
  const Vec3 flat = cdm::GetCircumcenter({ 0, 0, 5 }, { 4, 0, 5 }, { 0, 2, 5 });
  EXPECT_DOUBLE_EQ(2.0, flat.X);
  EXPECT_DOUBLE_EQ(1.0, flat.Y);
  EXPECT_DOUBLE_EQ(5.0, flat.Z);
  const Vec3 solid = cdm::GetCircumcenter({ 1, 1, 1 }, { 3, 1, 1 }, { 1, 5, 1 }, { 1, 1, 7 });
  EXPECT_DOUBLE_EQ(2.0, solid.X);
  EXPECT_DOUBLE_EQ(3.0, solid.Y);
  EXPECT_DOUBLE_EQ(4.0, solid.Z);
  EXPECT_FALSE(IsFinite(cdm::GetCircumcenter({ 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 })));
  EXPECT_FALSE(IsFinite(cdm::GetCircumcenter({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 })));
}
