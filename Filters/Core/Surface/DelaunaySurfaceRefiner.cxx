// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/DuplicateTriangles.h"
#include "Core/Search/BallIndex.h"
#include "Core/Search/PointSearches.h"
#include "Core/Sizing/TriangleLimits.h"
#include "Core/Surface/FacetWalk.h"
#include "Core/Surface/MeshPointClearance.h"
#include "Core/Surface/PartnerPoints.h"
#include "Core/Surface/RefinableSurface.h"
#include "Core/Surface/SurfaceChecks.h"
#include "Core/Surface/SurfaceDelaunayTest.h"
#include "Core/Surface/SurfaceFlips.h"
#include "Core/Surface/SurfaceIncidences.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t ReportInterval = 256;

/** In curved facets, points closer than that to others, in shortest edges of the input there. */
constexpr double CrumplingRatio = 1.0 / 8.0;

/** After so many attempts all edges of curved facets are structural. */
constexpr int LargestNumberOfAttempts = 20;

class SurfaceRefiner
{
public:
  SurfaceRefiner(const DelaunaySurfaceRefinerInput& input,
    const DelaunaySurfaceRefinerOptions& options, const ExecutionContext& context,
    DelaunaySurfaceRefinerOutput& output)
    : Input(input), Options(options), Context(context), Output(output), Test(Points, Octree)
  {
  }

  Status Run();

  /**
   * Marks the triangles of the input that refinement did not come to an end with because their
   * facet is curved. Returns whether there are any that were not marked before.
   */
  bool FindCrumpled(std::vector<char>& isExact) const;

private:
  Status Prepare();
  /**
   * Unless all edges have been made fine enough before, triangles that only a point in their facet
   * would mend come last, when no edge is left to split: what edges need is needed anyway, and
   * points in facets match those on edges then. In thin parts that saves up to 40 % of the points.
   */
  enum class QueueState : char
  {
    None,
    First,
    Last
  };

  struct QueueEntry
  {
    QueueState State;
    double Order;
    Id Triangle;

    bool operator>(const QueueEntry& other) const
    {
      return this->State != other.State ? this->State > other.State
        : this->Order != other.Order    ? this->Order > other.Order
                                        : this->Triangle > other.Triangle;
    }
  };

  void AddMeshPoints();
  void CollectIncidences();
  void Saturate();
  Status SplitRequested();
  Status Refine();
  void Process(Id t, QueueState state);
  void NoteCrumpling(Id t, Id newPoint);
  void ProcessEdge();
  bool AreEdgesTested() const
  {
    return this->Options.Criterion == SurfaceCriterion::SmallestSphereAndEdges;
  }
  bool IsGood(Id t, SurfaceDelaunayTest::Result& found) const;
  bool TestAll(const ExecutionContext& context);
  bool IsCocircularFacet(Id t, const SurfaceDelaunayTest::Result& found) const;
  bool FindTooCoarse(Id t, Id& segment) const;

  // Each returns true if it has changed the surface.
  bool ResolveByFlip(Id t);
  bool ResolveByEdge(Id t);
  bool ResolveInFacet(Id t, Id disturbing, const Vec3& target, bool isMirrored);
  bool SplitSegment(Id segment, Id disturbing);
  bool SplitLongestEdge(Id t);

  void Legalize(std::vector<Id>& uses);
  Id AddPoint(const Vec3& position, const PointParents& parents, Id facet, Id inputEdge);
  void Enqueue(Id t);
  void Enqueue(Id t, QueueState state);
  void EnqueueEdge(Id segment);
  /** Whether there is a point at the position or nearer than that. */
  bool HasPointNear(const Vec3& position, double distance, Id except = NoId) const
  {
    NearestPointVisitor visitor(position, except, std::max(distance, SamePoint));
    this->Octree.Visit(visitor, visitor.GetReach());
    return visitor.Nearest != NoId;
  }
  bool IsFull() const
  {
    return static_cast<Id>(this->Output.NewPoints.size()) >= this->MaximumNewPoints;
  }
  Status Finish();

  const DelaunaySurfaceRefinerInput& Input;
  const DelaunaySurfaceRefinerOptions& Options;
  const ExecutionContext& Context;
  DelaunaySurfaceRefinerOutput& Output;

  /** Points of the surface, then kept mesh points, then new ones. */
  std::vector<Vec3> Points;
  Id NumberOfSurfacePoints = 0;
  Id NumberOfGivenPoints = 0;
  Id MaximumNewPoints = 0;
  double Diagonal = 0.0;
  double Flatness = 0.0;
  double MinimumEdge = 0.0;
  PointOctree Octree;
  SurfaceDelaunayTest Test;
  SurfaceDelaunayTest::Result Found;
  std::unique_ptr<RefinableSurface> Surface;
  std::unique_ptr<SurfaceFlips> Flips;
  TriangleLimits Limits;

  /** These are made when the first triangle has to be refined. */
  std::unique_ptr<SurfaceIncidences> Incidences;
  std::unique_ptr<PartnerPoints> Partners;
  std::unique_ptr<FacetWalk> Walk;
  /**
   * Empty, or marks triangles of the input in curved facets: points there come too close, or flips
   * have made two sheets the same.
   */
  std::vector<char> IsCrumpled;
  BallIndex Proofs;
  /** Triangles to be looked at, a heap. */
  std::vector<QueueEntry> Queue;
  std::int64_t NumberOfEnqueued = 0;
  /** Of each triangle; entries that differ are stale. */
  std::vector<QueueState> States;
  /** Whether a triangle has passed the test since it or something around it has changed. */
  std::vector<char> IsProven;
  bool AreAllTested = false;
  std::vector<char> IsUnresolved;
  std::vector<Id> Reached;
  /**
   * Length and number of segments to be looked at, a heap; diametral spheres of those that were.
   */
  std::vector<std::pair<double, Id>> EdgeQueue;
  BallIndex EmptyEdges;
  /** Segments that are disturbed and cannot be split. */
  std::vector<char> IsDisturbed;
};

/** The surface's points are in place: mesh points that keep clear of it follow. */
void SurfaceRefiner::AddMeshPoints()
{
  if (this->Input.MeshPoints == nullptr || this->Input.MeshPoints->empty())
  {
    return;
  }
  const std::vector<Vec3>& meshPoints = *this->Input.MeshPoints;
  this->Output.KeptMeshPoints = FindClearMeshPoints(*this->Input.Surface, meshPoints,
    this->Options.MeshPointClearanceRatio * this->Diagonal, this->Options.NumberOfThreads);
  for (const Id i : this->Output.KeptMeshPoints)
  {
    this->Points.push_back(meshPoints[i]);
  }
  this->Output.Report.DroppedMeshPoints =
    static_cast<Id>(meshPoints.size() - this->Output.KeptMeshPoints.size());
}

Status SurfaceRefiner::Prepare()
{
  Status status = CheckRefinableSurface(
    *this->Input.Surface, this->Input.MeshPoints != nullptr ? this->Input.MeshPoints->size() : 0);
  if (!status.IsOk())
  {
    return status;
  }
  const TriangleMesh& surface = *this->Input.Surface;
  this->Points = surface.Points;
  this->NumberOfSurfacePoints = static_cast<Id>(surface.Points.size());
  this->Diagonal = GetBoundingBoxDiagonal(this->Points);
  this->Flatness = this->Options.StructuralEdges.FlatnessRatio * this->Diagonal;
  this->MinimumEdge = this->Options.MinimumEdgeRatio * this->Diagonal;
  StructuralEdgesOutput edges;
  status = ExtractStructuralEdges(
    surface, this->Options.StructuralEdges, this->Context.Part(0.0, 0.05), edges);
  if (!status.IsOk())
  {
    return status;
  }
  this->AddMeshPoints();
  this->NumberOfGivenPoints = static_cast<Id>(this->Points.size());
  this->Limits = { this->Options.MaximumEdgeLength, this->Options.MaximumArea,
    this->Options.MinimumAngle, this->Input.Sizing };
  // Without a limit of the user's, one that only a runaway refinement reaches: sheets a hair apart.
  this->MaximumNewPoints = this->Options.MaximumNewPoints > 0
    ? this->Options.MaximumNewPoints
    : static_cast<Id>(
        std::min<std::size_t>(std::max<std::size_t>(this->Limits.HasAny() ? 1000000 : 20000,
                                50 * surface.Triangles.size()) +
            this->Output.KeptMeshPoints.size(),
          LargestId / 8));
  this->Octree.Insert(this->Points);
  this->Surface = std::make_unique<RefinableSurface>(surface, edges.Edges, this->Points);
  this->Flips = std::make_unique<SurfaceFlips>(
    *this->Surface, this->Points, this->Flatness, this->Options.StructuralEdges.AccuracyAngle);
  return Status();
}

void SurfaceRefiner::CollectIncidences()
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
  this->Partners = std::make_unique<PartnerPoints>(
    *this->Surface, *this->Incidences, this->Points, this->Octree, this->Diagonal);
  this->Walk = std::make_unique<FacetWalk>(
    *this->Surface, *this->Partners, this->Points, this->Octree, this->Diagonal);
}

void SurfaceRefiner::Enqueue(Id t)
{
  if (static_cast<std::size_t>(t) >= this->States.size())
  {
    this->States.resize(t + 1, QueueState::None);
    this->IsProven.resize(t + 1, 0);
    this->IsUnresolved.resize(t + 1, 0);
  }
  this->IsProven[t] = 0;
  this->IsUnresolved[t] = 0;
  if (this->States[t] != QueueState::First)
  {
    this->Enqueue(t, QueueState::First);
  }
}

void SurfaceRefiner::Enqueue(Id t, QueueState state)
{
  this->States[t] = state;
  // Once the edges are fine enough, small triangles first: what large ones need depends on them.
  // Without, in order: of almost flat surfaces that would be refined down to the smallest.
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const double order = this->AreEdgesTested()
    ? Norm(GetCircumcenterOffset(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]))
    : static_cast<double>(this->NumberOfEnqueued++);
  this->Queue.push_back({ state, order, t });
  std::push_heap(this->Queue.begin(), this->Queue.end(), std::greater<>());
}

void SurfaceRefiner::Legalize(std::vector<Id>& uses)
{
  for (Id use : uses)
  {
    this->Enqueue(use / 3);
  }
  this->Flips->Saturate(uses, [this](Id t) { this->Enqueue(t); });
}

void SurfaceRefiner::Saturate()
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
  for (Id t = 0; t < count; ++t)
  {
    this->Enqueue(t);
  }
}

Status SurfaceRefiner::SplitRequested()
{
  if (this->Input.EdgesToSplit.empty() && this->Input.TrianglesToSplit.empty())
  {
    return Status();
  }
  this->CollectIncidences();
  std::map<EdgeIds, Id> segments;
  const auto makeKey = [](const EdgeIds& edge) { return MakeEdge(edge[0], edge[1]); };
  for (Id s = 0; s < this->Surface->GetNumberOfSegments(); ++s)
  {
    segments.emplace(makeKey(this->Surface->GetSegment(s).Points), s);
  }
  for (const EdgeIds& edge : this->Input.EdgesToSplit)
  {
    const auto segment = segments.find(makeKey(edge));
    if (segment != segments.end() &&
      makeKey(this->Surface->GetSegment(segment->second).Points) == segment->first)
    {
      this->SplitSegment(segment->second, NoId);
      const Status status = this->Refine();
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  for (Id t : this->Input.TrianglesToSplit)
  {
    const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
    // Flips do not count: the triangle is still about there.
    if (*std::max_element(ids.begin(), ids.end()) < this->NumberOfGivenPoints)
    {
      const Vec3 center =
        GetCircumcenter(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
      if (!this->ResolveInFacet(t, NoId, center, false))
      {
        this->SplitLongestEdge(t);
      }
      const Status status = this->Refine();
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  return Status();
}

bool SurfaceRefiner::IsCocircularFacet(Id t, const SurfaceDelaunayTest::Result& found) const
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

bool SurfaceRefiner::IsGood(Id t, SurfaceDelaunayTest::Result& found) const
{
  this->Test.Run(this->Surface->GetTriangle(t).Points, found,
    this->Options.Criterion != SurfaceCriterion::Delaunay);
  if (!found.IsDelaunay || (!found.Cocircular.empty() && !this->IsCocircularFacet(t, found)))
  {
    return false;
  }
  return this->Options.Criterion == SurfaceCriterion::Delaunay ||
    found.InsideSmallestSphere.empty();
}

/**
 * Tests all triangles on all threads before the first of them is refined: most are good and stay
 * so. False if aborted.
 */
bool SurfaceRefiner::TestAll(const ExecutionContext& context)
{
  this->AreAllTested = true;
  const auto count = static_cast<std::size_t>(this->Surface->GetNumberOfTriangles());
  std::vector<char> isGood(count, 0);
  std::vector<std::pair<Vec3, double>> proofs(count);
  const ParallelLoopOptions options{ this->Options.NumberOfThreads, 1024 };
  if (!ParallelLoop(count, options, context, "Testing the surface",
        [&](std::size_t begin, std::size_t end, std::size_t)
        {
          SurfaceDelaunayTest::Result found;
          for (std::size_t t = begin; t < end; ++t)
          {
            isGood[t] = this->IsGood(static_cast<Id>(t), found);
            proofs[t] = { found.ProofCenter, found.ProofRadius };
          }
        }))
  {
    return false;
  }
  for (std::size_t t = 0; t < count; ++t)
  {
    if (isGood[t] != 0)
    {
      this->Proofs.Set(static_cast<Id>(t), proofs[t].first, proofs[t].second);
      this->IsProven[t] = 1;
    }
  }
  return true;
}

bool SurfaceRefiner::ResolveByFlip(Id t)
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
    const bool isStronger = this->Options.Criterion != SurfaceCriterion::Delaunay;
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

Id SurfaceRefiner::AddPoint(
  const Vec3& position, const PointParents& parents, Id facet, Id inputEdge)
{
  const Id point = static_cast<Id>(this->Points.size());
  this->Points.push_back(position);
  this->Flips->AddPoint();
  this->Octree.Insert(point, position);
  this->Incidences->AddPoint(facet, inputEdge);
  this->Output.NewPoints.push_back(parents);
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
  return point;
}

bool SurfaceRefiner::SplitSegment(Id segment, Id disturbing)
{
  const EdgeIds ends = this->Surface->GetSegment(segment).Points;
  const Vec3 a = this->Points[ends[0]];
  const Vec3 b = this->Points[ends[1]];
  const double length = Distance(a, b);
  Vec3 position = this->Partners->PlaceOnSegment(segment, disturbing);
  for (int attempt = 0; attempt < 2; ++attempt)
  {
    if (std::min(Distance(position, a), Distance(position, b)) >= this->MinimumEdge &&
      !this->HasPointNear(position, 0.0) && this->Surface->CanSplitSegment(segment, position))
    {
      const double weight = Distance(position, a) / length;
      const PointParents parents{ { ends[0], ends[1], NoId }, { 1.0 - weight, weight, 0.0 } };
      const Id point =
        this->AddPoint(position, parents, NoId, this->Surface->GetSegment(segment).InputEdge);
      ++this->Output.Report.EdgePoints;
      std::vector<Id> uses;
      this->Surface->SplitSegment(segment, point, uses);
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

bool SurfaceRefiner::ResolveByEdge(Id t)
{
  Id bestSegment = NoId;
  Id bestPoint = NoId;
  double bestDepth = Infinity;
  const auto consider = [&](Id segment, const std::vector<Id>& points)
  {
    const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
    const Vec3& a = this->Points[ends[0]];
    const Vec3& b = this->Points[ends[1]];
    const Vec3 middle = 0.5 * (a + b);
    const double unit = 1.0 / SquaredNorm(b - a);
    for (Id point : points)
    {
      const double depth = unit * SquaredNorm(this->Points[point] - middle);
      if (point != ends[0] && point != ends[1] && depth < bestDepth &&
        InDiametralSphere(a, b, this->Points[point]) >= 0)
      {
        bestSegment = segment;
        bestPoint = point;
        bestDepth = depth;
      }
    }
  };
  for (int i = 0; i < 3; ++i)
  {
    const Id segment = this->Surface->GetSegmentAt(t, i);
    if (segment != NoId)
    {
      consider(segment, this->Found.InsideSmallestSphere);
      consider(segment, this->Found.OnSmallestSphere);
      consider(segment, this->Found.Cocircular);
    }
  }
  if (bestSegment == NoId)
  {
    for (int i = 0; i < 3; ++i)
    {
      const Id segment = this->Surface->GetSegmentAt(t, i);
      if (segment != NoId)
      {
        consider(segment, { this->Surface->GetApex(3 * t + i) });
      }
    }
  }
  return bestSegment != NoId && this->SplitSegment(bestSegment, bestPoint);
}

bool SurfaceRefiner::ResolveInFacet(Id t, Id disturbing, const Vec3& target, bool isMirrored)
{
  const RefinableSurface& surface = *this->Surface;
  const TriangleIds start = surface.GetTriangle(t).Points;
  FacetWalk::Landing landing;
  if (!this->Walk->Run(t, isMirrored ? disturbing : NoId, target, landing))
  {
    return false;
  }
  if (landing.Segment != NoId)
  {
    const EdgeIds& ends = surface.GetSegment(landing.Segment).Points;
    const auto isDisturbedBy = [&](const Vec3& p)
    { return InDiametralSphere(this->Points[ends[0]], this->Points[ends[1]], p) >= 0; };
    const bool isDisturbed = disturbing != NoId && isDisturbedBy(this->Points[disturbing]);
    // On a curved facet the walk may lead to an edge that has nothing to do with the triangle.
    return (isDisturbed || isDisturbedBy(target) ||
             std::any_of(
               start.begin(), start.end(), [&](Id p) { return isDisturbedBy(this->Points[p]); })) &&
      this->SplitSegment(landing.Segment, isDisturbed ? disturbing : NoId);
  }

  // A point that does not disturb the triangle would not remove it (on curved facets).
  const Vec3& position = landing.Position;
  if (this->HasPointNear(position, this->MinimumEdge) ||
    InEquatorialSphere(
      this->Points[start[0]], this->Points[start[1]], this->Points[start[2]], position) <= 0)
  {
    return false;
  }
  const Id current = landing.Triangle;
  if (landing.Edge != NoId && surface.GetSegmentAt(current, landing.Edge) != NoId)
  {
    return this->SplitSegment(surface.GetSegmentAt(current, landing.Edge), disturbing);
  }

  // A point that would disturb an edge of the facet must not be made: split the edge instead.
  const Id encroached = this->Walk->FindEncroachedSegment(current, position);
  if (encroached != NoId)
  {
    return this->SplitSegment(encroached, isMirrored ? disturbing : NoId);
  }

  const TriangleIds ids = surface.GetTriangle(current).Points;
  const Vec3 weights = GetBarycentricWeights(
    position, this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
  const PointParents parents{ ids, { weights.X, weights.Y, weights.Z } };
  const Id point = this->AddPoint(position, parents, surface.GetTriangle(current).Facet, NoId);
  ++this->Output.Report.FacetPoints;
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

bool SurfaceRefiner::SplitLongestEdge(Id t)
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
      ++this->Output.Report.FacetPoints;
      std::vector<Id> uses;
      this->Surface->SplitSmoothEdge(use, point, uses);
      this->Legalize(uses);
      return true;
    }
  }
  return false;
}

/** Segment: a structural edge to split first, or NoId. */
bool SurfaceRefiner::FindTooCoarse(Id t, Id& segment) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Id segments[3] = { this->Surface->GetSegmentAt(t, 0), this->Surface->GetSegmentAt(t, 1),
    this->Surface->GetSegmentAt(t, 2) };
  Id edge;
  const bool isTooCoarse =
    this->Limits.IsTooCoarse({ this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]] },
      { segments[0] != NoId, segments[1] != NoId, segments[2] != NoId }, edge);
  segment = edge != NoId ? segments[edge] : NoId;
  return isTooCoarse;
}

/**
 * In a curved facet a point that mends one triangle may disturb its neighbors, which are bent
 * against it, and so on with ever smaller triangles. Points much closer than the input's are a sign
 * of that.
 */
void SurfaceRefiner::NoteCrumpling(Id t, Id newPoint)
{
  const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
  if (newPoint >= static_cast<Id>(this->Points.size()) ||
    !this->Incidences->IsCurved(triangle.Facet) || !this->Incidences->GetEdges(newPoint).empty())
  {
    return;
  }
  const TriangleIds& ids = this->Input.Surface->Triangles[triangle.Source];
  double shortest = Infinity;
  for (int i = 0; i < 3; ++i)
  {
    shortest = std::min(shortest, Distance(this->Points[ids[i]], this->Points[ids[(i + 1) % 3]]));
  }
  if (this->HasPointNear(this->Points[newPoint], CrumplingRatio * shortest, newPoint))
  {
    this->IsCrumpled.resize(this->Input.Surface->Triangles.size(), 0);
    this->IsCrumpled[triangle.Source] = 1;
  }
}

bool SurfaceRefiner::FindCrumpled(std::vector<char>& isExact) const
{
  bool isAnyNew = false;
  const auto mark = [&](Id source)
  {
    isAnyNew = isAnyNew || isExact[source] == 0;
    isExact[source] = 1;
  };
  isExact.resize(this->Input.Surface->Triangles.size(), 0);
  for (std::size_t source = 0; source < this->IsCrumpled.size(); ++source)
  {
    if (this->IsCrumpled[source] != 0)
    {
      mark(static_cast<Id>(source));
    }
  }
  std::vector<char> isUnresolved(this->Incidences ? this->Incidences->GetNumberOfFacets() : 0, 0);
  for (Id t : this->Output.UnresolvedTriangles)
  {
    const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
    if (!isUnresolved.empty() && this->Incidences->IsCurved(triangle.Facet))
    {
      mark(triangle.Source);
      isUnresolved[triangle.Facet] = 1;
    }
  }
  // After flips the source may be a neighbor of the triangle that is meant.
  for (Id t = 0; t < this->Surface->GetNumberOfTriangles() && !isAnyNew; ++t)
  {
    if (!isUnresolved.empty() && isUnresolved[this->Surface->GetTriangle(t).Facet] != 0)
    {
      mark(this->Surface->GetTriangle(t).Source);
    }
  }
  return isAnyNew;
}

void SurfaceRefiner::Process(Id t, QueueState state)
{
  const auto getCircumcenter = [this](Id triangle)
  {
    const TriangleIds& ids = this->Surface->GetTriangle(triangle).Points;
    return GetCircumcenter(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
  };
  Id segment = NoId;
  const bool isProven = this->IsProven[t] != 0;
  if (isProven || this->IsGood(t, this->Found))
  {
    if (!isProven)
    {
      this->Proofs.Set(t, this->Found.ProofCenter, this->Found.ProofRadius);
      this->IsProven[t] = 1;
    }
    if (this->FindTooCoarse(t, segment))
    {
      this->CollectIncidences();
      // Too coarse is no fault: if a limit forbids to refine, the triangle stays as it is.
      const bool isRefined = segment != NoId
        ? this->SplitSegment(segment, NoId)
        : this->ResolveInFacet(t, NoId, getCircumcenter(t), false) || this->SplitLongestEdge(t);
      if (isRefined)
      {
        this->Enqueue(t);
      }
    }
    return;
  }
  this->Proofs.Remove(t);
  this->CollectIncidences();
  if (this->ResolveByFlip(t))
  {
    return;
  }
  if (!this->IsCrumpled.empty() && this->IsCrumpled[this->Surface->GetTriangle(t).Source] != 0)
  {
    this->IsUnresolved[t] = 1;
    return;
  }
  // Whatever is done now, t is looked at again: the new point need not have changed it.
  this->IsUnresolved[t] = 0;
  if (this->ResolveByEdge(t))
  {
    this->Enqueue(t);
    return;
  }
  if (state == QueueState::First && !this->AreEdgesTested())
  {
    this->Enqueue(t, QueueState::Last);
    return;
  }
  const Id disturbing = !this->Found.InsideSmallestSphere.empty()
    ? this->Found.InsideSmallestSphere.front()
    : !this->Found.OnSmallestSphere.empty() ? this->Found.OnSmallestSphere.front()
    : !this->Found.Cocircular.empty()       ? this->Found.Cocircular.front()
                                            : NoId;
  const Id newPoint = static_cast<Id>(this->Points.size());
  Vec3 target;
  const bool isMirrored = disturbing != NoId && this->Partners->PlaceInFacet(t, disturbing, target);
  if ((isMirrored && this->ResolveInFacet(t, disturbing, target, true)) ||
    this->ResolveInFacet(t, disturbing, getCircumcenter(t), false) || this->SplitLongestEdge(t))
  {
    this->NoteCrumpling(t, newPoint);
    this->Enqueue(t);
    return;
  }
  this->IsUnresolved[t] = 1;
}

void SurfaceRefiner::EnqueueEdge(Id segment)
{
  const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
  this->EdgeQueue.emplace_back(Distance(this->Points[ends[0]], this->Points[ends[1]]), segment);
  std::push_heap(this->EdgeQueue.begin(), this->EdgeQueue.end(), std::greater<>());
}

/**
 * Edges whose diametral spheres have to be empty come before any triangle: facets are refined from
 * a fine enough outline. The shortest first: what it needs is given by the surface around it, and
 * the partners of its points are the points that longer edges need.
 */
void SurfaceRefiner::ProcessEdge()
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
  if (this->IsFull() || !this->SplitSegment(segment, visitor.Found))
  {
    this->IsDisturbed.resize(this->Surface->GetNumberOfSegments(), 0);
    this->IsDisturbed[segment] = 1;
  }
}

Status SurfaceRefiner::Refine()
{
  const ExecutionContext part = this->Context.Part(0.1, 0.95);
  for (std::size_t steps = 0; !this->EdgeQueue.empty() || !this->Queue.empty(); ++steps)
  {
    const double left = static_cast<double>(this->EdgeQueue.size() + this->Queue.size());
    const double done = static_cast<double>(steps) / (static_cast<double>(steps) + left);
    if (steps % ReportInterval == 0 && !part.Continue(done, "Refining the surface"))
    {
      return Status::Aborted();
    }
    const Status range =
      CheckRefinement(this->Points.size(), this->Surface->GetNumberOfTriangles());
    if (!range.IsOk())
    {
      return range;
    }
    if (!this->EdgeQueue.empty())
    {
      this->ProcessEdge();
      continue;
    }
    if (!this->AreAllTested && !this->TestAll(part.Part(done, done)))
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
    if (this->IsFull())
    {
      this->IsUnresolved[t] = this->IsProven[t] == 0 && !this->IsGood(t, this->Found);
      continue;
    }
    this->Process(t, state);
  }
  return Status();
}

Status SurfaceRefiner::Finish()
{
  this->Output.Report.Flips = this->Flips->GetNumberOfFlips();
  // Mesh points lie between the given and the new points of the surface: take them out.
  const Id shift = this->NumberOfGivenPoints - this->NumberOfSurfacePoints;
  const auto renumber = [this, shift](Id id)
  { return id >= this->NumberOfGivenPoints ? id - shift : id; };
  TriangleMesh& surface = this->Output.Surface;
  this->Surface->Export(surface);
  const std::vector<DuplicateTriangle> duplicates = FindDuplicateTriangles(surface.Triangles);
  if (!duplicates.empty())
  {
    std::vector<Id> cells;
    for (const DuplicateTriangle& duplicate : duplicates)
    {
      cells.push_back(surface.SourceCells[duplicate.Original]);
      cells.push_back(surface.SourceCells[duplicate.Triangle]);
    }
    SortUnique(cells);
    this->IsCrumpled.resize(this->Input.Surface->Triangles.size(), 0);
    for (Id source : cells)
    {
      this->IsCrumpled[source] = 1;
    }
    return Status::InvalidInput("Two sheets of the surface with the same points lie within "
                                "FlatnessRatio of each other and have become one: lower "
                                "FlatnessRatio, or unite the sheets with a MergeTolerance of "
                                "vtkBoundaryTriangulator.",
      std::move(cells));
  }
  if (this->Input.Surface->Labels.empty())
  {
    surface.Labels.clear();
  }
  for (TriangleIds& ids : surface.Triangles)
  {
    ids = { renumber(ids[0]), renumber(ids[1]), renumber(ids[2]) };
  }
  surface.Points.assign(this->Points.begin(), this->Points.begin() + this->NumberOfSurfacePoints);
  surface.Points.insert(
    surface.Points.end(), this->Points.begin() + this->NumberOfGivenPoints, this->Points.end());
  for (PointParents& parents : this->Output.NewPoints)
  {
    for (Id& id : parents.Ids)
    {
      id = id == NoId ? NoId : renumber(id);
    }
  }
  for (Id s = 0; s < this->Surface->GetNumberOfSegments(); ++s)
  {
    const RefinableSurface::Segment& segment = this->Surface->GetSegment(s);
    const Id a = renumber(segment.Points[0]);
    const Id b = renumber(segment.Points[1]);
    this->Output.StructuralEdges.push_back(
      { MakeEdge(a, b), segment.Kind, segment.Chain, segment.DihedralAngle });
  }
  std::sort(this->Output.StructuralEdges.begin(), this->Output.StructuralEdges.end(),
    [](const StructuralEdge& x, const StructuralEdge& y)
    { return x.Points[0] != y.Points[0] ? x.Points[0] < y.Points[0] : x.Points[1] < y.Points[1]; });
  this->IsDisturbed.resize(this->Surface->GetNumberOfSegments(), 0);
  for (Id t = 0; t < static_cast<Id>(this->IsUnresolved.size()); ++t)
  {
    bool isUnresolved = this->IsUnresolved[t] != 0;
    for (int i = 0; i < 3; ++i)
    {
      const Id segment = this->Surface->GetSegmentAt(t, i);
      isUnresolved = isUnresolved || (segment != NoId && this->IsDisturbed[segment] != 0);
    }
    if (isUnresolved)
    {
      this->Output.UnresolvedTriangles.push_back(t);
    }
  }
  return Status();
}

Status SurfaceRefiner::Run()
{
  Status status = this->Prepare();
  if (!status.IsOk())
  {
    return status;
  }
  this->Saturate();
  for (Id segment = 0; this->AreEdgesTested() && segment < this->Surface->GetNumberOfSegments();
       ++segment)
  {
    this->EnqueueEdge(segment);
  }
  status = this->Refine();
  // One by one, so that points which match those are made before the next one.
  status = status.IsOk() ? this->SplitRequested() : status;
  return status.IsOk() ? this->Finish() : status;
}
} // namespace

Status RefineDelaunaySurface(const DelaunaySurfaceRefinerInput& input,
  const DelaunaySurfaceRefinerOptions& options, const ExecutionContext& context,
  DelaunaySurfaceRefinerOutput& output)
{
  // Where the facets' curvature keeps refinement from ending, the edges there become structural.
  DelaunaySurfaceRefinerOptions current = options;
  double begin = 0.0;
  for (int attempt = 0;; ++attempt)
  {
    output = DelaunaySurfaceRefinerOutput();
    const double end = options.StructuralEdges.AccuracyAngle > 0.0 ? 0.5 * (begin + 1.0) : 1.0;
    const ExecutionContext part = context.Part(begin, end);
    SurfaceRefiner refiner(input, current, part, output);
    const Status status = refiner.Run();
    const bool isFull = options.MaximumNewPoints > 0 &&
      static_cast<Id>(output.NewPoints.size()) >= options.MaximumNewPoints;
    if (options.StructuralEdges.AccuracyAngle == 0.0 || isFull ||
      !refiner.FindCrumpled(current.StructuralEdges.IsExact))
    {
      if (!status.IsOk())
      {
        output = DelaunaySurfaceRefinerOutput();
      }
      return status;
    }
    if (attempt == LargestNumberOfAttempts)
    {
      current.StructuralEdges.IsExact.assign(input.Surface->Triangles.size(), 1);
    }
    begin = end;
  }
}
} // namespace cdm
