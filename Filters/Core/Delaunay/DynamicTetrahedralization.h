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
 * Cost: microseconds for an insertion, a few hundred for a removal; 44 bytes per tetrahedron and 32
 * per point beside the mesh.
 *
 * Reference: O. Devillers, M. Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
 * triangulations", 2011, doi:10.1016/j.comgeo.2010.09.010 (removal in perturbed triangulations).
 */
#ifndef cdmDynamicTetrahedralization_h
#define cdmDynamicTetrahedralization_h

#include "Core/Delaunay/CavityFilling.h"
#include "Core/Meshes/TetMesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cdm
{
class DynamicTetrahedralization
{
public:
  /** The cavity of a point: what its insertion replaces. */
  struct PointCavity
  {
    std::vector<Id> Tetrahedra;
    /** Facets around the cavity; the point lies in front of each. */
    std::vector<TriangleIds> Facets;
    /** Facet ids of the tetrahedra beyond, NoId at the outer boundary. */
    std::vector<Id> Outer;
  };

  explicit DynamicTetrahedralization(TetMesh mesh);

  /**
   * The mesh with unused slots: dead tetrahedra have NoId as vertex 0, and removed points have no
   * tetrahedron.
   */
  const TetMesh& GetMesh() const { return this->Mesh; }
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
  /** A tetrahedron at the point, or NoId. */
  Id GetTetrahedronAt(Id point) const { return this->PointTetrahedra[point]; }
  /** Whether a facet lies between two regions or at the outside: it is never removed. */
  bool IsBoundary(Id tetrahedron, int facet) const;

  /**
   * Lists all tetrahedra at a point. False if the point lies on a boundary: then only those up to
   * there are listed.
   */
  bool FindStar(Id point, std::vector<Id>& star);

  /**
   * Finds the tetrahedron that holds a position, by a straight walk that stays in the region of the
   * first one. NoId if a boundary is in the way, or if cospherical sets lead the walk in a circle.
   */
  Id Locate(const Vec3& position, Id first) const;

  /** Whether a point with the given number lies in the (pulled) circumsphere of a tetrahedron. */
  bool IsInConflict(Id tetrahedron, const Vec3& position, Id number) const;

  /**
   * Finds the cavity of a point with the given number. The search starts from a tetrahedron whose
   * circumsphere holds the point. False if the point cannot be inserted: it is not in conflict with
   * the first tetrahedron, a boundary facet would vanish, or the point lies on or beyond one.
   */
  bool FindCavity(const Vec3& position, Id number, Id first, PointCavity& cavity);
  /**
   * The same, for a caller who has no use for most cavities.
   * @param accepts is called with each facet of the cavity, in their order, as soon as it is found.
   *   If it returns false, the search ends and returns false
   */
  template <typename Accepts>
  bool FindCavity(
    const Vec3& position, Id number, Id first, PointCavity& cavity, Accepts&& accepts);

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
   * Undoes the last removal, as long as nothing else has been changed: all tetrahedra get back
   * their slots and stamps.
   */
  void UndoRemove();

  /** Moves a point, before the caller replaces all tetrahedra that this changes. */
  void SetPoint(Id point, const Vec3& position) { this->Mesh.Points[point] = position; }
  /**
   * Replaces tetrahedra by cells.
   * @param outer for each facet of the border of the cavity that the cells fill: the facet id of
   *   the tetrahedron beyond, NoId at the outer boundary
   */
  void Replace(const std::vector<Id>& tetrahedra, const std::vector<Id>& outer,
    const std::vector<CavityFilling::Cell>& cells);

  /** Makes a facet an outer one: the outside replaces what lay beyond. */
  void MakeOuter(Id facet) { this->Mesh.Neighbors[facet / 4][facet % 4] = NoId; }

  /** The tetrahedra made by the last change. */
  const std::vector<Id>& GetChanged() const { return this->Changed; }

private:
  Id Make(const TetrahedronIds& ids, Id region);
  void Kill(Id tetrahedron);
  void Fill(Id point, const PointCavity& cavity);
  bool IsVisible(const PointCavity& cavity, const Vec3& position) const;
  /** Stamp of a new search; marks of older ones do not count. */
  std::uint32_t StartSearch();

  TetMesh Mesh;
  std::vector<std::int64_t> Stamps;
  std::int64_t NextStamp = 0;
  std::vector<Id> PointTetrahedra;
  std::vector<Id> Free;
  std::vector<Id> Changed;
  /** Marks of tetrahedra: search * 2, plus 1 if in conflict. */
  std::vector<std::uint32_t> Marks;
  std::uint32_t Search = 0;
  /** Work space. */
  std::vector<Id> Star;
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
  /** Facets at a new point, by their edges in the cavity: smaller id * 2^32 + larger one. */
  std::vector<std::pair<std::uint64_t, Id>> Facets;
  CavityFilling Filling;
};

template <typename Accepts>
bool DynamicTetrahedralization::FindCavity(
  const Vec3& position, Id number, Id first, PointCavity& cavity, Accepts&& accepts)
{
  cavity.Tetrahedra.clear();
  cavity.Facets.clear();
  cavity.Outer.clear();
  if (!this->IsInConflict(first, position, number))
  {
    return false;
  }
  const std::uint32_t stays = this->StartSearch();
  const std::uint32_t removed = stays + 1;
  cavity.Tetrahedra.push_back(first);
  this->Marks[first] = removed;
  for (std::size_t k = 0; k < cavity.Tetrahedra.size(); ++k)
  {
    const Id t = cavity.Tetrahedra[k];
    for (int i = 0; i < 4; ++i)
    {
      const Id outer = this->Mesh.Neighbors[t][i];
      bool isBorder = true;
      if (outer != NoId)
      {
        std::uint32_t& mark = this->Marks[outer / 4];
        const bool isNew = mark != stays && mark != removed;
        if (isNew)
        {
          mark = this->IsInConflict(outer / 4, position, number) ? removed : stays;
        }
        isBorder = mark == stays;
        if (!isBorder && this->IsBoundary(t, i))
        {
          return false;
        }
        if (isNew && !isBorder)
        {
          cavity.Tetrahedra.push_back(outer / 4);
        }
      }
      if (isBorder)
      {
        const TriangleIds facet = GetFacet(this->Mesh.Tetrahedra[t], i);
        cavity.Facets.push_back({ facet[0], facet[2], facet[1] });
        cavity.Outer.push_back(outer);
        if (!accepts(cavity.Facets.back()))
        {
          return false;
        }
      }
    }
  }
  // Facets inside of a region are in front of the point by themselves.
  return this->IsVisible(cavity, position);
}
} // namespace cdm

#endif
