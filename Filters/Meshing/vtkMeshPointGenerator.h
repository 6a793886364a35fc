// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMeshPointGenerator
 * @brief   Places mesh points inside of the regions of a surface, as dense as a sizing asks for.
 *
 * Method (Fleischmann 1999, sections 3.3, 3.6 and 6.2):
 *  1. points in layers off chosen interfaces, on the normals of the vertices that the surface has
 *     when it is refined as the sizing asks for: inversion layers, thin oxides;
 *  2. besides them one of four placements:
 *     - octree: cells are split until they are as small as the spacing in them, and until
 *       neighbors differ by no more than MaximumLevelDifference levels; each has the points of the
 *       Template: corners, center, or those of a lattice's unit cell (Fig. 6.2);
 *     - ortho-product: planes across the axes, at given ticks, or at distances of the smallest
 *       spacing between them; the Template again. With a body- or face-centered template and one
 *       spacing these are the crystal lattices;
 *     - random: darts, none nearer to others than about the spacing, then Lloyd's iteration;
 *     - none: layers only;
 *  3. points stay if they lie strictly inside of a region, not near a layer, and clear of the
 *     boundary by BoundaryClearance times the spacing of the points around them.
 * Edges of the mesh come close to the spacing. Octree cells are powers of two apart: their edges
 * have half of it to 1.5 times of it, random points and those of a grid are closer to it.
 *
 * Inputs: port 0: vtkPolyData of triangles (run vtkBoundaryTriangulator first), closed, optionally
 * with the two-component cell array BoundaryLabels. Give the mesher that comes after it the same
 * surface and sizing; layers nearer to the boundary than MeshPointClearanceRatio of
 * vtkDelaunaySurfaceRefiner would be dropped there: lower it for them. Port 1, optional: vtkDataSet
 * with the point array Sizing: target edge length at a position, in model units, positive; one
 * component, 3 (along x, y and z), or 6 (xx, yy, zz, xy, yz, xz) or 9 (a symmetric tensor whose
 * principal values are lengths). Between its points it is interpolated, outside of it the nearest
 * value holds. Octree and ortho-product follow the lengths along the axes, random points the
 * tensor. Without it Spacing holds everywhere.
 *
 * Outputs: port 0: vtkPolyData of vertices, coordinates in double precision: the mesh points, for
 * port 1 of vtkDelaunaySurfaceRefiner or vtkConformingDelaunayMesher. Point arrays RegionId (int):
 * as that of the tetrahedra; Layer (int): number of the layer counted from the interface, 0 for all
 * other points.
 *
 * Guarantees: points lie strictly inside of their region, decided exactly; the boundary is not
 * nearer than BoundaryClearance spacings; layers have their distance from the interface, to
 * rounding. Deterministic, random points too: the same Seed, the same points.
 *
 * Failure: an error that names the cells, and an empty output, for an empty input, cells that are
 * not triangles, labels that contradict each other, a surface that encloses nothing, layers at an
 * interface that does not exist, a Sizing that is not positive, or more points than
 * MaximumNumberOfPoints. A warning if no point, or none of the layers, finds place.
 *
 * Cost: O(n log n); some 10 microseconds for a point of the octree, a millisecond for a random one
 * with the default number of iterations.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: the placements. Filters/Core/MeshPoints/MeshPointGenerator.h is the engine.
 */
#ifndef vtkMeshPointGenerator_h
#define vtkMeshPointGenerator_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkPolyDataAlgorithm.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

class CDMMESHING_EXPORT vtkMeshPointGenerator : public vtkPolyDataAlgorithm
{
public:
  static vtkMeshPointGenerator* New();
  vtkTypeMacro(vtkMeshPointGenerator, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Values of Placement. */
  enum Placements
  {
    OCTREE = 0,
    ORTHO_PRODUCT = 1,
    RANDOM = 2,
    /** Layers only. */
    NONE = 3
  };

  /** Values of Template. */
  enum Templates
  {
    CORNERS = 0,
    CENTERS = 1,
    /** Corners and center of a cell. */
    BODY_CENTERED = 2,
    /** Corners of a cell and centers of its sides. */
    FACE_CENTERED = 3
  };

  ///@{
  /** How points are placed away from layers, one of Placements. Default OCTREE. */
  vtkSetInRangeMacro(Placement, int, OCTREE, NONE, "one of Placements");
  vtkGetMacro(Placement, int);
  void SetPlacementToOctree() { this->SetPlacement(OCTREE); }
  void SetPlacementToOrthoProduct() { this->SetPlacement(ORTHO_PRODUCT); }
  void SetPlacementToRandom() { this->SetPlacement(RANDOM); }
  void SetPlacementToNone() { this->SetPlacement(NONE); }
  ///@}

  ///@{
  /** Points of a cell of the octree or ortho-product, one of Templates. Default BODY_CENTERED. */
  vtkSetInRangeMacro(Template, int, CORNERS, FACE_CENTERED, "one of Templates");
  vtkGetMacro(Template, int);
  void SetTemplateToCorners() { this->SetTemplate(CORNERS); }
  void SetTemplateToCenters() { this->SetTemplate(CENTERS); }
  void SetTemplateToBodyCentered() { this->SetTemplate(BODY_CENTERED); }
  void SetTemplateToFaceCentered() { this->SetTemplate(FACE_CENTERED); }
  ///@}

  ///@{
  /**
   * Spacing along x, y and z where no sizing is connected. Model units; default 0: a tenth of the
   * longest side of the bounding box; range >= 0.
   */
  vtkSetVector3Macro(Spacing, double);
  vtkGetVector3Macro(Spacing, double);
  ///@}

  ///@{
  /**
   * Octree and random points: by how many levels (powers of two of the size) neighboring cells may
   * differ. Default 1; range 0 (no bound) to 16.
   */
  vtkSetInRangeMacro(MaximumLevelDifference, int, 0, 16, "levels of the octree");
  vtkGetMacro(MaximumLevelDifference, int);
  ///@}

  ///@{
  /**
   * Ortho-product: a plane at this x, y or z. Model units; any finite value, in any order. Default:
   * none; an axis without planes gets them from the spacing.
   */
  void AddXTick(double x) { this->AddTick(0, x); }
  void AddYTick(double y) { this->AddTick(1, y); }
  void AddZTick(double z) { this->AddTick(2, z); }
  void RemoveAllXTicks() { this->RemoveAllTicks(0); }
  void RemoveAllYTicks() { this->RemoveAllTicks(1); }
  void RemoveAllZTicks() { this->RemoveAllTicks(2); }
  ///@}

  ///@{
  /** Random points: number of Lloyd's iterations. Default 10; range 0 to 1000. */
  vtkSetInRangeMacro(SmoothingIterations, int, 0, 1000, "iterations");
  vtkGetMacro(SmoothingIterations, int);
  ///@}

  ///@{
  /** Random points: where the sequence of random numbers starts. Default 1; range >= 0. */
  vtkSetInRangeMacro(Seed, int, 0, VTK_INT_MAX, "start of the random numbers");
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Layers of points in a region along its interface with a neighbor (ids as in BoundaryLabels; -1
   * is the outside): so many of them, the first one at a distance (model units), each further gap
   * growing by a ratio. Whole numbers are passed as double, as ParaView does with rows of a table;
   * or regions as texts, which may also be names from the field array RegionNames. ParaView has a
   * table for each, and empties them one by one; layers of texts come after those of numbers.
   * Default: none; ranges: region and neighbor >= -1, 1 to 1000 layers, distance and ratio > 0.
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
   * Points closer to the boundary are left out. In spacings of the points around; default 0.5;
   * range 0 to 10.
   */
  vtkSetInRangeMacro(BoundaryClearance, double, 0.0, 10.0, "spacings of the points around");
  vtkGetMacro(BoundaryClearance, double);
  ///@}

  ///@{
  /** More points are an error. Default 10,000,000; range >= 1. */
  vtkSetInRangeMacro(MaximumNumberOfPoints, int, 1, VTK_INT_MAX, "points");
  vtkGetMacro(MaximumNumberOfPoints, int);
  ///@}

  ///@{
  /** Counts of the last run. Dropped are points of layers for which there was no room. */
  vtkGetMacro(NumberOfLayerPoints, vtkIdType);
  vtkGetMacro(NumberOfDroppedLayerPoints, vtkIdType);
  ///@}

protected:
  vtkMeshPointGenerator();
  ~vtkMeshPointGenerator() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  void AddTick(int axis, double position);
  void RemoveAllTicks(int axis);

  int Placement = OCTREE;
  int Template = BODY_CENTERED;
  double Spacing[3] = { 0.0, 0.0, 0.0 };
  int MaximumLevelDifference = 1;
  std::array<std::vector<double>, 3> Ticks;
  int SmoothingIterations = 10;
  int Seed = 1;
  std::vector<std::pair<std::array<std::string, 2>, std::array<double, 3>>> Layers;
  std::vector<std::pair<std::array<std::string, 2>, std::array<double, 3>>> LayersByName;
  double BoundaryClearance = 0.5;
  int MaximumNumberOfPoints = 10000000;

  vtkIdType NumberOfLayerPoints = 0;
  vtkIdType NumberOfDroppedLayerPoints = 0;

private:
  vtkMeshPointGenerator(const vtkMeshPointGenerator&) = delete;
  void operator=(const vtkMeshPointGenerator&) = delete;
};

#endif
