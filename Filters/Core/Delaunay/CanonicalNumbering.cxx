// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/CanonicalNumbering.h"

#include "Core/Basics/ParallelLoop.h"

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace cdm
{
namespace
{
/** The even permutations: index of the first vertex and of the second one after it. */
constexpr unsigned char Turns[12][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 },
  { 1, 0, 3, 2 }, { 1, 3, 2, 0 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 2, 1, 3, 0 }, { 2, 3, 0, 1 },
  { 3, 0, 2, 1 }, { 3, 2, 1, 0 }, { 3, 1, 0, 2 } };
constexpr unsigned char NotMeshed = 12;

/** The permutation that puts the lowest vertex first and the second lowest after it. */
unsigned char FindTurn(const TetrahedronIds& ids)
{
  int first = ids[1] < ids[0] ? 1 : 0;
  first = ids[2] < ids[first] ? 2 : first;
  first = ids[3] < ids[first] ? 3 : first;
  int turn = 3 * first;
  turn = ids[Turns[3 * first + 1][1]] < ids[Turns[turn][1]] ? 3 * first + 1 : turn;
  turn = ids[Turns[3 * first + 2][1]] < ids[Turns[turn][1]] ? 3 * first + 2 : turn;
  return static_cast<unsigned char>(turn);
}

/** Sorts the tetrahedra of one vertex by their other vertices. */
void SortStar(TetrahedronIds* items, Id size)
{
  // Two tetrahedra with the same first three vertices would lie on the same side of a facet.
  const auto isLess = [](const TetrahedronIds& s, const TetrahedronIds& t)
  { return s[0] != t[0] ? s[0] < t[0] : s[1] < t[1]; };
  constexpr Id Many = 32;
  if (size > Many)
  {
    std::sort(items, items + size, isLess);
    return;
  }
  // They are few: seven, on average.
  for (Id i = 1; i < size; ++i)
  {
    const TetrahedronIds item = items[i];
    Id k = i;
    for (; k > 0 && isLess(item, items[k - 1]); --k)
    {
      items[k] = items[k - 1];
    }
    items[k] = item;
  }
}

/** Adds one to a counter and returns what it was. */
Id Increment(std::atomic<Id>& counter, bool isAlone)
{
  if (!isAlone)
  {
    return counter.fetch_add(1, std::memory_order_relaxed);
  }
  // Without the lock, which would take as long as the rest of the loop.
  const Id value = counter.load(std::memory_order_relaxed);
  counter.store(value + 1, std::memory_order_relaxed);
  return value;
}

/** The neighbors of the old tetrahedra, by the new places and turns of all. */
void CollectNeighbors(const DelaunayTetrahedralization& all, const RawVector<Id>& places,
  const RawVector<unsigned char>& turns, int numberOfThreads, TetMesh& mesh)
{
  unsigned char inverse[12][4];
  for (int turn = 0; turn < 12; ++turn)
  {
    for (int i = 0; i < 4; ++i)
    {
      inverse[turn][Turns[turn][i]] = static_cast<unsigned char>(i);
    }
  }
  mesh.Neighbors.resize(mesh.Tetrahedra.size());
  ForEach(turns.size(), numberOfThreads,
    [&](std::size_t t)
    {
      for (int i = 0; i < 4 && turns[t] != NotMeshed; ++i)
      {
        const Id facet = all.Neighbors[t][Turns[turns[t]][i]];
        const unsigned char turn = turns[facet / 4];
        mesh.Neighbors[places[t]][i] =
          turn == NotMeshed ? NoId : 4 * places[facet / 4] + inverse[turn][facet % 4];
      }
    });
}
} // namespace

//--------------------------------------------------------------------------------------------------
void CollectTetrahedra(DelaunayTetrahedralization& all, RawVector<Id>& regions,
  const std::vector<Id>& points, int numberOfThreads, TetMesh& mesh)
{
  const std::size_t slots = all.Tetrahedra.size();
  // Their order within a vertex is left to chance here; it is settled below.
  std::vector<std::atomic<Id>> counts(points.size());
  RawVector<Id> ranks(slots);
  RawVector<unsigned char> turns(slots);
  const bool isAlone = numberOfThreads <= 1;
  ForEach(slots, numberOfThreads,
    [&](std::size_t t)
    {
      turns[t] = regions[t] == NoId ? NotMeshed : FindTurn(all.Tetrahedra[t]);
      if (turns[t] != NotMeshed)
      {
        ranks[t] = Increment(counts[all.Tetrahedra[t][Turns[turns[t]][0]]], isAlone);
      }
    });
  std::vector<Id> starts(points.size() + 1, 0);
  for (std::size_t vertex = 0; vertex < points.size(); ++vertex)
  {
    starts[vertex + 1] = starts[vertex] + counts[vertex].load(std::memory_order_relaxed);
  }
  // Where the tetrahedra of a vertex will be: the others of their vertices, and where they are now.
  mesh.Tetrahedra.resize(static_cast<std::size_t>(starts.back()));
  ForEach(slots, numberOfThreads,
    [&](std::size_t t)
    {
      if (turns[t] != NotMeshed)
      {
        const TetrahedronIds& ids = all.Tetrahedra[t];
        const unsigned char* const turn = Turns[turns[t]];
        mesh.Tetrahedra[starts[ids[turn[0]]] + ranks[t]] = { ids[turn[1]], ids[turn[2]],
          ids[turn[3]], static_cast<Id>(t) };
      }
    });
  all.Tetrahedra = RawVector<TetrahedronIds>();
  ranks = RawVector<Id>();
  mesh.Regions.resize(mesh.Tetrahedra.size());
  ForEach(points.size(), numberOfThreads,
    [&](std::size_t vertex)
    {
      SortStar(mesh.Tetrahedra.data() + starts[vertex], starts[vertex + 1] - starts[vertex]);
      for (Id place = starts[vertex]; place < starts[vertex + 1]; ++place)
      {
        const TetrahedronIds item = mesh.Tetrahedra[place];
        mesh.Tetrahedra[place] = { points[vertex], points[item[0]], points[item[1]],
          points[item[2]] };
        mesh.Regions[place] = regions[item[3]];
        // From here on regions holds the new index.
        regions[item[3]] = place;
      }
    });
  CollectNeighbors(all, regions, turns, numberOfThreads, mesh);
}
} // namespace cdm
