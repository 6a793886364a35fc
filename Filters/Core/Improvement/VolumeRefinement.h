// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VolumeRefinement.h
 * @brief Steiner points for tetrahedra that are too large or badly shaped.
 *
 * Method: tetrahedra that break a limit, the largest first, then the worst shaped, get a point at
 * the circumcenter or off-center (TetrahedronLimits.h); if it disturbs triangles or structural
 * edges of the boundary (BoundarySpheres.h), that which it disturbs most is requested to be split
 * instead. Which tetrahedra are left as they are, see RefinedMesh.h.
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
/** Free points closer to another one than this, or than 0.3 of the sizing, which may be empty. */
void RemoveClosePoints(double smallest, const SizingField& sizing, RefinedMesh& mesh);

/** Until no tetrahedron breaks a limit, but for those that need the boundary split. */
Status RefineByLimits(bool isShapeTested, const ExecutionContext& context, RefinedMesh& mesh);
} // namespace cdm

#endif
