// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/NegativeCouplings.h"

#include "Core/Basics/CollectItems.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace cdm
{
namespace
{
/** A thread looks at so many tetrahedra, or tests so many edges, at a time. */
constexpr std::size_t TetrahedraAtOnce = 8192;
constexpr std::size_t EdgesAtOnce = 64;

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
 * Calls visit(tetrahedron, i, edge, found) on threads for edge i of each tetrahedron that may be one
 * of the given edges of the boundary. Returns what these calls have added to found, sorted.
 */
template <typename Item, typename Visitor>
std::vector<Item> CollectAtCandidates(const TetMesh& mesh, const std::vector<EdgeIds>& edges,
  Id numberOfPoints, ThreadTeam& team, const Visitor& visit)
{
  std::vector<char> isEnd(numberOfPoints, 0);
  for (const EdgeIds& edge : edges)
  {
    isEnd[edge[0]] = 1;
    isEnd[edge[1]] = 1;
  }
  const auto isMarked = [&](Id id) { return id < numberOfPoints && isEnd[id] != 0; };
  const auto search = [&](std::size_t begin, std::size_t end, std::vector<Item>& found)
  {
    for (std::size_t t = begin; t < end; ++t)
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
            visit(static_cast<Id>(t), i, edge, found);
          }
        });
    }
  };
  std::vector<Item> all =
    CollectItems<Item>(team, edges.empty() ? 0 : mesh.Tetrahedra.size(), TetrahedraAtOnce, search);
  std::sort(all.begin(), all.end());
  return all;
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

/** Finds those of the edges whose smallest spheres are not empty, ascending. */
std::vector<EdgeIds> FindFilledEdges(
  const TetMesh& mesh, const std::vector<EdgeIds>& edges, Id numberOfPoints, ThreadTeam& team)
{
  std::vector<EdgeIds> filled = CollectAtCandidates<EdgeIds>(mesh, edges, numberOfPoints, team,
    [&](Id tetrahedron, int i, const EdgeIds& edge, std::vector<EdgeIds>& found)
    {
      if (IsSphereFilled(mesh, tetrahedron, i))
      {
        found.push_back(edge);
      }
    });
  filled.erase(std::unique(filled.begin(), filled.end()), filled.end());
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

/** Whether a coupling is negative, given all tetrahedra at the edge. */
bool HasNegative(
  const TetMesh& mesh, const EdgeIds& edge, const std::vector<SimplexIncidence::Record>& records)
{
  return std::any_of(records.begin(), records.end(),
           [&](const SimplexIncidence::Record& record)
           { return IsSphereFilled(mesh, record.Simplex / 6, record.Simplex % 6); }) &&
    HasNegativeCouplingInAnyRegion(mesh, edge, records);
}

/** Finds those of the edges that have a negative coupling, ascending. */
std::vector<EdgeIds> FindNegative(
  const TetMesh& mesh, const std::vector<EdgeIds>& edges, Id numberOfPoints, ThreadTeam& team)
{
  // The tetrahedra at each edge, as in SimplexIncidence.
  using Simplex = std::pair<EdgeIds, Id>;
  const std::vector<Simplex> simplices =
    CollectAtCandidates<Simplex>(mesh, edges, numberOfPoints, team,
      [&](Id tetrahedron, int i, const EdgeIds& edge, std::vector<Simplex>& found)
      {
        if (std::binary_search(edges.begin(), edges.end(), edge))
        {
          found.emplace_back(edge, 6 * tetrahedron + i);
        }
      });
  std::vector<char> isNegative(edges.size(), 0);
  const auto test = [&](std::size_t begin, std::size_t end, int)
  {
    std::vector<SimplexIncidence::Record> records;
    auto simplex =
      std::lower_bound(simplices.begin(), simplices.end(), Simplex(edges[begin], NoId));
    for (std::size_t i = begin; i < end; ++i)
    {
      records.clear();
      for (; simplex != simplices.end() && simplex->first == edges[i]; ++simplex)
      {
        records.push_back({ edges[i][1], NoId, simplex->second });
      }
      isNegative[i] = HasNegativeCouplingInAnyRegion(mesh, edges[i], records) ? 1 : 0;
    }
  };
  team.RunBlocks(team.GetNumberOfThreads(), edges.size(), EdgesAtOnce, test);
  std::vector<EdgeIds> negative;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    if (isNegative[i] != 0)
    {
      negative.push_back(edges[i]);
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

/**
 * The tetrahedra around an edge, in both directions, as in SimplexIncidence.
 * @param isEnd (tetrahedron, facet): whether the walk ends at a facet, at the latest at the outside
 */
template <typename Condition>
std::vector<SimplexIncidence::Record> FindAroundEdge(
  const TetMesh& tetrahedra, Id tetrahedron, int edge, Condition&& isEnd)
{
  const TetrahedronIds& firstIds = tetrahedra.Tetrahedra[tetrahedron];
  const EdgeIds points =
    MakeEdge(firstIds[TetrahedronEdges[edge][0]], firstIds[TetrahedronEdges[edge][1]]);
  std::vector<SimplexIncidence::Record> records{ { points[1], NoId, 6 * tetrahedron + edge } };
  for (int direction = 0; direction < 2; ++direction)
  {
    Id t = tetrahedron;
    int facet = TetrahedronEdges[5 - edge][direction];
    Id next = firstIds[TetrahedronEdges[5 - edge][1 - direction]];
    while (!isEnd(t, facet))
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

/** How many triangles of the boundary have the edge. */
std::ptrdiff_t CountTriangles(
  const TriangleMesh& boundary, const IdLists& pointTriangles, const EdgeIds& edge)
{
  // Corners of the input may have many triangles.
  const int end = pointTriangles[edge[0]].size() < pointTriangles[edge[1]].size() ? 0 : 1;
  const IdLists::Range triangles = pointTriangles[edge[end]];
  return std::count_if(triangles.begin(), triangles.end(),
    [&](Id t) { return Contains(boundary.Triangles[t], edge[1 - end]); });
}

/**
 * A tetrahedron at an edge, as in SimplexIncidence, found from one at an end of it. NoId if bodies
 * touch at the end, or if it has too many tetrahedra.
 */
Id FindSimplex(const DynamicTetrahedralization& mesh, const EdgeIds& edge)
{
  constexpr std::size_t most = 256;
  // The newer end: corners of the input may have thousands of tetrahedra.
  std::vector<Id> star;
  mesh.FindWholeStar(edge[1], most, star);
  const auto& tetrahedra = mesh.GetMesh().Tetrahedra;
  const auto found =
    std::find_if(star.begin(), star.end(), [&](Id t) { return Contains(tetrahedra[t], edge[0]); });
  return found != star.end() ? 6 * *found + FindEdge(tetrahedra[*found], edge) : NoId;
}

/** The tetrahedra around an edge, and how many boundary facets were passed on the way. */
struct Around
{
  std::vector<SimplexIncidence::Record> Records;
  std::ptrdiff_t NumberOfFacets = 0;
};

/** @param simplex as in SimplexIncidence */
Around WalkAround(const TetMesh& mesh, Id simplex)
{
  Around around;
  around.Records = FindAroundEdge(mesh, simplex / 6, simplex % 6,
    [&](Id t, int facet)
    {
      const Id neighbor = mesh.Neighbors[t][facet];
      const bool isOuter = neighbor == NoId;
      around.NumberOfFacets += isOuter || mesh.Regions[neighbor / 4] != mesh.Regions[t] ? 1 : 0;
      return isOuter;
    });
  return around;
}
} // namespace

void NegativeCouplings::Note(const TriangleIds& ids)
{
  for (int i = 0; i < 3; ++i)
  {
    this->Changed.push_back({ PackIds(MakeEdge(ids[i], ids[(i + 1) % 3])), NoId });
  }
}

void NegativeCouplings::NoteTriangles(
  const TriangleMesh& boundary, const std::vector<Id>& triangles)
{
  for (Id t : triangles)
  {
    this->Note(boundary.Triangles[t]);
  }
}

/**
 * Adds the pairs of points of the boundary at new tetrahedra; or, if there are too many of these, all
 * edges of the boundary, and returns true.
 */
bool NegativeCouplings::CollectChanged(
  const DynamicTetrahedralization& mesh, const TriangleMesh& boundary, int numberOfThreads)
{
  const std::int64_t numberOfNew = mesh.CountMade() - this->Last.NumberMade;
  const bool areAll =
    this->Last.NumberMade < 0 || numberOfNew > static_cast<std::int64_t>(boundary.Triangles.size());
  if (areAll)
  {
    std::for_each(boundary.Triangles.begin(), boundary.Triangles.end(),
      [this](const TriangleIds& ids) { this->Note(ids); });
  }
  else
  {
    const Id numberOfPoints = static_cast<Id>(boundary.Points.size());
    mesh.VisitMadeSince(this->Last, this->Marks,
      [&](Id t)
      {
        ++this->NumberOfVisits;
        if (mesh.IsMadeSince(this->Last, t))
        {
          ForEachBoundaryPair(mesh.GetMesh().Tetrahedra[t], numberOfPoints,
            [&](int i, const EdgeIds& edge) {
              this->Changed.push_back({ PackIds(edge), 6 * t + i });
            });
        }
      });
  }
  this->Last = mesh.GetMoment();
  // Each edge becomes one candidate: the first one, which has a tetrahedron if any of them has.
  ParallelSort(this->Changed, numberOfThreads, {}, "",
    [](const Candidate& a, const Candidate& b)
    { return a.Edge != b.Edge ? a.Edge < b.Edge : a.Simplex > b.Simplex; });
  this->Changed.erase(std::unique(this->Changed.begin(), this->Changed.end(),
                        [](const Candidate& a, const Candidate& b) { return a.Edge == b.Edge; }),
    this->Changed.end());
  return areAll;
}

/** Called on several threads at once. */
NegativeCouplings::Answer NegativeCouplings::Test(const Candidate& candidate,
  const DynamicTetrahedralization& mesh, const TriangleMesh& boundary,
  const IdLists& pointTriangles, bool areAll)
{
  const EdgeIds edge = UnpackIds(candidate.Edge);
  const std::ptrdiff_t triangles = CountTriangles(boundary, pointTriangles, edge);
  if (triangles == 0)
  {
    return { Finding::NotNegative, 0 };
  }
  const Id simplex =
    candidate.Simplex != NoId || areAll ? candidate.Simplex : FindSimplex(mesh, edge);
  const Around around = simplex != NoId ? WalkAround(mesh.GetMesh(), simplex) : Around();
  const Finding finding = around.NumberOfFacets != triangles ? Finding::Unknown
    : HasNegative(mesh.GetMesh(), edge, around.Records)      ? Finding::Negative
                                                             : Finding::NotNegative;
  return { finding, static_cast<std::uint32_t>(around.Records.size()) };
}

const std::vector<EdgeIds>& NegativeCouplings::Update(const DynamicTetrahedralization& mesh,
  const TriangleMesh& boundary, const IdLists& pointTriangles, ThreadTeam& team)
{
  const bool areAll = this->CollectChanged(mesh, boundary, team.GetNumberOfThreads());
  std::vector<EdgeIds> found;
  for (const EdgeIds& edge : this->Negative)
  {
    const auto changed = std::lower_bound(this->Changed.begin(), this->Changed.end(), PackIds(edge),
      [](const Candidate& candidate, std::uint64_t key) { return candidate.Edge < key; });
    const bool isChanged = changed != this->Changed.end() && changed->Edge == PackIds(edge);
    if (!isChanged && IsBoundaryEdge(boundary, pointTriangles, edge))
    {
      found.push_back(edge);
    }
  }
  this->Answers.resize(this->Changed.size());
  team.RunBlocks(team.GetNumberOfThreads(), this->Changed.size(), EdgesAtOnce,
    [&](std::size_t begin, std::size_t end, int)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        this->Answers[i] = Test(this->Changed[i], mesh, boundary, pointTriangles, areAll);
      }
    });
  // Edges at which bodies touch have tetrahedra beyond the outside, which no walk finds.
  std::vector<EdgeIds> others;
  for (std::size_t i = 0; i < this->Changed.size(); ++i)
  {
    const Answer& answer = this->Answers[i];
    this->NumberOfVisits += answer.NumberOfVisits;
    if (answer.What != Finding::NotNegative)
    {
      (answer.What == Finding::Negative ? found : others)
        .push_back(UnpackIds(this->Changed[i].Edge));
    }
  }
  this->Changed.clear();
  this->NumberOfVisits += others.empty() ? 0 : 2 * mesh.GetNumberOfTetrahedra();
  const std::vector<EdgeIds> negative =
    FindNegativeCouplings(mesh.GetMesh(), others, static_cast<Id>(boundary.Points.size()), team);
  found.insert(found.end(), negative.begin(), negative.end());
  std::sort(found.begin(), found.end());
  this->Negative = std::move(found);
  return this->Negative;
}

std::vector<EdgeIds> FindNegativeCouplings(const TetMesh& mesh, const std::vector<EdgeIds>& edges,
  Id numberOfBoundaryPoints, ThreadTeam& team)
{
  const std::vector<EdgeIds> filled = FindFilledEdges(mesh, edges, numberOfBoundaryPoints, team);
  return FindNegative(mesh, filled, numberOfBoundaryPoints, team);
}

bool IsBoundaryEdge(
  const TriangleMesh& boundary, const IdLists& pointTriangles, const EdgeIds& edge)
{
  return CountTriangles(boundary, pointTriangles, edge) > 0;
}

bool HasNegativeCoupling(const DynamicTetrahedralization& mesh, Id tetrahedron, int edge)
{
  const TetMesh& tetrahedra = mesh.GetMesh();
  const std::vector<SimplexIncidence::Record> records = FindAroundEdge(
    tetrahedra, tetrahedron, edge, [&mesh](Id t, int facet) { return mesh.IsBoundary(t, facet); });
  const TetrahedronIds& ids = tetrahedra.Tetrahedra[tetrahedron];
  return std::any_of(records.begin(), records.end(),
           [&](const SimplexIncidence::Record& record)
           { return IsSphereFilled(tetrahedra, record.Simplex / 6, record.Simplex % 6); }) &&
    HasNegativeCoupling(tetrahedra,
      MakeEdge(ids[TetrahedronEdges[edge][0]], ids[TetrahedronEdges[edge][1]]), records.begin(),
      records.end(), tetrahedra.Regions[tetrahedron]);
}
} // namespace cdm
