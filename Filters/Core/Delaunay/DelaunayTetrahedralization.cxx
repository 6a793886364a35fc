// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/DelaunayTetrahedralization.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/VertexInsertion.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <thread>

namespace cdm
{
namespace
{
/** Rounds of fewer vertices are inserted by one thread. */
constexpr std::size_t SmallRound = 2048;
/** The first round has about so many vertices, each of the others eight times more. */
constexpr Id FirstRound = 100;
/** Vertices between two calls of the context. */
constexpr std::size_t ReportInterval = 4096;
/** Vertices after which a thread looks whether another one is idle. */
constexpr std::size_t HandOverInterval = 64;
/** Fewer vertices are not worth handing over. */
constexpr std::size_t SmallestHandOver = 512;
constexpr std::chrono::microseconds IdleTime(200);

class Builder
{
public:
  Builder(const RawVector<Vec3>& points, const std::vector<Id>& numbers,
    const ExecutionContext& context, DelaunayTetrahedralization& output)
    : Infinite(static_cast<Id>(points.size())), Context(context), Output(output),
      Insertion(points, numbers, output)
  {
  }

  Status Start();
  Status StartFromBlock(
    const GridBlock& block, const std::vector<Id>& numbers, int numberOfThreads);
  Status InsertOthers(int numberOfThreads);

private:
  enum class Answer
  {
    None,
    TryAgain,
    Take
  };
  /** The private data of a thread. */
  struct alignas(SeparateLines) Worker
  {
    VertexInsertion::Workspace Space;
    std::vector<Id> Todo;
    std::vector<Id> Postponed;
    /** Answer of another worker to this one, which has nothing left to do. */
    std::atomic<Answer> Received{ Answer::None };
  };

  Status InsertRound(std::vector<Id> left, int numberOfThreads);
  void DivideWork(std::vector<Id>& left, Id shift, int numberOfThreads);
  bool WorkInParts(int numberOfThreads, const std::function<bool(std::size_t)>& report);
  std::vector<Id> CollectPostponed(int numberOfThreads);
  template <bool IsShared>
  bool Work(Worker& worker, const std::function<bool(std::size_t)>& mayContinue);
  bool HandOver(Worker& from, std::size_t next, Worker& to);
  bool WaitForMore(Worker& worker, const std::function<bool(std::size_t)>& mayContinue);

  /** The vertex at infinity, which is the number of points. */
  const Id Infinite;
  const ExecutionContext& Context;
  DelaunayTetrahedralization& Output;
  VertexInsertion Insertion;
  /** The progress reported last. */
  double Progress = 0.0;
  /** Vertices that need no insertion. */
  std::vector<bool> IsInserted;
  std::vector<Worker> Workers;
  /** A thread that has nothing left to do, and how many have. */
  std::atomic<Worker*> Idle{ nullptr };
  std::atomic<int> NumberOfBusy{ 0 };
};

template <bool IsShared>
bool Builder::Work(Worker& worker, const std::function<bool(std::size_t)>& mayContinue)
{
  for (std::size_t i = 0; i < worker.Todo.size(); ++i)
  {
    if (i % ReportInterval == 0 && !mayContinue(i))
    {
      return false;
    }
    if (IsShared && i % HandOverInterval == 0 && worker.Todo.size() - i >= 2 * SmallestHandOver)
    {
      Worker* idle = this->Idle.load(std::memory_order_relaxed);
      // Nobody else may serve it.
      if (idle != nullptr && this->Idle.compare_exchange_strong(idle, nullptr))
      {
        idle->Received = this->HandOver(worker, i, *idle) ? Answer::Take : Answer::TryAgain;
      }
    }
    const Id vertex = worker.Todo[i];
    const bool isDone = IsShared ? this->Insertion.InsertWithinPart(vertex, worker.Space)
                                 : this->Insertion.Insert(vertex, worker.Space);
    if (!isDone)
    {
      worker.Postponed.push_back(vertex);
      // Alone a thread can only run out of room.
      if (!IsShared)
      {
        return false;
      }
    }
  }
  return true;
}

/**
 * The second half of what is left to do, from next on, with that part of the curve and the places
 * that go with it. False if no tetrahedron is found there to start from.
 */
bool Builder::HandOver(Worker& from, std::size_t next, Worker& to)
{
  const std::size_t middle = next + (from.Todo.size() - next) / 2;
  const CurvePart& own = from.Space.Own;
  const CurvePart kept = own.GetBegin(own.GetPlace(from.Todo[middle]));
  const CurvePart given = own.GetEnd(from.Todo[middle]);
  // Both need a tetrahedron of their own to start from.
  const auto findStart = [&](const CurvePart& part, std::size_t first, std::size_t last, Id& start)
  {
    bool isFound = false;
    for (std::size_t i = first; i < last && !isFound; i += 1 + (last - first) / 8)
    {
      isFound = this->Insertion.LocateWithinPart(from.Todo[i], from.Space, start) &&
        this->Insertion.IsOwned(start, part);
      const TetrahedronIds& ids = this->Output.Tetrahedra[isFound ? start : 0];
      isFound = isFound && !Contains(ids, this->Infinite);
    }
    return isFound;
  };
  Id keptStart = NoId;
  Id givenStart = NoId;
  if (!findStart(kept, next, middle, keptStart) ||
    !findStart(given, middle, from.Todo.size(), givenStart))
  {
    return false;
  }
  to.Todo.assign(from.Todo.begin() + static_cast<std::ptrdiff_t>(middle), from.Todo.end());
  from.Todo.resize(middle);
  from.Space.Own = kept;
  from.Space.Last = keptStart;
  to.Space.Own = given;
  to.Space.Last = givenStart;
  FreeSlots& free = from.Space.Free;
  free.MoveTo(to.Space.Free, to.Space.Free.GetSize() + free.GetSize() / 2);
  ++this->NumberOfBusy;
  return true;
}

/** False when nobody has anything left to do. */
bool Builder::WaitForMore(Worker& worker, const std::function<bool(std::size_t)>& mayContinue)
{
  // Not later, when another one may be writing.
  const std::size_t done = worker.Todo.size();
  --this->NumberOfBusy;
  bool isAsking = false;
  for (;;)
  {
    const Answer answer = worker.Received.exchange(Answer::None);
    if (answer == Answer::Take)
    {
      return true;
    }
    if (this->NumberOfBusy <= 0)
    {
      return false;
    }
    Worker* nobody = nullptr;
    isAsking =
      (isAsking && answer == Answer::None) || this->Idle.compare_exchange_strong(nobody, &worker);
    mayContinue(done);
    std::this_thread::sleep_for(IdleTime);
  }
}

/**
 * Cuts the curve into parts, one for each thread, and divides the vertices among them. Each part
 * gets a tetrahedron of its own to start from; the vertices of one that has none are postponed.
 */
void Builder::DivideWork(std::vector<Id>& left, Id shift, int numberOfThreads)
{
  const Id part = this->Infinite / numberOfThreads + 1;
  FreeSlots spare;
  this->Workers[0].Space.Free.MoveTo(spare, std::numeric_limits<std::size_t>::max());
  const Id last = this->Workers[0].Space.Last;
  // Along the curve, from where the first part begins.
  std::rotate(left.begin(), std::lower_bound(left.begin(), left.end(), shift), left.end());
  auto first = left.begin();
  for (int w = 0; w < numberOfThreads; ++w)
  {
    Worker& worker = this->Workers[static_cast<std::size_t>(w)];
    worker.Space.Own = { w * part + shift, std::min(part, this->Infinite - w * part),
      this->Infinite };
    const auto end = std::partition_point(
      first, left.end(), [&worker](Id vertex) { return worker.Space.Own.Has(vertex); });
    worker.Todo.assign(first, end);
    worker.Postponed.clear();
    first = end;
  }
  for (int w = 0; w < numberOfThreads; ++w)
  {
    Worker& worker = this->Workers[static_cast<std::size_t>(w)];
    worker.Space.HasInserted = false;
    worker.Space.Last = last;
    bool hasStart = false;
    for (std::size_t i = 0; i < worker.Todo.size() && !hasStart; i += 1 + worker.Todo.size() / 64)
    {
      worker.Space.Last = this->Insertion.Locate(worker.Todo[i], worker.Space);
      hasStart = this->Insertion.IsOwned(worker.Space.Last, worker.Space.Own);
    }
    if (!hasStart)
    {
      worker.Postponed.swap(worker.Todo);
      worker.Todo.clear();
    }
    const std::size_t wanted = 7 * worker.Todo.size() + worker.Todo.size() / 2;
    spare.MoveTo(worker.Space.Free, wanted);
    if (worker.Space.Free.GetSize() < wanted)
    {
      this->Insertion.AddRoom(wanted - worker.Space.Free.GetSize(), worker.Space);
    }
  }
  spare.MoveTo(this->Workers[0].Space.Free, std::numeric_limits<std::size_t>::max());
}

/** Inserts the vertices of all parts. False: aborted. */
bool Builder::WorkInParts(int numberOfThreads, const std::function<bool(std::size_t)>& report)
{
  std::atomic<bool> isAborted{ false };
  this->Idle = nullptr;
  this->NumberOfBusy = numberOfThreads;
  RunOnThreads(numberOfThreads,
    [&](int w)
    {
      const auto mayContinue = [&](std::size_t done)
      {
        isAborted =
          isAborted || (w == 0 && !report(done * static_cast<std::size_t>(numberOfThreads)));
        return !isAborted;
      };
      Worker& worker = this->Workers[static_cast<std::size_t>(w)];
      try
      {
        do
        {
          this->Work<true>(worker, mayContinue);
        } while (this->WaitForMore(worker, mayContinue));
      }
      catch (...)
      {
        isAborted = true;
        --this->NumberOfBusy;
        throw;
      }
    });
  return !isAborted;
}

/** The vertices that were postponed, ascending. The first worker gets all free slots. */
std::vector<Id> Builder::CollectPostponed(int numberOfThreads)
{
  std::vector<Id> left;
  FreeSlots spare;
  Id last = this->Workers[0].Space.Last;
  for (int w = 0; w < numberOfThreads; ++w)
  {
    Worker& worker = this->Workers[static_cast<std::size_t>(w)];
    left.insert(left.end(), worker.Postponed.begin(), worker.Postponed.end());
    worker.Space.Free.MoveTo(spare, std::numeric_limits<std::size_t>::max());
    last = worker.Space.HasInserted ? worker.Space.Last : last;
  }
  std::sort(left.begin(), left.end());
  spare.MoveTo(this->Workers[0].Space.Free, std::numeric_limits<std::size_t>::max());
  this->Workers[0].Space.Last = last;
  return left;
}

/** The vertices ascend. */
Status Builder::InsertRound(std::vector<Id> left, int numberOfThreads)
{
  const double begin = static_cast<double>(this->Output.Tetrahedra.size()) / 6.8;
  const auto report = [&](std::size_t done)
  {
    // What a round will make is an estimate: it must not go back from what the last one has made.
    this->Progress = std::max(
      this->Progress, std::min(0.99, (begin + static_cast<double>(done)) / this->Infinite));
    return this->Context.Continue(this->Progress, VertexInsertion::Activity);
  };
  // Two cuts of the curve for the threads, then all of it for one. A third would hardly find more:
  // what is left lies where the curve comes by several times, and parts of half the curve never
  // have all of that.
  for (int cut = 0; cut < 2 && numberOfThreads > 1 && left.size() >= SmallRound; ++cut)
  {
    this->DivideWork(
      left, cut == 0 ? 0 : (this->Infinite / numberOfThreads + 1) / 2, numberOfThreads);
    if (!this->WorkInParts(numberOfThreads, report))
    {
      return Status::Aborted();
    }
    left = this->CollectPostponed(numberOfThreads);
  }
  Worker& worker = this->Workers[0];
  worker.Todo.swap(left);
  worker.Postponed.clear();
  const bool isDone = this->Work<false>(worker, report);
  if (!worker.Postponed.empty())
  {
    return Status::Failure(StatusCode::LimitReached,
      "The points need more than " + std::to_string(VertexInsertion::MaximumTetrahedra) +
        " tetrahedra, which 32-bit facet ids cannot number.");
  }
  return isDone ? Status() : Status::Aborted();
}

Status Builder::Start()
{
  this->IsInserted.resize(static_cast<std::size_t>(this->Infinite), false);
  TetrahedronIds first;
  const Status status = this->Insertion.Start(first);
  if (status.IsOk())
  {
    for (Id vertex : first)
    {
      this->IsInserted[vertex] = true;
    }
  }
  return status;
}

Status Builder::StartFromBlock(
  const GridBlock& block, const std::vector<Id>& numbers, int numberOfThreads)
{
  this->Insertion.Reserve();
  this->IsInserted.resize(static_cast<std::size_t>(this->Infinite), false);
  for (Id vertex : block.Points)
  {
    this->IsInserted[vertex] = true;
  }
  const std::size_t count = GetNumberOfTetrahedra(block);
  this->Output.Tetrahedra.resize(count);
  this->Output.Neighbors.resize(count);
  this->Output.HasCosphericalPoints = true;
  const bool isAlone = block.Points.size() == static_cast<std::size_t>(this->Infinite);
  const double share =
    0.9 * static_cast<double>(block.Points.size()) / static_cast<double>(this->Infinite);
  if (!MeshGridBlock(block, numbers, numberOfThreads,
        this->Context.Part(0.0, isAlone ? 1.0 : 0.7 * share), this->Output.Tetrahedra,
        this->Output.Neighbors))
  {
    return Status::Aborted();
  }
  if (isAlone)
  {
    return Status();
  }
  const bool isDone =
    this->Insertion.Start(numberOfThreads, this->Context.Part(0.7 * share, share));
  this->Progress = share;
  return isDone ? Status() : Status::Aborted();
}

Status Builder::InsertOthers(int numberOfThreads)
{
  int rounds = 0;
  for (Id size = this->Infinite; size > FirstRound; size /= 8)
  {
    ++rounds;
  }
  const auto getRound = [rounds](Id vertex)
  {
    std::uint64_t hash = (static_cast<std::uint64_t>(vertex) + 1) * 0x9e3779b97f4a7c15ull;
    hash = (hash ^ (hash >> 32)) * 0xd6e8feb86659fd93ull;
    hash ^= hash >> 32;
    int round = rounds;
    while (round > 0 && (hash & 7) == 0)
    {
      --round;
      hash >>= 3;
    }
    return static_cast<std::size_t>(round);
  };
  using Rounds = std::vector<std::vector<Id>>;
  const Rounds none(static_cast<std::size_t>(rounds) + 1);
  const ParallelLoopOptions options{ numberOfThreads, std::size_t(1) << 16 };
  std::vector<Rounds> blocks(
    GetNumberOfBlocks(static_cast<std::size_t>(this->Infinite), options), none);
  ParallelLoop(static_cast<std::size_t>(this->Infinite), options, {}, "",
    [&](std::size_t begin, std::size_t end, std::size_t block)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (!this->IsInserted[i])
        {
          blocks[block][getRound(static_cast<Id>(i))].push_back(static_cast<Id>(i));
        }
      }
    });
  this->Workers = std::vector<Worker>(static_cast<std::size_t>(std::max(1, numberOfThreads)));
  Status status;
  for (std::size_t round = 0; round < none.size(); ++round)
  {
    std::vector<Id> vertices;
    for (Rounds& block : blocks)
    {
      vertices.insert(vertices.end(), block[round].begin(), block[round].end());
      block[round] = std::vector<Id>();
    }
    status = this->InsertRound(std::move(vertices), numberOfThreads);
    if (!status.IsOk())
    {
      return status;
    }
  }
  this->Insertion.Finish(this->Workers[0].Space);
  for (const Worker& worker : this->Workers)
  {
    this->Output.HasCosphericalPoints = this->Output.HasCosphericalPoints || worker.Space.HasTies;
  }
  return status;
}
} // namespace

Status BuildDelaunayTetrahedralization(const RawVector<Vec3>& points,
  const std::vector<Id>& numbers, const GridBlock& block, int numberOfThreads,
  const ExecutionContext& context, DelaunayTetrahedralization& output)
{
  output = DelaunayTetrahedralization();
  Builder builder(points, numbers, context, output);
  const bool hasBlock =
    !block.IsEmpty() && GetNumberOfTetrahedra(block) <= VertexInsertion::MaximumTetrahedra;
  Status status =
    hasBlock ? builder.StartFromBlock(block, numbers, numberOfThreads) : builder.Start();
  if (status.IsOk() && (!hasBlock || block.Points.size() < points.size()))
  {
    status = builder.InsertOthers(numberOfThreads);
  }
  if (!status.IsOk())
  {
    output = DelaunayTetrahedralization();
  }
  return status;
}

Id LocateInTetrahedralization(const RawVector<Vec3>& points,
  const DelaunayTetrahedralization& tetrahedralization, const Vec3& position)
{
  const Id infinite = static_cast<Id>(points.size());
  const auto isInfinite = [&](Id t)
  {
    const TetrahedronIds& ids = tetrahedralization.Tetrahedra[t];
    return Contains(ids, infinite);
  };
  Id t = 0;
  while (tetrahedralization.Tetrahedra[t][0] == NoId || isInfinite(t))
  {
    ++t;
  }
  // Delaunay tetrahedra cannot see each other in a circle: the walk ends.
  for (int i = 0; i < 4; ++i)
  {
    const TriangleIds facet = GetFacet(tetrahedralization.Tetrahedra[t], i);
    if (Orientation(points[facet[0]], points[facet[1]], points[facet[2]], position) > 0)
    {
      t = tetrahedralization.Neighbors[t][i] / 4;
      if (isInfinite(t))
      {
        return NoId;
      }
      i = -1;
    }
  }
  return t;
}
} // namespace cdm
