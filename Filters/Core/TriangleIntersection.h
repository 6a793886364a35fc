// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleIntersection.h
 * @brief How do two triangles meet? Decided exactly.
 *
 * Method: the signs of the vertices of each triangle relative to the plane of the other one settle
 * almost all pairs. The rest is decided by
 *  1. common edge: coplanar, and the third vertices on the same side of the edge;
 *  2. common vertex: the two cones of directions at it have a direction in common (by convexity
 *     the triangles then share a segment that starts in the vertex);
 *  3. otherwise: an edge of one pierces or touches the other, or, coplanar, two edges meet or a
 *     vertex lies inside.
 *
 * Inputs: triangles are given by point ids; equal ids are common vertices, and different ids have to
 * have different coordinates. No triangle may be degenerate.
 */
#ifndef cdmTriangleIntersection_h
#define cdmTriangleIntersection_h

#include "Types.h"
#include "Vec3.h"

#include <vector>

namespace cdm
{
enum class TriangleContact : unsigned char
{
  /** No common point. */
  Disjoint,
  /** Nothing but one common vertex. */
  CommonVertex,
  /** Nothing but one common edge. */
  CommonEdge,
  /** They cross, overlap or touch in any other way; the same three vertices count too. */
  Intersection
};

TriangleContact ClassifyTriangles(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t);

/**
 * A segment (or point: begin == end) where two triangles of contact Intersection have common
 * points, to be shown: for triangles that cross all of it, for coplanar ones the longest found.
 * Rounded.
 */
void FindIntersectionSegment(const std::vector<Vec3>& points, const TriangleIds& s,
  const TriangleIds& t, Vec3& begin, Vec3& end);
} // namespace cdm

#endif
