// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SteinerPointRefiner.h
 * @brief Stage 5: new points, inside and on the boundary, until sizes and shapes are as wanted.
 *
 * Method (thesis 5.6 and 6.5): the boundary of the mesh is taken as a surface and its interior
 * points as mesh points; new points are added to these, and unwanted ones are taken out. Then, in
 * rounds, the surface is refined until its smallest spheres are empty and it is as fine as the
 * sizing asks for, and split where the round before requested it. It is tetrahedralized with the
 * mesh points, and the inside is refined for this boundary (SteinerPointRounds.h). Steiner points
 * are inserted in tetrahedra that are too large, then also in badly shaped ones, where each comes
 * no closer to others than a twentieth of the shortest edge that was there before. If a point would
 * encroach on the boundary, a split of the boundary is requested instead (VolumeRefinement.h). Where
 * these are for an eighth of the boundary, triangles of it that are too narrow for the limit of
 * shapes are split as well, before the next mesh is made: that spares half of the rounds with many
 * splits. When little is requested any more, points of slivers are moved, taken out or added, first
 * those inside, then those of the surface within their facets and along their edges; and the boundary is
 * split for slivers that nothing else helps. At last edges of the boundary with a negative coupling
 * are split (SliverSchedule.h). If rounds of smoothing are asked for, points inside are then moved to
 * where fewer circumcenters lie outside (OptimalDelaunaySmoothing.h).
 *
 * A round is in one of these states. "Next" starts another round: it splits what is requested.
 *
 * | state    | what is done                  | then                                             |
 * |----------|-------------------------------|--------------------------------------------------|
 * | start    | refine and tetrahedralize the | weak triangles: end; otherwise sizes             |
 * |          | surface                       |                                                  |
 * | sizes    | refine inside for sizes       | splits are requested: next, sizes; otherwise     |
 * |          |                               | measure the sizes of points, shapes              |
 * | shapes   | refine inside for sizes and   | boundary final: finish; few requests, or none    |
 * |          | shapes, note the state        | that can be made: slivers; else next, shapes     |
 * | slivers  | SliverSchedule::Run()         | Open, Requested, Moved: next, shapes; Done: end  |
 * | next     | split the boundary, in the    | weak triangles: restore; otherwise the state     |
 * |          | mesh or in a new one          | named above                                      |
 * | restore  | back to the state noted, the  | the state named above                            |
 * |          | boundary is final             |                                                  |
 * | finish   | SliverSchedule::Finish()      | end                                              |
 *
 * Sizes are also left when as many points have been made as allowed, when MaximumTime is over, or
 * when a round has split nothing; shapes then go to slivers. No round is started after that time,
 * nor after a thousand, which no input came near.
 *
 * Guarantees: the mesh is Delaunay by the pulling rule and conforms to the same surface; facets on
 * it fulfil criterion 3.1 at least. (Where the surface refiner does not end with that criterion, no
 * points are inserted: the mesh is that of stage 3, and the report counts the WeakTriangles.) The
 * report counts the couplings of the box method that are still negative. Points of the mesh that
 * are not free keep their coordinates; those of the surface that are stay in their facets and on
 * their edges. Deterministic, whatever the number of threads, unless MaximumTime is reached.
 * Tetrahedra across thin layers (ThinLayers.h) and across sharp angles (SharpAngles.h), which would
 * be refined for ever, are not refined for their shape: Faults tells which tetrahedra miss what was
 * asked for, the report counts them. Failure: InvalidInput names tetrahedra without a region,
 * inverted or flat ones, triangles that are no facets or facets that are missing among them, points
 * that are not finite. Cells are tetrahedra if no boundary is given, otherwise its triangles. The
 * output is then empty, as after an abort.
 * Cost: about 15 microseconds for a tetrahedron of the result; 250 bytes at the peak.
 */
#ifndef cdmSteinerPointRefiner_h
#define cdmSteinerPointRefiner_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Warning.h"
#include "Core/Improvement/RefinementWork.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Sizing/TetrahedronLimits.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"

namespace cdm
{
struct SteinerPointRefinerOptions
{
  /** Circumradius to shortest edge. 0 (off) or at least 1. */
  double RadiusEdgeRatio = 1.4;
  /**
   * Tetrahedra with a smaller dihedral angle are slivers. Degrees; 0: off. Any value is taken as it
   * is. Up to 20 are reached nearly everywhere; the filters allow up to 40.
   */
  double DihedralAngleTarget = 15.0;
  /**
   * Layers whose facets are at least so many times as wide as the layer is thick are not filled with
   * well shaped tetrahedra, see ThinLayers.h. 0: 20 beside another region, 100 where there is none;
   * or at least 1.
   */
  double LayerAspectRatio = 0.0;
  /**
   * At least so many tetrahedra lie one after another across each layer that is not thin, see
   * LayerThickness.h. At least 1.
   */
  int TetrahedraAcrossLayers = 1;
  /** Cubic model units; 0: off. */
  double MaximumVolume = 0.0;
  /** Model units; 0: off. */
  double MaximumEdgeLength = 0.0;
  /** Free points closer to another one are taken out. Model units; 0: off. */
  double MinimumEdgeLength = 0.0;
  /** Delaunay counts as SmallestSphere. */
  SurfaceCriterion Criterion = SurfaceCriterion::SmallestSphere;
  /** What counts as flat, see StructuralEdges.h. */
  StructuralEdgeOptions StructuralEdges;
  /**
   * The refinement stops when it has made about this many points. 0: no limit if sizes, or more than
   * one tetrahedron across layers, are asked for, otherwise 50000 and 200 for each point of the mesh. Shapes that need more can hardly be
   * reached.
   */
  Id MaximumNewPoints = 0;
  /**
   * The refinement stops after so many seconds: the mesh is valid, and misses what was not done by
   * then. Checks and the last mesh come on top of it. 0: off. A result that took as long depends on
   * the machine.
   */
  double MaximumTime = 0.0;
  /** Rounds of OptimalDelaunaySmoothing.h. 0: none. */
  int SmoothingRounds = 0;
};

struct SteinerPointRefinerInput
{
  const TetMesh* Mesh = nullptr;
  /**
   * May be null: then the boundary consists of the outer and interface facets. A given boundary has
   * these, and sheets inside of regions that are to be kept. It has labels and the points of the
   * mesh.
   */
  const TriangleMesh* Boundary = nullptr;
  /** Tetrahedra with an edge longer than the sizing are too large. May be empty. */
  SizingField Sizing;
  /**
   * Empty, or one for each point of the mesh: whether it may be moved and removed if inside, or
   * moved in its facet or along its edge if on the surface.
   */
  std::vector<char> IsFree;
  /** Whether all points inside may be moved and removed. */
  bool AreInteriorPointsFree = false;
  /** Empty, or one for each point of the mesh: whether it is to be taken out if inside. */
  std::vector<char> IsRemoved;
  /** Points to be put in; those outside of all regions or on the boundary are left out. */
  std::vector<Vec3> NewPoints;
};

/** What is wrong with a tetrahedron. */
enum class SteinerFault : unsigned char
{
  None = 0,
  /** Too large. */
  Size = 1,
  /** Its ratio of circumradius to shortest edge is too large. */
  Shape = 2,
  /** Its smallest dihedral angle is below the target. */
  Sliver = 3,
  /**
   * Badly shaped or a sliver, but with points on both sides of a sharp input angle or of a thin
   * layer (SharpAngles.h, ThinLayers.h).
   */
  Inevitable = 4
};

struct SteinerPointRefinerReport
{
  /** Points made on the boundary, and inside. */
  Id BoundaryPoints = 0;
  Id InteriorPoints = 0;
  Id MovedPoints = 0;
  Id RemovedPoints = 0;
  Id Rounds = 0;
  /** Tetrahedra by their SteinerFault. */
  Id TooLarge = 0;
  Id BadlyShaped = 0;
  Id Slivers = 0;
  Id Inevitable = 0;
  /** Triangles of the boundary that break the criterion; see DelaunaySurfaceRefiner.h. */
  Id UnresolvedTriangles = 0;
  /**
   * Unresolved triangles whose smallest spheres are not empty. If there are any, the volume is not
   * refined.
   */
  Id WeakTriangles = 0;
  /** Whether MaximumTime was over before all was done. */
  bool IsLate = false;
  /** Edges of the boundary with a negative coupling. */
  Id NegativeCouplings = 0;
  /** What all rounds have made and looked at. */
  RefinementWork Work;
};

struct SteinerPointRefinerOutput
{
  /** Points: those of the input that are kept, in their order, then new and moved ones. */
  TetMesh Mesh;
  /** Input point of each point; NoId for new and moved ones. */
  std::vector<Id> PointSources;
  /** One for each point, as in the input: those that were free, and those made here. */
  std::vector<char> IsFree;
  /**
   * The refined boundary, on the points of the mesh, with labels. SourceCells: triangles of the
   * boundary given, or the tetrahedra behind them.
   */
  TriangleMesh Boundary;
  /** One for each tetrahedron. */
  std::vector<SteinerFault> Faults;
  SteinerPointRefinerReport Report;
  std::vector<Warning> Warnings;
};

Status RefineBySteinerPoints(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context,
  SteinerPointRefinerOutput& output);
} // namespace cdm

#endif
