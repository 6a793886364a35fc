// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryRequests.h
 * @brief What of the boundary is to be split for tetrahedra that no point inside mends.
 *
 * An edge of the boundary, or one of its triangles, each at most once, and only if its ends or
 * corners may have a new point that close to them.
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
  /** Whether a new point may come to a point of the surface at a distance. */
  using DistanceRule = std::function<bool(Id point, double distance)>;

  /** Surface and edges have to outlive the object. */
  BoundaryRequests(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    DistanceRule mayHavePoint);

  /** Nothing is requested any more; the surface may be another one. */
  void Clear();

  /**
   * What the position disturbs most; edges before triangles.
   * @param isDistanceKept whether the rule is asked
   */
  void AddDisturbed(
    const Vec3& position, const BoundarySpheres::Disturbed& disturbed, bool isDistanceKept);
  /**
   * Where two triangles of the boundary that lie almost in a plane have a common circumcircle,
   * almost, they share a flat tetrahedron. No point inside destroys it; a point on their edge does.
   * @return whether that is so
   */
  bool AddEdgeOfTwoTriangles(const TetrahedronIds& ids, const IdLists& pointTriangles);
  /** An edge of the boundary, or the largest triangle at it if it is within a facet. */
  void AddEdgeOrTriangle(const EdgeIds& ends, const IdLists& pointTriangles);
  /** The largest triangle at the tetrahedron's points on the boundary that may be split. */
  void AddLargestTriangle(const TetrahedronIds& ids, const IdLists& pointTriangles);

  std::size_t GetNumber() const { return this->Triangles.size() + this->Edges.size(); }
  std::vector<Id> Triangles;
  std::vector<EdgeIds> Edges;

private:
  template <typename Ids>
  bool MayHavePoint(const Ids& ids, double distance) const;
  bool AddEdge(Id edge, bool isDistanceKept);
  void AddTriangle(Id triangle);
  void AddLargest(const std::vector<Id>& triangles);

  const TriangleMesh& Surface;
  const std::vector<StructuralEdge>& SurfaceEdges;
  const DistanceRule Rule;
  std::vector<char> IsTriangleRequested;
  std::vector<char> IsEdgeRequested;
};
} // namespace cdm

#endif
