// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureSizes.h
 * @brief Local feature size: how close structural edges and facets without a common point come to
 * each other.
 *
 * The local feature size of a point is the radius of the smallest ball around it that touches two
 * features (structural edges or surface facets) without a common point (thesis Def. 2.1). It tells
 * how small elements have to be there, even where all corners are far away: in the middle of a
 * layer they are as small as the layer is thick.
 *
 * Cost: O(n log n) to build, 100 bytes per edge and triangle; a query visits what lies
 * within four times its result, and compares 256 features at most.
 *
 * Reference: J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh
 * generation", 1995, doi:10.1006/jagm.1995.1021.
 */
#ifndef cdmFeatureSizes_h
#define cdmFeatureSizes_h

#include "Core/Search/BoxTree.h"
#include "Core/Surface/FacetPoints.h"
#include "Core/Surface/StructuralEdges.h"

#include <vector>

namespace cdm
{
class FeatureSizes
{
public:
  /**
   * @param facets the surface facet of each triangle, as from NumberFacets()
   * @param numberOfThreads that build the search
   */
  FeatureSizes(const std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
    const std::vector<Id>& facets, const std::vector<StructuralEdge>& edges,
    int numberOfThreads = 1);

  /**
   * The local feature size at a position, at most the limit. Features closer than a hundredth of
   * the limit are left out. If 256 features touch each other, the result is the limit.
   */
  double Find(const Vec3& position, double limit) const;

private:
  std::vector<Box> MakeBoxes() const;
  Id GetFeature(Id part) const;
  double GetDistanceTo(Id part, const Vec3& position) const;
  bool AreDisjoint(Id a, Id b) const;

  const std::vector<Vec3> Points;
  /** Parts are edges, then triangles; features are edges, then facets. */
  const std::vector<EdgeIds> Edges;
  const std::vector<TriangleIds> Triangles;
  const std::vector<Id> Facets;
  const FacetPoints Contacts;
  const BoxTree Tree;
};
} // namespace cdm

#endif
