// SPDX-License-Identifier: BSD-3-Clause
// Point sets that tests of the engine and of the filters have in common; Point is made of three
// coordinates in braces.
#ifndef PointSets_h
#define PointSets_h

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace testing_points
{
template <typename Point>
std::vector<Point> MakeRandom(int count, unsigned seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Point> points(static_cast<std::size_t>(count));
  for (Point& p : points)
  {
    p = { uniform(generator), uniform(generator), uniform(generator) };
  }
  return points;
}

/** A regular grid, turned about z, in random order: the numbers say nothing about places. */
template <typename Point>
std::vector<Point> MakeGrid(int size, double spacing, double angle, unsigned seed)
{
  std::vector<Point> points;
  for (int i = 0; i < size * size * size; ++i)
  {
    const double x = spacing * (i % size);
    const double y = spacing * (i / size % size);
    const double z = spacing * (i / size / size);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    points.push_back(angle == 0.0 ? Point{ x, y, z } : Point{ c * x - s * y, s * x + c * y, z });
  }
  std::mt19937 generator(seed);
  std::shuffle(points.begin(), points.end(), generator);
  return points;
}
} // namespace testing_points

#endif
