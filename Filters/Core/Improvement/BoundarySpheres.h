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
 * Exact. Cost: O(1) for a point, in cells of BallIndex.h, and for a triangle or edge that changes;
 * about 100 bytes per triangle and edge.
 */
#ifndef cdmBoundarySpheres_h
#define cdmBoundarySpheres_h

#include "Core/Meshes/TriangleMesh.h"
#include "Core/Search/BallIndex.h"
#include "Core/Surface/StructuralEdges.h"

#include <cstdint>
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
    /** Work space. */
    std::vector<Id> Near;

    bool IsEmpty() const { return this->Triangles.empty() && this->Edges.empty(); }
    void Clear()
    {
      this->Triangles.clear();
      this->Edges.clear();
    }
  };
  /** Several threads may call it at once. */
  void Find(const Vec3& position, Encroached& encroached) const;
  /** Whether a point encroaches on one of those that another point does. */
  bool IsOnOneOf(const Encroached& encroached, const Vec3& position) const;

  /**
   * Follows splits and moves of the surface.
   * @param triangles that are new, or have got other points or positions
   * @param changedEdges the same for edges
   * @param segments for each edge a number that it keeps in other lists: at first its index
   */
  void Follow(const std::vector<Id>& triangles, const std::vector<Id>& changedEdges,
    const std::vector<Id>& segments);

  /** How many spheres have been put into the search so far. */
  std::int64_t GetNumberOfVisits() const { return this->NumberOfVisits; }

private:
  bool IsOnTriangle(Id triangle, const Vec3& position) const;
  bool IsOnEdge(Id edge, const Vec3& position) const;
  void SetTriangle(Id triangle);
  void SetEdge(Id edge, Id segment);

  const TriangleMesh& Surface;
  const std::vector<StructuralEdge>& Edges;
  /** Balls that enclose the spheres of triangles t (2 t) and segments s (2 s + 1). */
  BallIndex Balls;
  /** The edge of each segment. */
  std::vector<Id> SegmentEdges;
  std::int64_t NumberOfVisits = 0;
};
} // namespace cdm

#endif
