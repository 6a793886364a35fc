// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RoundHole.h
 * @brief A circle in a rectangle of a layout, for vias.
 */
#ifndef cdmRoundHole_h
#define cdmRoundHole_h

#include "Devices/LayeredStructure.h"

#include <array>
#include <vector>

namespace cdm
{
struct RoundHole
{
  /** A regular polygon about the origin with its corners on the circle, counter-clockwise. */
  std::vector<Id> Circle;
  /** The rectangle without the hole, in two pieces without holes. */
  std::array<std::vector<Id>, 2> Surroundings;
};

/**
 * Adds the vertices of the circle; cells are left to the caller. Corners: lower left, lower right,
 * upper right, upper left, of a rectangle that has the circle inside of it.
 */
RoundHole AddRoundHole(LayeredStructure& structure, const std::array<Id, 4>& corners, double radius,
  int numberOfSegments);
} // namespace cdm

#endif
