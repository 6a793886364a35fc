// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetWalk.h
 * @brief Finds where to insert a point in a surface facet, and which edge it would encroach on.
 *
 * Method (thesis 6.3, "Locate Triangle"): walks from triangle to triangle, always across the edge
 * that faces the target most. The walk ends in the triangle above or below the target, or at a
 * structural edge. In plane facets it ends at the target itself.
 *
 * Floating point; only spheres are tested exactly. Deterministic. Cost: one step for each triangle
 * on the way.
 */
#ifndef cdmFacetWalk_h
#define cdmFacetWalk_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Search/PointOctree.h"
#include "Core/Surface/PartnerPoints.h"
#include "Core/Surface/RefinableSurface.h"

#include <vector>

namespace cdm
{
class FacetWalk
{
public:
  /**
   * All arguments have to outlive the object.
   * @param diagonal of the surface
   */
  FacetWalk(const RefinableSurface& surface, const PartnerPoints& partners,
    const std::vector<Vec3>& points, const PointOctree& octree, double diagonal)
    : Surface(surface), Partners(partners), Points(points), Octree(octree), Diagonal(diagonal)
  {
  }

  /**
   * Where a walk ends: at a position inside of a triangle or on one of its edges (0 to 2), or at a
   * segment.
   */
  struct Landing
  {
    Id Triangle = NoId;
    Id Edge = NoId;
    Vec3 Position;
    Id Segment = NoId;
  };

  /**
   * Walks from a triangle to a target in its facet. False if the walk does not arrive, as may
   * happen on curved facets.
   * @param mirrored the point that the target is to match, or NoId
   */
  bool Run(Id triangle, Id mirrored, const Vec3& target, Landing& landing) const;

  /**
   * A segment on which a position would encroach. Looks only at edges of the triangles that a point
   * there would replace: those whose smallest spheres hold the position, connected to the given
   * one.
   */
  Id FindEncroachedSegment(Id triangle, const Vec3& position);

private:
  Vec3 PutIntoPlane(Id triangle, const Vec3& position, const Vec3& normal) const;

  const RefinableSurface& Surface;
  const PartnerPoints& Partners;
  const std::vector<Vec3>& Points;
  const PointOctree& Octree;
  const double Diagonal;
  /** Marks of FindEncroachedSegment(), all zero outside of it. */
  std::vector<char> IsInCavity;
};
} // namespace cdm

#endif
