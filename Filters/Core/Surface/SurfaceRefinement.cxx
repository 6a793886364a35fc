// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceRefinement.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/EnclosingBall.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Surface/SurfaceChecks.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace cdm
{
namespace
{
constexpr std::size_t ReportInterval = 256;

/** The largest number of new points where sizes or angles are asked for. */
constexpr std::size_t MostForSizes = 1000000;
/** See SurfaceRefinementPlan::MostNeedles. */
constexpr std::size_t NeedlePart = 4;
/**
 * Plans for stacks give up with more points in facets than this, and so many for each point on an
 * edge. Those that ended had at most 13 for each; a slab with facets at 2e-7 radians, which cannot
 * end, had 150 and took 100 s.
 */
constexpr std::size_t MostInFacets = 20000;
constexpr std::size_t MostPerEdgePoint = 25;
/** A point farther from a circumcenter than this, in circumradii, is certainly not cocircular. */
constexpr double CocircularRadii = 1.0 + 1e-6;
/**
 * No edge is made shorter than this part of the largest coordinate, 8 times the rounding of it: the
 * points of shorter ones are not where they should be, and their triangles lean out of their facet.
 */
constexpr double RoundedEdgeRatio = 8.0 * std::numeric_limits<double>::epsilon();
} // namespace

SurfaceRefinement::SurfaceRefinement(const TriangleMesh& surface,
  const std::vector<StructuralEdge>& edges, const std::vector<Vec3>& meshPoints,
  const DelaunaySurfaceRefinerOptions& options, SizingField sizing, bool isSaturated,
  SurfaceRefinementPlan plan)
  : Options(options), Plan(plan), Points(surface.Points),
    NumberOfSurfacePoints(static_cast<Id>(surface.Points.size())),
    Diagonal(GetBoundingBoxDiagonal(surface.Points)),
    Flatness(GetFlatness(options.StructuralEdges.FlatnessRatio, surface.Points)),
    RoundedEdge(RoundedEdgeRatio * GetLargestCoordinate(surface.Points)),
    MinimumEdge(std::max(options.MinimumEdgeRatio * this->Diagonal, this->RoundedEdge)),
    Test(this->Points, this->Octree), Limits{ options.MaximumEdgeLength, options.MaximumArea,
      options.MinimumAngle, std::move(sizing) },
    Proofs(this->Points)
{
  this->Points.insert(this->Points.end(), meshPoints.begin(), meshPoints.end());
  // Without a limit of the user's, one that only a runaway refinement reaches: sheets a hair apart.
  const std::size_t forTriangles = plan.MostPerTriangle * surface.Triangles.size();
  const auto makeId = [](std::size_t most)
  { return static_cast<Id>(std::min<std::size_t>(most, LargestId / 8)); };
  const bool hasManyForSizes = this->Limits.HasAny() && !plan.RelaxesSome() && !plan.IsRescue;
  this->UsualMaximum = makeId(
    std::max(hasManyForSizes ? MostForSizes : plan.MostPoints, forTriangles) + meshPoints.size());
  this->MaximumNeedles = makeId(std::max(plan.MostNeedles, forTriangles / NeedlePart));
  this->MaximumNewPoints =
    options.MaximumNewPoints > 0 ? options.MaximumNewPoints : this->UsualMaximum;
  this->Octree.Insert(this->Points);
  this->Surface = std::make_unique<RefinableSurface>(surface, edges, this->Points);
  this->Flips = std::make_unique<SurfaceFlips>(
    *this->Surface, this->Points, 2.0 * this->Flatness, options.StructuralEdges.AccuracyAngle);
  if (options.StructuralEdges.AccuracyAngle > 0.0)
  {
    for (const TriangleIds& ids : surface.Triangles)
    {
      double shortest = Infinity;
      for (int i = 0; i < 3; ++i)
      {
        shortest =
          std::min(shortest, Distance(this->Points[ids[i]], this->Points[ids[(i + 1) % 3]]));
      }
      this->ShortestEdges.push_back(shortest);
    }
  }
  if (isSaturated)
  {
    this->EnqueueAll();
  }
  else
  {
    this->Saturate();
  }
  for (Id segment = 0; this->AreEdgesTested() && segment < this->Surface->GetNumberOfSegments();
       ++segment)
  {
    this->EnqueueEdge(segment);
  }
}

void SurfaceRefinement::CollectIncidences()
{
  if (this->Incidences)
  {
    return;
  }
  // Without an angle all facets are plane.
  const double flatness =
    this->Options.StructuralEdges.AccuracyAngle > 0.0 ? this->Flatness : Infinity;
  this->Incidences = std::make_unique<SurfaceIncidences>(
    *this->Surface, this->Points, this->NumberOfSurfacePoints, flatness);
  this->Partners = std::make_unique<PartnerPoints>(*this->Surface, *this->Incidences, this->Points,
    this->Octree, this->Diagonal, this->Plan.Rules);
  this->Walk = std::make_unique<FacetWalk>(
    *this->Surface, *this->Partners, this->Points, this->Octree, this->Diagonal);
  for (Id segment = 0; segment < this->Surface->GetNumberOfSegments(); ++segment)
  {
    this->NoteSegment(segment);
  }
}

void SurfaceRefinement::Enqueue(Id t)
{
  if (static_cast<std::size_t>(t) >= this->States.size())
  {
    this->States.resize(t + 1, QueueState::None);
    this->IsProven.resize(t + 1, 0);
    this->IsBad.resize(t + 1, 0);
  }
  this->Touch(t);
  this->IsProven[t] = 0;
  this->IsBad[t] = 0;
  if (this->States[t] == QueueState::First)
  {
    return;
  }
  // With criterion 3.2 edges are fine enough by now, and small triangles come first: what large
  // ones need depends on them. Otherwise triangles come in the order of arrival: smallest first
  // would refine almost flat surfaces down to the smallest triangles.
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  this->Enqueue(t, QueueState::First,
    this->AreEdgesFirst() ? Norm(GetCircumcenterOffset(
                              this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]))
                          : this->GetNextNumber());
}

void SurfaceRefinement::Enqueue(Id t, QueueState state, double order)
{
  this->States[t] = state;
  this->Queue.push_back({ state, order, t });
  std::push_heap(this->Queue.begin(), this->Queue.end(), std::greater<>());
}

void SurfaceRefinement::Legalize(std::vector<Id>& uses)
{
  for (Id use : uses)
  {
    this->Enqueue(use / 3);
  }
  this->Flips->Saturate(uses, [this](Id t) { this->Enqueue(t); });
}

void SurfaceRefinement::Saturate()
{
  const Id count = this->Surface->GetNumberOfTriangles();
  std::vector<Id> uses;
  for (Id use = 3 * count - 1; use >= 0; --use)
  {
    const Id other = this->Surface->GetTriangle(use / 3).Adjacent[use % 3];
    if (other > use)
    {
      uses.push_back(use);
    }
  }
  this->Legalize(uses);
  this->EnqueueAll();
}

void SurfaceRefinement::EnqueueAll()
{
  for (Id t = 0; t < this->Surface->GetNumberOfTriangles(); ++t)
  {
    this->Enqueue(t);
  }
}

Status SurfaceRefinement::SplitSegment(Id segment, const ExecutionContext& context)
{
  this->CollectIncidences();
  this->SplitSegment(segment, NoId);
  return this->Refine(context);
}

Status SurfaceRefinement::SplitTriangle(Id triangle, const ExecutionContext& context)
{
  this->CollectIncidences();
  if (!this->ResolveInFacet(triangle, NoId, this->FindCircumcenter(triangle), false))
  {
    this->SplitLongestEdge(triangle);
  }
  return this->Refine(context);
}

void SurfaceRefinement::ChangePoints(const PointChanges& changes, ThreadTeam& team)
{
  const std::size_t firstAdded = this->Points.size();
  this->Points.insert(this->Points.end(), changes.Added.begin(), changes.Added.end());
  for (std::size_t i = 0; i < changes.Added.size() && this->Incidences; ++i)
  {
    this->Incidences->AddPoint(NoId, NoId);
  }
  std::vector<std::pair<Id, Vec3>> moves = changes.MovedOnSurface;
  moves.insert(moves.end(), changes.Moved.begin(), changes.Moved.end());
  std::vector<Vec3> before;
  before.reserve(moves.size());
  for (const auto& [point, position] : moves)
  {
    before.push_back(std::exchange(this->Points[point], position));
  }
  const auto updateOctree = [&]
  {
    for (Id point : changes.Removed)
    {
      this->Octree.Remove(point, this->Points[point]);
    }
    // The octree never has two points at one position.
    for (std::size_t i = 0; i < moves.size(); ++i)
    {
      this->Octree.Remove(moves[i].first, before[i]);
    }
    for (std::size_t i = 0; i < changes.Added.size(); ++i)
    {
      this->Octree.Insert(static_cast<Id>(firstAdded + i), changes.Added[i]);
    }
    for (const auto& [point, position] : moves)
    {
      this->Octree.Insert(point, position);
    }
  };
  const auto testAgain = [&]
  {
    for (const Vec3& position : changes.Added)
    {
      this->TestAgainAround(position);
    }
    for (const auto& move : moves)
    {
      this->TestAgainAround(move.second);
    }
    this->TestAgainAt(changes.MovedOnSurface);
  };
  team.RunBoth(updateOctree, testAgain);
}

/** Tests all triangles and edges at points of the surface that have moved. */
void SurfaceRefinement::TestAgainAt(const std::vector<std::pair<Id, Vec3>>& moves)
{
  if (moves.empty())
  {
    return;
  }
  std::vector<char> isMoved(this->Points.size(), 0);
  for (const auto& move : moves)
  {
    isMoved[move.first] = 1;
  }
  const auto isAnyMoved = [&isMoved](const auto& ids)
  { return std::any_of(ids.begin(), ids.end(), [&](Id id) { return isMoved[id] != 0; }); };
  for (Id t = 0; t < this->Surface->GetNumberOfTriangles(); ++t)
  {
    if (isAnyMoved(this->Surface->GetTriangle(t).Points))
    {
      this->Proofs.Remove(t);
      this->Enqueue(t);
    }
  }
  for (Id s = 0; s < this->Surface->GetNumberOfSegments() && this->AreEdgesTested(); ++s)
  {
    if (isAnyMoved(this->Surface->GetSegment(s).Points))
    {
      this->EmptyEdges.Remove(s);
      this->EnqueueEdge(s);
    }
  }
}

void SurfaceRefinement::PullCocircular(const std::vector<Id>& triangles)
{
  std::vector<Id> uses;
  for (Id t : triangles)
  {
    uses.insert(uses.end(), { 3 * t, 3 * t + 1, 3 * t + 2 });
  }
  while (!uses.empty())
  {
    const Id use = uses.back();
    uses.pop_back();
    const Id other = this->Surface->GetTriangle(use / 3).Adjacent[use % 3];
    if (other < 0)
    {
      continue;
    }
    const TriangleIds& ids = this->Surface->GetTriangle(use / 3).Points;
    const Id a = ids[use % 3];
    const Id b = ids[(use % 3 + 1) % 3];
    const Id c = this->Surface->GetApex(use);
    const Id d = this->Surface->GetApex(other);
    const std::vector<Vec3>& points = this->Points;
    if (std::min(c, d) < std::min(a, b) &&
      Orientation(points[a], points[b], points[c], points[d]) == 0 &&
      InEquatorialSphere(points[a], points[b], points[c], points[d]) == 0)
    {
      this->Surface->Flip(use);
      for (Id t : { use / 3, other / 3 })
      {
        this->Touch(t);
        uses.insert(uses.end(), { 3 * t, 3 * t + 1, 3 * t + 2 });
      }
    }
  }
}

bool SurfaceRefinement::IsDelaunay(Id triangle) const
{
  SurfaceDelaunayTest::Result found;
  return this->IsGood(triangle, found, false);
}

bool SurfaceRefinement::IsTooLarge(Id triangle) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(triangle).Points;
  std::array<bool, 3> isStructural;
  for (int i = 0; i < 3; ++i)
  {
    isStructural[i] = this->Surface->GetSegmentAt(triangle, i) != NoId;
  }
  Id edge = NoId;
  return this->Limits.IsTooCoarse(
    { this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]] }, isStructural, false,
    edge);
}

bool SurfaceRefinement::IsUnresolved(Id triangle) const
{
  if (this->IsBadTriangle(triangle) || this->IsWeak(triangle))
  {
    return true;
  }
  for (int i = 0; i < 3; ++i)
  {
    const Id segment = this->Surface->GetSegmentAt(triangle, i);
    if (segment != NoId && static_cast<std::size_t>(segment) < this->IsEncroached.size() &&
      this->IsEncroached[segment] != 0)
    {
      return true;
    }
  }
  return false;
}

void SurfaceRefinement::Touch(Id t)
{
  this->IsTouched.resize(this->Surface->GetNumberOfTriangles(), 0);
  if (this->IsTouched[t] == 0)
  {
    this->IsTouched[t] = 1;
    this->Touched.push_back(t);
  }
}

std::vector<Id> SurfaceRefinement::TakeTouched()
{
  std::sort(this->Touched.begin(), this->Touched.end());
  for (Id t : this->Touched)
  {
    this->IsTouched[t] = 0;
  }
  return std::exchange(this->Touched, {});
}

bool SurfaceRefinement::IsCocircularFacet(Id t, const SurfaceDelaunayTest::Result& found) const
{
  // All points on the circumcircle have to be reached across smooth edges of triangles on it.
  const std::vector<Id>& cocircular = found.Cocircular;
  std::vector<Id> triangles(1, t);
  std::vector<Id> reached;
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    for (Id use : this->Surface->GetTriangle(triangles[i]).Adjacent)
    {
      if (use < 0 || Contains(triangles, use / 3))
      {
        continue;
      }
      const Id apex = this->Surface->GetApex(use);
      if (std::binary_search(cocircular.begin(), cocircular.end(), apex))
      {
        triangles.push_back(use / 3);
        reached.push_back(apex);
      }
    }
  }
  std::sort(reached.begin(), reached.end());
  return reached == cocircular;
}

bool SurfaceRefinement::IsStrong(Id t) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const auto isAsked = [&](int i, int k)
  { return !this->IsRelaxed(Distance(this->Points[ids[i]], this->Points[ids[k]])); };
  return this->Options.Criterion != SurfaceCriterion::Delaunay &&
    (isAsked(0, 1) || isAsked(1, 2) || isAsked(2, 0));
}

bool SurfaceRefinement::IsGood(Id t, SurfaceDelaunayTest::Result& found, bool isStrong) const
{
  this->Test.Run(this->Surface->GetTriangle(t).Points, found, isStrong);
  if (!found.IsDelaunay || (!found.Cocircular.empty() && !this->IsCocircularFacet(t, found)))
  {
    return false;
  }
  return !isStrong || found.InsideSmallestSphere.empty();
}

/**
 * How many points are made beyond a limit. If that is the time, no more than by the first plans: a
 * surface that takes more is refined without sizes then.
 */
Id SurfaceRefinement::GetMostForRescue(bool isLate) const
{
  const std::size_t usual = static_cast<std::size_t>(this->UsualMaximum);
  const std::size_t triangles = static_cast<std::size_t>(this->Surface->GetNumberOfTriangles());
  const std::size_t most = std::max(MostInFirstPlans, MostPerTriangleInFirstPlans * triangles);
  return static_cast<Id>(isLate ? std::min(usual, most) : usual);
}

/** From now on at most so many points are made, for what the criterion Delaunay needs. */
void SurfaceRefinement::StartRescue(Id most)
{
  this->PointsBeforeRescue = static_cast<Id>(this->NewPoints.size());
  this->MaximumRescuePoints = this->PointsBeforeRescue + most;
  this->EdgeQueue.clear();
  if (this->Plan.MakesShorterEdges)
  {
    const double usual = DelaunaySurfaceRefinerOptions().MinimumEdgeRatio * this->Diagonal;
    this->MinimumEdge = std::min(this->MinimumEdge, std::max(usual, this->RoundedEdge));
  }
}

/** Puts bad triangles that are not even Delaunay into the queue again; whether there are any. */
bool SurfaceRefinement::EnqueueNonDelaunay()
{
  for (Id t = 0; t < this->Surface->GetNumberOfTriangles(); ++t)
  {
    if (this->IsBadTriangle(t) && !this->IsDelaunay(t))
    {
      this->Enqueue(t);
    }
  }
  return !this->Queue.empty();
}

void SurfaceRefinement::AllowNewPoints(std::size_t count)
{
  this->MaximumNewPoints =
    static_cast<Id>(std::min<std::size_t>(this->NewPoints.size() + count, LargestId / 8));
}

/** Triangles that are still to be looked at count as bad. */
void SurfaceRefinement::GiveUp()
{
  for (const QueueEntry& entry : this->Queue)
  {
    this->IsBad[entry.Triangle] |=
      this->States[entry.Triangle] == entry.State && this->IsProven[entry.Triangle] == 0;
  }
  for (const auto& [length, segment] : this->EdgeQueue)
  {
    this->IsEncroached.resize(this->Surface->GetNumberOfSegments(), 0);
    this->IsEncroached[segment] = 1;
  }
  this->Queue.clear();
  this->EdgeQueue.clear();
}

void SurfaceRefinement::JudgeRelaxed()
{
  this->WeakTriangles.clear();
  this->NumberOfFailures = static_cast<Id>(std::count(this->IsBad.begin(), this->IsBad.end(), 1) +
    std::count(this->IsEncroached.begin(), this->IsEncroached.end(), 1));
  if (this->Options.Criterion == SurfaceCriterion::Delaunay ||
    (this->Plan.RelaxedLength == 0.0 && !this->IsRescuing()))
  {
    return;
  }
  this->WeakTriangles.resize(this->Surface->GetNumberOfTriangles(), 0);
  SurfaceDelaunayTest::Result found;
  for (Id t = 0; t < this->Surface->GetNumberOfTriangles(); ++t)
  {
    this->WeakTriangles[t] = this->IsGood(t, found, true) ? 0 : 1;
  }
  this->IsEncroached.resize(this->Surface->GetNumberOfSegments(), 0);
  for (Id s = 0; s < this->Surface->GetNumberOfSegments() && this->AreEdgesTested(); ++s)
  {
    this->IsEncroached[s] = this->FindDeepestPoint(this->Surface->GetSegment(s).Points) != NoId;
  }
}

/**
 * Tests all triangles on all threads before the first of them is refined: most are good and stay
 * so. False if aborted.
 */
bool SurfaceRefinement::TestAll(const ExecutionContext& context)
{
  this->AreAllTested = true;
  const auto count = static_cast<std::size_t>(this->Surface->GetNumberOfTriangles());
  std::vector<char> isGood(count, 0);
  std::vector<SurfaceDelaunayTest::SphereProof> proofs(count);
  const ParallelLoopOptions options{ context.GetNumberOfThreads(), 1024 };
  if (!ParallelLoop(count, options, context, "Testing the surface",
        [&](std::size_t begin, std::size_t end, std::size_t)
        {
          SurfaceDelaunayTest::Result found;
          for (std::size_t t = begin; t < end; ++t)
          {
            isGood[t] = this->IsGood(static_cast<Id>(t), found);
            proofs[t] = found.Proof;
          }
        }))
  {
    return false;
  }
  for (std::size_t t = 0; t < count; ++t)
  {
    if (isGood[t] != 0)
    {
      this->SetProof(static_cast<Id>(t), proofs[t]);
    }
  }
  return true;
}

bool SurfaceRefinement::ResolveByFlip(Id t)
{
  std::vector<Id> uses{ 3 * t, 3 * t + 1, 3 * t + 2 };
  for (Id use : uses)
  {
    if (this->Flips->ShouldFlip(use))
    {
      this->Legalize(uses);
      return true;
    }
  }
  // Nearly cocircular and nearly coplanar points: the local rule may not see what the exact
  // double sphere sees. A ridge along one diagonal, however flat, is a valley along the other: a
  // valley has the fourth point in front, which may leave no empty sphere there.
  const Vec3 center = this->FindCircumcenter(t);
  for (Id use : uses)
  {
    const Id other = this->Surface->GetTriangle(t).Adjacent[use % 3];
    if (!this->Flips->CanFlip(use))
    {
      continue;
    }
    const TriangleIds ids = this->Surface->GetTriangle(t).Points;
    const Id a = ids[use % 3];
    const Id b = ids[(use % 3 + 1) % 3];
    const Id c = this->Surface->GetApex(use);
    const Id d = this->Surface->GetApex(other);
    if (Distance(center, this->Points[d]) >
      CocircularRadii * Distance(center, this->Points[a]) + 2.0 * GetRounding(center))
    {
      continue;
    }
    SurfaceDelaunayTest::Result first;
    SurfaceDelaunayTest::Result second;
    const bool isStronger = this->IsStrong(t);
    this->Test.Run({ a, d, c }, first, isStronger);
    this->Test.Run({ d, b, c }, second, isStronger);
    const bool isAllowed =
      !isStronger || (first.InsideSmallestSphere.empty() && second.InsideSmallestSphere.empty());
    if (first.IsDelaunay && second.IsDelaunay && isAllowed && first.Cocircular.empty() &&
      second.Cocircular.empty())
    {
      this->Flips->Flip(use);
      this->Enqueue(t);
      this->Enqueue(other / 3);
      return true;
    }
  }
  return false;
}

Id SurfaceRefinement::AddPoint(
  const Vec3& position, const PointParents& parents, Id facet, Id inputEdge)
{
  const Id point = static_cast<Id>(this->Points.size());
  this->Points.push_back(position);
  this->Flips->AddPoint();
  this->Octree.Insert(point, position);
  this->Incidences->AddPoint(facet, inputEdge);
  this->NewPoints.push_back(parents);
  this->TestAgainAround(position);
  return point;
}

/** Remembers that a triangle is good, until a point comes into its sphere. */
void SurfaceRefinement::SetProof(Id t, const SurfaceDelaunayTest::SphereProof& proof)
{
  this->IsProven[t] = 1;
  this->Proofs.Set(t, this->Surface->GetTriangle(t).Points, proof);
}

/** Puts triangles and edges on which a new point may encroach into the queues again. */
void SurfaceRefinement::TestAgainAround(const Vec3& position)
{
  this->Proofs.Find(position, this->Reached);
  for (Id t : this->Reached)
  {
    this->Proofs.Remove(t);
    this->Enqueue(t);
  }
  if (this->AreEdgesTested())
  {
    this->EmptyEdges.Find(position, this->Reached);
    for (Id segment : this->Reached)
    {
      this->EmptyEdges.Remove(segment);
      this->EnqueueEdge(segment);
    }
  }
}

void SurfaceRefinement::Process(Id t, QueueState state)
{
  Id segment = NoId;
  const bool isProven = this->IsProven[t] != 0;
  if (isProven || this->IsGood(t, this->Found))
  {
    if (!isProven)
    {
      this->SetProof(t, this->Found.Proof);
    }
    if (!this->IsRescuing() && this->FindTooCoarse(t, segment))
    {
      this->CollectIncidences();
      // Too coarse is no fault: if a limit forbids to refine, the triangle stays as it is.
      const bool isRefined = segment != NoId
        ? this->SplitSegment(segment, NoId)
        : this->ResolveInFacet(t, NoId, this->FindCircumcenter(t), false) ||
          this->SplitLongestEdge(t);
      if (isRefined)
      {
        this->Enqueue(t);
      }
      else
      {
        this->HasLeftTooCoarse = true;
      }
    }
    return;
  }
  this->NumberOfNeedles += this->Found.IsNeedle ? 1 : 0;
  this->Proofs.Remove(t);
  this->CollectIncidences();
  if (this->ResolveByFlip(t))
  {
    return;
  }
  if (!this->IsOverrefined.empty() &&
    this->IsOverrefined[this->Surface->GetTriangle(t).Source] != 0)
  {
    this->IsBad[t] = 1;
    return;
  }
  // Whatever is done now, t is looked at again: the new point need not have changed it.
  this->IsBad[t] = 0;
  const EncroachedEdge edge = this->FindEncroachedEdge(t);
  if (edge.Segment != NoId && state == QueueState::First && !this->AreEdgesFirst())
  {
    this->Enqueue(t, QueueState::Edge, edge.Distance);
    return;
  }
  if (edge.Segment != NoId && this->SplitSegment(edge.Segment, edge.Point))
  {
    this->Enqueue(t);
    return;
  }
  if (state != QueueState::Last && !this->AreEdgesFirst())
  {
    this->Enqueue(t, QueueState::Last, this->GetNextNumber());
    return;
  }
  const Id encroaching = !this->Found.InsideSmallestSphere.empty()
    ? this->Found.InsideSmallestSphere.front()
    : !this->Found.OnSmallestSphere.empty() ? this->Found.OnSmallestSphere.front()
    : !this->Found.Cocircular.empty()       ? this->Found.Cocircular.front()
                                            : NoId;
  const Id newPoint = static_cast<Id>(this->Points.size());
  Vec3 target;
  const bool isMirrored =
    encroaching != NoId && this->Partners->PlaceInFacet(t, encroaching, target);
  if ((isMirrored && this->ResolveInFacet(t, encroaching, target, true)) ||
    (this->FindShellPoint(t, encroaching, target) &&
      this->ResolveInFacet(t, encroaching, target, false)) ||
    this->ResolveInFacet(t, encroaching, this->FindCircumcenter(t), false) ||
    this->SplitLongestEdge(t))
  {
    this->NoteOverrefinement(t, newPoint);
    this->Enqueue(t);
    return;
  }
  this->IsBad[t] = 1;
}

void SurfaceRefinement::EnqueueEdge(Id segment)
{
  const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
  const double length = Distance(this->Points[ends[0]], this->Points[ends[1]]);
  if (this->IsRelaxed(length))
  {
    return;
  }
  this->EdgeQueue.emplace_back(length, segment);
  std::push_heap(this->EdgeQueue.begin(), this->EdgeQueue.end(), std::greater<>());
}

/**
 * Edges whose diametral spheres have to be empty come before any triangle, but in stacks: facets
 * are refined from a fine enough outline. The shortest first: what it needs is given by the surface
 * around it, and the partners of its points are the points that longer edges need.
 */
void SurfaceRefinement::ProcessEdge()
{
  std::pop_heap(this->EdgeQueue.begin(), this->EdgeQueue.end(), std::greater<>());
  const auto [length, segment] = this->EdgeQueue.back();
  this->EdgeQueue.pop_back();
  const EdgeIds ends = this->Surface->GetSegment(segment).Points;
  const Vec3 a = this->Points[ends[0]];
  const Vec3 b = this->Points[ends[1]];
  if (length != Distance(a, b))
  {
    // It has been split since, and both pieces are in the queue.
    return;
  }
  const Id encroaching = this->FindDeepestPoint(ends);
  if (encroaching == NoId)
  {
    const EnclosingBall ball(a, b);
    this->EmptyEdges.Set(segment, ball.GetCenter(), ball.GetRadius());
    return;
  }
  this->CollectIncidences();
  if (!this->SplitSegment(segment, encroaching))
  {
    this->IsEncroached.resize(this->Surface->GetNumberOfSegments(), 0);
    this->IsEncroached[segment] = 1;
  }
}

/** Whether a stack gets points in facets that do not match those on edges any more. */
bool SurfaceRefinement::HasTooManyInFacets() const
{
  const std::size_t onEdges = static_cast<std::size_t>(this->NumberOfEdgePoints);
  return this->Plan.GivesUp && this->Plan.Rules == MatchingRules::Stacks &&
    this->NewPoints.size() > MostInFacets + (1 + MostPerEdgePoint) * onEdges;
}

Status SurfaceRefinement::Refine(const ExecutionContext& context)
{
  if (!this->Plan.MakesShorterEdges)
  {
    return this->RefineQueued(context);
  }
  if (this->Plan.IsRescue)
  {
    this->StartRescue(this->UsualMaximum);
  }
  Status status = this->RefineQueued(context.Part(0.0, 0.5));
  if (status.IsOk() && !this->Plan.GivesUp && this->EnqueueNonDelaunay())
  {
    if (!this->IsRescuing())
    {
      this->StartRescue(this->UsualMaximum);
    }
    status = this->RefineQueued(context.Part(0.5, 1.0));
  }
  return status;
}

Status SurfaceRefinement::RefineQueued(const ExecutionContext& context)
{
  // A step may leave more to do than before: what is reported never goes back.
  double done = 0.0;
  for (std::size_t steps = 0; !this->EdgeQueue.empty() || !this->Queue.empty(); ++steps)
  {
    const double left = static_cast<double>(this->EdgeQueue.size() + this->Queue.size());
    done = std::max(done, static_cast<double>(steps) / (static_cast<double>(steps) + left));
    if (steps % ReportInterval == 0 && !context.Continue(done, "Refining the surface"))
    {
      return Status::Aborted();
    }
    const Status range =
      CheckRefinement(this->Points.size(), this->Surface->GetNumberOfTriangles());
    if (!range.IsOk())
    {
      return range;
    }
    const bool isLate = steps % ReportInterval == 0 && context.IsLate();
    const bool isHopeless = this->HasTooManyNeedles() || this->HasTooManyInFacets();
    this->HasGivenUp = this->HasGivenUp || isLate || isHopeless;
    if (this->IsRescuing() ? isHopeless : this->IsFull())
    {
      this->Plan.GivesUp ? this->GiveUp() : this->StartRescue(this->GetMostForRescue(isLate));
    }
    if (!this->EdgeQueue.empty() && (this->AreEdgesFirst() || this->Queue.empty()))
    {
      this->ProcessEdge();
      continue;
    }
    if (this->Queue.empty())
    {
      break;
    }
    if (!this->AreAllTested && !this->TestAll(context.Part(done, done)))
    {
      return Status::Aborted();
    }
    std::pop_heap(this->Queue.begin(), this->Queue.end(), std::greater<>());
    const auto [state, order, t] = this->Queue.back();
    this->Queue.pop_back();
    if (this->States[t] != state)
    {
      continue;
    }
    this->States[t] = QueueState::None;
    if (this->IsRescuing() && static_cast<Id>(this->NewPoints.size()) >= this->MaximumRescuePoints)
    {
      this->IsBad[t] = this->IsProven[t] == 0 && !this->IsGood(t, this->Found);
      continue;
    }
    this->Process(t, state);
  }
  return Status();
}
} // namespace cdm
