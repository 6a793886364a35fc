// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureChains.h
 * @brief Structural edges that are worth keeping when the triangles of a surface get larger.
 *
 * Method: structural edges (StructuralEdges.h), without
 *  1. sharp edges that are connected to no other kind and whose box is smaller than the wanted
 *     length of edges: bumps and folds that larger triangles cannot show;
 *  2. chains of sharp edges, shorter than that, which end inside of a facet, until there are none.
 * Edges between given facets are never left out. Chains that go on into each other become one.
 *
 * Cost: O(n log n).
 */
#ifndef cdmFeatureChains_h
#define cdmFeatureChains_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Surface/StructuralEdges.h"

#include <vector>

namespace cdm
{
/** lengths: the wanted length of edges at each point; edges: sorted by their points. */
Status FindFeatureChains(const TriangleMesh& surface, const StructuralEdgeOptions& options,
  const std::vector<double>& lengths, const ExecutionContext& context,
  std::vector<StructuralEdge>& edges);
} // namespace cdm

#endif
