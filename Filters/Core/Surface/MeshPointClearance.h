// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPointClearance.h
 * @brief Finds the mesh points that keep clear of a surface and of each other (thesis 6.2).
 *
 * Dropped are points closer to a triangle than the clearance, all but the first of coincident
 * points, and points that are not finite. Cost: O(n log n).
 */
#ifndef cdmMeshPointClearance_h
#define cdmMeshPointClearance_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/** The points to keep, ascending. Threads: 0: one for each processor core. */
std::vector<Id> FindClearMeshPoints(const TriangleMesh& surface,
  const std::vector<Vec3>& meshPoints, double clearance, int numberOfThreads);
} // namespace cdm

#endif
