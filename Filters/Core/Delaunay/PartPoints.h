// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartPoints.h
 * @brief The points that one part of a distributed tetrahedralization knows: its own ones, and a
 * halo of those of other parts.
 *
 * Method: small blocks of own points have boxes; enlarged by their size, they are asked of the
 * parts whose points they may hold, and answered with these points unless they are very many. Where
 * all points of a box are known, no part has to be asked about it again.
 */
#ifndef cdmPartPoints_h
#define cdmPartPoints_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Box.h"
#include "Core/Search/PointOctree.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace cdm
{
/** A point and its number among those of all parts, from 0 on. */
struct NumberedPoint
{
  Vec3 Position;
  std::int64_t Number = 0;
};

/** The points of a part in the boxes that another part has asked for. */
struct HaloPoints
{
  /** For each box: 0 if it has too many points, which are not among these. */
  std::vector<char> IsComplete;
  std::vector<NumberedPoint> Points;
};

/**
 * Drops all but the lowest numbered one of points at the same position; the result is ascending.
 */
void RemoveCopies(std::vector<NumberedPoint>& points);

/**
 * The first of the points that is independent of up to three others: not equal to them, and not in
 * their line or plane. NoId if there is none. Four such calls give a tetrahedron for every part.
 */
Id FindIndependentPoint(
  const std::vector<NumberedPoint>& points, const std::vector<NumberedPoint>& others);

class PartPoints
{
public:
  /** Another part that has points. */
  struct OtherPart
  {
    std::size_t Part;
    /** The tight box of its points. */
    Box Bounds;
  };

  /**
   * @param own distinct points, ascending by number
   * @param part the number of this part
   * @param bounds the tight boxes of the points of all parts
   * @param cell what belongs to this part and to no other; its border may belong to others
   */
  PartPoints(
    std::vector<NumberedPoint> own, int part, const std::vector<Box>& bounds, const Box& cell);

  /** The boxes from which this part wants all points of each part. */
  std::vector<std::vector<Box>> GetHaloBoxes();
  /** Answers another part: its points in the boxes. */
  HaloPoints GetPointsIn(const std::vector<Box>& boxes) const;
  /** Takes the answers of all parts to GetHaloBoxes(). */
  void TakeHalo(const std::vector<HaloPoints>& halo);
  /** Adds points of other parts. */
  void Add(const std::vector<NumberedPoint>& points);

  /** The own points, then the halo. */
  const std::vector<NumberedPoint>& GetAll() const { return this->Points; }
  const NumberedPoint& operator[](Id point) const { return this->Points[point]; }
  Id GetNumber() const { return static_cast<Id>(this->Points.size()); }
  Id GetNumberOfOwn() const { return this->NumberOfOwn; }
  bool IsOwn(Id point) const { return point < this->NumberOfOwn; }
  /** The index of a point, or NoId. */
  Id Find(std::int64_t number) const;
  /** The own points; empty if there are no other parts. */
  const PointOctree& GetOctree() const { return this->Octree; }

  std::size_t GetNumberOfParts() const { return this->NumberOfParts; }
  const std::vector<OtherPart>& GetOthers() const { return this->Others; }
  /** Whether all points in the circumsphere of a tetrahedron are surely known. */
  bool IsCovered(const TetrahedronIds& ids) const;

private:
  void MakeBlocks(Id* begin, Id* end);
  Id FindOwn(std::int64_t number) const;

  std::vector<NumberedPoint> Points;
  Id NumberOfOwn;
  std::size_t NumberOfParts;
  std::vector<OtherPart> Others;
  Box Cell;
  PointOctree Octree;
  /** The enlarged box of each block of own points, and the block of each own point. */
  std::vector<Box> Blocks;
  std::vector<Id> BlockOfPoint;
  /** For each part the blocks whose boxes it was asked for. */
  std::vector<std::vector<Id>> BlocksOfBoxes;
  /** Index of each point of the halo, by its number. */
  std::unordered_map<std::int64_t, Id> HaloIndices;
};
} // namespace cdm

#endif
