// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronWatch.h
 * @brief The tetrahedra of a changing mesh that have some property, each asked for it once.
 *
 * Rounds of Steiner points change a small part of the mesh each. To look for what is badly shaped
 * in all of it took a third of the time of late rounds.
 *
 * Cost: the property is asked for where tetrahedra are new. The mesh lists these if they are at
 * most half as many as the mesh has; otherwise, and where something has to be forgotten, all
 * tetrahedra are visited. 16 bytes for each tetrahedron that has the property.
 */
#ifndef cdmTetrahedronWatch_h
#define cdmTetrahedronWatch_h

#include "Core/Basics/ThreadTeam.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdm
{
class TetrahedronWatch
{
public:
  /**
   * The tetrahedra that have the property, in no order.
   * @param team on whose threads hasProperty is called if there are many new tetrahedra
   * @param hasProperty called with the id of each tetrahedron that is new since the last update
   */
  template <typename Property>
  const std::vector<Id>& Update(
    const DynamicTetrahedralization& mesh, ThreadTeam& team, Property&& hasProperty)
  {
    this->Keep([&mesh](Id t, std::int64_t stamp) { return mesh.GetStamp(t) == stamp; });
    this->New.clear();
    const auto visit = [&](Id t)
    {
      ++this->NumberOfVisits;
      if (mesh.GetStamp(t) >= this->NextStamp && !mesh.IsDead(t))
      {
        this->New.push_back(t);
      }
    };
    mesh.VisitMadeSince(this->NumberMade, this->Marks, visit);
    this->NumberOfTests += static_cast<std::int64_t>(this->New.size());
    this->Test(team, hasProperty);
    for (std::size_t i = 0; i < this->New.size(); ++i)
    {
      if (this->HasProperty[i] != 0)
      {
        this->Found.push_back(this->New[i]);
        this->Stamps.push_back(mesh.GetStamp(this->New[i]));
      }
    }
    this->NumberMade = mesh.CountMade();
    this->NextStamp = mesh.GetNextStamp();
    return this->Found;
  }

  /**
   * Asks again for tetrahedra with this stamp or a later one.
   * @param numberMade how many tetrahedra the mesh had made, at most, before the first of these
   */
  void Forget(std::int64_t first, std::int64_t numberMade)
  {
    if (first < this->NextStamp)
    {
      this->Keep([first](Id, std::int64_t stamp) { return stamp < first; });
      this->NextStamp = first;
      this->NumberMade = std::min(this->NumberMade, numberMade);
    }
  }

  /** How many times a property has been asked for. */
  std::int64_t GetNumberOfTests() const { return this->NumberOfTests; }
  /** How many tetrahedra have been visited to find those that are new. */
  std::int64_t GetNumberOfVisits() const { return this->NumberOfVisits; }

private:
  /** A thread tests so many at a time, which takes some 50 microseconds. */
  static constexpr std::size_t TestsAtOnce = 256;

  /** Asks for the property of the new tetrahedra. */
  template <typename Property>
  void Test(ThreadTeam& team, Property&& hasProperty)
  {
    this->HasProperty.resize(this->New.size());
    team.RunBlocks(team.GetNumberOfThreads(), this->New.size(), TestsAtOnce,
      [&](std::size_t begin, std::size_t end, int)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          this->HasProperty[i] = hasProperty(this->New[i]) ? 1 : 0;
        }
      });
  }

  /** Drops all others of those that were found. */
  template <typename Condition>
  void Keep(const Condition& isKept)
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < this->Found.size(); ++i)
    {
      if (isKept(this->Found[i], this->Stamps[i]))
      {
        this->Found[kept] = this->Found[i];
        this->Stamps[kept++] = this->Stamps[i];
      }
    }
    this->Found.resize(kept);
    this->Stamps.resize(kept);
  }

  std::vector<Id> Found;
  std::vector<std::int64_t> Stamps;
  /** Tetrahedra with this stamp or a later one are new. */
  std::int64_t NextStamp = 0;
  std::int64_t NumberOfTests = 0;
  std::int64_t NumberOfVisits = 0;
  /** How many tetrahedra the mesh had made at the last update; negative: all have to be visited. */
  std::int64_t NumberMade = -1;
  /** Work space: marks for VisitAscending(), new tetrahedra, and what these have. */
  std::vector<std::uint64_t> Marks;
  std::vector<Id> New;
  std::vector<char> HasProperty;
};
} // namespace cdm

#endif
