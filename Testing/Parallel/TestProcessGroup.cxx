// SPDX-License-Identifier: BSD-3-Clause
#include "ParallelTesting.h"

#include "Distributed/ProcessGroup.h"

#include <functional>
#include <new>
#include <string>

using namespace testing_parallel;

namespace
{
using Bytes = vtkDistributed::ProcessGroup::Bytes;

/** Bytes that tell who sent them, to whom, and where in the message they are. */
Bytes MakeMessage(int from, int to, std::size_t size)
{
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i)
  {
    bytes.push_back(static_cast<char>(31 * from + 7 * to + 13 * i + i / 256));
  }
  return bytes;
}

vtkDistributed::ProcessGroup MakeGroup(std::int64_t largestGather)
{
  return vtkDistributed::ProcessGroup(
    vtkMultiProcessController::GetGlobalController(), largestGather);
}

void ExpectGathered(std::int64_t largestGather, const std::function<std::size_t(int)>& getSize)
{
  SCOPED_TRACE("pieces of " + std::to_string(largestGather) + " bytes in all");
  const std::vector<Bytes> messages =
    MakeGroup(largestGather).Gather(MakeMessage(GetRank(), 0, getSize(GetRank())));
  EXPECT_EQ(messages.size(), static_cast<std::size_t>(GetSize()));
  for (int rank = 0; rank < static_cast<int>(messages.size()); ++rank)
  {
    EXPECT_EQ(messages[rank], MakeMessage(rank, 0, getSize(rank))) << "of process " << rank;
  }
}

/** Fewer bytes than processes, a few for each, all at once. */
constexpr std::int64_t Limits[] = { 1, 3, 8, 20, 97, std::int64_t(1) << 20 };
} // namespace

TEST(ProcessGroup, GathersInPieces)
{
  const int last = GetSize() - 1;
  for (const std::int64_t limit : Limits)
  {
    ExpectGathered(limit, [](int) { return 0; });
    ExpectGathered(limit, [](int rank) { return 17 * static_cast<std::size_t>(rank + 1); });
    ExpectGathered(limit, [last](int rank) { return rank == last ? 100 : 0; });
    ExpectGathered(limit, [](int rank) { return rank == 0 ? 100 : 0; });
    ExpectGathered(limit, [](int rank) { return rank % 2 == 0 ? 0 : 1000; });
    // As many as fit, one more and one less.
    for (std::size_t size : { 4, 5, 3, 24, 25, 23 })
    {
      ExpectGathered(limit, [size](int) { return size; });
    }
  }
}

TEST(ProcessGroup, GathersItemsThatAreCut)
{
  // Pieces that end within an item.
  const std::vector<double> own(static_cast<std::size_t>(3 * GetRank()), 0.1 + GetRank());
  std::vector<double> expected;
  for (int rank = 0; rank < GetSize(); ++rank)
  {
    expected.insert(expected.end(), static_cast<std::size_t>(3 * rank), 0.1 + rank);
  }
  for (const std::int64_t limit : Limits)
  {
    EXPECT_EQ(MakeGroup(limit).GatherAll(own), expected);
  }
}

TEST(ProcessGroup, AllLearnOfAnErrorWhateverItsLength)
{
  for (const std::int64_t limit : Limits)
  {
    const vtkDistributed::ProcessGroup processes = MakeGroup(limit);
    for (int culprit = 0; culprit < GetSize(); ++culprit)
    {
      const std::string text(200, static_cast<char>('a' + culprit));
      const cdm::Status status =
        processes.Agree(GetRank() == culprit ? cdm::Status::InvalidInput(text) : cdm::Status());
      EXPECT_EQ(status.Code, cdm::StatusCode::InvalidInput);
      EXPECT_EQ(status.Message,
        GetRank() == culprit ? text : "Process " + std::to_string(culprit) + " failed: " + text);
    }
    EXPECT_TRUE(processes.Agree({}).IsOk());
    EXPECT_TRUE(
      processes.Agree(GetRank() == 0 ? cdm::Status::Aborted() : cdm::Status()).IsAborted());
    // No memory on one process is an error on all.
    const cdm::Status status = processes.Do(
      []
      {
        if (GetRank() == 0)
        {
          throw std::bad_alloc();
        }
        return cdm::Status();
      });
    EXPECT_FALSE(status.IsOk());
    EXPECT_FALSE(status.IsAborted());
  }
}

TEST(ProcessGroup, ExchangesMessagesOfAnyLength)
{
  vtkDistributed::ProcessGroup processes(vtkMultiProcessController::GetGlobalController());
  const auto getSize = [](int from, int to)
  { return static_cast<std::size_t>(from == to + 1 ? 0 : 100 * from + 10 * to); };
  std::vector<Bytes> messages;
  std::int64_t sent = 0;
  for (int to = 0; to < GetSize(); ++to)
  {
    messages.push_back(MakeMessage(GetRank(), to, getSize(GetRank(), to)));
    sent += to == GetRank() ? 0 : static_cast<std::int64_t>(messages.back().size());
  }
  std::vector<Bytes> received;
  EXPECT_TRUE(processes.Exchange(messages, received).IsOk());
  EXPECT_EQ(received.size(), messages.size());
  for (int from = 0; from < static_cast<int>(received.size()); ++from)
  {
    EXPECT_EQ(received[from], MakeMessage(from, GetRank(), getSize(from, GetRank())));
  }
  EXPECT_EQ(processes.GetNumberOfBytesSent(), sent);
}

int main(int argc, char** argv)
{
  return testing_parallel::RunAllTests(argc, argv);
}
