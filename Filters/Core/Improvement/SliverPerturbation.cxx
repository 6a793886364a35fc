// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverPerturbation.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/LookAhead.h"
#include "Core/Improvement/SliverChanges.h"
#include "Core/Improvement/SliverList.h"

#include <algorithm>
#include <utility>

namespace cdm
{
namespace
{
constexpr std::size_t SliversBetweenChecks = 16;
/**
 * Passes over slivers at sharp angles go on as long as one mends more than this part of them. The first
 * one only moves points: where that helps few, as in thin layers, new ones do not either.
 */
constexpr int MaximumSharpPasses = 5;
constexpr double WorthwhileRatio = 0.05;

/** Mends slivers of a list, one after the other; threads look ahead. */
class Perturbation
{
public:
  Perturbation(const SliverAim& aim, RefinedMesh& mesh);

  /** Begins with a list; slivers at or above the angle are not worth an insertion. */
  void Start(std::vector<Sliver> slivers, double insertedBelow);
  std::size_t GetNumberOfSlivers() const { return this->Slivers.size(); }
  const Sliver& GetSliver(std::size_t i) const { return this->Slivers[i]; }
  /** False if nothing helps, or is known not to; then nothing has changed. */
  bool Mend(std::size_t i);

private:
  SliverAttempt GetLast(const Sliver& sliver) const
  {
    return sliver.Angle < this->InsertedBelow ? SliverAttempt::Insertion : SliverAttempt::Move;
  }
  bool IsHopeless(const Sliver& sliver) const;
  const SliverChange& Find(std::size_t i);
  void Make(const SliverChange& change);

  RefinedMesh& Mesh;
  const SliverPlace Place;
  /** One for each thread. */
  std::vector<SliverChanges> Changes;
  std::vector<Sliver> Slivers;
  double InsertedBelow = 0.0;
  LookAhead<SliverChange> Ahead;
};

Perturbation::Perturbation(const SliverAim& aim, RefinedMesh& mesh)
  : Mesh(mesh), Place(aim.Place), Ahead(mesh, SliversPerThread, TetrahedraPerSliver)
{
  for (int i = 0; i < mesh.GetThreads().GetNumberOfThreads(); ++i)
  {
    this->Changes.emplace_back(aim, mesh, mesh.GetSearch(i));
  }
}

void Perturbation::Start(std::vector<Sliver> slivers, double insertedBelow)
{
  this->Slivers = std::move(slivers);
  this->InsertedBelow = insertedBelow;
  this->Ahead.Clear();
}

bool Perturbation::IsHopeless(const Sliver& sliver) const
{
  return cdm::IsHopeless(sliver, this->GetLast(sliver), this->Mesh);
}

const SliverChange& Perturbation::Find(std::size_t i)
{
  const auto find = [this](int thread, std::size_t k, LookAhead<SliverChange>::Found& result)
  {
    SliverChanges& changes = this->Changes[static_cast<std::size_t>(thread)];
    const Sliver& sliver = this->Slivers[k];
    result.What = changes.Find(sliver.Tetrahedron, this->GetLast(sliver));
    result.Visited = changes.GetVisited();
  };
  return this->Ahead.Get(
    i, this->Slivers.size(),
    [this](std::size_t k)
    { return !IsGone(this->Slivers[k], this->Mesh) && !this->IsHopeless(this->Slivers[k]); },
    find,
    // A mesh that was not full then may be full now.
    [this](const SliverChange& change)
    { return change.What != SliverChange::Kind::Insertion || !this->Mesh.IsFull(); });
}

void Perturbation::Make(const SliverChange& change)
{
  DynamicTetrahedralization& mesh = this->Mesh.GetTetrahedra();
  if (change.What == SliverChange::Kind::Insertion)
  {
    this->Mesh.Insert(change.Position, change.Cavity);
    return;
  }
  mesh.Remove(change.Point, change.Star, change.Cells);
  if (change.What == SliverChange::Kind::Removal)
  {
    this->Mesh.NoteRemoval(change.Point);
    return;
  }
  PointCavity cavity = change.Cavity;
  mesh.NumberCells(change.FirstCell, cavity);
  this->Mesh.Restore(change.Point, change.Position, cavity);
}

bool Perturbation::Mend(std::size_t i)
{
  const Sliver& sliver = this->Slivers[i];
  if (this->IsHopeless(sliver))
  {
    return false;
  }
  const SliverChange& change = this->Find(i);
  this->Mesh.SetImmovable(change.Immovable, this->Place);
  if (change.What == SliverChange::Kind::None)
  {
    SetHopeless(sliver, this->GetLast(sliver), this->Mesh);
    return false;
  }
  this->Make(change);
  return true;
}
} // namespace

Status PerturbSlivers(double target, SliverMeans means, const SearchEffort& effort,
  const ExecutionContext& context, RefinedMesh& mesh)
{
  const SliverAim aim{ MoveRatio * target, SliverPlace::Elsewhere, means != SliverMeans::Moves,
    effort };
  Perturbation perturbation(aim, mesh);
  const IdLists& pointTriangles = mesh.GetShape().PointTriangles;
  BoundaryRequests& requests = mesh.GetRequests();
  // First moves, then new points as well; when neither helps any more, requests.
  bool mayInsert = false;
  bool isLast = false;
  std::vector<TetrahedronIds> unmet;
  for (int pass = 0; pass < MaximumSliverPasses; ++pass)
  {
    perturbation.Start(FindSlivers(aim.Target, aim.Place, mesh), mayInsert ? target : 0.0);
    const std::size_t count = perturbation.GetNumberOfSlivers();
    bool isMended = false;
    for (std::size_t i = 0; i < count; ++i)
    {
      if (i % SliversBetweenChecks == 0 &&
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
      if (std::none_of(ids.begin(), ids.end(), [&near](Id id) { return Contains(near, id); }))
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
  // Those just above the target stay: to move them, too, took longer and mended no more.
  const SliverAim aim{ target, SliverPlace::SharpAngle };
  Perturbation perturbation(aim, mesh);
  bool isWorthwhile = true;
  for (int pass = 0; pass < MaximumSharpPasses && isWorthwhile; ++pass)
  {
    perturbation.Start(FindSlivers(aim.Target, aim.Place, mesh), pass > 0 ? target : 0.0);
    const std::size_t count = perturbation.GetNumberOfSlivers();
    std::size_t mended = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      if (i % SliversBetweenChecks == 0 &&
        !context.Continue((pass + static_cast<double>(i) / count) / MaximumSharpPasses,
          "Moving points at sharp angles"))
      {
        return Status::Aborted();
      }
      const bool isMended = !IsGone(perturbation.GetSliver(i), mesh) && perturbation.Mend(i);
      mended += isMended ? 1 : 0;
    }
    isWorthwhile = static_cast<double>(mended) > WorthwhileRatio * static_cast<double>(count);
  }
  return Status();
}
} // namespace cdm
