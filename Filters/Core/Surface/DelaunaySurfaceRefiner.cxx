// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/DuplicateTriangles.h"
#include "Core/Surface/FlatFacets.h"
#include "Core/Surface/MeshPointClearance.h"
#include "Core/Surface/SurfaceChecks.h"
#include "Core/Surface/SurfaceRefinement.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace cdm
{
namespace
{
/** After this many attempts the edges of all triangles are judged without the accuracy angle. */
constexpr int LargestNumberOfAttempts = 20;

/**
 * The largest numbers of new points of later plans that may give up, after those of MostInFirstPlans. Thin
 * stacks of many sheets need 340,000 at times.
 */
constexpr std::size_t MostInThinLayers = 50000;
constexpr std::size_t MostInStacks = 400000;
/** The largest numbers of tests of needles (SurfaceRefinementPlan) in thin layers, at first and at last. */
constexpr std::size_t MostNeedlesInThinLayers = 5000;
constexpr std::size_t MostNeedlesAtLast = 100000;
/**
 * The first length below which the criterion may be missed, in diagonals of the bounding box, and which part
 * of one the next one is. Stacks of many sheets end with a fifth of the diagonal at times, with thousands
 * of points for little more of their area.
 */
constexpr double FirstRelaxedLength = 0.05;
constexpr double RelaxedLengthPart = 0.2;
/** The largest coordinate in diagonals of the bounding box from which on rounding may be to blame. */
constexpr double FarFromOrigin = 100.0;

/** One attempt to refine the surface, by one plan. */
class SurfaceRefiner
{
public:
  SurfaceRefiner(const DelaunaySurfaceRefinerInput& input,
    const DelaunaySurfaceRefinerOptions& options, const SurfaceRefinementPlan& plan,
    const ExecutionContext& context, DelaunaySurfaceRefinerOutput& output)
    : Input(input), Options(options), Plan(plan), Context(context), Output(output)
  {
  }

  Status Run();

  /**
   * Marks triangles of the input where the refinement did not end because their facet is curved.
   * Returns whether any of them was not marked before.
   */
  bool FindOverrefined(std::vector<char>& isExact) const;

  /** Whether the plan gave up at needles. */
  bool HasTooManyNeedles() const
  {
    return this->Refinement && this->Refinement->HasTooManyNeedles();
  }

  /**
   * Whether no limit was reached: all triangles are as the plan wants them. A plan that goes beyond the
   * limits wants a surface that can be meshed.
   */
  bool IsSettled() const
  {
    return this->Plan.MakesShorterEdges
      ? this->Output.NonDelaunayTriangles.empty()
      : !this->Refinement->IsFull() && this->Refinement->GetNumberOfFailures() == 0;
  }

private:
  Status Prepare(int numberOfThreads);
  std::vector<Vec3> CollectMeshPoints(int numberOfThreads);
  Status SplitRequested();
  Status Finish();

  const DelaunaySurfaceRefinerInput& Input;
  const DelaunaySurfaceRefinerOptions& Options;
  const SurfaceRefinementPlan& Plan;
  const ExecutionContext& Context;
  DelaunaySurfaceRefinerOutput& Output;
  /** Null if the input is not valid. */
  std::unique_ptr<SurfaceRefinement> Refinement;
  /** Number of points of the surface, and of these together with mesh points. */
  Id NumberOfSurfacePoints = 0;
  Id NumberOfGivenPoints = 0;
  /** Triangles of the input where flips have made two sheets equal. */
  std::vector<Id> Duplicates;
};

/** Selects the mesh points that keep clear of the surface. */
std::vector<Vec3> SurfaceRefiner::CollectMeshPoints(int numberOfThreads)
{
  std::vector<Vec3> kept;
  if (this->Input.MeshPoints == nullptr || this->Input.MeshPoints->empty())
  {
    return kept;
  }
  const TriangleMesh& surface = *this->Input.Surface;
  const std::vector<Vec3>& meshPoints = *this->Input.MeshPoints;
  this->Output.KeptMeshPoints = FindClearMeshPoints(surface, meshPoints,
    this->Options.MeshPointClearanceRatio * GetBoundingBoxDiagonal(surface.Points),
    numberOfThreads);
  for (const Id i : this->Output.KeptMeshPoints)
  {
    kept.push_back(meshPoints[i]);
  }
  this->Output.Report.DroppedMeshPoints = static_cast<Id>(meshPoints.size() - kept.size());
  return kept;
}

Status SurfaceRefiner::Prepare(int numberOfThreads)
{
  Status status = CheckRefinableSurface(
    *this->Input.Surface, this->Input.MeshPoints != nullptr ? this->Input.MeshPoints->size() : 0);
  if (!status.IsOk())
  {
    return status;
  }
  const TriangleMesh& surface = *this->Input.Surface;
  StructuralEdgesOutput edges;
  status = ExtractStructuralEdges(
    surface, this->Options.StructuralEdges, this->Context.Part(0.0, 0.05), edges);
  if (!status.IsOk())
  {
    return status;
  }
  this->Output.Report.HasRoundedFacets = edges.HasRoundedFacets;
  const std::vector<Vec3> meshPoints = this->CollectMeshPoints(numberOfThreads);
  this->NumberOfSurfacePoints = static_cast<Id>(surface.Points.size());
  this->NumberOfGivenPoints = this->NumberOfSurfacePoints + static_cast<Id>(meshPoints.size());
  this->Refinement = std::make_unique<SurfaceRefinement>(
    surface, edges.Edges, meshPoints, this->Options, this->Input.Sizing, false, this->Plan);
  this->Refinement->SetExcusedTriangles(this->Input.ExcusedTriangles);
  return Status();
}

/**
 * Splits the requested edges and triangles one by one, so that points which match one split are
 * made before the next split.
 */
Status SurfaceRefiner::SplitRequested()
{
  const ExecutionContext part = this->Context.Part(0.1, 0.95);
  const RefinableSurface& surface = this->Refinement->GetSurface();
  const auto makeKey = [](const EdgeIds& edge) { return MakeEdge(edge[0], edge[1]); };
  std::map<EdgeIds, Id> segments;
  for (Id s = 0; !this->Input.EdgesToSplit.empty() && s < surface.GetNumberOfSegments(); ++s)
  {
    segments.emplace(makeKey(surface.GetSegment(s).Points), s);
  }
  for (const EdgeIds& edge : this->Input.EdgesToSplit)
  {
    const auto segment = segments.find(makeKey(edge));
    if (segment != segments.end() &&
      makeKey(surface.GetSegment(segment->second).Points) == segment->first)
    {
      const Status status = this->Refinement->SplitSegment(segment->second, part);
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  for (Id t : this->Input.TrianglesToSplit)
  {
    const TriangleIds& ids = surface.GetTriangle(t).Points;
    // Flips do not count: the triangle is still about there.
    if (*std::max_element(ids.begin(), ids.end()) < this->NumberOfGivenPoints)
    {
      const Status status = this->Refinement->SplitTriangle(t, part);
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  return Status();
}

bool SurfaceRefiner::FindOverrefined(std::vector<char>& isExact) const
{
  bool isAnyNew = false;
  const auto mark = [&](Id source)
  {
    isAnyNew = isAnyNew || isExact[source] == 0;
    isExact[source] = 1;
  };
  isExact.resize(this->Input.Surface->Triangles.size(), 0);
  std::for_each(this->Duplicates.begin(), this->Duplicates.end(), mark);
  if (!this->Refinement)
  {
    return isAnyNew;
  }
  const std::vector<char>& isOverrefined = this->Refinement->GetOverrefined();
  for (std::size_t source = 0; source < isOverrefined.size(); ++source)
  {
    if (isOverrefined[source] != 0)
    {
      mark(static_cast<Id>(source));
    }
  }
  const RefinableSurface& surface = this->Refinement->GetSurface();
  std::vector<Id> facets;
  for (Id t : this->Output.UnresolvedTriangles)
  {
    if (this->Refinement->IsCurved(t))
    {
      mark(surface.GetTriangle(t).Source);
      facets.push_back(surface.GetTriangle(t).Facet);
    }
  }
  SortUnique(facets);
  // After flips the source may be a neighbor of the triangle that is meant.
  for (Id t = 0; t < surface.GetNumberOfTriangles() && !isAnyNew; ++t)
  {
    if (std::binary_search(facets.begin(), facets.end(), surface.GetTriangle(t).Facet))
    {
      mark(surface.GetTriangle(t).Source);
    }
  }
  return isAnyNew;
}

Status SurfaceRefiner::Finish()
{
  const RefinableSurface& refined = this->Refinement->GetSurface();
  DelaunaySurfaceRefinerReport& report = this->Output.Report;
  this->Output.NewPoints = this->Refinement->GetNewPoints();
  report.EdgePoints = this->Refinement->GetNumberOfEdgePoints();
  report.FacetPoints = static_cast<Id>(this->Output.NewPoints.size()) - report.EdgePoints;
  report.Flips = this->Refinement->GetNumberOfFlips();
  report.PointsBeyondLimits = this->Refinement->GetNumberOfRescuePoints();
  // Mesh points lie between the given and the new points of the surface: take them out.
  const Id shift = this->NumberOfGivenPoints - this->NumberOfSurfacePoints;
  const auto renumber = [this, shift](Id id)
  { return id >= this->NumberOfGivenPoints ? id - shift : id; };
  TriangleMesh& surface = this->Output.Surface;
  refined.Export(surface);
  const std::vector<DuplicateTriangle> duplicates = FindDuplicateTriangles(surface.Triangles);
  if (!duplicates.empty())
  {
    for (const DuplicateTriangle& duplicate : duplicates)
    {
      this->Duplicates.push_back(surface.SourceCells[duplicate.Original]);
      this->Duplicates.push_back(surface.SourceCells[duplicate.Triangle]);
    }
    SortUnique(this->Duplicates);
    return Status::InvalidInput("Two sheets of the surface with the same points lie within "
                                "FlatnessRatio of each other and have become one: lower "
                                "FlatnessRatio, or unite the sheets with a MergeTolerance of "
                                "the boundary triangulator.",
      this->Duplicates);
  }
  if (this->Input.Surface->Labels.empty())
  {
    surface.Labels.clear();
  }
  for (TriangleIds& ids : surface.Triangles)
  {
    ids = { renumber(ids[0]), renumber(ids[1]), renumber(ids[2]) };
  }
  const std::vector<Vec3>& points = this->Refinement->GetPoints();
  surface.Points.assign(points.begin(), points.begin() + this->NumberOfSurfacePoints);
  surface.Points.insert(
    surface.Points.end(), points.begin() + this->NumberOfGivenPoints, points.end());
  for (PointParents& parents : this->Output.NewPoints)
  {
    for (Id& id : parents.Ids)
    {
      id = id == NoId ? NoId : renumber(id);
    }
  }
  for (Id s = 0; s < refined.GetNumberOfSegments(); ++s)
  {
    const RefinableSurface::Segment& segment = refined.GetSegment(s);
    const Id a = renumber(segment.Points[0]);
    const Id b = renumber(segment.Points[1]);
    this->Output.StructuralEdges.push_back(
      { MakeEdge(a, b), segment.Kind, segment.Chain, segment.DihedralAngle });
  }
  std::sort(this->Output.StructuralEdges.begin(), this->Output.StructuralEdges.end(),
    [](const StructuralEdge& x, const StructuralEdge& y)
    { return x.Points[0] != y.Points[0] ? x.Points[0] < y.Points[0] : x.Points[1] < y.Points[1]; });
  this->Refinement->JudgeRelaxed();
  const bool isStrong = this->Options.Criterion != SurfaceCriterion::Delaunay;
  const bool mayBeTooCoarse = this->Refinement->MayBeTooCoarse();
  for (Id t = 0; t < refined.GetNumberOfTriangles(); ++t)
  {
    if (this->Refinement->IsUnresolved(t))
    {
      this->Output.UnresolvedTriangles.push_back(t);
    }
    const bool isBad = this->Refinement->IsBadTriangle(t);
    if (isBad && (this->Plan.GivesUp || !this->Refinement->IsDelaunay(t)))
    {
      this->Output.NonDelaunayTriangles.push_back(t);
    }
    if (this->Refinement->IsWeak(t) || (isBad && isStrong))
    {
      this->Output.WeakTriangles.push_back(t);
    }
    this->Output.Report.TooCoarse += mayBeTooCoarse && this->Refinement->IsTooLarge(t);
  }
  return Status();
}

Status SurfaceRefiner::Run()
{
  Status status = this->Prepare(this->Context.GetNumberOfThreads());
  status = status.IsOk() ? this->Refinement->Refine(this->Context.Part(0.1, 0.95)) : status;
  status = status.IsOk() ? this->SplitRequested() : status;
  return status.IsOk() ? this->Finish() : status;
}

/**
 * Attempts to refine one surface: with the usual rules, with facets that are plane in double
 * precision only, with the rules for corners, thin layers and stacks, and with edges before all
 * triangles or after them, until one attempt ends; otherwise by the criterion Delaunay, for all of the
 * surface and then for ever smaller triangles only.
 */
class SurfaceAttempts
{
public:
  SurfaceAttempts(const DelaunaySurfaceRefinerInput& input,
    const DelaunaySurfaceRefinerOptions& options, const ExecutionContext& context,
    DelaunaySurfaceRefinerOutput& output)
    : Input(input), Options(options), GivenFlatness(options.StructuralEdges.FlatnessRatio),
      Context(context.WithTimeLimit(options.MaximumTime)), Best(output)
  {
  }

  Status Run();

private:
  /**
   * Rules for thin layers, whether edges are refined before all triangles, and whether only matches
   * that are nearer to a corner cut triangles there at half of the distance (SurfaceRefinementPlan).
   */
  using ThinWay = std::tuple<MatchingRules, bool, bool>;

  bool RunPlan(const SurfaceRefinementPlan& plan);
  void RunUsual(SurfaceRefinementPlan plan);
  void RunThinWay(const SurfaceRefinementPlan& first, const ThinWay& way);
  void RunThin(const SurfaceRefinementPlan& first);
  void RunUsualAndThin(const SurfaceRefinementPlan& plan);
  void RunOtherOrder(SurfaceRefinementPlan plan);
  void RunRelaxed(SurfaceRefinementPlan plan);
  void RunLastResort(SurfaceRefinementPlan plan);
  bool HasSizes() const
  {
    return this->Options.MaximumEdgeLength > 0.0 || this->Options.MaximumArea > 0.0 ||
      this->Options.MinimumAngle > 0.0 || this->Input.Sizing;
  }
  bool HasUserLimits() const
  {
    return this->Options.MaximumNewPoints > 0 || this->IsLate() ||
      this->Options.MinimumEdgeRatio > DelaunaySurfaceRefinerOptions().MinimumEdgeRatio;
  }
  /** Whether no attempt has come to its end, and the user has not stopped them. */
  bool IsUnfinished() const { return !this->IsAborted && !this->IsSettled; }
  /**
   * Whether to try again. What was too fine for the user's limit would be so again, and late is only
   * tried what there is no mesh without.
   */
  bool IsOpen() const
  {
    if (this->IsLate())
    {
      return this->IsLastResort && this->IsUnfinished() && !this->HasMesh();
    }
    const bool isTooFine = this->HasSizes() && this->HasBest &&
      (this->Best.NonDelaunayTriangles.empty() || this->Options.IsTrial) &&
      this->IsStoppedByUser(this->Best);
    return this->IsUnfinished() && !isTooFine;
  }
  bool IsLate() const { return this->Context.IsLate(); }
  /** Whether the best so far can be meshed. */
  bool HasMesh() const { return this->HasBest && this->Best.NonDelaunayTriangles.empty(); }
  void Keep(DelaunaySurfaceRefinerOutput&& output);
  bool IsStoppedByUser(const DelaunaySurfaceRefinerOutput& output) const
  {
    const auto count = static_cast<Id>(output.NewPoints.size());
    return (this->IsLate() && !this->IsLastResort) ||
      (this->Options.MaximumNewPoints > 0 && count >= this->Options.MaximumNewPoints);
  }
  ExecutionContext GetNextPart();
  Status GetStatus() const
  {
    return this->IsAborted ? Status::Aborted() : this->HasBest ? Status() : *this->First;
  }

  const DelaunaySurfaceRefinerInput& Input;
  /** The options, whose IsExact is extended from attempt to attempt, and the flatness they came with. */
  DelaunaySurfaceRefinerOptions Options;
  const double GivenFlatness;
  const ExecutionContext Context;
  DelaunaySurfaceRefinerOutput& Best;
  bool HasBest = false;
  /** Status of the first attempt. */
  std::optional<Status> First;
  bool IsAborted = false;
  /** Whether an attempt came to its end, see SurfaceRefiner. */
  bool IsSettled = false;
  /** Whether what there is no mesh without is made, whatever the limits are. */
  bool IsLastResort = false;
  /** Whether the facets of the last attempt were plane but for rounding. */
  bool HasRoundedFacets = false;
  /** Ways that gave up at needles, with few points. */
  std::set<ThinWay> StoppedByNeedles;
  double Begin = 0.0;
};

/** Progress of the next attempt. Their number is not known: each gets a part of what is left. */
ExecutionContext SurfaceAttempts::GetNextPart()
{
  const double part = this->Options.StructuralEdges.AccuracyAngle > 0.0 ? 0.5 : 0.9;
  const double begin = std::exchange(this->Begin, this->Begin + part * (1.0 - this->Begin));
  return this->Context.Part(begin, this->Begin);
}

/**
 * Refines by one plan. If curved facets or flips keep it from ending, the edges there become
 * structural, and it is tried again.
 * @return whether the plan gave up at needles, with few points
 */
bool SurfaceAttempts::RunPlan(const SurfaceRefinementPlan& plan)
{
  for (int attempt = 0;; ++attempt)
  {
    DelaunaySurfaceRefinerOutput output;
    const ExecutionContext part = this->GetNextPart();
    SurfaceRefiner refiner(this->Input, this->Options, plan, part, output);
    const Status status = refiner.Run();
    this->IsAborted = status.IsAborted();
    const bool isStoppedByNeedles =
      refiner.HasTooManyNeedles() && output.NewPoints.size() < 2 * MostNeedlesInThinLayers;
    if (this->IsAborted || this->IsStoppedByUser(output) ||
      !refiner.FindOverrefined(this->Options.StructuralEdges.IsExact))
    {
      this->First = this->First ? this->First : status;
      if (status.IsOk())
      {
        this->IsSettled = this->IsSettled || refiner.IsSettled();
        this->HasRoundedFacets = output.Report.HasRoundedFacets;
        this->Keep(std::move(output));
      }
      return isStoppedByNeedles;
    }
    if (attempt == LargestNumberOfAttempts)
    {
      this->Options.StructuralEdges.IsExact.assign(this->Input.Surface->Triangles.size(), 1);
    }
  }
}

/**
 * Keeps an output if it is better than the best so far: fewer triangles that cannot be meshed, then
 * less of the surface that misses the criterion, then fewer points.
 */
void SurfaceAttempts::Keep(DelaunaySurfaceRefinerOutput&& output)
{
  const auto rate = [](const DelaunaySurfaceRefinerOutput& x)
  {
    double area = 0.0;
    for (const Id t : x.UnresolvedTriangles)
    {
      const TriangleIds& ids = x.Surface.Triangles[t];
      const std::vector<Vec3>& points = x.Surface.Points;
      area += GetTriangleArea(points[ids[0]], points[ids[1]], points[ids[2]]);
    }
    return std::make_tuple(x.NonDelaunayTriangles.size(), area, x.NewPoints.size());
  };
  if (!this->HasBest || rate(output) < rate(this->Best))
  {
    this->Best = std::move(output);
    this->HasBest = true;
  }
}

/**
 * Refines by a plan with facets as the user wants them, then with facets that are plane in double
 * precision only, and with the rules for corners, until an attempt ends. The flatness stays as the last
 * attempt had it.
 */
void SurfaceAttempts::RunUsual(SurfaceRefinementPlan plan)
{
  if (plan.GivesUp && !plan.RelaxesSome())
  {
    plan.MostPoints = MostInFirstPlans;
    plan.MostPerTriangle = MostPerTriangleInFirstPlans;
  }
  double& flatness = this->Options.StructuralEdges.FlatnessRatio;
  flatness = this->GivenFlatness;
  this->RunPlan(plan);
  if (this->IsOpen() && this->HasRoundedFacets && flatness > RoundedFlatnessRatio)
  {
    flatness = RoundedFlatnessRatio;
    this->RunPlan(plan);
  }
  plan.Rules = MatchingRules::Corners;
  if (this->IsOpen())
  {
    this->RunPlan(plan);
  }
}

/**
 * Refines by the usual plan in the other order: edges before all triangles by criterion 3.2, which
 * implies 3.1, or after them. That ends soon or not at all, and then bounds what thin layers may take.
 */
void SurfaceAttempts::RunOtherOrder(SurfaceRefinementPlan plan)
{
  const SurfaceCriterion criterion = this->Options.Criterion;
  const double flatness = this->Options.StructuralEdges.FlatnessRatio;
  plan.AreEdgesLast = criterion == SurfaceCriterion::SmallestSphereAndEdges;
  this->Options.Criterion = SurfaceCriterion::SmallestSphereAndEdges;
  this->RunUsual(plan);
  this->Options.Criterion = criterion;
  this->Options.StructuralEdges.FlatnessRatio = flatness;
}

/** Refines with rules for thin layers, if nothing has ended yet or if fewer points are wanted. */
void SurfaceAttempts::RunThinWay(const SurfaceRefinementPlan& first, const ThinWay& way)
{
  const bool isBetterWanted = first.GivesUp && this->IsSettled && !this->IsLate();
  if (this->IsAborted || !(this->IsOpen() || isBetterWanted))
  {
    return;
  }
  const auto [rules, areEdgesFirst, cutsArcs] = way;
  if (cutsArcs && this->IsSettled)
  {
    return;
  }
  SurfaceRefinementPlan plan = first;
  plan.Rules = rules;
  plan.AreEdgesLast = !areEdgesFirst;
  plan.CutsArcs = cutsArcs;
  if (this->Options.IsTrial)
  {
    plan.MostPerTriangle = MostPerTriangleInFirstPlans;
  }
  if (first.GivesUp && !first.RelaxesSome())
  {
    plan.MostPoints = rules == MatchingRules::Stacks ? MostInStacks : MostInThinLayers;
    plan.MostNeedles = std::max(first.MostNeedles, MostNeedlesInThinLayers);
  }
  if (isBetterWanted)
  {
    plan.MostPoints = std::min(plan.MostPoints, this->Best.NewPoints.size());
    plan.MostPerTriangle = 0;
  }
  const SurfaceCriterion criterion = this->Options.Criterion;
  this->Options.Criterion = areEdgesFirst ? SurfaceCriterion::SmallestSphereAndEdges : criterion;
  if (this->RunPlan(plan))
  {
    this->StoppedByNeedles.insert(way);
  }
  this->Options.Criterion = criterion;
}

/**
 * Refines with the rules for thin layers, edges before all triangles and after them, and with those
 * for stacks, in two ways. Any of these takes five times as many points as another one at times. So all
 * are tried, each with at most as many points as the best one so far, and the fewest points are kept;
 * the second way for stacks only if nothing else ends. Where a plan does not give up, the first one
 * that ends is taken. With more needles allowed than at first, only those are tried again that gave up
 * at them.
 */
void SurfaceAttempts::RunThin(const SurfaceRefinementPlan& first)
{
  const bool areEdgesTested =
    this->Options.Criterion != SurfaceCriterion::Delaunay && first.RelaxedLength == 0.0;
  std::vector<ThinWay> ways{ { MatchingRules::ThinLayers, areEdgesTested, false },
    { MatchingRules::Stacks, false, false }, { MatchingRules::Stacks, false, true } };
  if (areEdgesTested)
  {
    ways.emplace_back(MatchingRules::ThinLayers, false, false);
  }
  for (const ThinWay& way : ways)
  {
    if (first.MostNeedles <= MostNeedlesInThinLayers || this->StoppedByNeedles.count(way) != 0)
    {
      this->RunThinWay(first, way);
    }
  }
}

/** Refines by the usual plan and, if that does not end, with rules for thin layers. */
void SurfaceAttempts::RunUsualAndThin(const SurfaceRefinementPlan& plan)
{
  this->RunUsual(plan);
  if (this->IsOpen())
  {
    this->RunThin(plan);
  }
}

/**
 * Refines as if the criterion Delaunay were asked for, by which each plan either ends soon or not at all.
 * Then only triangles and edges shorter than a length may miss the criterion: with ever smaller lengths,
 * as long as that ends.
 */
void SurfaceAttempts::RunRelaxed(SurfaceRefinementPlan plan)
{
  SurfaceRefinementPlan partly = plan;
  partly.RelaxedLength = FirstRelaxedLength * GetBoundingBoxDiagonal(this->Input.Surface->Points);
  partly.GivesUp = this->Options.MaximumNewPoints == 0;
  partly.MostPerTriangle = MostPerTriangleInFirstPlans;
  plan.RelaxedLength = Infinity;
  this->RunUsualAndThin(plan);
  const bool hasEnded = this->IsSettled;
  while (this->IsSettled && !this->IsAborted && !this->Best.UnresolvedTriangles.empty())
  {
    partly.MostPoints = MostInFirstPlans + this->Best.NewPoints.size();
    this->IsSettled = false;
    this->RunUsualAndThin(partly);
    partly.RelaxedLength *= RelaxedLengthPart;
  }
  this->IsSettled = hasEnded;
}

/**
 * Limits are for what the user asks for beyond a mesh, not for the mesh itself. Late this begins as if
 * the criterion Delaunay were all that is asked for.
 */
void SurfaceAttempts::RunLastResort(SurfaceRefinementPlan plan)
{
  this->IsLastResort = true;
  plan.RelaxedLength = Infinity;
  plan.MakesShorterEdges = true;
  plan.IsRescue = this->IsLate();
  plan.GivesUp = plan.IsRescue;
  this->RunUsualAndThin(plan);
  if (plan.GivesUp && !this->HasMesh())
  {
    plan.GivesUp = false;
    this->RunUsualAndThin(plan);
  }
}

Status SurfaceAttempts::Run()
{
  SurfaceRefinementPlan plan;
  // Where sizes are asked for, they are what most of the points are for.
  plan.GivesUp = !this->HasSizes() || this->Options.IsTrial;
  this->RunUsual(plan);
  const bool isStrong = this->Options.Criterion != SurfaceCriterion::Delaunay;
  if (this->IsOpen())
  {
    if (isStrong)
    {
      this->RunOtherOrder(plan);
    }
    this->RunThin(plan);
  }
  if (this->Options.IsTrial)
  {
    return this->GetStatus();
  }
  if (isStrong && plan.GivesUp && this->IsOpen())
  {
    // Rounded coordinates make needles, of which some surfaces have many before they end.
    SurfaceRefinementPlan patient = plan;
    patient.MostNeedles = MostNeedlesAtLast;
    this->RunThin(patient);
  }
  if (isStrong && this->IsOpen())
  {
    this->RunRelaxed(plan);
  }
  if (this->IsUnfinished() && !this->HasMesh() && this->HasUserLimits())
  {
    this->RunLastResort(plan);
  }
  DelaunaySurfaceRefinerReport& report = this->Best.Report;
  report.IsLate = this->IsLate() &&
    (this->IsUnfinished() || !this->Best.UnresolvedTriangles.empty() || report.TooCoarse > 0);
  return this->GetStatus();
}

/** Far from the origin coordinates are rounded to more than matching points differ by. */
std::string GetAdviceOnOrigin(const std::vector<Vec3>& points)
{
  const double ratio = GetLargestCoordinate(points) / GetBoundingBoxDiagonal(points);
  if (ratio < FarFromOrigin)
  {
    return {};
  }
  char text[200];
  std::snprintf(text, sizeof(text),
    "The coordinates are %.0f times as large as the surface, and rounded accordingly: move it to "
    "the origin first. ",
    ratio);
  return text;
}

/** Why triangles are larger than asked for, and what to do. */
std::string ExplainCoarse(
  const DelaunaySurfaceRefinerOptions& options, const DelaunaySurfaceRefinerOutput& output)
{
  const std::size_t most =
    options.MaximumNewPoints > 0 ? static_cast<std::size_t>(options.MaximumNewPoints) : 1000000;
  const bool isFull = output.NewPoints.size() >= most;
  if (!isFull && !output.Report.IsLate)
  {
    return "no edge is made shorter than MinimumEdgeRatio allows. Ask for less, or lower "
           "MinimumEdgeRatio.";
  }
  return "the refinement ended after " + std::to_string(output.NewPoints.size()) +
    " new points. Ask for less, or raise " +
    (output.Report.IsLate ? "MaximumTime." : "MaximumNewPoints.");
}

/** What the result does not fulfil, with the triangles of the input that it comes from. */
std::vector<Warning> MakeWarnings(
  const DelaunaySurfaceRefinerOptions& options, const DelaunaySurfaceRefinerOutput& output)
{
  std::vector<Warning> warnings;
  if (!output.UnresolvedTriangles.empty())
  {
    Warning warning;
    warning.Message = std::to_string(output.UnresolvedTriangles.size()) +
      " triangles do not fulfil the criterion within the limits (" +
      (output.Report.IsLate ? "MaximumTime" : "MinimumEdgeRatio, MaximumNewPoints") +
      "): see the array Unresolved. " +
      (output.NonDelaunayTriangles.empty()
          ? "They are strongly Delaunay all the same, and can be meshed. "
          : std::to_string(output.NonDelaunayTriangles.size()) +
            " of them are not even Delaunay: no mesh can be made with them. ") +
      (output.Report.IsLate ? "Allow more time. "
                            : "Sheets that lie a hair apart can be united with a MergeTolerance of "
                              "the boundary triangulator. " +
            GetAdviceOnOrigin(output.Surface.Points)) +
      "The triangles come from these cells of the input.";
    for (const Id triangle : output.UnresolvedTriangles)
    {
      warning.Cells.push_back(output.Surface.SourceCells[triangle]);
    }
    warnings.push_back(std::move(warning));
  }
  if (output.Report.PointsBeyondLimits > 0)
  {
    warnings.push_back({ std::to_string(output.Report.PointsBeyondLimits) +
      " new points of the surface are beyond the limits (MinimumEdgeRatio, MaximumNewPoints, "
      "MaximumTime): the mesh would not conform to the surface without them." });
  }
  if (output.Report.TooCoarse > 0)
  {
    warnings.push_back({ std::to_string(output.Report.TooCoarse) +
      " triangles of the surface are larger than asked for: " + ExplainCoarse(options, output) });
  }
  if (output.Report.DroppedMeshPoints > 0)
  {
    warnings.push_back({ "Dropped " + std::to_string(output.Report.DroppedMeshPoints) +
      " mesh points that lie on the surface or closer to it than MeshPointClearanceRatio, or "
      "repeat others." });
  }
  return warnings;
}
} // namespace

Status RefineDelaunaySurface(const DelaunaySurfaceRefinerInput& input,
  const DelaunaySurfaceRefinerOptions& options, const ExecutionContext& context,
  DelaunaySurfaceRefinerOutput& output)
{
  return RunGuarded(
    [&]() -> Status
    {
      output = DelaunaySurfaceRefinerOutput();
      const Status status =
        CheckMaximumEdgeLength(*input.Surface, options.MaximumEdgeLength)
          .Then([&] { return SurfaceAttempts(input, options, context, output).Run(); });
      if (!status.IsOk())
      {
        output = DelaunaySurfaceRefinerOutput();
        return status;
      }
      output.Warnings = MakeWarnings(options, output);
      return status;
    });
}
} // namespace cdm
