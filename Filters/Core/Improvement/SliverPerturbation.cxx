// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverPerturbation.h"

#include "Core/Geometry/Measures.h"
#include "Core/Improvement/LookAhead.h"
#include "Core/Improvement/SliverChanges.h"
#include "Core/Improvement/SliverList.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace cdm
{
namespace
{
constexpr std::size_t SliversBetweenChecks = 16;
/** Passes over those at sharp angles go on as long as one leaves fewer of them by more than this. */
constexpr int MaximumSharpPasses = 8;
constexpr double WorthwhileRatio = 0.02;

/** Mends slivers of a list, one after the other; threads look ahead. */
class Perturbation
{
public:
  Perturbation(const SliverAim& aim, RefinedMesh& mesh);

  /** Begins with a list; slivers at or above the angle are not worth an insertion. */
  void Start(std::vector<Sliver> slivers, double insertedBelow);
  std::size_t GetNumberOfSlivers() const { return this->Slivers.size(); }
  /**
   * Mends what is left of the list.
   * @param visit (sliver, isMended): called after each try. If nothing has helped, nothing has changed
   * @return false if it is to stop
   */
  template <typename Visitor>
  bool Run(const ExecutionContext& context, const char* activity, Visitor&& visit);

private:
  SliverAttempt GetLast(const Sliver& sliver) const
  {
    return sliver.Angle < this->InsertedBelow ? SliverAttempt::Insertion : SliverAttempt::Move;
  }
  bool IsHopeless(const Sliver& sliver) const;
  /** False if nothing helps, or is known not to. */
  bool Mend(std::size_t i);
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
    {
      const Sliver& sliver = this->Slivers[k];
      return IsGone(sliver, this->Mesh) || this->IsHopeless(sliver) ? NoId : sliver.Tetrahedron;
    },
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
  mesh.Restore(change.Point, change.Position, cavity);
  this->Mesh.NoteMove(change.Point);
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

template <typename Visitor>
bool Perturbation::Run(const ExecutionContext& context, const char* activity, Visitor&& visit)
{
  for (std::size_t i = 0; i < this->Slivers.size(); ++i)
  {
    if (i % SliversBetweenChecks == 0 &&
      !context.Continue(
        static_cast<double>(i) / static_cast<double>(this->Slivers.size()), activity))
    {
      return false;
    }
    if (i % SliversBetweenChecks == 0 && context.IsLate())
    {
      return true;
    }
    if (!IsGone(this->Slivers[i], this->Mesh))
    {
      visit(this->Slivers[i], this->Mend(i));
    }
  }
  return true;
}

/** The context of one of several passes. */
ExecutionContext GetPass(const ExecutionContext& context, int pass, int numberOfPasses)
{
  return context.Part(
    static_cast<double>(pass) / numberOfPasses, static_cast<double>(pass + 1) / numberOfPasses);
}

/**
 * A list of slivers each of which has at most one point in common with all others. 60 random complexes
 * take 695,651 tetrahedra so; 705,392 if they have no point in common, and 700,167 if all are listed.
 */
class ApartSlivers
{
public:
  bool IsApart(const TetrahedronIds& ids) const
  {
    return std::count_if(
             ids.begin(), ids.end(), [this](Id id) { return this->Points.count(id) > 0; }) < 2;
  }
  void Add(const TetrahedronIds& ids) { this->Points.insert(ids.begin(), ids.end()); }

private:
  std::unordered_set<Id> Points;
};

/** Requests a split of what is in the way of a sliver. False if no part of the boundary is. */
bool RequestSplit(Id sliver, RefinedMesh& mesh)
{
  if (mesh.GetRequests().AddEdgeOfTwoTriangles(
        mesh.GetMesh().Tetrahedra[sliver], mesh.GetShape().PointTriangles))
  {
    return true;
  }
  const auto [a, b, c, d] = mesh.GetTetrahedra().GetCorners(sliver);
  const Vec3 center = GetCircumcenter(a, b, c, d);
  return IsFinite(center) && mesh.RequestEncroached(center, true);
}

/**
 * Requests a split of a boundary triangle beside slivers, which may still help where no edge or
 * triangle is in the way.
 */
void RequestSplitsBeside(const std::vector<TetrahedronIds>& slivers, RefinedMesh& mesh)
{
  ApartSlivers requested;
  for (const TetrahedronIds& ids : slivers)
  {
    if (requested.IsApart(ids))
    {
      mesh.GetRequests().AddLargestTriangle(ids, mesh.GetShape().PointTriangles);
      requested.Add(ids);
    }
  }
}
} // namespace

Status PerturbSlivers(double target, SliverMeans means, const SearchEffort& effort,
  const ExecutionContext& context, RefinedMesh& mesh)
{
  const SliverAim aim{ MoveRatio * target, SliverPlace::Elsewhere, means != SliverMeans::Moves,
    effort };
  Perturbation perturbation(aim, mesh);
  // First moves, then new points as well; when neither helps any more, requests.
  bool mayInsert = false;
  bool isLast = false;
  std::vector<TetrahedronIds> unmet;
  ApartSlivers requested;
  for (int pass = 0; pass < MaximumSliverPasses; ++pass)
  {
    perturbation.Start(FindSlivers(aim.Target, aim.Place, mesh), mayInsert ? target : 0.0);
    bool isAnyMended = false;
    const auto visit = [&](const Sliver& sliver, bool isMended)
    {
      const bool isBad = sliver.Angle < target;
      isAnyMended = isAnyMended || (isMended && isBad);
      if (isBad && !isMended && isLast && means == SliverMeans::Requests)
      {
        unmet.push_back(mesh.GetMesh().Tetrahedra[sliver.Tetrahedron]);
        // A split may mend the other slivers at the edges of this one.
        if (requested.IsApart(unmet.back()) && RequestSplit(sliver.Tetrahedron, mesh))
        {
          requested.Add(unmet.back());
        }
      }
    };
    if (!perturbation.Run(
          GetPass(context, pass, MaximumSliverPasses), "Moving points of slivers", visit))
    {
      return Status::Aborted();
    }
    const bool isMoving = means == SliverMeans::Moves;
    if (isLast || perturbation.GetNumberOfSlivers() == 0 || (isMoving && !isAnyMended))
    {
      break;
    }
    isLast = mayInsert && !isAnyMended;
    mayInsert = !isMoving;
  }
  if (mesh.GetRequests().GetNumber() == 0)
  {
    RequestSplitsBeside(unmet, mesh);
  }
  return Status();
}

Status PerturbSharp(
  double target, SliverMeans means, const ExecutionContext& context, RefinedMesh& mesh)
{
  // Tetrahedra just above the target stay: to improve them, too, took longer and mended no more.
  const bool isMoving = means == SliverMeans::Moves;
  const SliverAim aim{ target, SliverPlace::SharpAngle, !isMoving };
  Perturbation perturbation(aim, mesh);
  double most = Infinity;
  for (int pass = 0; pass < MaximumSharpPasses; ++pass)
  {
    std::vector<Sliver> slivers = FindSlivers(aim.Target, aim.Place, mesh);
    if (static_cast<double>(slivers.size()) >= most)
    {
      break;
    }
    most = (1.0 - WorthwhileRatio) * static_cast<double>(slivers.size());
    // The first pass only moves points: where that helps few, as in thin layers, new ones do not.
    perturbation.Start(std::move(slivers), pass > 0 && !isMoving ? target : 0.0);
    if (!perturbation.Run(GetPass(context, pass, MaximumSharpPasses),
          "Moving points at sharp angles", [](const Sliver&, bool) {}))
    {
      return Status::Aborted();
    }
  }
  return Status();
}
} // namespace cdm
