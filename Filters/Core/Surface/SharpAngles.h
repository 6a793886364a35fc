// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SharpAngles.h
 * @brief Which tetrahedra lie in sharp angles of a surface.
 *
 * Sharp are dihedral angles below 60 degrees between two facets at a structural edge, and below 30
 * degrees plane angles between two structural edges at a point, and angles between two facets that
 * come together at a point, but not at an edge there. Where edges have to have empty smallest
 * spheres, these two are sharp below 60 degrees as well: each edge is split where the other one is.
 * In sharp angles, points of one side ask for points of the other side, closer to the corner and so
 * without end: refinement for shape has to stop there, and the tetrahedra from one side to the
 * other keep the shape that they have.
 *
 * A side is a facet (triangles that no structural edge separates), or a structural edge with the
 * edges that go straight on from it. Facets that come together at a point may be far apart
 * elsewhere: only what the point sees less than that angle apart is across. Of two edges with a
 * sharp plane angle, each casts a shadow on the facets of the other one that are on its side: its
 * points are in the spheres of triangles there, and are matched by points as close to the other
 * edge (PartnerPoints.h). Those and the points of that edge are across, too.
 *
 * Cost: O(n log n) to build; O(1) for a tetrahedron. About 60 bytes per triangle.
 */
#ifndef cdmSharpAngles_h
#define cdmSharpAngles_h

#include "Core/Basics/IdLists.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/StructuralEdges.h"

#include <utility>
#include <vector>

namespace cdm
{
/** Degrees; plane angles below are sharp. */
constexpr double UsualSharpPlaneAngle = 30.0;
/** Where the smallest spheres of structural edges have to be empty. */
constexpr double SharpPlaneAngleOfEmptySpheres = 60.0;

class SharpAngles
{
public:
  /** Triangles at each point of the surface, which outlives the object. */
  SharpAngles(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    const IdLists& pointTriangles, double sharpPlaneAngle = UsualSharpPlaneAngle);
  /**
   * Of the same surface after some triangles have been split: points have been added, the others
   * are where they were. To find all angles again was a sixth of the time of many small rounds.
   * @param parents of each triangle, one that was in its facet before
   */
  SharpAngles(SharpAngles&& coarse, const std::vector<StructuralEdge>& edges,
    const IdLists& pointTriangles, const std::vector<Id>& parents);

  /** Whether a vertex is the corner of a sharp angle, or lies on its edge. */
  bool IsAtCorner(const TetrahedronIds& ids) const;
  /**
   * Whether one vertex lies on one side of a sharp angle, and another one on the other side. Only
   * the surface's points lie on sides; ids of other points are larger.
   */
  bool IsAcross(const TetrahedronIds& ids) const;

private:
  /** Of an edge that makes a sharp plane angle with another one, on a facet of that one. */
  struct Shadow
  {
    Id Facet;
    /** Of the angle. */
    double Sine;
  };

  /** A structural edge as seen from a corner with a sharp angle. */
  struct Arm
  {
    Id Corner;
    /** From the corner, of length one. */
    Vec3 Direction;
    std::vector<Shadow> Shadows;
  };

  /** Two facets, the smaller one first, and a point at which they come together. */
  struct Tip
  {
    std::pair<Id, Id> Facets;
    Id Point;

    friend bool operator==(const Tip& a, const Tip& b)
    {
      return a.Facets == b.Facets && a.Point == b.Point;
    }
    friend bool operator<(const Tip& a, const Tip& b)
    {
      return a.Facets != b.Facets ? a.Facets < b.Facets : a.Point < b.Point;
    }
    friend bool operator<(const Tip& a, const std::pair<Id, Id>& b) { return a.Facets < b; }
    friend bool operator<(const std::pair<Id, Id>& a, const Tip& b) { return a < b.Facets; }
  };

  void FindFacetPairs(const std::vector<StructuralEdge>& edges, const std::vector<EdgeUse>& uses);
  void FindTips(const IdLists& pointTriangles);
  void FindTipsAt(Id corner, const IdLists::Range& triangles);
  void MarkSharpEdges(const std::vector<StructuralEdge>& edges);
  void ListFacets(const IdLists& pointTriangles);
  void FindArms(const IdLists& pointTriangles);
  void FindShadows(Id corner, Id first, Id other, const IdLists::Range& triangles,
    std::vector<Shadow>& shadows) const;
  bool AreAcrossFacets(Id p, Id q) const;
  bool AreAcrossTip(const std::pair<Id, Id>& facets, Id p, Id q) const;
  bool AreAcrossArms(Id p, Id q) const;
  bool IsInShadow(Id armPoint, Id point) const;

  const TriangleMesh& Surface;
  const double SharpPlaneCosine;
  /** Other ends of the structural edges at each point. */
  IdLists Neighbors;
  /** Of each triangle. */
  std::vector<Id> Facets;
  /** One for each point of the surface. */
  std::vector<char> IsCorner;
  /** Of each point; those without a sharp angle are left out. */
  IdLists PointFacets;
  /** Pairs of facets with a sharp angle, the smaller one first; sorted. */
  std::vector<std::pair<Id, Id>> FacetPairs;
  /** Sorted. */
  std::vector<Tip> Tips;
  std::vector<Arm> Arms;
  /** Of each point, but of corners only if it lies on the arm of another one. */
  IdLists PointArms;
};
} // namespace cdm

#endif
