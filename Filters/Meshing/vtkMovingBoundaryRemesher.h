// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMovingBoundaryRemesher
 * @brief   Moves the boundary and interfaces of a mesh, and makes it Delaunay and conforming again.
 *
 * Method (Fleischmann 1999, section 3.4.1), for each of NumberOfSteps steps:
 *  1. points on the boundary and the interfaces move by their displacement; points near them that
 *     have none follow: those inside, and those on walls and straight edges along these, for a
 *     distance of FollowRatio times the largest displacement;
 *  2. the moved boundary is checked, exactly, for triangles that cross, overlap or touch. Where
 *     neighbors fold over each other half a step is taken first;
 *  3. points inside are kept if they are still strictly inside of a region and nothing has come
 *     much closer to them (PointClearance); the surface is refined until it is Delaunay with them,
 *     and filled with the tetrahedra of all points;
 *  4. where the topology changes, since parts of the boundary meet or a layer vanishes, the
 *     boundary is cut along its intersections, and each cell of space gets the region that the
 *     moved boundary winds around it most often, of several the one with the lowest id.
 *
 * Inputs: port 0: vtkUnstructuredGrid of VTK_TETRA only, from any source; cell array RegionId
 * (whole numbers from 0 on) where there are several regions. The point array to process (default:
 * the active vectors) has three components: how far each point is to move, in model units. Points
 * inside of regions are not moved by it; on a wall along which an interface moves leave it zero,
 * and the points of the wall make way.
 *
 * Outputs: port 0: the tetrahedra, with the cell array RegionId (int) and the arrays of the input.
 * Point data are those of the input, interpolated at new points; cell data those of the input
 * tetrahedron of the same region with the most common points, zero where there is none. Port 1: the
 * boundary and the interfaces as triangles, with the cell array BoundaryLabels (int, 2 components:
 * the regions on the front and on the back side, -1 outside) and the point data.
 *
 * Guarantees: tetrahedra are positively oriented, none is flat, their circumspheres are empty, the
 * boundary is part of them. Points with a displacement are moved by it, rounded once, however many
 * steps there are; others that do not follow keep their coordinates. Deterministic.
 *
 * Failure: an error that names cells or points, and empty outputs, for an empty input, cells of
 * another type, tetrahedra that are inverted, flat or overlap, displacements that are missing or
 * not finite, and a moved boundary that cannot be meshed. A warning if triangles do not fulfil
 * the criterion. An aborted run has empty outputs.
 *
 * Cost: that of refining the surface and meshing all regions, in each step.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: moving boundaries. Filters/Core/MovingBoundary/MovingBoundaryRemesher.h is the engine.
 */
#ifndef vtkMovingBoundaryRemesher_h
#define vtkMovingBoundaryRemesher_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include "vtkDelaunaySurfaceRefiner.h"
#include <vtkUnstructuredGridAlgorithm.h>

class CDMMESHING_EXPORT vtkMovingBoundaryRemesher : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkMovingBoundaryRemesher* New();
  vtkTypeMacro(vtkMovingBoundaryRemesher, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** See vtkDelaunaySurfaceRefiner::Criteria. */
  enum Criteria
  {
    Delaunay = vtkDelaunaySurfaceRefiner::Delaunay,
    SmallestSphere = vtkDelaunaySurfaceRefiner::SmallestSphere,
    SmallestSphereAndEdges = vtkDelaunaySurfaceRefiner::SmallestSphereAndEdges
  };

  ///@{
  /** The displacement is applied in so many equal steps. Default 1; range 1 to 1000. */
  vtkSetInRangeMacro(NumberOfSteps, int, 1, 1000, "steps");
  vtkGetMacro(NumberOfSteps, int);
  ///@}

  ///@{
  /**
   * How far from points that move others follow them, in units of the largest displacement. Default
   * 4: edges change by a quarter of their length; 0: none follows; range 0 and above.
   */
  vtkSetInRangeMacro(FollowRatio, double, 0.0, VTK_DOUBLE_MAX, "largest displacements");
  vtkGetMacro(FollowRatio, double);
  ///@}

  ///@{
  /**
   * A point inside is removed if the boundary or another point has come closer to it than this part
   * of what was nearest to it before the step. Default 0.5; range 0 (only where it lies on the
   * boundary or beyond) to 0.9.
   */
  vtkSetInRangeMacro(PointClearance, double, 0.0, 0.9, "ratio of the distance before the step");
  vtkGetMacro(PointClearance, double);
  ///@}

  ///@{
  /** What every boundary triangle has to fulfil, one of Criteria. Default Delaunay. */
  vtkSetInRangeMacro(Criterion, int, Delaunay, SmallestSphereAndEdges, "one of Criteria");
  vtkGetMacro(Criterion, int);
  void SetCriterionToDelaunay() { this->SetCriterion(Delaunay); }
  void SetCriterionToSmallestSphere() { this->SetCriterion(SmallestSphere); }
  void SetCriterionToSmallestSphereAndEdges() { this->SetCriterion(SmallestSphereAndEdges); }
  ///@}

  ///@{
  /**
   * Edges that bend by no more than this are smooth and may be flipped, which changes the shape of
   * the surface by that much. Degrees; default 0: only numerically flat edges are smooth; range 0
   * to
   * 180.
   */
  vtkSetInRangeMacro(AccuracyAngle, double, 0.0, 180.0, "degrees");
  vtkGetMacro(AccuracyAngle, double);
  ///@}

  ///@{
  /**
   * Boundary triangles with a smaller angle are refined where possible. Degrees; default 0: off;
   * range 0 to 30.
   */
  vtkSetInRangeMacro(MinimumAngle, double, 0.0, 30.0, "degrees");
  vtkGetMacro(MinimumAngle, double);
  ///@}

  ///@{
  /**
   * Longer boundary edges, stretched by the motion, are split. Model units; default 0: off; range 0
   * and above.
   */
  vtkSetInRangeMacro(MaximumEdgeLength, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(MaximumEdgeLength, double);
  ///@}

  ///@{
  /**
   * The refinement of a step stops when it has made so many points, unless there is no mesh without
   * more. Default 0: no limit.
   */
  vtkSetInRangeMacro(MaximumNewPoints, int, 0, VTK_INT_MAX, "points");
  vtkGetMacro(MaximumNewPoints, int);
  ///@}

  ///@{
  /**
   * The refinement of a step stops after so much time, unless there is no mesh without more. Where it
   * does, the result depends on the machine. Seconds; default 0: no limit; range >= 0.
   */
  vtkSetInRangeMacro(MaximumTime, double, 0.0, VTK_DOUBLE_MAX, "s");
  vtkGetMacro(MaximumTime, double);
  ///@}

  ///@{
  /**
   * Of the last run: meshes made, half steps included; steps in which the topology changed; points
   * of the input that are gone; points of the output that are new.
   */
  vtkGetMacro(NumberOfStepsTaken, vtkIdType);
  vtkGetMacro(NumberOfTopologyChanges, vtkIdType);
  vtkGetMacro(NumberOfRemovedPoints, vtkIdType);
  vtkGetMacro(NumberOfNewPoints, vtkIdType);
  vtkGetMacro(NumberOfUnresolvedTriangles, vtkIdType);
  ///@}

protected:
  vtkMovingBoundaryRemesher();
  ~vtkMovingBoundaryRemesher() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int NumberOfSteps = 1;
  double FollowRatio = 4.0;
  double PointClearance = 0.5;
  int Criterion = Delaunay;
  double AccuracyAngle = 0.0;
  double MinimumAngle = 0.0;
  double MaximumEdgeLength = 0.0;
  int MaximumNewPoints = 0;
  double MaximumTime = 0.0;

  vtkIdType NumberOfStepsTaken = 0;
  vtkIdType NumberOfTopologyChanges = 0;
  vtkIdType NumberOfRemovedPoints = 0;
  vtkIdType NumberOfNewPoints = 0;
  vtkIdType NumberOfUnresolvedTriangles = 0;

private:
  vtkMovingBoundaryRemesher(const vtkMovingBoundaryRemesher&) = delete;
  void operator=(const vtkMovingBoundaryRemesher&) = delete;
};

#endif
