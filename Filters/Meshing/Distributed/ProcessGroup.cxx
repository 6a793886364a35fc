// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/ProcessGroup.h"

#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkDataObject.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>

#include <algorithm>
#include <numeric>

namespace vtkDistributed
{
namespace
{
constexpr int Tag = 7214;

enum Outcome : int
{
  Good,
  Aborted,
  Bad,
  Broken
};

Outcome GetOutcome(const cdm::Status& status)
{
  switch (status.Code)
  {
    case cdm::StatusCode::Ok:
      return Good;
    case cdm::StatusCode::Aborted:
      return Aborted;
    case cdm::StatusCode::InternalError:
      return Broken;
    default:
      return Bad;
  }
}
} // namespace

//--------------------------------------------------------------------------------------------------
ProcessGroup::ProcessGroup(vtkMultiProcessController* controller, std::int64_t largestGather)
  : Controller(controller)
{
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    this->Rank = controller->GetLocalProcessId();
    this->Size = controller->GetNumberOfProcesses();
  }
  this->LargestMessage = std::max<std::int64_t>(1, largestGather / this->Size);
}

//--------------------------------------------------------------------------------------------------
cdm::Status ProcessGroup::Agree(const cdm::Status& own) const
{
  if (this->IsAlone())
  {
    return own;
  }
  const int outcome = GetOutcome(own);
  int worst = Good;
  this->Controller->AllReduce(&outcome, &worst, 1, vtkCommunicator::MAX_OP);
  if (worst == Good)
  {
    return {};
  }
  const bool isError = worst == Bad || worst == Broken;
  const std::string message =
    isError && (outcome == Bad || outcome == Broken) ? own.Message : std::string();
  const std::vector<Bytes> messages = this->Gather(Bytes(message.begin(), message.end()));
  if (!isError)
  {
    return cdm::Status::Aborted();
  }
  if (outcome == Bad || outcome == Broken)
  {
    return own;
  }
  const auto first = std::find_if(
    messages.begin(), messages.end(), [](const Bytes& bytes) { return !bytes.empty(); });
  cdm::Status status =
    cdm::Status::InvalidInput("Process " + std::to_string(first - messages.begin()) +
      " failed: " + std::string(first->begin(), first->end()));
  status.Code = worst == Broken ? cdm::StatusCode::InternalError : cdm::StatusCode::InvalidInput;
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status ProcessGroup::Do(const std::function<cdm::Status()>& work) const
{
  return this->Agree(cdm::RunGuarded(work));
}

//--------------------------------------------------------------------------------------------------
std::int64_t ProcessGroup::Sum(std::int64_t own) const
{
  long long sum = own;
  if (!this->IsAlone())
  {
    const long long value = own;
    this->Controller->AllReduce(&value, &sum, 1, vtkCommunicator::SUM_OP);
  }
  return sum;
}

//--------------------------------------------------------------------------------------------------
std::int64_t ProcessGroup::Maximum(std::int64_t own) const
{
  long long maximum = own;
  if (!this->IsAlone())
  {
    const long long value = own;
    this->Controller->AllReduce(&value, &maximum, 1, vtkCommunicator::MAX_OP);
  }
  return maximum;
}

//--------------------------------------------------------------------------------------------------
void ProcessGroup::Swap(
  int partner, const char* data, std::int64_t size, char* received, std::int64_t receivedSize) const
{
  for (int turn = 0; turn < 2; ++turn)
  {
    if ((turn == 0) == (this->Rank < partner))
    {
      if (size > 0)
      {
        this->Controller->Send(data, size, partner, Tag);
      }
    }
    else if (receivedSize > 0)
    {
      this->Controller->Receive(received, receivedSize, partner, Tag);
    }
  }
}

//--------------------------------------------------------------------------------------------------
cdm::Status ProcessGroup::Exchange(std::vector<Bytes> messages, std::vector<Bytes>& received)
{
  const std::size_t count = static_cast<std::size_t>(this->Size);
  received.assign(count, {});
  std::vector<std::int64_t> sizes(count, 0);
  const auto getPartner = [this](int step)
  { return (step - this->Rank + this->Size) % this->Size; };
  for (int step = 0; step < this->Size; ++step)
  {
    const int partner = getPartner(step);
    if (partner != this->Rank)
    {
      const std::int64_t size = static_cast<std::int64_t>(messages[partner].size());
      this->Swap(partner, reinterpret_cast<const char*>(&size), sizeof(size),
        reinterpret_cast<char*>(&sizes[partner]), sizeof(size));
    }
  }
  // Only if there is room for the messages on all processes are they sent.
  const cdm::Status status = this->Do(
    [&]
    {
      for (std::size_t partner = 0; partner < count; ++partner)
      {
        received[partner].resize(static_cast<std::size_t>(sizes[partner]));
      }
      return cdm::Status();
    });
  if (!status.IsOk())
  {
    return status;
  }
  for (int step = 0; step < this->Size; ++step)
  {
    const int partner = getPartner(step);
    if (partner == this->Rank)
    {
      received[partner] = std::move(messages[partner]);
      continue;
    }
    this->Swap(partner, messages[partner].data(),
      static_cast<std::int64_t>(messages[partner].size()), received[partner].data(),
      sizes[partner]);
    this->BytesSent += static_cast<std::int64_t>(messages[partner].size());
    messages[partner] = Bytes();
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
std::vector<ProcessGroup::Bytes> ProcessGroup::Gather(const Bytes& own) const
{
  if (this->IsAlone())
  {
    return { own };
  }
  const std::size_t count = static_cast<std::size_t>(this->Size);
  const vtkIdType size = static_cast<vtkIdType>(own.size());
  std::vector<vtkIdType> sizes(count);
  this->Controller->AllGather(&size, sizes.data(), 1);
  std::vector<Bytes> messages;
  for (const vtkIdType length : sizes)
  {
    messages.emplace_back(static_cast<std::size_t>(length));
  }
  const vtkIdType longest = *std::max_element(sizes.begin(), sizes.end());
  std::vector<vtkIdType> pieces(count);
  std::vector<vtkIdType> offsets(count + 1, 0);
  for (vtkIdType begin = 0; begin < longest; begin += this->LargestMessage)
  {
    for (std::size_t rank = 0; rank < count; ++rank)
    {
      pieces[rank] =
        std::min<vtkIdType>(this->LargestMessage, std::max<vtkIdType>(0, sizes[rank] - begin));
    }
    std::partial_sum(pieces.begin(), pieces.end(), offsets.begin() + 1);
    Bytes all(static_cast<std::size_t>(offsets.back()));
    const vtkIdType piece = pieces[static_cast<std::size_t>(this->Rank)];
    const char* const data = piece > 0 ? own.data() + begin : own.data();
    this->Controller->AllGatherV(data, all.data(), piece, pieces.data(), offsets.data());
    for (std::size_t rank = 0; rank < count; ++rank)
    {
      std::copy_n(all.begin() + offsets[rank], pieces[rank],
        messages[rank].begin() + std::min(begin, sizes[rank]));
    }
  }
  return messages;
}

//--------------------------------------------------------------------------------------------------
ProcessGroup::Bytes ProcessGroup::Pack(vtkDataObject* data)
{
  vtkNew<vtkCharArray> buffer;
  vtkCommunicator::MarshalDataObject(data, buffer);
  return Bytes(buffer->GetPointer(0), buffer->GetPointer(0) + buffer->GetNumberOfTuples());
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> ProcessGroup::UnpackData(const Bytes& bytes)
{
  vtkNew<vtkCharArray> buffer;
  // The array reads what belongs to the message.
  buffer->SetArray(const_cast<char*>(bytes.data()), static_cast<vtkIdType>(bytes.size()), 1);
  return vtkCommunicator::UnMarshalDataObject(buffer);
}
} // namespace vtkDistributed
