// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfacePointMoves.h
 * @brief Better places for points of a surface, in the facet or on the edge that they lie on.
 *
 * A sliver whose points all lie on the surface is not mended by points inside. Often two sides of a
 * layer match but for one point: where that is put opposite its partner, the sliver is gone.
 *
 * Method: a point moves in the plane that all triangles around it lie in, or along the two
 * structural edges that meet at it in a straight line. Places are tried opposite the sliver's other
 * points, then in a pattern search (PlaceSearch.h). For each, the tetrahedra around the point and
 * those that it would be in conflict with are a cavity, which is filled anew (CavityFilling.h), the
 * moved triangles being walls. The place is rated by the smallest dihedral angle of what fills it.
 * It is no place at all if a triangle is not there, if the smallest sphere of a triangle, or of an
 * edge where these count, is not empty, if the point comes too close to others, or if more
 * tetrahedra than before break a limit.
 *
 * What lies beyond outer facets is not looked at: the surface has to be checked again with the new
 * places (DelaunaySurfaceRefiner.h).
 *
 * Floating point, but for the cavity. Deterministic. Cost: about 200 microseconds for each place
 * tried.
 */
#ifndef cdmSurfacePointMoves_h
#define cdmSurfacePointMoves_h

#include "Core/Basics/IdLists.h"
#include "Core/Delaunay/CavityFilling.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/StructuralEdges.h"

#include <array>
#include <functional>
#include <vector>

namespace cdm
{
class SurfacePointMoves
{
public:
  struct Rules
  {
    /** Whether the dihedral angles of a tetrahedron count, and whether it breaks a limit. */
    std::function<bool(const TetrahedronIds&, Id region)> HasAngle;
    std::function<bool(const TetrahedronIds&, const std::array<Vec3, 4>&)> BreaksLimit;
    /** How close another point may come to this one. */
    std::function<double(Id point)> GetClearance;
  };

  /**
   * The mesh has the surface's points first. The surface's triangles are those of outer facets and
   * interfaces whose smallest spheres are empty and stay so; at a point that is moved there are no
   * others. All have to outlive the object.
   * @param edges structural ones, sorted
   * @param keptEdges those whose smallest spheres stay empty, sorted
   */
  SurfacePointMoves(DynamicTetrahedralization& mesh, const TriangleMesh& surface,
    const IdLists& pointTriangles, const std::vector<StructuralEdge>& edges,
    const std::vector<StructuralEdge>& keptEdges, Rules rules);

  /**
   * Moves a point of a tetrahedron to the best place; false if none makes the smallest angle
   * larger.
   * @param target degrees that are enough
   */
  bool Move(Id point, const TetrahedronIds& sliver, double target);
  /** Where the surface's points are now; the surface itself stays as it is. */
  const std::vector<Vec3>& GetPoints() const { return this->Points; }

private:
  /** Where a point may go: along directions in a plane with a normal, or on a line. */
  struct Support
  {
    std::vector<Vec3> Directions;
    Vec3 Axis;
    bool IsLine = false;
  };
  bool FindSupport(Id point, Support& support) const;
  std::vector<Id> FindEdgeEnds(Id point) const;
  bool ArePlanar(Id point, const std::vector<Id>& ends) const;
  void CollectStar(Id point);
  double MeasureStar(Id point, double& nearest) const;
  double Rate(Id point, const Vec3& position, double required);
  bool KeepsTurns(Id point, const Vec3& position) const;
  bool CollectCavity(Id point, const Vec3& position);
  bool IsOnSurface(const TriangleIds& ids) const;
  bool AreSpheresEmpty(Id point, const Vec3& position) const;

  DynamicTetrahedralization& Mesh;
  const TriangleMesh& Surface;
  std::vector<Vec3> Points;
  const IdLists& PointTriangles;
  const std::vector<StructuralEdge>& Edges;
  const std::vector<StructuralEdge>& KeptEdges;
  const Rules Given;
  /** Across which triangles count as lying in one plane. */
  double Flatness = 0.0;
  /** Tetrahedra at the point that is moved. */
  std::vector<Id> Star;
  /** Work space of one place: the tetrahedra that it changes, and facets around these. */
  std::vector<Id> Tetrahedra;
  Cavity Around;
  std::vector<Id> Outer;
  CavityFilling Filling;
};
} // namespace cdm

#endif
