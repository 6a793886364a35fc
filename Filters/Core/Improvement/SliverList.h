// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverList.h
 * @brief The slivers of a mesh that is refined, the worst first.
 *
 * Tetrahedra across thin layers never count: no better ones exist there. Those across sharp angles
 * are asked for by themselves. A list stays usable while the mesh changes: IsGone() tells which of
 * its tetrahedra have been replaced.
 */
#ifndef cdmSliverList_h
#define cdmSliverList_h

#include "Core/Improvement/RefinedMesh.h"
#include "Core/Search/PlaceSearch.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdm
{
/**
 * Points are moved where angles are below this multiple of the target, which leaves some room. With
 * 1.1 meshes take 7 % more time and leave as many slivers; with 1 some have more tetrahedra.
 */
constexpr double MoveRatio = 1.02;
/**
 * Most searches find nothing. Five steps for all of them took 5 to 25 % more of the whole mesher's
 * time, and left as many slivers; one step for those that find nothing makes more tetrahedra.
 */
constexpr SearchEffort SliverEffort{ 3, 2 };
/** Passes over the slivers that are left. */
constexpr int MaximumSliverPasses = 20;

/** Threads search at least so many, each some 100 microseconds. */
constexpr std::size_t SliversPerThread = 2;
/** A sliver is searched ahead for each so many tetrahedra of the mesh: see LookAhead.h. */
constexpr std::size_t TetrahedraPerSliver = 4000;

struct Sliver
{
  /** The smallest dihedral angle, in degrees. */
  double Angle;
  Id Tetrahedron;
  std::int64_t Stamp;
};

/**
 * Tetrahedra with a dihedral angle below the target (degrees): those across sharp angles, or all
 * others.
 */
std::vector<Sliver> FindSlivers(double target, SliverPlace place, const RefinedMesh& mesh);

/** Number of slivers that are not across sharp angles. */
std::size_t CountSlivers(double target, const RefinedMesh& mesh);

/** Whether the tetrahedron has been replaced since it was found. */
bool IsGone(const Sliver& sliver, const RefinedMesh& mesh);

/** Whether all attempts up to this one have failed, and nothing nearby has changed since. */
bool IsHopeless(const Sliver& sliver, SliverAttempt last, RefinedMesh& mesh);
void SetHopeless(const Sliver& sliver, SliverAttempt last, RefinedMesh& mesh);
} // namespace cdm

#endif
