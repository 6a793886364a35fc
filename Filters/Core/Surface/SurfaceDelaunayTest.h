// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceDelaunayTest.h
 * @brief Whether a triangle is strongly Delaunay: the double sphere criterion 6.1, exactly.
 *
 * The spheres through a triangle form a pencil: their centers lie at H + lambda * n, H being the
 * circumcenter and n the normal. With p the point in front of the triangle whose lambda is smallest
 * and q its like behind, the triangle is strongly Delaunay if and only if q lies strictly outside
 * of the sphere through the triangle and p, and no point of its plane lies in or on its
 * circumcircle. Points on the circumcircle are handed to the caller, who knows whether they belong
 * to the same flat facet.
 *
 * Method: search the smallest sphere. If it is empty, the triangle is strongly Delaunay; if it
 * holds points on both sides of the triangle, or in its plane, it is not. If it holds points on one
 * side, p or q is among them, and the sphere through it is searched for a point of the other side.
 */
#ifndef cdmSurfaceDelaunayTest_h
#define cdmSurfaceDelaunayTest_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Search/PointOctree.h"

#include <vector>

namespace cdm
{
class SurfaceDelaunayTest
{
public:
  /** An empty sphere through a strongly Delaunay triangle. */
  struct SphereProof
  {
    /** A ball that contains it. The triangle stays Delaunay until a point is added within. */
    Vec3 Center;
    double Radius = 0.0;
    /**
     * Whether the ball is loose, and holds many points that are not in the sphere. The sphere is
     * almost a half space then, or the smallest one through a needle. As long as points are added
     * outside of the sphere through the triangle and a fourth point, if it has one, else outside of
     * the smallest sphere, the triangle stays Delaunay as well.
     */
    bool IsLoose = false;
    bool HasPoint = false;
    Vec3 Point;
  };

  struct Result
  {
    /** Strongly Delaunay, if the Cocircular points are left aside. */
    bool IsDelaunay = false;
    /**
     * Points strictly inside of the smallest sphere through the triangle, the deepest one first. If
     * there are many, only some of those near its center.
     */
    std::vector<Id> InsideSmallestSphere;
    /** Points on that sphere, but not in the plane of the triangle. */
    std::vector<Id> OnSmallestSphere;
    /** Points on the circumcircle, ascending. */
    std::vector<Id> Cocircular;
    SphereProof Proof;
    /**
     * Whether the triangle is such a needle that its sphere may hold any point: the search took
     * long.
     */
    bool IsNeedle = false;
  };

  SurfaceDelaunayTest(const std::vector<Vec3>& points, const PointOctree& octree)
    : Points(points), Octree(octree)
  {
  }

  /**
   * If the smallest sphere has to be empty and is not, nothing more is searched: the triangle
   * counts as not Delaunay.
   */
  void Run(const TriangleIds& triangle, Result& result, bool isSmallestSphereWanted = false) const;

private:
  const std::vector<Vec3>& Points;
  const PointOctree& Octree;
};
} // namespace cdm

#endif
