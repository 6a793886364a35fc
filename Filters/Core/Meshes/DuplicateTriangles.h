// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DuplicateTriangles.h
 * @brief Finds triangles with the same three points, and unites the regions at their sides.
 */
#ifndef cdmDuplicateTriangles_h
#define cdmDuplicateTriangles_h

#include "Core/Basics/Types.h"

#include <vector>

namespace cdm
{
struct DuplicateTriangle
{
  Id Triangle = NoId;
  /** The first triangle with the same points. */
  Id Original = NoId;
  /** Whether the two have opposite orientations. */
  bool IsReversed = false;
};

/**
 * In no particular, but always the same order. Cost: O(n) for a bounded number of them at a point.
 */
std::vector<DuplicateTriangle> FindDuplicateTriangles(const std::vector<TriangleIds>& triangles);

/**
 * Adds the regions of a copy to those of the original: a side labelled OutsideRegion takes the
 * region of the copy. False if a side has two different regions.
 */
bool UniteLabels(RegionPair& labels, RegionPair copy, bool isReversed);
} // namespace cdm

#endif
