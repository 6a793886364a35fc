// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ArrayNames.h
 * @brief Names of the arrays that stages hand to each other.
 */
#ifndef CoreBridge_ArrayNames_h
#define CoreBridge_ArrayNames_h

namespace vtkCoreBridge
{
/** Cell array: region ids on the front and on the back side of a polygon. */
constexpr const char* BoundaryLabelsName = "BoundaryLabels";
/** Cell array of tetrahedra, point array of seeds. */
constexpr const char* RegionIdName = "RegionId";
/** Cell array of a surface: the contact that a polygon belongs to, or -1. */
constexpr const char* ContactIdName = "ContactId";
/** Point array of the sizing input: a length, one for each axis, or a tensor. */
constexpr const char* SizingName = "Sizing";
/** Cell array of refined surfaces: structural edges are between different ones. */
constexpr const char* StructuralFacetIdName = "StructuralFacetId";
/** Point array: not 0 for points that may be moved. */
constexpr const char* FreePointName = "FreePoint";
/** Point array of structural edges: ids of the surface's points. */
constexpr const char* SurfacePointIdName = "SurfacePointId";
/** Field array: names of the regions, see Texts.h. */
constexpr const char* RegionNamesName = "RegionNames";
/** Field array: names of the contacts, see Texts.h. */
constexpr const char* ContactNamesName = "ContactNames";
} // namespace vtkCoreBridge

#endif
