// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVoronoiControlVolumes
 * @brief   What the box method needs of a mesh: Voronoi boxes clipped to regions, coupling areas.
 *
 * Method (Fleischmann 1999, section 3.2.1):
 *  1. the area of the Voronoi facet of each edge within each region, signed, summed over the
 *     tetrahedra there;
 *  2. the volume of the box of each point within each region;
 *  3. the part of each boundary and interface that is nearest to each of its points;
 *  4. on demand the boxes as polyhedra.
 *
 * Inputs: port 0: vtkUnstructuredGrid of VTK_TETRA only, from any source. Cell array RegionId
 * (whole numbers from 0 on) where there are several regions; without it all is region 0.
 *
 * Outputs, with lengths in model units:
 *  - port 0: vtkPolyData, a vertex for each (point, region) with the point data of the input and
 *    the point arrays PointId (vtkIdType), RegionId (int), BoxVolume (double);
 *  - port 1: vtkPolyData, a line for each (edge, region) on all points of the input with their
 *    data; cell arrays RegionId (int), CouplingArea (double, negative where the mesh is not
 *    Delaunay or a boundary is in the way), EdgeLength (double): the box method's coefficient is
 *    their quotient;
 *  - port 2: vtkPolyData, a vertex for each (point, pair of regions that touch there) with the
 *    point data of the input and the point arrays PointId (vtkIdType), BoundaryLabels (int, 2
 *    components: the smaller region id first, -1 for outside), BoundaryArea (double);
 *  - port 3: vtkUnstructuredGrid, empty unless GenerateBoxes is on: a VTK_POLYHEDRON for each
 *    vertex of port 0, in the same order, with cell arrays PointId, RegionId, BoxVolume and the
 *    point data of the input.
 *
 * Guarantees: the boxes of a region sum up to its volume to rounding, boundary areas to the area of
 * the boundary, also where couplings are negative (signed sums; their number is reported).
 * Deterministic.
 *
 * Failure: an error that names the cells, and empty outputs, for an empty input, cells of another
 * type, tetrahedra that are inverted, flat or overlap. An aborted run has empty outputs.
 *
 * Cost: O(n log n) on all processor cores; 180 bytes per tetrahedron, and
 * 500 more for the boxes.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: control volumes. Filters/Core/BoxMethod/ControlVolumes.h and ControlPolyhedra.h are the
 * engine.
 */
#ifndef vtkVoronoiControlVolumes_h
#define vtkVoronoiControlVolumes_h

#include "cdmMeshingModule.h" // For export macro
#include <vtkPolyDataAlgorithm.h>

class vtkUnstructuredGrid;

class CDMMESHING_EXPORT vtkVoronoiControlVolumes : public vtkPolyDataAlgorithm
{
public:
  static vtkVoronoiControlVolumes* New();
  vtkTypeMacro(vtkVoronoiControlVolumes, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Make the boxes as polyhedra (port 3). Default off. */
  vtkSetMacro(GenerateBoxes, bool);
  vtkGetMacro(GenerateBoxes, bool);
  vtkBooleanMacro(GenerateBoxes, bool);
  ///@}

  /** Number of couplings in the last run that are negative by more than rounding. */
  vtkGetMacro(NumberOfNegativeCouplings, vtkIdType);

  ///@{
  /** The outputs beside that of port 0. */
  vtkPolyData* GetCouplings();
  vtkPolyData* GetBoundaryAreas();
  vtkUnstructuredGrid* GetBoxes();
  ///@}

protected:
  vtkVoronoiControlVolumes();
  ~vtkVoronoiControlVolumes() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  bool GenerateBoxes = false;
  vtkIdType NumberOfNegativeCouplings = 0;

private:
  vtkVoronoiControlVolumes(const vtkVoronoiControlVolumes&) = delete;
  void operator=(const vtkVoronoiControlVolumes&) = delete;
};

#endif
