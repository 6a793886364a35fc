// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/CanonicalNumbering.h"

#include "Core/Basics/ParallelLoop.h"

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace cdm
{
void CollectTetrahedra(DelaunayTetrahedralization& all, RawVector<Id>& regions,
  const std::vector<Id>& points, int numberOfThreads, TetMesh& mesh)
{
  const std::size_t slots = all.Tetrahedra.size();
  // The even permutations: index of the first vertex and of the second one after it.
  static constexpr unsigned char Turns[12][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 },
    { 1, 0, 3, 2 }, { 1, 3, 2, 0 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 2, 1, 3, 0 }, { 2, 3, 0, 1 },
    { 3, 0, 2, 1 }, { 3, 2, 1, 0 }, { 3, 1, 0, 2 } };
  constexpr unsigned char NotMeshed = 12;
  // Their order within a vertex is left to chance here; it is settled below.
  std::vector<std::atomic<Id>> counts(points.size());
  RawVector<Id> ranks(slots);
  RawVector<unsigned char> turns(slots);
  const bool isAlone = numberOfThreads <= 1;
  const auto increment = [isAlone](std::atomic<Id>& counter)
  {
    if (!isAlone)
    {
      return counter.fetch_add(1, std::memory_order_relaxed);
    }
    // Without the lock, which would take as long as the rest of the loop.
    const Id value = counter.load(std::memory_order_relaxed);
    counter.store(value + 1, std::memory_order_relaxed);
    return value;
  };
  ForAll(slots, numberOfThreads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (regions[t] == NoId)
        {
          turns[t] = NotMeshed;
          continue;
        }
        const TetrahedronIds& ids = all.Tetrahedra[t];
        int first = ids[1] < ids[0] ? 1 : 0;
        first = ids[2] < ids[first] ? 2 : first;
        first = ids[3] < ids[first] ? 3 : first;
        int turn = 3 * first;
        turn = ids[Turns[3 * first + 1][1]] < ids[Turns[turn][1]] ? 3 * first + 1 : turn;
        turn = ids[Turns[3 * first + 2][1]] < ids[Turns[turn][1]] ? 3 * first + 2 : turn;
        turns[t] = static_cast<unsigned char>(turn);
        ranks[t] = increment(counts[ids[first]]);
      }
    });
  std::vector<Id> starts(points.size() + 1, 0);
  for (std::size_t vertex = 0; vertex < points.size(); ++vertex)
  {
    starts[vertex + 1] = starts[vertex] + counts[vertex].load(std::memory_order_relaxed);
  }
  // Where the tetrahedra of a vertex will be: the others of their vertices, and where they are now.
  const std::size_t count = static_cast<std::size_t>(starts.back());
  mesh.Tetrahedra.resize(count);
  ForAll(slots, numberOfThreads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (turns[t] != NotMeshed)
        {
          const TetrahedronIds& ids = all.Tetrahedra[t];
          const unsigned char* const turn = Turns[turns[t]];
          mesh.Tetrahedra[starts[ids[turn[0]]] + ranks[t]] = { ids[turn[1]], ids[turn[2]],
            ids[turn[3]], static_cast<Id>(t) };
        }
      }
    });
  all.Tetrahedra = RawVector<TetrahedronIds>();
  ranks = RawVector<Id>();
  mesh.Regions.resize(count);
  ForAll(points.size(), numberOfThreads,
    [&](std::size_t begin, std::size_t end)
    {
      // Two tetrahedra with the same first three vertices would lie on the same side of a facet.
      const auto isLess = [](const TetrahedronIds& s, const TetrahedronIds& t)
      { return s[0] != t[0] ? s[0] < t[0] : s[1] < t[1]; };
      constexpr Id Many = 32;
      for (std::size_t vertex = begin; vertex < end; ++vertex)
      {
        TetrahedronIds* const items = mesh.Tetrahedra.data() + starts[vertex];
        const Id size = starts[vertex + 1] - starts[vertex];
        if (size > Many)
        {
          std::sort(items, items + size, isLess);
        }
        for (Id i = 1; i < size && size <= Many; ++i)
        {
          // They are few: seven, on average.
          const TetrahedronIds item = items[i];
          Id k = i;
          for (; k > 0 && isLess(item, items[k - 1]); --k)
          {
            items[k] = items[k - 1];
          }
          items[k] = item;
        }
        for (Id i = 0; i < size; ++i)
        {
          const TetrahedronIds item = items[i];
          items[i] = { points[vertex], points[item[0]], points[item[1]], points[item[2]] };
          const Id place = starts[vertex] + i;
          mesh.Regions[place] = regions[item[3]];
          // From here on regions holds the new index.
          regions[item[3]] = place;
        }
      }
    });
  const RawVector<Id>& places = regions;
  unsigned char inverse[12][4];
  for (int turn = 0; turn < 12; ++turn)
  {
    for (int i = 0; i < 4; ++i)
    {
      inverse[turn][Turns[turn][i]] = static_cast<unsigned char>(i);
    }
  }
  mesh.Neighbors.resize(count);
  ForAll(slots, numberOfThreads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (turns[t] == NotMeshed)
        {
          continue;
        }
        TetrahedronIds& neighbors = mesh.Neighbors[places[t]];
        for (int i = 0; i < 4; ++i)
        {
          const Id facet = all.Neighbors[t][Turns[turns[t]][i]];
          const unsigned char turn = turns[facet / 4];
          neighbors[i] =
            turn == NotMeshed ? NoId : 4 * places[facet / 4] + inverse[turn][facet % 4];
        }
      }
    });
}
} // namespace cdm
