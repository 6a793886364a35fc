// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BallIndex.h
 * @brief Which of many balls hold a point: the inverse of the point octree.
 *
 * Balls of similar radius share a level, a hashed grid whose cells are as wide as its largest
 * balls; a ball lies in the cell of its center, so that at most eight cells of each level can hold
 * balls that reach a point. The cells are made by the first query: who never asks pays for a list.
 *
 * Cost: O(1) to add or remove; O(levels) cells for a query. About 100 bytes per ball.
 */
#ifndef cdmBallIndex_h
#define cdmBallIndex_h

#include "Types.h"
#include "Vec3.h"

#include <cstdint>
#include <map>
#include <utility>
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
  void Find(const Vec3& point, std::vector<Id>& ids);

private:
  struct Ball
  {
    Vec3 Center;
    double Radius;
    int Level;
    Id Number;
  };

  /** Where a ball is. */
  struct Place
  {
    Id Cell = NoId;
    Id Index = NoId;
  };

  static std::uint64_t GetKey(int level, const std::int64_t index[3]);

  std::size_t FindSlot(std::uint64_t key) const;
  void Put(const Ball& ball);
  void Resize(std::size_t numberOfSlots);

  /** By number of the ball. */
  std::vector<Place> Places;
  /** Balls side by side: queries read most balls of a cell, and add or remove few. */
  std::vector<std::vector<Ball>> Cells;
  /**
   * Hash table by open addressing: key and cell, NoId in slots that are free. A power of two of
   * them, at most half of them used; none before the first query.
   */
  std::vector<std::pair<std::uint64_t, Id>> Slots;
  /** Balls that wait for the first query. */
  std::vector<Ball> Waiting;
  /** How many balls there are of each level: cells are 2^level wide. */
  std::map<int, Id> Levels;
};
} // namespace cdm

#endif
