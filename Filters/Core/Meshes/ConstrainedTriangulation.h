// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConstrainedTriangulation.h
 * @brief Triangulates a nearly planar patch with given outlines, points and segments.
 *
 * Method:
 *  1. AddOutline: polygons are triangulated as in stage 0 (PolygonTriangulation.h);
 *  2. AddPoint: the triangle or the two triangles at an edge where a point lies are split;
 *  3. AddSegment: the edges that a segment crosses are flipped until none is left; where it runs
 *     through a vertex it is divided there;
 *  4. Improve: the other edges are flipped where that makes the opposite angles smaller (Delaunay).
 *     Ties, as in squares, are decided by the point ids alone, so that two patches that hold the
 *     same points, edges and segments are triangulated alike.
 *
 * Every decision is an exact sign in the projection along one axis: points that are off the plane
 * by a rounding error do no harm.
 *
 * Inputs: the axis and the sign of counter-clockwise turns along it, as by FindProjectionAxis. Ids
 * of points; different ids need different coordinates.
 * Guarantees: at all times all triangles are strictly positive in the projection, hence never
 * degenerate, and their boundary is the outlines. What cannot be added is left out.
 * Cost: O(n) for each point and segment of a patch of n triangles.
 *
 * References: S. W. Sloan, "A fast algorithm for generating constrained Delaunay triangulations",
 * 1993, doi:10.1016/0045-7949(93)90239-A (segments by flips).
 */
#ifndef cdmConstrainedTriangulation_h
#define cdmConstrainedTriangulation_h

#include "Core/Basics/SortedIds.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace cdm
{
class ConstrainedTriangulation
{
public:
  ConstrainedTriangulation(const std::vector<Vec3>& points, int axis, int sign)
    : Points(points), Axis(axis), Sign(sign)
  {
  }

  /** A closed polygon without repeated vertices. False if it is not simple and positive. */
  bool AddOutline(const std::vector<Id>& outline);

  /** False if the point is not inside, or coincides with another one in the projection. */
  bool AddPoint(Id point);

  /** False if one of the ends is missing, or an outline or another segment is in the way. */
  bool AddSegment(Id from, Id to);

  void Improve();

  const std::vector<TriangleIds>& GetTriangles() const { return this->Triangles; }

private:
  static std::uint64_t MakeEdgeKey(Id a, Id b) { return PackIds(MakeEdge(a, b)); }

  int Turn(Id a, Id b, Id c) const;
  bool IsAhead(Id from, Id to, Id point) const;
  /** The triangle that runs from a to b, or NoId. */
  Id FindTriangle(Id a, Id b) const;
  /** The vertex opposite to the edge from a to b, or NoId. */
  Id FindApex(Id a, Id b) const;
  void SetTriangle(Id triangle, const TriangleIds& ids);
  bool IsConstrained(Id a, Id b) const;
  bool CanFlip(Id a, Id b) const;
  void Flip(Id a, Id b);
  bool IsImprovedByFlip(Id a, Id b) const;
  bool FlipCrossingEdges(Id from, Id to, const std::vector<EdgeIds>& crossing);

  const std::vector<Vec3>& Points;
  int Axis;
  int Sign;
  std::vector<TriangleIds> Triangles;
  /** The triangle at each directed edge. */
  std::unordered_map<std::uint64_t, Id> TriangleAt;
  std::unordered_set<std::uint64_t> Segments;
  std::unordered_set<Id> Vertices;
};
} // namespace cdm

#endif
