// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/VolumeRefinement.h"

#include "Core/Basics/SortedIds.h"
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
/**
 * Threads search for at least so many tasks at a time, some 50 microseconds: with fewer, 16 threads
 * were slower than 4.
 */
constexpr std::size_t TasksPerThread = 16;
/** A task is searched ahead for each so many tetrahedra of the mesh: see LookAhead.h. */
constexpr std::size_t TetrahedraPerTask = 200;
/** A thread looks for faults of so many tetrahedra at a time. */
constexpr std::size_t TestsAtOnce = 64;
/** A batch has at least so many tasks, if there are as many. */
constexpr std::size_t FewestInBatch = 32;
/** A batch of more tasks than that is one in so many of the tasks that are left. */
constexpr std::size_t BatchesForAll = 30;

/** A tetrahedron that gets a point. */
struct Task
{
  double Severity = 0.0;
  std::int64_t Stamp = 0;
  Id Tetrahedron = NoId;
  TetrahedronFault Fault = TetrahedronFault::None;

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
class TaskList
{
public:
  explicit TaskList(const DynamicTetrahedralization& mesh) : Mesh(mesh) {}

  std::size_t GetSize() const { return this->Tasks.size(); }
  bool IsGone(const Task& task) const
  {
    return task.Stamp != this->Mesh.GetStamp(task.Tetrahedron);
  }

  void Add(const Task& task)
  {
    if (this->Tasks.size() >= this->Limit)
    {
      this->Tasks.erase(std::remove_if(this->Tasks.begin(), this->Tasks.end(),
                          [this](const Task& old) { return this->IsGone(old); }),
        this->Tasks.end());
      this->Limit = std::max(SmallestLimit, 2 * this->Tasks.size());
    }
    this->Tasks.push_back(task);
  }

  /** Takes the most urgent tasks out, the first one first. Some of them may be gone. */
  void TakeFirst(std::size_t count, std::vector<Task>& taken)
  {
    const auto first =
      this->Tasks.end() - static_cast<std::ptrdiff_t>(std::min(count, this->Tasks.size()));
    std::nth_element(this->Tasks.begin(), first, this->Tasks.end());
    taken.assign(first, this->Tasks.end());
    this->Tasks.erase(first, this->Tasks.end());
    std::sort(taken.rbegin(), taken.rend());
  }

private:
  static constexpr std::size_t SmallestLimit = 1 << 16;

  const DynamicTetrahedralization& Mesh;
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

/** Refines tetrahedra in batches of the most urgent ones; threads look ahead. */
class LimitRefinement
{
public:
  LimitRefinement(bool isShapeTested, RefinedMesh& mesh)
    : IsShapeTested(isShapeTested), Mesh(mesh), Tasks(mesh.GetTetrahedra()),
      Ahead(mesh, TasksPerThread, TetrahedraPerTask)
  {
  }
  Status Run(const ExecutionContext& context);

private:
  void Schedule();
  Task MakeTask(Id tetrahedron) const;
  void TakeBatch();
  void RunTask(std::size_t i);
  void Find(int thread, const Task& task, Remedy& remedy) const;
  void Apply(const Task& task, const Remedy& remedy);

  const bool IsShapeTested;
  RefinedMesh& Mesh;
  /** Tetrahedra that have been made, some more than once. */
  std::vector<Id> Made;
  /** Work space: marks for VisitAscending(). */
  std::vector<std::uint64_t> Marks;
  /** Work space: tetrahedra that may be tasks, once each; and their tasks, or ones without a fault. */
  std::vector<Id> Candidates;
  std::vector<Task> Found;
  TaskList Tasks;
  std::vector<Task> Batch;
  LookAhead<Remedy> Ahead;
};

/** Several threads may call it for different tetrahedra while the mesh does not change. */
Task LimitRefinement::MakeTask(Id tetrahedron) const
{
  const DynamicTetrahedralization& tetrahedra = this->Mesh.GetTetrahedra();
  Task task{ 0.0, tetrahedra.GetStamp(tetrahedron), tetrahedron, TetrahedronFault::None };
  if (!tetrahedra.IsDead(tetrahedron) && this->Mesh.IsFaulty(tetrahedron, this->IsShapeTested))
  {
    Vec3 target;
    task.Fault =
      this->Mesh.GetLimits().Find(tetrahedra.GetCorners(tetrahedron), true, target, task.Severity);
  }
  return task;
}

/** Makes tasks of the tetrahedra that have been made and break a limit. */
void LimitRefinement::Schedule()
{
  this->Candidates.clear();
  VisitAscending(this->Made.begin(), this->Made.end(), this->Marks,
    [this](Id t) { this->Candidates.push_back(t); });
  this->Made.clear();
  this->Found.resize(this->Candidates.size());
  this->Mesh.MakeRoomForFacts();
  ThreadTeam& team = this->Mesh.GetThreads();
  team.RunBlocks(team.GetNumberOfThreads(), this->Candidates.size(), TestsAtOnce,
    [this](std::size_t begin, std::size_t end, int)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        this->Found[i] = this->MakeTask(this->Candidates[i]);
      }
    });
  for (const Task& task : this->Found)
  {
    if (task.Fault != TetrahedronFault::None)
    {
      this->Tasks.Add(task);
    }
  }
}

/** The next tasks, the most urgent one first. */
void LimitRefinement::TakeBatch()
{
  this->Ahead.Clear();
  this->Tasks.TakeFirst(
    std::max(this->Tasks.GetSize() / BatchesForAll, FewestInBatch), this->Batch);
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
    const std::vector<Id>& made = this->Mesh.GetTetrahedra().GetChanged();
    this->Made.insert(this->Made.end(), made.begin(), made.end());
  }
}

/** Runs a task of the batch, unless its tetrahedron is gone. */
void LimitRefinement::RunTask(std::size_t i)
{
  if (this->Tasks.IsGone(this->Batch[i]))
  {
    return;
  }
  const Remedy& remedy = this->Ahead.Get(
    i, this->Batch.size(),
    [this](std::size_t k)
    { return this->Tasks.IsGone(this->Batch[k]) ? NoId : this->Batch[k].Tetrahedron; },
    [this](int thread, std::size_t k, LookAhead<Remedy>::Found& result)
    {
      this->Find(thread, this->Batch[k], result.What);
      result.Visited = this->Mesh.GetSearch(thread).GetVisited();
    });
  this->Apply(this->Batch[i], remedy);
}

Status LimitRefinement::Run(const ExecutionContext& context)
{
  this->Made = this->Mesh.FindFaulty(this->IsShapeTested);
  std::size_t done = 0;
  for (;;)
  {
    this->Schedule();
    this->TakeBatch();
    if (this->Batch.empty())
    {
      return Status();
    }
    for (std::size_t i = 0; i < this->Batch.size(); ++i, ++done)
    {
      if (this->Mesh.IsFull())
      {
        return Status();
      }
      const std::size_t left = this->Tasks.GetSize() + this->Batch.size() - i;
      if (done % InsertionsBetweenChecks == 0 &&
        !context.Continue(
          static_cast<double>(done) / static_cast<double>(done + left), "Refining tetrahedra"))
      {
        return Status::Aborted();
      }
      this->RunTask(i);
    }
  }
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
