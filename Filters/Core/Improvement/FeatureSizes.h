// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureSizes.h
 * @brief How close structural edges and facets come to each other that do not touch.
 *
 * At a point: the radius of the smallest ball around it that touches two edges, two facets, or an
 * edge and a facet, without a common point. That is the local feature size of the literature on
 * Delaunay refinement; it tells how small the elements have to be there, however far away all
 * corners are: in the middle of a layer as small as it is thick.
 *
 * Cost: O(n log n) to build, 100 bytes per edge and triangle; a query visits what lies
 * within four times its result, and compares 256 features at most.
 *
 * Reference: J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh
 * generation", 1995, doi:10.1006/jagm.1995.1021.
 */
#ifndef cdmFeatureSizes_h
#define cdmFeatureSizes_h

#include "Core/Basics/IdLists.h"
#include "Core/Search/BoxTree.h"
#include "Core/Surface/StructuralEdges.h"

#include <vector>

namespace cdm
{
class FeatureSizes
{
public:
  /** @param facets one for each triangle, as from NumberFacets() */
  FeatureSizes(const std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
    const std::vector<Id>& facets, const std::vector<StructuralEdge>& edges);

  /**
   * At most the limit; features closer than a hundredth of it are left out. The limit, too, where
   * 256 features touch each other.
   */
  double Find(const Vec3& position, double limit) const;

private:
  std::vector<Box> MakeBoxes() const;
  void ListFacetPoints();
  Id GetFeature(Id part) const;
  double GetDistanceTo(Id part, const Vec3& position) const;
  bool AreDisjoint(Id a, Id b) const;

  const std::vector<Vec3> Points;
  /** Parts are edges, then triangles; features are edges, then facets. */
  const std::vector<EdgeIds> Edges;
  const std::vector<TriangleIds> Triangles;
  const std::vector<Id> Facets;
  /** Facets at each point; points of each facet that it shares with others. */
  IdLists PointFacets;
  IdLists SharedPoints;
  const BoxTree Tree;
};
} // namespace cdm

#endif
