// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointTree.h
 * @brief Bounding boxes over points along a Hilbert curve, from which points drop out.
 *
 * A leaf is eight points in a row, a node eight nodes (or leaves) in a row: there are no pointers,
 * and the boxes of eight siblings lie side by side for the vector kernels (PencilKernels.h). The
 * boxes are tight around the points that are still there. Point i of the tree is the i-th along
 * the curve.
 *
 * Slabs: besides its box each node knows, for one sphere fitted to its points, between which of its
 * concentric spheres they lie. Points on a curved surface fill a thin slab, while their box is as
 * thick as wide; without slabs a search along a sphere or plane that touches such a surface visits
 * a number of leaves that grows with the fineness.
 *
 * Invariants: a child is in the mask of its parent if and only if it holds a point that has not
 * dropped out; its box is then the tight box of these.
 *
 * Cost: 24 bytes per point for the coordinates, 8 for the boxes, 8 for the slabs; O(n) to build.
 */
#ifndef cdmPointTree_h
#define cdmPointTree_h

#include "Types.h"
#include "Vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdm
{
class PointTree
{
public:
  static constexpr int Width = 8;
  /** Numbers of one group of siblings: six box coordinates, then those of the slabs. */
  static constexpr int BoxStride = 6 * Width;
  static constexpr int SlabStride = 8 * Width;

  /** Positions in the order of the curve. */
  void Build(const std::vector<Vec3>& points, const std::vector<Id>& order);

  Id GetNumberOfPoints() const { return this->NumberOfPoints; }
  Vec3 GetPoint(Id point) const { return { this->X[point], this->Y[point], this->Z[point] }; }
  bool IsThere(Id point) const
  {
    return ((this->LeafMasks[point / Width] >> (point % Width)) & 1u) != 0;
  }

  /** Let a point drop out, or come back. */
  void Remove(Id point);
  void Restore(Id point);

  int GetNumberOfLevels() const { return static_cast<int>(this->Levels.size()); }
  /** Level 0 holds the leaves; the top level has one group. */
  const double* GetBoxes(int level, Id group) const
  {
    return this->Levels[level].Boxes.data() + static_cast<std::size_t>(group) * BoxStride;
  }
  const double* GetSlabs(int level, Id group) const
  {
    return this->Levels[level].Slabs.data() + static_cast<std::size_t>(group) * SlabStride;
  }
  unsigned GetMask(int level, Id group) const { return this->Levels[level].Masks[group]; }
  unsigned GetLeafMask(Id leaf) const { return this->LeafMasks[leaf]; }
  /** Coordinates of all points; padded to whole leaves. */
  const double* GetX() const { return this->X.data(); }
  const double* GetY() const { return this->Y.data(); }
  const double* GetZ() const { return this->Z.data(); }

private:
  struct Level
  {
    std::vector<double> Boxes;
    std::vector<double> Slabs;
    std::vector<std::uint8_t> Masks;
  };

  void UpdateLeaf(Id leaf);
  void BuildSlab(int level, Id node);

  Id NumberOfPoints = 0;
  std::vector<double> X;
  std::vector<double> Y;
  std::vector<double> Z;
  std::vector<std::uint8_t> LeafMasks;
  std::vector<Level> Levels;
};
} // namespace cdm

#endif
