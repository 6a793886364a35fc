// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NegativeCouplings.h
 * @brief Edges of a boundary with a negative coupling in the box method.
 *
 * The coupling of an edge is the signed area of its Voronoi facet within a region. Edges inside of
 * a region have no negative coupling in a Delaunay mesh. At an edge of the boundary the Voronoi
 * facet ends where it meets the triangles there. A part of it counts negative where it lies beyond
 * the edge, which takes a point in the edge's smallest sphere. Crit. 3.2 would exclude that for all
 * edges; Crit. 3.1 excludes it for edges within surface facets.
 *
 * Method: only edges whose smallest spheres are not empty are looked at. After the first time only
 * those at tetrahedra that are new, and at triangles that have changed: walks around these edges
 * find their tetrahedra. At first, and where the walk misses some, as bodies touch at the edge, all
 * tetrahedra are looked through.
 *
 * Deterministic. Cost: O(m log m) for m new tetrahedra; O(n) for n in all at first, twice through
 * all of them, and wherever bodies touch.
 * Reference: P. Fleischmann, thesis, 3.1.
 */
#ifndef cdmNegativeCouplings_h
#define cdmNegativeCouplings_h

#include "Core/Basics/IdLists.h"
#include "Core/Basics/ThreadTeam.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Meshes/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace cdm
{
class NegativeCouplings
{
public:
  /**
   * Edges of the boundary whose coupling in a region is negative, ascending.
   * @param mesh has the points of the boundary first; the same mesh each time
   * @param pointTriangles the triangles at each point of the boundary
   * @param team whose threads share the work
   */
  const std::vector<EdgeIds>& Update(const DynamicTetrahedralization& mesh,
    const TriangleMesh& boundary, const IdLists& pointTriangles, ThreadTeam& team);

  /** Notes that triangles of the boundary have changed. */
  void NoteTriangles(const TriangleMesh& boundary, const std::vector<Id>& triangles);

  /** How many tetrahedra have been looked at. */
  std::int64_t GetNumberOfVisits() const { return this->NumberOfVisits; }

private:
  /** An edge that may have got another coupling. */
  struct Candidate
  {
    /** See PackIds(). */
    std::uint64_t Edge;
    /** A tetrahedron at the edge * 6 + its number there, or NoId if none is known. */
    Id Simplex;
  };
  /** What is known of an edge: Unknown where its tetrahedra have to be looked for among all. */
  enum class Finding : unsigned char
  {
    NotNegative,
    Negative,
    Unknown
  };
  struct Answer
  {
    Finding What = Finding::NotNegative;
    /** How many tetrahedra have been looked at. */
    std::uint32_t NumberOfVisits = 0;
  };
  static Answer Test(const Candidate& candidate, const DynamicTetrahedralization& mesh,
    const TriangleMesh& boundary, const IdLists& pointTriangles, bool areAll);
  void Note(const TriangleIds& ids);
  bool CollectChanged(
    const DynamicTetrahedralization& mesh, const TriangleMesh& boundary, int numberOfThreads);

  std::vector<EdgeIds> Negative;
  /** Edges of triangles that have changed since the last update, then all that may have. */
  std::vector<Candidate> Changed;
  /** Tetrahedra that have been made since then are new. */
  MeshMoment Last;
  /** Work space, as for VisitAscending(), and what was found of each edge. */
  std::vector<std::uint64_t> Marks;
  std::vector<Answer> Answers;
  std::int64_t NumberOfVisits = 0;
};

/**
 * Those of some edges of the boundary whose coupling in a region is negative; both lists ascend.
 * @param mesh has the points of the boundary first
 * @param team whose threads share the work
 */
std::vector<EdgeIds> FindNegativeCouplings(const TetMesh& mesh, const std::vector<EdgeIds>& edges,
  Id numberOfBoundaryPoints, ThreadTeam& team);

/**
 * Whether two points are joined by an edge of the boundary.
 * @param pointTriangles the triangles at each point of the boundary
 */
bool IsBoundaryEdge(
  const TriangleMesh& boundary, const IdLists& pointTriangles, const EdgeIds& edge);

/**
 * Whether the coupling of edge i of a tetrahedron is negative: within the tetrahedra around it up to
 * those of other regions.
 */
bool HasNegativeCoupling(const DynamicTetrahedralization& mesh, Id tetrahedron, int edge);
} // namespace cdm

#endif
