// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetApex.h
 * @brief Finds the fourth point of the Delaunay tetrahedron in front of a facet, among a few points.
 *
 * Method: the points in front of the facet are taken one by one; a point in the sphere through the
 * facet and the best point so far is better (gift wrapping). Spheres are kept relative to the
 * facet's first point, so that a point costs some twenty operations.
 *
 * Exact; points on one sphere are told apart by the pulling rule of their numbers. Cost: 10
 * nanoseconds for each of the points.
 *
 * Reference: D. R. Chand, S. S. Kapur, "An algorithm for convex polytopes", 1970,
 * doi:10.1145/321556.321564 (gift wrapping).
 */
#ifndef cdmFacetApex_h
#define cdmFacetApex_h

#include "Core/Basics/RawVector.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
class FacetApex
{
public:
  /**
   * Both have to outlive the object.
   * @param numbers of the points, for the pulling rule
   */
  FacetApex(const RawVector<Vec3>& points, const std::vector<Id>& numbers)
    : Points(points), Numbers(numbers)
  {
  }

  /**
   * The point that makes a Delaunay tetrahedron with the facet, in front of it; points are indices.
   * NoId if there is none.
   * @param isFacet whether the facet is known to be one of a Delaunay tetrahedron of the points; if
   *   not, this is found out
   */
  Id Find(const TriangleIds& facet, bool isFacet);

private:
  struct Sphere;
  bool IsInsideExactly(const TriangleIds& facet, Id apex, Id point) const;

  const RawVector<Vec3>& Points;
  const std::vector<Id>& Numbers;
  /** Points that are not in front of the facet. */
  std::vector<Id> Others;
};
} // namespace cdm

#endif
