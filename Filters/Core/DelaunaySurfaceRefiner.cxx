// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunaySurfaceRefiner.h"

#include "BallIndex.h"
#include "DuplicateTriangles.h"
#include "IdLimits.h"
#include "IdLists.h"
#include "MatchingPoints.h"
#include "Measures.h"
#include "ParallelLoop.h"
#include "ParallelSort.h"
#include "PointSearches.h"
#include "Predicates.h"
#include "RefinableSurface.h"
#include "SpatialSort.h"
#include "SurfaceDelaunayTest.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Pi = 3.14159265358979323846;
constexpr std::size_t ReportInterval = 256;

/** In curved facets, points closer than that to others, in shortest edges of the input there. */
constexpr double CrumplingRatio = 1.0 / 8.0;

/** After so many attempts all edges of curved facets are structural. */
constexpr int LargestNumberOfAttempts = 20;

/** Flips on curved facets may go in circles: so many are allowed for each triangle and new point. */
constexpr std::int64_t FlipsPerTriangle = 50;

/** New points keep this distance, as a ratio of the edge, from the ends of an edge they split. */
constexpr double SmallestPiece = 0.05;
/** A disturbing point this close to the plane of a triangle, in units of its circumradius, is
 * mirrored into the plane: thin layers get matching points instead of small triangles. */
constexpr double ThinLayerRatio = 0.75;
/** A disturbing point this close to an edge, in units of its length, is matched exactly. */
constexpr double ThinGapRatio = 0.1;
/** Disturbing points closer than this need no match near an end of the edge, in that unit, ... */
constexpr double NeedleGapRatio = 1e-3;
/** ... where the match lies within this part of the point's distance from the end. */
constexpr double CloseEndRatio = 0.25;
/** Another point on an edge, closer to the match than this part of the disturbing point's distance,
 * is matched instead. */
constexpr double CloseMatchRatio = 0.5;
/**
 * Lines and planes whose cosine is not above this are perpendicular: no point has a partner there.
 * Of turned devices rounding would make partners of them here and there, and a quarter more points.
 */
constexpr double PerpendicularCosine = 1e-9;
/** Among the edges around so many triangles one is looked for that a new point would disturb. */
constexpr std::size_t LargestCavity = 1000;

/** Two facets in one number, in any order. */
std::uint64_t GetFacetPair(Id a, Id b)
{
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
    static_cast<std::uint64_t>(std::max(a, b));
}

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
  void DropCloseMeshPoints();
  void CollectIncidences();
  void CollectAxes();
  void CollectFacetGeometry();
  IdLists::Range GetFacets(Id point) const;
  IdLists::Range GetEdges(Id point) const;
  bool IsAcuteCorner(Id point);
  void Saturate();
  Status SplitRequested();
  Status Refine();
  void Process(Id t);
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
  bool ResolveInFacet(Id t, Id disturbing, Vec3 target, bool isMirrored);
  Id FindEncroachedSegment(Id t, const Vec3& position);
  Vec3 MatchAcross(Id t, Id disturbing, const Vec3& position, double radius) const;
  bool MirrorDisturbingPoint(Id t, Id disturbing, Vec3& target) const;
  bool RotateAboutAxis(Id t, Id disturbing, Vec3& target) const;
  bool RotateAboutCorner(Id t, Id disturbing, Vec3& target) const;
  bool ProjectOntoFacet(Id t, Id disturbing, Vec3& target) const;
  bool SplitSegment(Id segment, Id disturbing);
  bool SplitLongestEdge(Id t);
  Vec3 PlaceOnSegment(Id segment, Id disturbing);
  bool PlacePartner(Id segment, Id disturbing, double& way, Vec3& along) const;

  bool CanFlip(Id use) const;
  bool ShouldFlip(Id use) const;
  void Legalize(std::vector<Id>& uses);
  Id AddPoint(const Vec3& position, const PointParents& parents, Id facet, Id inputEdge);
  void Enqueue(Id t);
  void EnqueueEdge(Id segment);
  double GetNearestDistance(const Vec3& position, Id except = NoId) const
  {
    NearestPointVisitor visitor(position, except);
    this->Octree.Visit(visitor);
    return std::sqrt(visitor.SquaredDistance);
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

  /** What follows is collected when the first triangle has to be refined. */
  bool HasIncidences = false;
  /** Facets at each point of the input, ascending. */
  IdLists PointFacets;
  /** Input edges at each point of the input. */
  IdLists PointEdges;
  /** Facets at each input edge, ascending. */
  IdLists EdgeFacets;
  /** For each new point the facet that it lies in, or the input edge that it lies on. */
  std::vector<Id> NewPointFacets;
  std::vector<Id> NewPointEdges;
  /** Input edges that two facets share: the facets in one number, the smaller first, and the edge. */
  std::vector<std::pair<std::uint64_t, Id>> Axes;
  /** Unit normal of each plane facet; zero for a curved one, which has no one plane. */
  std::vector<Vec3> FacetNormals;
  /**
   * Empty, or marks triangles of the input in curved facets: points there come too close, or flips
   * have made two sheets the same.
   */
  std::vector<char> IsCrumpled;
  /** Points of each facet at which structural edges end, ascending. */
  IdLists FacetCorners;
  /** Input points at which two structural edges meet at less than 90 degrees; -1: not known yet. */
  std::vector<signed char> AcuteCorners;

  BallIndex Proofs;
  /** Triangles to be looked at, a heap by their order. */
  std::vector<std::pair<double, Id>> Queue;
  std::int64_t NumberOfEnqueued = 0;
  std::vector<char> IsQueued;
  /** Whether a triangle has passed the test since it or something around it has changed. */
  std::vector<char> IsProven;
  bool AreAllTested = false;
  std::vector<char> IsUnresolved;
  std::vector<Id> Reached;
  /** Marks of FindEncroachedSegment(), all zero outside of it. */
  std::vector<char> IsInCavity;
  /** Length and number of segments to be looked at, a heap; diametral spheres of those that were. */
  std::vector<std::pair<double, Id>> EdgeQueue;
  BallIndex EmptyEdges;
  /** Segments that are disturbed and cannot be split. */
  std::vector<char> IsDisturbed;
  std::int64_t FlipBudget = 0;
};

Status SurfaceRefiner::Prepare()
{
  const TriangleMesh& surface = *this->Input.Surface;
  if (surface.Triangles.empty())
  {
    return Status::InvalidInput("The surface has no triangles; there is nothing to refine.");
  }
  const Status range = CheckNumberOfPoints(
    surface.Points.size(), this->Input.MeshPoints != nullptr ? this->Input.MeshPoints->size() : 0);
  if (!range.IsOk())
  {
    return range;
  }
  this->Points = surface.Points;
  this->NumberOfSurfacePoints = static_cast<Id>(surface.Points.size());
  for (Id i = 0; i < this->NumberOfSurfacePoints; ++i)
  {
    if (!IsFinite(this->Points[i]))
    {
      return Status::InvalidInput(
        "A point has a coordinate that is not a finite number; remove or repair it.", {}, { i });
    }
  }
  std::vector<Id> order(this->Points.size());
  std::iota(order.begin(), order.end(), 0);
  SortAlongHilbertCurve(this->Points, order);
  std::vector<Id> coincident;
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (this->Points[order[i]] == this->Points[order[i - 1]])
    {
      coincident.push_back(order[i - 1]);
      coincident.push_back(order[i]);
    }
  }
  if (!coincident.empty())
  {
    std::sort(coincident.begin(), coincident.end());
    coincident.erase(std::unique(coincident.begin(), coincident.end()), coincident.end());
    return Status::InvalidInput("Points of the surface coincide; merge them with "
                                "vtkBoundaryTriangulator first.",
      {}, std::move(coincident));
  }
  std::vector<Id> degenerate;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    const Vec3& a = this->Points[ids[0]];
    const Vec3& b = this->Points[ids[1]];
    const Vec3& c = this->Points[ids[2]];
    // Far above the error of the cross product, and of products below the range of doubles.
    const double certain = 1e-24 * SquaredNorm(b - a) * SquaredNorm(c - a);
    if (!(certain > 1e-280 && SquaredNorm(Cross(b - a, c - a)) > certain) && AreCollinear(a, b, c))
    {
      degenerate.push_back(static_cast<Id>(t));
    }
  }
  if (!degenerate.empty())
  {
    return Status::InvalidInput(
      "Triangles without area; clean the surface with vtkBoundaryTriangulator first.",
      std::move(degenerate));
  }

  this->Diagonal = GetBoundingBoxDiagonal(this->Points);
  this->Flatness = this->Options.StructuralEdges.FlatnessRatio * this->Diagonal;
  this->MinimumEdge = this->Options.MinimumEdgeRatio * this->Diagonal;
  StructuralEdgesOutput edges;
  const Status status = ExtractStructuralEdges(
    surface, this->Options.StructuralEdges, this->Context.Part(0.0, 0.05), edges);
  if (!status.IsOk())
  {
    return status;
  }
  this->DropCloseMeshPoints();
  this->NumberOfGivenPoints = static_cast<Id>(this->Points.size());
  // Without a limit of the user's, one that only a runaway refinement reaches: sheets a hair apart.
  const bool isSizeWanted = this->Input.Sizing || this->Options.MaximumEdgeLength > 0.0 ||
    this->Options.MaximumArea > 0.0 || this->Options.MinimumAngle > 0.0;
  this->MaximumNewPoints = this->Options.MaximumNewPoints > 0
    ? this->Options.MaximumNewPoints
    : static_cast<Id>(std::min<std::size_t>(
        std::max<std::size_t>(isSizeWanted ? 1000000 : 20000, 50 * surface.Triangles.size()) +
          this->Output.KeptMeshPoints.size(),
        LargestId / 8));
  this->Octree.Insert(this->Points);
  this->Surface = std::make_unique<RefinableSurface>(surface, edges.Edges, this->Points);
  return Status();
}

void SurfaceRefiner::DropCloseMeshPoints()
{
  if (this->Input.MeshPoints == nullptr || this->Input.MeshPoints->empty())
  {
    return;
  }
  const std::vector<Vec3>& meshPoints = *this->Input.MeshPoints;
  const double clearance = this->Options.MeshPointClearanceRatio * this->Diagonal;
  // Copies of points and points that are no numbers are of no use either.
  std::vector<char> isDropped(meshPoints.size(), 1);
  std::vector<Id> order;
  for (std::size_t i = 0; i < meshPoints.size(); ++i)
  {
    if (IsFinite(meshPoints[i]))
    {
      order.push_back(static_cast<Id>(i));
    }
  }
  ParallelSort(order, this->Options.NumberOfThreads, {}, "",
    [&meshPoints](Id i, Id j)
    { return meshPoints[i] != meshPoints[j] ? meshPoints[i] < meshPoints[j] : i < j; });
  order.erase(std::unique(order.begin(), order.end(),
                [&meshPoints](Id i, Id j) { return meshPoints[i] == meshPoints[j]; }),
    order.end());
  std::vector<Vec3> positions;
  positions.reserve(order.size());
  for (const Id i : order)
  {
    positions.push_back(meshPoints[i]);
  }
  PointOctree octree;
  octree.Insert(positions);
  std::vector<char> isClose(order.size(), 0);
  for (const TriangleIds& ids : this->Input.Surface->Triangles)
  {
    NearTriangleVisitor visitor(
      this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], clearance, isClose);
    octree.Visit(visitor);
  }
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    isDropped[order[i]] = isClose[i];
  }
  for (std::size_t i = 0; i < meshPoints.size(); ++i)
  {
    if (isDropped[i])
    {
      ++this->Output.Report.DroppedMeshPoints;
    }
    else
    {
      this->Output.KeptMeshPoints.push_back(static_cast<Id>(i));
      this->Points.push_back(meshPoints[i]);
    }
  }
}

void SurfaceRefiner::CollectIncidences()
{
  if (this->HasIncidences)
  {
    return;
  }
  this->HasIncidences = true;
  std::vector<std::pair<Id, Id>> pairs;
  pairs.reserve(3 * this->Surface->GetNumberOfTriangles());
  for (Id t = 0; t < this->Surface->GetNumberOfTriangles(); ++t)
  {
    const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
    for (Id point : triangle.Points)
    {
      pairs.emplace_back(point, triangle.Facet);
    }
  }
  std::stable_sort(
    pairs.begin(), pairs.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
  this->PointFacets.Build(this->NumberOfSurfacePoints, pairs);

  pairs.clear();
  std::vector<std::pair<Id, Id>> edgeFacets;
  for (Id s = 0; s < this->Surface->GetNumberOfSegments(); ++s)
  {
    const EdgeIds& edge = this->Surface->GetSegment(s).Points;
    pairs.emplace_back(edge[0], s);
    pairs.emplace_back(edge[1], s);
    for (Id facet : this->Surface->GetFacets(s))
    {
      edgeFacets.emplace_back(s, facet);
    }
  }
  this->PointEdges.Build(this->NumberOfSurfacePoints, pairs);
  this->EdgeFacets.Build(this->Surface->GetNumberOfSegments(), edgeFacets);
  this->AcuteCorners.assign(this->NumberOfSurfacePoints, -1);
  this->CollectAxes();
  this->CollectFacetGeometry();
}

/** Facets that a point lies on, ascending; none for a mesh point. */
IdLists::Range SurfaceRefiner::GetFacets(Id point) const
{
  if (point < this->NumberOfSurfacePoints)
  {
    return this->PointFacets[point];
  }
  if (point < this->NumberOfGivenPoints)
  {
    return {};
  }
  const Id* const facet = &this->NewPointFacets[point - this->NumberOfGivenPoints];
  return *facet != NoId ? IdLists::Range{ facet, facet + 1 }
                        : this->EdgeFacets[this->NewPointEdges[point - this->NumberOfGivenPoints]];
}

/** Input edges that a point lies on. */
IdLists::Range SurfaceRefiner::GetEdges(Id point) const
{
  if (point < this->NumberOfSurfacePoints)
  {
    return this->PointEdges[point];
  }
  if (point < this->NumberOfGivenPoints)
  {
    return {};
  }
  const Id* const edge = &this->NewPointEdges[point - this->NumberOfGivenPoints];
  return { edge, edge + (*edge != NoId ? 1 : 0) };
}

void SurfaceRefiner::CollectAxes()
{
  for (Id edge = 0; edge < static_cast<Id>(this->Surface->GetInputEdges().size()); ++edge)
  {
    const IdLists::Range facets = this->EdgeFacets[edge];
    for (const Id* i = facets.begin(); i != facets.end(); ++i)
    {
      for (const Id* j = i + 1; j != facets.end(); ++j)
      {
        this->Axes.emplace_back(GetFacetPair(*i, *j), edge);
      }
    }
  }
  std::sort(this->Axes.begin(), this->Axes.end());
}

bool SurfaceRefiner::IsAcuteCorner(Id point)
{
  if (point >= this->NumberOfSurfacePoints)
  {
    return false;
  }
  signed char& isAcute = this->AcuteCorners[point];
  if (isAcute < 0)
  {
    isAcute = 0;
    const IdLists::Range incident = this->PointEdges[point];
    const auto getArm = [this, point](Id edge)
    {
      const EdgeIds& ends = this->Surface->GetInputEdges()[edge];
      return this->Points[ends[0] == point ? ends[1] : ends[0]] - this->Points[point];
    };
    for (const Id* i = incident.begin(); i != incident.end() && isAcute == 0; ++i)
    {
      const Vec3 u = getArm(*i);
      for (const Id* j = i + 1; j != incident.end() && isAcute == 0; ++j)
      {
        const Vec3 v = getArm(*j);
        isAcute = Dot(u, v) > 1e-9 * Norm(u) * Norm(v) ? 1 : 0;
      }
    }
  }
  return isAcute != 0;
}

void SurfaceRefiner::CollectFacetGeometry()
{
  // The normal of the largest triangle of each facet is the most accurate one.
  const Id count = this->Surface->GetNumberOfTriangles();
  const auto getNormal = [this](Id t)
  {
    const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
    const Vec3& a = this->Points[ids[0]];
    return Cross(this->Points[ids[1]] - a, this->Points[ids[2]] - a);
  };
  std::vector<std::pair<double, Id>> largest;
  for (Id t = 0; t < count; ++t)
  {
    const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
    const double size = Norm(getNormal(t));
    largest.resize(
      std::max(largest.size(), static_cast<std::size_t>(triangle.Facet) + 1), { 0.0, NoId });
    largest[triangle.Facet] = std::max(largest[triangle.Facet], std::make_pair(size, t));
  }
  this->FacetNormals.resize(largest.size());
  for (std::size_t facet = 0; facet < largest.size(); ++facet)
  {
    if (largest[facet].second != NoId)
    {
      this->FacetNormals[facet] = (1.0 / largest[facet].first) * getNormal(largest[facet].second);
    }
  }
  for (Id t = 0; t<count&& this->Options.StructuralEdges.AccuracyAngle> 0.0; ++t)
  {
    const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
    const Id model = largest[triangle.Facet].second;
    for (Id p : triangle.Points)
    {
      const Vec3 arm = this->Points[p] - this->Points[this->Surface->GetTriangle(model).Points[0]];
      if (std::abs(Dot(arm, this->FacetNormals[triangle.Facet])) > this->Flatness)
      {
        this->FacetNormals[triangle.Facet] = Vec3();
        break;
      }
    }
  }

  std::vector<std::pair<Id, Id>> corners;
  for (Id p = 0; p < this->NumberOfSurfacePoints; ++p)
  {
    if (!this->PointEdges[p].empty())
    {
      for (Id facet : this->PointFacets[p])
      {
        corners.emplace_back(facet, p);
      }
    }
  }
  this->FacetCorners.Build(static_cast<Id>(this->FacetNormals.size()), corners);
}

void SurfaceRefiner::Enqueue(Id t)
{
  if (static_cast<std::size_t>(t) >= this->IsQueued.size())
  {
    this->IsQueued.resize(t + 1, 0);
    this->IsProven.resize(t + 1, 0);
    this->IsUnresolved.resize(t + 1, 0);
  }
  this->IsProven[t] = 0;
  this->IsUnresolved[t] = 0;
  if (!this->IsQueued[t])
  {
    this->IsQueued[t] = 1;
    // Once the edges are fine enough, small triangles first: what large ones need depends on them.
    // Without, in order: of almost flat surfaces that would be refined down to the smallest.
    const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
    const double order = this->AreEdgesTested() ? Norm(GetCircumcenterOffset(this->Points[ids[0]],
                                                    this->Points[ids[1]], this->Points[ids[2]]))
                                                : static_cast<double>(this->NumberOfEnqueued++);
    this->Queue.emplace_back(order, t);
    std::push_heap(this->Queue.begin(), this->Queue.end(), std::greater<>());
  }
}

bool SurfaceRefiner::CanFlip(Id use) const
{
  const RefinableSurface& surface = *this->Surface;
  const Id other = surface.GetTriangle(use / 3).Adjacent[use % 3];
  if (other < 0 || !surface.IsConvex(use))
  {
    return false;
  }
  const TriangleIds& ids = surface.GetTriangle(use / 3).Points;
  const Vec3& a = this->Points[ids[use % 3]];
  const Vec3& b = this->Points[ids[(use % 3 + 1) % 3]];
  const Vec3& c = this->Points[surface.GetApex(use)];
  const Vec3& d = this->Points[surface.GetApex(other)];
  // The surface moves by at most the distance of the two diagonals.
  const Vec3 across = Cross(b - a, d - c);
  const double norm = Norm(across);
  if (norm > 0.0 && std::abs(Dot(across, c - a)) <= this->Flatness * norm)
  {
    return true;
  }
  const double angle = this->Options.StructuralEdges.AccuracyAngle;
  return angle > 0.0 && IsSmoothEdge(a, b, c, d, angle, 0.0) &&
    IsSmoothEdge(d, c, a, b, angle, 0.0);
}

bool SurfaceRefiner::ShouldFlip(Id use) const
{
  // Flip what is locally bad into what is locally good: it cannot flip back at once.
  const RefinableSurface& surface = *this->Surface;
  const Id other = surface.GetTriangle(use / 3).Adjacent[use % 3];
  if (other < 0)
  {
    return false;
  }
  const TriangleIds& ids = surface.GetTriangle(use / 3).Points;
  const Vec3& a = this->Points[ids[use % 3]];
  const Vec3& b = this->Points[ids[(use % 3 + 1) % 3]];
  const Vec3& c = this->Points[surface.GetApex(use)];
  const Vec3& d = this->Points[surface.GetApex(other)];
  const bool isBad = InEquatorialSphere(a, b, c, d) > 0 || InEquatorialSphere(b, a, d, c) > 0;
  return isBad && this->CanFlip(use) && InEquatorialSphere(a, d, c, b) <= 0 &&
    InEquatorialSphere(d, b, c, a) <= 0;
}

void SurfaceRefiner::Legalize(std::vector<Id>& uses)
{
  for (Id use : uses)
  {
    this->Enqueue(use / 3);
  }
  while (!uses.empty())
  {
    const Id use = uses.back();
    uses.pop_back();
    if (this->FlipBudget <= 0 || !this->ShouldFlip(use))
    {
      continue;
    }
    const Id t = use / 3;
    const Id u = this->Surface->GetTriangle(t).Adjacent[use % 3] / 3;
    this->Surface->Flip(use);
    ++this->Output.Report.Flips;
    --this->FlipBudget;
    this->Enqueue(t);
    this->Enqueue(u);
    // The four outer edges of the quadrilateral.
    uses.push_back(3 * t);
    uses.push_back(3 * t + 2);
    uses.push_back(3 * u);
    uses.push_back(3 * u + 1);
  }
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
  const auto makeKey = [](const EdgeIds& edge) {
    return EdgeIds{ std::min(edge[0], edge[1]), std::max(edge[0], edge[1]) };
  };
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
 * Tests all triangles on all threads before the first of them is refined: most are good and stay so.
 * False if aborted.
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
    if (this->FlipBudget > 0 && this->ShouldFlip(use))
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
    if (other < 0 || this->FlipBudget <= 0 || !this->CanFlip(use))
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
      this->Surface->Flip(use);
      ++this->Output.Report.Flips;
      --this->FlipBudget;
      this->Enqueue(t);
      this->Enqueue(other / 3);
      return true;
    }
  }
  return false;
}

/**
 * The partner of a point on another edge: the point of this edge's line that is as far from the
 * common perpendicular of the two lines. If the edges meet, that is type R about their corner; if
 * they are parallel it is type P. Being partners is mutual, so that two edges never climb up a
 * ladder between them, and a point is outside of the diametral spheres of all pieces that end at
 * its partner.
 */
bool SurfaceRefiner::PlacePartner(Id segment, Id disturbing, double& way, Vec3& along) const
{
  const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
  const Vec3& a = this->Points[ends[0]];
  const Vec3& p = this->Points[disturbing];
  const Vec3 edge = this->Points[ends[1]] - a;
  const Vec3 direction = (1.0 / Norm(edge)) * edge;
  const std::vector<EdgeIds>& edges = this->Surface->GetInputEdges();
  const Id own = this->Surface->GetSegment(segment).InputEdge;
  // Of several edges at the point the one along this edge matters.
  double best = PerpendicularCosine;
  for (Id other : this->GetEdges(disturbing))
  {
    if (other == own)
    {
      continue;
    }
    const Vec3& begin = this->Points[edges[other][0]];
    Vec3 line = this->Points[edges[other][1]] - begin;
    line = (1.0 / Norm(line)) * line;
    double cosine = Dot(line, direction);
    if (cosine < 0.0)
    {
      line = -1.0 * line;
      cosine = -cosine;
    }
    if (cosine <= best)
    {
      continue;
    }
    best = cosine;
    const Vec3 across = Cross(direction, line);
    const double squaredSine = SquaredNorm(across);
    const double foot = Dot(p - a, direction);
    // Distance of p from the common perpendicular along its line, times 1 - cosine: a shift of the
    // foot that stays small and accurate where the lines are almost parallel.
    const double distance =
      squaredSine > 0.0 ? Dot(Cross(p - a, direction), across) / squaredSine : 0.0;
    const double shift = squaredSine > 1e-24 ? -distance * squaredSine / (1.0 + cosine) : 0.0;
    way = foot + shift;
    along = 0.5 * (direction + line);
  }
  return best > PerpendicularCosine;
}

Vec3 SurfaceRefiner::PlaceOnSegment(Id segment, Id disturbing)
{
  const EdgeIds& ends = this->Surface->GetSegment(segment).Points;
  const Vec3& a = this->Points[ends[0]];
  const Vec3& b = this->Points[ends[1]];
  const double length = Distance(a, b);
  const Vec3 direction = (1.0 / length) * (b - a);
  for (int attempt = 0; disturbing != NoId; ++attempt)
  {
    const Vec3& p = this->Points[disturbing];
    const double foot = Dot(p - a, direction);
    const double height = Distance(p, a + foot * direction);
    const bool isThin = height < ThinGapRatio * length;
    double way = foot;
    Vec3 along = direction;
    const bool isPartner = this->PlacePartner(segment, disturbing, way, along);
    // Close to an end of the piece, that end is the partner as good as there is: p stays outside of
    // pieces that are shorter than its squared height over its distance along.
    const double rest = std::abs(std::min(way, length - way));
    const bool isClose = height < NeedleGapRatio * length && rest < CloseEndRatio * height;
    if (isClose)
    {
      const double shorter = std::max(
        height, rest > 0.0 ? std::min(0.5 * length, 0.5 * height * (height / rest)) : 0.5 * length);
      way = way < 0.5 * length ? shorter : length - shorter;
    }
    const double margin = isThin ? 0.0
      : isPartner                ? SmallestPiece * length
                                 : std::min(height, 0.5 * length);
    if (way > margin && way < length - margin)
    {
      const Vec3 position = a + way * direction;
      if (isClose)
      {
        return position;
      }
      // A point that is much nearer is the one to match exactly.
      NearestPointVisitor visitor(position, NoId);
      this->Octree.Visit(visitor);
      if (attempt == 0 && visitor.Nearest != disturbing && visitor.Nearest != ends[0] &&
        visitor.Nearest != ends[1] && !this->GetEdges(visitor.Nearest).empty() &&
        std::sqrt(visitor.SquaredDistance) < CloseMatchRatio * height)
      {
        disturbing = visitor.Nearest;
        continue;
      }
      return MatchExactly(SnapToCoordinates(position, p, this->Diagonal), p, length, 10,
        [&along](long double x, long double y, long double z)
        { return std::abs(x * along.X + y * along.Y + z * along.Z); });
    }
    if (!isPartner && foot > 0.0 && foot < length)
    {
      // Type P, not nearer to the ends than the disturbing point is to the edge.
      return a + std::min(std::max(foot, margin), length - margin) * direction;
    }
    break;
  }
  // From an acute corner only powers of two are used, so that all edges there end up alike.
  const bool isAcuteA = this->IsAcuteCorner(ends[0]);
  const bool isAcuteB = this->IsAcuteCorner(ends[1]);
  if (isAcuteA != isAcuteB)
  {
    const double way = std::ldexp(1.0, std::ilogb(length * (2.0 / 3.0)));
    return isAcuteA ? a + way * direction : b - way * direction;
  }
  return 0.5 * (a + b);
}

Id SurfaceRefiner::AddPoint(
  const Vec3& position, const PointParents& parents, Id facet, Id inputEdge)
{
  const Id point = static_cast<Id>(this->Points.size());
  this->Points.push_back(position);
  this->FlipBudget += FlipsPerTriangle;
  this->Octree.Insert(point, position);
  this->NewPointFacets.push_back(facet);
  this->NewPointEdges.push_back(inputEdge);
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
  Vec3 position = this->PlaceOnSegment(segment, disturbing);
  for (int attempt = 0; attempt < 2; ++attempt)
  {
    if (std::min(Distance(position, a), Distance(position, b)) >= this->MinimumEdge &&
      this->GetNearestDistance(position) > 0.0 && this->Surface->CanSplitSegment(segment, position))
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

bool SurfaceRefiner::RotateAboutAxis(Id t, Id disturbing, Vec3& target) const
{
  const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
  const Vec3& p = this->Points[disturbing];
  const Vec3 center = GetCircumcenter(this->Points[triangle.Points[0]],
    this->Points[triangle.Points[1]], this->Points[triangle.Points[2]]);
  double nearest = Infinity;
  for (Id facet : this->GetFacets(disturbing))
  {
    const std::uint64_t pair = GetFacetPair(facet, triangle.Facet);
    for (auto place = std::lower_bound(
           this->Axes.begin(), this->Axes.end(), std::pair<std::uint64_t, Id>(pair, 0));
         place != this->Axes.end() && place->first == pair; ++place)
    {
      const EdgeIds& axis = this->Surface->GetInputEdges()[place->second];
      const Vec3& begin = this->Points[axis[0]];
      const Vec3 direction =
        (1.0 / Distance(begin, this->Points[axis[1]])) * (this->Points[axis[1]] - begin);
      const Vec3 foot = begin + Dot(p - begin, direction) * direction;
      const Vec3 inward = center - (begin + Dot(center - begin, direction) * direction);
      const double distance = Distance(p, foot);
      if (distance < nearest && distance > 0.0 &&
        Dot(inward, p - foot) > PerpendicularCosine * distance * Norm(inward))
      {
        nearest = distance;
        target = foot + (distance / Norm(inward)) * inward;
      }
    }
  }
  return nearest < Infinity;
}

bool SurfaceRefiner::RotateAboutCorner(Id t, Id disturbing, Vec3& target) const
{
  const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
  const IdLists::Range corners = this->FacetCorners[triangle.Facet];
  const Vec3& p = this->Points[disturbing];
  double nearest = Infinity;
  Id corner = NoId;
  for (Id facet : this->GetFacets(disturbing))
  {
    const IdLists::Range others = this->FacetCorners[facet];
    const bool isSmaller = others.size() < corners.size();
    for (Id candidate : isSmaller ? others : corners)
    {
      const double distance = Distance(p, this->Points[candidate]);
      if (candidate != disturbing && distance < nearest &&
        std::binary_search(
          (isSmaller ? corners : others).begin(), (isSmaller ? corners : others).end(), candidate))
      {
        nearest = distance;
        corner = candidate;
      }
    }
  }
  if (corner == NoId)
  {
    return false;
  }
  const Vec3& a = this->Points[triangle.Points[0]];
  const Vec3& b = this->Points[triangle.Points[1]];
  const Vec3& c = this->Points[triangle.Points[2]];
  const Vec3 normal = Cross(b - a, c - a);
  const Vec3 arm = p - this->Points[corner];
  const Vec3 inPlane = arm - (Dot(arm, normal) / SquaredNorm(normal)) * normal;
  target = this->Points[corner] + (nearest / Norm(inPlane)) * inPlane;
  // Steep or far beyond the triangle, the turned point would do nothing for it.
  return SquaredNorm(inPlane) > 0.25 * SquaredNorm(arm) && InEquatorialSphere(a, b, c, target) > 0;
}

/**
 * Type P for facets: along the normal. If the point's own facet is not parallel, the foot is moved
 * until both are equally far from the line where the two planes meet, somewhere outside: that is
 * type R again, and mutual.
 */
bool SurfaceRefiner::ProjectOntoFacet(Id t, Id disturbing, Vec3& target) const
{
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Vec3& a = this->Points[ids[0]];
  const Vec3 normal = Cross(this->Points[ids[1]] - a, this->Points[ids[2]] - a);
  const double radius = Distance(a, GetCircumcenter(a, this->Points[ids[1]], this->Points[ids[2]]));
  const Vec3& p = this->Points[disturbing];
  Vec3 unit = (1.0 / Norm(normal)) * normal;
  unit = Dot(unit, p - a) < 0.0 ? -1.0 * unit : unit;
  const double height = Dot(unit, p - a);
  if (height > ThinLayerRatio * radius)
  {
    return false;
  }
  target = p - height * unit;
  double best = 0.0;
  Vec3 other;
  for (Id facet : this->GetFacets(disturbing))
  {
    const Vec3& candidate = this->FacetNormals[facet];
    const double cosine = Dot(candidate, unit);
    if (std::abs(cosine) > best)
    {
      best = std::abs(cosine);
      other = cosine < 0.0 ? -1.0 * candidate : candidate;
    }
  }
  if (best > 0.5)
  {
    // tan(angle / 2) = sin / (1 + cos); the sine is the length of the tilt.
    const Vec3 tilt = other - best * unit;
    target = target - (height / (1.0 + best)) * tilt;
  }
  return true;
}

bool SurfaceRefiner::MirrorDisturbingPoint(Id t, Id disturbing, Vec3& target) const
{
  // A point of the same facet, which is curved then, would be matched by ones ever closer to it.
  const IdLists::Range facets = this->GetFacets(disturbing);
  if (std::find(facets.begin(), facets.end(), this->Surface->GetTriangle(t).Facet) != facets.end())
  {
    return false;
  }
  // However close to other points: only points that match exactly leave each other alone.
  return this->RotateAboutAxis(t, disturbing, target) ||
    this->RotateAboutCorner(t, disturbing, target) || this->ProjectOntoFacet(t, disturbing, target);
}

/** Moves a point in a plane facet by rounding errors, to match one of another facet exactly. */
Vec3 SurfaceRefiner::MatchAcross(Id t, Id disturbing, const Vec3& position, double radius) const
{
  const Vec3& p = this->Points[disturbing];
  const Vec3& own = this->FacetNormals[this->Surface->GetTriangle(t).Facet];
  Vec3 across;
  double best = 0.5;
  for (Id facet : this->GetFacets(disturbing))
  {
    const double cosine = Dot(this->FacetNormals[facet], own);
    if (std::abs(cosine) > best)
    {
      best = std::abs(cosine);
      across = own + (cosine < 0.0 ? -1.0 : 1.0) * this->FacetNormals[facet];
    }
  }
  if (best <= 0.5 || Distance(position, p) > NeedleGapRatio * radius)
  {
    return position;
  }
  const long double square = SquaredNorm(across);
  return MatchExactly(position, p, radius, 10,
    [&across, square](long double x, long double y, long double z)
    {
      const long double along = (x * across.X + y * across.Y + z * across.Z) / square;
      x -= along * across.X;
      y -= along * across.Y;
      z -= along * across.Z;
      return std::sqrt(x * x + y * y + z * z);
    });
}

/**
 * A segment whose diametral sphere holds a position, among those around the triangles whose smallest
 * spheres hold it, too: these are the triangles that a point there would replace.
 */
Id SurfaceRefiner::FindEncroachedSegment(Id t, const Vec3& position)
{
  const RefinableSurface& surface = *this->Surface;
  this->IsInCavity.resize(surface.GetNumberOfTriangles(), 0);
  std::vector<Id> cavity(1, t);
  this->IsInCavity[t] = 1;
  Id found = NoId;
  for (std::size_t i = 0; i < cavity.size() && found == NoId && cavity.size() < LargestCavity; ++i)
  {
    for (Id adjacent : surface.GetTriangle(cavity[i]).Adjacent)
    {
      if (adjacent < 0)
      {
        const EdgeIds& ends = surface.GetSegment(-1 - adjacent).Points;
        if (InDiametralSphere(this->Points[ends[0]], this->Points[ends[1]], position) >= 0)
        {
          found = -1 - adjacent;
          break;
        }
        continue;
      }
      const TriangleIds& ids = surface.GetTriangle(adjacent / 3).Points;
      if (!this->IsInCavity[adjacent / 3] &&
        InEquatorialSphere(
          this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], position) >= 0)
      {
        this->IsInCavity[adjacent / 3] = 1;
        cavity.push_back(adjacent / 3);
      }
    }
  }
  for (Id triangle : cavity)
  {
    this->IsInCavity[triangle] = 0;
  }
  return found;
}

bool SurfaceRefiner::ResolveInFacet(Id t, Id disturbing, Vec3 target, bool isMirrored)
{
  const RefinableSurface& surface = *this->Surface;
  const TriangleIds& start = surface.GetTriangle(t).Points;
  const Vec3& a = this->Points[start[0]];
  const Vec3 normal = Cross(this->Points[start[1]] - a, this->Points[start[2]] - a);
  const double radius =
    Norm(GetCircumcenterOffset(a, this->Points[start[1]], this->Points[start[2]]));

  // Walk (thesis 6.3, "Locate Triangle"): over the edge that faces the target most.
  Id current = t;
  Id previous = NoId;
  std::pair<Id, bool> place(NoId, true);
  Vec3 position = target;
  for (int step = 0;; ++step)
  {
    if (step > 10000)
    {
      return false;
    }
    const TriangleIds& ids = surface.GetTriangle(current).Points;
    Id worst = NoId;
    double worstSide = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const Vec3& p = this->Points[ids[i]];
      const Vec3 edge = this->Points[ids[(i + 1) % 3]] - p;
      const double side = Dot(normal, Cross(edge, target - p)) / Norm(edge);
      const Id adjacent = surface.GetTriangle(current).Adjacent[i];
      if (side < worstSide && !(adjacent >= 0 && adjacent / 3 == previous))
      {
        worst = i;
        worstSide = side;
      }
    }
    if (worst == NoId)
    {
      const Vec3& p = this->Points[ids[0]];
      const Vec3 n = Cross(this->Points[ids[1]] - p, this->Points[ids[2]] - p);
      const double slope = Dot(n, normal);
      position = slope != 0.0 ? target + (Dot(n, p - target) / slope) * normal : target;
      // A plane across an axis is met exactly, and so are the coordinates of a matching point.
      for (int axis = 0; axis < 3; ++axis)
      {
        const double coordinate = p[axis];
        if (this->Points[ids[1]][axis] == coordinate && this->Points[ids[2]][axis] == coordinate)
        {
          position[axis] = coordinate;
        }
      }
      if (isMirrored)
      {
        position = SnapToCoordinates(position, this->Points[disturbing], this->Diagonal);
        position = this->MatchAcross(current, disturbing, position, radius);
      }
      else
      {
        // It may have been made before on the other side of a layer.
        NearestPointVisitor visitor(position, NoId);
        this->Octree.Visit(visitor);
        position = SnapToCoordinates(position, this->Points[visitor.Nearest], this->Diagonal);
      }
      place = surface.Locate(current, position);
      const Id beyond = place.second ? NoId : surface.GetTriangle(current).Adjacent[place.first];
      if (!place.second && beyond >= 0 && beyond / 3 == previous &&
        surface.CanSplitSmoothEdge(3 * current + place.first, position))
      {
        // Rounded into the plane of either triangle it lies in the other one: on the edge between.
        place.second = true;
      }
      if (place.second)
      {
        break;
      }
      worst = place.first;
    }
    const Id adjacent = surface.GetTriangle(current).Adjacent[worst];
    if (adjacent < 0)
    {
      const Id segment = -1 - adjacent;
      const EdgeIds& ends = surface.GetSegment(segment).Points;
      const auto isDisturbedBy = [&](const Vec3& p)
      { return InDiametralSphere(this->Points[ends[0]], this->Points[ends[1]], p) >= 0; };
      const bool isDisturbed = disturbing != NoId && isDisturbedBy(this->Points[disturbing]);
      // On a curved facet the walk may lead to an edge that has nothing to do with the triangle.
      return (isDisturbed || isDisturbedBy(target) || isDisturbedBy(a) ||
               isDisturbedBy(this->Points[start[1]]) || isDisturbedBy(this->Points[start[2]])) &&
        this->SplitSegment(segment, isDisturbed ? disturbing : NoId);
    }
    previous = current;
    current = adjacent / 3;
  }

  // A point that does not disturb the triangle would not remove it (on curved facets).
  if (this->GetNearestDistance(position) < std::max(this->MinimumEdge, 1e-300) ||
    InEquatorialSphere(a, this->Points[start[1]], this->Points[start[2]], position) <= 0)
  {
    return false;
  }
  if (place.first != NoId && surface.GetSegmentAt(current, place.first) != NoId)
  {
    return this->SplitSegment(surface.GetSegmentAt(current, place.first), disturbing);
  }

  // A point that would disturb an edge of the facet must not be made: split the edge instead.
  const Id encroached = this->FindEncroachedSegment(current, position);
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
  if (place.first == NoId)
  {
    this->Surface->SplitTriangle(current, point, uses);
  }
  else
  {
    this->Surface->SplitSmoothEdge(3 * current + place.first, point, uses);
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
    if (0.25 * length >= this->MinimumEdge && this->GetNearestDistance(position) > 0.0 &&
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

bool SurfaceRefiner::FindTooCoarse(Id t, Id& segment) const
{
  segment = NoId;
  const TriangleIds& ids = this->Surface->GetTriangle(t).Points;
  const Vec3 corners[3] = { this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]] };
  double limit = this->Options.MaximumEdgeLength > 0.0 ? this->Options.MaximumEdgeLength : Infinity;
  if (this->Input.Sizing)
  {
    const LocalSpacing spacing =
      this->Input.Sizing((1.0 / 3.0) * (corners[0] + corners[1] + corners[2]));
    limit = std::min(limit, spacing.GetLargest());
  }
  int longest = 0;
  double lengths[3];
  for (int i = 0; i < 3; ++i)
  {
    lengths[i] = Distance(corners[i], corners[(i + 1) % 3]);
    longest = lengths[i] > lengths[longest] ? i : longest;
  }
  const double area = 0.5 * Norm(Cross(corners[1] - corners[0], corners[2] - corners[0]));
  const bool isLarge = lengths[longest] > limit ||
    (this->Options.MaximumArea > 0.0 && area > this->Options.MaximumArea);
  if (isLarge)
  {
    // The longest structural edge first: facets are refined from a fine enough outline.
    double length = limit;
    for (int i = 0; i < 3; ++i)
    {
      const Id candidate = this->Surface->GetSegmentAt(t, i);
      if (candidate != NoId && (lengths[i] > length || (i == longest && segment == NoId)))
      {
        segment = candidate;
        length = lengths[i];
      }
    }
    return true;
  }
  if (this->Options.MinimumAngle > 0.0)
  {
    const int shortest = static_cast<int>(std::min_element(lengths, lengths + 3) - lengths);
    const double sine = 2.0 * area / (lengths[(shortest + 1) % 3] * lengths[(shortest + 2) % 3]);
    const bool isGivenAngle = this->Surface->GetSegmentAt(t, (shortest + 1) % 3) != NoId &&
      this->Surface->GetSegmentAt(t, (shortest + 2) % 3) != NoId;
    return !isGivenAngle && sine < std::sin(this->Options.MinimumAngle * Pi / 180.0);
  }
  return false;
}

/**
 * In a curved facet a point that mends one triangle may disturb its neighbors, which are bent against
 * it, and so on with ever smaller triangles. Points much closer than the input's are a sign of that.
 */
void SurfaceRefiner::NoteCrumpling(Id t, Id newPoint)
{
  const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
  if (newPoint >= static_cast<Id>(this->Points.size()) ||
    this->FacetNormals[triangle.Facet] != Vec3() ||
    this->NewPointFacets[newPoint - this->NumberOfGivenPoints] == NoId)
  {
    return;
  }
  const TriangleIds& ids = this->Input.Surface->Triangles[triangle.Source];
  double shortest = Infinity;
  for (int i = 0; i < 3; ++i)
  {
    shortest = std::min(shortest, Distance(this->Points[ids[i]], this->Points[ids[(i + 1) % 3]]));
  }
  if (this->GetNearestDistance(this->Points[newPoint], newPoint) < CrumplingRatio * shortest)
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
  std::vector<char> isUnresolved(this->FacetNormals.size(), 0);
  for (Id t : this->Output.UnresolvedTriangles)
  {
    const RefinableSurface::Triangle& triangle = this->Surface->GetTriangle(t);
    if (!isUnresolved.empty() && this->FacetNormals[triangle.Facet] == Vec3())
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

void SurfaceRefiner::Process(Id t)
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
  const Id disturbing = !this->Found.InsideSmallestSphere.empty()
    ? this->Found.InsideSmallestSphere.front()
    : !this->Found.OnSmallestSphere.empty() ? this->Found.OnSmallestSphere.front()
    : !this->Found.Cocircular.empty()       ? this->Found.Cocircular.front()
                                            : NoId;
  const Id newPoint = static_cast<Id>(this->Points.size());
  Vec3 target;
  const bool isMirrored = disturbing != NoId && this->MirrorDisturbingPoint(t, disturbing, target);
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
 * Edges whose diametral spheres have to be empty come before any triangle: facets are refined from a
 * fine enough outline. The shortest first: what it needs is given by the surface around it, and the
 * partners of its points are the points that longer edges need.
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
  for (Id segment = 0; this->AreEdgesTested() && segment < this->Surface->GetNumberOfSegments();
       ++segment)
  {
    this->EnqueueEdge(segment);
  }
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
    const Id t = this->Queue.back().second;
    this->Queue.pop_back();
    this->IsQueued[t] = 0;
    if (this->IsFull())
    {
      this->IsUnresolved[t] = this->IsProven[t] == 0 && !this->IsGood(t, this->Found);
      continue;
    }
    this->Process(t);
  }
  return Status();
}

Status SurfaceRefiner::Finish()
{
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
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
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
      { { std::min(a, b), std::max(a, b) }, segment.Kind, segment.Chain, segment.DihedralAngle });
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
  this->FlipBudget = 100000 + FlipsPerTriangle * this->Surface->GetNumberOfTriangles();
  this->Saturate();
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
