// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PolygonTriangulation.h
 * @brief Triangulates one polygon, exactly.
 *
 * Method (thesis 6.3, recursive splitting):
 *  1. project along the axis of the largest component of the polygon's normal; all signs below are
 *     those of the projection, exact. If the outline crosses itself there (which a polygon that is
 *     far from planar may do), the other axes are tried, in the order of the components;
 *  2. split off the ear (a triangle at a convex vertex that holds no other vertex, neither inside
 *     nor on its new edge) with the largest smallest angle until one triangle is left;
 *  3. flip diagonals where that makes the opposite angles smaller (Delaunay) and both new triangles
 *     are positive. A quadrilateral gets its shorter diagonal instead.
 *
 * Why the result is right: the triangles are all strictly positive and have the outline as their
 * boundary, so at each point of the plane they add up to the winding number of the outline: once
 * inside and not at all outside, if the outline does not cross itself.
 *
 * Outlines may be non-convex, have vertices of 180 degrees (which become corners of triangles),
 * visit an edge twice (holes bridged to the outline) or a vertex (lobes that touch each other,
 * holes that touch the outline). Spikes (a, b, a) that stick out are cut off. The triangles are
 * oriented like the polygon, never degenerate, and deterministic.
 *
 * Cost: O(n^2) for n vertices.
 */
#ifndef cdmPolygonTriangulation_h
#define cdmPolygonTriangulation_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
enum class PolygonTriangulationResult : unsigned char
{
  Ok,
  /** Less than three vertices, all on one line, or nothing but spikes: no area. */
  Degenerate,
  /** The outline crosses itself. */
  Invalid
};

/**
 * Appends the triangles of the polygon, whose vertices are ids of points. Equal ids are the same
 * vertex visited again; different ids need different coordinates, and consecutive ids differ.
 */
PolygonTriangulationResult TriangulatePolygon(const std::vector<Vec3>& points,
  const std::vector<Id>& polygon, std::vector<TriangleIds>& triangles);

/** Whether all vertices of a polygon lie on one line, exactly. */
bool IsPolygonCollinear(const std::vector<Vec3>& points, const std::vector<Id>& polygon);

/**
 * Largest distance of a vertex from the polygon's mean plane (Newell), as a ratio of the largest
 * extent of the polygon. Rounded.
 */
double GetPolygonNonPlanarityRatio(const std::vector<Vec3>& points, const std::vector<Id>& polygon);
} // namespace cdm

#endif
