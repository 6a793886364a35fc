// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceFacets.h
 * @brief Finds the triangles of a surface among the facets of the tetrahedralization of its points.
 *
 * Method:
 *  1. facets are compared with the triangles at their first vertex;
 *  2. a triangle at a tetrahedron whose cell has four points only is strongly Delaunay. The others
 *     are tested by the double sphere (SurfaceDelaunayTest.h), and diagonals inside of cocircular
 *     facets are flipped to those of the pulling rule (FacetPolygons.h, thesis 6.4.3);
 *  3. the triangles of flipped diagonals are compared once more.
 *
 * Inputs: the invariants of TriangleMesh.h.
 * Guarantees: on Ok each side of each triangle has its facet; labels are exchanged with the
 * diagonals.
 * Failure: NotDelaunay names triangles that are not strongly Delaunay, SelfIntersecting those of a
 * flat facet that overlap, InvalidInput those with the same points.
 * Cost: O(n) for n tetrahedra and a bounded number of triangles at a point, O(log n) for each
 * triangle that has to be tested.
 */
#ifndef cdmSurfaceFacets_h
#define cdmSurfaceFacets_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/RawVector.h"
#include "Core/Basics/Status.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
struct SurfaceFacetsInput
{
  /** Points of the surface, followed by mesh points. */
  const std::vector<Vec3>& Points;
  /** The point of each vertex, and its position. */
  const std::vector<Id>& Order;
  const RawVector<Vec3>& VertexPoints;
  /** The tetrahedralization of all points. */
  const DelaunayTetrahedralization& All;
  /** At least 1; the result does not depend on it. */
  int NumberOfThreads;
};

struct SurfaceFacets
{
  /**
   * For the front, 2 * triangle, and the back, 2 * triangle + 1, of each triangle: the facet of the
   * tetrahedron there.
   */
  std::vector<Id> Sides;
  Id TurnedDiagonals = 0;
};

/** Triangles and labels of the surface may be exchanged; its own points are not looked at. */
Status FindSurfaceFacets(const SurfaceFacetsInput& input, const ExecutionContext& context,
  TriangleMesh& surface, SurfaceFacets& output);
} // namespace cdm

#endif
