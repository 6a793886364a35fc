// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegionVolumes.h
 * @brief Finds regions whose volume the refinement of their surface has changed.
 *
 * Plane facets whose points a file has rounded are divided anew (FlatFacets.h), and the surface
 * moves by as much as the points are off their plane. In a thin or small region that may be a
 * larger part of its volume than one allows.
 *
 * Method: the volume of a region is the sum over the triangles of its boundary. Each triangle of
 * the surface before looks to the same side as the boundary triangles that come from it.
 *
 * Guarantees: sums in extended precision. Cost: O(n).
 */
#ifndef cdmRegionVolumes_h
#define cdmRegionVolumes_h

#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/**
 * The triangles of the surface before that bound a region whose volume differs by more than a ratio
 * of it, ascending.
 * @param boundary has labels; its source cells are triangles of the surface before. Those that come
 *        from none close the surface, before as well.
 */
std::vector<Id> FindChangedRegions(
  const TriangleMesh& before, const TriangleMesh& boundary, double ratio);
} // namespace cdm

#endif
