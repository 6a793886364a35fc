// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMaterialInterfaceExtractor
 * @brief   Labelled voxels in, the interfaces of their materials out: ready to be meshed.
 *
 * Method (Fleischmann 1999, sections 3.5.1 to 3.5.3):
 *  1. the faces of voxels between different labels, as squares: the staircase, exactly;
 *  2. smoothing, a low pass filter: each corner moves by less than half a voxel, along lines where
 *     three or more materials meet, within the planes of the image's border; where triangles would
 *     intersect the corners go back;
 *  3. data reduction: points are merged into neighbors along edges, as long as the surface stays
 *     within MaximumDeviation. Lines where materials meet, edges sharper than FeatureAngle, the
 *     edges of the image and the corners of all these are kept.
 * Without smoothing and with a MaximumDeviation of 0 the result is the exact staircase with its
 * coplanar faces merged. vtkSurfaceNets3D of VTK 9.3 and later is not used: it smooths without a
 * look at self-intersections, which no mesh could conform to, and leaves some neighborhoods
 * unresolved.
 *
 * Inputs: port 0: vtkImageData or vtkRectilinearGrid, a volume. The array to process (default: the
 * active scalars of the points, otherwise of the cells) has one component with whole numbers: the
 * material from 0 on, -1 for outside. A cell is a voxel; with labels at points there is a voxel
 * around each point, which ends half way to the next one, and as far beyond the last one.
 *
 * Outputs: port 0: vtkPolyData, triangles with points in double precision and the cell array
 * BoundaryLabels (int, 2 components): labels on the front and on the back side, -1 outside. Normals
 * point to the smaller label. This is what vtkConformingDelaunayMesher takes: RegionId is the
 * label.
 *
 * Guarantees: watertight around each material; no two triangles intersect, decided exactly; each
 * region keeps its topology, and touches the others where its voxels do. Where a region touches
 * itself at an edge or a corner of voxels only, the surface is no manifold, as at junctions. With
 * smoothing off and MaximumDeviation 0 volumes are those of the voxels. Layers one voxel thick keep
 * at least half of their thickness in smoothing. Deterministic. An image with a direction matrix is
 * turned at the end, which rounds coordinates. In a parallel run the first process asks for all
 * voxels and makes all interfaces; the others have none.
 *
 * Failure: an error that names the voxels, and an empty output, for labels that are no whole
 * numbers from -1 on, an array that is missing or has several components, an image without a label
 * other than outside, without a volume, or with more than 2^31 - 1 corners. An aborted run has an
 * empty output.
 *
 * Cost: O(n log n) for n faces between labels: 256^3 voxels with 0.6 million faces take 37 s and
 * 420 MB; see Filters/Core/Voxels/MaterialInterfaces.h, the engine.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999; S. F. Gibson, "Constrained elastic surface nets", 1998, doi:10.1007/BFb0056277; G. Taubin,
 * T. Zhang, G. Golub, "Optimal surface smoothing as filter design", 1996, doi:10.1007/BFb0015544.
 */
#ifndef vtkMaterialInterfaceExtractor_h
#define vtkMaterialInterfaceExtractor_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkPolyDataAlgorithm.h>

class CDMMESHING_EXPORT vtkMaterialInterfaceExtractor : public vtkPolyDataAlgorithm
{
public:
  static vtkMaterialInterfaceExtractor* New();
  vtkTypeMacro(vtkMaterialInterfaceExtractor, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Voxels with this label are outside too. Default -1: no others; range -1 and above. */
  vtkSetInRangeMacro(BackgroundLabel, int, -1, VTK_INT_MAX, "label of voxels");
  vtkGetMacro(BackgroundLabel, int);
  ///@}

  ///@{
  /**
   * Waves of the surface shorter than this are taken for stairs and smoothed. In voxels; default
   * 10; range 0 (the exact faces of the voxels) to 1000.
   */
  vtkSetInRangeMacro(SmoothingLength, double, 0.0, 1000.0, "voxels");
  vtkGetMacro(SmoothingLength, double);
  ///@}

  ///@{
  /** Whether to remove points that do not shape the surface. Default on. */
  vtkSetMacro(ReduceSurface, bool);
  vtkGetMacro(ReduceSurface, bool);
  vtkBooleanMacro(ReduceSurface, bool);
  ///@}

  ///@{
  /**
   * How far the reduced surface may lie from the full one, anywhere and in both directions. In
   * units of the shortest voxel edge; default 0.25; range >= 0; 0: only what is exactly flat is
   * merged.
   */
  vtkSetInRangeMacro(MaximumDeviation, double, 0.0, VTK_DOUBLE_MAX, "shortest voxel edges");
  vtkGetMacro(MaximumDeviation, double);
  ///@}

  ///@{
  /**
   * Edges that bend by more than this are kept by the reduction. Degrees; default 60; range 0 to
   * 180 (none are).
   */
  vtkSetInRangeMacro(FeatureAngle, double, 0.0, 180.0, "degrees");
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * Of the last run: faces of voxels between labels; points that smoothing held back because of
   * intersections; points removed by the reduction, and the bound of the distance between the
   * surfaces before and after it, in model units.
   */
  vtkGetMacro(NumberOfFaces, vtkIdType);
  vtkGetMacro(NumberOfHeldPoints, vtkIdType);
  vtkGetMacro(NumberOfRemovedPoints, vtkIdType);
  vtkGetMacro(LargestDeviation, double);
  ///@}

protected:
  vtkMaterialInterfaceExtractor();
  ~vtkMaterialInterfaceExtractor() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int BackgroundLabel = -1;
  double SmoothingLength = 10.0;
  bool ReduceSurface = true;
  double MaximumDeviation = 0.25;
  double FeatureAngle = 60.0;

  vtkIdType NumberOfFaces = 0;
  vtkIdType NumberOfHeldPoints = 0;
  vtkIdType NumberOfRemovedPoints = 0;
  double LargestDeviation = 0.0;

private:
  vtkMaterialInterfaceExtractor(const vtkMaterialInterfaceExtractor&) = delete;
  void operator=(const vtkMaterialInterfaceExtractor&) = delete;
};

#endif
