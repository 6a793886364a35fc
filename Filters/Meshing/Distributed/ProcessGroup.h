// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessGroup.h
 * @brief What filters that run on several processes at once say to each other.
 *
 * Private to this module; on top of vtkMultiProcessController, whatever its kind. Every method has
 * to be called by all processes. So that none waits for one that has given up, a process that meets
 * an error goes on to the next Agree(), where all learn of it and stop together.
 *
 * Processes exchange messages in pairs: in step s of n, process r meets process (s - r) mod n, and
 * the one with the lower rank sends first. Nobody waits for a third one, and no buffer of MPI's has
 * to hold a message. Numbers travel as they are in memory: all processes are of one kind of
 * machine.
 */
#ifndef ProcessGroup_h
#define ProcessGroup_h

#include "Core/Basics/Status.h"

#include <vtkSmartPointer.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

class vtkDataObject;
class vtkMultiProcessController;

namespace vtkDistributed
{
class ProcessGroup
{
public:
  using Bytes = std::vector<char>;

  /**
   * null: a process by itself. Gather() takes messages that are longer in all than the limit in
   * pieces.
   */
  explicit ProcessGroup(
    vtkMultiProcessController* controller, std::int64_t largestGather = LargestGather);

  int GetRank() const { return this->Rank; }
  int GetSize() const { return this->Size; }
  bool IsAlone() const { return this->Size == 1; }

  /**
   * The same outcome everywhere: Ok if all are. A process keeps what went wrong on itself; the
   * others get the message of the first process that has an error, with its rank, or else are
   * aborted.
   */
  cdm::Status Agree(const cdm::Status& own) const;

  /** Work of each process by itself, of which running out of memory is a failure; then Agree(). */
  cdm::Status Do(const std::function<cdm::Status()>& work) const;

  std::int64_t Sum(std::int64_t own) const;
  std::int64_t Maximum(std::int64_t own) const;

  /** Message i goes to process i; what comes from process i is at place i of the result. */
  cdm::Status Exchange(std::vector<Bytes> messages, std::vector<Bytes>& received);
  /** Everybody's message, by rank. */
  std::vector<Bytes> Gather(const Bytes& own) const;

  template <typename T>
  cdm::Status Exchange(
    const std::vector<std::vector<T>>& messages, std::vector<std::vector<T>>& received)
  {
    std::vector<Bytes> packed;
    for (const std::vector<T>& message : messages)
    {
      packed.push_back(Pack(message));
    }
    std::vector<Bytes> arrived;
    const cdm::Status status = this->Exchange(std::move(packed), arrived);
    received.clear();
    for (const Bytes& bytes : arrived)
    {
      received.push_back(Unpack<T>(bytes));
    }
    return status;
  }

  /** The items of all processes, by rank. */
  template <typename T>
  std::vector<T> GatherAll(const std::vector<T>& own) const
  {
    std::vector<T> all;
    for (const Bytes& bytes : this->Gather(Pack(own)))
    {
      const std::vector<T> items = Unpack<T>(bytes);
      all.insert(all.end(), items.begin(), items.end());
    }
    return all;
  }

  /** Bytes that this process has sent to others so far. */
  std::int64_t GetNumberOfBytesSent() const { return this->BytesSent; }

  static Bytes Pack(vtkDataObject* data);
  static vtkSmartPointer<vtkDataObject> UnpackData(const Bytes& bytes);

  template <typename T>
  static Bytes Pack(const std::vector<T>& items)
  {
    static_assert(std::is_trivially_copyable_v<T>, "sent as it is in memory");
    Bytes bytes(items.size() * sizeof(T));
    if (!bytes.empty())
    {
      std::memcpy(bytes.data(), items.data(), bytes.size());
    }
    return bytes;
  }

  template <typename T>
  static std::vector<T> Unpack(const Bytes& bytes)
  {
    std::vector<T> items(bytes.size() / sizeof(T));
    if (!items.empty())
    {
      std::memcpy(items.data(), bytes.data(), items.size() * sizeof(T));
    }
    return items;
  }

private:
  void Swap(int partner, const char* data, std::int64_t size, char* received,
    std::int64_t receivedSize) const;

  /** Bytes that are gathered at once: MPI counts them with 32 bits. */
  static constexpr std::int64_t LargestGather = std::int64_t(1) << 30;

  vtkMultiProcessController* Controller;
  /** Largest message of one process, in one piece. */
  std::int64_t LargestMessage;
  int Rank = 0;
  int Size = 1;
  std::int64_t BytesSent = 0;
};
} // namespace vtkDistributed

#endif
