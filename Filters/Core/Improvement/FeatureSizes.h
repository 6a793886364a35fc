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
 * Cost: O(n log n) to build, 100 bytes per edge and triangle, 16 for two facets with a common
 * point; a query visits what lies within four times its result.
 *
 * Reference: J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh
 * generation", 1995, doi:10.1006/jagm.1995.1021.
 */
#ifndef cdmFeatureSizes_h
#define cdmFeatureSizes_h

#include "Core/Basics/IdLists.h"
#include "Core/Search/BoxTree.h"
#include "Core/Surface/StructuralEdges.h"

#include <utility>
#include <vector>

namespace cdm
{
class FeatureSizes
{
public:
  /** @param facets one for each triangle, as from NumberFacets() */
  FeatureSizes(const std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
    const std::vector<Id>& facets, const std::vector<StructuralEdge>& edges);

  /** At most the limit; features closer than a hundredth of it are left out. */
  double Find(const Vec3& position, double limit) const;

private:
  std::vector<Box> MakeBoxes() const;
  void CollectTouching();
  Id GetFeature(Id part) const;
  double GetDistanceTo(Id part, const Vec3& position) const;
  bool AreDisjoint(Id a, Id b) const;

  const std::vector<Vec3> Points;
  /** Parts are edges, then triangles; features are edges, then facets. */
  const std::vector<EdgeIds> Edges;
  const std::vector<TriangleIds> Triangles;
  const std::vector<Id> Facets;
  IdLists PointFacets;
  /** Pairs of facets with a common point, the smaller one first, sorted. */
  std::vector<std::pair<Id, Id>> Touching;
  const BoxTree Tree;
};
} // namespace cdm

#endif
