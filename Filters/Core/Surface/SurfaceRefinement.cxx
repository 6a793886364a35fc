// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceRefinement.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Surface/SurfaceChecks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t ReportInterval = 256;

/**
 * In curved facets, points closer to others than this are too close, in shortest edges of the input
 * triangle.
 */
constexpr double OverrefinementRatio = 1.0 / 8.0;
/**
 * If another point is closer to a match than this part of the encroaching point's distance, it is
 * match enough. The triangle is too large then: a match would encroach on what lies between.
 */
constexpr double CloseMatchRatio = 0.1;
/** A plan that may give up does so after this part as many needles that are bad as points. */
constexpr Id NeedlePart = 4;
/** A segment passes a new point if it is closer above or below than this, in circumradii ... */
constexpr double PassingRadiusRatio = 0.5;
/** ... and in lengths of the segment, ... */
constexpr double PassingLengthRatio = 0.25;
/** ... and if the sine of its angle with the facet is no larger than this. */
constexpr double PassingSine = 0.5;
/** A point matches a corner of a triangle if it is no farther from it than this, in heights. */
constexpr double MatchRatio = 1.1;
/** Distances from a corner that are as equal as that count as equal. */
constexpr double EqualRadii = 1.01;
} // namespace

SurfaceRefinement::SurfaceRefinement(const TriangleMesh& surface,
  const std::vector<StructuralEdge>& edges, const std::vector<Vec3>& meshPoints,
  const DelaunaySurfaceRefinerOptions& options, SizingField sizing, bool isSaturated,
  SurfaceRefinementPlan plan)
  : Options(options), Plan(plan), Points(surface.Points),
    NumberOfSurfacePoints(static_cast<Id>(surface.Points.size())),
    Diagonal(GetBoundingBoxDiagonal(surface.Points)),
    Flatness(GetFlatness(options.StructuralEdges.FlatnessRatio, surface.Points)),
    MinimumEdge(options.MinimumEdgeRatio * this->Diagonal),
    Test(this->Points, this->Octree), Limits{ options.MaximumEdgeLength, options.MaximumArea,
      options.MinimumAngle, std::move(sizing) }
{
  this->Points.insert(this->Points.end(), meshPoints.begin(), meshPoints.end());
  // Without a limit of the user's, one that only a runaway refinement reaches: sheets a hair apart.
  const std::size_t perTriangle = plan.IsTrial ? 10 : 50;
  this->UsualMaximum = static_cast<Id>(
    std::min<std::size_t>(std::max<std::size_t>(this->Limits.HasAny() ? 1000000 : 20000,
                            perTriangle * surface.Triangles.size()) +
        meshPoints.size(),
      LargestId / 8));
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

Id SurfaceRefinement::AddMeshPoint(const Vec3& position)
{
  const Id point = static_cast<Id>(this->Points.size());
  this->Points.push_back(position);
  if (this->Incidences)
  {
    this->Incidences->AddPoint(NoId, NoId);
  }
  this->Octree.Insert(point, position);
  this->TestAgainAround(position);
  return point;
}

void SurfaceRefinement::RemoveMeshPoint(Id point)
{
  this->Octree.Remove(point, this->Points[point]);
}

void SurfaceRefinement::MovePoints(const std::vector<std::pair<Id, Vec3>>& moves)
{
  // The octree never has two points at one position.
  std::vector<char> isMoved(this->Points.size(), 0);
  for (const auto& [point, position] : moves)
  {
    isMoved[point] = 1;
    this->Octree.Remove(point, this->Points[point]);
  }
  for (const auto& [point, position] : moves)
  {
    this->Points[point] = position;
    this->Octree.Insert(point, position);
    this->TestAgainAround(position);
  }
  const auto isAnyMoved = [&isMoved](const auto& ids)
  { return std::any_of(ids.begin(), ids.end(), [&](Id id) { return isMoved[id] != 0; }); };
  for (Id t = 0; t < this->Surface->GetNumberOfTriangles() && !moves.empty(); ++t)
  {
    if (isAnyMoved(this->Surface->GetTriangle(t).Points))
    {
      this->RemoveProof(t);
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
      if (use < 0 || std::find(triangles.begin(), triangles.end(), use / 3) != triangles.end())
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

bool SurfaceRefinement::IsGood(Id t, SurfaceDelaunayTest::Result& found, bool isStrong) const
{
  this->Test.Run(this->Surface->GetTriangle(t).Points, found, isStrong);
  if (!found.IsDelaunay || (!found.Cocircular.empty() && !this->IsCocircularFacet(t, found)))
  {
    return false;
  }
  return !isStrong || found.InsideSmallestSphere.empty();
}

/** The limit of points is reached: as many again for what the criterion Delaunay needs. */
void SurfaceRefinement::StartRescue()
{
  this->MaximumRescuePoints = static_cast<Id>(this->NewPoints.size()) + this->UsualMaximum;
  this->EdgeQueue.clear();
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
  if (this->Options.Criterion == SurfaceCriterion::Delaunay || !this->IsRelaxed())
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
    DiametralSphereVisitor visitor(this->Points, this->Surface->GetSegment(s).Points);
    this->Octree.Visit(visitor, visitor.GetReach());
    this->IsEncroached[s] = visitor.Found != NoId ? 1 : 0;
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
  // double sphere sees.
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
    if (InEquatorialSphere(
          this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], this->Points[d]) < 0)
    {
      continue;
    }
    SurfaceDelaunayTest::Result first;
    SurfaceDelaunayTest::Result second;
    const bool isStronger = this->IsStrong();
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
  this->Proofs.Set(t, proof.Center, proof.Radius);
  if (proof.IsFlat)
  {
    this->FlatProofs[t] = proof.Point;
  }
  else
  {
    this->FlatProofs.erase(t);
  }
}

void SurfaceRefinement::RemoveProof(Id t)
{
  this->Proofs.Remove(t);
  this->FlatProofs.erase(t);
}

/**
 * Whether a point within the ball of a proof is certainly outside of the sphere of the proof. A
 * point of long, thin sheets reaches the balls of some forty triangles, nearly always in vain.
 */
bool SurfaceRefinement::IsOutsideOfFlatProof(Id t, const Vec3& position) const
{
  const auto proof = this->FlatProofs.find(t);
  if (proof == this->FlatProofs.end() || this->IsProven[t] == 0)
  {
    return false;
  }
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  const Vec3& c = this->Points[ids[2]];
  const int side = Orientation(a, b, c, proof->second);
  return side * InSphere(a, b, c, proof->second, position) < 0;
}

/** Puts triangles and edges on which a new point may encroach into the queues again. */
void SurfaceRefinement::TestAgainAround(const Vec3& position)
{
  this->Proofs.Find(position, this->Reached);
  for (Id t : this->Reached)
  {
    if (!this->IsOutsideOfFlatProof(t, position))
    {
      this->RemoveProof(t);
      this->Enqueue(t);
    }
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

bool SurfaceRefinement::SplitSegment(Id segment, Id encroaching)
{
  const EdgeIds ends = this->Surface->GetSegment(segment).Points;
  const Vec3 a = this->Points[ends[0]];
  const Vec3 b = this->Points[ends[1]];
  const double length = Distance(a, b);
  Vec3 position = this->Partners->PlaceOnSegment(segment, encroaching);
  for (int attempt = 0; attempt < 2; ++attempt)
  {
    if (std::min(Distance(position, a), Distance(position, b)) >= this->MinimumEdge &&
      !this->HasPointNear(position, 0.0) && this->Surface->CanSplitSegment(segment, position))
    {
      const double weight = Distance(position, a) / length;
      const PointParents parents{ { ends[0], ends[1], NoId }, { 1.0 - weight, weight, 0.0 } };
      const Id point =
        this->AddPoint(position, parents, NoId, this->Surface->GetSegment(segment).InputEdge);
      ++this->NumberOfEdgePoints;
      std::vector<Id> uses;
      this->Surface->SplitSegment(segment, point, uses);
      this->NoteSegment(segment);
      this->NoteSegment(this->Surface->GetNumberOfSegments() - 1);
      if (this->AreEdgesTested())
      {
        this->EmptyEdges.Remove(segment);
        this->EnqueueEdge(segment);
        this->EnqueueEdge(this->Surface->GetNumberOfSegments() - 1);
      }
      this->Legalize(uses);
      return true;
    }
    position = 0.5 * (a + b);
  }
  return false;
}

/**
 * Of the segments of a bad triangle the one that is most encroached on, by any point: facets get
 * points where their outline is fine enough. Points on the sphere of an edge are looked for among
 * what was found on the triangle's sphere, if that is given.
 */
SurfaceRefinement::EncroachedEdge SurfaceRefinement::FindEncroachedEdge(
  Id t, const SurfaceDelaunayTest::Result* found) const
{
  EncroachedEdge best;
  double bestDepth = Infinity;
  const auto consider = [&](Id segment, Id point)
  {
    const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
    const Vec3& a = this->Points[ends[0]];
    const Vec3& b = this->Points[ends[1]];
    const double distance = Distance(this->Points[point], 0.5 * (a + b));
    const double depth = distance / Distance(a, b);
    if (point != ends[0] && point != ends[1] && depth < bestDepth &&
      InDiametralSphere(a, b, this->Points[point]) >= 0)
    {
      best = { segment, point, distance };
      bestDepth = depth;
    }
  };
  for (int i = 0; i < 3; ++i)
  {
    const Id segment = this->Surface->GetSegmentAt(t, i);
    if (segment == NoId)
    {
      continue;
    }
    DiametralSphereVisitor visitor(this->Points, this->Surface->GetSegment(segment).Points);
    this->Octree.Visit(visitor, visitor.GetReach());
    if (visitor.Found != NoId)
    {
      consider(segment, visitor.Found);
    }
    else if (found != nullptr)
    {
      consider(segment, this->Surface->GetApex(3 * t + i));
      for (const auto* points : { &found->OnSmallestSphere, &found->Cocircular })
      {
        for (Id point : *points)
        {
          consider(segment, point);
        }
      }
    }
  }
  return best;
}

/** Remembers the diametral sphere of a segment if new points in facets have to give way to it. */
void SurfaceRefinement::NoteSegment(Id segment)
{
  if (this->Plan.Rules == MatchingRules::Stacks)
  {
    const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
    const Vec3& a = this->Points[ends[0]];
    const Vec3& b = this->Points[ends[1]];
    this->SegmentBalls.Set(segment, 0.5 * (a + b), 0.5 * Distance(a, b));
  }
}

/**
 * Of the segments that pass close above or below a new point in a facet, the one on which it would
 * encroach most, or none. What matches the points of that segment would come close to the new one.
 */
Id SurfaceRefinement::FindPassingSegment(Id t, const Vec3& position)
{
  if (this->Plan.Rules != MatchingRules::Stacks)
  {
    return NoId;
  }
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Vec3& corner = this->Points[ids[0]];
  Vec3 normal = Cross(this->Points[ids[1]] - corner, this->Points[ids[2]] - corner);
  normal = (1.0 / Norm(normal)) * normal;
  const double radius = Distance(this->FindCircumcenter(t), corner);
  this->SegmentBalls.Find(position, this->Reached);
  Id found = NoId;
  double nearest = Infinity;
  for (Id segment : this->Reached)
  {
    const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
    const Vec3& a = this->Points[ends[0]];
    const Vec3& b = this->Points[ends[1]];
    const double length = Distance(a, b);
    const Vec3 direction = (1.0 / length) * (b - a);
    const Vec3 arm = a + Dot(position - a, direction) * direction - position;
    const double height = std::abs(Dot(arm, normal));
    const double distance = Norm(arm) / length;
    if (distance < nearest && height <= PassingRadiusRatio * radius &&
      height <= PassingLengthRatio * length && std::abs(Dot(direction, normal)) <= PassingSine &&
      InDiametralSphere(a, b, position) >= 0)
    {
      nearest = distance;
      found = segment;
    }
  }
  return found;
}

bool SurfaceRefinement::ResolveInFacet(Id t, Id encroaching, const Vec3& target, bool isMirrored)
{
  const RefinableSurface& surface = *this->Surface;
  const TriangleIds start = surface.GetTriangle(t).Points;
  FacetWalk::Landing landing;
  if (!this->Walk->Run(t, isMirrored ? encroaching : NoId, target, landing))
  {
    return false;
  }
  if (landing.Segment != NoId)
  {
    const EdgeIds& ends = surface.GetSegment(landing.Segment).Points;
    const auto isEncroachedBy = [&](const Vec3& p)
    { return InDiametralSphere(this->Points[ends[0]], this->Points[ends[1]], p) >= 0; };
    const bool isEncroached = encroaching != NoId && isEncroachedBy(this->Points[encroaching]);
    if (isMirrored && !isEncroached && this->IsMatchedByEnd(landing.Segment, encroaching, target))
    {
      return false;
    }
    const bool isTargetPartner =
      this->Plan.Rules != MatchingRules::Usual && isMirrored && isEncroachedBy(target);
    // On a curved facet the walk may lead to an edge that has nothing to do with the triangle.
    return (isEncroached || isEncroachedBy(target) ||
             std::any_of(start.begin(), start.end(),
               [&](Id p) { return isEncroachedBy(this->Points[p]); })) &&
      this->SplitSegment(landing.Segment, isEncroached || isTargetPartner ? encroaching : NoId);
  }

  // A point that does not encroach on the triangle would not remove it (on curved facets).
  const Vec3& position = landing.Position;
  if (this->HasPointNear(position, this->MinimumEdge) ||
    InEquatorialSphere(
      this->Points[start[0]], this->Points[start[1]], this->Points[start[2]], position) <= 0)
  {
    return false;
  }
  if (isMirrored && AreForLayers(this->Plan.Rules))
  {
    const double reach = CloseMatchRatio * Distance(position, this->Points[encroaching]);
    NearestPointVisitor visitor(position, encroaching, reach);
    this->Octree.Visit(visitor, visitor.GetReach());
    const IdLists::Range facets =
      visitor.Nearest != NoId ? this->Incidences->GetFacets(visitor.Nearest) : IdLists::Range();
    if (std::binary_search(facets.begin(), facets.end(), surface.GetTriangle(t).Facet))
    {
      return false;
    }
  }
  const Id current = landing.Triangle;
  if (landing.Edge != NoId && surface.GetSegmentAt(current, landing.Edge) != NoId)
  {
    return this->SplitSegment(surface.GetSegmentAt(current, landing.Edge), encroaching);
  }

  // A point that would encroach on an edge of the facet must not be made: split the edge instead.
  const Id encroached = this->Walk->FindEncroachedSegment(current, position);
  if (encroached != NoId)
  {
    if (isMirrored && this->IsMatchedByEnd(encroached, encroaching, position))
    {
      return false;
    }
    return this->SplitSegment(encroached, isMirrored ? encroaching : NoId);
  }
  const Id passing = isMirrored ? NoId : this->FindPassingSegment(t, position);
  if (passing != NoId && this->SplitSegment(passing, NoId))
  {
    return true;
  }

  const TriangleIds ids = surface.GetTriangle(current).Points;
  const Vec3 weights = GetBarycentricWeights(
    position, this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
  const PointParents parents{ ids, { weights.X, weights.Y, weights.Z } };
  const Id point = this->AddPoint(position, parents, surface.GetTriangle(current).Facet, NoId);
  std::vector<Id> uses;
  if (landing.Edge == NoId)
  {
    this->Surface->SplitTriangle(current, point, uses);
  }
  else
  {
    this->Surface->SplitSmoothEdge(3 * current + landing.Edge, point, uses);
  }
  this->Legalize(uses);
  return true;
}

bool SurfaceRefinement::SplitLongestEdge(Id t)
{
  const TriangleIds ids = this->Surface->GetTriangle(t).Points;
  int longest = 0;
  double length = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const double candidate = Distance(this->Points[ids[i]], this->Points[ids[(i + 1) % 3]]);
    if (candidate > length)
    {
      longest = i;
      length = candidate;
    }
  }
  const Id use = 3 * t + longest;
  const Id segment = this->Surface->GetSegmentAt(t, longest);
  if (segment != NoId)
  {
    return this->SplitSegment(segment, this->Surface->GetApex(use));
  }
  const EdgeIds ends{ ids[longest], ids[(longest + 1) % 3] };
  const Vec3 a = this->Points[ends[0]];
  const Vec3 edge = this->Points[ends[1]] - a;
  const double foot = Dot(this->Points[this->Surface->GetApex(use)] - a, edge) / SquaredNorm(edge);
  for (double weight : { std::min(std::max(foot, 0.25), 0.75), 0.5 })
  {
    const Vec3 position = a + weight * edge;
    if (0.25 * length >= this->MinimumEdge && !this->HasPointNear(position, 0.0) &&
      this->Surface->CanSplitSmoothEdge(use, position))
    {
      const PointParents parents{ { ends[0], ends[1], NoId }, { 1.0 - weight, weight, 0.0 } };
      const Id point = this->AddPoint(position, parents, this->Surface->GetTriangle(t).Facet, NoId);
      std::vector<Id> uses;
      this->Surface->SplitSmoothEdge(use, point, uses);
      this->Legalize(uses);
      return true;
    }
  }
  return false;
}

Vec3 SurfaceRefinement::FindCircumcenter(Id t) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  return GetCircumcenter(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
}

/** Segment: a structural edge to split first, or NoId. */
bool SurfaceRefinement::FindTooCoarse(Id t, Id& segment) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Id segments[3] = { this->Surface->GetSegmentAt(t, 0), this->Surface->GetSegmentAt(t, 1),
    this->Surface->GetSegmentAt(t, 2) };
  Id edge;
  const bool isTooCoarse =
    this->Limits.IsTooCoarse({ this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]] },
      { segments[0] != NoId, segments[1] != NoId, segments[2] != NoId },
      this->ExcusedTriangles.empty() ||
        this->ExcusedTriangles[this->Surface->GetTriangle(t).Source] == 0,
      edge);
  segment = edge != NoId ? segments[edge] : NoId;
  return isTooCoarse;
}

/**
 * Notes where points come too close to each other in a curved facet. There a point that mends one
 * triangle may encroach on its neighbors, which are bent against it, and so on with ever smaller
 * triangles. Points much closer to each other than those of the input are a sign of that.
 */
void SurfaceRefinement::NoteOverrefinement(Id t, Id newPoint)
{
  const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
  if (this->ShortestEdges.empty() || newPoint >= static_cast<Id>(this->Points.size()) ||
    !this->Incidences->IsCurved(triangle.Facet) || !this->Incidences->GetEdges(newPoint).empty())
  {
    return;
  }
  const double reach = OverrefinementRatio * this->ShortestEdges[triangle.Source];
  if (this->HasPointNear(this->Points[newPoint], reach, newPoint))
  {
    this->IsOverrefined.resize(this->ShortestEdges.size(), 0);
    this->IsOverrefined[triangle.Source] = 1;
  }
}

/**
 * Whether an end of a segment matches the encroaching point as well as the position does. The usual
 * rules do not ask for it.
 */
bool SurfaceRefinement::IsMatchedByEnd(Id segment, Id encroaching, const Vec3& position) const
{
  const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
  const double nearest =
    std::min(Distance(position, this->Points[ends[0]]), Distance(position, this->Points[ends[1]]));
  return this->Plan.Rules != MatchingRules::Usual &&
    nearest < CloseMatchRatio * Distance(position, this->Points[encroaching]);
}

/**
 * Whether a triangle with a corner of the input is too long, as seen from there: a point that
 * matches another of its points encroaches on it, as the match is not exact in the direction of the
 * corner.
 */
bool SurfaceRefinement::IsTooLong(Id t, int corner, Id encroaching) const
{
  if (this->Plan.Rules != MatchingRules::Stacks || encroaching == NoId)
  {
    return false;
  }
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Vec3& q = this->Points[encroaching];
  const Vec3 first = this->Points[ids[(corner + 1) % 3]] - this->Points[ids[corner]];
  const Vec3 second = this->Points[ids[(corner + 2) % 3]] - this->Points[ids[corner]];
  const Vec3 normal = Cross(first, second);
  const double height = std::abs(Dot(q - this->Points[ids[corner]], normal)) / Norm(normal);
  Vec3 outward = (1.0 / Norm(first)) * first + (1.0 / Norm(second)) * second;
  outward = (1.0 / Norm(outward)) * outward;
  const Vec3 center = this->FindCircumcenter(t);
  for (const Id point : { ids[(corner + 1) % 3], ids[(corner + 2) % 3] })
  {
    // How much nearer the match is to the circumcenter than the point, along the way and across.
    const Vec3 offset = q - this->Points[point];
    const Vec3 arm = center - this->Points[point];
    const double along = Dot(offset, outward) * Dot(arm, outward);
    const double across = Dot(offset, arm) - along;
    if (Norm(offset) < MatchRatio * height && along > 0.0 && along > across)
    {
      return true;
    }
  }
  return false;
}

/**
 * Finds a point on a shell around a corner of the input, to be used instead of the circumcenter of
 * a triangle at that corner. Only with the rules for thin layers. The triangle's other two points
 * have to be about as far from the corner as the nearest points on its edges: then the point midway
 * between them at that distance is taken. If one is farther away, the point at that distance on the
 * way to it is taken. Nearer points would ask for nearer ones in all sheets that meet in the
 * corner, and are made only for a triangle that is too long.
 */
bool SurfaceRefinement::FindShellPoint(Id t, Id encroaching, Vec3& target) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  for (int i = 0; i < 3 && AreForLayers(this->Plan.Rules); ++i)
  {
    const Id v = ids[i];
    if (v >= this->NumberOfSurfacePoints || this->Incidences->GetEdges(v).size() < 2)
    {
      continue;
    }
    const Vec3& corner = this->Points[v];
    Vec3 near = this->Points[ids[(i + 1) % 3]] - corner;
    Vec3 far = this->Points[ids[(i + 2) % 3]] - corner;
    if (SquaredNorm(near) > SquaredNorm(far))
    {
      std::swap(near, far);
    }
    const double radius = Norm(near);
    if (radius <= EqualRadii * this->Incidences->GetInnerRadius(v))
    {
      const double farther = Norm(far);
      const bool isTooLong = this->IsTooLong(t, i, encroaching);
      const Vec3 direction =
        farther > EqualRadii * radius && !isTooLong ? far : near + (radius / farther) * far;
      target = corner + ((isTooLong ? 0.5 : 1.0) * radius / Norm(direction)) * direction;
      return true;
    }
  }
  return false;
}

void SurfaceRefinement::Process(Id t, QueueState state)
{
  Id segment = NoId;
  const bool isProven = this->IsProven[t] != 0;
  // Points only come: a triangle that has waited for the split of an edge is bad as long as the
  // criterion is the same. Tests of needles are long.
  EncroachedEdge edge;
  if (state == QueueState::Edge && !this->IsRescuing())
  {
    edge = this->FindEncroachedEdge(t, nullptr);
  }
  const bool isTested = edge.Segment == NoId;
  if (isTested && (isProven || this->IsGood(t, this->Found)))
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
  this->NumberOfNeedles += isTested && this->Found.IsNeedle ? 1 : 0;
  this->RemoveProof(t);
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
  edge = isTested ? this->FindEncroachedEdge(t, &this->Found) : edge;
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
  if (this->IsRelaxed())
  {
    return;
  }
  const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
  this->EdgeQueue.emplace_back(Distance(this->Points[ends[0]], this->Points[ends[1]]), segment);
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
  DiametralSphereVisitor visitor(this->Points, ends);
  this->Octree.Visit(visitor, visitor.GetReach());
  if (visitor.Found == NoId)
  {
    this->EmptyEdges.Set(segment, 0.5 * (a + b), 0.5 * length * (1.0 + 1e-6));
    return;
  }
  this->CollectIncidences();
  if (!this->SplitSegment(segment, visitor.Found))
  {
    this->IsEncroached.resize(this->Surface->GetNumberOfSegments(), 0);
    this->IsEncroached[segment] = 1;
  }
}

Status SurfaceRefinement::Refine(const ExecutionContext& context)
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
    this->HasGivenUp = this->HasGivenUp ||
      (this->Plan.GivesUp && this->NumberOfNeedles > this->UsualMaximum / NeedlePart);
    if (this->IsFull() && !this->IsRescuing())
    {
      this->Plan.GivesUp ? this->GiveUp() : this->StartRescue();
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
