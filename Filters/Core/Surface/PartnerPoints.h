// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartnerPoints.h
 * @brief Where a new point goes so that it and the point that disturbs leave each other alone.
 *
 * A point that disturbs an edge or a triangle is answered by its partner there (thesis 5.2.2, types
 * P and R; Filters/Core/README.md has the proofs): two features never disturb each other for ever.
 *
 *  1. On an edge: the point as far from the common perpendicular of the disturbing point's edge and
 *     this one; for edges with a corner in common that is a rotation about it (type R), for
 *     parallel ones a projection (type P). Without an edge the point's projection; near an acute
 *     corner a power of two of the unit of length, so that all edges there end up alike; otherwise
 *     the middle.
 *  2. In a facet: the disturbing point is rotated about the edge that the two facets share, or
 *     about a corner that they share, or projected along the normal, in this order.
 *  3. The last digits are chosen so that the two match exactly (MatchingPoints.h).
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
/** Which places for new points are tried; surfaces that one does not end on may need the other. */
enum class MatchingRules : char
{
  /** Feet on edges, projections in facets: fewest points where sheets and edges are few. */
  Usual,
  /**
   * For bodies that touch in corners and edges: what matches a point is as far from a common corner
   * as it is, and mirrored at the plane between two facets.
   */
  Corners,
  /**
   * For stacks of sheets that are much closer to each other than their triangles are wide. Edges
   * that pass each other are split where they do; points that match those of several sheets keep
   * away from each other; around corners new points in facets keep to the distances that there are.
   */
  ThinLayers
};

class PartnerPoints
{
public:
  /** All are shared with the caller, who may append to them. Diagonal: of the bounding box. */
  PartnerPoints(const RefinableSurface& surface, SurfaceIncidences& incidences,
    const std::vector<Vec3>& points, const PointOctree& octree, double diagonal,
    MatchingRules rules)
    : Surface(surface), Incidences(incidences), Points(points), Octree(octree), Diagonal(diagonal),
      Rules(rules)
  {
  }

  /**
   * Where to split a segment that a point disturbs; NoId: that has to be split for other reasons.
   */
  Vec3 PlaceOnSegment(Id segment, Id disturbing) const;

  /** The partner in the plane of a triangle, maybe beyond its facet. False if there is none. */
  bool PlaceInFacet(Id triangle, Id disturbing, Vec3& target) const;

  /**
   * Moves a point in the plane of a triangle by rounding errors, so that it matches the disturbing
   * point exactly. Radius: of the circumcircle of the triangle that is refined.
   */
  Vec3 MatchAcross(Id triangle, Id disturbing, const Vec3& position, double radius) const;

private:
  bool PlaceOnLine(Id segment, Id disturbing, double& way, Vec3& along, double& passing) const;
  bool RotateToSegment(Id segment, Id disturbing, double& way) const;
  Vec3 GetNormalAt(Id point) const;
  bool RotateAboutEdge(Id triangle, Id disturbing, Vec3& target) const;
  bool RotateAboutCorner(Id triangle, Id disturbing, Vec3& target) const;
  bool Project(Id triangle, Id disturbing, Vec3& target) const;

  const RefinableSurface& Surface;
  SurfaceIncidences& Incidences;
  const std::vector<Vec3>& Points;
  const PointOctree& Octree;
  double Diagonal;
  MatchingRules Rules;
};
} // namespace cdm

#endif
