// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceSpheres.h
 * @brief Whether smallest spheres of a surface stay empty when one of its points is moved.
 *
 * A mesh shows this only within its regions (SurfacePointMoves.h). A point of an outer facet that is
 * moved may fill a sphere beyond that facet: the surface would be split there, and at sharp angles
 * one split asks for the next. Two points moved at the tip of a cone took 72 splits.
 *
 * Method: the new position must not lie inside the smallest sphere of another triangle, nor may a
 * point lie inside those of the triangles that are moved with it. All other points are where they
 * were when the object was made: two of them that are moved may still fill a sphere.
 *
 * Exact, but for triangles that are needles but for rounding: these must not be moved. Several
 * threads may ask at once. Cost: O(log n) for a position, some microseconds; 40 to 50 bytes per
 * point.
 */
#ifndef cdmSurfaceSpheres_h
#define cdmSurfaceSpheres_h

#include "Core/Basics/IdLists.h"
#include "Core/Certificate/EmptySphereSearch.h"
#include "Core/Improvement/BoundarySpheres.h"
#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
class SurfaceSpheres
{
public:
  /**
   * All have to outlive the object, and stay as they are.
   * @param pointTriangles the triangles at each point
   * @param spheres those of the surface
   */
  SurfaceSpheres(
    const TriangleMesh& surface, const IdLists& pointTriangles, const BoundarySpheres& spheres);

  /** Whether the smallest spheres of all triangles stay empty if a point gets this position. */
  bool StayEmpty(Id point, const Vec3& position) const;

private:
  const TriangleMesh& Surface;
  const IdLists& PointTriangles;
  const BoundarySpheres& Spheres;
  EmptySphereSearch Search;
};
} // namespace cdm

#endif
