// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSliverRemover
 * @brief   Stage 4: better tetrahedra from the same points, with every tetrahedron still Delaunay.
 *
 * Method (Fleischmann 1999, sections 3.4.7, 5.7 and 6.4.3):
 *  1. tetrahedra that are numerically flat on a boundary or interface are peeled off: removed at the
 *     outside, handed to the other region at an interface;
 *  2. 2-3, 3-2 and 4-4 flips within exactly cospherical sets, where any tetrahedralization is
 *     Delaunay, as long as the smallest dihedral angle of the tetrahedra involved grows.
 *
 * Inputs: port 0: vtkUnstructuredGrid of VTK_TETRA only, from any source. Cell array RegionId
 * (whole numbers from 0 on) where there are several regions; without it all is region 0.
 *
 * Outputs: port 0: the tetrahedra, with the cell array RegionId (int). Other cell data are kept
 * where a tetrahedron survives (the same four points), and zero for a new one. Points and point data
 * are those of the input, coordinates in double precision.
 *
 * Guarantees: points are neither moved nor removed; no tetrahedron is inverted or flat; a mesh that
 * was Delaunay is so still. Deterministic.
 *
 * Failure: an error that names the cells, and an empty output, for an empty input, cells of another
 * type, tetrahedra that are inverted, flat or overlap. An aborted run has an empty output.
 *
 * Cost: O(n) for n tetrahedra and few flips.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien 1999:
 * local transformations. Filters/Core/SliverRemover.h is the engine.
 */
#ifndef vtkSliverRemover_h
#define vtkSliverRemover_h

#include "cdmMeshingModule.h" // For export macro
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
  vtkSetClampMacro(DihedralAngleTarget, double, 0.0, 70.0);
  vtkGetMacro(DihedralAngleTarget, double);
  ///@}

  ///@{
  /**
   * A tetrahedron on a boundary that is lower than this may be peeled off. Ratio of the bounding
   * box diagonal; default 1e-9; range 0 to 1.
   */
  vtkSetClampMacro(FlatnessRatio, double, 0.0, 1.0);
  vtkGetMacro(FlatnessRatio, double);
  ///@}

  ///@{
  /** Of the last run; angles in degrees. */
  vtkGetMacro(NumberOfPeeledTetrahedra, vtkIdType);
  vtkGetMacro(NumberOfFlips, vtkIdType);
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

  vtkIdType NumberOfPeeledTetrahedra = 0;
  vtkIdType NumberOfFlips = 0;
  double SmallestDihedralAngleBefore = 0.0;
  double SmallestDihedralAngleAfter = 0.0;

private:
  vtkSliverRemover(const vtkSliverRemover&) = delete;
  void operator=(const vtkSliverRemover&) = delete;
};

#endif
