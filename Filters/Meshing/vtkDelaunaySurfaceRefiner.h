// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDelaunaySurfaceRefiner
 * @brief   Stage 2: flips edges and adds points until a surface is part of its Delaunay mesh.
 *
 * Method (Fleischmann 1999, section 6.3):
 *  1. find the structural edges (Def. 6.2), flip the others to saturation (Def. 6.1);
 *  2. test each triangle by the chosen criterion, exactly;
 *  3. for a triangle that fails: flip, split an encroached structural edge (type P or R), mirror
 *     the encroaching point (thin layers, sharp angles), or insert the projected circumcentre (Fig.
 *     6.10);
 *  4. test again the triangles that the new point encroaches on.
 *
 * Inputs: port 0: vtkPolyData of triangles (run vtkBoundaryTriangulator first), optionally with the
 * two-component cell array BoundaryLabels and the cell array StructuralFacetId of an output of this
 * filter, which keeps its structural edges. Port 1, optional: vtkPointSet, mesh points that the
 * tetrahedra are to use inside. Port 2, optional: vtkDataSet with the point array Sizing: target
 * edge length at a position, in model units, positive; between its points it is interpolated,
 * outside of it the nearest value holds. Of several lengths (3 components: along the axes; 6 or 9:
 * a tensor) the largest counts.
 *
 * Outputs: port 0: the Delaunay surface: input points with their ids, new points after them.
 * Point data are interpolated at new points (id arrays excepted: they are dropped), cell data are
 * those of the input triangle. An array FreePoint is 1 at new points: vtkSteinerPointRefiner may
 * move them. Cell array StructuralFacetId (int): the same for triangles between which there is no
 * structural edge, from 0. Only if triangles are left that do not fulfil the criterion: cell
 * array Unresolved (unsigned char), 1 for them and 0 for the others.
 * Port 1: its structural edges, with the arrays of vtkStructuralEdgeExtractor; ChainId is that of
 * the input surface. Port 2: the mesh points kept, as vertices, with their point data. Mesh points
 * nearer to the surface than MeshPointClearanceRatio are dropped, and counted in a warning.
 *
 * Guarantees: decisions are exact; input points keep their coordinates. Deterministic.
 *
 * Failure: an error that names the cells or points, and empty outputs, for an empty input, cells
 * that are not triangles, coordinates that are not finite, or a surface that intersects itself.
 * Triangles that a limit leaves unresolved give a warning and the array Unresolved. They can be meshed
 * whatever the limits are: points that this needs beyond MaximumNewPoints, MinimumEdgeRatio and
 * MaximumTime are counted in a warning.
 *
 * Cost: about proportional to the points made, each with a search in an octree.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: the method. Filters/Core/Surface/DelaunaySurfaceRefiner.h is the engine.
 */
#ifndef vtkDelaunaySurfaceRefiner_h
#define vtkDelaunaySurfaceRefiner_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkPolyDataAlgorithm.h>

class CDMMESHING_EXPORT vtkDelaunaySurfaceRefiner : public vtkPolyDataAlgorithm
{
public:
  static vtkDelaunaySurfaceRefiner* New();
  vtkTypeMacro(vtkDelaunaySurfaceRefiner, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Criteria
  {
    /** Criterion 5.2: the surface is part of the Delaunay mesh. */
    Delaunay = 0,
    /** Criterion 3.1: the smallest sphere of each triangle is empty. */
    SmallestSphere,
    /** Criterion 3.2: those of each triangle and of its edges are: closed control volumes. */
    SmallestSphereAndEdges
  };

  ///@{
  /** What every triangle has to fulfil, one of Criteria. Default Delaunay. */
  vtkSetInRangeMacro(Criterion, int, Delaunay, SmallestSphereAndEdges, "one of Criteria");
  vtkGetMacro(Criterion, int);
  void SetCriterionToDelaunay() { this->SetCriterion(Delaunay); }
  void SetCriterionToSmallestSphere() { this->SetCriterion(SmallestSphere); }
  void SetCriterionToSmallestSphereAndEdges() { this->SetCriterion(SmallestSphereAndEdges); }
  ///@}

  ///@{
  /**
   * Edges that bend by no more than this are smooth and may be flipped. Degrees; default 0: only
   * numerically flat edges are smooth; range 0 to 180.
   */
  vtkSetInRangeMacro(AccuracyAngle, double, 0.0, 180.0, "degrees");
  vtkGetMacro(AccuracyAngle, double);
  ///@}

  ///@{
  /**
   * How far points of a facet may be from its plane, as a ratio of the bounding box diagonal. It
   * allows for coordinates that were rounded to six or seven digits in a file. Edges in such facets
   * are smooth, and the surface moves by no more than twice that. At 1e-9 and below, edges are
   * judged one by one: for closed control volumes without Steiner points, as couplings in rounded
   * facets may be negative by as little. Default 5e-7; range 0 to 1.
   */
  vtkSetInRangeMacro(FlatnessRatio, double, 0.0, 1.0, "ratio of the bounding box diagonal");
  vtkGetMacro(FlatnessRatio, double);
  ///@}

  ///@{
  /**
   * Triangles with a smaller angle are refined where possible. Degrees; default 0: off; range 0 to
   * 30.
   */
  vtkSetInRangeMacro(MinimumAngle, double, 0.0, 30.0, "degrees");
  vtkGetMacro(MinimumAngle, double);
  ///@}

  ///@{
  /** Triangles with a larger area are refined. Square model units; default 0: off; range >= 0. */
  vtkSetInRangeMacro(MaximumArea, double, 0.0, VTK_DOUBLE_MAX, "square model units");
  vtkGetMacro(MaximumArea, double);
  ///@}

  ///@{
  /** Longer edges are split. Model units; default 0: off; range >= 0. */
  vtkSetInRangeMacro(MaximumEdgeLength, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(MaximumEdgeLength, double);
  ///@}

  ///@{
  /**
   * Mesh points closer to the surface are dropped. Ratio of the bounding box diagonal; default
   * 1e-3; range 0 to 1.
   */
  vtkSetInRangeMacro(
    MeshPointClearanceRatio, double, 0.0, 1.0, "ratio of the bounding box diagonal");
  vtkGetMacro(MeshPointClearanceRatio, double);
  ///@}

  ///@{
  /**
   * No edge is made shorter, unless there is no mesh without it: a guard against endless refinement. Far
   * from the origin, where coordinates are rounded farther, 8 times their rounding is the limit. Points of
   * different sheets may be closer to each other. Ratio of the bounding box diagonal; default 1e-12; range
   * 0 to 1.
   */
  vtkSetInRangeMacro(MinimumEdgeRatio, double, 0.0, 1.0, "ratio of the bounding box diagonal");
  vtkGetMacro(MinimumEdgeRatio, double);
  ///@}

  ///@{
  /**
   * The refinement stops when it has made so many points, unless there is no mesh without more.
   * Default 0: 50 for each triangle, at least 200000, or 1000000 where sizes or angles are asked for,
   * and one for each mesh point; range >= 0. Surfaces that need more have sheets a hair apart that run
   * into each other.
   */
  vtkSetInRangeMacro(MaximumNewPoints, int, 0, VTK_INT_MAX, "points");
  vtkGetMacro(MaximumNewPoints, int);
  ///@}

  ///@{
  /**
   * The refinement stops after so much time, unless there is no mesh without more. Where it does, the
   * result depends on the machine. Seconds; default 0: no limit; range >= 0.
   */
  vtkSetInRangeMacro(MaximumTime, double, 0.0, VTK_DOUBLE_MAX, "s");
  vtkGetMacro(MaximumTime, double);
  ///@}

  ///@{
  /** Counts of the last run. */
  vtkGetMacro(NumberOfEdgePoints, vtkIdType);
  vtkGetMacro(NumberOfFacetPoints, vtkIdType);
  vtkGetMacro(NumberOfFlips, vtkIdType);
  vtkGetMacro(NumberOfDroppedMeshPoints, vtkIdType);
  vtkGetMacro(NumberOfUnresolvedTriangles, vtkIdType);
  ///@}

protected:
  vtkDelaunaySurfaceRefiner();
  ~vtkDelaunaySurfaceRefiner() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Criterion = Delaunay;
  double AccuracyAngle = 0.0;
  double FlatnessRatio = 5e-7;
  double MinimumAngle = 0.0;
  double MaximumArea = 0.0;
  double MaximumEdgeLength = 0.0;
  double MeshPointClearanceRatio = 1e-3;
  double MinimumEdgeRatio = 1e-12;
  int MaximumNewPoints = 0;
  double MaximumTime = 0.0;

  vtkIdType NumberOfEdgePoints = 0;
  vtkIdType NumberOfFacetPoints = 0;
  vtkIdType NumberOfFlips = 0;
  vtkIdType NumberOfDroppedMeshPoints = 0;
  vtkIdType NumberOfUnresolvedTriangles = 0;

private:
  vtkDelaunaySurfaceRefiner(const vtkDelaunaySurfaceRefiner&) = delete;
  void operator=(const vtkDelaunaySurfaceRefiner&) = delete;
};

#endif
