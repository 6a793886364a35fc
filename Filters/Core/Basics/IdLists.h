// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IdLists.h
 * @brief A list of ids for each of many owners: the triangles at each point, and the like.
 *
 * Cost: O(n) to build; 4 bytes per id and 8 per owner. A list that is replaced takes O(its ids).
 */
#ifndef cdmIdLists_h
#define cdmIdLists_h

#include "Core/Basics/SortedIds.h"
#include "Core/Basics/Types.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace cdm
{
/** Ids in one list, a range of it for each owner. */
class IdLists
{
public:
  struct Range
  {
    const Id* First = nullptr;
    const Id* Last = nullptr;

    const Id* begin() const { return this->First; }
    const Id* end() const { return this->Last; }
    bool empty() const { return this->First == this->Last; }
    std::size_t size() const { return static_cast<std::size_t>(this->Last - this->First); }
  };

  /**
   * Builds the lists from pairs (owner, id). A list has the order of the pairs, without repetitions
   * in a row.
   */
  void Build(Id numberOfOwners, const std::vector<std::pair<Id, Id>>& pairs)
  {
    std::vector<Id> next(static_cast<std::size_t>(numberOfOwners) + 1, 0);
    for (const auto& pair : pairs)
    {
      ++next[pair.first + 1];
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    this->Begin = next;
    this->End.assign(next.begin(), next.end() - 1);
    this->Ids.resize(pairs.size());
    for (const auto& [owner, id] : pairs)
    {
      Id& end = this->End[owner];
      if (end == this->Begin[owner] || this->Ids[end - 1] != id)
      {
        this->Ids[end++] = id;
      }
    }
  }

  /** Builds the lists of the triangles at each point, ascending. */
  void Build(Id numberOfPoints, const std::vector<TriangleIds>& triangles)
  {
    this->Begin.assign(static_cast<std::size_t>(numberOfPoints) + 1, 0);
    for (const TriangleIds& ids : triangles)
    {
      for (const Id point : ids)
      {
        ++this->Begin[point + 1];
      }
    }
    std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
    this->End.assign(this->Begin.begin(), this->Begin.end() - 1);
    this->Ids.resize(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      for (const Id point : triangles[t])
      {
        this->Ids[this->End[point]++] = static_cast<Id>(t);
      }
    }
  }

  /** Adds an owner, after all others. */
  void Append(const std::vector<Id>& ids)
  {
    this->Begin.resize(this->End.size() + 1);
    this->Begin.back() = static_cast<Id>(this->Ids.size());
    this->Ids.insert(this->Ids.end(), ids.begin(), ids.end());
    this->Begin.push_back(static_cast<Id>(this->Ids.size()));
    this->End.push_back(this->Begin.back());
  }

  /** Gives an owner other ids. More than before take new memory, until the lists are built anew. */
  void Replace(Id owner, const std::vector<Id>& ids)
  {
    Id& begin = this->Begin[owner];
    if (ids.size() > (*this)[owner].size())
    {
      begin = static_cast<Id>(this->Ids.size());
      this->Ids.resize(this->Ids.size() + ids.size());
    }
    std::copy(ids.begin(), ids.end(), this->Ids.begin() + begin);
    this->End[owner] = begin + static_cast<Id>(ids.size());
  }
  /** What the lists take, with what Replace() has left behind. */
  std::size_t GetNumberOfIds() const { return this->Ids.size(); }

  Range operator[](Id owner) const
  {
    return { this->Ids.data() + this->Begin[owner], this->Ids.data() + this->End[owner] };
  }
  Id GetNumberOfOwners() const { return static_cast<Id>(this->End.size()); }

private:
  std::vector<Id> Begin;
  std::vector<Id> End;
  std::vector<Id> Ids;
};

/** The triangles at each point. */
inline IdLists ListTrianglesAtPoints(
  const std::vector<TriangleIds>& triangles, std::size_t numberOfPoints)
{
  IdLists lists;
  lists.Build(static_cast<Id>(numberOfPoints), triangles);
  return lists;
}

/** The triangle of three points, which may be others than those of the lists; or NoId. */
inline Id FindTriangle(const std::vector<TriangleIds>& triangles, const IdLists& pointTriangles,
  const TriangleIds& points)
{
  const Id count = pointTriangles.GetNumberOfOwners();
  if (points[0] >= count || points[1] >= count || points[2] >= count)
  {
    return NoId;
  }
  const IdLists::Range around = pointTriangles[points[0]];
  const Id* const found = std::find_if(around.begin(), around.end(),
    [&](Id t) { return Contains(triangles[t], points[1]) && Contains(triangles[t], points[2]); });
  return found != around.end() ? *found : NoId;
}

/** Whether three points have a triangle. */
inline bool IsTriangle(const std::vector<TriangleIds>& triangles, const IdLists& pointTriangles,
  const TriangleIds& points)
{
  return FindTriangle(triangles, pointTriangles, points) != NoId;
}
} // namespace cdm

#endif
