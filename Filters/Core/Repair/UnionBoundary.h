// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UnionBoundary.h
 * @brief Which pieces of a surface that was cut along its intersections do not bound the outside.
 *
 * Method, for each component of the surface that was cut:
 *  1. count windings from shell to shell (SurfaceSides.h): one more on the back of each piece. What
 *     has winding 0 on one side only bounds the union;
 *  2. where orientations contradict each other: what has a side that belongs to the outer shell;
 *  3. of sheets that stick out of something closed, those made of nothing but cut triangles go:
 *     they are left where a surface ran along another one. Others may be parts of the model.
 *
 * Inputs: a surface without intersections.
 * Guarantees: components that were not cut stay as they are, inner sheets included.
 * Cost: O(n log n).
 */
#ifndef cdmUnionBoundary_h
#define cdmUnionBoundary_h

#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/** How a triangle of a surface came about. */
struct UnionPiece
{
  /** How many triangles lie here, those turned over counted as -1. */
  int Multiplicity = 1;
  /** Cut, or equal to another one. */
  bool IsTouched = false;
};

/** 1 for each triangle that does not bound the outside. One piece for each triangle. */
std::vector<char> FindInternalPieces(
  const TriangleMesh& surface, const std::vector<UnionPiece>& pieces);
} // namespace cdm

#endif
