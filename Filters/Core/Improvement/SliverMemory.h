// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverMemory.h
 * @brief What has been tried in vain for slivers, so that it is not tried again before something
 * has changed there. Points are known by names that they keep from one mesh to the next.
 */
#ifndef cdmSliverMemory_h
#define cdmSliverMemory_h

#include "Core/Basics/Types.h"

#include <cstdint>
#include <map>
#include <vector>

namespace cdm
{
/** What is tried for a sliver, in this order. */
enum class SliverAttempt
{
  /** To move or take out one of its free points inside. */
  Move,
  /** To put in a point. */
  Insertion,
  /** To move one of its points on the surface. */
  SurfaceMove
};

class SliverMemory
{
public:
  /** A name for a point inside of a region, for good. */
  Id MakeName() { return this->NextName++; }
  /** Names of new points are larger than ids of points of the surface, which are their names. */
  static constexpr Id FirstName = 1 << 29;

  /** That the points of a tetrahedron have got other neighbors. */
  void SetChanged(const TetrahedronIds& names);
  /** That nothing up to this has helped the tetrahedron. */
  void SetHopeless(const TetrahedronIds& names, SliverAttempt last);
  bool IsHopeless(const TetrahedronIds& names, SliverAttempt last) const;

private:
  struct Failure
  {
    std::int64_t Time = 0;
    SliverAttempt Last = SliverAttempt::Move;
  };
  std::int64_t GetChange(Id name) const;

  Id NextName = FirstName;
  std::int64_t Time = 0;
  /** Of points of the surface, and of points inside. */
  std::vector<std::int64_t> SurfaceChanges;
  std::vector<std::int64_t> InsideChanges;
  std::map<TetrahedronIds, Failure> Failures;
};
} // namespace cdm

#endif
