// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetPolygons.h
 * @brief Convex polygons of cocircular triangles in a flat surface facet. In a mesh their diagonals
 * have to be those of the pulling rule (thesis 6.4.3, "flip triangles on the fly").
 *
 * Cost: O(n) to build for a bounded number of triangles at a point; 4 bytes per side of a triangle.
 */
#ifndef cdmFacetPolygons_h
#define cdmFacetPolygons_h

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/TriangleMesh.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cdm
{
class FacetPolygons
{
public:
  /**
   * The surface has to outlive this; diagonals may be flipped within their polygons. Its own points
   * are not looked at.
   */
  FacetPolygons(const TriangleMesh& surface, std::size_t numberOfPoints);

  /**
   * Triangles of the polygon around a triangle: crosses an edge of two triangles with the same
   * labels if the point beyond is one of the circle's, isCocircular(point).
   * @return the points beyond that are reached, ascending
   */
  template <typename IsCocircular>
  std::vector<Id> Collect(
    Id start, const IsCocircular& isCocircular, std::vector<Id>& triangles) const
  {
    triangles.assign(1, start);
    std::vector<Id> reached;
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
      const TriangleIds& ids = this->Surface.Triangles[triangles[i]];
      for (int e = 0; e < 3; ++e)
      {
        const Id a = ids[e];
        const Id b = ids[(e + 1) % 3];
        const Id other = this->Others[3 * triangles[i] + e];
        if (other == NoId || !this->HaveSameLabels(triangles[i], other, a, b) ||
          Contains(triangles, other))
        {
          continue;
        }
        const TriangleIds& beyond = this->Surface.Triangles[other];
        const Id apex = beyond[0] != a && beyond[0] != b ? beyond[0]
          : beyond[1] != a && beyond[1] != b             ? beyond[1]
                                                         : beyond[2];
        if (isCocircular(apex))
        {
          triangles.push_back(other);
          reached.push_back(apex);
        }
      }
    }
    std::sort(reached.begin(), reached.end());
    reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
    return reached;
  }

private:
  bool HaveSameLabels(Id s, Id t, Id a, Id b) const;

  const TriangleMesh& Surface;
  /** At each side of each triangle the other one, or NoId if there is not exactly one. */
  std::vector<Id> Others;
};

/**
 * The triangles of a convex polygon by the pulling rule: the fan from its lowest point. The polygon
 * is a triangle and further points on its circle; orientations are those of the triangle.
 */
std::vector<TriangleIds> MakePulledFan(
  const std::vector<Vec3>& points, const TriangleIds& triangle, const std::vector<Id>& others);
} // namespace cdm

#endif
