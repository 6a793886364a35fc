// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartnerPoints.h
 * @brief Partner points: where to split an encroached edge or facet so that refinement ends.
 *
 * A point that encroaches on an edge or a triangle is answered by its partner there (thesis 6.3,
 * types P and R). Neither of the two encroaches on the pieces that end at the other, so two
 * features cannot keep encroaching on each other. Filters/Core/README.md has the proofs. The
 * thesis calls the encroaching point the disturbing one.
 *
 *  1. Partner on an edge: the point as far from the common perpendicular as the encroaching point
 *     is on its own edge. If the edges have a common corner, this is a rotation about it (type R);
 *     if they are parallel, a projection (type P). If the encroaching point lies on no edge, its
 *     projection is taken. Edges split for no point are split near an acute corner at a power of
 *     two of the unit of length (concentric shells), so that all edges there end up alike;
 *     otherwise in the middle.
 *  2. Partner in a facet: the encroaching point is rotated about the nearest edge that the two
 *     facets share, or mirrored between the two planes if they share a corner (rotated about that
 *     if the planes are steep or the point is one of an edge), or projected along the normal, in
 *     this order. In stacks it is always mirrored, wherever the planes meet.
 *  3. The last bits are chosen so that the two points match exactly (MatchingPoints.h).
 *
 * Cost: constant, but for the search of shared edges and corners.
 */
#ifndef cdmPartnerPoints_h
#define cdmPartnerPoints_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Search/PointOctree.h"
#include "Core/Surface/RefinableSurface.h"
#include "Core/Surface/SurfaceIncidences.h"

#include <vector>

namespace cdm
{
/**
 * Which positions for new points are tried. A surface on which one set of rules does not end may
 * need another.
 */
enum class MatchingRules : char
{
  /** Feet on edges, projections in facets: fewest points where sheets and edges are few. */
  Usual,
  /**
   * For bodies that touch in corners and edges. A partner on an edge, too, is as far from a common
   * corner as the encroaching point in a facet.
   */
  Corners,
  /**
   * For stacks of sheets that are much closer to each other than their triangles are wide. Edges
   * that pass each other are split where they do. Partners keep away from points that match those
   * of other sheets. Around corners, new points in facets keep to the distances that are there
   * already.
   */
  ThinLayers,
  /**
   * The rules for thin layers, for stacks of many sheets, some of them narrow. A point of an edge
   * is matched for all facets there. A new point in a facet gives way to edges that pass above or
   * below. Edges are only then made to have empty diametral spheres when all triangles have.
   */
  Stacks
};

/** Whether the rules are those for thin layers, or more. */
inline bool AreForLayers(MatchingRules rules)
{
  return rules == MatchingRules::ThinLayers || rules == MatchingRules::Stacks;
}

class PartnerPoints
{
public:
  /**
   * All arguments are shared with the caller, who may append to them. Diagonal: of the bounding
   * box.
   */
  PartnerPoints(const RefinableSurface& surface, SurfaceIncidences& incidences,
    const std::vector<Vec3>& points, const PointOctree& octree, double diagonal,
    MatchingRules rules)
    : Surface(surface), Incidences(incidences), Points(points), Octree(octree), Diagonal(diagonal),
      Rules(rules)
  {
  }

  /**
   * Where to split a segment on which a point encroaches; NoId: the segment is split for another
   * reason.
   */
  Vec3 PlaceOnSegment(Id segment, Id encroaching) const;

  /**
   * The partner in the plane of a triangle, which may lie beyond its facet. False if there is none.
   */
  bool PlaceInFacet(Id triangle, Id encroaching, Vec3& target) const;

  /**
   * Moves a point in the plane of a triangle by rounding errors, so that it matches the encroaching
   * point exactly. Radius: of the circumcircle of the triangle that is refined.
   */
  Vec3 MatchAcross(Id triangle, Id encroaching, const Vec3& position, double radius) const;

private:
  bool PlaceOnLine(Id segment, Id encroaching, double& way, Vec3& along, double& passing) const;
  bool RotateToSegment(Id segment, Id encroaching, double& way) const;
  Vec3 GetNormalAt(Id point) const;
  bool RotateAboutEdge(Id triangle, Id encroaching, Vec3& target) const;
  bool RotateAboutCorner(Id triangle, Id encroaching, Vec3& target) const;
  bool Project(Id triangle, Id encroaching, Vec3& target) const;
  bool MirrorInStack(Id triangle, Id encroaching, Vec3& target) const;

  const RefinableSurface& Surface;
  SurfaceIncidences& Incidences;
  const std::vector<Vec3>& Points;
  const PointOctree& Octree;
  double Diagonal;
  MatchingRules Rules;
};
} // namespace cdm

#endif
