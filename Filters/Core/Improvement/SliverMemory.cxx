// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverMemory.h"

#include <algorithm>

namespace cdm
{
void SliverMemory::SetChanged(const TetrahedronIds& names)
{
  ++this->Time;
  for (Id name : names)
  {
    this->Changes[name] = this->Time;
  }
}

void SliverMemory::SetHopeless(const TetrahedronIds& names, SliverAttempt last)
{
  this->Failures[names] = { this->Time, last };
}

bool SliverMemory::IsHopeless(const TetrahedronIds& names, SliverAttempt last) const
{
  const auto failure = this->Failures.find(names);
  return failure != this->Failures.end() && failure->second.Last >= last &&
    std::none_of(names.begin(), names.end(),
      [&](Id name)
      {
        const auto change = this->Changes.find(name);
        return change != this->Changes.end() && change->second > failure->second.Time;
      });
}
} // namespace cdm
