// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PulledSphere.h
 * @brief The pulling rule: a symbolic perturbation that puts cospherical points inside or outside
 *   of a
 * sphere.
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
  // The point that is pulled most decides. If it is the tested point, it comes to lie inside. If it
  // is a vertex, the tested point lies outside on the tetrahedron's side of the other three
  // vertices, and inside on their other side. If these three are coplanar with the tested point,
  // the next point decides.
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
