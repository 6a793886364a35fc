// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TJunctions.h
 * @brief Splits edges of polygons at the vertices that lie on them (thesis Fig. 3.16).
 *
 * Method: vertices are looked up in a tree of the edges' boxes (BoxTree.h). With a tolerance of
 * zero a vertex lies on an edge if the three points are collinear, exactly.
 *
 * Guarantees: all polygons at an edge get the same vertices on it. Deterministic.
 * Cost: O(n log n) for n edges of bounded overlap.
 */
#ifndef cdmTJunctions_h
#define cdmTJunctions_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Vec3.h"
#include "Core/Meshes/PolygonOutlines.h"

#include <vector>

namespace cdm
{
/** A vertex that lies on an edge of a polygon. */
struct TJunction
{
  /** The cell of the polygon at the edge. */
  Id Cell = NoId;
  Id Vertex = NoId;
};

/**
 * Puts the vertices on edges between the ends of these, and appends what was found to junctions;
 * false if aborted.
 * @param tolerance a vertex closer than this to an edge lies on it; model units, range >= 0
 */
bool SplitEdgesAtVertices(const std::vector<Vec3>& points, double tolerance,
  const ExecutionContext& context, PolygonOutlines& polygons, std::vector<TJunction>& junctions);
} // namespace cdm

#endif
