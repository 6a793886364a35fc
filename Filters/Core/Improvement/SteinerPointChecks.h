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
 * Checks that mesh and boundary fit each other, that regions are numbered from 0 on, and that new
 * points are finite. An error names tetrahedra, triangles of the boundary, or new points.
 * @param threads 0: one for each processor core
 */
Status CheckSteinerPointInput(const SteinerPointRefinerInput& input, int threads);
} // namespace cdm

#endif
