// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverMemory.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>

namespace cdm
{
SliverMemory::Times SliverMemory::Get(Id name) const
{
  const bool isInside = name >= FirstName;
  const std::vector<Times>& times = isInside ? this->Inside : this->OnSurface;
  const std::size_t place = isInside ? name - FirstName : name;
  return place < times.size() ? times[place] : Times();
}

SliverMemory::Times& SliverMemory::Get(Id name)
{
  const bool isInside = name >= FirstName;
  std::vector<Times>& times = isInside ? this->Inside : this->OnSurface;
  const std::size_t place = isInside ? name - FirstName : name;
  if (place >= times.size())
  {
    times.resize(place + 1);
  }
  return times[place];
}

bool SliverMemory::HasChangedSince(std::int64_t time, const TetrahedronIds& names) const
{
  return std::any_of(
    names.begin(), names.end(), [&](Id name) { return this->Get(name).Change > time; });
}

void SliverMemory::SetChanged(const TetrahedronIds& names)
{
  ++this->Time;
  for (Id name : names)
  {
    this->Get(name).Change = this->Time;
  }
}

std::size_t SliverMemory::NamesHash::operator()(const TetrahedronIds& names) const
{
  std::uint64_t hash = 0;
  for (Id name : names)
  {
    hash = (hash ^ static_cast<std::uint64_t>(name)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 32;
  }
  return static_cast<std::size_t>(hash);
}

void SliverMemory::SetHopeless(const TetrahedronIds& names, SliverAttempt last)
{
  this->Failures[Sorted(names)] = { this->Time, last };
}

bool SliverMemory::IsHopeless(const TetrahedronIds& names, SliverAttempt last) const
{
  const auto failure = this->Failures.find(Sorted(names));
  return failure != this->Failures.end() && failure->second.Last >= last &&
    !this->HasChangedSince(failure->second.Time, names);
}

void SliverMemory::SetUnroundable(const TetrahedronIds& names)
{
  this->FailedRoundings[Sorted(names)] = this->Time;
}

bool SliverMemory::IsUnroundable(const TetrahedronIds& names) const
{
  const auto failure = this->FailedRoundings.find(Sorted(names));
  return failure != this->FailedRoundings.end() && !this->HasChangedSince(failure->second, names);
}

void SliverMemory::SetImmovable(Id name, SliverPlace place)
{
  this->Get(name).Searches[static_cast<int>(place)] = this->Time;
}

bool SliverMemory::IsImmovable(Id name, SliverPlace place) const
{
  const Times times = this->Get(name);
  const std::int64_t search = times.Searches[static_cast<int>(place)];
  return search > 0 && search >= times.Change;
}
} // namespace cdm
