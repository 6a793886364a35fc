// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UnionBoundary.h
 * @brief Finds the pieces of a surface that was cut along its intersections which do not bound the
 * outside.
 *
 * Method, for each component of the surface that was cut:
 *  1. count windings from shell to shell (SurfaceSides.h): one more on the back of each piece.
 *     Pieces with winding 0 on exactly one side bound the union;
 *  2. where orientations contradict each other, pieces with a side on the outer shell bound it;
 *  3. sheets that stick out of a closed part are dropped if all their triangles were cut: they are
 *     left where a surface ran along another one. Other sheets may be parts of the model.
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
  /** Number of coincident triangles here; reversed ones count -1. */
  int Multiplicity = 1;
  /** Whether the triangle was cut, or equals another one. */
  bool IsTouched = false;
};

/** Marks the triangles that do not bound the outside. pieces has one entry for each triangle. */
std::vector<char> FindInternalPieces(
  const TriangleMesh& surface, const std::vector<UnionPiece>& pieces);
} // namespace cdm

#endif
