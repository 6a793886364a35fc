// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Cavity.h
 * @brief A cavity in a Delaunay mesh, and the cells that fill it.
 */
#ifndef cdmCavity_h
#define cdmCavity_h

#include "Core/Basics/RawVector.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <algorithm>
#include <array>
#include <functional>
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

  /** Makes it empty, and keeps the memory: most cavities take a few microseconds. */
  void Clear()
  {
    this->Numbers.clear();
    this->Points.clear();
    this->Border.clear();
    this->Regions.clear();
    this->Walls.clear();
  }

  /** The indices of a facet's points; the number of points for one that the cavity does not have. */
  TriangleIds FindCorners(TriangleIds facet) const
  {
    for (Id& id : facet)
    {
      const auto place = std::lower_bound(this->Numbers.begin(), this->Numbers.end(), id);
      const bool isThere = place != this->Numbers.end() && *place == id;
      id = static_cast<Id>((isThere ? place : this->Numbers.end()) - this->Numbers.begin());
    }
    return facet;
  }
};

/** A tetrahedron that fills a part of a cavity. */
struct CavityCell
{
  /** Numbers of points. */
  TetrahedronIds Ids;
  Id Region;
  /**
   * 4 * cell + facet; or OutOf(k) behind border facet k; or NoId behind a wall without a cell there.
   */
  std::array<Id, 4> Neighbors;

  static Id OutOf(Id facet) { return -2 - facet; }
  /** The inverse of OutOf(), or negative. */
  static Id GetBorderFacet(Id neighbor) { return -2 - neighbor; }
};

/** Whether a cell with these points and this region is of any use. */
using CavityCellTest = std::function<bool(const TetrahedronIds& ids, Id region)>;
} // namespace cdm

#endif
