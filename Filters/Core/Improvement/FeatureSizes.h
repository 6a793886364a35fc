// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureSizes.h
 * @brief How close structural edges come to each other that do not touch.
 *
 * At a point: the radius of the smallest ball around it that touches two structural edges without a
 * common end. That is the local feature size of the literature on Delaunay refinement, of edges; it
 * tells how small the elements have to be there, however far away the ends of the edges are.
 *
 * Cost: O(n log n) to build, 100 bytes per edge; a query visits the edges within four times its
 * result.
 *
 * Reference: J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh
 * generation", 1995, doi:10.1006/jagm.1995.1021.
 */
#ifndef cdmFeatureSizes_h
#define cdmFeatureSizes_h

#include "Core/Search/BoxTree.h"
#include "Core/Surface/StructuralEdges.h"

#include <array>
#include <utility>
#include <vector>

namespace cdm
{
class FeatureSizes
{
public:
  FeatureSizes(const std::vector<Vec3>& points, const std::vector<StructuralEdge>& edges);

  /** At most the limit; pairs of edges closer than a hundredth of it are left out. */
  double Find(const Vec3& position, double limit) const;

private:
  struct Segment
  {
    EdgeIds Ids;
    std::array<Vec3, 2> Ends;
  };
  static std::vector<Segment> MakeSegments(
    const std::vector<Vec3>& points, const std::vector<StructuralEdge>& edges);
  static std::vector<Box> MakeBoxes(const std::vector<Segment>& segments);

  std::vector<Segment> Segments;
  BoxTree Tree;
};
} // namespace cdm

#endif
