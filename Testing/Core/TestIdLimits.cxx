// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/IdLimits.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

using namespace cdm;

TEST(IdLimits, NumbersThatIdsCannotCountAreNamed)
{
  constexpr std::uint64_t largest = 2147483647;
  EXPECT_TRUE(CheckIdRange(0, "points").IsOk());
  EXPECT_TRUE(CheckIdRange(largest, "points").IsOk());
  for (const std::uint64_t number : { largest + 1, 2 * largest + 2, ~std::uint64_t(0) })
  {
    const Status status = CheckIdRange(number, "points");
    EXPECT_EQ(status.Code, StatusCode::LimitReached);
    EXPECT_NE(status.Message.find(std::to_string(number) + " points"), std::string::npos);
  }
}

TEST(IdLimits, EdgesCountWithTheirTetrahedraAndTriangles)
{
  EXPECT_TRUE(CheckNumberOfTetrahedra(357913941).IsOk());
  EXPECT_NE(CheckNumberOfTetrahedra(357913942).Message.find("357913941"), std::string::npos);
  EXPECT_EQ(CheckNumberOfTetrahedra(std::uint64_t(1) << 33).Code, StatusCode::LimitReached);
  EXPECT_TRUE(CheckNumberOfTriangles(715827882).IsOk());
  EXPECT_NE(CheckNumberOfTriangles(715827883).Message.find("715827882"), std::string::npos);
}

TEST(IdLimits, SurfaceAndMeshPointsCountTogether)
{
  constexpr std::uint64_t largest = 2147483647;
  EXPECT_TRUE(CheckNumberOfPoints(0, 0).IsOk());
  // One id is that of the point at infinity.
  EXPECT_TRUE(CheckNumberOfPoints(1000, largest - 1001).IsOk());
  EXPECT_EQ(CheckNumberOfPoints(1000, largest - 1000).Code, StatusCode::LimitReached);
  // Each alone is within the limit, and 32 bits would have wrapped around.
  const Status status = CheckNumberOfPoints(largest, largest);
  EXPECT_EQ(status.Code, StatusCode::LimitReached);
  EXPECT_NE(status.Message.find("4294967295 points"), std::string::npos) << status.Message;
}

TEST(IdLimits, ARefinementEndsBeforeItsIdsDo)
{
  EXPECT_TRUE(CheckRefinement(2146000000, 714000000).IsOk());
  for (const auto& [points, triangles] :
    { std::pair<std::uint64_t, std::uint64_t>(2147483647, 12), { 8, 715827882 } })
  {
    const Status status = CheckRefinement(points, triangles);
    EXPECT_EQ(status.Code, StatusCode::LimitReached);
    EXPECT_NE(status.Message.find(std::to_string(points) + " points"), std::string::npos);
    EXPECT_NE(status.Message.find(std::to_string(triangles) + " triangles"), std::string::npos);
  }
}
