// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FourthPointSearch.h
 * @brief The point that completes a triangle to a Delaunay tetrahedron (thesis 6.4.2, Crit. 6.2).
 *
 * The spheres through a triangle form a pencil: their centers lie at H + lambda * n, H being the
 * circumcenter and n the normal. Every point in front of the triangle has its lambda; the smallest
 * one belongs to the empty sphere.
 *
 * Method: visit the nodes of the octree in the order of their lower bounds of lambda and give every
 * point an interval that is sure to hold its lambda (double arithmetic with forward error bounds);
 * leave out boxes that lie behind the plane or outside of the best sphere so far, both by more than
 * the error; decide among the points whose intervals overlap the best one with exact predicates.
 * (Depth first, nearest first was ten times slower on surfaces: it looks at everything beside the
 * triangle before it reaches the other side.)
 *
 * Cost: proportional to the points near the sphere that is found; nothing else is exact.
 */
#ifndef cdmFourthPointSearch_h
#define cdmFourthPointSearch_h

#include "PointOctree.h"
#include "Types.h"
#include "Vec3.h"

#include <limits>
#include <vector>

namespace cdm
{
struct FourthPoint
{
  /** The point of smallest lambda strictly in front, or NoId: the triangle is on the hull. */
  Id Point = NoId;
  /** An approximation of its lambda in units of the normal (b - a) x (c - a). */
  double Lambda = std::numeric_limits<double>::infinity();
  /** All points in front on its sphere, Point included; ascending. */
  std::vector<Id> Cospherical;
  /** Points in the plane of the triangle and on its circumcircle; ascending. */
  std::vector<Id> Cocircular;
  /** A point in the plane strictly inside of the circumcircle, or NoId. */
  Id InsideCircle = NoId;
};

class FourthPointSearch
{
public:
  FourthPointSearch(const std::vector<Vec3>& points, const PointOctree& octree)
    : Points(points)
    , Octree(octree)
  {
  }

  /**
   * Search in front of the triangle. Points whose lambda is certainly above the limit may be left
   * out; the limit is in units of the normal.
   */
  void Find(const TriangleIds& triangle, FourthPoint& result,
    double limit = std::numeric_limits<double>::infinity());

private:
  struct Candidate
  {
    Id Point;
    double LambdaLow;
    double LambdaHigh;
  };

  const std::vector<Vec3>& Points;
  const PointOctree& Octree;
  std::vector<Candidate> Candidates;
  PointOctree::WaitingNodes Waiting;

  friend class PencilVisitor;
};
}

#endif
