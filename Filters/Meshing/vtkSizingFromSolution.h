// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSizingFromSolution
 * @brief   Turns a solution into the sizing of the next mesh: short edges where it changes quickly.
 *
 * Method (Fleischmann 1999, section 3.3):
 *  1. gradient of the point array, by vtkGradientFilter;
 *  2. h = MaximumIncrease / (Regularization + |d grad n|), eq. 3.21: an edge of this length in
 *     direction d sees no larger increase. Isotropic: d is the direction of the gradient;
 *     anisotropic: one h for each axis, eq. 3.22;
 *  3. limits MinimumSize and MaximumSize;
 *  4. gradation: sizes are lowered until they differ by no more than Gradation times the distance
 *     between any two points of a cell (Dijkstra's algorithm), each axis by itself.
 *
 * Inputs: port 0: any vtkDataSet with cells: the background mesh. The array to process is a point
 * array with one component; default: the active scalars. For quantities over many decades, as
 * carrier concentrations, take the logarithm first.
 *
 * Outputs: port 0: the input with the point array Sizing (double, 1 component, or 3 if
 * Anisotropic): target edge lengths in model units, for the sizing inputs of vtkMeshPointGenerator,
 * vtkDelaunaySurfaceRefiner and vtkConformingDelaunayMesher.
 *
 * Guarantees: sizes are positive and finite; limits and gradation hold exactly as stated, to
 * rounding. Deterministic.
 *
 * Failure: an error, and an empty output, for an input without cells, an array that is missing, has
 * several components, or values that are not finite, and limits that contradict each other.
 *
 * Cost: O(n log n) for n points.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: eq. 3.21. Filters/Core/Sizing/SizingField.h has the gradation.
 */
#ifndef vtkSizingFromSolution_h
#define vtkSizingFromSolution_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkDataSetAlgorithm.h>

#include <vector>

class vtkDataArray;
class vtkDataSet;
namespace cdm
{
struct Status;
}

class CDMMESHING_EXPORT vtkSizingFromSolution : public vtkDataSetAlgorithm
{
public:
  static vtkSizingFromSolution* New();
  vtkTypeMacro(vtkSizingFromSolution, vtkDataSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Largest increase of the array along an edge, in its units. Default 0: a tenth of its range;
   * range >= 0.
   */
  vtkSetInRangeMacro(MaximumIncrease, double, 0.0, VTK_DOUBLE_MAX, "units of the solution");
  vtkGetMacro(MaximumIncrease, double);
  ///@}

  ///@{
  /**
   * Added to the gradient; where there is none, edges are MaximumIncrease / Regularization long. In
   * units of the array per model unit; default 0: so that this is the bounding box diagonal; range
   * >= 0.
   */
  vtkSetInRangeMacro(
    Regularization, double, 0.0, VTK_DOUBLE_MAX, "units of the solution per model unit");
  vtkGetMacro(Regularization, double);
  ///@}

  ///@{
  /** Whether to give one length for each axis instead of one for all. Default off. */
  vtkSetMacro(Anisotropic, bool);
  vtkGetMacro(Anisotropic, bool);
  vtkBooleanMacro(Anisotropic, bool);
  ///@}

  ///@{
  /** Smaller sizes are raised to this. Model units; default 0: no limit; range >= 0. */
  vtkSetInRangeMacro(MinimumSize, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(MinimumSize, double);
  ///@}

  ///@{
  /** Larger sizes are lowered to this. Model units; default 0: no limit; range >= 0. */
  vtkSetInRangeMacro(MaximumSize, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(MaximumSize, double);
  ///@}

  ///@{
  /**
   * By how much sizes may grow per unit of length. Default 0.3; range >= 0; 0: no bound. Elements
   * of good shape need about 0.5 or less.
   */
  vtkSetInRangeMacro(
    Gradation, double, 0.0, VTK_DOUBLE_MAX, "increase of the size per unit of length");
  vtkGetMacro(Gradation, double);
  ///@}

protected:
  vtkSizingFromSolution();
  ~vtkSizingFromSolution() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double MaximumIncrease = 0.0;
  double Regularization = 0.0;
  bool Anisotropic = false;
  double MinimumSize = 0.0;
  double MaximumSize = 0.0;
  double Gradation = 0.3;

private:
  /** Components of the sizes: of isotropic ones one, otherwise one for each axis. */
  int GetNumberOfSizes() const { return this->Anisotropic ? 3 : 1; }
  /** The sizes at each point, before they are graded; sizes: one list for each component. */
  cdm::Status ComputeSizes(vtkDataSet* data, vtkDataArray* solution, std::vector<double>* sizes);
  cdm::Status BoundGradation(vtkDataSet* data, std::vector<double>* sizes);

  vtkSizingFromSolution(const vtkSizingFromSolution&) = delete;
  void operator=(const vtkSizingFromSolution&) = delete;
};

#endif
