// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CosphericalCell.h
 * @brief A cell of the Delaunay subdivision with more than four points, and the rule that splits it.
 *
 * The cell is the convex hull of all points on one empty sphere (the local sphere boundary, LSPB,
 * of thesis 6.4.3). Pulling rule: each face, a cocircular polygon, becomes a fan from its lowest
 * numbered point, and the cell the cone from its lowest numbered point over the triangles of all
 * faces that do not hold that point. Two cells that share a face agree on it without looking at
 * each other, no tetrahedron is flat, and the result depends on the numbering alone.
 *
 * Method: gift wrapping over the faces with exact signs, starting from a known triangle of the
 * hull. Cost: O(f n) orientation signs for f faces of n points.
 */
#ifndef cdmCosphericalCell_h
#define cdmCosphericalCell_h

#include "Types.h"
#include "Vec3.h"

#include <vector>

namespace cdm
{
class CosphericalCell
{
public:
  explicit CosphericalCell(const std::vector<Vec3>& points)
    : Points(points)
  {
  }

  /**
   * Tetrahedra of the cell. base is a triangle within a face of the hull, its front looking into
   * the cell; ids are all points of the cell, those of base included. False if the points are not
   * in convex position with base on their hull, which a caller with exact input never sees.
   */
  bool Split(const TriangleIds& base, const std::vector<Id>& ids,
    std::vector<TetrahedronIds>& tetrahedra);

private:
  /** The face polygon that holds a, b, c, counter-clockwise seen from outside. */
  void CollectFace(Id a, Id b, Id c, const std::vector<Id>& ids, std::vector<Id>& face) const;

  const std::vector<Vec3>& Points;
};

/** Fan of a convex polygon from its lowest id, in the polygon's orientation. */
void AppendFan(const std::vector<Id>& polygon, std::vector<TriangleIds>& triangles);
}

#endif
