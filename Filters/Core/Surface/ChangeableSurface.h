// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChangeableSurface.h
 * @brief A surface that takes small changes only if it stays what it is: its topology, its facets
 * and chains, its place within a bound, and free of intersections.
 *
 * A change replaces a few triangles at a point or an edge by others: a collapse, a split, a flip or
 * a move. TryChange() does it if
 *  1. no new triangle is degenerate or bends against a neighbor of its facet by more than 60
 *     degrees, but where triangles do already and the new ones do not turn by more than that;
 *  2. the new triangles meet no others, decided exactly, no point lies in the tetrahedra between
 *     the old and the new ones, and around edges of three or more triangles the same spaces lie
 *     between them as before;
 *  3. facets and chains stay within the bound of the original ones, in both directions
 *     (DeviationBound.h).
 * The caller says which changes keep the topology: KeepsTopology() tells it for collapses.
 *
 * Inputs: the invariants of TriangleMesh.h; facets and chains as of StructuralEdges.h.
 * Cost: a change looks at the triangles around and at the pieces of the original that they are the
 * witnesses of. About 600 bytes per triangle.
 */
#ifndef cdmChangeableSurface_h
#define cdmChangeableSurface_h

#include "Core/Meshes/TriangleMesh.h"
#include "Core/Search/BoxOctree.h"
#include "Core/Surface/DeviationBound.h"
#include "Core/Surface/StructuralEdges.h"

#include <array>
#include <vector>

namespace cdm
{
/** A triangle in place of another, whose facet and orientation it takes. */
struct NewTriangle
{
  TriangleIds Points;
  /** One of the triangles that go. */
  Id Source;
};

struct SurfaceChange
{
  /** A point that moves or is new, and where it is afterwards; NoId: none. */
  Id Point = NoId;
  Vec3 Position;
  std::vector<Id> Removed;
  std::vector<NewTriangle> Added;
  /** Structural edges, by number; those in their place are of the same chain. */
  std::vector<Id> RemovedEdges;
  std::vector<EdgeIds> AddedEdges;
  /** Tetrahedra that fill what is between the old and the new triangles. */
  std::vector<std::array<Vec3, 4>> Swept;
};

class ChangeableSurface
{
public:
  /** facets: one for each triangle; bound: of the distance from the surface, > 0; threads: for it. */
  ChangeableSurface(const TriangleMesh& surface, const std::vector<Id>& facets,
    const std::vector<StructuralEdge>& edges, double bound, ThreadTeam& threads);

  const std::vector<Vec3>& GetPoints() const { return this->Points; }
  Id GetNumberOfTriangles() const { return static_cast<Id>(this->Triangles.size()); }
  bool IsTriangle(Id triangle) const { return this->Sources[triangle] != NoId; }
  const TriangleIds& GetTriangle(Id triangle) const { return this->Triangles[triangle]; }
  Id GetFacet(Id triangle) const { return this->Facets[triangle]; }
  /** The triangle of the input that a triangle takes labels and data from. */
  Id GetSource(Id triangle) const { return this->Sources[triangle]; }

  /** Triangles at a point; none where it was removed. */
  const std::vector<Id>& GetUses(Id point) const { return this->Uses[point]; }
  /** Triangles at an edge. */
  std::vector<Id> GetUses(const EdgeIds& edge) const;
  /** Points that share a triangle with this one, ascending. */
  std::vector<Id> GetNeighbors(Id point) const;
  bool Has(Id triangle, Id point) const;

  /** Numbers of the structural edges at a point. */
  const std::vector<Id>& GetEdges(Id point) const { return this->EdgesAt[point]; }
  const EdgeIds& GetEdge(Id edge) const { return this->Edges[edge]; }
  Id GetChain(Id edge) const { return this->Chains[edge]; }
  Id GetOtherEnd(Id edge, Id point) const
  {
    return this->Edges[edge][0] == point ? this->Edges[edge][1] : this->Edges[edge][0];
  }
  /** NoId where an edge is not structural. */
  Id FindEdge(const EdgeIds& edge) const;

  /** Whether a point may be merged into a neighbor: the link condition. */
  bool KeepsTopology(Id point, Id target) const;

  /** The next number of a point for a change that makes one. */
  Id GetNewPoint() const { return static_cast<Id>(this->Points.size()); }

  /** The nearest point of the original facet or chain that a point is on, within a reach. */
  bool FindNearestOriginal(Id point, const Vec3& position, double reach, Vec3& nearest) const;

  /** Does a change unless it breaks one of the rules above. */
  bool TryChange(const SurfaceChange& change);

  /** The nearest point of the original facet of a point, whose triangle is returned, or NoId. */
  Id FindOriginalTriangle(Id point, double reach, Vec3& nearest) const;

private:
  /** A triangle as it is after a change, and where its facet and spaces come from. */
  struct Around
  {
    TriangleIds Ids;
    Id Source;
  };

  bool KeepsAll(const SurfaceChange& change, const std::vector<Vec3>& oldNormals, double oldBend);
  bool KeepsBends(const SurfaceChange& change, double smallestCosine) const;
  bool MeetsNothing(const SurfaceChange& change) const;
  bool IsPassedOver(Id triangle, const SurfaceChange& change) const;
  bool KeepsSpaces(const SurfaceChange& change) const;
  bool KeepsBound(const SurfaceChange& change);
  void Commit(const SurfaceChange& change);
  void CommitEdges(const SurfaceChange& change);

  std::array<Vec3, 3> GetCorners(const TriangleIds& ids) const
  {
    return { this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]] };
  }
  Vec3 GetNormal(const TriangleIds& ids) const;
  /** Cosine of the angle by which two triangles bend at their common edge. */
  double GetBend(const TriangleIds& ids, const TriangleIds& other) const;
  double GetOldBend(const SurfaceChange& change) const;
  /** Triangles at an edge after a change. */
  std::vector<Around> FindAround(const SurfaceChange& change, const EdgeIds& edge) const;

  std::vector<Vec3> Points;
  std::vector<TriangleIds> Triangles;
  std::vector<Id> Facets;
  std::vector<Id> Sources;
  /** The spaces in front of and behind each triangle (SurfaceSides.h). */
  std::vector<RegionPair> Spaces;
  std::vector<std::vector<Id>> Uses;
  std::vector<EdgeIds> Edges;
  std::vector<Id> Chains;
  std::vector<std::vector<Id>> EdgesAt;
  BoxOctree Boxes;
  DeviationBound FacetBound;
  DeviationBound ChainBound;
  /** What KeepsBound() has proven last. */
  BoundChange FacetChange;
  BoundChange ChainChange;
  DeviationBound::ChangeProof FacetProof;
  DeviationBound::ChangeProof ChainProof;
};
} // namespace cdm

#endif
