// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PolygonSoup.h
 * @brief The input: one unsorted list of polygons, of any orientation and any connectivity.
 */
#ifndef cdmPolygonSoup_h
#define cdmPolygonSoup_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
/**
 * Invariants: Offsets has one entry more than there are polygons, starts with 0, ascends, and ends
 * with the size of Connectivity; Connectivity holds ids of Points. Labels is empty, or has one pair
 * for each polygon.
 */
struct PolygonSoup
{
  std::vector<Vec3> Points;
  std::vector<Id> Offsets{ 0 };
  std::vector<Id> Connectivity;
  std::vector<RegionPair> Labels;

  Id GetNumberOfPolygons() const { return static_cast<Id>(this->Offsets.size()) - 1; }
  Id GetPolygonSize(Id polygon) const
  {
    return this->Offsets[polygon + 1] - this->Offsets[polygon];
  }
  const Id* GetPolygon(Id polygon) const
  {
    return this->Connectivity.data() + this->Offsets[polygon];
  }
};
} // namespace cdm

#endif
