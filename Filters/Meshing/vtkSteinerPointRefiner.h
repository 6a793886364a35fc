// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSteinerPointRefiner
 * @brief   Stage 5: new points until tetrahedra are as small and as well shaped as wanted, without
 * slivers, and Delaunay.
 *
 * Method (Fleischmann 1999, sections 5.6 and 6.5), in rounds:
 *  1. the boundary of the mesh is refined until its smallest spheres are empty and it is as fine as
 *     asked for, and tetrahedralized anew with the points inside;
 *  2. tetrahedra that are too large or badly shaped get a point at their circumcenter or, for
 *     shape, on the way there; where it encroaches on the boundary, the boundary is split instead;
 *  3. points of slivers are moved, inside of their region, each move with a local update of the
 *     Delaunay mesh, and only if the smallest dihedral angle around it grows; where that does not
 *     help points are taken out or added, then points of the boundary moved in their facet or along
 *     their edge, at last the boundary is split;
 *  4. edges of the boundary with a negative coupling of the box method are split.
 *
 * Inputs: port 0: vtkUnstructuredGrid of VTK_TETRA only, as it comes from
 * vtkAdvancingFrontTetrahedralizer or any other source; cell array RegionId (whole numbers from 0
 * on) where there are several regions. Point array FreePoint (optional, one component): points
 * inside with a value other than 0 may be moved and taken out, points on the boundary moved in
 * their flat facet or along their straight edge. Point array RemovePoint (optional, one component):
 * points inside with a value other than 0 are taken out first. Port 1, optional: vtkDataSet with
 * the point array Sizing, see vtkDelaunaySurfaceRefiner; edges longer than the sizing in their
 * direction are too long. Port 2, optional: vtkPolyData, the boundary that belongs to the mesh
 * (output 1 of vtkAdvancingFrontTetrahedralizer), which hands its cell data on and holds sheets
 * inside of regions; by the cell array StructuralFacetId of vtkDelaunaySurfaceRefiner it keeps the
 * structural edges of the input between triangles too small to tell. Port 3, optional: vtkPointSet,
 * points to be put in.
 *
 * Outputs: port 0: the tetrahedra, with the cell array RegionId (int). Other cell data are dropped.
 * Points that stay where they are come first, in their order, with their data; at new and moved
 * ones point data are interpolated in the input mesh (arrays of ids excepted: they are dropped).
 * Point array FreePoint (unsigned char): 1 for points that were made here or were free before. Only
 * if there are tetrahedra that miss what was asked for: cell array RefinementFault (unsigned char),
 * 1 too large, 2 radius-edge ratio, 3 dihedral angle, 4 the latter two at a sharp angle of the
 * input or across a thin layer, 0 for all others. Port 1: the refined boundary as triangles, with
 * BoundaryLabels (int, 2 components) and the cell data of port 2.
 *
 * Guarantees: the mesh is Delaunay and keeps the shape of the boundary; each boundary triangle
 * fulfils the criterion, and no coupling of the box method is negative, with either criterion, but
 * for those that a warning counts. Points that are not free keep their coordinates. It ends for
 * every bound. Deterministic.
 *
 * Failure: an error that names the cells, and empty outputs, for an empty input, cells of another
 * type, tetrahedra that are inverted or flat, a boundary that does not belong to the mesh. An
 * aborted run has empty outputs. A warning counts tetrahedra that miss what was asked for.
 *
 * Cost: about 25 microseconds for a tetrahedron of the result.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999; J. R. Shewchuk, "Tetrahedral mesh generation by Delaunay refinement", 1998; J. Tournois et
 * al., "Perturbing slivers in 3D Delaunay meshes", 2009.
 * Filters/Core/Improvement/SteinerPointRefiner.h is the engine.
 */
#ifndef vtkSteinerPointRefiner_h
#define vtkSteinerPointRefiner_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include "vtkDelaunaySurfaceRefiner.h"
#include <vtkUnstructuredGridAlgorithm.h>

class CDMMESHING_EXPORT vtkSteinerPointRefiner : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkSteinerPointRefiner* New();
  vtkTypeMacro(vtkSteinerPointRefiner, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** See vtkDelaunaySurfaceRefiner::Criteria. */
  enum Criteria
  {
    SmallestSphere = vtkDelaunaySurfaceRefiner::SmallestSphere,
    SmallestSphereAndEdges = vtkDelaunaySurfaceRefiner::SmallestSphereAndEdges
  };

  ///@{
  /** What every boundary triangle has to fulfil, one of Criteria. Default SmallestSphere. */
  vtkSetInRangeMacro(Criterion, int, SmallestSphere, SmallestSphereAndEdges, "one of Criteria");
  vtkGetMacro(Criterion, int);
  void SetCriterionToSmallestSphere() { this->SetCriterion(SmallestSphere); }
  void SetCriterionToSmallestSphereAndEdges() { this->SetCriterion(SmallestSphereAndEdges); }
  ///@}

  ///@{
  /**
   * Largest ratio of the circumradius to the shortest edge. Default 1.4; 0: off; range >= 0 (a
   * regular tetrahedron has 0.612; below 1.2 many points are spent in vain).
   */
  vtkSetInRangeMacro(
    RadiusEdgeRatio, double, 0.0, VTK_DOUBLE_MAX, "ratio of circumradius to shortest edge");
  vtkGetMacro(RadiusEdgeRatio, double);
  ///@}

  ///@{
  /**
   * Tetrahedra with a smaller dihedral angle are slivers, to be removed. Degrees; default 15; 0:
   * off; range 0 to 40 (up to 20 are reached nearly everywhere).
   */
  vtkSetInRangeMacro(DihedralAngleTarget, double, 0.0, 40.0, "degrees");
  vtkGetMacro(DihedralAngleTarget, double);
  ///@}

  ///@{
  /**
   * Layers whose facets are at least so many times as wide as the layer is thick are thin: tetrahedra
   * across them may be flat, as well shaped ones would have to be as small as the layer is thick. All
   * other layers are filled with well shaped ones. Facets that bend by less than a degree are one.
   * Ratio; default 0: 20 where another region is beside the layer, and 100 for plates, with the
   * outside on both sides; otherwise at least 1.
   */
  vtkSetInRangeMacro(LayerAspectRatio, double, 0.0, VTK_DOUBLE_MAX, "ratio of width to thickness");
  vtkGetMacro(LayerAspectRatio, double);
  ///@}

  ///@{
  /**
   * At least so many tetrahedra lie one after another from side to side of each layer, and
   * of each other part whose sides face each other, but for thin layers (LayerAspectRatio) and layers
   * that end in a sharp edge. Default 1: no more than their shapes need; range 1 to 100.
   */
  vtkSetInRangeMacro(TetrahedraAcrossLayers, int, 1, 100, "tetrahedra");
  vtkGetMacro(TetrahedraAcrossLayers, int);
  ///@}

  ///@{
  /** Largest volume of a tetrahedron. Cubic model units; default 0: off; range >= 0. */
  vtkSetInRangeMacro(MaximumVolume, double, 0.0, VTK_DOUBLE_MAX, "cubic model units");
  vtkGetMacro(MaximumVolume, double);
  ///@}

  ///@{
  /** Longest edge, inside and on the boundary. Model units; default 0: off; range >= 0. */
  vtkSetInRangeMacro(MaximumEdgeLength, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(MaximumEdgeLength, double);
  ///@}

  ///@{
  /**
   * Free points closer to another one are taken out before the refinement, with a sizing also those
   * closer than 0.3 of it. Model units; default 0: off; range >= 0.
   */
  vtkSetInRangeMacro(MinimumEdgeLength, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(MinimumEdgeLength, double);
  ///@}

  ///@{
  /**
   * Whether all points inside are free, to be moved and taken out where that makes better
   * tetrahedra; otherwise those only that the point array FreePoint says. Default off.
   */
  vtkSetMacro(FreeInteriorPoints, bool);
  vtkGetMacro(FreeInteriorPoints, bool);
  vtkBooleanMacro(FreeInteriorPoints, bool);
  ///@}

  ///@{
  /** See vtkDelaunaySurfaceRefiner. Degrees; default 0; range 0 to 180. */
  vtkSetInRangeMacro(AccuracyAngle, double, 0.0, 180.0, "degrees");
  vtkGetMacro(AccuracyAngle, double);
  ///@}

  ///@{
  /**
   * See vtkDelaunaySurfaceRefiner. Ratio of the bounding box diagonal; default 5e-7; range 0 to 1.
   */
  vtkSetInRangeMacro(FlatnessRatio, double, 0.0, 1.0, "ratio of the bounding box diagonal");
  vtkGetMacro(FlatnessRatio, double);
  ///@}

  ///@{
  /**
   * The refinement stops when it has made about so many points. Default 0: no limit where sizes,
   * or more than one tetrahedron across layers, are asked for, otherwise 200 for each point of the mesh and 50000; range >= 0.
   */
  vtkSetInRangeMacro(MaximumNewPoints, int, 0, VTK_INT_MAX, "points");
  vtkGetMacro(MaximumNewPoints, int);
  ///@}

  ///@{
  /**
   * The refinement stops after so much time: the mesh is valid, and RefinementFault tells what it misses.
   * What is begun is brought to its end. Where the time is over, the result depends on the machine.
   * Seconds; default 0: no limit; range >= 0.
   */
  vtkSetInRangeMacro(MaximumTime, double, 0.0, VTK_DOUBLE_MAX, "s");
  vtkGetMacro(MaximumTime, double);
  ///@}

  ///@{
  /** Counts of the last run. */
  vtkGetMacro(NumberOfBoundaryPoints, vtkIdType);
  vtkGetMacro(NumberOfInteriorPoints, vtkIdType);
  vtkGetMacro(NumberOfMovedPoints, vtkIdType);
  vtkGetMacro(NumberOfRemovedPoints, vtkIdType);
  vtkGetMacro(NumberOfRounds, vtkIdType);
  vtkGetMacro(NumberOfTooLargeTetrahedra, vtkIdType);
  vtkGetMacro(NumberOfBadlyShapedTetrahedra, vtkIdType);
  vtkGetMacro(NumberOfSlivers, vtkIdType);
  vtkGetMacro(NumberOfInevitableFaults, vtkIdType);
  /** Edges of the boundary with a negative coupling. */
  vtkGetMacro(NumberOfNegativeCouplings, vtkIdType);
  ///@}

protected:
  vtkSteinerPointRefiner();
  ~vtkSteinerPointRefiner() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Criterion = SmallestSphere;
  double RadiusEdgeRatio = 1.4;
  double DihedralAngleTarget = 15.0;
  double LayerAspectRatio = 0.0;
  int TetrahedraAcrossLayers = 1;
  double MaximumVolume = 0.0;
  double MaximumEdgeLength = 0.0;
  double MinimumEdgeLength = 0.0;
  bool FreeInteriorPoints = false;
  double AccuracyAngle = 0.0;
  double FlatnessRatio = 5e-7;
  int MaximumNewPoints = 0;
  double MaximumTime = 0.0;

  vtkIdType NumberOfBoundaryPoints = 0;
  vtkIdType NumberOfInteriorPoints = 0;
  vtkIdType NumberOfMovedPoints = 0;
  vtkIdType NumberOfRemovedPoints = 0;
  vtkIdType NumberOfRounds = 0;
  vtkIdType NumberOfTooLargeTetrahedra = 0;
  vtkIdType NumberOfBadlyShapedTetrahedra = 0;
  vtkIdType NumberOfSlivers = 0;
  vtkIdType NumberOfInevitableFaults = 0;
  vtkIdType NumberOfNegativeCouplings = 0;

private:
  vtkSteinerPointRefiner(const vtkSteinerPointRefiner&) = delete;
  void operator=(const vtkSteinerPointRefiner&) = delete;
};

#endif
