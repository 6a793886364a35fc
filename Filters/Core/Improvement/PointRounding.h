// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointRounding.h
 * @brief Other last digits for points of a surface, with which no tetrahedron is flat.
 *
 * In a device that is turned, points that lie in one plane and on one circle as drawn do so only to
 * rounding. If they are corners of two cells that are degenerate but for that, these may choose
 * different diagonals of the quadrangle in between, and only a flat tetrahedron fits there. It is
 * Delaunay if the center of its circumsphere lies between those of the two cells: that is chance,
 * decided by the last digits. A point that was computed to lie on the surface has no right last
 * digits. So another one of the positions around it is taken, such that for each quadrangle of the
 * point the sphere's center lies well outside of what the centers of both sides span. This takes a
 * few units in the last place, whatever the facet or edge that the point lies on. A coordinate
 * that the facets across an axis have in common stays exact.
 *
 * Floating point: which position is the better one is no question of topology.
 * Deterministic. Cost: O(n) for n tetrahedra, and a few hundred positions for each flat one.
 */
#ifndef cdmPointRounding_h
#define cdmPointRounding_h

#include "Core/Basics/IdLists.h"
#include "Core/Geometry/WideVec3.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

#include <array>
#include <vector>

namespace cdm
{
class PointRounding
{
public:
  /**
   * @param mesh has the surface's points first; places whose tetrahedron is gone have the vertex
   * NoId
   * @param flat tetrahedra that are flat but for rounding, of points of the surface
   */
  PointRounding(const TetMesh& mesh, const TriangleMesh& surface, const std::vector<Id>& flat);

  /**
   * Moves at most one point of each flat tetrahedron.
   * @param isFree one for each point of the surface: whether it may be moved
   * @param points of the surface, which get their new places
   */
  void Move(const std::vector<char>& isFree, std::vector<Vec3>& points) const;

private:
  /** Three other points of a plane and a circle that a point lies on, too, but for rounding. */
  struct Quadrangle
  {
    Vec3 Corner;
    /** From the corner to the center of the circle; of length one and across the plane. */
    WideVec3 Center;
    WideVec3 Normal;
    /**
     * Where along the normal, from the circle's center on, the centers of the adjacent cells lie.
     */
    double Low = 0.0;
    double High = 0.0;
  };
  Vec3 GetCenter(Id tetrahedron) const;
  bool AddQuadrangle(const std::vector<Vec3>& points, const std::array<Id, 3>& others,
    const std::vector<Id>& cells, bool isComplete, std::vector<Quadrangle>& quadrangles) const;
  std::vector<Quadrangle> FindQuadrangles(Id point, const std::vector<Vec3>& points) const;
  std::array<bool, 3> FindFreeAxes(Id point) const;
  static double Rate(const Vec3& position, const std::vector<Quadrangle>& quadrangles);

  const TetMesh& Mesh;
  const TriangleMesh& Surface;
  const std::vector<Id>& Flat;
  /** One for each tetrahedron. */
  std::vector<char> IsFlat;
  /** Tetrahedra and triangles at points of flat tetrahedra. */
  IdLists Stars;
  IdLists Triangles;
};
} // namespace cdm

#endif
