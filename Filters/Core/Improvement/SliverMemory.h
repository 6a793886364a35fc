// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverMemory.h
 * @brief Remembers attempts to remove slivers that failed, so that they are not repeated before
 * something nearby has changed. Points have names, which they keep from one mesh to the next.
 *
 * Flat tetrahedra that rounding cannot remove stay flat for hundreds of rounds: nine of ten searches
 * for other last bits were for such ones, in complexes with sharp angles.
 *
 * A point is immovable if no better position was found for it, and its neighbors are the same since
 * then. Of five searches for positions one to two were for such points, of other slivers or in a
 * later pass; one in 500 of these found something.
 */
#ifndef cdmSliverMemory_h
#define cdmSliverMemory_h

#include "Core/Basics/Types.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace cdm
{
/** The attempts to remove a sliver, in this order. */
enum class SliverAttempt
{
  /** Move one of its points on the surface, where it is across a sharp angle. */
  SharpSurfaceMove,
  /** Move or remove one of its free interior points. */
  Move,
  /** Insert a point. */
  Insertion,
  /** Move one of its points on the surface, where it is not. */
  SurfaceMove
};

/** Which tetrahedra a position was searched for: those across sharp angles, or the others. */
enum class SliverPlace
{
  Elsewhere,
  SharpAngle
};

class SliverMemory
{
public:
  /** Makes a permanent name for an interior point. */
  Id MakeName() { return this->NextName++; }
  /**
   * The first name of interior points. Points of the surface have their ids as names, which are
   * smaller.
   */
  static constexpr Id FirstName = 1 << 29;

  /** Notes that the points of a tetrahedron have got other neighbors. */
  void SetChanged(const TetrahedronIds& names);
  /** Notes that all attempts up to this one have failed for the tetrahedron. */
  void SetHopeless(const TetrahedronIds& names, SliverAttempt last);
  bool IsHopeless(const TetrahedronIds& names, SliverAttempt last) const;
  /** Notes that no rounding of its points (PointRounding.h) does away with a flat tetrahedron. */
  void SetUnroundable(const TetrahedronIds& names);
  bool IsUnroundable(const TetrahedronIds& names) const;
  /** Notes that no better position was found for a point. */
  void SetImmovable(Id name, SliverPlace place);
  bool IsImmovable(Id name, SliverPlace place) const;

private:
  struct Failure
  {
    std::int64_t Time = 0;
    SliverAttempt Last = SliverAttempt::Move;
  };
  /** 0: never. */
  struct Times
  {
    /** When a point has last got other neighbors. */
    std::int64_t Change = 0;
    /** When the last search for a better position found none, by what it was for. */
    std::int64_t Searches[2] = {};
  };
  Times Get(Id name) const;
  Times& Get(Id name);
  bool HasChangedSince(std::int64_t time, const TetrahedronIds& names) const;

  Id NextName = FirstName;
  std::int64_t Time = 1;
  std::vector<Times> OnSurface;
  std::vector<Times> Inside;
  struct NamesHash
  {
    std::size_t operator()(const TetrahedronIds& names) const;
  };
  /** The last failure for each sliver, whose key are the sorted names of its points. */
  std::unordered_map<TetrahedronIds, Failure, NamesHash> Failures;
  /** When the last rounding failed for each flat tetrahedron, by the sorted names of its points. */
  std::unordered_map<TetrahedronIds, std::int64_t, NamesHash> FailedRoundings;
};
} // namespace cdm

#endif
