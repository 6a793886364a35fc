// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverSchedule.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Improvement/SliverList.h"
#include "Core/Improvement/SurfacePointMoves.h"
#include "Core/Improvement/VolumeRefinement.h"

#include <algorithm>
#include <utility>

namespace cdm
{
namespace
{
/** Rounds in a row that move points of the boundary for slivers, or split it, in vain. */
constexpr int MaximumSliverRounds = 40;
/** Moves of the boundary's points in a row that leave as many slivers as before. */
constexpr int MaximumMoves = 4;
/** Rounds in a row that split the boundary for negative couplings in vain. */
constexpr int MaximumCouplingRounds = 16;
/** Roundings of points in a row that do not do away with a quarter of the flat tetrahedra. */
constexpr int MaximumRoundings = 3;
constexpr double RoundingGain = 0.75;
/** How many times sizes are halved for what is left. */
constexpr int MaximumHalvings = 5;
/** Where more than this part of the tetrahedra is left, sizes are not halved again in vain. */
constexpr double FewLeftRatio = 0.0005;
/** A halving that leaves this part of what was left, or more, is in vain. */
constexpr double HalvingGain = 0.75;
/** Turns of moves of surface points, and passes, at sharp angles. */
constexpr int MaximumSharpTurns = 5;
/** Passes over slivers and shapes, alternating, when the boundary stays as it is. */
constexpr int MaximumLastPasses = 5;
} // namespace

SliverSchedule::SliverSchedule(const SteinerPointRefinerOptions& options,
  SteinerPointRounds& rounds, SteinerPointRefinerReport& report)
  : Options(options), Rounds(rounds), Report(report), Roundings(MaximumRoundings, RoundingGain),
    SurfaceMoves(MaximumMoves), SliverRounds(MaximumSliverRounds), Couplings(MaximumCouplingRounds),
    ManyHalvings(1, HalvingGain)
{
}

RoundResult SliverSchedule::Run()
{
  const bool isFull = this->GetMesh().IsFull();
  const Id inserted = this->GetMesh().GetReport().InsertedPoints;
  const double target = this->Options.DihedralAngleTarget;
  if (target > 0.0 && !this->SliverRounds.IsOver(CountSlivers(target, this->GetMesh())))
  {
    RoundResult round = this->MendSlivers(isFull);
    if (!round.IsOpen())
    {
      return round;
    }
  }
  const bool isLeft =
    this->Rounds.CountRequests() > 0 || this->GetMesh().GetReport().InsertedPoints != inserted;
  return isLeft && !isFull && !this->Rounds.IsStuck() ? RoundResult() : this->MendCouplings();
}

/** Means 1 to 5. */
RoundResult SliverSchedule::MendSlivers(bool isFull)
{
  if (!isFull && this->RoundFlatTetrahedraAway())
  {
    return { {}, RoundEnd::Moved };
  }
  RoundResult round = this->PerturbMoveOrRequest(isFull);
  if (round.End != RoundEnd::Open)
  {
    this->SliverRounds.NoteTry();
  }
  if (round.Outcome.IsOk() && round.End != RoundEnd::Moved)
  {
    round.Outcome = this->RefineShapes();
  }
  return round;
}

/** Means 2 to 4. */
RoundResult SliverSchedule::PerturbMoveOrRequest(bool isFull)
{
  Status status = this->Perturb(isFull ? SliverMeans::Moves : SliverMeans::Points);
  if (!status.IsOk() || isFull)
  {
    return { std::move(status), RoundEnd::Open };
  }
  if (this->MoveSurfacePoints())
  {
    return { {}, RoundEnd::Moved };
  }
  const std::size_t requests = this->Rounds.CountRequests();
  if (requests > 0 && !this->Rounds.IsStuck())
  {
    return {};
  }
  status = this->Perturb(SliverMeans::Requests);
  return { std::move(status),
    this->Rounds.CountRequests() > requests ? RoundEnd::Requested : RoundEnd::Open };
}

/** Means 6 to 11. */
RoundResult SliverSchedule::MendCouplings()
{
  if (this->RequestCouplings())
  {
    return { {}, RoundEnd::Requested };
  }
  if (this->Options.DihedralAngleTarget <= 0.0)
  {
    return { {}, RoundEnd::Done };
  }
  if (this->MoveSharpSurfacePoints())
  {
    return { {}, RoundEnd::Moved };
  }
  const bool isTurn = !this->IsSharpPerturbed;
  Status status = this->PerturbLast();
  if (status.IsOk() && isTurn && this->StartSharpTurn())
  {
    return { {}, RoundEnd::Moved };
  }
  if (status.IsOk() && this->RequestCouplings())
  {
    return { {}, RoundEnd::Requested };
  }
  return status.IsOk() ? this->MendWhatIsLeft() : RoundResult{ std::move(status), RoundEnd::Done };
}

/** Tetrahedra that are slivers or badly shaped, and are to be neither. */
std::vector<Id> SliverSchedule::FindWhatIsLeft() const
{
  std::vector<Id> left = this->GetMesh().FindFaulty(true);
  for (const Sliver& sliver :
    FindSlivers(this->Options.DihedralAngleTarget, SliverPlace::Elsewhere, this->GetMesh()))
  {
    left.push_back(sliver.Tetrahedron);
  }
  SortUnique(left);
  return left;
}

/** Whether another halving of sizes is worth its points. */
bool SliverSchedule::MayHalveSizes(const std::vector<Id>& left)
{
  const double few =
    FewLeftRatio * static_cast<double>(this->GetMesh().GetMesh().Tetrahedra.size());
  const bool isInVain = this->ManyHalvings.IsOver(left.size());
  return !left.empty() && (!isInVain || static_cast<double>(left.size()) <= few);
}

/** Means 11. */
RoundResult SliverSchedule::MendWhatIsLeft()
{
  Status status;
  while (status.IsOk() && this->Halvings < MaximumHalvings && !this->GetMesh().IsFull())
  {
    const std::vector<Id> left = this->FindWhatIsLeft();
    if (!this->MayHalveSizes(left))
    {
      break;
    }
    ++this->Halvings;
    this->ManyHalvings.NoteTry();
    // What is made now may make other couplings negative.
    this->Couplings.Renew();
    this->Rounds.HalveSizes(left);
    status = this->RefineShapes()
               .Then([this] { return this->Perturb(SliverMeans::Points); })
               .Then([this] { return this->Perturb(SliverMeans::Requests); });
    if (this->Rounds.CountRequests() > 0)
    {
      this->SliverRounds.Renew();
      return { std::move(status), RoundEnd::Requested };
    }
  }
  const bool isRequested = status.IsOk() && this->RequestCouplings();
  return { std::move(status), isRequested ? RoundEnd::Requested : RoundEnd::Done };
}

Status SliverSchedule::Finish()
{
  Status status;
  if (this->Options.DihedralAngleTarget > 0.0)
  {
    status = this->Perturb(SliverMeans::Points)
               .Then([this] { return this->RefineShapes(); })
               .Then([this] { return this->PerturbLast(); });
  }
  this->RequestCouplings();
  return status;
}

bool SliverSchedule::RequestCouplings()
{
  const std::size_t requests = this->Rounds.CountRequests();
  const std::size_t negative = this->GetMesh().RequestNegativeCouplings();
  this->Report.NegativeCouplings = static_cast<Id>(negative);
  if (this->Rounds.CountRequests() == requests || this->GetMesh().IsFull() ||
    this->Couplings.IsOver(negative))
  {
    return false;
  }
  this->Couplings.NoteTry();
  this->SliverRounds.Renew();
  return true;
}

/** False if there is nothing to do. Points that are not free stay. */
bool SliverSchedule::RoundFlatTetrahedraAway()
{
  const std::vector<Id> flat = this->GetMesh().FindFlatTetrahedra();
  std::vector<TetrahedronIds> found;
  for (Id t : flat)
  {
    found.push_back(this->GetMesh().GetMesh().Tetrahedra[t]);
    std::sort(found.back().begin(), found.back().end());
  }
  std::sort(found.begin(), found.end());
  if (std::includes(this->LeftFlat.begin(), this->LeftFlat.end(), found.begin(), found.end()))
  {
    return false;
  }
  if (this->Roundings.IsOver(flat.size()))
  {
    this->LeftFlat = std::move(found);
    this->Roundings.Renew();
    return false;
  }
  this->Roundings.NoteTry();
  return this->Rounds.TakeSurfacePositions(
    RoundSurfacePoints(flat, this->Rounds.GetFreeSurfacePoints(), this->GetMesh()));
}

/**
 * Moves free surface points of slivers. False if there is nothing to do, or if a few tries in a row
 * have not reduced the slivers: a move may spoil facets on the outer side of the boundary, which
 * the mesh does not show.
 */
bool SliverSchedule::MoveSurfacePoints()
{
  if (this->SurfaceMoves.IsOver(CountSlivers(this->Options.DihedralAngleTarget, this->GetMesh())))
  {
    this->SurfaceMoves.Renew();
    return false;
  }
  this->SurfaceMoves.NoteTry();
  return this->TakeSurfaceMoves(SliverPlace::Elsewhere);
}

/** Moves free surface points of slivers at sharp angles, once in a turn. False if all points stay. */
bool SliverSchedule::MoveSharpSurfacePoints()
{
  if (this->AreSharpMoved || this->GetMesh().IsFull())
  {
    return false;
  }
  this->AreSharpMoved = true;
  return this->TakeSurfaceMoves(SliverPlace::SharpAngle);
}

/** Begins another turn at sharp angles. False if no point of the surface is moved any more. */
bool SliverSchedule::StartSharpTurn()
{
  ++this->SharpTurns;
  if (this->SharpTurns == MaximumSharpTurns)
  {
    return false;
  }
  this->AreSharpMoved = false;
  const bool isMoved = this->MoveSharpSurfacePoints();
  this->IsSharpPerturbed = !isMoved;
  return isMoved;
}

bool SliverSchedule::TakeSurfaceMoves(SliverPlace place)
{
  return this->Rounds.TakeSurfacePositions(cdm::MoveSurfacePoints(this->Options.DihedralAngleTarget,
    place, this->Rounds.GetFreeSurfacePoints(),
    this->Options.Criterion == SurfaceCriterion::SmallestSphereAndEdges, this->GetMesh()));
}

Status SliverSchedule::RefineShapes()
{
  return RefineByLimits(true, this->Rounds.GetContext(), this->GetMesh());
}

Status SliverSchedule::Perturb(SliverMeans means)
{
  // A few are left when sizes are halved: these are worth a longer search.
  return PerturbSlivers(this->Options.DihedralAngleTarget, means,
    this->Halvings > 0 ? SearchEffort() : SliverEffort, this->Rounds.GetContext(), this->GetMesh());
}

/**
 * Perturbs the slivers that points inserted for shapes have left. Those at sharp angles are
 * perturbed once in a turn: each time would make other couplings negative.
 */
Status SliverSchedule::PerturbLast()
{
  Status status;
  Id inserted = NoId;
  for (int pass = 1; status.IsOk() && pass <= MaximumLastPasses &&
       inserted != this->GetMesh().GetReport().InsertedPoints;
       ++pass)
  {
    inserted = this->GetMesh().GetReport().InsertedPoints;
    status = this->Perturb(SliverMeans::Points);
    if (status.IsOk() && pass < MaximumLastPasses)
    {
      status = this->RefineShapes();
    }
  }
  if (status.IsOk() && !this->IsSharpPerturbed)
  {
    this->IsSharpPerturbed = true;
    status = PerturbSharp(this->Options.DihedralAngleTarget, SliverMeans::Points,
      this->Rounds.GetContext(), this->GetMesh());
  }
  return status;
}
} // namespace cdm
