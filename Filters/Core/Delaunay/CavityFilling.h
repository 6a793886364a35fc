// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CavityFilling.h
 * @brief Fills a cavity in a Delaunay mesh with Delaunay tetrahedra of the points on its border.
 *
 * Where a point of a Delaunay mesh is removed or moved, the tetrahedra around it leave a cavity. It
 * can be filled with tetrahedra of the points at the cavity alone.
 *
 * Method: few points make their tetrahedra one by one (CavityWrapping.h). More points are all
 * tetrahedralized; from each facet of the border a flood goes inwards, from tetrahedron to
 * tetrahedron, to walls (facets between two regions, which have to be there) and the border.
 *
 * Exact; points on one sphere are told apart by the pulling rule of their numbers. Cost: 0.4
 * microseconds for each tetrahedron of few points, 3 of many.
 */
#ifndef cdmCavityFilling_h
#define cdmCavityFilling_h

#include "Core/Delaunay/Cavity.h"
#include "Core/Delaunay/CavityWrapping.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
class CavityFilling
{
public:
  /**
   * False if the tetrahedra of the points do not have all facets of the border and all walls, or
   * if these do not separate the regions from each other and from the outside; or for more than two
   * million points.
   * @param accepts if given, false as soon as a cell is found that is not accepted
   */
  bool Run(const Cavity& cavity, const CavityCellTest& accepts = {});
  const std::vector<CavityCell>& GetCells() const { return this->Cells; }

private:
  class Flood;

  std::vector<CavityCell> Cells;
  CavityWrapping Wrapping;
  /** Work space: facets of local tetrahedra, by their points' indices in the cavity. */
  std::vector<std::pair<std::uint64_t, Id>> Facets;
};
} // namespace cdm

#endif
