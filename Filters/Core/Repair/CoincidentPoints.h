// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CoincidentPoints.h
 * @brief Finds points to be merged: equal ones, and those closer than a tolerance.
 *
 * Guarantees: the lowest id of equal points stays; with a tolerance points are taken in the order
 * of their ids, and each is merged into the lowest one within the tolerance that stays, or stays
 * itself.
 * Cost: O(n log n), with a tolerance for a bounded number of staying points within it.
 */
#ifndef cdmCoincidentPoints_h
#define cdmCoincidentPoints_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
/**
 * Finds the point that stands for each point; false if aborted.
 * @param tolerance model units, range >= 0; 0: equal coordinates only
 * @param representatives has NoId for points that take no part, anything else for the others
 */
bool FindRepresentatives(const std::vector<Vec3>& points, double tolerance,
  const ExecutionContext& context, std::vector<Id>& representatives);
} // namespace cdm

#endif
