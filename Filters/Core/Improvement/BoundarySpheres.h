// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundarySpheres.h
 * @brief Which triangles and structural edges of a surface a new point would disturb.
 *
 * A point disturbs a triangle or an edge if it lies in its smallest sphere or on it (Crit. 3.1 and
 * 3.2; "encroaches" in the literature on Delaunay refinement). If no point does, all of them stay
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
  /** Both have to outlive the object. */
  BoundarySpheres(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges);

  /** What a point disturbs: triangles and edges by their indices, ascending. */
  struct Disturbed
  {
    std::vector<Id> Triangles;
    std::vector<Id> Edges;

    bool IsEmpty() const { return this->Triangles.empty() && this->Edges.empty(); }
  };
  void Find(const Vec3& position, Disturbed& disturbed);

private:
  const TriangleMesh& Surface;
  const std::vector<StructuralEdge>& Edges;
  /** Triangles, then edges. */
  BallIndex Balls;
  std::vector<Id> Near;
};
} // namespace cdm

#endif
