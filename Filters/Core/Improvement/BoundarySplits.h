// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundarySplits.h
 * @brief Splits triangles and edges of the boundary of a Delaunay mesh, in the mesh itself.
 *
 * Method, for one triangle or edge after the other:
 *  1. the surface is refined (SurfaceRefinement.h) until it fulfils its criterion again; diagonals
 *     of cocircular points are flipped to those of the pulling rule;
 *  2. all tetrahedra in conflict with its new points, whatever their region, leave a cavity; it is
 *     filled anew, the surface's new triangles and the interfaces that stay being walls: with a cone
 *     (CavityCone.h) for one new point and no ties, otherwise with what CavityFilling.h finds.
 *
 * The surface does not depend on the tetrahedra: with two threads one is ahead with the surface,
 * and the other one lets the mesh follow (HandOver.h).
 *
 * Guarantees: after a run surface and mesh fit each other. Exact; the mesh is the one that would be
 * made anew of the same points (AdvancingFrontTetrahedralizer.h), whatever the number of threads.
 * Cost: 30 to 60 microseconds for a split, whatever the size of the mesh; the first run tests all of
 * the surface.
 */
#ifndef cdmBoundarySplits_h
#define cdmBoundarySplits_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Delaunay/CavityCone.h"
#include "Core/Delaunay/CavityFilling.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Surface/SurfaceRefinement.h"

#include <functional>
#include <vector>

namespace cdm
{
/** Points that may have come, gone or moved since the last splits; ascending. */
struct ChangedPoints
{
  std::vector<Id> OnSurface;
  std::vector<Id> Inside;
};

class BoundarySplits
{
public:
  /**
   * All have to outlive the object.
   * @param mesh has the surface's points first, then reserved ids for new ones, then interior
   *   points
   * @param firstInside id of the first interior point
   * @param surface all outer and interface facets of the mesh; with labels and source cells
   * @param edges structural edges, sorted
   * @param options those that the surface was refined with
   */
  BoundarySplits(DynamicTetrahedralization& mesh, Id firstInside, TriangleMesh& surface,
    std::vector<StructuralEdge>& edges, const DelaunaySurfaceRefinerOptions& options,
    const SizingField& sizing);

  /**
   * Splits the given triangles and edges. First the mesh follows the points that have changed since
   * the object was made, or the last run: interior points that have come or gone, and points of the
   * surface that were moved, in the surface or in both. Triangles that have got a new point at them by then, and edges that are
   * split already, are left out. If the mesh has to be made anew, the lists keep what is left,
   * beginning with the split that failed. That happens when no reserved id is left, when
   * rounding has made something that does not fit, or when the splits take far more points than they
   * are. The object cannot be used any more then.
   */
  Status Run(const ChangedPoints& changed, std::vector<Id>& triangles, std::vector<EdgeIds>& edges,
    const ExecutionContext& context);
  bool IsUsable() const { return this->CanGoOn; }
  /** Whether that is because the last run took far more points than it had splits to make. */
  bool HasRunAway() const { return this->RanAway; }
  /** Interior points have got higher ids: DynamicTetrahedralization::ReservePoints(). */
  void SetFirstInside(Id firstInside) { this->FirstInside = firstInside; }

  /** Tetrahedra that the last run has made; some may be gone again. */
  const std::vector<Id>& GetChanged() const { return this->Changed; }
  /** Triangles of the surface that the last run has made or may have changed, ascending. */
  const std::vector<Id>& GetChangedTriangles() const { return this->ChangedTriangles; }
  /** The same for structural edges, by their indices. */
  const std::vector<Id>& GetChangedEdges() const { return this->ChangedEdges; }
  /** For each structural edge its segment, which keeps its number. At first that is its index. */
  const std::vector<Id>& GetSegments() const { return this->Segments; }

private:
  /** A triangle of the surface after the split. */
  struct NewTriangle
  {
    Id Index;
    TriangleIds Ids;
    RegionPair Labels;
    Id Source;
  };
  /** What a split has done to the surface, for the mesh to follow. */
  struct SurfaceChange
  {
    /** New points of the surface, in the order of their ids. */
    std::vector<Vec3> Points;
    /** Triangles that may have changed, as they are after the split; their indices ascend. */
    std::vector<NewTriangle> Triangles;
    /** The number of all triangles of the surface after the split. */
    std::size_t NumberOfTriangles = 0;
    /** The number of edges and triangles that had been split, or left out, before. */
    std::size_t Place = 0;
    /** Whether the mesh may follow. */
    bool IsPossible = false;
    /** Whether the splits have run away, so that the mesh may not follow: see MostPerSplit. */
    bool HasRunAway = false;
  };

  // The surface, on the calling thread.
  Status FollowPoints(const ChangedPoints& changed, const ExecutionContext& context);
  Status Split(const std::vector<Id>& triangles, const std::vector<EdgeIds>& edges,
    const ExecutionContext& context, const std::function<bool(SurfaceChange)>& put);
  SurfaceChange TakeChange(std::size_t place);
  Id FindSegment(const EdgeIds& edge) const;
  TriangleIds Translate(const TriangleIds& refined) const;

  // The mesh, which follows.
  bool Follow(const SurfaceChange& change);
  void CollectTriangles(const SurfaceChange& change);
  bool CollectConflicts(const SurfaceChange& change);
  void CollectCavity();
  void CollectPoints(const std::vector<Vec3>& points);
  const Vec3& GetPosition(Id point, const std::vector<Vec3>& points) const;
  bool FillByCone(const std::vector<Vec3>& points);
  bool AreWallsComplete();
  Id GetRegionInFront(const TriangleIds& ids) const;
  bool FindSides(const TriangleIds& ids);
  void Visit(Id tetrahedron, Id point, const Vec3& position);
  void Adopt(const SurfaceChange& change, const std::vector<CavityCell>& cells);

  std::vector<std::pair<EdgeIds, Id>> FindChangedSegments();
  void UpdateEdges();

  DynamicTetrahedralization& Mesh;
  Id FirstInside;
  TriangleMesh& Surface;
  std::vector<StructuralEdge>& Edges;
  SurfaceRefinement Refinement;
  bool CanGoOn = true;
  /** See HasRunAway(). */
  bool RanAway = false;
  /** SourceCells of the surface when the object was made. */
  const std::vector<Id> SourceCells;
  /** For each structural edge its segment in the refinement. */
  std::vector<Id> Segments;
  /** For each segment its edge, as it is listed. */
  std::vector<EdgeIds> SegmentEdges;
  /** Point of the refinement for each point of the surface, and for each point inside, or NoId. */
  std::vector<Id> RefinementSurfacePoints;
  std::vector<Id> RefinementPoints;
  /** Point of the surface for each point of the refinement, or NoId. */
  std::vector<Id> SurfacePoints;
  /** The id that the next new point of the surface gets. */
  Id NextPoint = 0;
  std::vector<Id> Changed;
  std::vector<Id> ChangedTriangles;
  std::vector<Id> ChangedEdges;
  /** Points of the surface, ascending, that have not been moved in the mesh yet. */
  std::vector<Id> Moved;

  /** Work space of one split. */
  std::vector<NewTriangle> Triangles;
  /** Points of triangles that are no longer there, and of new ones; each sorted. */
  std::vector<TriangleIds> Vanished;
  std::vector<TriangleIds> Made;
  /** For each one that was made its index in Triangles. */
  std::vector<std::size_t> MadeFrom;
  /** Facets of tetrahedra at vanished triangles; the tetrahedra that are replaced. */
  std::vector<Id> Sides;
  std::vector<Id> Tetrahedra;
  std::vector<char> IsInCavity;
  /** Searches that have come to a tetrahedron. */
  std::vector<Id> Visits;
  Id Search = 0;
  std::vector<Id> Open;
  Cavity Around;
  /** Whether the cone from a new point may not fill the cavity. */
  bool IsNoCone = false;
  std::vector<Id> Outer;
  /** Facets of tetrahedra beyond the cavity that have become outer ones. */
  std::vector<Id> Bared;
  /**
   * For each wall, by its sorted points: a region that has to be at it, and one that was found
   * there.
   */
  std::vector<std::pair<TriangleIds, Id>> WallRegions;
  std::vector<std::pair<TriangleIds, Id>> FoundRegions;
  CavityFilling Filling;
  CavityCone Cone;
  /** Marks changed segments; edges and segments as they were before. */
  std::vector<char> IsChangedSegment;
  std::vector<StructuralEdge> FormerEdges;
  std::vector<Id> FormerSegments;
};
} // namespace cdm

#endif
