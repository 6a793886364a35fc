// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSliverRemover
 * @brief   Stage 4: better tetrahedra from the same points, with every tetrahedron still Delaunay.
 *
 * Method (Fleischmann 1999, sections 3.4.6, 3.4.7, 5.7 and 6.4.3):
 *  1. tetrahedra that are numerically flat on a boundary or interface are peeled off: removed at
 *     the outside, handed to the other region at an interface;
 *  2. 2-3, 3-2 and 4-4 flips within exactly cospherical sets, where any tetrahedralization is
 *     Delaunay, as long as the smallest dihedral angle of the tetrahedra involved grows;
 *  3. free points of those that are left are moved, each with a local update of the Delaunay mesh,
 *     and only if the smallest dihedral angle around it grows: those inside anywhere, those on the
 *     boundary and on interfaces within their facet or along their structural edge.
 * With QualityBeforeDelaunay, 2. takes all flips that make the smallest dihedral angle larger, also
 * removals of edges with up to eight tetrahedra, and instead of 3. free points are moved within the
 * tetrahedra around them (smoothing), in turn with the flips. The mesh is then no longer Delaunay.
 *
 * Inputs: port 0: vtkUnstructuredGrid of VTK_TETRA only, from any source. Cell array RegionId
 * (whole numbers from 0 on) where there are several regions; without it all is region 0. Point
 * array FreePoint (optional, one component): points inside with a value other than 0 may be moved.
 *
 * Outputs: port 0: the tetrahedra, with the cell array RegionId (int). Other cell data are kept
 * where a tetrahedron survives (the same four points), and zero for a new one. Points and point
 * data are those of the input, coordinates in double precision; at moved points point data but
 * FreePoint are interpolated in the input mesh (arrays of ids excepted: they are dropped if a point
 * moves).
 *
 * Guarantees: no point is added or removed; those that are not free keep their coordinates, corners
 * of the boundary always. No tetrahedron is inverted or flat. Unless QualityBeforeDelaunay is on: a
 * mesh that was Delaunay is so still, and boundary triangles that fulfilled criterion 3.1 or 3.2
 * still do; with 3.1 alone, moved points may make couplings of the box method negative where facets
 * meet. Regions and boundaries keep their shape, but for what is peeled off. Deterministic.
 *
 * Failure: an error that names the cells, and an empty output, for an empty input, cells of another
 * type, tetrahedra that are inverted, flat or overlap, an array FreePoint of the wrong size. An
 * aborted run has an empty output.
 *
 * Cost: O(n) for n tetrahedra and few flips; about a millisecond for a point that is tried to be
 * moved.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: local transformations; J. Tournois et al., "Perturbing slivers in 3D Delaunay meshes",
 * 2009: moved points. Filters/Core/Improvement/SliverRemover.h is the engine.
 */
#ifndef vtkSliverRemover_h
#define vtkSliverRemover_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkUnstructuredGridAlgorithm.h>

class CDMMESHING_EXPORT vtkSliverRemover : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkSliverRemover* New();
  vtkTypeMacro(vtkSliverRemover, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Tetrahedra with a smaller dihedral angle are treated. Degrees; default 15; range 0 to 70 (that
   * of the regular tetrahedron is 70.5).
   */
  vtkSetInRangeMacro(DihedralAngleTarget, double, 0.0, 70.0, "degrees");
  vtkGetMacro(DihedralAngleTarget, double);
  ///@}

  ///@{
  /**
   * A tetrahedron on a boundary that is lower than this may be peeled off. Ratio of the bounding
   * box diagonal; default 1e-9; range 0 to 1.
   */
  vtkSetInRangeMacro(FlatnessRatio, double, 0.0, 1.0, "ratio of the bounding box diagonal");
  vtkGetMacro(FlatnessRatio, double);
  ///@}

  ///@{
  /**
   * Whether all points inside of regions are free, to be moved where that makes better tetrahedra;
   * otherwise those only that the point array FreePoint says. Default off.
   */
  vtkSetMacro(FreeInteriorPoints, bool);
  vtkGetMacro(FreeInteriorPoints, bool);
  vtkBooleanMacro(FreeInteriorPoints, bool);
  ///@}

  ///@{
  /**
   * Whether points of the boundary and of interfaces may be moved, too, within the flat facet that
   * they lie in or along their straight structural edge; corners stay. Not with quality before
   * Delaunay. Default off.
   */
  vtkSetMacro(FreeBoundaryPoints, bool);
  vtkGetMacro(FreeBoundaryPoints, bool);
  vtkBooleanMacro(FreeBoundaryPoints, bool);
  ///@}

  ///@{
  /**
   * Whether flips and smoothing may leave tetrahedra that are not Delaunay: for finite elements.
   * Control volumes and their coupling coefficients need a Delaunay mesh. Default off.
   */
  vtkSetMacro(QualityBeforeDelaunay, bool);
  vtkGetMacro(QualityBeforeDelaunay, bool);
  vtkBooleanMacro(QualityBeforeDelaunay, bool);
  ///@}

  ///@{
  /** Results of the last run. Angles are in degrees; a point counts as often as it is moved. */
  vtkGetMacro(NumberOfPeeledTetrahedra, vtkIdType);
  vtkGetMacro(NumberOfFlips, vtkIdType);
  vtkGetMacro(NumberOfMovedPoints, vtkIdType);
  vtkGetMacro(SmallestDihedralAngleBefore, double);
  vtkGetMacro(SmallestDihedralAngleAfter, double);
  ///@}

protected:
  vtkSliverRemover() = default;
  ~vtkSliverRemover() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double DihedralAngleTarget = 15.0;
  double FlatnessRatio = 1e-9;
  bool FreeInteriorPoints = false;
  bool FreeBoundaryPoints = false;
  bool QualityBeforeDelaunay = false;

  vtkIdType NumberOfPeeledTetrahedra = 0;
  vtkIdType NumberOfFlips = 0;
  vtkIdType NumberOfMovedPoints = 0;
  double SmallestDihedralAngleBefore = 0.0;
  double SmallestDihedralAngleAfter = 0.0;

private:
  vtkSliverRemover(const vtkSliverRemover&) = delete;
  void operator=(const vtkSliverRemover&) = delete;
};

#endif
