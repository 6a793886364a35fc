// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpatialSort.h
 * @brief Order of points along a Hilbert curve: neighbours in the list are neighbours in space.
 *
 * Method:
 *  1. keys of a Hilbert curve on a lattice over the bounding box, as fine as the number of points
 *     asks for, from a table of the curve's 24 states;
 *  2. radix sort by key;
 *  3. points with the same key: again, on the lattice of their own bounding box; few of them by
 *     their coordinates. So clusters and graded sets are ordered to the last point.
 *
 * Guarantees: the order is a function of the positions alone, whatever the order they come in;
 * copies of a point follow each other, the smaller id first.
 * Cost: O(n) for usual distributions, 32 bytes per point while it runs.
 *
 * References: C. Hamilton, A. Rau-Chaplin, "Compact Hilbert indices: space-filling curves for
 * domains with unequal side lengths", 2008, doi:10.1016/j.ipl.2007.08.034 (entry points and
 * directions of the curve, of which the table is made).
 */
#ifndef cdmSpatialSort_h
#define cdmSpatialSort_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
/** Sorts the ids of points into the order of the curve. */
void SortAlongHilbertCurve(
  const std::vector<Vec3>& points, std::vector<Id>& ids, int numberOfThreads = 1);
} // namespace cdm

#endif
