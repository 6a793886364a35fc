// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkConformingDelaunayMesher
 * @brief   Everything at once: polygons in, boundary-conforming Delaunay tetrahedra out.
 *
 * Method (Fleischmann 1999, chapters 3, 5 and 6): the engines of the stages, one after the other
 * (Core/Pipeline/ConformingMesher.h),
 *  1. vtkBoundaryTriangulator: one clean triangulated surface (3.5, 6.3); vtkMeshPointGenerator, if
 *     GenerateMeshPoints is on (3.6, 6.2);
 *  2. vtkDelaunaySurfaceRefiner: structural edges, flips and new points until the surface is part
 *     of its Delaunay mesh (6.3);
 *  3. vtkAdvancingFrontTetrahedralizer: tetrahedra for every enclosed region (6.4);
 *  4. vtkSliverRemover, if RemoveSlivers is on (3.4.7, 5.7); or
 *  5. vtkSteinerPointRefiner, if AddSteinerPoints is on (5.6, 6.5), which removes slivers itself:
 *     generated points are free, those of port 1 are not;
 *  6. a check of the result, from the output alone.
 *
 * MeshFor says what the mesh is for. It decides Criterion, MaximumEdgeLength, GenerateMeshPoints,
 * AddSteinerPoints, RemoveSlivers, DihedralAngleTarget and RadiusEdgeRatio
 * (Core/Pipeline/MeshPurpose.h), each as long as it is AUTOMATIC (-1), its default; what is set
 * counts. The field arrays of the mesh MeshFor (int) and MaximumEdgeLength (double, model units)
 * have what was used, and the last line of the certificate has all of it.
 *
 * Inputs: port 0: vtkPolyData, any list of polygons, optionally with the two-component cell array
 * BoundaryLabels (region ids on the front and back side, -1 outside) and the field array
 * RegionNames. Port 1, optional: vtkPointSet, mesh points, beside those that are generated. Port 2,
 * optional: vtkDataSet with the point array Sizing: target edge length in model units.
 *
 * Blocks: port 0 may be a vtkPartitionedDataSetCollection or a vtkMultiBlockDataSet of vtkPolyData.
 * Each block is meshed by itself; all get the same mesh points and sizing. On several processes
 * blocks are spread over them: the largest one that is left goes to the process with the fewest
 * polygons so far. Pieces of a block on several processes, and partitions, become one surface. The
 * outputs are of the same kind and structure, with a block where its process is, and nothing on the
 * others.
 *
 * Outputs: port 0: vtkUnstructuredGrid of VTK_TETRA with the cell array RegionId (int), the point
 * data of the input, interpolated at new points, and in the field data the certificate with the
 * arrays of vtkDelaunayMeshCriteria: couplings are looked at with the two stronger criteria only.
 * Port 1: the boundary of the mesh and its regions as triangles, with BoundaryLabels (int, 2
 * components), StructuralFacetId (int: see vtkDelaunaySurfaceRefiner) and the cell data of the input
 * polygons; where the criterion is missed also Unresolved (unsigned char), 1 for triangles that miss
 * it. Port 2: the problems found in the input, see vtkBoundaryTriangulator.
 *
 * Guarantees: those of the stages. Tetrahedra are positively oriented, none is flat, circumspheres
 * are empty, the boundary is kept, points of the input keep their coordinates. A result that the
 * check finds at fault comes with a warning. A surface that cannot fulfil the criterion within the
 * limits is meshed all the same, with a warning. Deterministic.
 *
 * Failure: the error of the stage that failed, with the cells of this filter's input, and empty
 * outputs; port 2 still lists what was found. An aborted run has empty outputs. An error in a block
 * names it, and ends the filter on all processes.
 * A value out of the range of its property is an error: in the setter, after which the property is
 * what it was, or, where AUTOMATIC is allowed beside real numbers and in rows of tables, when the
 * filter runs.
 *
 * Cost: O(n log n) for n tetrahedra, if the surface is not much finer than its smallest features.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999.
 */
#ifndef vtkConformingDelaunayMesher_h
#define vtkConformingDelaunayMesher_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include "vtkDelaunaySurfaceRefiner.h"
#include "vtkMeshPointGenerator.h"
#include <vtkUnstructuredGridAlgorithm.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

class vtkDataSet;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;
namespace cdm
{
struct ConformingMesherOptions;
struct MeshOptionChoices;
struct Status;
} // namespace cdm

class CDMMESHING_EXPORT vtkConformingDelaunayMesher : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkConformingDelaunayMesher* New();
  vtkTypeMacro(vtkConformingDelaunayMesher, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The tetrahedra; the output of a port (1: boundary, 2: problems), null for blocks. */
  vtkUnstructuredGrid* GetOutput() { return this->Superclass::GetOutput(); }
  vtkPointSet* GetOutput(int port);
  ///@}

  enum Purposes
  {
    FINITE_VOLUMES = 0,
    FINITE_ELEMENTS = 1,
    FEWEST_POINTS = 2
  };

  /** The value of a property that is as MeshFor asks. */
  enum
  {
    AUTOMATIC = -1
  };

  ///@{
  /**
   * What the mesh is for, one of Purposes. FINITE_VOLUMES: smallest spheres, Steiner points, no
   * slivers, no negative coupling of the box method. FINITE_ELEMENTS: shapes count, with the
   * criterion Delaunay. FEWEST_POINTS: the criterion Delaunay, no size, no Steiner points. Default
   * FINITE_VOLUMES.
   */
  vtkSetInRangeMacro(MeshFor, int, FINITE_VOLUMES, FEWEST_POINTS, "one of Purposes");
  vtkGetMacro(MeshFor, int);
  void SetMeshForToFiniteVolumes() { this->SetMeshFor(FINITE_VOLUMES); }
  void SetMeshForToFiniteElements() { this->SetMeshFor(FINITE_ELEMENTS); }
  void SetMeshForToFewestPoints() { this->SetMeshFor(FEWEST_POINTS); }
  ///@}

  /** See vtkDelaunaySurfaceRefiner::Criteria. */
  enum Criteria
  {
    Delaunay = vtkDelaunaySurfaceRefiner::Delaunay,
    SmallestSphere = vtkDelaunaySurfaceRefiner::SmallestSphere,
    SmallestSphereAndEdges = vtkDelaunaySurfaceRefiner::SmallestSphereAndEdges
  };

  ///@{
  /**
   * Points closer to each other than this are merged. Model units; default 0: only points with
   * equal coordinates; range 0 and above.
   */
  vtkSetInRangeMacro(MergeTolerance, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(MergeTolerance, double);
  ///@}

  ///@{
  /** Gaps of at most this many open edges are patched. Default 0: none; range 0 and above. */
  vtkSetInRangeMacro(MaximumGapEdges, int, 0, VTK_INT_MAX, "open edges");
  vtkGetMacro(MaximumGapEdges, int);
  ///@}

  ///@{
  /**
   * Split triangles that intersect along their intersections, instead of refusing them. The cuts
   * are rounded to double precision, so a cut triangle moves by that much. Default off.
   */
  vtkSetMacro(ResolveSelfIntersections, bool);
  vtkGetMacro(ResolveSelfIntersections, bool);
  vtkBooleanMacro(ResolveSelfIntersections, bool);
  ///@}

  ///@{
  /**
   * What stays of a surface without labels whose self-intersections were resolved. Off: the
   * boundary of the union; on: pieces inside of it too, as sheets between regions. With labels all
   * pieces stay in any case. Default off.
   */
  vtkSetMacro(KeepInternalPieces, bool);
  vtkGetMacro(KeepInternalPieces, bool);
  vtkBooleanMacro(KeepInternalPieces, bool);
  ///@}

  ///@{
  /**
   * What every boundary triangle has to fulfil, one of Criteria or AUTOMATIC: SmallestSphere for
   * finite volumes, Delaunay otherwise. Default AUTOMATIC.
   */
  vtkSetInRangeMacro(
    Criterion, int, AUTOMATIC, SmallestSphereAndEdges, "one of Criteria; -1: automatic");
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
   * Boundary triangles with a larger area are refined. Square model units; default 0: off; range 0
   * and above.
   */
  vtkSetInRangeMacro(MaximumArea, double, 0.0, VTK_DOUBLE_MAX, "square model units");
  vtkGetMacro(MaximumArea, double);
  ///@}

  ///@{
  /**
   * Longer boundary edges are split; with Steiner points those inside, too. Model units; 0: off;
   * default AUTOMATIC: off for the fewest points and with a sizing input, otherwise a size by the
   * bounding box and the thinnest region (Core/Sizing/DefaultSize.h); range 0 and above, or
   * AUTOMATIC.
   */
  vtkSetMacro(MaximumEdgeLength, double);
  vtkGetMacro(MaximumEdgeLength, double);
  ///@}

  ///@{
  /**
   * A region, by its id or by its name in the field array RegionNames, gets edges no longer than
   * this, beside MaximumEdgeLength and the sizing. Model units, above 0; default: none.
   */
  void AddRegionSize(int region, double length);
  void AddRegionSize(const char* region, double length);
  void RemoveAllRegionSizes();
  ///@}

  ///@{
  /**
   * How much longer edges may be for each unit of distance from a region with a size of its own: at
   * a distance d its size + Growth * d (Core/Sizing/RegionSizes.h). Default 0.3; above 0; well
   * shaped tetrahedra need about 0.5 or less.
   */
  vtkSetMacro(Growth, double);
  vtkGetMacro(Growth, double);
  ///@}

  ///@{
  /**
   * How far the surface may be from that of the input, and the input's from it, where it is finer
   * than edges are to be: it is then made coarser and evened out first, with structural edges
   * (which bend by more than 40 degrees, or lie between different labels, facets or values of
   * integer cell arrays that repeat), topology and labels kept. Points of the input then need not
   * be points of the mesh. Model units; 0: it stays as it is; default AUTOMATIC: a tenth of
   * MaximumEdgeLength, or of the smallest sizing, or of the thickness of the thinnest region (twice
   * its volume over its area) if that is less, for surfaces of at least 500 polygons, all of them
   * triangles, with half of the edges shorter than 0.64 of that size, or with half of the triangles
   * narrow strips (one edge shorter than that, and one longer than 1.07 of the size), otherwise 0.
   * A warning says what was done. Range 0 and above, or AUTOMATIC.
   */
  vtkSetMacro(MaximumDeviation, double);
  vtkGetMacro(MaximumDeviation, double);
  ///@}

  ///@{
  /**
   * Whether to place mesh points inside of the regions by vtkMeshPointGenerator, as dense as the
   * sizing input asks for, or without it Spacing. With Steiner points they lie so that no edge
   * between them is too long: far fewer points are needed inside. 0: no; 1: yes; default AUTOMATIC:
   * with Steiner points and a size or sizing, but not for the fewest points.
   */
  vtkSetInRangeMacro(GenerateMeshPoints, int, AUTOMATIC, 1, "0: no; 1: yes; -1: automatic");
  vtkGetMacro(GenerateMeshPoints, int);
  vtkBooleanMacro(GenerateMeshPoints, int);
  ///@}

  ///@{
  /** How they are placed, one of vtkMeshPointGenerator::Placements. Default OCTREE. */
  vtkSetInRangeMacro(Placement, int, vtkMeshPointGenerator::OCTREE, vtkMeshPointGenerator::NONE,
    "one of vtkMeshPointGenerator::Placements");
  vtkGetMacro(Placement, int);
  ///@}

  ///@{
  /**
   * Their spacing along x, y and z where no sizing is connected. Model units; default 0:
   * MaximumEdgeLength or, if that is off, a tenth of the longest side of the bounding box; range 0
   * and above.
   */
  vtkSetVector3Macro(Spacing, double);
  vtkGetVector3Macro(Spacing, double);
  ///@}

  ///@{
  /**
   * Layers of them along interfaces, as in vtkMeshPointGenerator: regions are ids, or texts with
   * their names or ids. Default none. ParaView has a table for each, and empties them one by one.
   */
  void AddLayers(double region, double neighbor, double numberOfLayers, double firstDistance,
    double growthRatio);
  void AddLayers(const char* region, const char* neighbor, double numberOfLayers,
    double firstDistance, double growthRatio);
  void RemoveAllLayers();
  void RemoveAllLayersById();
  void RemoveAllLayersByName();
  ///@}

  ///@{
  /**
   * Mesh points closer to the boundary are dropped. Ratio of the bounding box diagonal; default
   * 1e-3; range 0 (only those on the boundary) and above. Thin layers need a smaller one.
   */
  vtkSetInRangeMacro(
    MeshPointClearanceRatio, double, 0.0, VTK_DOUBLE_MAX, "ratio of the bounding box diagonal");
  vtkGetMacro(MeshPointClearanceRatio, double);
  ///@}

  ///@{
  /**
   * Where the surface is open, close the mesh with triangles on the convex hull of the points;
   * otherwise an open region is an error. Default off.
   */
  vtkSetMacro(CloseOpenBoundary, bool);
  vtkGetMacro(CloseOpenBoundary, bool);
  vtkBooleanMacro(CloseOpenBoundary, bool);
  ///@}

  ///@{
  /**
   * Whether tetrahedra with a dihedral angle below DihedralAngleTarget are to be removed (0 or 1):
   * by vtkSteinerPointRefiner if Steiner points are added, otherwise by vtkSliverRemover. Default
   * AUTOMATIC: yes.
   */
  vtkSetInRangeMacro(RemoveSlivers, int, AUTOMATIC, 1, "0: no; 1: yes; -1: automatic");
  vtkGetMacro(RemoveSlivers, int);
  vtkBooleanMacro(RemoveSlivers, int);
  ///@}

  ///@{
  /**
   * Whether to run vtkSteinerPointRefiner (0 or 1): new points on the boundary and inside until no
   * tetrahedron has an edge longer than MaximumEdgeLength or the sizing, is larger than
   * MaximumVolume, has a larger radius-edge ratio or, with RemoveSlivers, a smaller dihedral angle
   * than asked for, but for those at sharp input angles and across thin layers, and until no
   * coupling of the box method is negative. Criterion Delaunay counts as SmallestSphere. Default
   * AUTOMATIC: not for the fewest points.
   */
  vtkSetInRangeMacro(AddSteinerPoints, int, AUTOMATIC, 1, "0: no; 1: yes; -1: automatic");
  vtkGetMacro(AddSteinerPoints, int);
  vtkBooleanMacro(AddSteinerPoints, int);
  ///@}

  ///@{
  /**
   * Largest ratio of a tetrahedron's circumradius to its shortest edge, with Steiner points. 0:
   * off; default AUTOMATIC: 1.4; range 0 and above, or AUTOMATIC.
   */
  vtkSetMacro(RadiusEdgeRatio, double);
  vtkGetMacro(RadiusEdgeRatio, double);
  ///@}

  ///@{
  /**
   * Largest volume of a tetrahedron, with AddSteinerPoints. Cubic model units; default 0: off;
   * range >= 0.
   */
  vtkSetInRangeMacro(MaximumVolume, double, 0.0, VTK_DOUBLE_MAX, "cubic model units");
  vtkGetMacro(MaximumVolume, double);
  ///@}

  ///@{
  /**
   * Tetrahedra with a smaller dihedral angle are slivers; with Steiner points, more than 40 count
   * as 40. Degrees; default AUTOMATIC: 20 for finite elements, otherwise 15; range 0 to 70, or
   * AUTOMATIC.
   */
  vtkSetMacro(DihedralAngleTarget, double);
  vtkGetMacro(DihedralAngleTarget, double);
  ///@}

  ///@{
  /**
   * Steiner points do not fill all layers. Layers whose facets are at least so many times as wide as
   * the layer is thick are thin: tetrahedra across them may be flat, as well shaped ones would have
   * to be as small as the layer is thick. All other layers are filled with well shaped ones. Facets
   * that bend by less than a degree are one. Ratio; default 0: 20 where another region is beside the
   * layer, and 100 for plates, with the outside on both sides; otherwise at least 1.
   */
  vtkSetInRangeMacro(LayerAspectRatio, double, 0.0, VTK_DOUBLE_MAX, "ratio of width to thickness");
  vtkGetMacro(LayerAspectRatio, double);
  ///@}

  ///@{
  /**
   * Steiner points divide layers. At least so many tetrahedra lie one after another from side to side of each layer, and
   * of each other part whose sides face each other, but for thin layers (LayerAspectRatio) and layers
   * that end in a sharp edge. Default 1: no more than their shapes need; range 1 to 100.
   */
  vtkSetInRangeMacro(TetrahedraAcrossLayers, int, 1, 100, "tetrahedra");
  vtkGetMacro(TetrahedraAcrossLayers, int);
  ///@}

  ///@{
  /**
   * With Steiner points: how many times each free point inside may go to where fewer circumcenters
   * lie outside of their tetrahedra. Solvers that take absolute values of couplings then have
   * smaller errors; the others need no smoothing. The mesh stays Delaunay, with the same boundary;
   * sizes, slivers and couplings do not get worse. Rounds; default 0: none; range 0 to 100.
   */
  vtkSetInRangeMacro(SmoothingRounds, int, 0, 100, "rounds");
  vtkGetMacro(SmoothingRounds, int);
  ///@}

  ///@{
  /**
   * The refinement of the surface and of the tetrahedra stop so much time after the start, unless there is
   * no mesh without more. Warnings say what the mesh misses, and its certificate which criterion holds; all of
   * it is valid. What is begun is brought to its end, and the check comes on top. Where the time is over, the
   * result depends on the machine. Seconds; default 0: no limit; range >= 0.
   */
  vtkSetInRangeMacro(MaximumTime, double, 0.0, VTK_DOUBLE_MAX, "s");
  vtkGetMacro(MaximumTime, double);
  ///@}

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkConformingDelaunayMesher();
  ~vtkConformingDelaunayMesher() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int MeshFor = FINITE_VOLUMES;
  double MergeTolerance = 0.0;
  int MaximumGapEdges = 0;
  bool ResolveSelfIntersections = false;
  bool KeepInternalPieces = false;
  int Criterion = AUTOMATIC;
  double AccuracyAngle = 0.0;
  double MinimumAngle = 0.0;
  double MaximumArea = 0.0;
  double MaximumEdgeLength = AUTOMATIC;
  std::vector<std::pair<std::string, double>> RegionSizes;
  double Growth = 0.3;
  double MaximumDeviation = AUTOMATIC;
  int GenerateMeshPoints = AUTOMATIC;
  int Placement = vtkMeshPointGenerator::OCTREE;
  double Spacing[3] = { 0.0, 0.0, 0.0 };
  std::vector<std::pair<std::array<std::string, 2>, std::array<double, 3>>> Layers;
  std::vector<std::pair<std::array<std::string, 2>, std::array<double, 3>>> LayersByName;
  double MeshPointClearanceRatio = 1e-3;
  bool CloseOpenBoundary = false;
  int RemoveSlivers = AUTOMATIC;
  double DihedralAngleTarget = AUTOMATIC;
  int AddSteinerPoints = AUTOMATIC;
  double RadiusEdgeRatio = AUTOMATIC;
  double MaximumVolume = 0.0;
  double LayerAspectRatio = 0.0;
  int TetrahedraAcrossLayers = 1;
  int SmoothingRounds = 0;
  double MaximumTime = 0.0;

private:
  int RequestDataObject(vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  int MeshBlocks(vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  cdm::Status MakeChoices(cdm::MeshOptionChoices& choices) const;
  cdm::Status MakeOptions(vtkPolyData* input, cdm::ConformingMesherOptions& options) const;
  /** All stages; prefix comes before the text of warnings. */
  cdm::Status MeshPolygons(const std::string& prefix, vtkPolyData* input, vtkPointSet* givenPoints,
    vtkDataSet* sizing, vtkUnstructuredGrid* mesh, vtkPolyData* boundary, vtkPolyData* problems);

  vtkConformingDelaunayMesher(const vtkConformingDelaunayMesher&) = delete;
  void operator=(const vtkConformingDelaunayMesher&) = delete;
};

#endif
