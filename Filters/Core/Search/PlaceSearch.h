// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlaceSearch.h
 * @brief Searches a better position for a point: one that increases the smallest dihedral angle.
 *
 * Method: pattern search around the best position so far, in given directions (those of a cube if
 * the point may go anywhere), in steps that become shorter when none helps. A moved point first
 * tries the mean of its neighbors (Laplacian smoothing, thesis 3.4.6), and half the way there.
 *
 * Deterministic. Cost: about a hundred ratings, fewer with less effort.
 */
#ifndef cdmPlaceSearch_h
#define cdmPlaceSearch_h

#include "Core/Basics/Vec3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cdm
{
/** The best position found for a point. "Place" means a position here. */
struct Place
{
  Vec3 Position;
  /** The angle at the position, in degrees; the required angle as long as none is found. */
  double Angle = 0.0;
  bool IsFound = false;
};

/** Degrees that a change has to gain at least. */
constexpr double SmallestGain = 0.05;

/**
 * Rates a position and keeps it if it is the best. rate(position, required) returns the angle if
 * that is larger than required, otherwise any value that is not.
 */
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

/** Directions from the center of a cube of 27 points to the 26 others. */
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

/** Directions in the plane normal to a unit vector, or along it: each of them and its opposite. */
inline std::vector<Vec3> MakeDirections(const Vec3& axis, bool isLine)
{
  if (isLine)
  {
    return { axis, -1.0 * axis };
  }
  // The axis along which the plane has no component stays exact.
  Vec3 least;
  least[std::abs(axis.X) <= std::abs(axis.Y) && std::abs(axis.X) <= std::abs(axis.Z) ? 0
      : std::abs(axis.Y) <= std::abs(axis.Z)                                         ? 1
                                                                                     : 2] = 1.0;
  Vec3 u = Cross(axis, least);
  u = (1.0 / Norm(u)) * u;
  const Vec3 v = Cross(axis, u);
  std::vector<Vec3> directions;
  for (int i = -1; i <= 1; ++i)
  {
    for (int j = -1; j <= 1; ++j)
    {
      if (i != 0 || j != 0)
      {
        directions.push_back(static_cast<double>(i) * u + static_cast<double>(j) * v);
      }
    }
  }
  return directions;
}

/** How long a search goes on. */
struct SearchEffort
{
  /** Largest number of steps, taken or halved. */
  int Steps = 5;
  /** After how many steps a search ends that has found nothing. */
  int Patience = 5;
};

/**
 * Searches until the angle reaches the target, or the steps are too short.
 * @param directions of any length but 0
 */
template <typename Rate>
void SearchPlace(const Vec3& start, double step, const std::vector<Vec3>& directions, double target,
  Rate&& rate, Place& best, const SearchEffort& effort = {})
{
  const int patience = std::min(effort.Patience, effort.Steps);
  for (int i = 0; i < (best.IsFound ? effort.Steps : patience) && best.Angle < target; ++i)
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
 * Searches a position for a point that may move in any direction.
 * @param nearest distance to its nearest neighbor
 */
template <typename Rate>
void SearchMove(const Vec3& old, const Vec3& mean, double nearest, double target, Rate&& rate,
  Place& best, const SearchEffort& effort = {})
{
  TryPlace(mean, rate, best);
  TryPlace(0.5 * (old + mean), rate, best);
  SearchPlace(old, FirstMove * nearest, MakeCubeDirections(), target, rate, best, effort);
}
} // namespace cdm

#endif
