// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointRounding.h
 * @brief Perturbs the last bits of surface points to remove numerically flat tetrahedra.
 *
 * In a rotated device, points that were drawn in one plane and on one circle are so only up to
 * rounding. The quadrangle of four such points may lie between two cells that are degenerate but
 * for rounding. If the cells choose different diagonals of it, only a flat tetrahedron fits in
 * between. That tetrahedron is Delaunay if the center of its circumsphere lies between the centers
 * of the two cells, which the last bits of the coordinates decide by chance.
 *
 * A point that was computed to lie on the surface has no true last bits. So a nearby position is
 * taken, such that for each quadrangle at the point the center of the sphere lies well outside of
 * the span of the two cells' centers. A change of a few units in the last place is enough, whatever
 * facet or edge the point lies on. A coordinate stays exact if a facet at the point lies across
 * that axis.
 *
 * Positions are rated in floating point: the choice does not decide topology.
 * Deterministic. Cost: O(n) for n tetrahedra, and about a hundred positions for each point of a
 * wanted one.
 */
#ifndef cdmPointRounding_h
#define cdmPointRounding_h

#include "Core/Basics/IdLists.h"
#include "Core/Basics/ThreadTeam.h"
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
   * @param mesh has the surface's points first; dead tetrahedra have the vertex NoId
   * @param flat all tetrahedra that are flat but for rounding, of points of the surface
   * @param wanted those of them that are to be removed
   * @param team whose threads share the work
   */
  PointRounding(const TetMesh& mesh, const TriangleMesh& surface, const std::vector<Id>& flat,
    const std::vector<Id>& wanted, ThreadTeam& team);

  /**
   * Moves at most one point of each wanted tetrahedron.
   * @param isFree for each point of the surface: whether it may be moved
   * @param points of the surface, which are moved
   * @return wanted tetrahedra for which no position is better
   */
  std::vector<Id> Move(const std::vector<char>& isFree, std::vector<Vec3>& points) const;

private:
  /**
   * Three points that lie in one plane and on one circle with the moved point, but for rounding.
   */
  struct Quadrangle
  {
    Vec3 Corner;
    /** From the corner to the center of the circle; and the unit normal of the plane. */
    WideVec3 Center;
    WideVec3 Normal;
    /**
     * Centers of the two adjacent cells, as positions along the normal from the circle's center.
     */
    double Low = 0.0;
    double High = 0.0;
  };
  Vec3 GetCenter(Id tetrahedron) const;
  bool AddQuadrangle(const std::vector<Vec3>& points, const std::array<Id, 3>& others,
    const std::vector<Id>& cells, bool isComplete, std::vector<Quadrangle>& quadrangles) const;
  std::vector<Quadrangle> FindQuadrangles(Id point, const std::vector<Vec3>& points) const;
  std::vector<Vec3> FindDirections(Id point) const;
  static double Rate(const Vec3& position, double required, std::vector<Quadrangle>& quadrangles);

  const TetMesh& Mesh;
  const TriangleMesh& Surface;
  const std::vector<Id>& Wanted;
  /** One for each tetrahedron. */
  std::vector<char> IsFlat;
  /** Tetrahedra and triangles at points of wanted tetrahedra. */
  IdLists Stars;
  IdLists Triangles;
};
} // namespace cdm

#endif
