// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceIncidences.h
 * @brief Knows on which surface facets and structural edges each point lies while a surface is
 * refined.
 *
 * Facets and input edges are those of RefinableSurface and stay the same: splits and flips change
 * neither. Points are numbered as the refiner has them: those of the surface, mesh points, which
 * lie on nothing, and new ones, each of which lies in one facet or on one input edge or is a mesh
 * point again.
 *
 * Cost: O(n log n) to build, O(1) for a new point.
 */
#ifndef cdmSurfaceIncidences_h
#define cdmSurfaceIncidences_h

#include "Core/Basics/IdLists.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Surface/RefinableSurface.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace cdm
{
class SurfaceIncidences
{
public:
  /**
   * Surface and points are shared with the caller, who may append to them.
   * @param numberOfSurfacePoints of the points, which come first; mesh points follow
   * @param flatness points farther than that from the plane of a facet make it a curved one
   */
  SurfaceIncidences(const RefinableSurface& surface, const std::vector<Vec3>& points,
    Id numberOfSurfacePoints, double flatness);

  /** Adds the next new point: its facet, or NoId and its input edge; neither for a mesh point. */
  void AddPoint(Id facet, Id inputEdge);

  /** Facets that a point lies on, ascending; none for a mesh point. */
  IdLists::Range GetFacets(Id point) const;
  /** Input edges that a point lies on. */
  IdLists::Range GetEdges(Id point) const;

  std::size_t GetNumberOfFacets() const { return this->Normals.size(); }
  /** Unit normal of a plane facet; zero for a curved one, which has no one plane. */
  const Vec3& GetNormal(Id facet) const { return this->Normals[facet]; }
  bool IsCurved(Id facet) const { return this->Normals[facet] == Vec3(); }

  /** Points of a facet at which structural edges end, ascending. */
  IdLists::Range GetCorners(Id facet) const { return this->Corners[facet]; }

  /** Calls visit(edge) for the input edges that two facets share. */
  template <typename Visit>
  void ForEachSharedEdge(Id facet, Id other, const Visit& visit) const
  {
    const std::pair<std::uint64_t, Id> first(GetPair(facet, other), 0);
    for (auto place = std::lower_bound(this->SharedEdges.begin(), this->SharedEdges.end(), first);
         place != this->SharedEdges.end() && place->first == first.first; ++place)
    {
      visit(place->second);
    }
  }

  /** Distance of the nearest new point on an input edge from a point at its end; or infinity. */
  double GetInnerRadius(Id point) const
  {
    return point < this->NumberOfSurfacePoints ? this->InnerRadii[point] : Infinity;
  }

  /** Whether two input edges meet at a point at less than 90 degrees; never at a new one. */
  bool IsAcuteCorner(Id point);

private:
  /** Two facets in one number, in any order. */
  static std::uint64_t GetPair(Id a, Id b) { return PackIds(MakeEdge(a, b)); }

  void CollectFacets();
  void CollectEdges();
  void CollectNormals(double flatness);
  void CollectCorners();

  const RefinableSurface& Surface;
  const std::vector<Vec3>& Points;
  Id NumberOfSurfacePoints;
  Id NumberOfGivenPoints;
  IdLists PointFacets;
  IdLists PointEdges;
  /** Facets at each input edge, ascending. */
  IdLists EdgeFacets;
  /** For each new point. */
  std::vector<Id> NewPointFacets;
  std::vector<Id> NewPointEdges;
  /** Pairs of facets, and an edge that they share, ascending. */
  std::vector<std::pair<std::uint64_t, Id>> SharedEdges;
  std::vector<Vec3> Normals;
  IdLists Corners;
  std::vector<double> InnerRadii;
  /** -1: not known yet. */
  std::vector<signed char> AcuteCorners;
};
} // namespace cdm

#endif
