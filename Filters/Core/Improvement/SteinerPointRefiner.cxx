// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SteinerPointRefiner.h"

#include "Core/Geometry/Measures.h"
#include "Core/Improvement/OptimalDelaunaySmoothing.h"
#include "Core/Improvement/SliverSchedule.h"
#include "Core/Improvement/SteinerPointChecks.h"
#include "Core/Improvement/SteinerPointRounds.h"
#include "Core/Improvement/VolumeRefinement.h"

#include <algorithm>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
/**
 * Guards against rounds without end, which would be an error of the rules. No input came near it.
 */
constexpr Id MaximumRounds = 1000;
/**
 * Slivers wait until no more requests than these are left from badly shaped tetrahedra, nor for more
 * than this part of the boundary. Otherwise small surfaces, of which a tenth is split in each round,
 * would have their slivers mended in vain while they become finer: a part of 56 triangles took 1.4 s
 * for 2,800 tetrahedra.
 */
constexpr std::size_t FewRequests = 16;
constexpr double FewRequestsRatio = 0.02;

class SteinerPointRefinement
{
public:
  SteinerPointRefinement(const SteinerPointRefinerInput& input,
    const SteinerPointRefinerOptions& options, const ExecutionContext& context,
    SteinerPointRefinerOutput& output)
    : Input(input), Options(options), Context(context), Output(output),
      Rounds(input, options, context, output.Report), Schedule(options, this->Rounds, output.Report)
  {
  }

  Status Run();

private:
  Status RefineSizes();
  Status RefineShapes();
  RoundResult RunShapeRound();
  bool HasFewRequests() const;
  Status RefineInside(bool isShapeTested);
  Status Smooth();
  bool IsOutOfRounds() const
  {
    return this->Output.Report.Rounds >= MaximumRounds || this->Context.IsLate();
  }
  void FindFaults();
  SteinerFault FindFault(const TetrahedronIds& ids, Id region) const;
  bool IsInevitable(const TetrahedronIds& ids, Id region, SharpAngleUse use) const;

  const SteinerPointRefinerInput& Input;
  const SteinerPointRefinerOptions& Options;
  const ExecutionContext& Context;
  SteinerPointRefinerOutput& Output;
  SteinerPointRounds Rounds;
  SliverSchedule Schedule;
};

Status SteinerPointRefinement::Run()
{
  Status status = CheckSteinerPointInput(this->Input, this->Context.GetNumberOfThreads())
                    .Then([this] { return this->Rounds.StartFirst(); });
  if (status.IsOk() && this->Output.Report.WeakTriangles == 0)
  {
    RemoveClosePoints(this->Options.MinimumEdgeLength, this->Input.Sizing, this->Rounds.GetMesh());
    status = this->RefineSizes()
               .Then([this] { return this->RefineShapes(); })
               .Then([this] { return this->Smooth(); });
  }
  this->Output.Report.IsLate = this->Context.IsLate();
  if (status.IsOk())
  {
    this->Output.Mesh = this->Rounds.Finish();
    this->FindFaults();
    this->Rounds.MakeOutput(this->Output);
  }
  return status;
}

Status SteinerPointRefinement::RefineInside(bool isShapeTested)
{
  return RefineByLimits(isShapeTested, this->Rounds.GetContext(), this->Rounds.GetMesh());
}

/** Smoothing is the last step: what follows would not know that there are to be no slivers. */
Status SteinerPointRefinement::Smooth()
{
  if (this->Options.SmoothingRounds == 0)
  {
    return {};
  }
  Status status = SmoothOptimalDelaunay(this->Options.SmoothingRounds,
    this->Options.DihedralAngleTarget, this->Rounds.GetContext(), this->Rounds.GetMesh());
  this->Output.Report.NegativeCouplings =
    static_cast<Id>(this->Rounds.GetMesh().RequestNegativeCouplings());
  return status;
}

/** Refines until no tetrahedron is too large. */
Status SteinerPointRefinement::RefineSizes()
{
  Status status = this->RefineInside(false);
  while (status.IsOk() && !this->Rounds.IsStuck() && this->Rounds.CountRequests() > 0 &&
    !this->Rounds.GetMesh().IsFull() && !this->IsOutOfRounds())
  {
    this->Rounds.NoteState();
    status = this->Rounds.StartNext().Then([this] { return this->RefineInside(false); });
  }
  if (status.IsOk())
  {
    this->Rounds.MeasureSizes();
  }
  return status;
}

/** Refines and perturbs until nothing helps bad shapes and slivers any more. */
Status SteinerPointRefinement::RefineShapes()
{
  RoundResult round;
  while (round.Outcome.IsOk() && round.End != RoundEnd::Done)
  {
    round = this->RunShapeRound();
    if (round.End != RoundEnd::Moved && this->IsOutOfRounds())
    {
      // No round is left to split them: this only counts the negative couplings.
      this->Schedule.RequestCouplings();
      round.End = RoundEnd::Done;
    }
    if (round.Outcome.IsOk() && round.End != RoundEnd::Done)
    {
      round.Outcome = this->Rounds.StartNext();
    }
  }
  return round.Outcome;
}

bool SteinerPointRefinement::HasFewRequests() const
{
  const std::size_t triangles = this->Rounds.GetMesh().GetBoundary().Surface.Triangles.size();
  const std::size_t requests = this->Rounds.CountRequests();
  return requests <= FewRequests &&
    static_cast<double>(requests) <= FewRequestsRatio * static_cast<double>(triangles);
}

RoundResult SteinerPointRefinement::RunShapeRound()
{
  RoundResult round{ this->RefineInside(true), RoundEnd::Open };
  if (!round.Outcome.IsOk())
  {
    return round;
  }
  this->Rounds.NoteState();
  if (this->Rounds.IsBoundaryFinal())
  {
    return { this->Schedule.Finish(), RoundEnd::Done };
  }
  const bool isSliversTurn =
    this->Rounds.IsStuck() || this->Rounds.GetMesh().IsFull() || this->HasFewRequests();
  return isSliversTurn ? this->Schedule.Run() : round;
}

/** Whether a tetrahedron of the output is across a thin layer or a sharp angle. */
bool SteinerPointRefinement::IsInevitable(
  const TetrahedronIds& ids, Id region, SharpAngleUse use) const
{
  const BoundaryShape& shape = this->Rounds.GetMesh().GetShape();
  return shape.Layers.IsAcross(ids, region) || shape.Sharp.IsAcross(ids, use);
}

SteinerFault SteinerPointRefinement::FindFault(const TetrahedronIds& ids, Id region) const
{
  const std::array<Vec3, 4> v = GetCorners(this->Output.Mesh.Points, ids);
  Vec3 target;
  double severity = 0.0;
  const TetrahedronFault fault = this->Rounds.GetMesh().GetLimits().Find(v, true, target, severity);
  if (fault == TetrahedronFault::Size)
  {
    return SteinerFault::Size;
  }
  const bool isBadlyShaped = fault == TetrahedronFault::Shape;
  if (!isBadlyShaped &&
    !(GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]) < this->Options.DihedralAngleTarget))
  {
    return SteinerFault::None;
  }
  const SharpAngleUse use = isBadlyShaped ? SharpAngleUse::Shape : SharpAngleUse::Sliver;
  return this->IsInevitable(ids, region, use) ? SteinerFault::Inevitable
    : isBadlyShaped                           ? SteinerFault::Shape
                                              : SteinerFault::Sliver;
}

void SteinerPointRefinement::FindFaults()
{
  const TetMesh& mesh = this->Output.Mesh;
  SteinerPointRefinerReport& report = this->Output.Report;
  for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
  {
    const SteinerFault found = this->FindFault(mesh.Tetrahedra[t], mesh.Regions[t]);
    report.TooLarge += found == SteinerFault::Size;
    report.BadlyShaped += found == SteinerFault::Shape;
    report.Slivers += found == SteinerFault::Sliver;
    report.Inevitable += found == SteinerFault::Inevitable;
    this->Output.Faults.push_back(found);
  }
}

/** "3 are too large", for what there is. */
std::string ListFaults(const SteinerPointRefinerReport& report)
{
  std::string text;
  const auto add = [&](Id count, const char* what)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    }
  };
  add(report.TooLarge, " are too large");
  add(report.BadlyShaped, " have a larger radius-edge ratio");
  add(report.Slivers, " have a smaller dihedral angle");
  return text;
}

std::vector<Warning> MakeWarnings(const SteinerPointRefinerOutput& output)
{
  std::vector<Warning> warnings;
  const SteinerPointRefinerReport& report = output.Report;
  if (report.IsLate)
  {
    warnings.push_back(
      { "The time limit (MaximumTime) was reached in round " + std::to_string(report.Rounds) +
        " of the refinement: the mesh is valid, but what was not done by then is left out." });
  }
  const std::string faults = ListFaults(report);
  if (!faults.empty())
  {
    warnings.push_back({ "Of " + std::to_string(output.Mesh.Tetrahedra.size()) + " tetrahedra " +
      faults + " than asked for: see the array RefinementFault. Ask for less, or allow more " +
      (report.IsLate ? "time." : "points.") });
  }
  if (report.WeakTriangles > 0)
  {
    warnings.push_back({ std::to_string(report.WeakTriangles) +
      " triangles of the boundary have no empty smallest spheres" +
      (report.IsLate ? std::string(" yet") : ": sheets lie too close to each other there") +
      ". The mesh is Delaunay, but no Steiner points are made. " +
      (report.IsLate ? "Allow more time."
                     : "Unite the sheets with a MergeTolerance of the boundary triangulator.") });
  }
  else if (report.UnresolvedTriangles > 0)
  {
    warnings.push_back({ std::to_string(report.UnresolvedTriangles) +
      " triangles of the boundary do not fulfil the criterion." });
  }
  if (report.NegativeCouplings > 0)
  {
    warnings.push_back({ std::to_string(report.NegativeCouplings) +
      " edges of the boundary have a negative coupling: allow more " +
      (report.IsLate ? "time" : "points") + ", or use the criterion SmallestSphereAndEdges." });
  }
  return warnings;
}

Status RunRefineBySteinerPoints(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context,
  SteinerPointRefinerOutput& output)
{
  output = SteinerPointRefinerOutput();
  // The number of rounds is not known: progress is the largest fraction reported so far.
  double largest = 0.0;
  bool isGoingOn = true;
  const ExecutionContext ascending = context.WithTimeLimit(options.MaximumTime)
                                       .WithFunctions(
                                         [&](double fraction, const char* activity)
                                         {
                                           largest = std::max(largest, fraction);
                                           const std::string text = std::string(activity) +
                                             ", round " + std::to_string(output.Report.Rounds + 1);
                                           isGoingOn = context.Continue(largest, text.c_str());
                                         },
                                         [&] { return !isGoingOn; });
  const Status status = SteinerPointRefinement(input, options, ascending, output).Run();
  if (!status.IsOk())
  {
    output = SteinerPointRefinerOutput();
    return status;
  }
  output.Warnings = MakeWarnings(output);
  return status;
}
} // namespace

Status RefineBySteinerPoints(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context,
  SteinerPointRefinerOutput& output)
{
  if (options.RadiusEdgeRatio != 0.0 && !(options.RadiusEdgeRatio >= 1.0))
  {
    // The refinement would not end.
    return Status::Failure(StatusCode::InvalidOption,
      "RadiusEdgeRatio has to be 0 (off) or at least 1: no mesh has smaller ones everywhere.");
  }
  if (options.LayerAspectRatio != 0.0 && !(options.LayerAspectRatio >= 1.0))
  {
    return Status::Failure(
      StatusCode::InvalidOption, "LayerAspectRatio has to be 0 (automatic) or at least 1.");
  }
  if (options.TetrahedraAcrossLayers < 1)
  {
    return Status::Failure(
      StatusCode::InvalidOption, "TetrahedraAcrossLayers has to be at least 1.");
  }
  return RunGuarded([&] { return RunRefineBySteinerPoints(input, options, context, output); });
}
} // namespace cdm
