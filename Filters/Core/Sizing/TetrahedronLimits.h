// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronLimits.h
 * @brief Limits of the size and shape of tetrahedra, and the Steiner point that would improve one.
 *
 * A tetrahedron is too large by its volume, by an edge that is longer than allowed or than the
 * sizing asks for anywhere in it, or by a rule of the caller; it is badly shaped if the ratio of its
 * circumradius to its shortest edge is too large. A point at the circumcenter destroys it. For a badly shaped one the
 * off-center serves better: on the way from the middle of the shortest edge to the circumcenter,
 * where the triangle that it makes with this edge is just well shaped. That leaves larger
 * tetrahedra and needs fewer points.
 *
 * Reference: A. Ungor, "Off-centers: A new type of Steiner points for computing size-optimal
 * quality-guaranteed Delaunay triangulations", 2009, doi:10.1016/j.comgeo.2008.06.002.
 */
#ifndef cdmTetrahedronLimits_h
#define cdmTetrahedronLimits_h

#include "Core/Basics/Vec3.h"
#include "Core/Sizing/SizingField.h"

#include <array>
#include <functional>

namespace cdm
{
enum class TetrahedronFault : unsigned char
{
  None = 0,
  Size = 1,
  Shape = 2
};

struct TetrahedronLimits
{
  /** Circumradius to shortest edge; 0: no limit. A regular tetrahedron has 0.612. */
  double RadiusEdgeRatio = 0.0;
  /** Cubic model units; 0: no limit. */
  double MaximumVolume = 0.0;
  /** Model units; 0: no limit. */
  double MaximumEdgeLength = 0.0;
  /** May be empty. */
  SizingField Sizing;
  /** Whether a tetrahedron whose longest edge is given is too large. May be empty. */
  std::function<bool(const std::array<Vec3, 4>& vertices, double longest)> IsTooLarge;

  /**
   * @param isShapeTested whether the shape counts
   * @param target if there is a fault: where to put a point
   * @param severity of the fault: the circumradius of a large one, the ratio of a badly shaped one
   */
  TetrahedronFault Find(
    const std::array<Vec3, 4>& vertices, bool isShapeTested, Vec3& target, double& severity) const;
};
} // namespace cdm

#endif
