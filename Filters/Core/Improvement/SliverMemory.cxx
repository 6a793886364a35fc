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
    const bool isInside = name >= FirstName;
    std::vector<std::int64_t>& changes = isInside ? this->InsideChanges : this->SurfaceChanges;
    const std::size_t place = isInside ? name - FirstName : name;
    if (place >= changes.size())
    {
      changes.resize(place + 1, 0);
    }
    changes[place] = this->Time;
  }
}

/** Time at which a point has last got other neighbors; 0: never. */
std::int64_t SliverMemory::GetChange(Id name) const
{
  const bool isInside = name >= FirstName;
  const std::vector<std::int64_t>& changes = isInside ? this->InsideChanges : this->SurfaceChanges;
  const std::size_t place = isInside ? name - FirstName : name;
  return place < changes.size() ? changes[place] : 0;
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
      [&](Id name) { return this->GetChange(name) > failure->second.Time; });
}
} // namespace cdm
