// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkAdvancingFrontTetrahedralizer
 * @brief   Stage 3: fills the regions of a Delaunay surface with Delaunay tetrahedra.
 *
 * Method (Fleischmann 1999, section 6.4):
 *  1. find the fourth point of each facet (the smallest lambda, Crit. 6.2) for all points at once:
 *     the exact Delaunay tetrahedralization of the points, where cells of more than four
 *     cospherical points are triangulated by pulling their lowest point;
 *  2. test that the surface is part of it, up to the diagonals of flat cocircular facets;
 *  3. take a side of a triangle of each enclosed region as the seed of the front;
 *  4. attach the fourth point to each triangle of the front; like triangles meet and leave the
 *     front (Lemma 6.1), until it is empty (Lemma 6.2).
 *
 * Inputs: port 0: vtkPolyData, the output of vtkDelaunaySurfaceRefiner; or any vtkPointSet, whose
 * points alone are taken, to be meshed up to their convex hull (CloseOpenBoundary). With the
 * two-component cell array BoundaryLabels the regions are those labels; without it every enclosed
 * segment becomes a region, numbered from 0 on. The outside is never meshed. Port 1, optional:
 * vtkPointSet, mesh points. Port 2, optional: vtkPointSet of seeds; only the regions that hold one
 * are meshed. Its point array RegionId gives the region's id; without it seeds are numbered from 0
 * on.
 *
 * Outputs: port 0: vtkUnstructuredGrid of VTK_TETRA with the cell array RegionId (int). Points are
 * those of the surface in their order, then the mesh points used; without mesh points point data
 * are those of the surface, with mesh points the arrays that both have (name, type, components).
 * Port 1: the completed boundary of the mesh and its regions, on the points of the mesh, with
 * BoundaryLabels (int, 2 components) and the cell data of the surface; triangles made to close an
 * open boundary have zeros. Port 2: the front, its triangles turned to the unmeshed side; empty
 * when the mesh is finished.
 *
 * Guarantees: tetrahedra are positively oriented, none is flat, their circumspheres are empty of
 * all points, exactly. The mesh depends on the numbering of the points only. Deterministic.
 *
 * Failure: an error that names the cells, and empty outputs, for an empty input, triangles that are
 * not Delaunay, labels that contradict each other, and a surface that encloses nothing. A warning
 * counts mesh points in no meshed region, and another one names the cells that bound none: they are
 * not in the boundary of a finished mesh. An aborted run, from the
 * moment the front advances, and one stopped by MaximumNumberOfTetrahedra leave the valid mesh made
 * so far and its front in the outputs. (VTK empties the outputs of an aborted filter; this one
 * takes its mark back. Filters downstream decide for themselves whether they run on it.)
 *
 * Cost: O(n log n) for usual distributions; 49 bytes per tetrahedron of all points at the peak, 36
 * for those of the result. Uses as many threads as vtkSMPTools, or one for each core where that is
 * sequential; the result does not depend on them.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: the modified advancing front. Filters/Core/Volume/AdvancingFrontTetrahedralizer.h is the
 * engine.
 */
#ifndef vtkAdvancingFrontTetrahedralizer_h
#define vtkAdvancingFrontTetrahedralizer_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkUnstructuredGridAlgorithm.h>

class CDMMESHING_EXPORT vtkAdvancingFrontTetrahedralizer : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkAdvancingFrontTetrahedralizer* New();
  vtkTypeMacro(vtkAdvancingFrontTetrahedralizer, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Where the surface is open, close the mesh with triangles on the convex hull of the points;
   * otherwise an open region is an error. Default off.
   */
  vtkSetMacro(CloseOpenBoundary, bool);
  vtkGetMacro(CloseOpenBoundary, bool);
  vtkBooleanMacro(CloseOpenBoundary, bool);
  ///@}

  ///@{
  /**
   * Stop after this many tetrahedra and leave the front in output port 2. Default 0: no limit;
   * range >= 0.
   */
  vtkSetInRangeMacro(MaximumNumberOfTetrahedra, int, 0, VTK_INT_MAX, "tetrahedra");
  vtkGetMacro(MaximumNumberOfTetrahedra, int);
  ///@}

  ///@{
  /** Counts of the last run. */
  vtkGetMacro(NumberOfRegions, vtkIdType);
  vtkGetMacro(NumberOfUnusedMeshPoints, vtkIdType);
  vtkGetMacro(NumberOfUnusedTriangles, vtkIdType);
  vtkGetMacro(NumberOfTurnedDiagonals, vtkIdType);
  ///@}

protected:
  vtkAdvancingFrontTetrahedralizer();
  ~vtkAdvancingFrontTetrahedralizer() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  bool CloseOpenBoundary = false;
  int MaximumNumberOfTetrahedra = 0;

  vtkIdType NumberOfRegions = 0;
  vtkIdType NumberOfUnusedMeshPoints = 0;
  vtkIdType NumberOfUnusedTriangles = 0;
  vtkIdType NumberOfTurnedDiagonals = 0;

private:
  vtkAdvancingFrontTetrahedralizer(const vtkAdvancingFrontTetrahedralizer&) = delete;
  void operator=(const vtkAdvancingFrontTetrahedralizer&) = delete;
};

#endif
