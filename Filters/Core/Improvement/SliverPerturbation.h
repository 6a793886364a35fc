// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverPerturbation.h
 * @brief Points that are moved, put in and taken out for larger dihedral angles.
 *
 * Method: tetrahedra with a small dihedral angle, worst first: a free point of it is taken out of
 * the mesh and put in again at the best of some hundred places around (PlaceSearch.h), or left out
 * if that is better. A place is rated by the smallest dihedral angle of all tetrahedra that it
 * would make, before anything is changed. If no point's move helps, a new point is tried in the
 * same way, at last the boundary that is in the way is requested to be split. Each change makes the
 * smallest angle of what it replaces larger, and breaks no limit where all were kept. Tetrahedra
 * across sharp input angles do not count, they only must not get worse; their turn is the last.
 *
 * Reference: J. Tournois, R. Srinivasan, P. Alliez, "Perturbing slivers in 3D Delaunay meshes",
 * 2009, doi:10.1007/978-3-642-04319-2_10.
 */
#ifndef cdmSliverPerturbation_h
#define cdmSliverPerturbation_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Improvement/RefinedMesh.h"

#include <vector>

namespace cdm
{
/** What may be done about slivers; each also what is above it. */
enum class SliverMeans
{
  /** Free points are moved. */
  Moves,
  /** They are also taken out, and new ones put in. */
  Points,
  /** What is in the way in the boundary is requested to be split. */
  Requests
};

/**
 * Tetrahedra with a dihedral angle below the target (degrees), but for those across thin layers and
 * sharp angles.
 */
std::size_t CountSlivers(double target, const RefinedMesh& mesh);

/** Until nothing of what may be done makes angles below the target larger. */
Status PerturbSlivers(
  double target, SliverMeans means, const ExecutionContext& context, RefinedMesh& mesh);

/** Moves points of tetrahedra across sharp angles, as far as all others stay as good. */
Status PerturbSharp(double target, const ExecutionContext& context, RefinedMesh& mesh);

/**
 * Moves points of the surface that are corners of slivers. Afterwards it has to be seen whether
 * they are in smallest spheres on the other side of outer facets: the surface gets its points, and
 * RefinedMesh::SplitBoundary() is called, or a new mesh is made.
 * @param isFree one for each point of the surface, whether it may be moved
 * @param areEdgesKept whether smallest spheres of the kept edges stay empty, too
 * @return where the surface's points are now
 */
std::vector<Vec3> MoveSurfacePoints(
  double target, const std::vector<char>& isFree, bool areEdgesKept, RefinedMesh& mesh);
} // namespace cdm

#endif
