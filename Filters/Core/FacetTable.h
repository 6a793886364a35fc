// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetTable.h
 * @brief Finds triangles by their three points: the memory of the advancing front (Lemma 6.1).
 *
 * Open addressing with linear probing; removal shifts entries back, so that the table stays as
 * large as the front, not as the mesh. 16 bytes per slot, at most two thirds full.
 */
#ifndef cdmFacetTable_h
#define cdmFacetTable_h

#include "Types.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace cdm
{
class FacetTable
{
public:
  FacetTable()
    : Slots(1024)
  {
  }

  /** Value stored for the triangle with these points in any order, or null. */
  Id* Find(const TriangleIds& triangle)
  {
    const TriangleIds key = Sort(triangle);
    const std::size_t slot = this->FindSlot(key);
    return this->Slots[slot].Key[0] == NoId ? nullptr : &this->Slots[slot].Value;
  }

  /** The triangle must not be there yet. */
  void Insert(const TriangleIds& triangle, Id value)
  {
    if (3 * (this->Count + 1) > 2 * this->Slots.size())
    {
      this->Grow();
    }
    const TriangleIds key = Sort(triangle);
    this->Slots[this->FindSlot(key)] = { key, value };
    ++this->Count;
  }

  /** The triangle must be there. */
  void Remove(const TriangleIds& triangle)
  {
    const std::size_t mask = this->Slots.size() - 1;
    std::size_t hole = this->FindSlot(Sort(triangle));
    for (std::size_t next = (hole + 1) & mask; this->Slots[next].Key[0] != NoId;
         next = (next + 1) & mask)
    {
      const std::size_t home = Hash(this->Slots[next].Key) & mask;
      // An entry may move back as far as its home.
      if (((next - home) & mask) >= ((next - hole) & mask))
      {
        this->Slots[hole] = this->Slots[next];
        hole = next;
      }
    }
    this->Slots[hole] = Slot{};
    --this->Count;
  }

private:
  struct Slot
  {
    TriangleIds Key{ NoId, NoId, NoId };
    Id Value = NoId;
  };

  static TriangleIds Sort(TriangleIds t)
  {
    if (t[0] > t[1])
    {
      std::swap(t[0], t[1]);
    }
    if (t[1] > t[2])
    {
      std::swap(t[1], t[2]);
    }
    if (t[0] > t[1])
    {
      std::swap(t[0], t[1]);
    }
    return t;
  }

  static std::size_t Hash(const TriangleIds& key)
  {
    std::uint64_t h = static_cast<std::uint32_t>(key[0]);
    h = h * 0x9E3779B97F4A7C15ull + static_cast<std::uint32_t>(key[1]);
    h = (h ^ (h >> 29)) * 0xBF58476D1CE4E5B9ull + static_cast<std::uint32_t>(key[2]);
    h = (h ^ (h >> 32)) * 0x94D049BB133111EBull;
    return static_cast<std::size_t>(h ^ (h >> 31));
  }

  std::size_t FindSlot(const TriangleIds& key) const
  {
    const std::size_t mask = this->Slots.size() - 1;
    std::size_t slot = Hash(key) & mask;
    while (this->Slots[slot].Key[0] != NoId && this->Slots[slot].Key != key)
    {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  void Grow()
  {
    std::vector<Slot> old(2 * this->Slots.size());
    old.swap(this->Slots);
    for (const Slot& slot : old)
    {
      if (slot.Key[0] != NoId)
      {
        this->Slots[this->FindSlot(slot.Key)] = slot;
      }
    }
  }

  std::vector<Slot> Slots;
  std::size_t Count = 0;
};
}

#endif
