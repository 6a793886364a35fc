// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartSimplices.h
 * @brief The tetrahedra of points that one part knows, and the facets of their hull.
 */
#ifndef cdmPartSimplices_h
#define cdmPartSimplices_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Types.h"
#include "Core/Delaunay/PartPoints.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace cdm
{
/** Tetrahedra or queries between two calls of the context: each may have to look at many points. */
constexpr std::size_t PartReportInterval = 64;
constexpr const char* PartActivity = "Completing the tetrahedra between parts";

/**
 * A tetrahedron, or a facet of the hull, which faces outside, and the apex of its tetrahedron. Ids
 * are indices into the points of the part.
 */
struct PartSimplex
{
  TetrahedronIds Ids;
  bool IsFacet = false;

  /** Number of ids that it consists of. */
  int GetSize() const { return this->IsFacet ? 3 : 4; }
};

/**
 * Tetrahedralizes points of a part by the pulling rule.
 * @param chosen the points that take part
 * @param visit is called with each tetrahedron and facet of the hull, until it returns false
 */
Status VisitPartSimplices(const PartPoints& points, std::vector<Id> chosen,
  const ExecutionContext& context, const std::function<bool(const PartSimplex&)>& visit);
} // namespace cdm

#endif
