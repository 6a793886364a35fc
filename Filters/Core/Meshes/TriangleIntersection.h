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
 *  3. otherwise: where neither has a vertex in the other's plane, two signs tell whether their
 *     pieces of the line in which the planes meet overlap; else an edge of one pierces or touches
 *     the other, or, coplanar, no line along an edge separates them.
 *
 * Pairs are searched in a tree of boxes (BoxTree.h).
 *
 * Inputs: triangles are given by point ids; equal ids are common vertices, and different ids have
 * to have different coordinates. No triangle may be degenerate.
 *
 * Reference: P. Guigue, O. Devillers, "Fast and robust triangle-triangle overlap test using
 * orientation predicates", Journal of Graphics Tools 8 (1), 2003 (the two signs).
 */
#ifndef cdmTriangleIntersection_h
#define cdmTriangleIntersection_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <cstddef>
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

/** Whether all vertices of t lie in the plane of s. */
bool AreCoplanar(const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t);

/**
 * The axis nearest to the normal of the triangle along which its projection has an area; sign: the
 * orientation of the projection.
 */
int FindProjectionAxis(const Vec3& a, const Vec3& b, const Vec3& c, int& sign);

/** Whether two segments, projected along an axis, cross in inner points of both. */
bool DoProjectedSegmentsCross(int axis, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/**
 * A common point of two triangles: a vertex of one that lies in the other one; an edge (number i
 * runs from vertex i to the next one) that pierces the other one; or, for coplanar triangles, two
 * edges that cross.
 */
struct ContactPoint
{
  /** 0 or 1: the triangle that Vertex or Edge belongs to. 0 for two edges. */
  int Triangle = 0;
  /** 0 to 2, or -1. */
  int Vertex = -1;
  int Edge = -1;
  /** For two edges that of triangle 1, else -1. */
  int OtherEdge = -1;
};
using ContactPoints = std::vector<ContactPoint>;

/**
 * The corners of what two triangles of contact Intersection have in common: a point, the ends of a
 * segment, or the corners of a polygon, not in order. The same point may be found more than once.
 * asCoplanar: in the projection along an axis, for triangles that are coplanar or almost.
 */
ContactPoints FindContactPoints(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t, bool asCoplanar);

/**
 * A segment (or point: begin == end) where two triangles of contact Intersection have common
 * points, to be shown: for triangles that cross all of it, for coplanar ones the longest found.
 * Rounded.
 */
void FindIntersectionSegment(const std::vector<Vec3>& points, const TriangleIds& s,
  const TriangleIds& t, Vec3& begin, Vec3& end);

/** Two triangles, the smaller id first. */
using TrianglePair = std::array<Id, 2>;

/** Guard against quadratic output: FindIntersectingPairs stops after about so many. */
constexpr std::size_t MaximumNumberOfPairs = 1000000;

/**
 * All pairs of contact Intersection, ascending. active: empty, or for each triangle whether pairs
 * with it are wanted. False if the context asks to stop. Cost: O(n log n) for bounded overlap.
 */
bool FindIntersectingPairs(const std::vector<Vec3>& points,
  const std::vector<TriangleIds>& triangles, const std::vector<char>& active,
  const ExecutionContext& context, std::vector<TrianglePair>& pairs);
} // namespace cdm

#endif
