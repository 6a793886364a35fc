// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GapPatches.h
 * @brief Traces the open edges of a surface into rings, and patches those of a few edges.
 *
 * Method:
 *  1. follow open edges to closed chains, cut where they come back to a vertex; a patch runs along
 *     an edge against the triangle that is there. Dead ends belong to no ring;
 *  2. triangulate the ring (PolygonTriangulation.h);
 *  3. give it up if a triangle of it would meet the surface or an earlier patch other than in a
 *     common edge or vertex, exactly (TriangleIntersection.h).
 *
 * Inputs: triangles without repeated points.
 * Guarantees: Deterministic; points stay as they are.
 * Cost: O(n log n) for n triangles of bounded overlap, and quadratic in the triangles of all
 * patches.
 */
#ifndef cdmGapPatches_h
#define cdmGapPatches_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
struct GapPatchOptions
{
  /** Rings of at most this many edges are patched. Less than 3: none. */
  Id MaximumEdges = 0;
  /** A patch may cross the surface, but not lie in it. */
  bool CanCross = false;
};

/** An edge with one triangle; Points ascend. */
struct OpenEdge
{
  EdgeIds Points;
  Id Triangle;
  /** The triangle runs from Points[0] to Points[1]. */
  bool IsForward;
};

struct GapPatch
{
  std::vector<TriangleIds> Triangles;
  /** The ring of edges around it. */
  std::vector<OpenEdge> Edges;
  /** Triangle of the surface at the first of these edges. */
  Id Neighbor = NoId;
};

/** False if aborted. */
bool FindGapPatches(const std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
  const GapPatchOptions& options, const ExecutionContext& context, std::vector<GapPatch>& patches);
} // namespace cdm

#endif
