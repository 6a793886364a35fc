// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MergeableSurface.h
 * @brief A surface of which points are merged into their neighbors, one after the other.
 *
 * Says which merges keep the topology, and does them. The callers (SurfaceCoarsening.h,
 * SurfaceReduction.h) decide which merges keep the shape.
 *
 * Inputs: the invariants of TriangleMesh.h. The surface must outlive this and not be changed by
 * others until Finish().
 * Cost: each function is quadratic in the number of triangles at the points concerned. 50 bytes per
 * point and 15 per triangle.
 */
#ifndef cdmMergeableSurface_h
#define cdmMergeableSurface_h

#include "Core/Meshes/TriangleMesh.h"

#include <vector>

namespace cdm
{
class MergeableSurface
{
public:
  explicit MergeableSurface(TriangleMesh& surface);

  const std::vector<Vec3>& GetPoints() const { return this->Surface.Points; }
  const TriangleIds& GetTriangle(Id triangle) const { return this->Surface.Triangles[triangle]; }
  const RegionPair& GetLabels(Id triangle) const { return this->Surface.Labels[triangle]; }

  /** Triangles at a point that are left. */
  const std::vector<Id>& GetUses(Id point) const { return this->Uses[point]; }

  bool Has(Id triangle, Id point) const;

  /** Points that share a triangle with this one: nearest first, of equal distance by id. */
  std::vector<Id> GetNeighbors(Id point) const;

  /**
   * Whether a merge of a point into its neighbor keeps the topology (the link condition): only
   * triangles at the edge between the two may vanish. Anything else next to both would be folded
   * onto itself.
   */
  bool KeepsTopology(Id point, Id target) const;

  /** Merge a point into its neighbor. */
  void Merge(Id point, Id target);

  /** Take the triangles that are gone out of the surface; the others keep their order. */
  void Finish();

private:
  bool AreNeighbors(Id a, Id b) const;

  TriangleMesh& Surface;
  std::vector<std::vector<Id>> Uses;
  std::vector<char> IsAlive;
};
} // namespace cdm

#endif
