// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CavityFilling.h
 * @brief Fills a cavity in a Delaunay mesh with Delaunay tetrahedra of the points on its border.
 *
 * Where a point of a Delaunay mesh is removed or moved, the tetrahedra around it leave a cavity. It
 * can be filled with tetrahedra of the points at the cavity alone.
 *
 * Method: all points are tetrahedralized. From each facet of the border a flood goes inwards, from
 * tetrahedron to tetrahedron, to walls (facets between two regions, which have to be there) and the
 * border.
 *
 * Exact; points on one sphere are told apart by the pulling rule of their numbers. Cost: some ten
 * microseconds, and about two for each tetrahedron.
 */
#ifndef cdmCavityFilling_h
#define cdmCavityFilling_h

#include "Core/Basics/RawVector.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
struct Cavity
{
  /** Numbers of the points, ascending, and their positions. */
  std::vector<Id> Numbers;
  RawVector<Vec3> Points;
  /** Facets around the cavity, by numbers; the inside is in front of each. */
  std::vector<TriangleIds> Border;
  /** One for each facet of the border: the region in front of it. */
  std::vector<Id> Regions;
  /**
   * Facets between two regions, by numbers; the far side of a wall need not be inside the cavity.
   */
  std::vector<TriangleIds> Walls;
};

class CavityFilling
{
public:
  struct Cell
  {
    /** Numbers of points. */
    TetrahedronIds Ids;
    Id Region;
    /**
     * 4 * cell + facet; or OutOf(k) behind border facet k; or NoId behind a wall without a cell
     * there.
     */
    std::array<Id, 4> Neighbors;
  };
  static Id OutOf(Id facet) { return -2 - facet; }
  /** The inverse of OutOf(), or negative. */
  static Id GetBorderFacet(Id neighbor) { return -2 - neighbor; }

  /**
   * False if the tetrahedra of the points do not have all facets of the border and all walls, or
   * if these do not separate the regions from each other and from the outside; or for more than two
   * million points.
   */
  bool Run(const Cavity& cavity);
  const std::vector<Cell>& GetCells() const { return this->Cells; }

private:
  class Flood;

  std::vector<Cell> Cells;
  /** Work space: facets of local tetrahedra, by their points' indices in the cavity. */
  std::vector<std::pair<std::uint64_t, Id>> Facets;
};
} // namespace cdm

#endif
