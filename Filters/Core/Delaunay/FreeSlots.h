// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FreeSlots.h
 * @brief Free slots of arrays that a thread may fill: those of removed things, and unused ranges.
 */
#ifndef cdmFreeSlots_h
#define cdmFreeSlots_h

#include "Core/Basics/Types.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace cdm
{
class FreeSlots
{
public:
  std::size_t GetSize() const { return this->Size; }

  /** Ranges [begin, end) that were never used. */
  const std::vector<std::pair<Id, Id>>& GetRanges() const { return this->Ranges; }

  void Add(Id slot)
  {
    this->Removed.push_back(slot);
    ++this->Size;
  }
  void AddRange(Id begin, Id end)
  {
    this->Ranges.emplace_back(begin, end);
    this->Size += static_cast<std::size_t>(end - begin);
  }

  /** Takes a free slot; there has to be one. The slot freed last comes first. */
  Id Take()
  {
    --this->Size;
    if (!this->Removed.empty())
    {
      const Id slot = this->Removed.back();
      this->Removed.pop_back();
      return slot;
    }
    std::pair<Id, Id>& range = this->Ranges.back();
    const Id slot = range.first++;
    if (range.first == range.second)
    {
      this->Ranges.pop_back();
    }
    return slot;
  }

  /** Gives slots to another object, as many as that one still wants. */
  void MoveTo(FreeSlots& to, std::size_t wanted)
  {
    while (to.Size < wanted && !this->Removed.empty())
    {
      to.Add(this->Removed.back());
      this->Removed.pop_back();
      --this->Size;
    }
    while (to.Size < wanted && !this->Ranges.empty())
    {
      std::pair<Id, Id>& range = this->Ranges.back();
      const std::size_t size =
        std::min(wanted - to.Size, static_cast<std::size_t>(range.second - range.first));
      const Id begin = range.second - static_cast<Id>(size);
      to.AddRange(begin, range.second);
      range.second = begin;
      if (range.first == range.second)
      {
        this->Ranges.pop_back();
      }
      this->Size -= size;
    }
  }

private:
  std::vector<Id> Removed;
  std::vector<std::pair<Id, Id>> Ranges;
  std::size_t Size = 0;
};
} // namespace cdm

#endif
