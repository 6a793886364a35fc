// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexIncidence.h
 * @brief Facets and edges of tetrahedra gathered at their lowest point, for parallel passes.
 *
 * Built by counting, without a sort of all of them; ForEachGroup() then sorts the few of one point.
 * 16 bytes per tetrahedron for facets, 24 for edges, and 4 per point.
 */
#ifndef cdmSimplexIncidence_h
#define cdmSimplexIncidence_h

#include "TetMesh.h"

#include <algorithm>
#include <numeric>

namespace cdm
{
class SimplexIncidence
{
public:
  /** Facet ids 4 * tetrahedron + i. */
  static SimplexIncidence OfFacets(const TetMesh& mesh) { return SimplexIncidence(mesh, 4); }
  /** Edge ids 6 * tetrahedron + i. */
  static SimplexIncidence OfEdges(const TetMesh& mesh) { return SimplexIncidence(mesh, 6); }

  /** Points of a facet or an edge, ascending; the third of an edge is NoId. */
  static TriangleIds GetPoints(const TetMesh& mesh, int perTetrahedron, Id simplex)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[simplex / perTetrahedron];
    TriangleIds points;
    if (perTetrahedron == 4)
    {
      points = GetFacet(ids, simplex % 4);
      std::sort(points.begin(), points.end());
    }
    else
    {
      const int* edge = TetrahedronEdges[simplex % 6];
      points = { std::min(ids[edge[0]], ids[edge[1]]), std::max(ids[edge[0]], ids[edge[1]]), NoId };
    }
    return points;
  }

  /** A facet or an edge of one tetrahedron, at its lowest point. */
  struct Record
  {
    Id Second;
    Id Third;
    Id Simplex;

    friend bool operator<(const Record& a, const Record& b)
    {
      return a.Second != b.Second ? a.Second < b.Second
        : a.Third != b.Third      ? a.Third < b.Third
                                  : a.Simplex < b.Simplex;
    }
  };

  /**
   * Calls visit(points, begin, end) for each facet or edge whose lowest point is the given one:
   * [begin, end) are its Records, ascending. scratch is overwritten.
   */
  template <typename Visitor>
  void ForEachGroup(Id point, std::vector<Record>& scratch, Visitor&& visit) const
  {
    scratch.clear();
    for (Id i = this->Begin[point]; i < this->Begin[point + 1]; ++i)
    {
      const TriangleIds points = GetPoints(this->Mesh, this->PerTetrahedron, this->Simplices[i]);
      scratch.push_back({ points[1], points[2], this->Simplices[i] });
    }
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

private:
  SimplexIncidence(const TetMesh& mesh, int perTetrahedron)
    : Mesh(mesh), PerTetrahedron(perTetrahedron), Begin(mesh.Points.size() + 1, 0),
      Simplices(mesh.Tetrahedra.size() * perTetrahedron)
  {
    const Id count = static_cast<Id>(this->Simplices.size());
    for (Id simplex = 0; simplex < count; ++simplex)
    {
      ++this->Begin[GetPoints(mesh, perTetrahedron, simplex)[0]];
    }
    std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
    for (Id simplex = count - 1; simplex >= 0; --simplex)
    {
      this->Simplices[--this->Begin[GetPoints(mesh, perTetrahedron, simplex)[0]]] = simplex;
    }
  }

  const TetMesh& Mesh;
  int PerTetrahedron;
  std::vector<Id> Begin;
  std::vector<Id> Simplices;
};
} // namespace cdm

#endif
