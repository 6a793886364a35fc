// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PulledSphere.h
 * @brief Inside or outside of a sphere that a point lies on: the pulling rule for cospherical
 * points.
 *
 * Points on one sphere are told apart as if each had been pulled into it infinitely little, the
 * lowest numbered one most: the tetrahedra are then those of the pulling rule, and none is flat.
 *
 * Reference: O. Devillers, M. Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
 * triangulations", 2011, doi:10.1016/j.comgeo.2010.09.010 (perturbed spheres make no flat
 * tetrahedra).
 */
#ifndef cdmPulledSphere_h
#define cdmPulledSphere_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <limits>

namespace cdm
{
/**
 * +1 inside, -1 outside, for a point on the circumsphere of a positive tetrahedron.
 * @param vertices of the tetrahedron, with their numbers; own is the number of the point
 * @param getSide the exact sign of Orientation() in Predicates.h
 */
template <typename GetSide>
int GetPulledPosition(const std::array<Vec3, 4>& vertices, const std::array<Id, 4>& numbers,
  const Vec3& point, Id own, GetSide&& getSide)
{
  // What is pulled most decides: the point comes to lie within; another one leaves the point
  // outside where the tetrahedron is, and inside on the other side of its other three. If these are
  // coplanar with the point the next one decides.
  Id limit = std::numeric_limits<Id>::min();
  for (;;)
  {
    Id lowest = own;
    int place = -1;
    for (int i = 0; i < 4; ++i)
    {
      if (numbers[i] > limit && numbers[i] < lowest)
      {
        lowest = numbers[i];
        place = i;
      }
    }
    if (place < 0)
    {
      return 1;
    }
    std::array<Vec3, 4> other = vertices;
    other[place] = point;
    const int side = getSide(other[0], other[1], other[2], other[3]);
    if (side != 0)
    {
      return -side;
    }
    limit = lowest;
  }
}
} // namespace cdm

#endif
