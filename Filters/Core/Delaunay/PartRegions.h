// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartRegions.h
 * @brief Finds the regions of the tetrahedra of one part of a mesh from the surface that bounds
 *   them.
 *
 * Method:
 *  1. triangles of the surface are facets of tetrahedra; tetrahedra that share another facet belong
 *     together (thesis, Lemma 6.1: the front stops at the surface);
 *  2. tetrahedra at a side of a triangle have the region of that side;
 *  3. regions that are still unknown come from other parts that have the same tetrahedra, in rounds
 *     until nothing new is found. Every enclosed space borders on the surface: tetrahedra without a
 *     region in the end lie outside.
 *
 * Guarantees: the regions are those that the front of AdvancingFrontTetrahedralizer.h reaches.
 * Failure: NotDelaunay names triangles that are no facets of the mesh, NotClosed those where
 * regions contradict each other.
 * Cost: O(n log n), 80 bytes per tetrahedron while it runs.
 */
#ifndef cdmPartRegions_h
#define cdmPartRegions_h

#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"

#include <vector>

namespace cdm
{
class PartRegions
{
public:
  /** Region of a side that does not tell what it borders on. */
  static constexpr Id Unknown = -2;

  /**
   * @param mesh with neighbors; its points are those of the part, of which numberOfOwnPoints come
   * first: their tetrahedra are all there
   * @param triangles of the surface, all that have three points of the part; and the regions on
   * their sides
   */
  PartRegions(const TetMesh& mesh, Id numberOfOwnPoints, const std::vector<TriangleIds>& triangles,
    const std::vector<RegionPair>& regions);

  /** Takes the regions that the surface tells. Cells of the status are triangles. */
  Status Start();
  /** The given tetrahedra whose region has become known since the last call. */
  std::vector<Id> TakeNews(const std::vector<Id>& tetrahedra);
  /** The region of a tetrahedron, and of the one on a side of a triangle, as far as it is known. */
  Id GetRegion(Id tetrahedron) const
  {
    return this->Components[this->ComponentOf[tetrahedron]].Region;
  }
  Id GetSideRegion(Id side) const
  {
    return this->SideFacets[side] == NoId ? OutsideRegion
                                          : this->GetRegion(this->SideFacets[side] / 4);
  }
  /** Takes a region that another part has found. */
  Status SetRegion(Id tetrahedron, Id region);
  /** The region of each tetrahedron, OutsideRegion included. */
  Status Finish(RawVector<Id>& regions) const;

private:
  /** A set of tetrahedra that belong together. */
  struct Component
  {
    Id Region;
    bool IsKnown;
    bool IsNews;
  };

  Status FindFacets();
  bool HasOwnPoint(const TriangleIds& ids) const;
  void FindComponents();
  Status SetRegionOfComponent(Id component, Id region, Id triangle);

  const TetMesh& Mesh;
  Id NumberOfOwnPoints;
  const std::vector<TriangleIds>& Triangles;
  const std::vector<RegionPair>& Regions;
  /** For each side of a triangle: the facet of the tetrahedron there, or NoId. */
  std::vector<Id> SideFacets;
  /** Bit i: facet i of the tetrahedron is a triangle of the surface. */
  std::vector<unsigned char> Barriers;
  std::vector<Id> ComponentOf;
  std::vector<Component> Components;
};
} // namespace cdm

#endif
