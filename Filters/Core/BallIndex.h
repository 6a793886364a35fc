// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BallIndex.h
 * @brief Which of many balls hold a point: the inverse of the point octree.
 *
 * Balls of similar radius share a level, a hashed grid whose cells are as wide as its largest
 * balls; a ball lies in the cell of its center, so that at most eight cells of each level can hold
 * balls that reach a point.
 *
 * Cost: O(1) to add or remove; O(levels) cells for a query. About 100 bytes per ball.
 */
#ifndef cdmBallIndex_h
#define cdmBallIndex_h

#include "Types.h"
#include "Vec3.h"

#include <map>
#include <unordered_map>
#include <vector>

namespace cdm
{
class BallIndex
{
public:
  /** Add a ball under an id, or replace the one it had. An infinite radius holds every point. */
  void Set(Id id, const Vec3& center, double radius);

  void Remove(Id id);

  /** Ids of the balls that hold the point, ascending. */
  void Find(const Vec3& point, std::vector<Id>& ids) const;

private:
  struct Ball
  {
    Vec3 Center;
    double Radius = -1.0;
    int Level = 0;
    std::uint64_t Cell = 0;
  };

  static std::uint64_t GetCell(int level, const std::int64_t index[3]);

  using Cells = std::unordered_map<std::uint64_t, std::vector<Id>>;

  std::vector<Ball> Balls;
  /** By level: cells are 2^level wide. Infinite balls have a level and a cell of their own. */
  std::map<int, Cells> Levels;
};
}

#endif
