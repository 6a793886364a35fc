// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CavitySearch.h
 * @brief Searches a Delaunay mesh for what a point would replace, without changing the mesh; also
 * as if one of its points were not there.
 *
 * Several searches may look at the same mesh at the same time, one on each thread, as long as
 * nobody changes it.
 *
 * Method: the cavity of a point is flooded from a tetrahedron whose circumsphere holds the point
 * (Bowyer 1981, Watson 1981). A point that is left out is replaced, for this search only, by cells:
 * the Delaunay tetrahedra of its neighbors within the same cavity (CavityFilling.h). They are
 * numbered after the tetrahedra of the mesh, and hide those around the point.
 *
 * Guarantees: what a search finds is what the changed mesh would have, in the same order. See
 * DynamicTetrahedralization.h for what the mesh has to be. Cost: 4 bytes for each tetrahedron.
 */
#ifndef cdmCavitySearch_h
#define cdmCavitySearch_h

#include "Core/Basics/ThreadTeam.h"
#include "Core/Delaunay/CavityFilling.h"
#include "Core/Meshes/TetMesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cdm
{
/** The cavity of a point: what its insertion replaces. */
struct PointCavity
{
  std::vector<Id> Tetrahedra;
  /** Facets around the cavity; the point lies in front of each. */
  std::vector<TriangleIds> Facets;
  /** For each of these facets its id in a tetrahedron of the cavity. */
  std::vector<Id> Inner;
  /** Facet ids of the tetrahedra beyond, NoId at the outer boundary. */
  std::vector<Id> Outer;
};

class alignas(SeparateLines) CavitySearch
{
public:
  /**
   * Both have to outlive the search.
   * @param pointTetrahedra a tetrahedron at each point, or NoId
   * @param isRecording whether the search notes which tetrahedra it visits
   */
  CavitySearch(
    const TetMesh& mesh, const std::vector<Id>& pointTetrahedra, bool isRecording = false)
    : Mesh(mesh), PointTetrahedra(pointTetrahedra), IsRecording(isRecording)
  {
  }

  /** Whether a facet lies between two regions or at the outside. */
  bool IsBoundary(Id tetrahedron, int facet) const;

  /**
   * Lists all tetrahedra at a point. False if the point lies on a boundary: then only those up to
   * there are listed. No point may be left out.
   */
  bool FindStar(Id point, std::vector<Id>& star);

  /**
   * Finds the tetrahedron that holds a position, by a straight walk that stays in the region of the
   * first one. NoId if a boundary is in the way, or if cospherical sets lead the walk in a circle.
   */
  Id Locate(const Vec3& position, Id first);

  /** Whether a point with the given number lies in the (pulled) circumsphere of a tetrahedron. */
  bool IsInConflict(Id tetrahedron, const Vec3& position, Id number) const;

  /**
   * Finds the cavity of a point with the given number. The search starts from a tetrahedron whose
   * circumsphere holds the point. False if the point cannot be inserted: it is not in conflict with
   * the first tetrahedron, a boundary facet would vanish, or the point lies on or beyond one.
   */
  bool FindCavity(const Vec3& position, Id number, Id first, PointCavity& cavity)
  {
    return this->FindCavity(position, number, first, cavity, [] { return true; });
  }
  /**
   * The same, for a caller who has no use for most cavities.
   * @param accepts is called as soon as a facet of the cavity is found, the last one of its lists.
   *   If it returns false, the search ends and returns false
   */
  template <typename Accepts>
  bool FindCavity(
    const Vec3& position, Id number, Id first, PointCavity& cavity, Accepts&& accepts);

  /** Whether a facet would be around the cavity of a point that reaches it; its id is Inner. */
  bool IsAroundCavity(Id facet, const Vec3& position, Id number);

  /**
   * Leaves a point out from now on. False, and it is not, if the point lies on a boundary, or if
   * cospherical neighbors are not split by the pulling rule. The mesh must not change until
   * TakeBack() is called.
   */
  bool LeaveOut(Id point);
  void TakeBack();
  /** The tetrahedra around the point that is left out; border facet i of the cells is of the i-th. */
  const std::vector<Id>& GetStar() const { return this->Star; }
  /** The cells that replace them; cell i is the tetrahedron GetFirstCell() + i. */
  const std::vector<CavityCell>& GetCells() const { return this->Filling.GetCells(); }
  Id GetFirstCell() const { return static_cast<Id>(this->Mesh.Tetrahedra.size()); }
  /** Points of a tetrahedron, or of a cell. */
  const TetrahedronIds& GetIds(Id tetrahedron) const
  {
    const Id cell = tetrahedron - this->GetFirstCell();
    return cell < 0 ? this->Mesh.Tetrahedra[tetrahedron] : this->GetCells()[cell].Ids;
  }

  /** Forgets the visits so far. */
  void StartRecord();
  /**
   * The tetrahedra that were visited since then, some maybe twice. If none of them has been replaced
   * meanwhile, the same searches would find the same.
   */
  const std::vector<Id>& GetVisited() const { return this->Visited; }

private:
  /** Marks from here on are hidden tetrahedra: their index in the star is added. */
  static constexpr std::uint32_t FirstHidden = 1U << 31;

  Id GetRegion(Id tetrahedron) const
  {
    return tetrahedron < this->GetFirstCell() ? this->Mesh.Regions[tetrahedron]
                                              : this->HiddenRegion;
  }
  Id GetNeighbor(Id tetrahedron, int facet) const;
  /** Stamp of a new search; marks of older ones do not count. */
  std::uint32_t StartSearch();
  bool IsVisible(const PointCavity& cavity, const Vec3& position) const;
  /** Notes a tetrahedron if visits are recorded; before it is marked. */
  void Visit(Id tetrahedron);

  const TetMesh& Mesh;
  const std::vector<Id>& PointTetrahedra;
  const bool IsRecording;
  /** Marks of tetrahedra: search * 2, plus 1 if in conflict. */
  std::vector<std::uint32_t> Marks;
  std::uint32_t Search = 0;
  /** The tetrahedra around the point that is left out, and their region. */
  std::vector<Id> Star;
  Id HiddenRegion = NoId;
  CavityFilling Filling;
  /** Work space of LeaveOut(): the cavity of the point, and the facet ids beyond its border. */
  Cavity Around;
  std::vector<Id> Beyond;
  /** Facet ids of the cells' neighbors, and the facet id that replaces each tetrahedron's. */
  std::vector<std::array<Id, 4>> CellNeighbors;
  std::vector<Id> Substitutes;
  /**
   * The tetrahedra that have been visited since the record was started. Their marks are not smaller
   * than this one, which is of no search.
   */
  std::vector<Id> Visited;
  std::uint32_t FirstOfRecord = 0;
};

inline Id CavitySearch::GetNeighbor(Id tetrahedron, int facet) const
{
  const Id cell = tetrahedron - this->GetFirstCell();
  if (cell >= 0)
  {
    return this->CellNeighbors[cell][facet];
  }
  const Id neighbor = this->Mesh.Neighbors[tetrahedron][facet];
  if (!this->CellNeighbors.empty() && neighbor != NoId && this->Marks[neighbor / 4] >= FirstHidden)
  {
    return this->Substitutes[this->Marks[neighbor / 4] - FirstHidden];
  }
  return neighbor;
}

inline void CavitySearch::Visit(Id tetrahedron)
{
  if (this->IsRecording && tetrahedron < this->GetFirstCell() &&
    this->Marks[tetrahedron] < this->FirstOfRecord)
  {
    this->Marks[tetrahedron] = this->FirstOfRecord;
    this->Visited.push_back(tetrahedron);
  }
}

template <typename Accepts>
bool CavitySearch::FindCavity(
  const Vec3& position, Id number, Id first, PointCavity& cavity, Accepts&& accepts)
{
  cavity.Tetrahedra.clear();
  cavity.Facets.clear();
  cavity.Inner.clear();
  cavity.Outer.clear();
  const std::uint32_t stays = this->StartSearch();
  this->Visit(first);
  if (!this->IsInConflict(first, position, number))
  {
    return false;
  }
  const std::uint32_t removed = stays + 1;
  cavity.Tetrahedra.push_back(first);
  this->Marks[first] = removed;
  for (std::size_t k = 0; k < cavity.Tetrahedra.size(); ++k)
  {
    const Id t = cavity.Tetrahedra[k];
    for (int i = 0; i < 4; ++i)
    {
      const Id outer = this->GetNeighbor(t, i);
      bool isBorder = true;
      if (outer != NoId)
      {
        std::uint32_t& mark = this->Marks[outer / 4];
        const bool isNew = mark != stays && mark != removed;
        if (isNew)
        {
          this->Visit(outer / 4);
          mark = this->IsInConflict(outer / 4, position, number) ? removed : stays;
        }
        isBorder = mark == stays;
        if (!isBorder && this->GetRegion(outer / 4) != this->GetRegion(t))
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
        const TriangleIds facet = GetFacet(this->GetIds(t), i);
        cavity.Facets.push_back({ facet[0], facet[2], facet[1] });
        cavity.Inner.push_back(4 * t + i);
        cavity.Outer.push_back(outer);
        if (!accepts())
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
