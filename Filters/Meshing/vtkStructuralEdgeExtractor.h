// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkStructuralEdgeExtractor
 * @brief   Stage 1: the edges of a triangulated surface that a mesh has to keep.
 *
 * Method (Fleischmann 1999, Def. 6.2):
 *  1. an edge is structural if it is open (one triangle), shared by more than two triangles, a
 *     border between different BoundaryLabels, or if it bends by more than AccuracyAngle. Two
 *     triangles that differ from a plane by the rounding of coordinates only are flat in any case;
 *  2. structural edges are joined to chains, which end at corners (points where not exactly two
 *     structural edges meet) or are closed.
 *
 * Inputs: port 0: vtkPolyData of triangles (run vtkBoundaryTriangulator first), optionally with the
 * two-component cell array BoundaryLabels.
 *
 * Outputs: port 0: the surface, passed through with all arrays. Port 1: the structural edges as
 * lines. Cell arrays: Kind (int, see EdgeKinds), DihedralAngle (double, degrees from 0 to 180,
 * where 180 is flat; -1 for an open edge), ChainId (int, from 0). Point arrays: those of the
 * surface, and SurfacePointId (vtkIdType), the point of the surface.
 *
 * Guarantees: deterministic; edges are sorted by their point ids on the surface.
 * Failure: an error that names the cells, and empty outputs, for an empty input, cells that are not
 * triangles, and coordinates that are not finite.
 * Cost: O(n log n).
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: structural edges. Filters/Core/Surface/StructuralEdges.h is the engine.
 */
#ifndef vtkStructuralEdgeExtractor_h
#define vtkStructuralEdgeExtractor_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkPolyDataAlgorithm.h>

class CDMMESHING_EXPORT vtkStructuralEdgeExtractor : public vtkPolyDataAlgorithm
{
public:
  static vtkStructuralEdgeExtractor* New();
  vtkTypeMacro(vtkStructuralEdgeExtractor, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Values of the cell array Kind; an edge that is several of these is the first of them. */
  enum EdgeKinds
  {
    Open = 0,
    NonManifold,
    LabelChange,
    Sharp
  };

  ///@{
  /**
   * Edges that bend by no more than this are smooth. Degrees; default 0: only numerically flat
   * edges are smooth; range 0 to 180.
   */
  vtkSetInRangeMacro(AccuracyAngle, double, 0.0, 180.0, "degrees");
  vtkGetMacro(AccuracyAngle, double);
  ///@}

  ///@{
  /** Counts of the last run. */
  vtkGetMacro(NumberOfChains, vtkIdType);
  vtkGetMacro(NumberOfCorners, vtkIdType);
  ///@}

protected:
  vtkStructuralEdgeExtractor();
  ~vtkStructuralEdgeExtractor() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double AccuracyAngle = 0.0;
  vtkIdType NumberOfChains = 0;
  vtkIdType NumberOfCorners = 0;

private:
  vtkStructuralEdgeExtractor(const vtkStructuralEdgeExtractor&) = delete;
  void operator=(const vtkStructuralEdgeExtractor&) = delete;
};

#endif
