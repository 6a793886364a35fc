// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverPerturbation.h
 * @brief Moves, inserts and removes points to make the smallest dihedral angles larger.
 *
 * Method: slivers are taken one by one, the worst first. A free point of the sliver is moved, or
 * left out if that is better; if that does not help, a new point is inserted (SliverChanges.h). At
 * last a split of the boundary is requested, in each round for one of all slivers with a common
 * edge. Each change increases the smallest angle of the tetrahedra that it replaces, and breaks no
 * limit that all of them kept. Tetrahedra across input angles that are sharp for slivers
 * (SharpAngles.h) do not count as such, but must not get worse; PerturbSharp() treats them last.
 *
 * Threads look ahead: they search the changes of the next slivers at the same time. A change is made
 * in its turn, if no tetrahedron that its search has seen was replaced meanwhile; otherwise it is
 * searched again. So the mesh does not depend on the number of threads.
 */
#ifndef cdmSliverPerturbation_h
#define cdmSliverPerturbation_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Search/PlaceSearch.h"

namespace cdm
{
/** What may be done about slivers. Each value includes those before it. */
enum class SliverMeans
{
  /** Free points are moved. */
  Moves,
  /** Points are also removed and inserted. */
  Points,
  /** Splits of the boundary are also requested. */
  Requests
};

/**
 * Perturbs slivers until none of the allowed means increases an angle below the target.
 * @param effort for the search of each position
 */
Status PerturbSlivers(double target, SliverMeans means, const SearchEffort& effort,
  const ExecutionContext& context, RefinedMesh& mesh);

/**
 * Perturbs slivers at sharp angles, if no other tetrahedron gets worse: in several passes, as long as
 * each leaves clearly fewer of them.
 * @param means requests are not made
 */
Status PerturbSharp(
  double target, SliverMeans means, const ExecutionContext& context, RefinedMesh& mesh);
} // namespace cdm

#endif
