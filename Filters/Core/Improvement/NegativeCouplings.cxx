// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/NegativeCouplings.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <utility>

namespace cdm
{
namespace
{
/** Calls visit(tetrahedron, i, edge) for each edge i of a tetrahedron between two first points. */
template <typename Visitor>
void ForEachEdgeOfFirstPoints(const TetMesh& mesh, std::size_t numberOfPoints, Visitor&& visit)
{
  const Id end = static_cast<Id>(numberOfPoints);
  for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    if (ids[0] == NoId)
    {
      continue;
    }
    for (int i = 0; i < 6; ++i)
    {
      const Id a = ids[TetrahedronEdges[i][0]];
      const Id b = ids[TetrahedronEdges[i][1]];
      if (a < end && b < end)
      {
        visit(static_cast<Id>(t), i, MakeEdge(a, b));
      }
    }
  }
}

/** Whether one of the other two points of the tetrahedron lies in the smallest sphere of an edge. */
bool IsSphereFilled(const TetMesh& mesh, Id tetrahedron, int edge)
{
  const TetrahedronIds& ids = mesh.Tetrahedra[tetrahedron];
  const Vec3& a = mesh.Points[ids[TetrahedronEdges[edge][0]]];
  const Vec3& b = mesh.Points[ids[TetrahedronEdges[edge][1]]];
  const auto isInside = [&](int vertex)
  { return Dot(a - mesh.Points[ids[vertex]], b - mesh.Points[ids[vertex]]) < 0.0; };
  return isInside(TetrahedronEdges[5 - edge][0]) || isInside(TetrahedronEdges[5 - edge][1]);
}

/** Edges of the boundary whose smallest spheres are not empty, ascending. */
std::vector<EdgeIds> FindFilledEdges(const TetMesh& mesh, const TriangleMesh& boundary)
{
  std::vector<EdgeIds> filled;
  ForEachEdgeOfFirstPoints(mesh, boundary.Points.size(),
    [&](Id tetrahedron, int i, const EdgeIds& edge)
    {
      if (IsSphereFilled(mesh, tetrahedron, i))
      {
        filled.push_back(edge);
      }
    });
  SortUnique(filled);
  std::vector<EdgeIds> edges;
  for (const EdgeUse& use : SortEdgeUses(boundary.Triangles, boundary.Points.size()))
  {
    if (std::binary_search(filled.begin(), filled.end(), use.GetPoints()) &&
      (edges.empty() || edges.back() != use.GetPoints()))
    {
      edges.push_back(use.GetPoints());
    }
  }
  return edges;
}

bool HasNegativeCouplingInAnyRegion(
  const TetMesh& mesh, const EdgeIds& edge, const std::vector<SimplexIncidence::Record>& records)
{
  std::vector<Id> regions;
  for (const SimplexIncidence::Record& record : records)
  {
    regions.push_back(mesh.Regions[record.Simplex / 6]);
  }
  SortUnique(regions);
  return std::any_of(regions.begin(), regions.end(),
    [&](Id region)
    { return HasNegativeCoupling(mesh, edge, records.begin(), records.end(), region); });
}
} // namespace

std::vector<EdgeIds> FindNegativeCouplings(const TetMesh& mesh, const TriangleMesh& boundary)
{
  const std::vector<EdgeIds> edges = FindFilledEdges(mesh, boundary);
  // Of each edge the tetrahedra, as in SimplexIncidence.
  std::vector<std::pair<EdgeIds, Id>> simplices;
  ForEachEdgeOfFirstPoints(mesh, edges.empty() ? 0 : boundary.Points.size(),
    [&](Id tetrahedron, int i, const EdgeIds& edge)
    {
      if (std::binary_search(edges.begin(), edges.end(), edge))
      {
        simplices.emplace_back(edge, 6 * tetrahedron + i);
      }
    });
  std::sort(simplices.begin(), simplices.end());

  std::vector<EdgeIds> negative;
  std::vector<SimplexIncidence::Record> records;
  for (std::size_t first = 0, last = 0; first < simplices.size(); first = last)
  {
    const EdgeIds& edge = simplices[first].first;
    records.clear();
    for (; last < simplices.size() && simplices[last].first == edge; ++last)
    {
      records.push_back({ edge[1], NoId, simplices[last].second });
    }
    if (HasNegativeCouplingInAnyRegion(mesh, edge, records))
    {
      negative.push_back(edge);
    }
  }
  return negative;
}
} // namespace cdm
