// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FlipSearch.h
 * @brief The flip that makes the tetrahedra around a bad one best.
 *
 * Flips replace the two tetrahedra at a facet by three (2-3), or those around an edge by others
 * without the edge (3-2, 4-4 and larger ones), the ring triangulated best possible by dynamic
 * programming. A flip counts if it stays in one region, if each new tetrahedron has the circumsphere
 * of one that it replaces, and if the sorted smallest angles grow lexicographically.
 *
 * A Delaunay mesh leaves only those flips a choice that replace cospherical tetrahedra. So a facet
 * is searched if the tetrahedra on both sides have one circumsphere, and an edge if one of its
 * facets in the bad tetrahedron is such a one: an edge that other Delaunay tetrahedra do without
 * lies inside a polyhedron of cospherical points, or in a facet of two of them.
 *
 * Cost: four in-sphere tests where there is no choice; O(k^3) for a ring of k tetrahedra, of which
 * there are at most eight.
 * References: see SliverRemover.h.
 */
#ifndef cdmFlipSearch_h
#define cdmFlipSearch_h

#include "Core/Improvement/FlippableMesh.h"

#include <array>

namespace cdm
{
/** Edges with more tetrahedra around them are left alone: their removal hardly ever pays. */
constexpr int MaximumRingSize = 8;

class FlipSearch
{
public:
  /** @param isAnyShapeAllowed whether new tetrahedra may be no Delaunay ones */
  FlipSearch(const FlippableMesh& mesh, bool isAnyShapeAllowed)
    : Mesh(mesh), IsAnyShapeAllowed(isAnyShapeAllowed)
  {
  }

  /** The best flip at the facets and edges of a tetrahedron; without new ones if none improves. */
  Flip FindBest(Id tetrahedron) const;
  /** The removal of an edge, if that is better than the best flip so far. */
  void TryEdge(Id tetrahedron, int edge, Flip& best) const;

private:
  using RingMiddles = std::array<std::array<int, MaximumRingSize>, MaximumRingSize>;

  AngleKey GetSmallestKey(const std::vector<Id>& tetrahedra) const;
  AngleKey Rate(const TetrahedronIds& ids, AngleKey required) const;
  void Keep(Flip& flip, Flip& best) const;
  bool IsOpen(Id tetrahedron, int facet) const;
  void TryFacet(Id tetrahedron, int facet, Flip& best) const;
  bool TriangulateRing(const EdgeRing& ring, RingMiddles& middle) const;

  const FlippableMesh& Mesh;
  const bool IsAnyShapeAllowed;
};
} // namespace cdm

#endif
