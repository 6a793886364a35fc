// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointTemplates.h
 * @brief The points of a cell: corners, center, or the unit cell of a lattice (thesis 6.2).
 *
 * Places are counted in halves of the cell's edges. One in the middle of all edges is the center,
 * one in the middle of two is that of a side.
 */
#ifndef cdmPointTemplates_h
#define cdmPointTemplates_h

#include "Core/MeshPoints/MeshPointGenerator.h"

#include <array>
#include <vector>

namespace cdm
{
/** Edge of a lattice's unit cell whose nearest points are at a distance of 1. */
double GetLatticeConstant(PointTemplate kind);

/** Whether a template has a point where so many coordinates are in the middle of a cell. */
bool HasTemplatePoint(PointTemplate kind, int middles);

/** Places of a template's points in a cell, in halves of its edges. */
std::vector<std::array<int, 3>> GetTemplatePoints(PointTemplate kind);
} // namespace cdm

#endif
