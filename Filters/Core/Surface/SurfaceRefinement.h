// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceRefinement.h
 * @brief Flips and splits a surface until all its triangles are good, and keeps it so afterwards.
 *
 * These are steps 2 to 4 of DelaunaySurfaceRefiner.h, for a surface whose structural edges are
 * known. The object lives on after the refinement: mesh points may come, move and go, and triangles
 * and segments may be split; only what such a change concerns is tested again. Triangles and
 * segments keep their index, see RefinableSurface.h.
 *
 * The queues and the order of work are in SurfaceRefinement.cxx, the splits in
 * SurfaceRefinementSplits.cxx.
 *
 * Cost: see DelaunaySurfaceRefiner.h; a split takes about 100 microseconds, whatever the surface's
 * size.
 */
#ifndef cdmSurfaceRefinement_h
#define cdmSurfaceRefinement_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/ThreadTeam.h"
#include "Core/Search/BallIndex.h"
#include "Core/Search/PointOctree.h"
#include "Core/Search/PointSearches.h"
#include "Core/Sizing/TriangleLimits.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Surface/FacetWalk.h"
#include "Core/Surface/PartnerPoints.h"
#include "Core/Surface/RefinableSurface.h"
#include "Core/Surface/SurfaceDelaunayTest.h"
#include "Core/Surface/SurfaceFlips.h"
#include "Core/Surface/SurfaceIncidences.h"
#include "Core/Surface/TriangleProofs.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace cdm
{
/**
 * The largest number of new points of the first plans, which may give up: so many, or so many for each
 * triangle, if that is more. What ends by these plans hardly ever takes as many.
 */
constexpr std::size_t MostInFirstPlans = 4000;
constexpr std::size_t MostPerTriangleInFirstPlans = 10;

/** How a surface is refined. A surface on which one plan does not end may need another plan. */
struct SurfaceRefinementPlan
{
  MatchingRules Rules = MatchingRules::Usual;
  /**
   * Triangles of edges shorter than this only have to fulfil the criterion Delaunay, and such edges none.
   * 0: none of them; infinity: all of them, and the plan goes as that criterion does.
   */
  double RelaxedLength = 0.0;
  /** Whether that is so of some triangles, but not of all. */
  bool RelaxesSome() const { return this->RelaxedLength > 0.0 && this->RelaxedLength < Infinity; }
  /** Whether edges are made fine enough after all triangles, where they count. */
  bool AreEdgesLast = false;
  /**
   * In stacks: whether a triangle at a corner is cut at half of the distance only for a match that is
   * nearer to the corner than what it matches. For others the arc is cut. There are surfaces that end
   * with either, but not with the other.
   */
  bool CutsArcs = false;
  /**
   * Whether to give up at the largest number of points. Otherwise the refinement then goes on with
   * what the criterion Delaunay needs.
   */
  bool GivesUp = false;
  /** Whether edges shorter than MinimumEdgeRatio are made where there is no mesh without them. */
  bool MakesShorterEdges = false;
  /** Whether sizes and limits of the user do not count: only what the criterion Delaunay needs does. */
  bool IsRescue = false;
  /**
   * The largest number of new points if the user gives none and no sizes, or if some triangles are
   * relaxed: so many, or so many for each triangle, if that is more.
   */
  std::size_t MostPoints = 20000;
  std::size_t MostPerTriangle = 50;
  /**
   * A plan that may give up does so after so many tests of needles that are bad, or a quarter of the
   * points for each triangle, if that is more: it has come down to rounding errors.
   */
  std::size_t MostNeedles = 1000;
};

class SurfaceRefinement
{
public:
  /**
   * @param edges structural edges, sorted
   * @param meshPoints their ids follow those of the surface's points
   * @param sizing as in DelaunaySurfaceRefinerInput
   * @param isSaturated whether the surface has been refined before: only bad triangles are flipped
   */
  SurfaceRefinement(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    const std::vector<Vec3>& meshPoints, const DelaunaySurfaceRefinerOptions& options,
    SizingField sizing, bool isSaturated, SurfaceRefinementPlan plan = {});

  /** See DelaunaySurfaceRefinerInput. */
  void SetExcusedTriangles(std::vector<char> isExcused)
  {
    this->ExcusedTriangles = std::move(isExcused);
  }
  /**
   * Refines all triangles and, where they count, edges; later calls only what has changed since. At
   * the largest number of points, the plan says what is done with the rest.
   */
  Status Refine(const ExecutionContext& context);

  /**
   * Splits a segment, or a triangle by a point in its facet, and refines what the new point
   * encroaches on. Nothing is split if a limit forbids it.
   */
  Status SplitSegment(Id segment, const ExecutionContext& context);
  Status SplitTriangle(Id triangle, const ExecutionContext& context);

  /** Points that have come, gone or moved. */
  struct PointChanges
  {
    /** Mesh points. */
    std::vector<Id> Removed;
    std::vector<Vec3> Added;
    std::vector<std::pair<Id, Vec3>> Moved;
    /** Points of the surface, within their facets and along their edges. */
    std::vector<std::pair<Id, Vec3>> MovedOnSurface;
  };
  /**
   * Changes points; those that are added get the next ids. What they encroach on is refined next
   * time.
   */
  void ChangePoints(const PointChanges& changes, ThreadTeam& team);

  /**
   * Flips diagonals of exactly cocircular quadrilaterals to the corner with the smallest id, as the
   * pulling rule asks for. Starts from the given triangles.
   */
  void PullCocircular(const std::vector<Id>& triangles);

  const RefinableSurface& GetSurface() const { return *this->Surface; }
  /** Points of the surface, then mesh points, then further ones in the order in which they came. */
  const std::vector<Vec3>& GetPoints() const { return this->Points; }
  /** The parents of each new point of the surface. */
  const std::vector<PointParents>& GetNewPoints() const { return this->NewPoints; }
  Id GetNumberOfEdgePoints() const { return this->NumberOfEdgePoints; }
  Id GetNumberOfFlips() const { return this->Flips->GetNumberOfFlips(); }
  /** From now on at most so many new points are made. */
  void AllowNewPoints(std::size_t count);
  /**
   * Whether as many points have been made as allowed. Then only the criterion Delaunay is refined
   * for.
   */
  bool IsFull() const
  {
    return static_cast<Id>(this->NewPoints.size()) >= this->MaximumNewPoints || this->HasGivenUp;
  }
  /** Whether the limits are reached, and only the criterion Delaunay is refined for. */
  bool IsRescuing() const { return this->MaximumRescuePoints > 0; }
  /** How many points have been made since then. */
  Id GetNumberOfRescuePoints() const
  {
    return this->IsRescuing() ? static_cast<Id>(this->NewPoints.size()) - this->PointsBeforeRescue
                              : 0;
  }

  /**
   * After a refinement in which some or all triangles only had to fulfil the criterion Delaunay: finds
   * those that miss the criterion asked for. IsUnresolved() and IsWeak() need it.
   */
  void JudgeRelaxed();

  /** Whether a triangle misses the criterion asked for, or has an encroached edge. */
  bool IsUnresolved(Id triangle) const;
  /** How many triangles and edges are not as they are to be, whatever the plan has relaxed. */
  Id GetNumberOfFailures() const { return this->NumberOfFailures; }
  /** Whether it was needles at which the plan gave up. */
  bool HasTooManyNeedles() const
  {
    return this->Plan.GivesUp && this->NumberOfNeedles > this->MaximumNeedles;
  }
  bool IsDelaunay(Id triangle) const;
  /** Whether limits may have left triangles that are larger than asked for. */
  bool MayBeTooCoarse() const
  {
    return this->Limits.HasAny() && (this->HasLeftTooCoarse || this->IsFull());
  }
  /** Whether a triangle is larger than asked for, whatever its angles. */
  bool IsTooLarge(Id triangle) const;
  /** Whether a triangle should be better but nothing could be done for it. */
  bool IsBadTriangle(Id triangle) const
  {
    return static_cast<std::size_t>(triangle) < this->IsBad.size() && this->IsBad[triangle] != 0;
  }
  /** Whether the triangle is only Delaunay: its smallest sphere is not empty. */
  bool IsWeak(Id triangle) const
  {
    return static_cast<std::size_t>(triangle) < this->WeakTriangles.size() &&
      this->WeakTriangles[triangle] != 0;
  }
  /** Whether the triangle is part of a curved facet. */
  bool IsCurved(Id triangle) const
  {
    return this->Incidences &&
      this->Incidences->IsCurved(this->Surface->GetTriangle(triangle).Facet);
  }
  /**
   * Marks triangles of the input in curved facets where points come too close to each other; empty
   * if there are none. These triangles are not refined further.
   */
  const std::vector<char>& GetOverrefined() const { return this->IsOverrefined; }

  /** Triangles that may have been changed since this was last asked for, ascending. */
  std::vector<Id> TakeTouched();

private:
  /**
   * States of a triangle in the queue. Unless all edges have been made fine enough before,
   * triangles that only a point in their facet would improve come last, when no edge is left to
   * split: what edges need is needed anyway, and points in facets then match those on edges. In
   * thin parts that saves up to 40 % of the points.
   *
   * Edges are split in the order of how close the encroaching point is to the edge's middle,
   * whatever the order of the triangles. That saves up to 47 % of the points (2.5 % in the mean),
   * and makes rotated surfaces need as many points within 5 %.
   */
  enum class QueueState : char
  {
    None,
    First,
    Edge,
    Last
  };

  struct EncroachedEdge
  {
    Id Segment = NoId;
    /** The point that encroaches on the segment, and its distance from the middle. */
    Id Point = NoId;
    double Distance = 0.0;
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

  void CollectIncidences();
  void Saturate();
  void EnqueueAll();
  void Process(Id t, QueueState state);
  void NoteOverrefinement(Id t, Id newPoint);
  void ProcessEdge();
  bool AreEdgesTested() const
  {
    return this->Options.Criterion == SurfaceCriterion::SmallestSphereAndEdges;
  }
  /**
   * Whether all edges are made fine enough before the first triangle is. A relaxed plan goes as the
   * criterion Delaunay does, which ends.
   */
  bool AreEdgesFirst() const
  {
    return this->AreEdgesTested() && this->Plan.RelaxedLength < Infinity &&
      !this->Plan.AreEdgesLast && this->Plan.Rules != MatchingRules::Stacks;
  }
  bool IsGood(Id t, SurfaceDelaunayTest::Result& found) const
  {
    return this->IsGood(t, found, this->IsStrong(t));
  }
  bool IsGood(Id t, SurfaceDelaunayTest::Result& found, bool isStrong) const;
  /** Whether what is so long only has to fulfil the criterion Delaunay. */
  bool IsRelaxed(double length) const
  {
    return length < this->Plan.RelaxedLength || this->IsRescuing();
  }
  /** Whether the smallest sphere of a triangle has to be empty. */
  bool IsStrong(Id t) const;
  Id GetMostForRescue(bool isLate) const;
  void StartRescue(Id most);
  bool EnqueueNonDelaunay();
  Status RefineQueued(const ExecutionContext& context);
  void GiveUp();
  bool TestAll(const ExecutionContext& context);
  bool IsCocircularFacet(Id t, const SurfaceDelaunayTest::Result& found) const;
  bool FindTooCoarse(Id t, Id& segment) const;

  /** The edge of a bad triangle that is encroached on most, or none. */
  EncroachedEdge FindEncroachedEdge(Id t) const;

  // Each returns true if it has changed the surface.
  bool ResolveByFlip(Id t);
  bool ResolveInFacet(Id t, Id encroaching, const Vec3& target, bool isMirrored);
  bool IsTooClose(Id t, const Vec3& position) const;
  bool SplitSegment(Id segment, Id encroaching);
  bool SplitLongestEdge(Id t);

  void Legalize(std::vector<Id>& uses);
  Id AddPoint(const Vec3& position, const PointParents& parents, Id facet, Id inputEdge);
  void SetProof(Id t, const SurfaceDelaunayTest::SphereProof& proof);
  void TestAgainAround(const Vec3& position);
  void TestAgainAt(const std::vector<std::pair<Id, Vec3>>& moves);
  void Touch(Id t);
  void NoteSegment(Id segment);
  Id FindPassingSegment(Id t, const Vec3& position);
  Vec3 FindCircumcenter(Id t) const;
  bool HasTooManyInFacets() const;
  bool IsTooLong(Id t, int corner, Id encroaching) const;
  bool FindShellPoint(Id t, Id encroaching, Vec3& target) const;
  bool IsMatchedByEnd(Id segment, Id encroaching, const Vec3& position) const;
  void Enqueue(Id t);
  void Enqueue(Id t, QueueState state, double order);
  double GetNextNumber() { return static_cast<double>(this->NumberOfEnqueued++); }
  void EnqueueEdge(Id segment);
  /** The deepest point inside the diametral sphere of an edge, or NoId. */
  Id FindDeepestPoint(const EdgeIds& edge) const
  {
    DiametralSphereVisitor visitor(this->Points, edge);
    this->Octree.Visit(visitor, visitor.GetReach());
    return visitor.Found;
  }
  /** Whether there is a point nearer to the position than a distance, or at the position. */
  bool HasPointNear(const Vec3& position, double distance, Id except = NoId) const
  {
    NearestPointVisitor visitor(position, except, std::max(distance, SamePoint));
    this->Octree.Visit(visitor, visitor.GetReach());
    return visitor.Nearest != NoId;
  }

  const DelaunaySurfaceRefinerOptions Options;
  const SurfaceRefinementPlan Plan;
  std::vector<Vec3> Points;
  const Id NumberOfSurfacePoints;
  const double Diagonal;
  const double Flatness;
  /** The shortest edge that the rounding of coordinates allows. */
  const double RoundedEdge;
  /** No shorter edge is made. */
  double MinimumEdge;
  Id MaximumNewPoints = 0;
  bool HasLeftTooCoarse = false;
  /**
   * The limit if the user gives none; the limit in all once the first one is reached, and how many
   * points there were then.
   */
  Id UsualMaximum = 0;
  Id MaximumRescuePoints = 0;
  Id PointsBeforeRescue = 0;
  PointOctree Octree;
  SurfaceDelaunayTest Test;
  SurfaceDelaunayTest::Result Found;
  std::unique_ptr<RefinableSurface> Surface;
  std::unique_ptr<SurfaceFlips> Flips;
  TriangleLimits Limits;
  std::vector<PointParents> NewPoints;
  Id NumberOfEdgePoints = 0;
  Id NumberOfFailures = 0;
  /**
   * Number of tests of needles. A refinement that has come down to rounding errors makes many of
   * them.
   */
  Id NumberOfNeedles = 0;
  Id MaximumNeedles = 0;
  bool HasGivenUp = false;

  /** The next three are made when the first triangle has to be refined. */
  std::unique_ptr<SurfaceIncidences> Incidences;
  std::unique_ptr<PartnerPoints> Partners;
  std::unique_ptr<FacetWalk> Walk;
  /** Shortest edge of each triangle of the input; empty if all facets are plane. */
  std::vector<double> ShortestEdges;
  std::vector<char> IsOverrefined;
  TriangleProofs Proofs;
  /** Triangles to be tested, as a heap. */
  std::vector<QueueEntry> Queue;
  std::int64_t NumberOfEnqueued = 0;
  /** Current state of each triangle; queue entries with another state are stale. */
  std::vector<QueueState> States;
  /** Whether a triangle has passed the test since it or something around it has changed. */
  std::vector<char> IsProven;
  bool AreAllTested = false;
  std::vector<char> IsBad;
  /** Marks weak triangles once they have been judged; empty if all have to fulfil the criterion. */
  std::vector<char> WeakTriangles;
  std::vector<char> IsTouched;
  std::vector<Id> Touched;
  std::vector<Id> Reached;
  /**
   * Segments to be tested, as a heap of (length, segment); and the empty diametral spheres of those
   * that were tested.
   */
  std::vector<std::pair<double, Id>> EdgeQueue;
  BallIndex EmptyEdges;
  /** Diametral spheres of all segments; only with the rules for stacks. */
  BallIndex SegmentBalls;
  /** Marks segments that are encroached on and cannot be split. */
  std::vector<char> IsEncroached;
  /** One for each triangle of the input, or none. */
  std::vector<char> ExcusedTriangles;
};
} // namespace cdm

#endif
