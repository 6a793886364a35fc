// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SteinerPointChecks.h
 * @brief Whether Steiner points can be put into a mesh: what is wrong with the input, and where.
 */
#ifndef cdmSteinerPointChecks_h
#define cdmSteinerPointChecks_h

#include "Core/Basics/Status.h"
#include "Core/Improvement/SteinerPointRefiner.h"

namespace cdm
{
/**
 * Whether mesh and boundary fit each other and all numbers are in their ranges: an error names
 * tetrahedra, triangles of the boundary, or new points.
 */
Status CheckSteinerPointInput(const SteinerPointRefinerInput& input, int threads);
} // namespace cdm

#endif
