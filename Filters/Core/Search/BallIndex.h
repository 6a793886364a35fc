// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BallIndex.h
 * @brief Finds those of many balls that hold a point: the inverse of the point octree.
 *
 * Balls of similar radius share a level, a hashed grid whose cells are as wide as its largest
 * balls; a ball lies in the cell of its center, so that at most eight cells of each level can hold
 * balls that reach a point. The first query makes the cells; before it, balls are only listed.
 * Within a cell balls are kept in single precision, in units of the cell, a little too large, and
 * are tested in blocks.
 *
 * Cost: O(1) to add or remove; a query looks at most balls of O(levels) cells. About 100 bytes per
 * ball.
 */
#ifndef cdmBallIndex_h
#define cdmBallIndex_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace cdm
{
class BallIndex
{
public:
  /**
   * Add a ball under an id, or replace the one it had. An infinite radius holds every point. A ball that
   * is to enclose a sphere has to be larger by what its center is rounded by (EnclosingBall.h).
   */
  void Set(Id id, const Vec3& center, double radius);

  void Remove(Id id);

  /** Ids of the balls that hold the point, or almost (to 1e-4 of the radius), ascending. */
  void Find(const Vec3& point, std::vector<Id>& ids)
  {
    this->Settle();
    this->FindSettled(point, ids);
  }
  /** Puts balls into their cells that wait for the first query. */
  void Settle();
  /** The same as Find(), for several threads at once: all balls have to be settled. */
  void FindSettled(const Vec3& point, std::vector<Id>& ids) const;

private:
  struct Ball
  {
    Vec3 Center;
    double Radius;
    Id Number;
  };

  /** Balls in a block: a multiple of what a vector register holds. */
  static constexpr std::size_t BlockSize = 16;

  /** Coordinates relative to the low corner of the cell, in widths of it. */
  struct Block
  {
    float X[BlockSize];
    float Y[BlockSize];
    float Z[BlockSize];
    float SquaredRadius[BlockSize];
  };

  /** Cells of level l are 2^l wide. */
  struct CellPlace
  {
    int Level;
    std::int64_t Index[3];

    bool operator==(const CellPlace& other) const
    {
      return this->Level == other.Level && this->Index[0] == other.Index[0] &&
        this->Index[1] == other.Index[1] && this->Index[2] == other.Index[2];
    }
    std::uint64_t GetHash() const;
  };

  struct Cell
  {
    CellPlace Place;
    Vec3 Corner;
    /** A box that holds all balls of the cell, coordinates as in the blocks. */
    float Low[3];
    float High[3];
    std::vector<Id> Numbers;
    /** The balls themselves, in as many blocks as needed. */
    std::vector<Block> Blocks;
  };

  /** The cell of a ball, and its index there. */
  struct Place
  {
    Id Cell = NoId;
    Id Index = NoId;
  };

  /** A cell and the upper half of the hash of its level and index. */
  struct Slot
  {
    Id Cell = NoId;
    std::uint32_t Mark = 0;
  };

  static void Find(const Cell& cell, double scale, const Vec3& point, std::vector<Id>& ids);

  template <std::size_t Count>
  void FindInCells(const std::array<CellPlace, Count>& places, double scale, const Vec3& point,
    std::vector<Id>& ids) const;
  std::size_t FindSlot(const CellPlace& place, std::uint64_t hash) const;
  void Put(const Ball& ball);
  void Resize(std::size_t numberOfSlots);

  /** The cell and index of each ball, by its number. */
  std::vector<Place> Places;
  std::vector<Cell> Cells;
  /**
   * Hash table of the cells by open addressing, NoId in slots that are free. A power of two of
   * them, at most half of them used; none before the first query.
   */
  std::vector<Slot> Slots;
  /** Balls that wait for the first query. */
  std::vector<Ball> Waiting;
  /** Number of balls of each level in the cells. */
  std::map<int, Id> Levels;
};
} // namespace cdm

#endif
