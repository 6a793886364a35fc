// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <thread>

using namespace cdm;

TEST(Status, StepsEndWithTheFirstThatFails)
{
  int calls = 0;
  const auto succeed = [&calls]() -> Status
  {
    ++calls;
    return {};
  };
  EXPECT_TRUE(succeed().Then(succeed).Then(succeed).IsOk());
  EXPECT_EQ(calls, 3);
  const Status status =
    succeed()
      .Then([] { return Status::Failure(StatusCode::NotClosed, "Open.", { 7 }); })
      .Then(succeed);
  EXPECT_EQ(status.Code, StatusCode::NotClosed);
  EXPECT_EQ(status.Cells, std::vector<Id>{ 7 });
  EXPECT_EQ(calls, 4);
}

TEST(Status, MemoryThatIsNotThereIsNoException)
{
  EXPECT_EQ(RunGuarded([]() -> Status { throw std::bad_alloc(); }).Code, StatusCode::OutOfMemory);
  EXPECT_EQ(RunGuarded([]() -> Status { throw std::length_error("vector"); }).Code,
    StatusCode::OutOfMemory);
  EXPECT_TRUE(RunGuarded([] { return Status(); }).IsOk());
}

TEST(ExecutionContext, ThreadsTravelWithItsParts)
{
  EXPECT_EQ(ExecutionContext().GetNumberOfThreads(), 1);
  EXPECT_EQ(ExecutionContext(3).Part(0.2, 0.4).Part(0.0, 0.5).GetNumberOfThreads(), 3);
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  EXPECT_EQ(ExecutionContext(0).GetNumberOfThreads(), static_cast<int>(cores));
}
