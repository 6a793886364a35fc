// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/VolumeRefinement.h"

#include <algorithm>
#include <cstdint>
#include <queue>
#include <vector>

namespace cdm
{
namespace
{
constexpr std::size_t ReportInterval = 256;
/** Free points closer to others than this part of the sizing are removed. */
constexpr double CloseRatio = 0.3;

struct Task
{
  TetrahedronFault Fault;
  double Severity;
  Id Tetrahedron;
  std::int64_t Stamp;

  /** Large ones first, then the most severe fault, then the smallest id. */
  friend bool operator<(const Task& a, const Task& b)
  {
    return a.Fault != b.Fault    ? a.Fault > b.Fault
      : a.Severity != b.Severity ? a.Severity < b.Severity
                                 : a.Tetrahedron > b.Tetrahedron;
  }
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
      mesh.NoteRemoval();
    }
  }
}

Status RefineByLimits(bool isShapeTested, const ExecutionContext& context, RefinedMesh& mesh)
{
  const DynamicTetrahedralization& tetrahedra = mesh.GetTetrahedra();
  std::priority_queue<Task> tasks;
  const auto schedule = [&](Id t)
  {
    Vec3 target;
    double severity = 0.0;
    const TetrahedronFault fault =
      mesh.GetLimits().Find(tetrahedra.GetCorners(t), true, target, severity);
    tasks.push({ fault, severity, t, tetrahedra.GetStamp(t) });
  };
  for (Id t : mesh.FindFaulty(isShapeTested))
  {
    schedule(t);
  }
  for (std::size_t done = 0; !tasks.empty() && !mesh.IsFull(); ++done)
  {
    if (done % ReportInterval == 0 &&
      !context.Continue(static_cast<double>(done) / static_cast<double>(done + tasks.size()),
        "Refining tetrahedra"))
    {
      return Status::Aborted();
    }
    const Task task = tasks.top();
    tasks.pop();
    if (task.Stamp != tetrahedra.GetStamp(task.Tetrahedron))
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
