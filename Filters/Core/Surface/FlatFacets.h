// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FlatFacets.h
 * @brief Which edges of a surface lie in facets that are plane but for the digits of their points.
 *
 * Files keep six or seven digits of a coordinate. A plane facet of many triangles then bends at
 * nearly all of its edges, by far less than its size. Were these edges kept, each narrow triangle
 * would be a facet with sharp angles of its own. A curved facet of very small triangles bends as
 * little from one to the next, so facets are looked at as a whole.
 *
 * Method:
 *  1. two triangles are united at an edge where they bend by at most one degree, the vertex of the
 *     narrower one is within the tolerance of the other's plane, and the other one is wider than
 *     the tolerance: narrower ones have no plane of their own;
 *  2. united triangles make up a facet. Its plane is normal to its vector area, which depends on
 *     its outline only: it is the same however the facet is divided;
 *  3. the facet is plane if its points differ by at most twice the tolerance in height over that
 *     plane, and if no triangle is turned from it by more than 60 degrees. Then all edges between
 *     triangles of the facet are flat;
 *  4. triangles are united by 1.75 times the tolerance first, then by once. What is still not plane is
 *     tried again with a tenth of the tolerance, until that would be less than the rounding of double
 *     precision. There each edge counts by itself (IsSmoothEdge()).
 * Known facets, of a surface that has been refined since, are looked at first, as a whole. Far from the
 * origin triangles may be no wider than their coordinates are rounded: these may be turned there.
 *
 * Guarantees: deterministic; no edge is flat whose facet is off its plane by more than the
 * tolerance, but for edges that are flat to RoundedFlatnessRatio.
 * Cost: O(n) for each of at most ten tolerances, for one if no edge is flat to more than rounding;
 * 100 bytes per triangle.
 */
#ifndef cdmFlatFacets_h
#define cdmFlatFacets_h

#include "Core/Meshes/TriangleMesh.h"

#include <utility>
#include <vector>

namespace cdm
{
/** The part of the size of a surface (GetFlatness()) that counts as rounding in double precision. */
constexpr double RoundedFlatnessRatio = 1e-9;
/** The same where edges have to stay as they are: no more than the last digits of the coordinates. */
constexpr double ExactFlatnessRatio = 1e-15;

/** Two triangles at an edge, as uses of it (EdgeUses.h). */
using UsePair = std::pair<Id, Id>;

struct FlatFacetOptions
{
  /** Model units: how far points of a facet may be from its plane. */
  double Tolerance = 0.0;
  /** Model units: rounding of double precision. Within it edges are judged one by one. */
  double RoundedTolerance = 0.0;
  /** Whether each pair is known to lie in one facet, plane or not. */
  bool AreFacetsKnown = false;
};

/** For each pair of triangles, which may be oriented as they like, whether their edge is flat. */
std::vector<char> FindFlatEdges(
  const TriangleMesh& surface, const std::vector<UsePair>& pairs, const FlatFacetOptions& options);
} // namespace cdm

#endif
