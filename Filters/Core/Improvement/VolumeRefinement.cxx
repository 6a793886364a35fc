// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/VolumeRefinement.h"

#include "Core/Improvement/LookAhead.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace cdm
{
namespace
{
constexpr std::size_t InsertionsBetweenChecks = 256;
/** Free points closer to others than this part of the sizing are removed. */
constexpr double CloseRatio = 0.3;
/** Threads take at least so many at a time, some 50 microseconds: with fewer, 16 were slower than 4. */
constexpr std::size_t TasksPerThread = 16;

/** A tetrahedron that gets a point. */
struct Task
{
  double Severity;
  std::int64_t Stamp;
  Id Tetrahedron;
  TetrahedronFault Fault;

  /** Large ones first, then the most severe fault, then the smallest id. */
  friend bool operator<(const Task& a, const Task& b)
  {
    return a.Fault != b.Fault    ? a.Fault > b.Fault
      : a.Severity != b.Severity ? a.Severity < b.Severity
                                 : a.Tetrahedron > b.Tetrahedron;
  }
};

/**
 * The tasks that are left. Most tetrahedra are replaced before it is their turn: from time to time
 * those are taken out, as they took as much memory as the mesh.
 */
class TaskQueue
{
public:
  explicit TaskQueue(const DynamicTetrahedralization& mesh) : Mesh(mesh) {}

  bool IsEmpty() const { return this->Tasks.empty(); }
  std::size_t GetSize() const { return this->Tasks.size(); }
  bool IsGone(const Task& task) const
  {
    return task.Stamp != this->Mesh.GetStamp(task.Tetrahedron);
  }

  void Push(const Task& task)
  {
    if (this->Tasks.size() >= this->Limit)
    {
      this->Tasks.erase(std::remove_if(this->Tasks.begin(), this->Tasks.end(),
                          [this](const Task& old) { return this->IsGone(old); }),
        this->Tasks.end());
      std::make_heap(this->Tasks.begin(), this->Tasks.end());
      this->Limit = std::max(SmallestLimit, 2 * this->Tasks.size());
    }
    this->Tasks.push_back(task);
    std::push_heap(this->Tasks.begin(), this->Tasks.end());
  }

  const Task& GetFirst() const { return this->Tasks.front(); }
  Task Pop()
  {
    std::pop_heap(this->Tasks.begin(), this->Tasks.end());
    const Task task = this->Tasks.back();
    this->Tasks.pop_back();
    return task;
  }

private:
  static constexpr std::size_t SmallestLimit = 1 << 16;

  const DynamicTetrahedralization& Mesh;
  /** A heap. */
  std::vector<Task> Tasks;
  std::size_t Limit = SmallestLimit;
};

/** What is to be done about a tetrahedron: one of these, or nothing. */
struct Remedy
{
  Vec3 Target;
  /** If that is not empty, splits of the boundary are requested. */
  BoundarySpheres::Encroached Encroached;
  bool IsInsertion = false;
  PointCavity Cavity;
};

/** Refines tetrahedra, the most urgent one first; threads look ahead. */
class LimitRefinement
{
public:
  LimitRefinement(bool isShapeTested, RefinedMesh& mesh)
    : IsShapeTested(isShapeTested), Mesh(mesh), Tasks(mesh.GetTetrahedra()),
      Ahead(mesh, TasksPerThread)
  {
  }
  Status Run(const ExecutionContext& context);

private:
  void Schedule(Id tetrahedron);
  bool HasTasks();
  void RunNext();
  void Find(int thread, const Task& task, Remedy& remedy) const;
  void Apply(const Task& task, const Remedy& remedy);

  const bool IsShapeTested;
  RefinedMesh& Mesh;
  TaskQueue Tasks;
  /** Tasks taken from the queue, ahead of their turn, and the place of the next one. */
  std::vector<Task> Batch;
  std::size_t Next = 0;
  LookAhead<Remedy> Ahead;
  /** What is to be done about a task that came before the batch's next one. */
  Remedy Urgent;
};

void LimitRefinement::Schedule(Id tetrahedron)
{
  const DynamicTetrahedralization& tetrahedra = this->Mesh.GetTetrahedra();
  Vec3 target;
  double severity = 0.0;
  const TetrahedronFault fault =
    this->Mesh.GetLimits().Find(tetrahedra.GetCorners(tetrahedron), true, target, severity);
  this->Tasks.Push({ severity, tetrahedra.GetStamp(tetrahedron), tetrahedron, fault });
}

/** Whether there is a task; if so, the batch has one. */
bool LimitRefinement::HasTasks()
{
  if (this->Next == this->Batch.size())
  {
    this->Batch.clear();
    this->Next = 0;
    this->Ahead.Clear();
    const std::size_t most = this->Ahead.GetBatchSize();
    while (this->Batch.size() < most && !this->Tasks.IsEmpty())
    {
      const Task task = this->Tasks.Pop();
      if (!this->Tasks.IsGone(task))
      {
        this->Batch.push_back(task);
      }
    }
  }
  return !this->Batch.empty();
}

/** Several threads may call it while the mesh does not change. */
void LimitRefinement::Find(int thread, const Task& task, Remedy& remedy) const
{
  const DynamicTetrahedralization& tetrahedra = this->Mesh.GetTetrahedra();
  CavitySearch& search = this->Mesh.GetSearch(thread);
  search.StartRecord();
  remedy.Encroached.Clear();
  remedy.IsInsertion = false;
  double severity = 0.0;
  this->Mesh.GetLimits().Find(
    tetrahedra.GetCorners(task.Tetrahedron), this->IsShapeTested, remedy.Target, severity);
  if (!IsFinite(remedy.Target))
  {
    return;
  }
  this->Mesh.GetShape().Spheres.Find(remedy.Target, remedy.Encroached);
  remedy.IsInsertion = remedy.Encroached.IsEmpty() &&
    search.FindCavity(
      remedy.Target, tetrahedra.GetNumberOfPoints(), task.Tetrahedron, remedy.Cavity) &&
    (task.Fault != TetrahedronFault::Shape || this->Mesh.IsClear(remedy.Cavity, remedy.Target));
}

void LimitRefinement::Apply(const Task& task, const Remedy& remedy)
{
  if (!remedy.Encroached.IsEmpty())
  {
    this->Mesh.GetRequests().AddEncroached(
      remedy.Target, remedy.Encroached, task.Fault == TetrahedronFault::Shape);
  }
  else if (remedy.IsInsertion)
  {
    this->Mesh.Insert(remedy.Target, remedy.Cavity);
    for (Id t : this->Mesh.GetTetrahedra().GetChanged())
    {
      if (this->Mesh.IsFaulty(t, this->IsShapeTested))
      {
        this->Schedule(t);
      }
    }
  }
}

/** The most urgent task is the next one of the batch, or one that is newer. */
void LimitRefinement::RunNext()
{
  if (!this->Tasks.IsEmpty() && this->Batch[this->Next] < this->Tasks.GetFirst())
  {
    const Task task = this->Tasks.Pop();
    if (!this->Tasks.IsGone(task))
    {
      this->Find(0, task, this->Urgent);
      this->Apply(task, this->Urgent);
    }
    return;
  }
  const std::size_t i = this->Next++;
  const Task task = this->Batch[i];
  if (this->Tasks.IsGone(task))
  {
    return;
  }
  const Remedy& remedy = this->Ahead.Get(
    i, this->Batch.size(), [this](std::size_t k) { return !this->Tasks.IsGone(this->Batch[k]); },
    [this](int thread, std::size_t k, LookAhead<Remedy>::Found& result)
    {
      this->Find(thread, this->Batch[k], result.What);
      result.Visited = this->Mesh.GetSearch(thread).GetVisited();
    });
  this->Apply(task, remedy);
}

Status LimitRefinement::Run(const ExecutionContext& context)
{
  for (Id t : this->Mesh.FindFaulty(this->IsShapeTested))
  {
    this->Schedule(t);
  }
  for (std::size_t done = 0; !this->Mesh.IsFull() && this->HasTasks(); ++done)
  {
    const std::size_t left = this->Tasks.GetSize() + this->Batch.size() - this->Next;
    if (done % InsertionsBetweenChecks == 0 &&
      !context.Continue(
        static_cast<double>(done) / static_cast<double>(done + left), "Refining tetrahedra"))
    {
      return Status::Aborted();
    }
    this->RunNext();
  }
  return Status();
}
} // namespace

void RemoveClosePoints(double smallest, const SizingField& sizing, RefinedMesh& mesh)
{
  DynamicTetrahedralization& tetrahedra = mesh.GetTetrahedra();
  std::vector<Id> star;
  for (Id p = 0; p < tetrahedra.GetNumberOfPoints(); ++p)
  {
    if (!mesh.IsFree(p) || !tetrahedra.FindStar(p, star))
    {
      continue;
    }
    const Vec3& position = tetrahedra.GetPoint(p);
    const double limit =
      std::max(smallest, sizing ? CloseRatio * sizing(position).GetSmallest() : 0.0);
    const bool isClose = std::any_of(star.begin(), star.end(),
      [&](Id t)
      {
        const TetrahedronIds& ids = mesh.GetMesh().Tetrahedra[t];
        return std::any_of(ids.begin(), ids.end(),
          [&](Id id) { return id != p && Distance(position, tetrahedra.GetPoint(id)) < limit; });
      });
    if (isClose && tetrahedra.Remove(p))
    {
      mesh.NoteRemoval(p);
    }
  }
}

Status RefineByLimits(bool isShapeTested, const ExecutionContext& context, RefinedMesh& mesh)
{
  return LimitRefinement(isShapeTested, mesh).Run(context);
}
} // namespace cdm
