// SPDX-License-Identifier: BSD-3-Clause
#include "IdLimits.h"

#include <gtest/gtest.h>

using namespace cdm;

TEST(IdLimits, NumbersThatIdsCannotCountAreNamed)
{
  constexpr std::uint64_t largest = 2147483647;
  EXPECT_TRUE(CheckIdRange(0, "points").IsOk());
  EXPECT_TRUE(CheckIdRange(largest, "points").IsOk());
  for (const std::uint64_t number : { largest + 1, 2 * largest + 2, ~std::uint64_t(0) })
  {
    const Status status = CheckIdRange(number, "points");
    EXPECT_EQ(status.Code, StatusCode::InvalidInput);
    EXPECT_NE(status.Message.find(std::to_string(number) + " points"), std::string::npos);
  }
}

TEST(IdLimits, EdgesCountWithTheirTetrahedraAndTriangles)
{
  EXPECT_TRUE(CheckNumberOfTetrahedra(357913941).IsOk());
  EXPECT_NE(CheckNumberOfTetrahedra(357913942).Message.find("357913941"), std::string::npos);
  EXPECT_EQ(CheckNumberOfTetrahedra(std::uint64_t(1) << 33).Code, StatusCode::InvalidInput);
  EXPECT_TRUE(CheckNumberOfTriangles(715827882).IsOk());
  EXPECT_NE(CheckNumberOfTriangles(715827883).Message.find("715827882"), std::string::npos);
}
