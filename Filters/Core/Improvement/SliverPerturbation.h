// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverPerturbation.h
 * @brief Moves, inserts and removes points to make the smallest dihedral angles larger.
 *
 * Method: slivers are taken one by one, the worst first. A free point of the sliver is removed from
 * the mesh and inserted again at the best of some hundred positions around (PlaceSearch.h), or left
 * out if that is better. A position is rated by the smallest dihedral angle of all tetrahedra that
 * it would make, before the mesh is changed. If no move helps, a new point is tried in the same
 * way. At last a split of the boundary is requested. Each change increases the smallest angle of
 * the tetrahedra that it replaces, and breaks no limit that all of them kept. Tetrahedra across
 * input angles that are sharp for slivers (SharpAngles.h) do not count as such, but must not get
 * worse; PerturbSharp() treats them last.
 *
 * Reference: J. Tournois, R. Srinivasan, P. Alliez, "Perturbing slivers in 3D Delaunay meshes",
 * 2009, doi:10.1007/978-3-642-04319-2_10.
 */
#ifndef cdmSliverPerturbation_h
#define cdmSliverPerturbation_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Improvement/RefinedMesh.h"

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

/** Perturbs slivers until none of the allowed means increases an angle below the target. */
Status PerturbSlivers(
  double target, SliverMeans means, const ExecutionContext& context, RefinedMesh& mesh);

/** Moves points of tetrahedra across sharp angles, if no other tetrahedron gets worse. */
Status PerturbSharp(double target, const ExecutionContext& context, RefinedMesh& mesh);
} // namespace cdm

#endif
