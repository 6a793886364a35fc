// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CavityWrapping.h
 * @brief Fills a cavity of few points with Delaunay tetrahedra, one by one.
 *
 * Method: the advancing front of the thesis (5.2). From each facet of the border, and then from each
 * facet of what has been made, a tetrahedron is made with the point that FacetApex.h finds in front
 * of it, up to walls and the border. A hash table of oriented facets tells which are closed.
 *
 * Guarantees: as CavityFilling.h. Cost: 0.4 microseconds for each tetrahedron of a cavity of 15
 * points, and in proportion to these. That is a third of what it takes to insert the points one after
 * the other, which pays for a hundred points and more.
 */
#ifndef cdmCavityWrapping_h
#define cdmCavityWrapping_h

#include "Core/Delaunay/Cavity.h"

#include <array>
#include <cstddef>
#include <vector>

namespace cdm
{
class CavityWrapping
{
public:
  static constexpr std::size_t MostPoints = 64;

  /**
   * Makes the cells. False in the cases of CavityFilling::Run(), and for a cell that is not accepted.
   * @param accepts may be empty
   */
  bool Run(const Cavity& cavity, const CavityCellTest& accepts, std::vector<CavityCell>& cells);

private:
  class Front;

  /** Behind a facet is a tetrahedron, or a wall; or else a facet of the border, by its index. */
  static constexpr Id Open = -1;
  static constexpr Id Wall = -2;

  /** A facet, as seen from its sides: 0 is where its points turn counter-clockwise from outside. */
  struct Facet
  {
    /** Indices in the cavity, the lowest first, then ascending. */
    TriangleIds Points;
    /** 4 * cell + facet of the tetrahedra on its sides, where these are cells. */
    std::array<Id, 2> Inner{ NoId, NoId };
    /** What is behind the facet for them. */
    std::array<Id, 2> Behind{ Open, Open };
  };

  void Clear(std::size_t numberOfPoints);
  /** The side that sees the points in this order; it is new if the facet is. */
  Id GetSide(const TriangleIds& points);
  std::size_t FindPlace(const TriangleIds& ascending) const;
  void Grow();
  Id& GetInner(Id side) { return this->Facets[side / 2].Inner[side % 2]; }
  Id& GetBehind(Id side) { return this->Facets[side / 2].Behind[side % 2]; }

  std::vector<Facet> Facets;
  /** Hash table with open addresses: indices of facets, or NoId. */
  std::vector<Id> Table;
  /** The sides of each cell's facets, 2 * facet + side. */
  std::vector<std::array<Id, 4>> CellSides;
};
} // namespace cdm

#endif
