// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlaceSearch.h
 * @brief A better place for a point: the one that makes the smallest dihedral angle largest.
 *
 * Method: pattern search, in given directions (of a cube, where a point may go anywhere) around the
 * best place so far, in steps that become shorter where none helps. A moved point first tries the
 * mean of its neighbors (Laplacian smoothing, thesis 3.4.6), and half the way there.
 *
 * Deterministic. Cost: about a hundred ratings.
 */
#ifndef cdmPlaceSearch_h
#define cdmPlaceSearch_h

#include "Core/Basics/Vec3.h"

#include <array>
#include <vector>

namespace cdm
{
/** The best place found for a point. */
struct Place
{
  Vec3 Position;
  /** Degrees; what is required as long as nothing is found. */
  double Angle = 0.0;
  bool IsFound = false;
};

/** Degrees that a change has to gain. */
constexpr double SmallestGain = 0.05;

/** rate(position, required): the angle if it is larger than required; otherwise less than that. */
template <typename Rate>
void TryPlace(const Vec3& position, Rate&& rate, Place& best)
{
  const double angle = rate(position, best.Angle);
  if (angle > best.Angle)
  {
    best = { position, angle, true };
  }
}

/** First step of a point that moves, in distances to its nearest neighbor. */
constexpr double FirstMove = 0.3;

/** To the 26 other places of a cube of 27. */
inline std::vector<Vec3> MakeCubeDirections()
{
  std::vector<Vec3> directions;
  for (int i = 0; i < 27; ++i)
  {
    if (i != 13)
    {
      const std::array<int, 3> cell{ i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1 };
      directions.push_back({ double(cell[0]), double(cell[1]), double(cell[2]) });
    }
  }
  return directions;
}

/**
 * Until the angle reaches the target, or the steps are too short.
 * @param directions of any length but 0
 */
template <typename Rate>
void SearchPlace(const Vec3& start, double step, const std::vector<Vec3>& directions, double target,
  Rate&& rate, Place& best)
{
  /** How often the step is taken, or halved. */
  constexpr int numberOfSteps = 5;
  for (int i = 0; i < numberOfSteps && best.Angle < target; ++i)
  {
    const Vec3 base = best.IsFound ? best.Position : start;
    const double angle = best.Angle;
    for (const Vec3& direction : directions)
    {
      TryPlace(base + (step / Norm(direction)) * direction, rate, best);
    }
    step *= best.Angle > angle ? 1.0 : 0.5;
  }
}

/**
 * A place for a point that moves in any direction.
 * @param nearest distance to its nearest neighbor
 */
template <typename Rate>
void SearchMove(
  const Vec3& old, const Vec3& mean, double nearest, double target, Rate&& rate, Place& best)
{
  TryPlace(mean, rate, best);
  TryPlace(0.5 * (old + mean), rate, best);
  SearchPlace(old, FirstMove * nearest, MakeCubeDirections(), target, rate, best);
}
} // namespace cdm

#endif
