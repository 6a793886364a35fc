// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThinLayers.h
 * @brief Which tetrahedra reach from one side of a thin layer to the other.
 *
 * A layer is thin if it is many times as wide as thick (thesis 2: thin layer). Well shaped
 * tetrahedra would be as long as the layer is thick, and thousands would be needed to fill it. So
 * tetrahedra across thin layers are accepted although they are flat.
 *
 * How many times is an option. By default it is twenty where another region is on either side of
 * the layer: what fills the layer would make the triangles between the regions as small, and so the
 * tetrahedra of that region. A plate with nothing but the outside on both sides has nothing else to
 * be meshed, and twenty would leave hardly any well shaped tetrahedron in the sheets of usual parts:
 * there it is a hundred.
 *
 * Method: the boundary of each region is divided into sides: triangles connected across edges that
 * bend by less than a degree. A side is as wide as a square with the same ratio of area to
 * perimeter, or with the same area if that is narrower. A tetrahedron is across a layer if all its
 * points lie on the boundary and two of them lie on sides that face each other. The distance of
 * these sides has to be small for the size of the tetrahedron, and the width of either side at least
 * so many times the distance.
 *
 * So what counts is the size of a facet, not that of the sheet. While facets that bend by less than
 * 45 degrees were one side, curved sheets were layers as wide as all of their facets. They were
 * filled all the same, from the edges between facets on, and kept flat tetrahedra in between: 375 of
 * 45,752 between two icosahedra of radius 1 and 0.95, where there are none of 45,835 now.
 *
 * Cost: O(n log n) to build; O(1) for a tetrahedron. About 100 bytes per triangle.
 */
#ifndef cdmThinLayers_h
#define cdmThinLayers_h

#include "Core/Basics/IdLists.h"
#include "Core/Meshes/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace cdm
{
class ThinLayers
{
public:
  /**
   * Surface and lists have to outlive the object. The surface has labels; pointTriangles lists the
   * triangles at each of its points.
   * @param aspectRatio how many times as wide as thick a thin layer is at least; 0: by default
   */
  ThinLayers(const TriangleMesh& surface, const IdLists& pointTriangles, double aspectRatio = 0.0);
  /**
   * Follows splits of the surface: sides stay as wide as they were.
   * @param triangles those that are new or changed
   * @param parents for each of them one of the surface before in the same surface facet
   */
  void Follow(const std::vector<Id>& triangles, const std::vector<Id>& parents);
  /** How many faces have been looked at so far. */
  std::int64_t GetNumberOfVisits() const { return this->NumberOfVisits; }

  /**
   * Whether a tetrahedron of a region is across a thin layer. Ids of interior points are larger
   * than those of the surface.
   */
  bool IsAcross(const TetrahedronIds& ids, Id region) const;
  /**
   * Whether two faces look at each other, or away from each other, but for 32 degrees. The face 2 t
   * is triangle t as seen from behind, and 2 t + 1 as seen from its front.
   */
  bool AreOpposite(Id first, Id second) const
  {
    return AreOpposite(this->Faces[first], this->Faces[second]);
  }
  /** Whether a layer between two faces is thin if it is so thick. */
  bool IsThin(Id first, Id second, double thickness) const
  {
    return this->IsThin(this->Faces[first], this->Faces[second], thickness);
  }

private:
  /** A triangle as seen from the region on one side. */
  struct Face
  {
    /** Unit normal that points out of the region. */
    Vec3 Normal;
    /** How wide the side is that the face belongs to. */
    double Width = 0.0;
    /** Whether there is no region on the other side of the face. */
    bool IsOuter = false;
  };
  void MeasureWidths();
  const Face* GetFace(Id triangle, Id region) const;
  static bool AreOpposite(const Face& first, const Face& second);
  bool IsThin(const Face& first, const Face& second, double thickness) const;

  const TriangleMesh& Surface;
  const IdLists& PointTriangles;
  const double AspectRatio;
  /** 2 * t as seen from behind a triangle, 2 * t + 1 from its front. */
  std::vector<Face> Faces;
  std::int64_t NumberOfVisits = 0;
};
} // namespace cdm

#endif
