// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VolumeRefinement.h
 * @brief Steiner points for tetrahedra that are too large or badly shaped.
 *
 * Method: tetrahedra that break a limit get a point at the circumcenter or off-center
 * (TetrahedronLimits.h), the largest first, then the worst shaped. They are taken in batches: what
 * one batch has made is tested when it is done, on all threads, and has its turn in a later one. If
 * the point would encroach on triangles or structural edges of the boundary (BoundarySpheres.h), a
 * split of the one it encroaches on most is requested instead. RefinedMesh.h says which tetrahedra
 * are left as they are. Threads look ahead (LookAhead.h): the result does not depend on them.
 *
 * Reference: J. R. Shewchuk, "Tetrahedral mesh generation by Delaunay refinement", 1998,
 * doi:10.1145/276884.276894 (what is split instead, and why it ends).
 */
#ifndef cdmVolumeRefinement_h
#define cdmVolumeRefinement_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Sizing/SizingField.h"

namespace cdm
{
/**
 * Removes free points closer to another one than smallest or than 0.3 of the sizing, which may be
 * empty.
 */
void RemoveClosePoints(double smallest, const SizingField& sizing, RefinedMesh& mesh);

/** Refines until no tetrahedron breaks a limit, except those that need a split of the boundary. */
Status RefineByLimits(bool isShapeTested, const ExecutionContext& context, RefinedMesh& mesh);
} // namespace cdm

#endif
