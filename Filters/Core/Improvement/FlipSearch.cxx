// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/FlipSearch.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace cdm
{
namespace
{
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

/**
 * Which points of a ring lie on the circumsphere of which of its tetrahedra. Each is asked for once
 * at most: parts of a ring have most points in common, and the test is slow where it holds.
 */
class RingSpheres
{
public:
  RingSpheres(const FlippableMesh& mesh, const EdgeRing& ring) : Mesh(mesh), Ring(ring) {}

  /** Whether the circumsphere of a tetrahedron of the ring goes through all three points. */
  bool HasSphereThrough(int i, int j, int k)
  {
    for (std::size_t sphere = 0; sphere < this->Ring.Tetrahedra.size(); ++sphere)
    {
      if (this->IsOn(sphere, i) && this->IsOn(sphere, j) && this->IsOn(sphere, k))
      {
        return true;
      }
    }
    return false;
  }

private:
  bool IsOn(std::size_t sphere, int i)
  {
    bool& isKnown = this->IsKnown[sphere][i];
    if (!isKnown)
    {
      const Id point = this->Ring.Points[i];
      const TetrahedronIds& ids = this->Mesh.GetMesh().Tetrahedra[this->Ring.Tetrahedra[sphere]];
      const auto [a, b, c, d] = GetCorners(this->Mesh.GetMesh().Points, ids);
      this->IsOnSphere[sphere][i] =
        Contains(ids, point) || InSphere(a, b, c, d, this->Mesh.GetPoint(point)) == 0;
      isKnown = true;
    }
    return this->IsOnSphere[sphere][i];
  }

  using Table = std::array<std::array<bool, MaximumRingSize>, MaximumRingSize>;

  const FlippableMesh& Mesh;
  const EdgeRing& Ring;
  Table IsKnown{};
  Table IsOnSphere{};
};
} // namespace

AngleKey FlipSearch::GetSmallestKey(const std::vector<Id>& tetrahedra) const
{
  double smallest = 180.0;
  for (const Id tetrahedron : tetrahedra)
  {
    smallest = std::min(smallest, this->Mesh.GetAngle(tetrahedron));
  }
  return GetAngleKey(smallest);
}

/** Smallest dihedral angle of a new tetrahedron; negative if it is less than required or none. */
AngleKey FlipSearch::Rate(const TetrahedronIds& ids, AngleKey required) const
{
  const AngleKey key = GetAngleKey(this->Mesh.MeasureAngle(ids));
  const bool isAllowed = key >= required &&
    Orientation(this->Mesh.GetPoint(ids[0]), this->Mesh.GetPoint(ids[1]),
      this->Mesh.GetPoint(ids[2]), this->Mesh.GetPoint(ids[3])) > 0;
  return isAllowed ? key : -1;
}

/** Make the flip the best one if it improves on the old tetrahedra, and on the best one so far. */
void FlipSearch::Keep(Flip& flip, Flip& best) const
{
  std::vector<AngleKey> oldKeys;
  for (const Id tetrahedron : flip.Old)
  {
    oldKeys.push_back(GetAngleKey(this->Mesh.GetAngle(tetrahedron)));
  }
  for (const TetrahedronIds& ids : flip.New)
  {
    flip.Keys.push_back(GetAngleKey(this->Mesh.MeasureAngle(ids)));
  }
  std::sort(oldKeys.begin(), oldKeys.end());
  std::sort(flip.Keys.begin(), flip.Keys.end());
  if (AreBetter(flip.Keys, oldKeys) && (best.New.empty() || AreBetter(flip.Keys, best.Keys)))
  {
    best = std::move(flip);
  }
}

/** The 2-3 flip at an open facet: all five points lie on one sphere if they have to. */
void FlipSearch::TryFacet(Id tetrahedron, int facet, Flip& best) const
{
  const Id neighbor = this->Mesh.GetMesh().Neighbors[tetrahedron][facet];
  const Id p = this->Mesh.GetMesh().Tetrahedra[tetrahedron][facet];
  const Id q = this->Mesh.GetMesh().Tetrahedra[neighbor / 4][neighbor % 4];
  const TriangleIds triangle = GetFacet(this->Mesh.GetMesh().Tetrahedra[tetrahedron], facet);
  Flip flip;
  flip.Old = { tetrahedron, neighbor / 4 };
  const AngleKey required = this->GetSmallestKey(flip.Old);
  for (int i = 0; i < 3; ++i)
  {
    flip.New.push_back({ p, q, triangle[i], triangle[(i + 1) % 3] });
    if (this->Rate(flip.New.back(), required) < 0)
    {
      return;
    }
  }
  this->Keep(flip, best);
}

/**
 * The triangulation of a ring whose tetrahedra have the best smallest angle, by dynamic
 * programming; false if none is good enough. middle: for each part of the ring, from its i-th to
 * its k-th point, the point that makes a triangle with both. Angles come first: they spare most of
 * the exact tests of spheres.
 */
bool FlipSearch::TriangulateRing(const EdgeRing& ring, RingMiddles& middle) const
{
  const int size = static_cast<int>(ring.Points.size());
  const AngleKey required = this->GetSmallestKey(ring.Tetrahedra);
  RingSpheres spheres(this->Mesh, ring);
  // Best smallest angle for each part.
  std::array<std::array<AngleKey, MaximumRingSize>, MaximumRingSize> angle{};
  for (int i = 0; i + 1 < size; ++i)
  {
    angle[i][i + 1] = GetAngleKey(180.0);
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
            smallest = std::min(smallest, this->Rate(ids, required));
          }
        }
        if (smallest > angle[i][k] &&
          (this->IsAnyShapeAllowed || spheres.HasSphereThrough(i, j, k)))
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
void FlipSearch::TryEdge(Id tetrahedron, int edge, Flip& best) const
{
  EdgeRing ring;
  RingMiddles middle{};
  if (!this->Mesh.FindRing(tetrahedron, edge, MaximumRingSize, ring) ||
    !this->Mesh.IsInOneRegion(ring) || ring.Points.size() < 3 ||
    !this->TriangulateRing(ring, middle))
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

/**
 * Whether flips across a facet of the tetrahedron are worth a search: the tetrahedron beyond is in
 * the same region and, if flips have to leave Delaunay tetrahedra, has the same circumsphere.
 */
bool FlipSearch::IsOpen(Id tetrahedron, int facet) const
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  const Id neighbor = mesh.Neighbors[tetrahedron][facet];
  if (neighbor == NoId || mesh.Regions[neighbor / 4] != mesh.Regions[tetrahedron])
  {
    return false;
  }
  const auto [a, b, c, d] = GetCorners(mesh.Points, mesh.Tetrahedra[tetrahedron]);
  return this->IsAnyShapeAllowed ||
    InSphere(a, b, c, d, this->Mesh.GetPoint(mesh.Tetrahedra[neighbor / 4][neighbor % 4])) == 0;
}

Flip FlipSearch::FindBest(Id tetrahedron) const
{
  std::array<bool, 4> isOpen{};
  for (int facet = 0; facet < 4; ++facet)
  {
    isOpen[facet] = this->IsOpen(tetrahedron, facet);
  }
  Flip best;
  if (!Contains(isOpen, true))
  {
    return best;
  }
  for (int facet = 0; facet < 4; ++facet)
  {
    if (isOpen[facet])
    {
      this->TryFacet(tetrahedron, facet, best);
    }
  }
  for (int edge = 0; edge < 6; ++edge)
  {
    // The facets at the edge are opposite to the other vertices.
    if (isOpen[EdgeVertices[edge][2]] || isOpen[EdgeVertices[edge][3]])
    {
      this->TryEdge(tetrahedron, edge, best);
    }
  }
  return best;
}
} // namespace cdm
