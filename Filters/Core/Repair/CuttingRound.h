// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CuttingRound.h
 * @brief One round of cutting triangles along their intersections.
 *
 * Method: add all pairs that intersect, connect the chains, then cut the triangles that change.
 *  1. points where an edge pierces a triangle or crosses an edge are made once (PointGrid.h);
 *     within the tolerance of an edge they divide it, in all triangles that have it;
 *  2. a chain of points runs along the line that two triangles have in common, or along the part of
 *     an edge that lies in another triangle. Chains meet at points beside them and where they
 *     cross;
 *  3. a triangle is triangulated anew with its points and chains (ConstrainedTriangulation.h).
 *
 * Inputs: triangles without repeated points, no two points equal.
 * Guarantees: both triangles at an edge divide it at the same points. Points are appended;
 * triangles stay as they are until the caller exchanges them for their pieces.
 * Cost: O(n log n) to set up for n triangles; quadratic in the number of cuts of a triangle.
 */
#ifndef cdmCuttingRound_h
#define cdmCuttingRound_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Search/PointGrid.h"

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace cdm
{
class CuttingRound
{
public:
  /**
   * Points and triangles have to outlive this.
   * @param tolerance in model units, positive
   * @param onNewPoint is told of the triangle that a new point, the last one, lies in
   */
  CuttingRound(std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
    double tolerance, std::function<void(Id)> onNewPoint);

  /** Two triangles that intersect, or lie within the tolerance of each other. */
  void AddPair(Id s, Id t);

  /** For a triangle on one line, up to the tolerance: its middle vertex divides its long edge. */
  void AddDegenerate(Id t);

  /** Lets chains meet: at points beside them, then where they cross. */
  void ConnectChains();

  /** All triangles that change, ascending. */
  std::vector<Id> GetChangedTriangles() const;

  /** The pieces of a triangle; safe: how many of them, the first ones, surely have an area. */
  std::vector<TriangleIds> Cut(Id t, std::size_t& safe) const;

private:
  using EdgeTriangle = std::pair<EdgeIds, Id>;
  using EdgeRange =
    std::pair<std::vector<EdgeTriangle>::const_iterator, std::vector<EdgeTriangle>::const_iterator>;
  /**
   * Points on the common line of two triangles, or on an edge of one: then the other one is NoId.
   */
  struct Chain
  {
    std::array<Id, 2> Triangles;
    std::vector<Id> Points;
  };

  EdgeRange FindEdge(const EdgeIds& edge) const;
  bool IsNearEdge(Id point, Id a, Id b) const;
  bool IsNearPlane(Id s, Id t) const;
  void AddNeedle(Id t);
  void DivideEdge(Id point, Id a, Id b);
  void AddPoint(Id point, Id t);
  Id MakePoint(const Vec3& p, Id t);
  void MoveToAxisPlane(const TriangleIds& t, Vec3& p) const;
  Id MakeContact(const ContactPoint& contact, Id s, Id t);
  int GetAxis(Id t) const;
  Vec3 CrossSegments(int axis, const EdgeIds& s, const EdgeIds& t) const;
  void AddCrossing(Id s, Id t);
  void AddNearVertices(Id s, Id t, std::vector<Id>& ids) const;
  void AddOverlap(Id s, Id t);
  void AddChain(std::array<Id, 2> pieces, std::vector<Id> ids);
  void InsertInChain(Chain& chain, std::size_t position, Id id);
  void AttachPoints(Id t);
  void CrossChains(Id t);
  void CrossChains(int axis, Id t, Chain& first, Chain& second);
  std::vector<std::vector<Id>> MakeLoops(const TriangleIds& ids) const;

  std::vector<Vec3>& Points;
  const std::vector<TriangleIds>& Triangles;
  double Tolerance;
  PointGrid Grid;
  std::function<void(Id)> OnNewPoint;
  /** Each edge with each of its triangles, ascending. */
  std::vector<EdgeTriangle> Edges;
  /** Points on edges, by key of the edge, and inside of triangles. */
  std::unordered_map<std::uint64_t, std::vector<Id>> OnEdge;
  std::unordered_map<Id, std::vector<Id>> Inside;
  /** The chains in each triangle. */
  std::unordered_map<Id, std::vector<Id>> ChainsAt;
  std::vector<Chain> Chains;
};
} // namespace cdm

#endif
