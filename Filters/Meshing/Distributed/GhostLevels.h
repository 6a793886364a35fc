// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GhostLevels.h
 * @brief Adds tetrahedra of other processes to those of this one, level by level.
 *
 * Private to this module. Method: a level has all tetrahedra at the points of those before. Each
 * process answers for its own points, at which it knows all tetrahedra.
 */
#ifndef GhostLevels_h
#define GhostLevels_h

#include "Distributed/DistributedMesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <unordered_map>
#include <vector>

namespace vtkDistributed
{
class DistributedMesh::GhostLevels
{
public:
  explicit GhostLevels(DistributedMesh& mesh) : Owner(mesh) {}

  /** Finds the tetrahedra of this process at each of its points. Those at its own points are all. */
  void Start();

  /** Called by all processes at once. */
  cdm::Status AddLevel();

private:
  /** A tetrahedron with its points, for a process that has none of them. */
  struct GhostTetrahedron
  {
    std::array<cdm::NumberedPoint, 4> Points;
    std::int64_t Region;
  };

  /** Adds those of this process; the numbers of points at which others are asked for theirs. */
  std::vector<std::vector<std::int64_t>> TakeOwn();

  /** The tetrahedra at own points of these numbers, each of them once. */
  std::vector<GhostTetrahedron> Answer(const std::vector<std::int64_t>& numbers) const;

  /** Adds those of another process that are not known yet. */
  void Take(const std::vector<GhostTetrahedron>& message);

  DistributedMesh& Owner;
  cdm::Id NumberOfPartPoints = 0;
  /** The tetrahedra at point i of the part: Stars[Starts[i]] to Stars[Starts[i + 1] - 1]. */
  std::vector<cdm::Id> Starts;
  std::vector<cdm::Id> Stars;
  /** Index of each point by its number. */
  std::unordered_map<std::int64_t, cdm::Id> Places;
  /** Tetrahedra of the part that are cells of the output. */
  std::vector<char> IsTaken;
  /** Points whose tetrahedra are cells of the output, or asked for. */
  std::vector<char> IsReached;
  /** Tetrahedra of other parts that are cells of the output. */
  std::set<Numbers> Ghosts;
  std::size_t FirstOfLevel = 0;
};
} // namespace vtkDistributed

#endif
