// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetWalk.h
 * @brief Where in a facet a point is to be put that a triangle needs, and what would be in its way.
 *
 * Method (thesis 6.3, "Locate Triangle"): from triangle to triangle, always over the edge that
 * faces the target most, to the triangle above or below the target, or to a structural edge. In
 * plane facets that is the way to the target itself.
 *
 * Floating point, but for spheres. Deterministic. Cost: one step for each triangle on the way.
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
  /** All have to outlive the object. @param diagonal of the surface */
  FacetWalk(const RefinableSurface& surface, const PartnerPoints& partners,
    const std::vector<Vec3>& points, const PointOctree& octree, double diagonal)
    : Surface(surface), Partners(partners), Points(points), Octree(octree), Diagonal(diagonal)
  {
  }

  /** At a position in or on an edge (0 to 2) of a triangle, or at a segment. */
  struct Landing
  {
    Id Triangle = NoId;
    Id Edge = NoId;
    Vec3 Position;
    Id Segment = NoId;
  };

  /**
   * From a triangle to a target in its facet. False if that leads nowhere, as it may on curved
   * facets.
   * @param mirrored the point that the target is to match, or NoId
   */
  bool Run(Id triangle, Id mirrored, const Vec3& target, Landing& landing) const;

  /**
   * A segment whose diametral sphere holds a position, among those around the triangles whose
   * smallest spheres hold it, too, from one of them: these are the triangles that a point there
   * would replace.
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
