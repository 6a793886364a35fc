// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDelaunayMeshCriteria
 * @brief   The certificate: what any tetrahedral mesh is worth to a solver, and where it fails.
 *
 * Method (Fleischmann 1999, sections 3.1, 3.2 and 5.2):
 *  1. orientation, quality measures Q1 to Q5 and angles of each tetrahedron;
 *  2. Delaunay tetrahedra (Crit. 5.3) and triangles (5.2): empty spheres, against all points;
 *  3. smallest spheres of the outer and interface facets (3.1) and of structural edges (3.2),
 *     and tetrahedra whose circumcenter lies beyond such a facet: open control volumes;
 *  4. for each edge the sum of the cotangents of the opposite dihedral angles, weighted with the
 *     lengths there (3.3; negative: an entry of the finite element matrix has the wrong sign), and
 *     for each edge and region the coupling of the box method, the signed area of the Voronoi
 *     facet;
 *  5. the volume of each region;
 *  6. for each region the volume of its boxes if their pieces are added up without signs, over the
 *     true one. It is 1 where all circumcenters lie inside of tetrahedra and facets, and more
 *     elsewhere, also in a mesh that is clean. Solvers that take the signed couplings and boxes of
 *     vtkVoronoiControlVolumes need not care; those that compute boxes by themselves, without
 *     signs, as DEVSIM does, compute with too large ones.
 * Spheres are decided exactly; 3.3 and the couplings with a tolerance of 1e-12 of the lengths
 * involved, couplings also of what rounding the coordinates changes.
 *
 * Inputs:
 *  - port 0: vtkUnstructuredGrid of VTK_TETRA from any source; cells of up to two dimensions are
 *    passed over. Cell array RegionId (whole numbers from 0 on) where there are several regions.
 *  - port 1 (optional): vtkPolyData, the boundary of the regions with the cell array
 *    BoundaryLabels: the volumes that it encloses are compared with those of the tetrahedra.
 *    Without it the volumes within the mesh's own outer and interface facets are.
 *
 * Outputs:
 *  - port 0: the tetrahedra with their data and the cell arrays Q1, Q2, Q3, Q4, Q5, AspectRatio
 *    (R/r, 1/Q3), RadiusEdgeRatio (1/Q1), SmallestDihedralAngle, LargestDihedralAngle (double,
 *    degrees), UnsignedBoxRatio (double: the volume of the tetrahedron's parts of boxes without
 *    signs to its volume), MakesUnsignedBoxesLarge (unsigned char: whether it is one of those, as
 *    few as can be, which make nine tenths of what the unsigned boxes of their region have too
 *    much), IsDelaunay (unsigned char, Crit. 5.3) and IsOpen (unsigned char: an open control
 *    volume).
 *    Field data: Certificate (three lines: verdict, reasons, numbers), IsClean (0 or 1), one count for each kind of
 *    fault (InvertedTetrahedra, FlatTetrahedra, OverfullFacets, NonDelaunayTetrahedra,
 *    NonDelaunayFacets, FacetSphereViolations, EdgeSphereViolations, OpenControlVolumes,
 *    NegativeCouplings, NegativeCotangentSums), what they are counted among (Facets, BorderFacets,
 *    StructuralEdges, Edges, Couplings), CoincidentPoints, TetrahedraUnder5Degrees,
 *    TetrahedraUnder10Degrees, TetrahedraUnder15Degrees, MeshSmallestDihedralAngle, MeshLargestDihedralAngle, and for each
 *    region RegionIds, RegionVolumes, RegionVolumeErrors (relative) and RegionUnsignedBoxRatios.
 *  - port 1: vtkUnstructuredGrid, a copy of everything at fault: VTK_LINE, VTK_TRIANGLE
 *    and VTK_TETRA with the cell arrays Fault (int, in the order of the counts above, from 0),
 *    RegionId (-1: of no region) and CellId (a cell of the input that it belongs to, or -1).
 *
 * Guarantees: deterministic for any number of threads; the input may be invalid in every way that
 * leaves finite points and existing ids.
 *
 * Failure: an error that names the cells or points, and empty outputs, for an input without
 * tetrahedra, three-dimensional cells of another type, points that are not finite.
 *
 * Cost: O(n log n) on all processor cores: 5 million tetrahedra of random points take 25 s of
 * processor time; 160 bytes per tetrahedron, outputs included.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: the criteria. Filters/Core/Certificate/MeshCertificate.h is the engine.
 */
#ifndef vtkDelaunayMeshCriteria_h
#define vtkDelaunayMeshCriteria_h

#include "cdmMeshingModule.h" // For export macro
#include <vtkUnstructuredGridAlgorithm.h>

#include <string> // For the certificate

class CDMMESHING_EXPORT vtkDelaunayMeshCriteria : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkDelaunayMeshCriteria* New();
  vtkTypeMacro(vtkDelaunayMeshCriteria, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Values of the array Fault. */
  enum Faults
  {
    INVERTED_TETRAHEDRON = 0,
    FLAT_TETRAHEDRON = 1,
    OVERFULL_FACET = 2,
    NON_DELAUNAY_TETRAHEDRON = 3,
    NON_DELAUNAY_FACET = 4,
    FACET_SPHERE = 5,
    EDGE_SPHERE = 6,
    OPEN_CONTROL_VOLUME = 7,
    NEGATIVE_COUPLING = 8,
    NEGATIVE_COTANGENT_SUM = 9
  };

  ///@{
  /** The text of the last run, a line, and whether the mesh is ready for the box method. */
  vtkGetMacro(Certificate, std::string);
  vtkGetMacro(IsClean, bool);
  ///@}

protected:
  vtkDelaunayMeshCriteria();
  ~vtkDelaunayMeshCriteria() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  std::string Certificate;
  bool IsClean = false;

private:
  vtkDelaunayMeshCriteria(const vtkDelaunayMeshCriteria&) = delete;
  void operator=(const vtkDelaunayMeshCriteria&) = delete;
};

#endif
