// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StarTable.h
 * @brief The triangles around one vertex by their other two points (Lemma 6.1, one star at a time).
 *
 * Open addressing with linear probing; the table is as large as the largest star so far, and is
 * cleared by counting up.
 */
#ifndef cdmStarTable_h
#define cdmStarTable_h

#include "Types.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdm
{
class StarTable
{
public:
  /** Values that are no facet ids. Barrier t is a triangle of the surface. */
  static constexpr Id Nothing = -1;
  static constexpr Id Closed = -2;
  static constexpr Id FirstBarrier = -3;

  struct Entry
  {
    Id B = NoId;
    Id C = NoId;
    Id Value = Nothing;
  };

  StarTable() : Slots(256) {}

  void Clear()
  {
    ++this->Round;
    this->Count = 0;
  }

  /**
   * The entry of the triangle with points b and c in any order; a new one has the value Nothing and
   * is to be set. Valid until the next call.
   */
  Entry& Find(Id b, Id c)
  {
    if (2 * this->Count >= this->Slots.size())
    {
      this->Grow();
    }
    Slot& slot = this->FindSlot(b, c);
    if (slot.Round != this->Round)
    {
      slot.Round = this->Round;
      slot.Content = { b, c, Nothing };
      ++this->Count;
    }
    return slot.Content;
  }

private:
  struct Slot
  {
    Entry Content;
    std::uint32_t Round = 0;
  };

  Slot& FindSlot(Id b, Id c)
  {
    const std::uint64_t low = static_cast<std::uint32_t>(std::min(b, c));
    const std::uint64_t high = static_cast<std::uint32_t>(std::max(b, c));
    const std::uint64_t hash = ((high << 32) | low) * 0x9e3779b97f4a7c15ull;
    const std::size_t mask = this->Slots.size() - 1;
    for (std::size_t i = static_cast<std::size_t>(hash >> 32) & mask;; i = (i + 1) & mask)
    {
      Slot& slot = this->Slots[i];
      const Entry& entry = slot.Content;
      if (slot.Round != this->Round || (entry.B == b && entry.C == c) ||
        (entry.B == c && entry.C == b))
      {
        return slot;
      }
    }
  }

  void Grow()
  {
    const std::vector<Slot> old = std::move(this->Slots);
    this->Slots = std::vector<Slot>(2 * old.size());
    for (const Slot& slot : old)
    {
      if (slot.Round == this->Round)
      {
        this->FindSlot(slot.Content.B, slot.Content.C) = slot;
      }
    }
  }

  std::vector<Slot> Slots;
  std::size_t Count = 0;
  std::uint32_t Round = 1;
};
} // namespace cdm

#endif
