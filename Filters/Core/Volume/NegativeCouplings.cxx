// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Volume/NegativeCouplings.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <iterator>

namespace cdm
{
namespace
{
/** Ascending. */
std::vector<EdgeIds> ListEdges(const std::vector<TriangleIds>& triangles)
{
  std::vector<EdgeIds> edges;
  edges.reserve(3 * triangles.size());
  for (const TriangleIds& ids : triangles)
  {
    edges.insert(edges.end(),
      { MakeEdge(ids[0], ids[1]), MakeEdge(ids[1], ids[2]), MakeEdge(ids[2], ids[0]) });
  }
  SortUnique(edges);
  return edges;
}

using RecordIterator = std::vector<SimplexIncidence::Record>::const_iterator;

/** Whether another point of the tetrahedra at the edge lies in its smallest sphere. */
bool IsSphereFilled(
  const TetMesh& mesh, const EdgeIds& edge, RecordIterator begin, RecordIterator end)
{
  const Vec3& a = mesh.Points[edge[0]];
  const Vec3& b = mesh.Points[edge[1]];
  return std::any_of(begin, end,
    [&](const SimplexIncidence::Record& record)
    {
      const TetrahedronIds& ids = mesh.Tetrahedra[record.Simplex / 6];
      const int(&others)[2] = TetrahedronEdges[5 - record.Simplex % 6];
      return std::any_of(std::begin(others), std::end(others),
        [&](int i) { return Dot(a - mesh.Points[ids[i]], b - mesh.Points[ids[i]]) < 0.0; });
    });
}

bool HasNegativeCouplingInAnyRegion(
  const TetMesh& mesh, const EdgeIds& edge, RecordIterator begin, RecordIterator end)
{
  std::vector<Id> regions;
  for (auto record = begin; record != end; ++record)
  {
    regions.push_back(mesh.Regions[record->Simplex / 6]);
  }
  SortUnique(regions);
  return std::any_of(regions.begin(), regions.end(),
    [&](Id region) { return HasNegativeCoupling(mesh, edge, begin, end, region); });
}
} // namespace

std::vector<EdgeIds> FindNegativeCouplings(
  const TetMesh& mesh, const TriangleMesh& boundary, int numberOfThreads)
{
  const std::vector<EdgeIds> edges = ListEdges(boundary.Triangles);
  std::vector<EdgeIds> negative;
  const SimplexIncidence incidence(mesh, numberOfThreads);
  std::vector<SimplexIncidence::Record> scratch;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last)
  {
    const Id point = edges[first][0];
    while (last < edges.size() && edges[last][0] == point)
    {
      ++last;
    }
    const auto begin = edges.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = edges.begin() + static_cast<std::ptrdiff_t>(last);
    incidence.ForEachEdge(point, scratch,
      [&](const TriangleIds& ids, RecordIterator firstRecord, RecordIterator lastRecord)
      {
        const EdgeIds edge{ ids[0], ids[1] };
        if (std::binary_search(begin, end, edge) &&
          IsSphereFilled(mesh, edge, firstRecord, lastRecord) &&
          HasNegativeCouplingInAnyRegion(mesh, edge, firstRecord, lastRecord))
        {
          negative.push_back(edge);
        }
      });
  }
  return negative;
}
} // namespace cdm
