// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryRequests.h
 * @brief Requests to split the boundary, for tetrahedra that no interior point can improve.
 *
 * A request names an edge or a triangle of the boundary. Each is requested at most once, and, but
 * for negative couplings that nothing else helps, only if a new point may come as close to its
 * corners as the split would put it.
 *
 * Reference: J. R. Shewchuk, "Tetrahedral mesh generation by Delaunay refinement", 1998,
 * doi:10.1145/276884.276894 (what is split instead of a point that it keeps out).
 */
#ifndef cdmBoundaryRequests_h
#define cdmBoundaryRequests_h

#include "Core/Basics/IdLists.h"
#include "Core/Improvement/BoundarySpheres.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/StructuralEdges.h"

#include <functional>
#include <vector>

namespace cdm
{
class BoundaryRequests
{
public:
  /** Whether a new point may be this close to a point of the surface. */
  using DistanceRule = std::function<bool(Id point, double distance)>;

  /** Surface and edges have to outlive the object. */
  BoundaryRequests(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    DistanceRule mayHavePoint);

  /** Forgets all requests. The surface may be another one from then on. */
  void Clear();

  /**
   * Requests the edge, or if there is none the triangle, on which the position encroaches most.
   * @param isDistanceKept whether the distance rule applies
   */
  void AddEncroached(
    const Vec3& position, const BoundarySpheres::Encroached& encroached, bool isDistanceKept);
  /**
   * Two boundary triangles that are nearly coplanar and nearly cocircular share a flat tetrahedron.
   * No interior point destroys it, but a point on their common edge does.
   * @return whether the tetrahedron is such a one; then the edge is requested
   */
  bool AddEdgeOfTwoTriangles(const TetrahedronIds& ids, const IdLists& pointTriangles);
  /**
   * Requests an edge of the boundary; if it lies within a facet, the largest triangle at it.
   * @param isDistanceKept whether the distance rule applies
   */
  void AddEdgeOrTriangle(const EdgeIds& ends, const IdLists& pointTriangles, bool isDistanceKept);
  /** Requests the largest boundary triangle at the tetrahedron's points that may be split. */
  void AddLargestTriangle(const TetrahedronIds& ids, const IdLists& pointTriangles);

  std::size_t GetNumber() const { return this->Triangles.size() + this->Edges.size(); }
  std::vector<Id> Triangles;
  std::vector<EdgeIds> Edges;

private:
  template <typename Ids>
  bool MayHavePoint(const Ids& ids, double distance) const;
  bool AddEdge(Id edge, bool isDistanceKept);
  void AddTriangle(Id triangle);
  void AddLargest(const std::vector<Id>& triangles, bool isDistanceKept);

  const TriangleMesh& Surface;
  const std::vector<StructuralEdge>& SurfaceEdges;
  const DistanceRule Rule;
  std::vector<char> IsTriangleRequested;
  std::vector<char> IsEdgeRequested;
};
} // namespace cdm

#endif
