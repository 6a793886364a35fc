// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlaceSearch.h
 * @brief A better place for a point: the one that makes the smallest dihedral angle largest.
 *
 * Method: pattern search, in the 26 directions of a cube around the best place so far, in steps that
 * become shorter where none helps. A moved point first tries the mean of its neighbors (Laplacian
 * smoothing, thesis 3.4.6), and half the way there.
 *
 * Deterministic. Cost: about a hundred ratings.
 */
#ifndef cdmPlaceSearch_h
#define cdmPlaceSearch_h

#include "Core/Basics/Vec3.h"

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

/** Until the angle reaches the target, or the steps are too short. */
template <typename Rate>
void SearchPlace(const Vec3& start, double step, double target, Rate&& rate, Place& best)
{
  /** How often the step is taken, or halved. */
  constexpr int numberOfSteps = 5;
  for (int i = 0; i < numberOfSteps && best.Angle < target; ++i)
  {
    const Vec3 base = best.IsFound ? best.Position : start;
    const double angle = best.Angle;
    for (int direction = 0; direction < 27; ++direction)
    {
      const Vec3 offset{ direction % 3 - 1.0, direction / 3 % 3 - 1.0, direction / 9 - 1.0 };
      if (direction != 13)
      {
        TryPlace(base + (step / Norm(offset)) * offset, rate, best);
      }
    }
    step *= best.Angle > angle ? 1.0 : 0.5;
  }
}

/**
 * A place for a point that moves.
 * @param nearest distance to its nearest neighbor
 */
template <typename Rate>
void SearchMove(
  const Vec3& old, const Vec3& mean, double nearest, double target, Rate&& rate, Place& best)
{
  /** First step, in distances to the nearest neighbor. */
  constexpr double firstStep = 0.3;
  TryPlace(mean, rate, best);
  TryPlace(0.5 * (old + mean), rate, best);
  SearchPlace(old, firstStep * nearest, target, rate, best);
}
} // namespace cdm

#endif
