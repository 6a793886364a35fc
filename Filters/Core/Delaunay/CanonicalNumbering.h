// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CanonicalNumbering.h
 * @brief Numbers tetrahedra by their vertices alone, independent of the order they were made in.
 *
 * Method: each tetrahedron starts with its first vertex along the curve, then the first of the
 * others, and all are in the order of their vertices. A counting sort by the first vertex; the few
 * tetrahedra that have it in common are compared. Tetrahedra, and then neighbors, move from the old
 * array to the new one in two halves, so that the second half of the new one needs no memory before
 * that of the old one is released.
 *
 * Guarantees: the order depends on the vertices only, not on the number of threads; orientations
 * stay.
 * Cost: O(n); 17 bytes per tetrahedron while it runs, besides 32 of the input, which it uses up.
 */
#ifndef cdmCanonicalNumbering_h
#define cdmCanonicalNumbering_h

#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Meshes/TetMesh.h"

#include <vector>

namespace cdm
{
/**
 * Writes the tetrahedra, regions and neighbors of a mesh.
 * @param all is used up
 * @param regions of all tetrahedra; NoId: not part of the mesh. Used up
 * @param points that stand for the vertices
 */
void CollectTetrahedra(DelaunayTetrahedralization& all, RawVector<Id>& regions,
  const std::vector<Id>& points, int numberOfThreads, TetMesh& mesh);
} // namespace cdm

#endif
