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

/** All points with whole coordinates on a sphere about the origin, in random order. */
template <typename Point>
std::vector<Point> MakeOnSphere(long long squaredRadius, unsigned seed)
{
  const auto getRoot = [](long long square)
  { return std::llround(std::sqrt(static_cast<double>(square))); };
  std::vector<Point> points;
  const long long radius = getRoot(squaredRadius) + 1;
  for (long long x = -radius; x <= radius; ++x)
  {
    for (long long y = -radius; y <= radius; ++y)
    {
      const long long rest = squaredRadius - x * x - y * y;
      const long long z = rest >= 0 ? getRoot(rest) : 0;
      if (z * z == rest)
      {
        points.push_back(
          { static_cast<double>(x), static_cast<double>(y), static_cast<double>(z) });
        if (z > 0)
        {
          points.push_back(
            { static_cast<double>(x), static_cast<double>(y), static_cast<double>(-z) });
        }
      }
    }
  }
  std::mt19937 generator(seed);
  std::shuffle(points.begin(), points.end(), generator);
  return points;
}
} // namespace testing_points

#endif
