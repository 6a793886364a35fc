// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DynamicTetrahedralization.h
 * @brief A conforming Delaunay mesh in which points can be inserted, removed and moved.
 *
 * Method:
 *  - insertion: the tetrahedra whose circumsphere holds the point are replaced by the cone from the
 *    point over the facets around them (Bowyer 1981, Watson 1981), unless a facet between two
 *    regions would vanish. These tetrahedra are the cavity of the point (PointCavity). FindCavity()
 *    finds it before anything is changed, so that the new tetrahedra can be rated first;
 *  - removal: the tetrahedra around the point are replaced by the Delaunay tetrahedra of its
 *    neighbors that lie within the same cavity;
 *  - points on one sphere are told apart by the pulling rule of their numbers, which are their ids:
 *    a mesh that is Delaunay by this rule is at any time the one that stage 3 makes of the same
 *    points in the same order. One whose cospherical sets are split in another way stays Delaunay
 *    too: a new tetrahedron's sphere lies within the spheres of those on both sides of its facet.
 *
 * Requires: a Delaunay mesh with the invariants of TetMesh.h. Where a cavity ends at an outer
 * facet, the smallest sphere of that facet has to be empty (Crit. 3.1), also of the new point. Then
 * no point beyond the facet, which the mesh does not know, is in conflict with a point on this
 * side. Guarantees: these invariants. Only points inside of a region are inserted, removed or
 * moved; the exception is Replace(), whose caller has to know that the cells fit.
 * Cost: microseconds for an insertion, a few hundred for a removal; 14 bytes per tetrahedron and 4
 * per point beside the mesh.
 *
 * Reference: O. Devillers, M. Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
 * triangulations", 2011, doi:10.1016/j.comgeo.2010.09.010 (removal in perturbed triangulations).
 */
#ifndef cdmDynamicTetrahedralization_h
#define cdmDynamicTetrahedralization_h

#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/CavityFilling.h"
#include "Core/Delaunay/CavitySearch.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
/** A moment of a mesh that changes, to find what has been made since; by default its beginning. */
struct MeshMoment
{
  /** Tetrahedra that are made from then on have this stamp or a later one. */
  std::int64_t NextStamp = 0;
  /** How many tetrahedra had been made by then; negative: none, not even those it begins with. */
  std::int64_t NumberMade = -1;
};

class DynamicTetrahedralization
{
public:
  explicit DynamicTetrahedralization(TetMesh mesh);
  DynamicTetrahedralization(const DynamicTetrahedralization&) = delete;
  DynamicTetrahedralization& operator=(const DynamicTetrahedralization&) = delete;

  /**
   * The mesh with unused slots: dead tetrahedra have NoId as vertex 0, and removed points have no
   * tetrahedron.
   */
  const TetMesh& GetMesh() const { return this->Mesh; }
  /** Gives the mesh away; only GetTetrahedronAt() tells anything from then on. */
  TetMesh TakeMesh() { return std::move(this->Mesh); }
  const Vec3& GetPoint(Id point) const { return this->Mesh.Points[point]; }
  std::array<Vec3, 4> GetCorners(Id tetrahedron) const
  {
    return cdm::GetCorners(this->Mesh.Points, this->Mesh.Tetrahedra[tetrahedron]);
  }
  Id GetNumberOfPoints() const { return static_cast<Id>(this->Mesh.Points.size()); }
  Id GetNumberOfTetrahedra() const { return static_cast<Id>(this->Mesh.Tetrahedra.size()); }
  bool IsDead(Id tetrahedron) const { return this->Mesh.Tetrahedra[tetrahedron][0] == NoId; }
  /**
   * A stamp that identifies the tetrahedron in this slot: no other one ever gets the same stamp.
   */
  std::int64_t GetStamp(Id tetrahedron) const { return this->Stamps[tetrahedron]; }
  /** The stamp of the next tetrahedron that is made: those of older ones are smaller. */
  std::int64_t GetNextStamp() const { return this->NextStamp; }
  MeshMoment GetMoment() const { return { this->NextStamp, this->CountMade() }; }
  /** The moment before the last change made its tetrahedra. */
  MeshMoment GetMomentBeforeChange() const
  {
    const auto count = static_cast<std::int64_t>(this->Changed.size());
    const std::int64_t first = count > 0 ? this->GetStamp(this->Changed.front()) : this->NextStamp;
    return { first, this->CountMade() - count };
  }
  /** Whether the slot has a tetrahedron that was made since a moment. */
  bool IsMadeSince(const MeshMoment& moment, Id tetrahedron) const
  {
    return this->GetStamp(tetrahedron) >= moment.NextStamp && !this->IsDead(tetrahedron);
  }
  /** A tetrahedron at the point, or NoId. */
  Id GetTetrahedronAt(Id point) const { return this->PointTetrahedra[point]; }
  /** Whether a facet lies between two regions or at the outside: it is never removed. */
  bool IsBoundary(Id tetrahedron, int facet) const
  {
    return this->Search.IsBoundary(tetrahedron, facet);
  }

  /**
   * Lists the tetrahedra at a point, whatever their region, in no order; the search ends with more
   * than most of them. Where bodies touch at the point, it finds those of one only.
   * @return whether it has come to its end
   */
  bool FindWholeStar(Id point, std::size_t most, std::vector<Id>& star) const;
  /** These four do what CavitySearch says, in this mesh. */
  bool FindStar(Id point, std::vector<Id>& star) { return this->Search.FindStar(point, star); }
  Id Locate(const Vec3& position, Id first) { return this->Search.Locate(position, first); }
  bool IsInConflict(Id tetrahedron, const Vec3& position, Id number) const
  {
    return this->Search.IsInConflict(tetrahedron, position, number);
  }
  bool FindCavity(const Vec3& position, Id number, Id first, PointCavity& cavity)
  {
    return this->Search.FindCavity(position, number, first, cavity);
  }
  /** A search for a thread of its own, while the mesh does not change. */
  CavitySearch MakeSearch(bool isRecording) const
  {
    return { this->Mesh, this->PointTetrahedra, isRecording };
  }

  /** Appends a point and returns its id. The cavity must be that of this point and number. */
  Id Insert(const Vec3& position, const PointCavity& cavity);
  /** Inserts a removed point again, at another position. */
  void Restore(Id point, const Vec3& position, const PointCavity& cavity);
  /**
   * Removes a point; its id stays reserved. False, and nothing is changed, if the point lies on a
   * boundary, or if cospherical neighbors are not split by the pulling rule.
   */
  bool Remove(Id point);
  /**
   * Removes a point that a search has left out, with the star and the cells that it had then. The
   * tetrahedra around the point have to be the same as then.
   */
  void Remove(Id point, const std::vector<Id>& star, const std::vector<CavityCell>& cells);
  /**
   * Gives the cells in a cavity that a search has found the numbers of the tetrahedra which the
   * removal, the last change, has made of them.
   * @param firstCell the first number of a cell in the search
   */
  void NumberCells(Id firstCell, PointCavity& cavity) const;
  /**
   * Undoes the last removal, as long as nothing else has been changed: all tetrahedra get back
   * their slots and stamps.
   */
  void UndoRemove();

  /**
   * Inserts point ids that no tetrahedron uses before a point: this one and all after it get higher
   * ids. A removal before it cannot be undone any more.
   */
  void ReservePoints(Id first, Id count);
  /** Moves a point, before the caller replaces all tetrahedra that this changes. */
  void SetPoint(Id point, const Vec3& position) { this->Mesh.Points[point] = position; }
  /**
   * Replaces tetrahedra by cells.
   * @param outer for each facet of the border of the cavity that the cells fill: the facet id of
   *   the tetrahedron beyond, NoId at the outer boundary
   */
  void Replace(const std::vector<Id>& tetrahedra, const std::vector<Id>& outer,
    const std::vector<CavityCell>& cells);

  /** Makes a facet an outer one: the outside replaces what lay beyond. */
  void MakeOuter(Id facet);

  /** The tetrahedra made by the last change. */
  const std::vector<Id>& GetChanged() const { return this->Changed; }
  /** How many tetrahedra have been made so far, those that are gone included. */
  std::int64_t CountMade() const
  {
    return this->FirstNoted + static_cast<std::int64_t>(this->Noted.size());
  }
  /**
   * Calls visit(slot) for the slots of all tetrahedra that have been made since a moment, once each,
   * ascending. If that is too long ago to be known, all slots are visited.
   * @param marks work space, as for VisitAscending()
   */
  template <typename Visitor>
  void VisitMadeSince(
    const MeshMoment& moment, std::vector<std::uint64_t>& marks, Visitor&& visit) const
  {
    if (moment.NumberMade < this->FirstNoted)
    {
      for (Id t = 0; t < this->GetNumberOfTetrahedra(); ++t)
      {
        visit(t);
      }
      return;
    }
    VisitAscending(this->Noted.begin() + (moment.NumberMade - this->FirstNoted), this->Noted.end(),
      marks, visit);
  }

private:
  Id Make(const TetrahedronIds& ids, Id region);
  void Kill(Id tetrahedron);
  void Note(Id tetrahedron);
  void Fill(Id point, const PointCavity& cavity);

  TetMesh Mesh;
  std::vector<std::int64_t> Stamps;
  std::int64_t NextStamp = 0;
  std::vector<Id> PointTetrahedra;
  std::vector<Id> Free;
  std::vector<Id> Changed;
  /** Slots of the last tetrahedra that were made, and how many were made before these. */
  std::vector<Id> Noted;
  std::int64_t FirstNoted = 0;
  CavitySearch Search;
  /** A tetrahedron that the last removal has removed. */
  struct Removed
  {
    Id Tetrahedron;
    TetrahedronIds Ids;
    std::array<Id, 4> Neighbors;
    std::int64_t Stamp;
  };
  std::vector<Removed> RemovedStar;
  Id RemovedRegion = NoId;
  /** Number of free slots before the last removal. */
  std::size_t FormerlyFree = 0;
  /**
   * The facets through a new point and an edge of its cavity, where two new tetrahedra meet: a hash
   * table by open addressing.
   */
  class FacetsAtEdges
  {
  public:
    /** Forgets all facets. */
    void Start(std::size_t numberOfEdges);
    /** The facet that was given for the edge before, or NoId. */
    Id Match(const EdgeIds& edge, Id facet);

  private:
    static constexpr std::uint64_t NoEdge = ~std::uint64_t{ 0 };
    std::vector<std::pair<std::uint64_t, Id>> Places;
  };
  FacetsAtEdges Facets;
};
} // namespace cdm

#endif
