// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/CanonicalNumbering.h"

#include "Core/Basics/ParallelLoop.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace cdm
{
namespace
{
/** The even permutations: index of the first vertex and of the second one after it. */
constexpr unsigned char Turns[12][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 },
  { 1, 0, 3, 2 }, { 1, 3, 2, 0 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 2, 1, 3, 0 }, { 2, 3, 0, 1 },
  { 3, 0, 2, 1 }, { 3, 2, 1, 0 }, { 3, 1, 0, 2 } };
constexpr unsigned char NotMeshed = 12;

/**
 * The permutation that puts the lowest vertex first and the second lowest after it, by which vertices
 * are lower than which others: the comparisons are unpredictable, and a table takes no branch.
 */
class TurnTable
{
public:
  TurnTable()
  {
    TetrahedronIds ids{ 0, 1, 2, 3 };
    do
    {
      unsigned char best = 0;
      for (unsigned char turn = 1; turn < NotMeshed; ++turn)
      {
        const bool isFirstLower = ids[Turns[turn][0]] < ids[Turns[best][0]];
        const bool isFirstSame = Turns[turn][0] == Turns[best][0];
        best =
          isFirstLower || (isFirstSame && ids[Turns[turn][1]] < ids[Turns[best][1]]) ? turn : best;
      }
      this->Entries[GetOrder(ids)] = best;
    } while (std::next_permutation(ids.begin(), ids.end()));
  }

  unsigned char Find(const TetrahedronIds& ids) const { return this->Entries[GetOrder(ids)]; }

private:
  static unsigned GetOrder(const TetrahedronIds& ids)
  {
    return unsigned(ids[0] < ids[1]) | unsigned(ids[0] < ids[2]) << 1 |
      unsigned(ids[0] < ids[3]) << 2 | unsigned(ids[1] < ids[2]) << 3 |
      unsigned(ids[1] < ids[3]) << 4 | unsigned(ids[2] < ids[3]) << 5;
  }

  unsigned char Entries[64] = {};
};

/** Sorts the tetrahedra of one vertex by their other vertices, of which two tell them apart. */
void SortStar(TetrahedronIds* items, Id size)
{
  // Two tetrahedra with the same first three vertices would lie on the same side of a facet.
  const auto getKey = [](const TetrahedronIds& item)
  {
    return static_cast<std::uint64_t>(std::get<0>(item)) << 32 |
      static_cast<std::uint64_t>(std::get<1>(item));
  };
  constexpr Id Many = 16;
  if (size > Many)
  {
    std::sort(items, items + size,
      [&](const TetrahedronIds& s, const TetrahedronIds& t) { return getKey(s) < getKey(t); });
    return;
  }
  // They are few, seven on average: each counts how many are lower, without branches, which would
  // be unpredictable.
  TetrahedronIds copies[Many];
  std::uint64_t keys[Many];
  Id places[Many];
  for (Id i = 0; i < size; ++i)
  {
    copies[i] = items[i];
    keys[i] = getKey(copies[i]);
    places[i] = 0;
    for (Id k = 0; k < i; ++k)
    {
      const Id isLower = keys[i] < keys[k] ? 1 : 0;
      places[k] += isLower;
      places[i] += 1 - isLower;
    }
  }
  for (Id i = 0; i < size; ++i)
  {
    items[places[i]] = copies[i];
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

/**
 * Moves items to new places, in two halves: those of the second one wait at the front of the old
 * array, whose rest is released. So the arrays never take more than 1.5 times the memory of one.
 * @param places of the items; NoId: dropped. Both are used up
 */
void MoveToPlaces(RawVector<TetrahedronIds>& items, RawVector<Id>& places, int numberOfThreads,
  RawVector<TetrahedronIds>& moved)
{
  const auto half = static_cast<Id>(moved.size() / 2);
  const ParallelLoopOptions options = MakeLargeBlocks(items.size(), numberOfThreads);
  std::vector<std::size_t> ends(GetNumberOfBlocks(items.size(), options));
  ParallelLoop(items.size(), options, {}, "",
    [&](std::size_t begin, std::size_t end, std::size_t block)
    {
      std::size_t kept = begin;
      for (std::size_t i = begin; i < end; ++i)
      {
        const Id place = places[i];
        if (place != NoId && place < half)
        {
          moved[place] = items[i];
        }
        else if (place != NoId)
        {
          items[kept] = items[i];
          places[kept++] = place;
        }
      }
      ends[block] = kept;
      ReleaseMemory(items, kept, end);
    });
  ParallelLoop(items.size(), options, {}, "",
    [&](std::size_t begin, std::size_t, std::size_t block)
    {
      for (std::size_t i = begin; i < ends[block]; ++i)
      {
        moved[places[i]] = items[i];
      }
    });
  items = RawVector<TetrahedronIds>();
}

/**
 * Sorts the tetrahedra of each vertex, and lists them by their points and regions.
 * @param starts where the tetrahedra of each vertex begin
 * @param regions by old indices; then the new index of each, NoId if it has none
 */
void SortStars(const std::vector<Id>& starts, const std::vector<Id>& points, int numberOfThreads,
  RawVector<Id>& regions, TetMesh& mesh)
{
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
        regions[item[3]] = place;
      }
    });
}

/** Replaces the neighbors of tetrahedra by their new facet ids, from the places and turns of all. */
void RenumberNeighbors(const RawVector<Id>& places, const RawVector<unsigned char>& turns,
  int numberOfThreads, RawVector<TetrahedronIds>& neighbors)
{
  unsigned char inverse[12][4];
  for (int turn = 0; turn < 12; ++turn)
  {
    for (int i = 0; i < 4; ++i)
    {
      inverse[turn][Turns[turn][i]] = static_cast<unsigned char>(i);
    }
  }
  ForEach(turns.size(), numberOfThreads,
    [&](std::size_t t)
    {
      const unsigned char own = turns[t];
      if (own == NotMeshed)
      {
        return;
      }
      const TetrahedronIds facets = neighbors[t];
      for (int i = 0; i < 4; ++i)
      {
        const Id facet = facets[Turns[own][i]];
        const unsigned char turn = turns[facet / 4];
        neighbors[t][i] =
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
  // Their order within a vertex is left to chance here; it is settled below. Ranks first, then
  // places.
  std::vector<std::atomic<Id>> counts(points.size());
  RawVector<Id> places(slots);
  RawVector<unsigned char> turns(slots);
  const bool isAlone = numberOfThreads <= 1;
  const TurnTable table;
  ForEach(slots, numberOfThreads,
    [&](std::size_t t)
    {
      turns[t] = regions[t] == NoId ? NotMeshed : table.Find(all.Tetrahedra[t]);
      if (turns[t] != NotMeshed)
      {
        places[t] = Increment(counts[all.Tetrahedra[t][Turns[turns[t]][0]]], isAlone);
      }
    });
  std::vector<Id> starts(points.size() + 1, 0);
  for (std::size_t vertex = 0; vertex < points.size(); ++vertex)
  {
    starts[vertex + 1] = starts[vertex] + counts[vertex].load(std::memory_order_relaxed);
  }
  // The others of its vertices, and where it is now.
  ForEach(slots, numberOfThreads,
    [&](std::size_t t)
    {
      if (turns[t] == NotMeshed)
      {
        places[t] = NoId;
        return;
      }
      const TetrahedronIds ids = all.Tetrahedra[t];
      const unsigned char* const turn = Turns[turns[t]];
      places[t] += starts[ids[turn[0]]];
      all.Tetrahedra[t] = { ids[turn[1]], ids[turn[2]], ids[turn[3]], static_cast<Id>(t) };
    });
  mesh.Tetrahedra.resize(static_cast<std::size_t>(starts.back()));
  MoveToPlaces(all.Tetrahedra, places, numberOfThreads, mesh.Tetrahedra);
  SortStars(starts, points, numberOfThreads, regions, mesh);
  places = RawVector<Id>();
  RenumberNeighbors(regions, turns, numberOfThreads, all.Neighbors);
  turns = RawVector<unsigned char>();
  mesh.Neighbors.resize(mesh.Tetrahedra.size());
  MoveToPlaces(all.Neighbors, regions, numberOfThreads, mesh.Neighbors);
}
} // namespace cdm
