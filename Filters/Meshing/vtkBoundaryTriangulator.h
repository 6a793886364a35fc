// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBoundaryTriangulator
 * @brief   Stage 0: turns any list of polygons into a clean, well connected triangulated surface.
 *
 * One unsorted list of polygons is enough: of any orientation, convex or not, open or closed, of
 * one or of several materials, with more than two polygons at an edge.
 *
 * Method (Fleischmann 1999, sections 3.5 and 6.3):
 *  1. merge coincident points; drop repeated vertices, degenerate and duplicate polygons;
 *  2. split polygon edges at vertices that lie on them (T-junctions, Fig. 3.16);
 *  3. triangulate every polygon by recursive splitting, with exact signs;
 *  4. patch gaps: rings of at most MaximumGapEdges open edges;
 *  5. find all triangles that cross, overlap or touch each other wrongly, exactly; on request split
 *     them along their intersections;
 *  6. turn over the triangles that are reversed, where BoundaryLabels or closure tell.
 *
 * Inputs: port 0: vtkPolyData. Polygons and triangle strips are used; vertices and lines are
 * ignored with a warning. Optional cell array BoundaryLabels (two whole numbers for each cell): the
 * region ids on the front and the back side, -1 for outside.
 *
 * Outputs: port 0: the surface, triangles only, coordinates in double precision. Cell data are
 * those of the polygon that a triangle comes from (for a patched gap: of the polygon at its first
 * edge), BoundaryLabels is a vtkIntArray; point data are those of the input points, interpolated
 * where triangles were split.
 * Port 1: the problems found, to look at: line segments, or vertices where a segment is a point,
 * and the polygons concerned. Cell arrays: ProblemKind (int, see ProblemKinds), Cell and OtherCell
 * (vtkIdType): the cells of the input that it is about, -1 for none.
 *
 * Repairs that drop something are told in a warning that names the cells, and counted.
 *
 * Guarantees: no two points coincide, no triangle is degenerate or there twice, and two triangles
 * meet in a common edge, a common vertex or not at all. Points keep their exact coordinates.
 * Deterministic.
 *
 * Failure: an error that names the cells or points, and an empty surface, for an empty input,
 * coordinates that are not finite, outlines that cannot be triangulated, and self-intersections
 * (unless RefuseSelfIntersections is off). Port 1 still lists what was found.
 *
 * Cost: O(n log n) for n triangles that overlap in few places.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: recursive splitting, gaps, T-junctions. Filters/Core/Repair/BoundaryTriangulator.h is the
 * engine.
 */
#ifndef vtkBoundaryTriangulator_h
#define vtkBoundaryTriangulator_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkPolyDataAlgorithm.h>

namespace cdm
{
struct BoundaryTriangulatorReport;
}

class CDMMESHING_EXPORT vtkBoundaryTriangulator : public vtkPolyDataAlgorithm
{
public:
  static vtkBoundaryTriangulator* New();
  vtkTypeMacro(vtkBoundaryTriangulator, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Values of the cell array ProblemKind of output port 1. */
  enum ProblemKinds
  {
    /** Where two triangles cross, overlap or touch: segments and points. */
    SelfIntersection = 0,
    /** A polygon without area, dropped. */
    DegeneratePolygon,
    /** A polygon that repeats OtherCell, dropped. */
    DuplicatePolygon,
    /** A polygon whose outline crosses itself. */
    InvalidOutline,
    /** A vertex on an edge of Cell, which was split there. */
    TJunction,
    /** An open edge of a ring that was patched. */
    PatchedGap,
    /** An open edge that was left as it is. */
    OpenEdge,
    /** A polygon against the orientation of the others; its triangles were turned over. */
    ReversedPolygon,
    /** A polygon of a self-intersection. */
    IntersectingPolygon
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
  /**
   * Rings of at most this many open edges are patched; longer ones are taken for boundaries that
   * are open on purpose. Default 0: none; range 0 and above.
   */
  vtkSetInRangeMacro(MaximumGapEdges, int, 0, VTK_INT_MAX, "open edges");
  vtkGetMacro(MaximumGapEdges, int);
  ///@}

  ///@{
  /**
   * Whether a self-intersection is an error. Off: the surface is made all the same and the pairs
   * are listed on output port 1; the stages after this one refuse it. Default on.
   */
  vtkSetMacro(RefuseSelfIntersections, bool);
  vtkGetMacro(RefuseSelfIntersections, bool);
  vtkBooleanMacro(RefuseSelfIntersections, bool);
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
  /** What the last run met and repaired. */
  vtkGetMacro(NumberOfMergedPoints, vtkIdType);
  vtkGetMacro(NumberOfUnusedPoints, vtkIdType);
  vtkGetMacro(NumberOfRepeatedVertices, vtkIdType);
  vtkGetMacro(NumberOfDegeneratePolygons, vtkIdType);
  vtkGetMacro(NumberOfDuplicatePolygons, vtkIdType);
  vtkGetMacro(NumberOfTJunctions, vtkIdType);
  vtkGetMacro(NumberOfNonPlanarPolygons, vtkIdType);
  vtkGetMacro(NumberOfPatchedRings, vtkIdType);
  vtkGetMacro(NumberOfOpenEdges, vtkIdType);
  vtkGetMacro(NumberOfNonManifoldEdges, vtkIdType);
  vtkGetMacro(NumberOfReversedPolygons, vtkIdType);
  vtkGetMacro(NumberOfSelfIntersections, vtkIdType);
  ///@}

protected:
  vtkBoundaryTriangulator();
  ~vtkBoundaryTriangulator() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double MergeTolerance = 0.0;
  int MaximumGapEdges = 0;
  bool RefuseSelfIntersections = true;
  bool ResolveSelfIntersections = false;
  bool KeepInternalPieces = false;

  vtkIdType NumberOfMergedPoints = 0;
  vtkIdType NumberOfUnusedPoints = 0;
  vtkIdType NumberOfRepeatedVertices = 0;
  vtkIdType NumberOfDegeneratePolygons = 0;
  vtkIdType NumberOfDuplicatePolygons = 0;
  vtkIdType NumberOfTJunctions = 0;
  vtkIdType NumberOfNonPlanarPolygons = 0;
  vtkIdType NumberOfPatchedRings = 0;
  vtkIdType NumberOfOpenEdges = 0;
  vtkIdType NumberOfNonManifoldEdges = 0;
  vtkIdType NumberOfReversedPolygons = 0;
  vtkIdType NumberOfSelfIntersections = 0;

private:
  void TakeReport(const cdm::BoundaryTriangulatorReport& report);

  vtkBoundaryTriangulator(const vtkBoundaryTriangulator&) = delete;
  void operator=(const vtkBoundaryTriangulator&) = delete;
};

#endif
