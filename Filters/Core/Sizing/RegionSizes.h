// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegionSizes.h
 * @brief Longest edges of single regions, and how fast edges may grow away from them.
 *
 * The longest edge at a position p is the smallest h_r + g d_r(p) of all regions r with a size h_r:
 * d_r is the distance of p from the region, 0 in it and on its boundary, and g the growth. Of all
 * functions that are nowhere above a region's size and have no slope above g this is the largest
 * one, as in eq. 1 of Persson.
 *
 * Inputs: a clean surface (TriangleMesh.h), closed; without labels the enclosed regions have the
 * numbers that the tetrahedralizer gives them (RegionLocator.h).
 * Guarantees: exact but for rounding. Thread safe.
 * Failure: InvalidOption for sizes and growths that are not positive, and for regions that are not
 * there; as RegionLocator.h for a surface that is not closed.
 * Cost: O(n log n) to build; a query locates the position, and then looks for those regions only
 * that are near enough to matter.
 * References: P.-O. Persson, "Mesh size functions for implicit geometries and PDE-based gradient
 * limiting", 2006, doi:10.1007/s00366-006-0014-1.
 */
#ifndef cdmRegionSizes_h
#define cdmRegionSizes_h

#include "Core/Basics/Status.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Sizing/SizingField.h"

#include <vector>

namespace cdm
{
struct RegionSize
{
  Id Region = 0;
  /** The longest edge, in model units; > 0. The smallest of several for a region counts. */
  double Length = 0.0;
};

struct RegionSizesOptions
{
  std::vector<RegionSize> Sizes;
  /** How much longer edges may be for each unit of distance. > 0. */
  double Growth = 0.3;
};

/**
 * Lowers the field to the sizes; no field becomes one.
 * @param largest the longest edge where the regions' sizes do not matter, model units; 0: as long
 *   as the surface's bounding box
 */
Status LimitByRegions(const TriangleMesh& surface, const RegionSizesOptions& options,
  double largest, SizingField& sizing);
} // namespace cdm

#endif
