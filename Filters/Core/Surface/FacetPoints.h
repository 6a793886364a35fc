// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetPoints.h
 * @brief Which points the surface facets of a surface share.
 *
 * Cost: O(n log n) to build for n triangles; a query takes the shared points of the facet that has
 * fewer of them.
 */
#ifndef cdmFacetPoints_h
#define cdmFacetPoints_h

#include "Core/Basics/IdLists.h"
#include "Core/Basics/Types.h"

#include <vector>

namespace cdm
{
struct FacetPoints
{
  /** @param facets the surface facet of each triangle, as from NumberFacets() */
  FacetPoints(
    Id numberOfPoints, const std::vector<TriangleIds>& triangles, const std::vector<Id>& facets);

  /** Whether two facets have no common point. */
  bool AreDisjoint(Id first, Id second) const;

  /** Facets at each point. */
  IdLists PointFacets;
  /** Points of each facet that it shares with others. */
  IdLists SharedPoints;
};
} // namespace cdm

#endif
