// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceSides.h
 * @brief Finds the sides of triangles that look into the same space.
 *
 * Side 2 * t is the front and 2 * t + 1 the back of triangle t. Around every edge the triangles are
 * sorted by angle, exactly; sides that face each other across the wedge between two neighbours are
 * joined. A shell is a set of joined sides. Every edge-connected component of the surface has one
 * outer shell: the one that looks away from all it encloses; each other shell is the outermost
 * border of an enclosed segment of space.
 *
 * Guarantees: shells are numbered by their smallest side. Cost: O(n log n).
 */
#ifndef cdmSurfaceSides_h
#define cdmSurfaceSides_h

#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
struct SurfaceSides
{
  /** The shell of each side. */
  std::vector<Id> Shells;
  /** For each shell: whether it is the outer one of its component. */
  std::vector<char> IsOuter;
  /** For each shell: whether its component has an open edge. */
  std::vector<char> IsOpen;
  /** For each triangle: the edge-connected component, numbered by its smallest triangle. */
  std::vector<Id> Components;
  /** Triangles with an open edge, ascending. */
  std::vector<Id> OpenTriangles;
};

SurfaceSides FindSurfaceSides(const TriangleMesh& surface);

/** A triangle at an edge, which runs from the smaller to the larger point id. */
struct TriangleAtEdge
{
  EdgeIds Edge;
  Id Triangle;
  Id Apex;
  /** The triangle runs along the edge in its direction: its front faces growing angles. */
  bool IsForward;
};

/** Sorts the triangles at one edge by their angle from the first one, exactly. */
void SortAroundEdge(const std::vector<Vec3>& points, TriangleAtEdge* begin, TriangleAtEdge* end);
} // namespace cdm

#endif
