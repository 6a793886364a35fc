// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DynamicTetrahedralization.h
 * @brief A conforming Delaunay mesh that points can be put into, taken out of, and moved in.
 *
 * Method:
 *  - insertion: the tetrahedra whose circumsphere holds the point are replaced by the cone from the
 *    point over the facets around them (Bowyer 1981, Watson 1981), if no facet between two regions
 *    is among what would vanish. Looking at that hole first (FindHole()) tells how good the mesh
 *    would be, before anything is changed;
 *  - removal: the tetrahedra around the point are replaced by the Delaunay tetrahedra of its
 *    neighbors that lie within the same hole;
 *  - points on one sphere are told apart by the pulling rule of their numbers, which are their ids:
 *    a mesh that is Delaunay by this rule is at any time the one that stage 3 makes of the same
 *    points in the same order. One whose cospherical sets are split in another way stays Delaunay
 *    too: a new tetrahedron's sphere lies within the spheres of those on both sides of its facet.
 *
 * Requires: a Delaunay mesh with the invariants of TetMesh.h. Where a hole ends at an outer facet,
 * the smallest sphere of that has to be empty (Crit. 3.1), also of the point: then nothing beyond
 * it, which the mesh does not have, is in conflict with a point on this side.
 * Guarantees: these invariants; only points inside of a region are inserted, removed or moved, but
 * for Replace(), whose caller has to know that the cells fit.
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
  /** What an insertion replaces. */
  struct Hole
  {
    std::vector<Id> Tetrahedra;
    /** Around it; the point lies in front of each. */
    std::vector<TriangleIds> Facets;
    /** Facet ids of the tetrahedra beyond, NoId at the outer boundary. */
    std::vector<Id> Outer;
  };

  explicit DynamicTetrahedralization(TetMesh mesh);

  /**
   * Tetrahedra that are gone have the vertex NoId at place 0, points that are gone no tetrahedron.
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
  /** Of what is at this place: no other tetrahedron ever gets the same one. */
  std::int64_t GetStamp(Id tetrahedron) const { return this->Stamps[tetrahedron]; }
  /** A tetrahedron at the point, or NoId. */
  Id GetTetrahedronAt(Id point) const { return this->PointTetrahedra[point]; }
  /** Between two regions or at the outside: never removed. */
  bool IsBoundary(Id tetrahedron, int facet) const;

  /** All tetrahedra at a point; false if it lies on a boundary, then only those up to there. */
  bool FindStar(Id point, std::vector<Id>& star);

  /**
   * The tetrahedron that holds a position, by a straight walk that stays in the region of the
   * first one; NoId if a boundary is in the way, or if cospherical sets lead the walk in a circle.
   */
  Id Locate(const Vec3& position, Id first) const;

  /**
   * The hole of a point whose number is given, from a tetrahedron on whose sphere's inside it lies.
   * False if the point cannot be inserted: the first one is not in conflict, a boundary would
   * vanish, or the point lies on or beyond one.
   */
  bool FindHole(const Vec3& position, Id number, Id first, Hole& hole);

  /** Appends a point and returns its id. The hole must be that of this point and number. */
  Id Insert(const Vec3& position, const Hole& hole);
  /** Puts a point back that was removed, to another position. */
  void Restore(Id point, const Vec3& position, const Hole& hole);
  /**
   * False, and nothing changed, if the point lies on a boundary, or if cospherical neighbors are
   * not told apart by the pulling rule. The id stays reserved.
   */
  bool Remove(Id point);
  /**
   * Undoes the last removal, as long as nothing else has been changed: all tetrahedra are back in
   * their places, with their stamps.
   */
  void UndoRemove();

  /** A new place for a point, before all tetrahedra that this changes are replaced. */
  void SetPoint(Id point, const Vec3& position) { this->Mesh.Points[point] = position; }
  /**
   * Puts cells in the place of tetrahedra.
   * @param outer one for each facet of the border that the cells were found in: the facet id of the
   *   tetrahedron beyond, NoId at the outer boundary
   */
  void Replace(const std::vector<Id>& tetrahedra, const std::vector<Id>& outer,
    const std::vector<CavityFilling::Cell>& cells);

  /** What lay beyond a facet is replaced by the outside. */
  void MakeOuter(Id facet) { this->Mesh.Neighbors[facet / 4][facet % 4] = NoId; }

  /** The tetrahedra made by the last change. */
  const std::vector<Id>& GetChanged() const { return this->Changed; }

private:
  bool IsInConflict(Id tetrahedron, const Vec3& position, Id number) const;
  Id Make(const TetrahedronIds& ids, Id region);
  void Kill(Id tetrahedron);
  void Fill(Id point, const Hole& hole);
  /** Stamp of a new search; marks of older ones do not count. */
  std::uint32_t StartSearch();

  TetMesh Mesh;
  std::vector<std::int64_t> Stamps;
  std::int64_t NextStamp = 0;
  std::vector<Id> PointTetrahedra;
  std::vector<Id> Free;
  std::vector<Id> Changed;
  /** Search * 2, + 1 if in conflict. */
  std::vector<std::uint32_t> Marks;
  std::uint32_t Search = 0;
  /** Work space. */
  std::vector<Id> Star;
  /** A tetrahedron that the last removal has taken out. */
  struct Removed
  {
    Id Tetrahedron;
    TetrahedronIds Ids;
    std::array<Id, 4> Neighbors;
    std::int64_t Stamp;
  };
  std::vector<Removed> RemovedStar;
  Id RemovedRegion = NoId;
  /** How many free places there were before. */
  std::size_t FormerlyFree = 0;
  /** Facets at a new point, by their edges in the hole: smaller id * 2^32 + larger one. */
  std::vector<std::pair<std::uint64_t, Id>> Facets;
  CavityFilling Filling;
};
} // namespace cdm

#endif
