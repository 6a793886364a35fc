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
      if (mesh.IsMadeSince(this->Last, t))
      {
        this->New.push_back(t);
      }
    };
    mesh.VisitMadeSince(this->Last, this->Marks, visit);
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
    this->Last = mesh.GetMoment();
    return this->Found;
  }

  /** Asks again for tetrahedra that have been made since a moment. */
  void Forget(const MeshMoment& moment)
  {
    if (moment.NextStamp < this->Last.NextStamp)
    {
      this->Keep([&moment](Id, std::int64_t stamp) { return stamp < moment.NextStamp; });
      this->Last = moment;
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
  /** Tetrahedra that have been made since then are new. */
  MeshMoment Last;
  std::int64_t NumberOfTests = 0;
  std::int64_t NumberOfVisits = 0;
  /** Work space: marks for VisitAscending(), new tetrahedra, and what these have. */
  std::vector<std::uint64_t> Marks;
  std::vector<Id> New;
  std::vector<char> HasProperty;
};
} // namespace cdm

#endif
