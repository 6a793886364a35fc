// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ControlPolyhedra.h
 * @brief Makes polyhedra of the boxes of the box method, for display.
 *
 * Method (thesis 3.2.1, Fig. 3.4 and 5.1): the dual of the mesh. Around each edge, in each region,
 * the circumcenters of its tetrahedra form a polygon that separates the boxes of its ends; where it
 * meets an outer or interface facet it is closed by the circumcenters of these facets and the
 * midpoint of the edge. The boxes of points on such facets are closed by polygons of the
 * circumcenters of the facets around them, the midpoints of edges where these facets bend, and the
 * point itself; where facets go on in one plane, midpoints are left out. Circumcenters that
 * coincide, as an exact sign tells, are one point; polygons that shrink to fewer than three points
 * are left out.
 *
 * Guarantees: each polyhedron is closed, its polygons oriented outwards; the volume within is that
 * of ControlBox. On a Delaunay mesh without negative couplings the polyhedra are the Voronoi boxes
 * clipped to the regions; otherwise they fold over and overlap. Polygons are plane to rounding.
 * The same for any number of threads.
 * Cost: O(n log n); 300 bytes per tetrahedron.
 */
#ifndef cdmControlPolyhedra_h
#define cdmControlPolyhedra_h

#include "Core/BoxMethod/ControlVolumes.h"

namespace cdm
{
/** One polyhedron for each ControlBox, in their order. */
struct ControlPolyhedra
{
  std::vector<Vec3> Points;
  /** Polygon i has the points Connectivity[Offsets[i]] to Connectivity[Offsets[i + 1] - 1]. */
  std::vector<Id> Offsets{ 0 };
  std::vector<Id> Connectivity;
  /**
   * Box b has the polygons BoxPolygons[BoxOffsets[b]] to BoxPolygons[BoxOffsets[b + 1] - 1]; ~i
   * stands for polygon i with the opposite orientation.
   */
  std::vector<Id> BoxOffsets{ 0 };
  std::vector<Id> BoxPolygons;
};

/** Makes the polyhedra of a mesh from what ComputeControlVolumes() computed for it. */
Status MakeControlPolyhedra(const TetMesh& mesh, const ControlVolumes& volumes,
  const ExecutionContext& context, ControlPolyhedra& polyhedra);
} // namespace cdm

#endif
