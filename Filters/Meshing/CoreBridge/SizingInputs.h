// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizingInputs.h
 * @brief Data sets that say how fine a mesh has to be.
 */
#ifndef CoreBridge_SizingInputs_h
#define CoreBridge_SizingInputs_h

#include "Core/Basics/Status.h"
#include "Core/Sizing/SizingField.h"

#include <vtkSmartPointer.h>

class vtkDataSet;

namespace vtkCoreBridge
{
/**
 * The point array Sizing as a field: interpolated in the cell that holds the position, outside of
 * the cells at the nearest point of them, or taken from the nearest point if there are no cells.
 * One component: a length; 3: one for each axis; 6 (xx, yy, zz, xy, yz, xz) or 9: a symmetric
 * tensor with the lengths as its principal values. The field keeps what it needs of the input.
 */
cdm::Status ToSizing(vtkDataSet* input, cdm::SizingField& sizing);

/**
 * A shallow copy in which nothing is blanked. Where a surface is resampled to an image all cells are
 * blanked, and VTK 9.3 finds neither cells nor gradients there.
 */
vtkSmartPointer<vtkDataSet> CopyWithoutBlanking(vtkDataSet* input);

/** Points and cells of any data set. */
cdm::Status ToSizingCells(vtkDataSet* input, cdm::SizingCells& cells);
} // namespace vtkCoreBridge

#endif
