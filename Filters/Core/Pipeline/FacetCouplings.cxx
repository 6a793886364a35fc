// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Pipeline/FacetCouplings.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Improvement/NegativeCouplings.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Surface/FlatFacets.h"
#include "Core/Surface/StructuralEdges.h"

#include <algorithm>
#include <array>

namespace cdm
{
namespace
{
struct RoundedEdge
{
  EdgeIds Points;
  /** Its two triangles. */
  std::array<Id, 2> Triangles;
};

/** The edges within facets that bend by more than the last digits of the coordinates, ascending. */
std::vector<RoundedEdge> FindRoundedEdges(
  const TriangleMesh& boundary, const std::vector<Id>& facets)
{
  const double flatness = GetFlatness(ExactFlatnessRatio, boundary.Points);
  const std::vector<EdgeUse> uses = SortEdgeUses(boundary.Triangles, boundary.Points.size());
  std::vector<RoundedEdge> edges;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    end = FindEndOfEdge(uses, begin);
    if (end - begin != 2)
    {
      continue;
    }
    const Id first = uses[begin].Use / 3;
    const Id second = uses[begin + 1].Use / 3;
    if (facets[first] == facets[second] &&
      !IsSmoothEdge(boundary, uses[begin], uses[begin + 1], 0.0, flatness))
    {
      edges.push_back({ uses[begin].GetPoints(), { first, second } });
    }
  }
  return edges;
}
} // namespace

std::vector<Id> FindNegativeTriangles(const TetMesh& mesh, const TriangleMesh& boundary,
  const std::vector<Id>& facets, ThreadTeam& team)
{
  const std::vector<RoundedEdge> edges = FindRoundedEdges(boundary, facets);
  std::vector<EdgeIds> points;
  points.reserve(edges.size());
  for (const RoundedEdge& edge : edges)
  {
    points.push_back(edge.Points);
  }
  const std::vector<EdgeIds> negative =
    FindNegativeCouplings(mesh, points, static_cast<Id>(mesh.Points.size()), team);
  std::vector<Id> found;
  for (const RoundedEdge& edge : edges)
  {
    if (std::binary_search(negative.begin(), negative.end(), edge.Points))
    {
      found.insert(found.end(), edge.Triangles.begin(), edge.Triangles.end());
    }
  }
  SortUnique(found);
  return found;
}
} // namespace cdm
