// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/VolumeRefinement.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace cdm
{
namespace
{
constexpr std::size_t ReportInterval = 256;
/** Free points closer to others than this part of the sizing are removed. */
constexpr double CloseRatio = 0.3;

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
  const DynamicTetrahedralization& tetrahedra = mesh.GetTetrahedra();
  TaskQueue tasks(tetrahedra);
  const auto schedule = [&](Id t)
  {
    Vec3 target;
    double severity = 0.0;
    const TetrahedronFault fault =
      mesh.GetLimits().Find(tetrahedra.GetCorners(t), true, target, severity);
    tasks.Push({ severity, tetrahedra.GetStamp(t), t, fault });
  };
  for (Id t : mesh.FindFaulty(isShapeTested))
  {
    schedule(t);
  }
  for (std::size_t done = 0; !tasks.IsEmpty() && !mesh.IsFull(); ++done)
  {
    if (done % ReportInterval == 0 &&
      !context.Continue(static_cast<double>(done) / static_cast<double>(done + tasks.GetSize()),
        "Refining tetrahedra"))
    {
      return Status::Aborted();
    }
    const Task task = tasks.Pop();
    if (tasks.IsGone(task))
    {
      continue;
    }
    Vec3 target;
    double severity = 0.0;
    mesh.GetLimits().Find(tetrahedra.GetCorners(task.Tetrahedron), isShapeTested, target, severity);
    if (!IsFinite(target))
    {
      continue;
    }
    const bool isSizeKept = task.Fault == TetrahedronFault::Shape;
    if (!mesh.RequestEncroached(target, isSizeKept) && mesh.FindCavity(target, task.Tetrahedron) &&
      (!isSizeKept || mesh.IsClear(mesh.GetCavity(), target)))
    {
      mesh.Insert(target);
      for (Id t : tetrahedra.GetChanged())
      {
        if (mesh.IsFaulty(t, isShapeTested))
        {
          schedule(t);
        }
      }
    }
  }
  return Status();
}
} // namespace cdm
