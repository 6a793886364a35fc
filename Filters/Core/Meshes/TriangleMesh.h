// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleMesh.h
 * @brief A triangulated surface: non-manifold, multi-material, open or closed.
 *
 * 12 bytes per triangle, 8 more with labels, 4 more with source cells; 24 bytes per point.
 */
#ifndef cdmTriangleMesh_h
#define cdmTriangleMesh_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <vector>

namespace cdm
{
/**
 * Invariants of a surface that went through the boundary triangulator: no two points coincide, the
 * three points of a triangle are not collinear, no two triangles have the same three points, and
 * two triangles meet in a common edge, a common vertex or not at all.
 */
struct TriangleMesh
{
  std::vector<Vec3> Points;
  std::vector<TriangleIds> Triangles;
  /** Empty (regions are to be found), or one pair for each triangle. */
  std::vector<RegionPair> Labels;
  /** Empty, or for each triangle the cell of the stage's input that it comes from, or NoId. */
  std::vector<Id> SourceCells;
};
} // namespace cdm

#endif
