// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetMesh.h
 * @brief A tetrahedral mesh of several regions with adjacency, in flat arrays.
 *
 * 36 bytes per tetrahedron (16 vertices, 16 neighbours, 4 region); 24 bytes per point.
 */
#ifndef cdmTetMesh_h
#define cdmTetMesh_h

#include "Core/Basics/RawVector.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <vector>

namespace cdm
{
/**
 * Facet i of a tetrahedron (its face) lies opposite to its vertex i. A facet id is 4 * tetrahedron
 * + i. The facets of a surface (StructuralEdges.h) are something else: sets of triangles.
 *
 * Invariants: every tetrahedron is positively oriented (exact sign); Regions and Neighbors have one
 * entry for each tetrahedron; Neighbors[t][i] is the facet id, seen from the other tetrahedron, of
 * the tetrahedron that shares facet i, also across interfaces between regions, and NoId where there
 * is none. CertifyMesh() in MeshCertificate.h tests all of it.
 */
struct TetMesh
{
  std::vector<Vec3> Points;
  RawVector<TetrahedronIds> Tetrahedra;
  RawVector<Id> Regions;
  RawVector<TetrahedronIds> Neighbors;
};

/**
 * Vertices of the facet opposite to each vertex of a tetrahedron, in the order for which the front
 * side (the normal) looks out of the tetrahedron.
 */
constexpr int FacetVertices[4][3] = { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } };

/** Vertices of the edges; edges i and 5 - i are opposite to each other. */
constexpr int TetrahedronEdges[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 },
  { 2, 3 } };

inline TriangleIds GetFacet(const TetrahedronIds& tetrahedron, int facet)
{
  return { tetrahedron[FacetVertices[facet][0]], tetrahedron[FacetVertices[facet][1]],
    tetrahedron[FacetVertices[facet][2]] };
}

/** Whether the normal of a triangle keeps its direction when its three points are sorted. */
inline bool IsEven(const TriangleIds& ids)
{
  // Two steps up around it, and not two steps down.
  return (ids[0] < ids[1]) + (ids[1] < ids[2]) + (ids[2] < ids[0]) == 2;
}

/** The positions of the vertices. */
inline std::array<Vec3, 4> GetCorners(
  const std::vector<Vec3>& points, const TetrahedronIds& tetrahedron)
{
  return { points[tetrahedron[0]], points[tetrahedron[1]], points[tetrahedron[2]],
    points[tetrahedron[3]] };
}

/** The vertices by their new numbers. */
inline TetrahedronIds Renumber(const TetrahedronIds& tetrahedron, const std::vector<Id>& newIds)
{
  return { newIds[tetrahedron[0]], newIds[tetrahedron[1]], newIds[tetrahedron[2]],
    newIds[tetrahedron[3]] };
}

/** Drops tetrahedra whose vertex 0 is NoId; the others keep their order. */
void RemoveDeadTetrahedra(TetMesh& mesh);
} // namespace cdm

#endif
