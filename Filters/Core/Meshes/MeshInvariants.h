// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshInvariants.h
 * @brief What stages ask of a tetrahedral mesh before they change it, and neighbors for others'.
 *
 * Failure: InvalidInput names the tetrahedra at fault.
 * Cost: O(n), in parallel.
 */
#ifndef cdmMeshInvariants_h
#define cdmMeshInvariants_h

#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"

#include <vector>

namespace cdm
{
/** Cells with an id that is no point. */
template <typename Cells>
std::vector<Id> FindCellsOutOfRange(const Cells& cells, std::size_t numberOfPoints)
{
  std::vector<Id> found;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
  {
    for (const Id point : cells[cell])
    {
      if (point < 0 || static_cast<std::size_t>(point) >= numberOfPoints)
      {
        found.push_back(static_cast<Id>(cell));
        break;
      }
    }
  }
  return found;
}

/** Whether there are as many tetrahedra and points as ids can count, and all points exist. */
Status CheckTetrahedra(const TetMesh& mesh);

/**
 * The invariants of TetMesh.h, one tetrahedron by itself: InvalidInput names those that are
 * inverted, flat, or have wrong points or neighbors.
 */
Status CheckMeshInvariants(const TetMesh& mesh, int numberOfThreads);

/**
 * Makes the neighbors of tetrahedra from their vertices alone; for meshes that come from outside.
 * InvalidInput names tetrahedra that share a facet with more than one other.
 */
Status BuildNeighbors(TetMesh& mesh, int numberOfThreads = 1);
} // namespace cdm

#endif
