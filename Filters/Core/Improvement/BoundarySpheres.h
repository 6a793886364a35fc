// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundarySpheres.h
 * @brief Finds the triangles and structural edges of a surface on which a new point would encroach.
 *
 * A point encroaches on a triangle or an edge if it lies in its smallest sphere or on it (Crit. 3.1
 * and 3.2). The smallest sphere of an edge is its diametral sphere, that of a triangle its
 * equatorial sphere; a simplex whose smallest sphere is empty has the Gabriel property. The
 * thesis says "disturb" for encroach. If no point encroaches on them, all triangles and edges stay
 * part of the Delaunay mesh.
 *
 * Exact. Cost: O(1) for a point, in cells of BallIndex.h; about 100 bytes per triangle and edge.
 */
#ifndef cdmBoundarySpheres_h
#define cdmBoundarySpheres_h

#include "Core/Meshes/TriangleMesh.h"
#include "Core/Search/BallIndex.h"
#include "Core/Surface/StructuralEdges.h"

#include <vector>

namespace cdm
{
class BoundarySpheres
{
public:
  /** Surface and edges have to outlive the object. */
  BoundarySpheres(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges);

  /** The triangles and edges on which a point encroaches, by their indices, ascending. */
  struct Encroached
  {
    std::vector<Id> Triangles;
    std::vector<Id> Edges;

    bool IsEmpty() const { return this->Triangles.empty() && this->Edges.empty(); }
  };
  void Find(const Vec3& position, Encroached& encroached);

private:
  const TriangleMesh& Surface;
  const std::vector<StructuralEdge>& Edges;
  /** Balls around triangles, then around edges, a little too large. */
  BallIndex Balls;
  std::vector<Id> Near;
};
} // namespace cdm

#endif
