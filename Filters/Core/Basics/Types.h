// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Types.h
 * @brief Integer vocabulary of the engine: ids, simplices and region labels.
 *
 * Ids are 32 bits wide inside the engine (an input that needs more is refused by the stages);
 * VTK's own id type appears only in Filters/Meshing.
 */
#ifndef cdmTypes_h
#define cdmTypes_h

#include <array>
#include <cstdint>
#include <limits>

namespace cdm
{
/** Index of a point, a triangle, a tetrahedron, ... */
using Id = std::int32_t;

/** "No limit", and larger than all that is compared with it. */
constexpr double Infinity = std::numeric_limits<double>::infinity();

/** "None": no neighbour, no source cell, no parent. */
constexpr Id NoId = -1;

/** Region id of the unbounded outside, as in the array BoundaryLabels. */
constexpr Id OutsideRegion = -1;

using EdgeIds = std::array<Id, 2>;

/** Counter-clockwise seen from the front side, the side that the normal points to. */
using TriangleIds = std::array<Id, 3>;

/** Positively oriented in VTK's sense: the front of the triangle (0, 1, 2) faces point 3. */
using TetrahedronIds = std::array<Id, 4>;

/** Regions on the two sides of a polygon or triangle (array BoundaryLabels). */
struct RegionPair
{
  Id Front = OutsideRegion;
  Id Back = OutsideRegion;

  friend bool operator==(const RegionPair& a, const RegionPair& b)
  {
    return a.Front == b.Front && a.Back == b.Back;
  }
  friend bool operator!=(const RegionPair& a, const RegionPair& b) { return !(a == b); }
};

/**
 * How a new point came about: the weighted sum of up to three parents, each with a smaller id than
 * the point itself, so that point data can be interpolated in the order of the ids.
 */
struct PointParents
{
  std::array<Id, 3> Ids{ NoId, NoId, NoId };
  std::array<double, 3> Weights{ 0.0, 0.0, 0.0 };
};
} // namespace cdm

#endif
