// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellSizing.h
 * @brief A sizing field given at points, linear in tetrahedra between them.
 *
 * In a tetrahedron the lengths of its corners are interpolated; outside of all tetrahedra, and
 * without any, the nearest point has the length.
 *
 * Cost: O(n log n) to build; a query O(log n) for tetrahedra of usual shapes.
 */
#ifndef cdmCellSizing_h
#define cdmCellSizing_h

#include "Core/Basics/Status.h"
#include "Core/Sizing/SizingField.h"

#include <vector>

namespace cdm
{
/**
 * @param cells tetrahedra with ids of points, or none
 * @param lengths one for each point
 * InvalidInput names points whose coordinates are not finite or whose length is not positive.
 */
Status MakeCellSizing(SizingCells cells, std::vector<double> lengths, SizingField& sizing);
} // namespace cdm

#endif
