// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfacePointMoves.h
 * @brief Moves points of a surface: within their facet or along their edge to remove slivers, or in
 * their last bits to remove flat tetrahedra.
 *
 * Interior points do not improve a sliver whose points all lie on the surface. Often the two sides
 * of a layer match but for one point: when it is moved opposite its partner, the sliver is gone.
 *
 * Method: a point moves in the plane of all triangles around it, or along the two structural edges
 * that meet at it in a straight line. Positions opposite the sliver's other points are tried first,
 * then a pattern search (PlaceSearch.h). For each position, the tetrahedra around the point and
 * those in conflict with it form a cavity, which is filled anew (CavityFilling.h) with the moved
 * triangles as walls. A position is rated by the smallest dihedral angle of the new tetrahedra. It
 * is rejected if a triangle of the surface is not among the new facets, if the smallest sphere of a
 * triangle (or of an edge where these count) is not empty, if the point comes too close to others,
 * or if more tetrahedra than before break a limit. Two positions of three are rejected for points of
 * the tetrahedra around the point, before a cavity is made. A hub is a point with many tetrahedra,
 * which often has many slivers, too: what is known of the tetrahedra at a hub is kept until they
 * change. To find it anew for each sliver took nine tenths of the time of meshes with such points.
 *
 * At sharp angles tetrahedra are mended by themselves, once and with fewer positions: most searches
 * find nothing there. The others must not get angles below the target. As splits would ask for more
 * splits, the spheres of all triangles have to stay empty there, on both sides (SurfaceSpheres.h).
 *
 * Elsewhere the method does not look beyond outer facets: the surface has to be checked again with
 * the new positions (DelaunaySurfaceRefiner.h). So the functions at the end, which say where the points of
 * a refined mesh go, leave the surface as it is. The caller gives the positions to it, and calls
 * RefinedMesh::SplitBoundary() or makes a new mesh.
 *
 * Positions are rated in floating point; the cavity is filled exactly. Deterministic. Cost: about
 * 4 microseconds for each position tried.
 */
#ifndef cdmSurfacePointMoves_h
#define cdmSurfacePointMoves_h

#include "Core/Basics/IdLists.h"
#include "Core/Delaunay/CavityFilling.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Improvement/SliverList.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Search/PlaceSearch.h"
#include "Core/Surface/StructuralEdges.h"

#include <array>
#include <functional>
#include <unordered_map>
#include <vector>

namespace cdm
{
/** Searches positions for points of a surface, in a mesh that follows them. */
class alignas(SeparateLines) SurfacePointMoves
{
public:
  struct Rules
  {
    /** The smallest dihedral angle of a tetrahedron of the mesh if that counts and is smaller. */
    std::function<double(Id tetrahedron, double angle)> GetSmallerAngle;
    /**
     * What the smallest dihedral angle of a new tetrahedron counts: as much as it is; 180 if it does
     * not matter, 0 if there must be no such tetrahedron. Degrees.
     */
    std::function<double(const TetrahedronIds&, Id region, double angle)> Weigh;
    /** Angles below this have to be weighed even if there are smaller ones. Degrees. */
    double WeighedBelow = 0.0;
    /** Whether a new tetrahedron breaks a limit. */
    std::function<bool(const TetrahedronIds&, const std::array<Vec3, 4>&)> BreaksLimit;
    /** How close another point may come to this one. */
    std::function<double(Id point)> GetClearance;
    /** Whether a point is immovable, see SliverMemory. */
    std::function<bool(Id point)> IsImmovable;
    /** Whether a point may be there, whatever the mesh shows. Empty: anywhere. */
    std::function<bool(Id point, const Vec3& position)> IsAllowed;
    SearchEffort Effort = SliverEffort;
  };

  /**
   * The mesh has the surface's points first. The surface's triangles are those of outer facets and
   * interfaces whose smallest spheres are empty and stay so; a point with other outer facets cannot
   * be moved. All have to outlive the object.
   * @param points the current positions of the surface's points, which may have been moved
   * @param edges structural edges, sorted
   * @param keptEdges structural edges whose smallest spheres stay empty, sorted
   * @param isRecording whether TakeVisited() is needed
   */
  SurfacePointMoves(const DynamicTetrahedralization& mesh, const TriangleMesh& surface,
    const std::vector<Vec3>& points, const IdLists& pointTriangles,
    const std::vector<StructuralEdge>& edges, const std::vector<StructuralEdge>& keptEdges,
    Rules rules, bool isRecording);

  /**
   * Finds the best position for a point of a sliver; false if none increases the smallest angle.
   * The neighborhood of an immovable point is not searched again: it may be one of many slivers.
   * @param target an angle that is large enough, in degrees
   */
  bool Find(Id point, const TetrahedronIds& sliver, double target, Vec3& position);
  /**
   * Moves a point in the mesh, which is the one of this object, to a position that was found.
   * @return the points whose tetrahedra have changed: objects with that mesh have to forget them
   */
  const std::vector<Id>& Make(Id point, const Vec3& position, DynamicTetrahedralization& mesh);
  /** Forgets what is known of the tetrahedra at points. */
  void Forget(const std::vector<Id>& points);

  /** Forgets the visits so far; the tetrahedra that were looked at since then, in no order. */
  void StartRecord() { this->Visited.clear(); }
  std::vector<Id> TakeVisited();

private:
  /** Where a point may move: in a plane, in several directions, or along a line. */
  struct Support
  {
    std::vector<Vec3> Directions;
    Vec3 Axis;
    bool IsLine = false;
  };
  /** Tetrahedra that a position changes, as a cavity, and what is around them. */
  struct Surroundings
  {
    Cavity Inside;
    /** One for each facet of the cavity's border: the facet behind it, or NoId. */
    std::vector<Id> Outer;
    /** Facets of the tetrahedra that are triangles of the surface. */
    std::vector<TriangleIds> Triangles;
  };
  /** The tetrahedra at a point. */
  struct Neighborhood
  {
    /** Whether the point can be moved at all; otherwise there is nothing else here but the star. */
    bool IsMovable = false;
    Support Free;
    std::vector<Id> Star;
    /** The star as a cavity, which is a part of the cavities of all positions. */
    Surroundings AtPoint;
    /** The smallest angle that counts, and how far away the nearest other point is. */
    double Smallest = 0.0;
    double Nearest = 0.0;
  };
  /** A tetrahedron with the point that made a position too bad, and its region; NoId: none. */
  struct Spoiler
  {
    TetrahedronIds Ids{};
    Id Region = NoId;
  };
  Neighborhood& Explore(Id point);
  bool FindSupport(Id point, Support& support);
  std::vector<Id> FindEdgeEnds(Id point) const;
  bool ArePlanar(Id point, const std::vector<Id>& ends) const;
  void MeasureStar(Id point, Neighborhood& around) const;
  double GetSmallerAngle(
    double angle, const TetrahedronIds& ids, Id region, const std::array<Vec3, 4>& corners) const;
  std::array<Vec3, 4> GetMovedCorners(
    const TetrahedronIds& ids, Id point, const Vec3& position) const;
  bool IsFlatAgain(const Spoiler& spoiler, Id point, const Vec3& position, double required) const;
  bool IsSpoiled(Id point, const Vec3& position, double required) const;
  double Rate(Id point, const Vec3& position, double required, Neighborhood& around);
  bool KeepsOrientations(Id point, const Vec3& position) const;
  bool CollectConflicts(const std::vector<Id>& star, const Vec3& position);
  void MarkInside();
  bool CollectFacets(Id point, Surroundings& around) const;
  void CollectPoints(Id point, const Vec3& position, Cavity& cavity);
  bool CollectCavity(Id point, const std::vector<Id>& star, const Vec3& position);
  bool IsOnSurface(const TriangleIds& ids) const;
  bool IsClear(Id point, const Vec3& position, const Cavity& cavity) const;
  bool AreSpheresEmpty(Id point, const Vec3& position, Surroundings& around) const;

  const DynamicTetrahedralization& Mesh;
  const TriangleMesh& Surface;
  const std::vector<Vec3>& Points;
  const IdLists& PointTriangles;
  const std::vector<StructuralEdge>& Edges;
  const std::vector<StructuralEdge>& KeptEdges;
  const Rules Given;
  /** Triangles count as coplanar if they deviate by less than this. Model units. */
  double Flatness = 0.0;
  /** One for each point: whether it is known that other than two structural edges meet there. */
  std::vector<char> IsCorner;
  /** Neighborhoods of hubs, by the point, and of the last other point. */
  std::unordered_map<Id, Neighborhood> Hubs;
  Neighborhood Last;
  /** Work space for one position: the tetrahedra that it changes. */
  std::vector<Id> Tetrahedra;
  /**
   * One for each tetrahedron: the last mark if it is in the cavity, one less if it is a neighbor that
   * stays. Lower marks are those of earlier cavities.
   */
  std::vector<Id> Marks;
  Id LastMark = 0;
  /** One for each point: the last mark if it is in the cavity. */
  std::vector<Id> PointMarks;
  Surroundings Around;
  /** The last spoilers. */
  std::array<Spoiler, 4> Spoilers;
  CavityFilling Filling;
  const bool IsRecording;
  std::vector<Id> Visited;
};

/**
 * Moves points of the surface that are corners of slivers, also in the mesh.
 * @param target slivers have a dihedral angle below this. Degrees
 * @param place which slivers these are
 * @param isFree one for each point of the surface, whether it may be moved
 * @param areEdgesKept whether smallest spheres of the kept edges stay empty, too
 * @return the new positions of the surface's points
 */
std::vector<Vec3> MoveSurfacePoints(double target, SliverPlace place,
  const std::vector<char>& isFree, bool areEdgesKept, RefinedMesh& mesh);

/**
 * Perturbs the last bits of surface points, for tetrahedra that are flat but for rounding
 * (PointRounding.h). Those for which that was in vain are tried again when something has changed at
 * one of their points.
 * @param flat these tetrahedra
 * @param isFree one for each point of the surface, whether it may be moved
 * @return the new positions of the surface's points
 */
std::vector<Vec3> RoundSurfacePoints(
  const std::vector<Id>& flat, const std::vector<char>& isFree, RefinedMesh& mesh);
} // namespace cdm

#endif
