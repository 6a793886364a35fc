// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StructuralEdges.h
 * @brief Stage 1: structural edges, the edges of a surface that a mesh has to keep (thesis Def.
 *   6.2;
 * "feature edges" or "sharp edges" in the literature).
 *
 * An edge is structural if it is open (one triangle), shared by more than two triangles, a border
 * between different BoundaryLabels, or if its dihedral angle differs from 180 degrees by more than
 * the accuracy angle. Whatever the accuracy angle, edges are smooth in facets that are plane to
 * FlatnessRatio times the size of the surface, because coordinates in files are rounded
 * (FlatFacets.h). The size is the diagonal of the bounding box. Far from the origin coordinates are
 * rounded to more than that: the distance is at least 5e-16 times the largest coordinate, about
 * four times what that is rounded by.
 *
 * Exactly: let n and m be the normals of the two triangles, reversed where needed so that the
 * triangles are oriented consistently along their edge; the edge bends by the angle between n and m
 * (0 is flat, 180 folded back). The edge is smooth if it bends by no more than the accuracy angle,
 * if its facet is plane, or if it bends by no more than one degree and each opposite vertex is no
 * farther from the other's plane than 1e-9 times the size. A triangle without area has no normal:
 * its edges are never smooth but in a plane facet. Labels are compared after the triangles have
 * been oriented consistently; surfaces without labels have no label change. After a refinement,
 * small triangles may bend by as little at edges that were structural: the option Facets keeps
 * these edges, and the facets whole.
 *
 * Method:
 *  1. sort all edges of all triangles, judge each group of equal edges;
 *  2. trace chains from corners (points where not exactly two structural edges meet), in the order
 *     of the corners' ids and, at a corner, of the edges;
 *  3. what is left are closed chains, each traced from its smallest point.
 *
 * Guarantees: deterministic; edges come in the order of (smaller id, larger id).
 * Failure: InvalidInput names triangles with ids out of range or repeated, and points that are not
 * finite; the output is then empty, as after an abort.
 * Cost: O(n log n); 28 bytes per structural edge.
 */
#ifndef cdmStructuralEdges_h
#define cdmStructuralEdges_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
/** In order of precedence: an edge that is several of these is the first of them. */
enum class StructuralEdgeKind : unsigned char
{
  Open = 0,
  NonManifold = 1,
  LabelChange = 2,
  Sharp = 3
};

struct StructuralEdge
{
  /** Smaller id first. */
  EdgeIds Points{ NoId, NoId };
  StructuralEdgeKind Kind = StructuralEdgeKind::Sharp;
  /** Chain of edges between corners (or closed) that the edge belongs to, from 0. */
  Id Chain = NoId;
  /**
   * Degrees, 0 to 180: the smallest angle between two neighbouring triangles around the edge; 180
   * is flat. -1 for an open edge.
   */
  double DihedralAngle = 0.0;
};

struct StructuralEdgeOptions
{
  /** Degrees, 0 to 180: edges that bend by no more are smooth. 0: only numerically flat ones. */
  double AccuracyAngle = 0.0;
  /** How far points of plane facets are from their plane, as a ratio of the size; 0 to 1. */
  double FlatnessRatio = 5e-7;
  /**
   * Surface facet of each triangle, as NumberFacets() gave it for the surface that this one
   * refines: edges between different facets are structural. Empty: not known.
   */
  std::vector<Id> Facets = {};
  /**
   * Marks triangles at whose edges accuracy angle and plane facets do not count, only the last digits
   * of the coordinates; empty: none.
   */
  std::vector<char> IsExact = {};
};

struct StructuralEdgesOutput
{
  std::vector<StructuralEdge> Edges;
  /** Points where chains end, ascending. */
  std::vector<Id> Corners;
  Id NumberOfChains = 0;
  /** Whether a plane facet bends by more than the rounding of double precision. */
  bool HasRoundedFacets = false;
};

Status ExtractStructuralEdges(const TriangleMesh& surface, const StructuralEdgeOptions& options,
  const ExecutionContext& context, StructuralEdgesOutput& output);

/**
 * Numbers the surface facets (the facets of a PLC): sets of triangles connected across edges that
 * are not structural. One number for each triangle, from 0, in the order of the facets' first
 * triangles.
 * @param uses of the surface's triangles
 */
std::vector<Id> NumberFacets(
  const std::vector<EdgeUse>& uses, const std::vector<StructuralEdge>& edges);

/** The edge between two points, the smaller id first, in a sorted list; null if it is not there. */
const StructuralEdge* FindStructuralEdge(
  const std::vector<StructuralEdge>& edges, const EdgeIds& points);

/**
 * Whether two triangles (a, b, c) and (b, a, d) count as flat or bend by no more than the accuracy
 * angle: the rule above in one place. flatness is a distance in model units.
 */
bool IsSmoothEdge(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double accuracyAngle,
  double flatness);
/** The same for an edge of a surface, from two of its uses. */
bool IsSmoothEdge(const TriangleMesh& surface, const EdgeUse& first, const EdgeUse& second,
  double accuracyAngle, double flatness);

/** Diagonal of the bounding box of the points; 0 without points. */
double GetBoundingBoxDiagonal(const std::vector<Vec3>& points);

/** The largest absolute value of a coordinate, which tells how far coordinates are rounded. */
double GetLargestCoordinate(const std::vector<Vec3>& points);

/** FlatnessRatio as a distance in model units, for a surface with these points. */
double GetFlatness(double flatnessRatio, const std::vector<Vec3>& points);
} // namespace cdm

#endif
