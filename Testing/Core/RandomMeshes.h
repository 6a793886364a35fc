// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomMeshes.h
 * @brief Delaunay meshes of random points in the unit cube, for the tests.
 */
#ifndef cdmRandomMeshes_h
#define cdmRandomMeshes_h

#include "HullMeshes.h"

#include <random>
#include <vector>

namespace cdm
{
inline Vec3 DrawPoint(std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double x = uniform(generator);
  const double y = uniform(generator);
  return { x, y, uniform(generator) };
}

/** The mesh fills the convex hull of the points. */
inline TetMesh MakeRandomMesh(int numberOfPoints, std::mt19937_64& generator)
{
  std::vector<Vec3> points;
  for (int i = 0; i < numberOfPoints; ++i)
  {
    points.push_back(DrawPoint(generator));
  }
  return testing_core::MakeHullMesh(points);
}
} // namespace cdm

#endif
