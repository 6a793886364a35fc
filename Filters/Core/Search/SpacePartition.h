// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpacePartition.h
 * @brief Cuts space into a box for each of several parts, with about the same number of points in
 * each.
 *
 * Method: a k-d tree on a sample of the points. A box for n parts is cut across the longest side of
 * its sample points, so that each half gets its share of them: n / 2 and n - n / 2 parts.
 *
 * Guarantees: a function of the set of sample points alone, whatever their order; every position
 * belongs to one part, points on a cut to the higher one. Cost: O(s log s) for s sample points.
 */
#ifndef cdmSpacePartition_h
#define cdmSpacePartition_h

#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Box.h"

#include <vector>

namespace cdm
{
class SpacePartition
{
public:
  /** Makes the parts, at least one; the sample may be empty. */
  SpacePartition(std::vector<Vec3> sample, int numberOfParts);

  int GetPart(const Vec3& position) const;

  /** The box of a part, cuts included; infinite where there is no cut. */
  const Box& GetCell(int part) const { return this->Cells[static_cast<std::size_t>(part)]; }

private:
  struct Node
  {
    int Axis;
    double Cut;
    /** The nodes below and above the cut, or -1 less the part. */
    int Below;
    int Above;
  };

  int Build(Vec3* begin, Vec3* end, int firstPart, int numberOfParts, const Box& cell);

  std::vector<Node> Nodes;
  int Root = -1;
  std::vector<Box> Cells;
};
} // namespace cdm

#endif
