// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartConflicts.h
 * @brief Questions of parts to each other about conflicts, and the exact answers.
 *
 * A point is in conflict with a tetrahedron if it lies in its pulled circumsphere
 * (PulledSphere.h), and with a facet of the hull if it lies beyond it, or in its plane and in the
 * pulled circumsphere of its tetrahedron.
 */
#ifndef cdmPartConflicts_h
#define cdmPartConflicts_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Delaunay/PartPoints.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdm
{
/**
 * A question to other parts: which points are in conflict with a tetrahedron, or lie beyond a facet
 * of the hull?
 */
struct ConflictQuery
{
  /**
   * Vertices of a positive tetrahedron. Or those of a facet, counter-clockwise seen from outside,
   * and the apex of its tetrahedron, which decides about points in the plane of the facet.
   */
  std::array<Vec3, 4> Vertices;
  std::array<std::int64_t, 4> Numbers;
  std::int32_t IsFacet = 0;
  /** The vertex that the answers should be near to. */
  std::int32_t Center = 0;
};

struct ConflictAnswers
{
  /** For each query: not 0 if there is a point in conflict. */
  std::vector<char> HasConflict;
  /** Points in conflict: a few for each query, each point once. */
  std::vector<NumberedPoint> Points;
};

/** The exact answer to a query, for one point. */
bool IsInConflict(const ConflictQuery& query, const NumberedPoint& point);

/** The other parts that may have points in conflict. */
std::vector<std::size_t> FindPartsInConflict(
  const ConflictQuery& query, const std::vector<PartPoints::OtherPart>& others);

/**
 * Own points in conflict, up to a number of them that are nearest to the center of the query.
 * @param numberOfTests is increased by the number of points tested
 */
std::vector<Id> FindOwnConflicts(const ConflictQuery& query, const PartPoints& points,
  std::size_t limit, std::size_t& numberOfTests);
} // namespace cdm

#endif
