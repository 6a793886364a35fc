// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SharpAngles.h
 * @brief Which tetrahedra lie in sharp angles of a surface.
 *
 * Three kinds of input angles are sharp:
 *  - dihedral angles below 60 degrees, between two surface facets at a structural edge;
 *  - plane angles below 30 degrees, between two structural edges at a point;
 *  - tips: angles below 30 degrees between two surface facets that meet at a point but at no edge
 *    there.
 * Where edges have to have empty smallest spheres, the last two are sharp below 60 degrees as well,
 * because each edge is split where the other one is. In a sharp angle, points of one side ask for
 * points of the other side that are closer to the corner, without end. So refinement for shape
 * stops there, and tetrahedra from one side to the other ("across") keep the shape that they have.
 *
 * A face with the plane angle a makes the radius-edge ratio of its tetrahedron at least
 * 1 / (2 sin a), but leaves the dihedral angles free. So slivers are mended where plane angles and
 * tips have 12 degrees or more. Below that nearly all attempts are in vain, and take most of the
 * time.
 *
 * A side is a surface facet (triangles that no structural edge separates), or a structural edge
 * with the edges that go straight on from it. Facets that meet in a tip may be far apart elsewhere:
 * two points are across only if the tip sees them less than the sharp angle apart. Each of two
 * edges with a sharp plane angle casts a shadow on the facets of the other edge that are on its
 * side. The points of the first edge lie in the spheres of triangles there, and are matched by
 * points as close to the other edge (PartnerPoints.h). A point in the shadow and a point of the
 * first edge are across, too.
 *
 * Cost: O(n log n) to build, O(k log k) to follow k changes; O(1) for a tetrahedron. About 76 bytes
 * per triangle.
 */
#ifndef cdmSharpAngles_h
#define cdmSharpAngles_h

#include "Core/Basics/IdLists.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/StructuralEdges.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
/** Degrees: smaller plane angles, and smaller angles at tips, are sharp. */
constexpr double UsualSharpPlaneAngle = 30.0;
/** The same where the smallest spheres of structural edges have to be empty. */
constexpr double SharpPlaneAngleOfEmptySpheres = 60.0;
/** The same for slivers. */
constexpr double SharpPlaneAngleOfSlivers = 12.0;

/** What is left as it is at a sharp angle: a large radius-edge ratio, or a small dihedral angle. */
enum class SharpAngleUse
{
  Shape,
  Sliver
};

class SharpAngles
{
public:
  /**
   * The surface has to outlive the object. pointTriangles lists the triangles at each of its
   * points.
   */
  SharpAngles(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    const IdLists& pointTriangles, double sharpPlaneAngle = UsualSharpPlaneAngle);
  /**
   * Follows splits of the surface, which make no angle sharp: new points lie in facets, or between
   * two points of an edge and on its arms.
   * @param edges those of the surface now, and which of them are new or changed
   * @param triangles those that are new or changed
   * @param parents for each of them one of the surface before in the same surface facet
   */
  void Follow(const std::vector<StructuralEdge>& edges, const std::vector<Id>& changedEdges,
    const std::vector<Id>& triangles, const std::vector<Id>& parents);

  /**
   * Whether one vertex lies on one side of a sharp angle, and another one on the other side. Only
   * the surface's points lie on sides; ids of other points are larger. A tetrahedron that is across
   * for slivers is across for shapes.
   */
  bool IsAcross(const TetrahedronIds& ids, SharpAngleUse use = SharpAngleUse::Shape) const;
  /** How many points, triangles and arms have been looked at so far. */
  std::int64_t GetNumberOfVisits() const { return this->NumberOfVisits; }
  /** The surface facet of each triangle. */
  const std::vector<Id>& GetFacets() const { return this->Facets; }
  /** For each surface facet whether it has a sharp angle, or a sharp plane angle at its edges. */
  std::vector<char> MarkFacets() const;

private:
  /** Smaller plane angles and angles at tips are sharp. */
  struct PlaneLimit
  {
    explicit PlaneLimit(double degrees);

    double Cosine;
    double Sine;
  };

  /**
   * The shadow that an edge casts on a surface facet of another edge with which it makes a sharp
   * plane angle.
   */
  struct Shadow
  {
    Id Facet;
    /** Sine of the plane angle. */
    double Sine;
  };

  /** A structural edge as seen from a corner with a sharp angle. */
  struct Arm
  {
    Id Corner;
    /** Unit vector from the corner. */
    Vec3 Direction;
    std::vector<Shadow> Shadows;
  };

  /** A tip: two surface facets, the smaller one first, and the point at which they meet. */
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
  };

  void FindFacetPairs(const std::vector<StructuralEdge>& edges, const std::vector<EdgeUse>& uses);
  void FindTips(const IdLists& pointTriangles, const IdLists& neighbors);
  void FindTipsAt(Id corner, const IdLists::Range& triangles, const IdLists::Range& ends);
  void ListFacets(const IdLists& pointTriangles);
  void FollowFacets(const std::vector<Id>& triangles);
  void FollowArms(const std::vector<StructuralEdge>& edges, const std::vector<Id>& changedEdges);
  std::vector<Id> ListArmsAt(Id point) const;
  void FindArms(const IdLists& pointTriangles, const IdLists& neighbors);
  void FindShadows(Id corner, Id first, Id other, const IdLists::Range& triangles,
    std::vector<Shadow>& shadows) const;
  bool AreAcrossFacets(Id p, Id q, const PlaneLimit& limit) const;
  bool AreAcrossTip(Id facet, Id largerFacet, Id p, Id q, const PlaneLimit& limit) const;
  bool AreAcrossArms(Id p, Id q, const PlaneLimit& limit) const;
  bool IsInShadow(Id armPoint, Id point, const PlaneLimit& limit) const;

  const TriangleMesh& Surface;
  const PlaneLimit ForShapes;
  const PlaneLimit ForSlivers;
  /** The surface facet of each triangle. */
  std::vector<Id> Facets;
  /** Whether a surface facet has a sharp angle; one for each triangle of the first surface. */
  std::vector<char> IsFacetSharp;
  /** Surface facets at each point; facets without a sharp angle are left out. */
  IdLists PointFacets;
  /** Pairs of facets with a sharp angle at an edge: the larger ones, for the smaller one. */
  IdLists Partners;
  /** Sorted; and which of them each facet has as the smaller one. */
  std::vector<Tip> Tips;
  IdLists FacetTips;
  /** By their corners. */
  std::vector<Arm> Arms;
  /** Arms that each point lies on. A corner is listed only on arms of other corners. */
  IdLists PointArms;
  std::int64_t NumberOfVisits = 0;
};
} // namespace cdm

#endif
