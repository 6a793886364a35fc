// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinableSurface.h
 * @brief A surface with adjacency whose smooth edges can be flipped and whose edges and triangles
 *   can be split.
 *
 * Two triangles with equal orientation meet across each smooth edge. Structural edges are made of
 * segments, each of which knows all triangles at it. In this file a facet is a surface facet: a set
 * of triangles connected across smooth edges (the facet of a piecewise linear complex, PLC; curved
 * if there is an accuracy angle). Edge i of triangle t runs from its vertex i to vertex i + 1; its
 * use is 3 * t + i.
 *
 * Invariants: Adjacent[i] of a triangle is the use at the other side of a smooth edge, whose
 * Adjacent points back, or -1 - s for segment s, one of whose uses it then is. Triangles and
 * segments keep their index for ever: a split shrinks the old one and appends the rest.
 */
#ifndef cdmRefinableSurface_h
#define cdmRefinableSurface_h

#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/StructuralEdges.h"

#include <array>
#include <utility>
#include <vector>

namespace cdm
{
class RefinableSurface
{
public:
  struct Triangle
  {
    TriangleIds Points;
    std::array<Id, 3> Adjacent{ NoId, NoId, NoId };
    Id Facet = NoId;
    Id Source = NoId;
    RegionPair Labels;
    /** Reversed against the input; Export() sets it back. */
    bool IsReversed = false;
  };

  struct Segment
  {
    EdgeIds Points;
    StructuralEdgeKind Kind;
    Id Chain;
    double DihedralAngle;
    /** The input edge that the segment is a piece of: index into GetInputEdges(). */
    Id InputEdge;
    /** The segment's uses are a range of one list of all uses; their number never changes. */
    Id FirstUse;
    Id NumberOfUses;
  };

  /** points is shared with the caller, who may append to it. */
  RefinableSurface(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
    const std::vector<Vec3>& points);

  Id GetNumberOfTriangles() const { return static_cast<Id>(this->Triangles.size()); }
  Id GetNumberOfSegments() const { return static_cast<Id>(this->Segments.size()); }
  const Triangle& GetTriangle(Id t) const { return this->Triangles[t]; }
  const Segment& GetSegment(Id s) const { return this->Segments[s]; }
  /** End points of the structural edges of the input. */
  const std::vector<EdgeIds>& GetInputEdges() const { return this->InputEdges; }

  /** Segment at edge i of triangle t, or NoId if the edge is smooth. */
  Id GetSegmentAt(Id t, int i) const
  {
    const Id adjacent = this->Triangles[t].Adjacent[i];
    return adjacent < 0 ? -1 - adjacent : NoId;
  }

  /** The point opposite to a use's edge. */
  Id GetApex(Id use) const { return this->Triangles[use / 3].Points[(use % 3 + 2) % 3]; }

  /** Facets that a segment borders on, ascending. */
  std::vector<Id> GetFacets(Id segment) const;

  /**
   * Whether the two triangles at a smooth edge form a strictly convex quadrilateral (exact). No
   * corner counts as convex at which two pieces of one edge of the input meet.
   */
  bool IsConvex(Id use) const;

  /** Flip the diagonal of the quadrilateral at a smooth edge. */
  void Flip(Id use);

  /**
   * Whether every triangle at the segment keeps its orientation if the segment is split at a
   * position (exact in the projection along the normal).
   */
  bool CanSplitSegment(Id segment, const Vec3& position) const;

  /** The same for a smooth edge. */
  bool CanSplitSmoothEdge(Id use, const Vec3& position) const;

  /** Split a segment at a point; uses lists the edges opposite to the point. */
  void SplitSegment(Id segment, Id point, std::vector<Id>& uses);

  /**
   * Position of a point relative to a triangle in the projection along its normal: strictly inside
   * (NoId, true), on an edge (its index, true), or outside beyond an edge (its index, false).
   */
  std::pair<Id, bool> Locate(Id triangle, const Vec3& position) const;

  /** Split a triangle at a point strictly inside. */
  void SplitTriangle(Id triangle, Id point, std::vector<Id>& uses);

  /** Split the two triangles at a smooth edge at a point on it. */
  void SplitSmoothEdge(Id use, Id point, std::vector<Id>& uses);

  /** Triangles, labels and sources, with the orientations of the input. */
  void Export(TriangleMesh& surface) const;

private:
  void AddInputEdge(const StructuralEdge& edge, const EdgeUse* uses, Id count);
  void ReplaceUse(Id segment, Id former, Id use);
  void Connect(Id use, Id adjacent, Id formerUse);
  bool CanSplitUse(Id use, const Vec3& position) const;
  Id SplitUse(Id use, Id point);
  bool AreOnOneInputEdge(Id first, Id second) const;
  void TurnTriangle(Id t);
  void MakeFacets();
  int GetProjectionAxis(Id triangle, int& turn) const;

  const std::vector<Vec3>& Points;
  std::vector<Triangle> Triangles;
  std::vector<Segment> Segments;
  std::vector<Id> SegmentUses;
  std::vector<EdgeIds> InputEdges;
};
} // namespace cdm

#endif
