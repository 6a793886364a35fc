// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SphereCriteria.h
 * @brief The criteria of the thesis about empty spheres, for one simplex of a mesh, decided
 *   exactly.
 *
 * A sphere is empty if no point lies strictly inside of it: on cospherical points, where several
 * Delaunay meshes exist, all of them pass. The points are all those of the mesh, used or not, also
 * those on the far side of a boundary.
 *
 * Method: the points that may lie in a sphere are searched in a tree (EmptySphereSearch.h), the
 * exact predicates decide. Criterion 5.2 asks for one empty sphere among the pencil of spheres
 * through a triangle: if the smallest one holds points in front of the triangle and behind, or in
 * its plane, there is none; if it holds points on one side only, it is the sphere through the
 * triangle and that point of them with the smallest lambda (thesis Crit. 6.1), or none.
 *
 * Thread safe. Cost: O(log n) for usual points.
 */
#ifndef cdmSphereCriteria_h
#define cdmSphereCriteria_h

#include "Core/Certificate/EmptySphereSearch.h"

#include <array>
#include <cstddef>
#include <vector>

namespace cdm
{
class SphereCriteria
{
public:
  /**
   * The points have to be finite, and to outlive the object. Threads: 0: one for each processor
   * core.
   */
  explicit SphereCriteria(const std::vector<Vec3>& points, int numberOfThreads = 1)
    : Points(points), Search(points, numberOfThreads)
  {
  }

  /** Crit. 5.3 for a tetrahedron of positive orientation. */
  bool IsDelaunay(const TetrahedronIds& tetrahedron) const;

  /** Crit. 5.2; true for collinear points, which have no sphere. */
  bool IsDelaunay(const TriangleIds& triangle) const;

  /** Crit. 3.1: the equatorial sphere; true for collinear points. */
  bool HasEmptySmallestSphere(const TriangleIds& triangle) const;

  /** Crit. 3.2 for one edge: the diametral sphere. */
  bool HasEmptySmallestSphere(const EdgeIds& edge) const;

private:
  /** EmptySphereSearch::FindInside() of the smallest sphere through the points of a simplex. */
  template <std::size_t N, typename Predicate>
  bool FindInside(const std::array<Id, N>& ids, Predicate&& isInside) const;

  const std::vector<Vec3>& Points;
  EmptySphereSearch Search;
};
} // namespace cdm

#endif
