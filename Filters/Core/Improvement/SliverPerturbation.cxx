// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverPerturbation.h"

#include "Core/Basics/Threads.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/SliverChanges.h"
#include "Core/Improvement/SliverList.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

namespace cdm
{
namespace
{
constexpr std::size_t ReportInterval = 16;
/**
 * Slivers that threads look at before the first of them is mended: one for so many tetrahedra. Where
 * they are closer, more of what was found is out of date when its turn comes.
 */
constexpr std::size_t TetrahedraPerSliver = 4000;
constexpr std::size_t FewestAhead = 8;
constexpr std::size_t MostAhead = 256;

/**
 * Mends slivers of a list, one after the other. Threads look ahead for the changes of the next ones.
 * At its turn, a change is made if the tetrahedra that the search has looked at are still there, and
 * looked for again if not. So the mesh is the same for any number of threads.
 */
class Perturbation
{
public:
  Perturbation(const SliverAim& aim, int numberOfThreads, RefinedMesh& mesh);

  /** Begins with a list; slivers at or above the angle are not worth an insertion. */
  void Start(std::vector<Sliver> slivers, double insertedBelow);
  std::size_t GetNumberOfSlivers() const { return this->Slivers.size(); }
  const Sliver& GetSliver(std::size_t i) const { return this->Slivers[i]; }
  /** False if nothing helps, or is known not to; then nothing has changed. */
  bool Mend(std::size_t i);

private:
  /** What a thread has found for a sliver. */
  struct Foreseen
  {
    bool IsKnown = false;
    SliverChange Change;
    std::vector<Id> Visited;
  };
  SliverAttempt GetLast(const Sliver& sliver) const
  {
    return sliver.Angle < this->InsertedBelow ? SliverAttempt::Insertion : SliverAttempt::Move;
  }
  bool IsHopeless(const Sliver& sliver) const;
  void LookAhead(std::size_t first);
  bool IsTrue(const Foreseen& foreseen) const;
  SliverChange Find(std::size_t i);
  void Make(const SliverChange& change, Id tetrahedron);

  RefinedMesh& Mesh;
  /** One for each thread. */
  std::vector<SliverChanges> Changes;
  std::vector<Sliver> Slivers;
  double InsertedBelow = 0.0;
  /** For the slivers from First on, and the stamp of the first tetrahedron made since then. */
  std::vector<Foreseen> Ahead;
  std::size_t First = 0;
  std::int64_t NextStamp = 0;
};

Perturbation::Perturbation(const SliverAim& aim, int numberOfThreads, RefinedMesh& mesh)
  : Mesh(mesh)
{
  for (int i = 0; i < numberOfThreads; ++i)
  {
    this->Changes.emplace_back(aim, mesh, numberOfThreads > 1);
  }
}

void Perturbation::Start(std::vector<Sliver> slivers, double insertedBelow)
{
  this->Slivers = std::move(slivers);
  this->InsertedBelow = insertedBelow;
  this->Ahead.clear();
  this->First = 0;
}

bool Perturbation::IsHopeless(const Sliver& sliver) const
{
  const TetrahedronIds& ids = this->Mesh.GetMesh().Tetrahedra[sliver.Tetrahedron];
  return this->Mesh.GetMemory().IsHopeless(this->Mesh.GetNames(ids), this->GetLast(sliver));
}

void Perturbation::LookAhead(std::size_t first)
{
  const std::size_t most = std::clamp(
    this->Mesh.GetMesh().Tetrahedra.size() / TetrahedraPerSliver, FewestAhead, MostAhead);
  this->First = first;
  this->NextStamp = this->Mesh.GetTetrahedra().GetNextStamp();
  this->Ahead.clear();
  std::vector<std::size_t> open;
  for (std::size_t i = first; i < this->Slivers.size() && open.size() < most; ++i)
  {
    this->Ahead.emplace_back();
    if (!IsGone(this->Slivers[i], this->Mesh) && !this->IsHopeless(this->Slivers[i]))
    {
      open.push_back(i);
    }
  }
  const std::size_t threads = std::min(this->Changes.size(), open.size());
  if (threads < 2)
  {
    return;
  }
  std::atomic<std::size_t> next{ 0 };
  this->Mesh.Freeze(true);
  RunOnThreads(static_cast<int>(threads),
    [&](int thread)
    {
      SliverChanges& changes = this->Changes[static_cast<std::size_t>(thread)];
      for (std::size_t k = next++; k < open.size(); k = next++)
      {
        const Sliver& sliver = this->Slivers[open[k]];
        const SliverChange change = changes.Find(sliver.Tetrahedron, this->GetLast(sliver));
        this->Ahead[open[k] - first] = { true, change, changes.GetVisited() };
      }
    });
  this->Mesh.Freeze(false);
}

/** Whether the search would find the same now. */
bool Perturbation::IsTrue(const Foreseen& foreseen) const
{
  const DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
  return foreseen.IsKnown &&
    !(foreseen.Change.What == SliverChange::Kind::Insertion && this->Mesh.IsFull()) &&
    std::all_of(foreseen.Visited.begin(), foreseen.Visited.end(),
      [&](Id t) { return mesh.GetStamp(t) < this->NextStamp; });
}

SliverChange Perturbation::Find(std::size_t i)
{
  if (this->Changes.size() > 1)
  {
    if (i >= this->First + this->Ahead.size())
    {
      this->LookAhead(i);
    }
    const Foreseen& foreseen = this->Ahead[i - this->First];
    if (this->IsTrue(foreseen))
    {
      return foreseen.Change;
    }
  }
  const Sliver& sliver = this->Slivers[i];
  return this->Changes.front().Find(sliver.Tetrahedron, this->GetLast(sliver));
}

void Perturbation::Make(const SliverChange& change, Id tetrahedron)
{
  DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
  if (change.What == SliverChange::Kind::Insertion)
  {
    this->Mesh.FindCavity(change.Position, tetrahedron);
    this->Mesh.Insert(change.Position);
    return;
  }
  mesh.Remove(change.Point, change.Star, change.Cells);
  if (change.What == SliverChange::Kind::Removal)
  {
    this->Mesh.NoteRemoval();
    return;
  }
  const Id first = mesh.Locate(change.Position, mesh.GetChanged().front());
  this->Mesh.FindCavity(change.Position, first, change.Point);
  this->Mesh.Restore(change.Point, change.Position);
}

bool Perturbation::Mend(std::size_t i)
{
  const Sliver& sliver = this->Slivers[i];
  if (this->IsHopeless(sliver))
  {
    return false;
  }
  const SliverChange change = this->Find(i);
  if (change.What == SliverChange::Kind::None)
  {
    const TetrahedronIds& ids = this->Mesh.GetMesh().Tetrahedra[sliver.Tetrahedron];
    this->Mesh.GetMemory().SetHopeless(this->Mesh.GetNames(ids), this->GetLast(sliver));
    return false;
  }
  this->Make(change, sliver.Tetrahedron);
  return true;
}
} // namespace

Status PerturbSlivers(
  double target, SliverMeans means, const ExecutionContext& context, RefinedMesh& mesh)
{
  const SliverAim aim{ MoveRatio * target, false, means != SliverMeans::Moves };
  Perturbation perturbation(aim, context.GetNumberOfThreads(), mesh);
  const IdLists& pointTriangles = mesh.GetShape().PointTriangles;
  BoundaryRequests& requests = mesh.GetRequests();
  // First moves, then new points as well; when neither helps any more, requests.
  bool mayInsert = false;
  bool isLast = false;
  std::vector<TetrahedronIds> unmet;
  for (int pass = 0; pass < MaximumSliverPasses; ++pass)
  {
    perturbation.Start(FindSlivers(aim.Target, aim.IsSharp, mesh), mayInsert ? target : 0.0);
    const std::size_t count = perturbation.GetNumberOfSlivers();
    bool isMended = false;
    for (std::size_t i = 0; i < count; ++i)
    {
      if (i % ReportInterval == 0 &&
        !context.Continue((pass + static_cast<double>(i) / count) / MaximumSliverPasses,
          "Moving points of slivers"))
      {
        return Status::Aborted();
      }
      const Sliver& sliver = perturbation.GetSliver(i);
      if (IsGone(sliver, mesh))
      {
        continue;
      }
      const TetrahedronIds ids = mesh.GetMesh().Tetrahedra[sliver.Tetrahedron];
      const bool isBad = sliver.Angle < target;
      if (perturbation.Mend(i))
      {
        isMended = isMended || isBad;
        continue;
      }
      if (isBad && isLast && means == SliverMeans::Requests)
      {
        unmet.push_back(ids);
        const auto [a, b, c, d] = mesh.GetTetrahedra().GetCorners(sliver.Tetrahedron);
        const Vec3 center = GetCircumcenter(a, b, c, d);
        if (!requests.AddEdgeOfTwoTriangles(ids, pointTriangles) && IsFinite(center))
        {
          mesh.RequestEncroached(center, true);
        }
      }
    }
    const bool isMoving = means == SliverMeans::Moves;
    if (isLast || count == 0 || (isMoving && !isMended))
    {
      break;
    }
    isLast = mayInsert && !isMended;
    mayInsert = !isMoving;
  }
  // No edge or triangle of the boundary is in the way. A point on a boundary triangle beside the
  // sliver may still help: request one for all slivers that have a point in common.
  if (requests.GetNumber() == 0)
  {
    std::vector<Id> near;
    for (const TetrahedronIds& ids : unmet)
    {
      if (std::none_of(ids.begin(), ids.end(),
            [&near](Id id) { return std::find(near.begin(), near.end(), id) != near.end(); }))
      {
        requests.AddLargestTriangle(ids, pointTriangles);
        near.insert(near.end(), ids.begin(), ids.end());
      }
    }
  }
  return Status();
}

Status PerturbSharp(double target, const ExecutionContext& context, RefinedMesh& mesh)
{
  const SliverAim aim{ MoveRatio * target, true };
  Perturbation perturbation(aim, context.GetNumberOfThreads(), mesh);
  perturbation.Start(FindSlivers(aim.Target, aim.IsSharp, mesh), 0.0);
  const std::size_t count = perturbation.GetNumberOfSlivers();
  for (std::size_t i = 0; i < count; ++i)
  {
    if (i % ReportInterval == 0 &&
      !context.Continue(static_cast<double>(i) / count, "Moving points at sharp angles"))
    {
      return Status::Aborted();
    }
    if (!IsGone(perturbation.GetSliver(i), mesh))
    {
      perturbation.Mend(i);
    }
  }
  return Status();
}
} // namespace cdm
