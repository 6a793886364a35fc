// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/NegativeCouplings.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace cdm
{
namespace
{
/** Calls visit(i, edge) for each edge i of a tetrahedron between two points of the boundary. */
template <typename Visitor>
void ForEachBoundaryPair(const TetrahedronIds& ids, Id numberOfPoints, Visitor&& visit)
{
  for (int i = 0; i < 6; ++i)
  {
    const Id a = ids[TetrahedronEdges[i][0]];
    const Id b = ids[TetrahedronEdges[i][1]];
    if (a < numberOfPoints && b < numberOfPoints)
    {
      visit(i, MakeEdge(a, b));
    }
  }
}

/**
 * Calls visit(tetrahedron, i, edge) for edge i of each tetrahedron that may be one of the given
 * edges of the boundary.
 */
template <typename Visitor>
void ForEachCandidate(
  const TetMesh& mesh, const std::vector<EdgeIds>& edges, Id numberOfPoints, Visitor&& visit)
{
  std::vector<char> isEnd(numberOfPoints, 0);
  for (const EdgeIds& edge : edges)
  {
    isEnd[edge[0]] = 1;
    isEnd[edge[1]] = 1;
  }
  const auto isMarked = [&](Id id) { return id < numberOfPoints && isEnd[id] != 0; };
  for (std::size_t t = 0; t < mesh.Tetrahedra.size() && !edges.empty(); ++t)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    if (ids[0] == NoId || std::count_if(ids.begin(), ids.end(), isMarked) < 2)
    {
      continue;
    }
    ForEachBoundaryPair(ids, numberOfPoints,
      [&](int i, const EdgeIds& edge)
      {
        if (isEnd[edge[0]] != 0 && isEnd[edge[1]] != 0)
        {
          visit(static_cast<Id>(t), i, edge);
        }
      });
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

/** Those of the edges whose smallest spheres are not empty, ascending. */
std::vector<EdgeIds> FindFilledEdges(
  const TetMesh& mesh, const std::vector<EdgeIds>& edges, Id numberOfPoints)
{
  std::vector<EdgeIds> filled;
  ForEachCandidate(mesh, edges, numberOfPoints,
    [&](Id tetrahedron, int i, const EdgeIds& edge)
    {
      if (IsSphereFilled(mesh, tetrahedron, i))
      {
        filled.push_back(edge);
      }
    });
  SortUnique(filled);
  std::vector<EdgeIds> found;
  std::set_intersection(
    filled.begin(), filled.end(), edges.begin(), edges.end(), std::back_inserter(found));
  return found;
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

/** Those of the edges with a negative coupling, ascending. */
std::vector<EdgeIds> FindNegative(
  const TetMesh& mesh, const std::vector<EdgeIds>& edges, Id numberOfPoints)
{
  // The tetrahedra at each edge, as in SimplexIncidence.
  std::vector<std::pair<EdgeIds, Id>> simplices;
  ForEachCandidate(mesh, edges, numberOfPoints,
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

/** Which edge of a tetrahedron joins two of its points. */
int FindEdge(const TetrahedronIds& ids, const EdgeIds& points)
{
  int edge = 0;
  while (MakeEdge(ids[TetrahedronEdges[edge][0]], ids[TetrahedronEdges[edge][1]]) != points)
  {
    ++edge;
  }
  return edge;
}

/** The tetrahedra of one region around an edge, in both directions, as in SimplexIncidence. */
std::vector<SimplexIncidence::Record> FindAroundEdge(
  const DynamicTetrahedralization& mesh, Id tetrahedron, int edge)
{
  const TetMesh& tetrahedra = mesh.GetMesh();
  const TetrahedronIds& firstIds = tetrahedra.Tetrahedra[tetrahedron];
  const EdgeIds points =
    MakeEdge(firstIds[TetrahedronEdges[edge][0]], firstIds[TetrahedronEdges[edge][1]]);
  std::vector<SimplexIncidence::Record> records{ { points[1], NoId, 6 * tetrahedron + edge } };
  for (int direction = 0; direction < 2; ++direction)
  {
    Id t = tetrahedron;
    int facet = TetrahedronEdges[5 - edge][direction];
    Id next = firstIds[TetrahedronEdges[5 - edge][1 - direction]];
    while (!mesh.IsBoundary(t, facet))
    {
      const Id entered = tetrahedra.Neighbors[t][facet];
      t = entered / 4;
      if (t == tetrahedron)
      {
        return records;
      }
      const TetrahedronIds& ids = tetrahedra.Tetrahedra[t];
      records.push_back({ points[1], NoId, 6 * t + FindEdge(ids, points) });
      facet = static_cast<int>(std::find(ids.begin(), ids.end(), next) - ids.begin());
      next = ids[entered % 4];
    }
  }
  return records;
}

void AddEdges(const TriangleIds& ids, std::vector<EdgeIds>& edges)
{
  for (int i = 0; i < 3; ++i)
  {
    edges.push_back(MakeEdge(ids[i], ids[(i + 1) % 3]));
  }
}
} // namespace

void NegativeCouplings::NoteTriangles(
  const TriangleMesh& boundary, const std::vector<Id>& triangles)
{
  for (Id t : triangles)
  {
    AddEdges(boundary.Triangles[t], this->Noted);
  }
}

/** Pairs of points of the boundary that may have got another coupling, ascending. */
std::vector<EdgeIds> NegativeCouplings::TakeChanged(
  const DynamicTetrahedralization& mesh, const TriangleMesh& boundary)
{
  std::vector<EdgeIds> changed = std::exchange(this->Noted, {});
  if (this->NextStamp == 0)
  {
    for (const TriangleIds& ids : boundary.Triangles)
    {
      AddEdges(ids, changed);
    }
  }
  const auto visit = [&](Id t)
  {
    if (mesh.GetStamp(t) >= this->NextStamp && !mesh.IsDead(t))
    {
      ForEachBoundaryPair(mesh.GetMesh().Tetrahedra[t], static_cast<Id>(boundary.Points.size()),
        [&changed](int, const EdgeIds& edge) { changed.push_back(edge); });
    }
  };
  if (this->NextStamp > 0)
  {
    mesh.VisitMadeSince(this->NumberMade, this->New, visit);
  }
  this->NumberMade = mesh.CountMade();
  this->NextStamp = mesh.GetNextStamp();
  SortUnique(changed);
  return changed;
}

const std::vector<EdgeIds>& NegativeCouplings::Update(const DynamicTetrahedralization& mesh,
  const TriangleMesh& boundary, const IdLists& pointTriangles)
{
  const auto isNoEdge = [&](const EdgeIds& edge)
  { return !IsBoundaryEdge(boundary, pointTriangles, edge); };
  std::vector<EdgeIds> changed = this->TakeChanged(mesh, boundary);
  this->Negative.erase(
    std::remove_if(this->Negative.begin(), this->Negative.end(),
      [&](const EdgeIds& edge)
      { return isNoEdge(edge) || std::binary_search(changed.begin(), changed.end(), edge); }),
    this->Negative.end());
  changed.erase(std::remove_if(changed.begin(), changed.end(), isNoEdge), changed.end());
  this->NumberOfTests += static_cast<std::int64_t>(changed.size());

  const Id numberOfPoints = static_cast<Id>(boundary.Points.size());
  const std::vector<EdgeIds> filled = FindFilledEdges(mesh.GetMesh(), changed, numberOfPoints);
  const std::vector<EdgeIds> found = FindNegative(mesh.GetMesh(), filled, numberOfPoints);
  std::vector<EdgeIds> both;
  std::merge(this->Negative.begin(), this->Negative.end(), found.begin(), found.end(),
    std::back_inserter(both));
  this->Negative = std::move(both);
  return this->Negative;
}

bool IsBoundaryEdge(
  const TriangleMesh& boundary, const IdLists& pointTriangles, const EdgeIds& edge)
{
  const IdLists::Range triangles = pointTriangles[edge[0]];
  return std::any_of(triangles.begin(), triangles.end(),
    [&](Id t) { return Contains(boundary.Triangles[t], edge[1]); });
}

bool HasNegativeCoupling(const DynamicTetrahedralization& mesh, Id tetrahedron, int edge)
{
  const std::vector<SimplexIncidence::Record> records = FindAroundEdge(mesh, tetrahedron, edge);
  const TetMesh& tetrahedra = mesh.GetMesh();
  const TetrahedronIds& ids = tetrahedra.Tetrahedra[tetrahedron];
  return std::any_of(records.begin(), records.end(),
           [&](const SimplexIncidence::Record& record)
           { return IsSphereFilled(tetrahedra, record.Simplex / 6, record.Simplex % 6); }) &&
    HasNegativeCoupling(tetrahedra,
      MakeEdge(ids[TetrahedronEdges[edge][0]], ids[TetrahedronEdges[edge][1]]), records.begin(),
      records.end(), tetrahedra.Regions[tetrahedron]);
}
} // namespace cdm
