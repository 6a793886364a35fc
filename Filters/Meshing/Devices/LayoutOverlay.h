// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LayoutOverlay.h
 * @brief Overlays the polygons of all masks of a layout into one planar subdivision.
 *
 * Method (thesis 4.2.1, Fig. 4.3): the polygons, pressed onto the plane z = 0, go through stage 0,
 * which triangulates them and splits triangles that cross or overlap along each other; each of the
 * pieces then lies in a polygon as a whole or not at all, which the exact position of its middle
 * tells.
 *
 * Guarantees: pieces do not overlap and share all vertices on their common border; vertices of the
 * input keep their coordinates, unless two are nearer to each other than rounding. Deterministic.
 * Failure: that of stage 0, with the cells of the input.
 * Cost: O(n log n) for the pieces; n times m for n pieces and m polygons, where bounds overlap.
 */
#ifndef cdmLayoutOverlay_h
#define cdmLayoutOverlay_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/PolygonSoup.h"

#include <vector>

namespace cdm
{
struct LayoutOverlay
{
  /** Points in the plane z = 0; some may be unused. */
  std::vector<Vec3> Points;
  std::vector<TriangleIds> Pieces;
  /** For each piece the polygons that it lies in, ascending. */
  std::vector<std::vector<Id>> Polygons;
};

/** The z of the polygons does not matter. */
Status OverlayPolygons(
  PolygonSoup polygons, const ExecutionContext& context, LayoutOverlay& output);
} // namespace cdm

#endif
