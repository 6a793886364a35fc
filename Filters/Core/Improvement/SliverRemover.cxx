// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverRemover.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Improvement/SliverPointMoves.h"
#include "Core/Meshes/MeshInvariants.h"
#include "Core/Search/PlaceSearch.h"
#include "Core/Surface/StructuralEdges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
constexpr Id ContinueInterval = 1 << 10;

/** Edges with more tetrahedra around them are left alone: their removal hardly ever pays. */
constexpr int MaximumRingSize = 8;

/**
 * Angles are compared as multiples of this (degrees): it is more than their rounding error, so
 * tetrahedra of one shape are equal, and an order of integers cannot run in circles.
 */
constexpr double AngleStep = 1e-6;

using AngleKey = std::int64_t;

AngleKey GetKey(double angle)
{
  return std::llround(angle / AngleStep);
}

/** Degrees: what two facets on a boundary bend at most if they are to be exchanged. */
constexpr double LargestPeelBend = 1.0;

/** Positions of an edge's two vertices and of the other two, so that the order is even. */
constexpr int EdgeVertices[6][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 }, { 1, 2, 0, 3 },
  { 1, 3, 2, 0 }, { 2, 3, 0, 1 } };

/** Number of the edge, in the order of GetDihedralAngles(), between two vertices. */
int GetEdge(int first, int second)
{
  const int low = std::min(first, second);
  return low + std::max(first, second) - (low == 0 ? 1 : 0);
}

/** The tetrahedra around an edge p-q: (p, q, Points[i], Points[i + 1]) is Tetrahedra[i]. */
struct Ring
{
  Id P = NoId;
  Id Q = NoId;
  std::vector<Id> Points;
  std::vector<Id> Tetrahedra;

  /** The tetrahedra of three of the points with q, and with p. */
  TetrahedronIds MakeUpper(int i, int j, int k) const
  {
    return { this->Points[i], this->Points[j], this->Points[k], this->Q };
  }
  TetrahedronIds MakeLower(int i, int j, int k) const
  {
    return { this->Points[i], this->Points[k], this->Points[j], this->P };
  }
};

using RingMiddles = std::array<std::array<int, MaximumRingSize>, MaximumRingSize>;

/** A facet of a cavity or of a new tetrahedron, and the facet behind it. */
struct OpenFacet
{
  /** Sorted. */
  TriangleIds Points;
  Id Behind;
};

TriangleIds GetSortedFacet(const TetrahedronIds& ids, int facet)
{
  TriangleIds sorted = GetFacet(ids, facet);
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/** Tetrahedra to be replaced by others. */
struct Flip
{
  std::vector<Id> Old;
  /** None: there is no flip. */
  std::vector<TetrahedronIds> New;
  /** Smallest dihedral angles of the new tetrahedra, ascending. */
  std::vector<AngleKey> Keys;
};

/**
 * Whether the first angles are the better ones: the smallest is larger, or as large and the second
 * smallest is larger, and so on; none is better than any.
 */
bool AreBetter(const std::vector<AngleKey>& first, const std::vector<AngleKey>& second)
{
  const auto difference = std::mismatch(first.begin(), first.end(), second.begin(), second.end());
  return difference.second != second.end() &&
    (difference.first == first.end() || *difference.first > *difference.second);
}

class SliverRemoval
{
public:
  SliverRemoval(TetMesh& mesh, const SliverRemoverOptions& options, SliverRemoverReport& report)
    : Mesh(mesh), Options(options), Target(options.DihedralAngleTarget),
      Flatness(options.FlatnessRatio * GetBoundingBoxDiagonal(mesh.Points)), Report(report)
  {
  }

  Status Run(const ExecutionContext& context);

private:
  /** A tetrahedron to be treated, unless it has changed since. */
  struct Task
  {
    double Angle;
    Id Tetrahedron;
    Id Stamp;

    /** Worst first, then the smallest id. */
    friend bool operator<(const Task& a, const Task& b)
    {
      return a.Angle != b.Angle ? a.Angle > b.Angle : a.Tetrahedron > b.Tetrahedron;
    }
  };

  bool IsDead(Id tetrahedron) const { return this->Mesh.Tetrahedra[tetrahedron][0] == NoId; }
  const Vec3& GetPoint(Id point) const { return this->Mesh.Points[point]; }
  double MeasureAngle(const TetrahedronIds& ids) const;
  void MeasureAngles(int numberOfThreads);
  double MeasureSmallestAngle() const;
  void Schedule(Id tetrahedron);
  bool FindRing(Id tetrahedron, int edge, std::size_t maximumSize, Ring& ring) const;
  bool IsInOneRegion(const Ring& ring) const;

  bool FindPeeledEdges(Id tetrahedron, int& outerEdge, int& innerEdge, Id& neighborRegion) const;
  bool IsOnlyTetrahedronAtEdge(Id tetrahedron, int edge);
  bool PeelOff(Id tetrahedron);
  bool HandOver(Id tetrahedron);

  bool IsDelaunay(const TetrahedronIds& ids, const std::vector<Id>& old) const;
  AngleKey GetSmallestKey(const std::vector<Id>& tetrahedra) const;
  AngleKey Rate(const TetrahedronIds& ids, const std::vector<Id>& old, AngleKey required) const;
  void TryFacet(Id tetrahedron, int facet, Flip& best) const;
  bool TriangulateRing(const Ring& ring, RingMiddles& middle) const;
  void TryEdge(Id tetrahedron, int edge, Flip& best) const;
  void Keep(Flip& flip, Flip& best) const;
  bool Improve(Id tetrahedron);
  void Apply(const Flip& flip);
  std::vector<OpenFacet> FindFacetsAround(const std::vector<Id>& tetrahedra) const;
  Id Make(const TetrahedronIds& ids, Id region);
  void Connect(Id tetrahedron, std::vector<OpenFacet>& open);
  void Kill(Id tetrahedron);
  void Compact();

  bool IsFree(Id point) const
  {
    return !this->Options.IsFree.empty() && this->Options.IsFree[point];
  }
  bool FindStar(Id point, Id first, std::vector<Id>& star) const;
  bool FindBetterPosition(Id point, const std::vector<Id>& star, Vec3& position) const;
  bool Smooth(Id tetrahedron);
  bool PeelAndFlip(const ExecutionContext& context);
  bool HasMovableSlivers() const;

  TetMesh& Mesh;
  const SliverRemoverOptions& Options;
  const double Target;
  const double Flatness;
  SliverRemoverReport& Report;

  /** Smallest dihedral angle of each tetrahedron, and how often it has changed. */
  std::vector<double> Angles;
  std::vector<Id> Stamps;
  /** Slots of tetrahedra that are gone. */
  std::vector<Id> Free;
  std::priority_queue<Task> Tasks;
  /** The points' tetrahedra before the first flip; made when the first one may be peeled off. */
  std::vector<Id> IncidenceBegin;
  std::vector<Id> Incidence;
};

double SliverRemoval::MeasureAngle(const TetrahedronIds& ids) const
{
  return GetSmallestDihedralAngle(
    this->GetPoint(ids[0]), this->GetPoint(ids[1]), this->GetPoint(ids[2]), this->GetPoint(ids[3]));
}

double SliverRemoval::MeasureSmallestAngle() const
{
  return this->Angles.empty() ? 0.0 : *std::min_element(this->Angles.begin(), this->Angles.end());
}

void SliverRemoval::Schedule(Id tetrahedron)
{
  if (this->Angles[tetrahedron] < this->Target)
  {
    this->Tasks.push({ this->Angles[tetrahedron], tetrahedron, this->Stamps[tetrahedron] });
  }
}

/** False if the ring is open or longer than it may be. */
bool SliverRemoval::FindRing(Id tetrahedron, int edge, std::size_t maximumSize, Ring& ring) const
{
  const int* order = EdgeVertices[edge];
  const TetrahedronIds& first = this->Mesh.Tetrahedra[tetrahedron];
  ring.P = first[order[0]];
  ring.Q = first[order[1]];
  ring.Points.clear();
  ring.Tetrahedra.clear();
  Id current = tetrahedron;
  // Position of the ring's point that is left behind.
  int last = order[2];
  Id next = first[order[3]];
  do
  {
    if (ring.Tetrahedra.size() == maximumSize)
    {
      return false;
    }
    ring.Tetrahedra.push_back(current);
    ring.Points.push_back(this->Mesh.Tetrahedra[current][last]);
    const Id facet = this->Mesh.Neighbors[current][last];
    if (facet == NoId)
    {
      return false;
    }
    current = facet / 4;
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[current];
    last = static_cast<int>(std::find(ids.begin(), ids.end(), next) - ids.begin());
    next = ids[facet % 4];
  } while (current != tetrahedron);
  return true;
}

bool SliverRemoval::IsInOneRegion(const Ring& ring) const
{
  return std::all_of(ring.Tetrahedra.begin(), ring.Tetrahedra.end(),
    [&](Id other)
    { return this->Mesh.Regions[other] == this->Mesh.Regions[ring.Tetrahedra.front()]; });
}

/**
 * Whether the tetrahedron is flat and has exactly two facets on the border of its region, both to
 * the same one. These meet in the outer edge, the other two facets in the inner edge.
 */
bool SliverRemoval::FindPeeledEdges(
  Id tetrahedron, int& outerEdge, int& innerEdge, Id& neighborRegion) const
{
  std::array<int, 4> facets;
  int front = 0;
  int back = 4;
  for (int facet = 0; facet < 4; ++facet)
  {
    const Id neighbor = this->Mesh.Neighbors[tetrahedron][facet];
    const Id region = neighbor == NoId ? OutsideRegion : this->Mesh.Regions[neighbor / 4];
    if (neighbor != NoId && region == this->Mesh.Regions[tetrahedron])
    {
      facets[--back] = facet;
      continue;
    }
    if (front > 0 && region != neighborRegion)
    {
      return false;
    }
    neighborRegion = region;
    facets[front++] = facet;
  }
  if (front != 2)
  {
    return false;
  }
  const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
  const std::array<Vec3, 4> points{ this->GetPoint(ids[0]), this->GetPoint(ids[1]),
    this->GetPoint(ids[2]), this->GetPoint(ids[3]) };
  if (GetSmallestHeight(points[0], points[1], points[2], points[3]) >= this->Flatness)
  {
    return false;
  }
  // The vertices opposite to the border's facets are those of the inner edge.
  innerEdge = GetEdge(facets[0], facets[1]);
  outerEdge = GetEdge(facets[2], facets[3]);
  const std::array<double, 6> angles =
    GetDihedralAngles(points[0], points[1], points[2], points[3]);
  return angles[innerEdge] >= 180.0 - LargestPeelBend &&
    angles[outerEdge] >= 180.0 - LargestPeelBend;
}

bool SliverRemoval::IsOnlyTetrahedronAtEdge(Id tetrahedron, int edge)
{
  if (this->IncidenceBegin.empty())
  {
    this->IncidenceBegin.assign(this->Mesh.Points.size() + 1, 0);
    for (const TetrahedronIds& ids : this->Mesh.Tetrahedra)
    {
      for (const Id point : ids)
      {
        if (point != NoId)
        {
          ++this->IncidenceBegin[point + 1];
        }
      }
    }
    for (std::size_t i = 1; i < this->IncidenceBegin.size(); ++i)
    {
      this->IncidenceBegin[i] += this->IncidenceBegin[i - 1];
    }
    this->Incidence.resize(this->IncidenceBegin.back());
    std::vector<Id> next(this->IncidenceBegin.begin(), this->IncidenceBegin.end() - 1);
    for (Id other = 0; other < static_cast<Id>(this->Mesh.Tetrahedra.size()); ++other)
    {
      for (const Id point : this->Mesh.Tetrahedra[other])
      {
        if (point != NoId)
        {
          this->Incidence[next[point]++] = other;
        }
      }
    }
  }
  const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
  const Id begin = ids[EdgeVertices[edge][0]];
  const Id end = ids[EdgeVertices[edge][1]];
  for (Id i = this->IncidenceBegin[begin]; i < this->IncidenceBegin[begin + 1]; ++i)
  {
    const Id other = this->Incidence[i];
    const TetrahedronIds& otherIds = this->Mesh.Tetrahedra[other];
    if (other != tetrahedron && !this->IsDead(other) &&
      std::find(otherIds.begin(), otherIds.end(), end) != otherIds.end())
    {
      return false;
    }
  }
  return true;
}

/**
 * Remove a flat tetrahedron at the outer boundary. Its inner edge must not lie on a border, or the
 * border would touch itself there; its outer edge must not be another tetrahedron's, or a gap would
 * open there.
 */
bool SliverRemoval::PeelOff(Id tetrahedron)
{
  int outerEdge = 0;
  int innerEdge = 0;
  Id neighborRegion = NoId;
  Ring ring;
  if (!this->FindPeeledEdges(tetrahedron, outerEdge, innerEdge, neighborRegion) ||
    neighborRegion != OutsideRegion ||
    !this->FindRing(tetrahedron, innerEdge, this->Mesh.Tetrahedra.size(), ring) ||
    !this->IsInOneRegion(ring) || !this->IsOnlyTetrahedronAtEdge(tetrahedron, outerEdge))
  {
    return false;
  }
  for (const Id neighbor : this->Mesh.Neighbors[tetrahedron])
  {
    if (neighbor != NoId)
    {
      this->Mesh.Neighbors[neighbor / 4][neighbor % 4] = NoId;
      // With a facet on the boundary it may be the next one.
      this->Schedule(neighbor / 4);
    }
  }
  this->Kill(tetrahedron);
  ++this->Report.PeeledTetrahedra;
  return true;
}

/** Give a flat tetrahedron at an interface to the other region if it can vanish there. */
bool SliverRemoval::HandOver(Id tetrahedron)
{
  int outerEdge = 0;
  int innerEdge = 0;
  Id neighborRegion = NoId;
  Ring ring;
  if (!this->FindPeeledEdges(tetrahedron, outerEdge, innerEdge, neighborRegion) ||
    neighborRegion == OutsideRegion ||
    !this->FindRing(tetrahedron, innerEdge, this->Mesh.Tetrahedra.size(), ring) ||
    !this->IsInOneRegion(ring))
  {
    return false;
  }
  const Id ownRegion = std::exchange(this->Mesh.Regions[tetrahedron], neighborRegion);
  Flip flip;
  this->TryEdge(tetrahedron, outerEdge, flip);
  if (flip.New.empty())
  {
    this->Mesh.Regions[tetrahedron] = ownRegion;
    return false;
  }
  this->Apply(flip);
  ++this->Report.PeeledTetrahedra;
  return true;
}

/** Whether the new tetrahedron has the circumsphere of one of the old ones. */
bool SliverRemoval::IsDelaunay(const TetrahedronIds& ids, const std::vector<Id>& old) const
{
  return std::any_of(old.begin(), old.end(),
    [&](Id other)
    {
      const TetrahedronIds& otherIds = this->Mesh.Tetrahedra[other];
      return std::all_of(ids.begin(), ids.end(),
        [&](Id point)
        {
          return std::find(otherIds.begin(), otherIds.end(), point) != otherIds.end() ||
            InSphere(this->GetPoint(otherIds[0]), this->GetPoint(otherIds[1]),
              this->GetPoint(otherIds[2]), this->GetPoint(otherIds[3]), this->GetPoint(point)) == 0;
        });
    });
}

AngleKey SliverRemoval::GetSmallestKey(const std::vector<Id>& tetrahedra) const
{
  double smallest = 180.0;
  for (const Id tetrahedron : tetrahedra)
  {
    smallest = std::min(smallest, this->Angles[tetrahedron]);
  }
  return GetKey(smallest);
}

/**
 * Smallest dihedral angle of a new tetrahedron; negative if it is less than required or if the
 * tetrahedron must not be made. The angle comes first: it spares most of the exact tests, which are
 * slow where all points are cospherical.
 */
AngleKey SliverRemoval::Rate(
  const TetrahedronIds& ids, const std::vector<Id>& old, AngleKey required) const
{
  const AngleKey key = GetKey(this->MeasureAngle(ids));
  const bool isAllowed = key >= required &&
    Orientation(this->GetPoint(ids[0]), this->GetPoint(ids[1]), this->GetPoint(ids[2]),
      this->GetPoint(ids[3])) > 0 &&
    (this->Options.QualityBeforeDelaunay || this->IsDelaunay(ids, old));
  return isAllowed ? key : -1;
}

/** Make the flip the best one if it improves on the old tetrahedra, and on the best one so far. */
void SliverRemoval::Keep(Flip& flip, Flip& best) const
{
  std::vector<AngleKey> oldKeys;
  for (const Id tetrahedron : flip.Old)
  {
    oldKeys.push_back(GetKey(this->Angles[tetrahedron]));
  }
  for (const TetrahedronIds& ids : flip.New)
  {
    flip.Keys.push_back(GetKey(this->MeasureAngle(ids)));
  }
  std::sort(oldKeys.begin(), oldKeys.end());
  std::sort(flip.Keys.begin(), flip.Keys.end());
  if (AreBetter(flip.Keys, oldKeys) && (best.New.empty() || AreBetter(flip.Keys, best.Keys)))
  {
    best = std::move(flip);
  }
}

/** The 2-3 flip at a facet. */
void SliverRemoval::TryFacet(Id tetrahedron, int facet, Flip& best) const
{
  const Id neighbor = this->Mesh.Neighbors[tetrahedron][facet];
  if (neighbor == NoId || this->Mesh.Regions[neighbor / 4] != this->Mesh.Regions[tetrahedron])
  {
    return;
  }
  const Id p = this->Mesh.Tetrahedra[tetrahedron][facet];
  const Id q = this->Mesh.Tetrahedra[neighbor / 4][neighbor % 4];
  const TriangleIds triangle = GetFacet(this->Mesh.Tetrahedra[tetrahedron], facet);
  Flip flip;
  flip.Old = { tetrahedron, neighbor / 4 };
  const AngleKey required = this->GetSmallestKey(flip.Old);
  for (int i = 0; i < 3; ++i)
  {
    flip.New.push_back({ p, q, triangle[i], triangle[(i + 1) % 3] });
    if (this->Rate(flip.New.back(), flip.Old, required) < 0)
    {
      return;
    }
  }
  this->Keep(flip, best);
}

/**
 * The triangulation of a ring whose tetrahedra have the best smallest angle, by dynamic
 * programming; false if none is good enough. middle: for each part of the ring, from its i-th to
 * its k-th point, the point that makes a triangle with both.
 */
bool SliverRemoval::TriangulateRing(const Ring& ring, RingMiddles& middle) const
{
  const int size = static_cast<int>(ring.Points.size());
  const AngleKey required = this->GetSmallestKey(ring.Tetrahedra);
  // Best smallest angle for each part.
  std::array<std::array<AngleKey, MaximumRingSize>, MaximumRingSize> angle{};
  for (int i = 0; i + 1 < size; ++i)
  {
    angle[i][i + 1] = GetKey(180.0);
  }
  for (int width = 2; width < size; ++width)
  {
    for (int i = 0; i + width < size; ++i)
    {
      const int k = i + width;
      angle[i][k] = -1;
      for (int j = i + 1; j < k; ++j)
      {
        AngleKey smallest = std::min(angle[i][j], angle[j][k]);
        for (const TetrahedronIds& ids : { ring.MakeUpper(i, j, k), ring.MakeLower(i, j, k) })
        {
          if (smallest > angle[i][k])
          {
            smallest = std::min(smallest, this->Rate(ids, ring.Tetrahedra, required));
          }
        }
        if (smallest > angle[i][k])
        {
          angle[i][k] = smallest;
          middle[i][k] = j;
        }
      }
    }
  }
  return angle[0][size - 1] >= 0;
}

/** Remove an edge: triangulate its ring and connect each triangle with both ends of the edge. */
void SliverRemoval::TryEdge(Id tetrahedron, int edge, Flip& best) const
{
  Ring ring;
  RingMiddles middle{};
  if (!this->FindRing(tetrahedron, edge, MaximumRingSize, ring) || !this->IsInOneRegion(ring) ||
    ring.Points.size() < 3 || !this->TriangulateRing(ring, middle))
  {
    return;
  }
  Flip flip;
  flip.Old = ring.Tetrahedra;
  std::vector<std::pair<int, int>> parts{ { 0, static_cast<int>(ring.Points.size()) - 1 } };
  while (!parts.empty())
  {
    const auto [i, k] = parts.back();
    parts.pop_back();
    if (k - i < 2)
    {
      continue;
    }
    const int j = middle[i][k];
    flip.New.push_back(ring.MakeUpper(i, j, k));
    flip.New.push_back(ring.MakeLower(i, j, k));
    parts.emplace_back(i, j);
    parts.emplace_back(j, k);
  }
  this->Keep(flip, best);
}

bool SliverRemoval::Improve(Id tetrahedron)
{
  Flip best;
  for (int facet = 0; facet < 4; ++facet)
  {
    this->TryFacet(tetrahedron, facet, best);
  }
  for (int edge = 0; edge < 6; ++edge)
  {
    this->TryEdge(tetrahedron, edge, best);
  }
  if (best.New.empty())
  {
    return false;
  }
  this->Apply(best);
  return true;
}

void SliverRemoval::Kill(Id tetrahedron)
{
  this->Mesh.Tetrahedra[tetrahedron] = { NoId, NoId, NoId, NoId };
  this->Angles[tetrahedron] = 180.0;
  ++this->Stamps[tetrahedron];
  this->Free.push_back(tetrahedron);
}

/** The facets around tetrahedra, with what lies behind them. */
std::vector<OpenFacet> SliverRemoval::FindFacetsAround(const std::vector<Id>& tetrahedra) const
{
  std::vector<OpenFacet> facets;
  for (const Id tetrahedron : tetrahedra)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      const Id neighbor = this->Mesh.Neighbors[tetrahedron][facet];
      if (neighbor == NoId ||
        std::find(tetrahedra.begin(), tetrahedra.end(), neighbor / 4) == tetrahedra.end())
      {
        facets.push_back({ GetSortedFacet(this->Mesh.Tetrahedra[tetrahedron], facet), neighbor });
      }
    }
  }
  return facets;
}

/** Makes a tetrahedron in a free slot, without its neighbors. */
Id SliverRemoval::Make(const TetrahedronIds& ids, Id region)
{
  Id tetrahedron = NoId;
  if (this->Free.empty())
  {
    tetrahedron = static_cast<Id>(this->Mesh.Tetrahedra.size());
    this->Mesh.Tetrahedra.emplace_back();
    this->Mesh.Regions.emplace_back();
    this->Mesh.Neighbors.emplace_back();
    this->Angles.emplace_back();
    this->Stamps.emplace_back(0);
  }
  else
  {
    tetrahedron = this->Free.back();
    this->Free.pop_back();
  }
  this->Mesh.Tetrahedra[tetrahedron] = ids;
  this->Mesh.Regions[tetrahedron] = region;
  this->Angles[tetrahedron] = this->MeasureAngle(ids);
  return tetrahedron;
}

/** Connects a new tetrahedron across the facets that are open; its other facets become so. */
void SliverRemoval::Connect(Id tetrahedron, std::vector<OpenFacet>& open)
{
  for (int facet = 0; facet < 4; ++facet)
  {
    const TriangleIds points = GetSortedFacet(this->Mesh.Tetrahedra[tetrahedron], facet);
    const Id own = 4 * tetrahedron + facet;
    const auto found = std::find_if(
      open.begin(), open.end(), [&](const OpenFacet& other) { return other.Points == points; });
    if (found == open.end())
    {
      open.push_back({ points, own });
      continue;
    }
    this->Mesh.Neighbors[tetrahedron][facet] = found->Behind;
    if (found->Behind != NoId)
    {
      this->Mesh.Neighbors[found->Behind / 4][found->Behind % 4] = own;
    }
  }
}

void SliverRemoval::Apply(const Flip& flip)
{
  std::vector<OpenFacet> open = this->FindFacetsAround(flip.Old);
  const std::size_t numberOfOuterFacets = open.size();
  const Id region = this->Mesh.Regions[flip.Old.front()];
  for (auto tetrahedron = flip.Old.rbegin(); tetrahedron != flip.Old.rend(); ++tetrahedron)
  {
    this->Kill(*tetrahedron);
  }
  std::vector<Id> made;
  for (const TetrahedronIds& ids : flip.New)
  {
    made.push_back(this->Make(ids, region));
    this->Connect(made.back(), open);
  }
  for (const Id tetrahedron : made)
  {
    this->Schedule(tetrahedron);
  }
  // For their neighbors flips may have become possible.
  for (std::size_t i = 0; i < numberOfOuterFacets; ++i)
  {
    if (open[i].Behind != NoId)
    {
      this->Schedule(open[i].Behind / 4);
    }
  }
  ++this->Report.Flips;
}

/** Close the gaps that dead tetrahedra leave, without changing the order of the others. */
void SliverRemoval::Compact()
{
  std::size_t count = 0;
  for (std::size_t t = 0; t < this->Angles.size(); ++t)
  {
    if (!this->IsDead(static_cast<Id>(t)))
    {
      this->Angles[count++] = this->Angles[t];
    }
  }
  this->Angles.resize(count);
  RemoveDeadTetrahedra(this->Mesh);
}

/** All tetrahedra at a point; false if it lies on a border. */
bool SliverRemoval::FindStar(Id point, Id first, std::vector<Id>& star) const
{
  star.assign(1, first);
  for (std::size_t i = 0; i < star.size(); ++i)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      if (this->Mesh.Tetrahedra[star[i]][facet] == point)
      {
        continue;
      }
      const Id neighbor = this->Mesh.Neighbors[star[i]][facet];
      if (neighbor == NoId || this->Mesh.Regions[neighbor / 4] != this->Mesh.Regions[first])
      {
        return false;
      }
      if (std::find(star.begin(), star.end(), neighbor / 4) == star.end())
      {
        star.push_back(neighbor / 4);
      }
    }
  }
  return true;
}

/** The best position for a point within the tetrahedra around it, which stay. */
bool SliverRemoval::FindBetterPosition(Id point, const std::vector<Id>& star, Vec3& position) const
{
  const Vec3 old = this->GetPoint(point);
  double smallest = 180.0;
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 sum;
  for (const Id other : star)
  {
    smallest = std::min(smallest, this->Angles[other]);
    for (const Id id : this->Mesh.Tetrahedra[other])
    {
      if (id != point)
      {
        nearest = std::min(nearest, Distance(old, this->GetPoint(id)));
        sum = sum + this->GetPoint(id);
      }
    }
  }
  const auto rate = [&](const Vec3& tried, double required)
  {
    double angle = 180.0;
    for (const Id other : star)
    {
      std::array<Vec3, 4> v;
      for (int i = 0; i < 4; ++i)
      {
        const Id id = this->Mesh.Tetrahedra[other][i];
        v[i] = id == point ? tried : this->GetPoint(id);
      }
      angle = std::min(angle, GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]));
      if (angle <= required || Orientation(v[0], v[1], v[2], v[3]) <= 0)
      {
        return 0.0;
      }
    }
    return angle;
  };
  Place best{ old, smallest + SmallestGain, false };
  const Vec3 mean = (1.0 / (3.0 * static_cast<double>(star.size()))) * sum;
  SearchMove(old, mean, nearest, this->Target, rate, best);
  position = best.Position;
  return best.IsFound;
}

/** Move a free point within the tetrahedra around it, which stay. */
bool SliverRemoval::Smooth(Id tetrahedron)
{
  std::vector<Id> star;
  for (const Id point : this->Mesh.Tetrahedra[tetrahedron])
  {
    Vec3 position;
    if (!this->IsFree(point) || !this->FindStar(point, tetrahedron, star) ||
      !this->FindBetterPosition(point, star, position))
    {
      continue;
    }
    this->Mesh.Points[point] = position;
    for (const Id other : star)
    {
      this->Angles[other] = this->MeasureAngle(this->Mesh.Tetrahedra[other]);
      ++this->Stamps[other];
    }
    for (const Id other : star)
    {
      this->Schedule(other);
      // For their neighbors flips may have become possible.
      for (const Id facet : this->Mesh.Neighbors[other])
      {
        if (facet != NoId && std::find(star.begin(), star.end(), facet / 4) == star.end())
        {
          this->Schedule(facet / 4);
        }
      }
    }
    ++this->Report.MovedPoints;
    return true;
  }
  return false;
}

bool SliverRemoval::HasMovableSlivers() const
{
  for (std::size_t t = 0; t < this->Angles.size(); ++t)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[t];
    if (this->Angles[t] < this->Target &&
      (this->Options.AreBoundaryPointsFree ||
        std::any_of(ids.begin(), ids.end(), [&](Id point) { return this->IsFree(point); })))
    {
      return true;
    }
  }
  return false;
}

/** Peel, flip and, if it need not stay Delaunay, smooth. False if aborted. */
bool SliverRemoval::PeelAndFlip(const ExecutionContext& context)
{
  const Id count = static_cast<Id>(this->Mesh.Tetrahedra.size());
  // Peel first: the tetrahedra around each point, which it asks for, change with the first flip.
  bool isAborted = false;
  for (const bool isPeeling : { true, false })
  {
    for (Id tetrahedron = 0; tetrahedron < count; ++tetrahedron)
    {
      if (!this->IsDead(tetrahedron))
      {
        this->Schedule(tetrahedron);
      }
    }
    const std::size_t numberOfTasks = this->Tasks.size();
    for (std::size_t done = 0; !this->Tasks.empty() && !isAborted; ++done)
    {
      if (done % ContinueInterval == 0)
      {
        const double fraction = static_cast<double>(done) / (done + numberOfTasks);
        isAborted =
          !context.Continue(isPeeling ? 0.2 * fraction : 0.2 + 0.8 * fraction, "Removing slivers");
      }
      const Task task = this->Tasks.top();
      this->Tasks.pop();
      if (task.Stamp != this->Stamps[task.Tetrahedron])
      {
        continue;
      }
      if (isPeeling)
      {
        this->PeelOff(task.Tetrahedron);
      }
      else if (!this->Improve(task.Tetrahedron) && !this->HandOver(task.Tetrahedron) &&
        this->Options.QualityBeforeDelaunay)
      {
        this->Smooth(task.Tetrahedron);
      }
    }
  }
  this->Compact();
  return !isAborted;
}

void SliverRemoval::MeasureAngles(int numberOfThreads)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  this->Angles.resize(count);
  ParallelLoop(count, { numberOfThreads }, {}, "",
    [this](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        this->Angles[t] = this->MeasureAngle(this->Mesh.Tetrahedra[t]);
      }
    });
}

Status SliverRemoval::Run(const ExecutionContext& context)
{
  this->MeasureAngles(context.GetNumberOfThreads());
  this->Stamps.assign(this->Mesh.Tetrahedra.size(), 0);
  this->Report.SmallestDihedralAngleBefore = this->MeasureSmallestAngle();
  const bool mayMove = (!this->Options.IsFree.empty() || this->Options.AreBoundaryPointsFree) &&
    !this->Options.QualityBeforeDelaunay;
  const double share = mayMove ? 0.2 : 1.0;
  bool isAborted = !this->PeelAndFlip(context.Part(0.0, share));
  if (mayMove && !isAborted && this->HasMovableSlivers())
  {
    const Status status =
      MoveSliverPoints(this->Target, this->Options.IsFree, this->Options.AreBoundaryPointsFree,
        context.Part(share, 1.0), this->Mesh, this->Report.MovedPoints);
    isAborted = !status.IsOk();
    this->MeasureAngles(context.GetNumberOfThreads());
  }
  this->Report.SmallestDihedralAngleAfter = this->MeasureSmallestAngle();
  return isAborted ? Status::Aborted() : Status{};
}
} // namespace

Status RemoveSlivers(TetMesh& mesh, const SliverRemoverOptions& options,
  const ExecutionContext& context, SliverRemoverReport& report)
{
  return RunGuarded(
    [&]() -> Status
    {
      report = {};
      const Status status = CheckMeshInvariants(mesh, context.GetNumberOfThreads());
      if (status.IsOk() && !options.IsFree.empty() && options.IsFree.size() != mesh.Points.size())
      {
        return Status::InvalidInput(
          "Which points are free has to be said for each point, or for none.");
      }
      return status.IsOk() ? SliverRemoval(mesh, options, report).Run(context) : status;
    });
}
} // namespace cdm
