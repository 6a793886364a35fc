// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegionLocator.h
 * @brief Finds the region in which a point lies, and its distance from the boundary.
 *
 * Method: sides of triangles that look into the same space form shells (SurfaceSides.h).
 *  1. A segment from far outside to the point crosses triangles; each crossing leaves the shell on
 *     one side and enters that on the other. All in all one more entered than left: the point lies
 *     in the space of this shell, as seen from its component of the surface. No crossings need to
 *     be sorted, so that exact signs decide everything. A segment that meets an edge or a vertex is
 *     replaced by another one.
 *  2. Components may lie inside of others: the innermost one around the point counts.
 * Regions: with labels that of the shell; without the enclosed segments are numbered from 0 on by
 * their first side, as the tetrahedralizer does, and the outer shell of a component that lies inside
 * of another one looks into the region around it.
 *
 * Guarantees: a point on the surface lies in no region; all else is exact. Queries are thread safe.
 * Failure: NotClosed names triangles whose labels contradict each other (as they do around an
 * opening), or that enclose nothing.
 * Cost: O(n log n) to build; a query looks at the triangles whose boxes meet a thin box from the
 * point to the outside, O(sqrt n) for usual surfaces.
 */
#ifndef cdmRegionLocator_h
#define cdmRegionLocator_h

#include "Core/Basics/Status.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Sizing/SizingField.h"

#include <memory>
#include <vector>

namespace cdm
{
class BoxTree;

class RegionLocator
{
public:
  /** The surface has to outlive the locator. */
  explicit RegionLocator(const TriangleMesh& surface);
  ~RegionLocator();

  Status Build();

  const Vec3& GetLow() const { return this->Low; }
  const Vec3& GetHigh() const { return this->High; }
  /** The regions in front of and behind a triangle. */
  RegionPair GetRegions(Id triangle) const;

  /** The region that the point lies strictly inside of, or OutsideRegion. */
  Id Locate(const Vec3& point) const;

  /** Whether a triangle's box meets the closed box. */
  bool MayTouch(const Vec3& low, const Vec3& high) const;

  /** Distance of the point from the nearest triangle, or the limit if that is smaller. */
  double GetDistance(const Vec3& point, double limit) const;

  /** Whether the triangles are at least as far from the point as so many spacings, to rounding. */
  bool IsClear(const Vec3& point, const LocalSpacing& spacing, double distance) const;
  /** The same for the triangles between two regions only, given in either order. */
  bool IsClear(const Vec3& point, const LocalSpacing& spacing, double distance,
    const RegionPair& between) const;

private:
  struct ShellCount
  {
    Id Shell;
    int Count;
  };

  Status FindRegions();
  void FindDepths();
  Id GetInnermostRegion(const std::vector<Id>& shells) const;
  std::vector<Id> FindShells(const Vec3& point, Id except, bool& isOnSurface) const;
  bool CountCrossings(
    const Vec3& point, const Vec3& outside, Id except, std::vector<ShellCount>& counts) const;

  const TriangleMesh& Surface;
  std::unique_ptr<BoxTree> Tree;
  Vec3 Low;
  Vec3 High;
  /** The shell of each side; whether each shell is an outer one; the component of each triangle. */
  std::vector<Id> Shells;
  std::vector<char> IsOuter;
  std::vector<Id> Components;
  /** The region and the component of each shell. */
  std::vector<Id> Regions;
  std::vector<Id> ShellComponents;
  /** For each component the number of others that it lies in. */
  std::vector<Id> Depths;
};
} // namespace cdm

#endif
