// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Tuples.h
 * @brief Data arrays on their way from the input to the output of a stage.
 *
 * A source id of -1 means "none": the tuple made for it is zero, or the empty string.
 */
#ifndef CoreBridge_Tuples_h
#define CoreBridge_Tuples_h

#include "Core/Basics/Types.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include <vtkType.h>

#include <vector>

class vtkDataSetAttributes;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkCoreBridge
{
/**
 * Copy the tuple sources[i] to i for all arrays but the named ones, which a stage writes itself.
 */
void CopyTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  vtkDataSetAttributes* to, const std::vector<const char*>& except = {});

/** Cell data of a surface by source cell; keeps the array BoundaryLabels that is there already. */
void CopyCellTuples(vtkPolyData* from, const std::vector<vtkIdType>& sources, vtkPolyData* to);

/** The same with sources counted from the first polygon of the surface; cdm::NoId stays none. */
void CopyTriangleTuples(vtkPolyData* from, const std::vector<cdm::Id>& sources, vtkPolyData* to);

/** Which ids the parents of new points are. */
enum class ParentIds
{
  Input,
  Output
};

/**
 * Copy the tuple sources[i] to i; the tuples of new points are interpolated after them. Arrays of
 * global and pedigree ids are left out: there is no id between two ids.
 */
void InterpolateTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  const std::vector<cdm::PointParents>& newPoints, ParentIds parentIds, vtkDataSetAttributes* to);

/**
 * Point data of a mesh made from another one: of the input point sources[i], or interpolated where
 * the output's point i lies in the input's cells if there is none. Arrays of ids are left out, and
 * FreePoint, which is no property of a place.
 */
void InterpolateTuplesInCells(
  vtkUnstructuredGrid* input, const std::vector<cdm::Id>& sources, vtkUnstructuredGrid* output);

/**
 * All tuples of first, then the tuples sources[i] of second: the arrays that both have (same name,
 * type and number of components). second may be null if there are no sources.
 */
void AppendTuples(vtkDataSetAttributes* first, vtkDataSetAttributes* second,
  const std::vector<cdm::Id>& sources, vtkDataSetAttributes* to);
} // namespace vtkCoreBridge

#endif
