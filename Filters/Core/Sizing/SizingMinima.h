// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizingMinima.h
 * @brief Where a sizing field that is given at the points of cells is smallest within a
 *   tetrahedron, a triangle or a box.
 *
 * A linear function is smallest at a corner of the polytope that a cell of the field has in common
 * with the region. Method:
 *  1. a hierarchy of the cells' boxes with the smallest length in each: what is nowhere below the
 *     length in question is not visited;
 *  2. the facets of a cell are clipped by the planes of the region. Corners of what is left are
 *     points of the field within the region, or lie where the region's faces and edges cut the
 *     cell's. The region's own corners are not among them: who asks tests these.
 *
 * Guarantees: exact up to rounding in simplices, where the field is linear; in hexahedra at the
 * corners of what is in common. Queries are thread safe.
 * Cost: O(n log n) to build, 40 bytes per cell beside its corners; a query visits the cells that
 * overlap the region and are smaller than the length.
 */
#ifndef cdmSizingMinima_h
#define cdmSizingMinima_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Box.h"

#include <array>
#include <functional>
#include <vector>

namespace cdm
{
/** A tetrahedron, triangle or box as the intersection of half spaces. */
class ConvexRegion
{
public:
  /** A triangle is a slab, as thin as rounding allows. */
  explicit ConvexRegion(const std::array<Vec3, 3>& triangle);
  explicit ConvexRegion(const std::array<Vec3, 4>& tetrahedron);
  explicit ConvexRegion(const Box& box);

  const Box& GetBounds() const { return this->Bounds; }
  int GetNumberOfPlanes() const { return this->NumberOfPlanes; }
  /** Positive inside, or 0. */
  double GetHeight(int plane, const Vec3& p) const
  {
    return Dot(this->Normals[plane], p - this->Origins[plane]);
  }

private:
  void AddPlane(const Vec3& origin, const Vec3& normal);

  Box Bounds;
  std::array<Vec3, 6> Origins;
  std::array<Vec3, 6> Normals;
  int NumberOfPlanes = 0;
};

/** Points in cells: cell i has the points from Connectivity[Offsets[i]] to [Offsets[i + 1] - 1]. */
struct SizingCells
{
  std::vector<Vec3> Points;
  std::vector<Id> Offsets{ 0 };
  std::vector<Id> Connectivity;
};

class SizingMinima
{
public:
  /**
   * @param cells points, edges, triangles, tetrahedra; or hexahedra, the fifth corner above the
   *   first; without any, each point is a cell
   * @param lengths the smallest length of the spacing at each point
   */
  SizingMinima(SizingCells cells, std::vector<double> lengths);

  /**
   * False: the cells around a position have no points with lengths below this one. Outside of all
   * cells' boxes true.
   */
  bool MayBeBelow(const Vec3& position, double length) const;

  /** Gets a position, returns the length that others have to be below from now on; 0: ends it. */
  using Visitor = std::function<double(const Vec3& position)>;

  /** Visits positions in the region where the field may be below the length. */
  void VisitBelow(const ConvexRegion& region, double length, const Visitor& visit) const;

private:
  struct Node
  {
    Box Bounds;
    double Smallest;
    /** Leaf: range of Order. */
    Id Begin = 0;
    Id End = 0;
    /** Inner node: the second child, the first one follows; leaf: NoId. */
    Id Second = NoId;
  };

  void Build(Id begin, Id end, const std::vector<Vec3>& centers);
  /** Visits leaves whose box overlaps a box, and which are wanted, as all nodes above them are. */
  template <class Predicate, class Function>
  void VisitLeaves(const Box& box, Predicate&& isWanted, Function&& visit) const;
  /** What makes the field bilinear in a face of a hexahedron; 0: linear. */
  double GetTwist(const Id* corners, int face) const;
  double VisitCell(const ConvexRegion& region, Id cell, double length, const Visitor& visit) const;

  SizingCells Cells;
  std::vector<double> Lengths;
  /** Cells in the order of the leaves. */
  std::vector<Id> Order;
  /** Depth first. */
  std::vector<Node> Nodes;
};
} // namespace cdm

#endif
