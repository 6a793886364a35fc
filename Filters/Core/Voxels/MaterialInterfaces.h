// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MaterialInterfaces.h
 * @brief From the cells of a labelled grid to the triangulated interfaces of its regions.
 *
 * Method (thesis 3.5.1 to 3.5.3):
 *  1. a square for each face of a cell whose other side has another region, on the corners of the
 *     cells: the staircase, exactly;
 *  2. smoothing, if asked for (InterfaceSmoothing.h);
 *  3. each square becomes two triangles, by the diagonal that gives both of them the orientation of
 *     the square; if both diagonals do, by the shorter one;
 *  4. fewer triangles, if asked for (SurfaceReduction.h): borders of the grid and structural edges
 *     stay. Without smoothing and with a deviation of 0, coplanar squares are merged.
 *
 * Guarantees: the surface has the invariants of TriangleMesh.h and is watertight: each edge belongs
 * to an even number of triangles of each region, with the opposite direction for one half of them.
 * It is no manifold where three or more regions meet, nor where a region touches itself at an edge
 * or a corner only: such edges are in four triangles, and stay in their places. All normals point
 * to the region of smaller id, that is, outside at the outer boundary. Deterministic.
 * Failure: InvalidInput for coordinates that do not ascend, labels below OutsideRegion (cells), a
 * wrong number of labels, and grids without a region; LimitReached for more than 2^31 - 1 corners.
 * Cost: one pass over the cells, 8 bytes per corner in a slice; smoothing and reduction take about
 * 60 microseconds and 600 bytes per face. 256^3 cells with 0.6 million faces: 37 s and 420 MB for
 * 22,000 smooth triangles, 18 s for the staircase with its coplanar faces merged.
 * References: S. F. Gibson, "Constrained elastic surface nets", 1998, doi:10.1007/BFb0056277
 * (points that stay near their corner; here corners of cells, whose squares are the net of all
 * regions).
 */
#ifndef cdmMaterialInterfaces_h
#define cdmMaterialInterfaces_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TriangleMesh.h"

#include <array>
#include <vector>

namespace cdm
{
struct LabelledGrid
{
  /**
   * Coordinates of the corners along each axis, ascending: one more than there are cells. Model
   * units.
   */
  std::array<std::vector<double>, 3> Coordinates;
  /** Region of each cell, x fastest, then y; OutsideRegion is not meshed. */
  std::vector<Id> Regions;
};

struct MaterialInterfacesOptions
{
  /**
   * Shorter waves of the surface are stairs and vanish. In cells; 0: the exact faces of the cells.
   */
  double SmoothingLength = 10.0;
  bool Reduce = true;
  /** Largest deviation of the reduction, in units of the shortest edge of a cell. >= 0. */
  double MaximumDeviation = 0.25;
  /** The reduction keeps edges that bend by more. Degrees, 0 to 180. */
  double FeatureAngle = 60.0;
};

struct MaterialInterfacesReport
{
  /** Faces of cells that are interfaces. */
  Id Faces = 0;
  /** Points whose smoothing was limited by intersections. */
  Id HeldPoints = 0;
  Id RemovedPoints = 0;
  /** Bound of the distance between the surfaces before and after the reduction. Model units. */
  double LargestDeviation = 0.0;
};

Status ExtractMaterialInterfaces(const LabelledGrid& grid, const MaterialInterfacesOptions& options,
  const ExecutionContext& context, TriangleMesh& surface, MaterialInterfacesReport& report);
} // namespace cdm

#endif
