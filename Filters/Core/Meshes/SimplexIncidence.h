// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexIncidence.h
 * @brief Tetrahedra at each point, and facets and edges gathered at their lowest point, for
 * parallel passes.
 *
 * Built by counting, without a sort of all of them: each thread fills the lists of a range of
 * points. The functions that visit the facets and edges of a point then sort these few.
 *
 * Cost: O(n) to build; 16 bytes per tetrahedron and 4 per point.
 */
#ifndef cdmSimplexIncidence_h
#define cdmSimplexIncidence_h

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
class SimplexIncidence
{
public:
  /** The mesh has to outlive the object. Threads: 0: one for each processor core. */
  SimplexIncidence(const TetMesh& mesh, int numberOfThreads);

  /** A facet or an edge of one tetrahedron, at its lowest point. */
  struct Record
  {
    /** The other points, ascending; the third of an edge is NoId. */
    Id Second;
    Id Third;
    /** 4 * tetrahedron + i for a facet, 6 * tetrahedron + i for an edge. */
    Id Simplex;

    friend bool operator<(const Record& a, const Record& b)
    {
      const std::uint64_t points = PackIds(a.Second, a.Third);
      const std::uint64_t others = PackIds(b.Second, b.Third);
      return points != others ? points < others : a.Simplex < b.Simplex;
    }
  };

  /** Whether a tetrahedron has the point. */
  bool IsUsed(Id point) const { return this->Begin[point] < this->Begin[point + 1]; }

  Id CountTetrahedra(Id point) const { return this->Begin[point + 1] - this->Begin[point]; }

  /** Calls visit(tetrahedron, i) where the point is vertex i of it; tetrahedra ascend. */
  template <typename Visitor>
  void ForEachTetrahedron(Id point, Visitor&& visit) const
  {
    for (Id i = this->Begin[point]; i < this->Begin[point + 1]; ++i)
    {
      visit(this->Corners[i] / 4, this->Corners[i] % 4);
    }
  }

  /**
   * Calls visit(points, begin, end) for each facet whose lowest point is the given one: [begin,
   * end) are its Records, ascending. scratch is overwritten.
   */
  template <typename Visitor>
  void ForEachFacet(Id point, std::vector<Record>& scratch, Visitor&& visit) const
  {
    scratch.clear();
    this->ForEachTetrahedron(point,
      [&](Id tetrahedron, int vertex)
      {
        const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
        const int* others = FacetVertices[vertex];
        const bool isLower[3] = { this->IsLower(tetrahedron, others[0], vertex),
          this->IsLower(tetrahedron, others[1], vertex),
          this->IsLower(tetrahedron, others[2], vertex) };
        // The vertex is the lowest point of three facets if no other one is lower, and of one facet
        // if one other is.
        const int numberOfLower = isLower[0] + isLower[1] + isLower[2];
        for (int i = 0; i < 3 && numberOfLower < 2; ++i)
        {
          if (numberOfLower == 0 || isLower[i])
          {
            const auto [second, third] =
              std::minmax(ids[others[(i + 1) % 3]], ids[others[(i + 2) % 3]]);
            scratch.push_back({ second, third, 4 * tetrahedron + others[i] });
          }
        }
      });
    VisitGroups(point, scratch, visit);
  }

  /** The same for edges. */
  template <typename Visitor>
  void ForEachEdge(Id point, std::vector<Record>& scratch, Visitor&& visit) const
  {
    scratch.clear();
    this->ForEachTetrahedron(point,
      [&](Id tetrahedron, int vertex)
      {
        constexpr int EdgeBetween[4][4] = { { -1, 0, 1, 2 }, { 0, -1, 3, 4 }, { 1, 3, -1, 5 },
          { 2, 4, 5, -1 } };
        for (int other = 0; other < 4; ++other)
        {
          if (other != vertex && this->IsLower(tetrahedron, vertex, other))
          {
            scratch.push_back({ this->Mesh.Tetrahedra[tetrahedron][other], NoId,
              6 * tetrahedron + EdgeBetween[vertex][other] });
          }
        }
      });
    VisitGroups(point, scratch, visit);
  }

private:
  /** A total order of the vertices of any tetrahedron, also of one with a point twice. */
  bool IsLower(Id tetrahedron, int vertex, int other) const
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
    return ids[vertex] != ids[other] ? ids[vertex] < ids[other] : vertex < other;
  }

  template <typename Visitor>
  static void VisitGroups(Id point, std::vector<Record>& scratch, Visitor&& visit)
  {
    std::sort(scratch.begin(), scratch.end());
    for (auto begin = scratch.cbegin(), end = begin; begin != scratch.cend(); begin = end)
    {
      while (end != scratch.cend() && end->Second == begin->Second && end->Third == begin->Third)
      {
        ++end;
      }
      visit(TriangleIds{ point, begin->Second, begin->Third }, begin, end);
    }
  }

  const TetMesh& Mesh;
  /**
   * For each point the index of its first entry in Corners, which are 4 * tetrahedron + vertex,
   * ascending.
   */
  std::vector<Id> Begin;
  RawVector<Id> Corners;
};
} // namespace cdm

#endif
