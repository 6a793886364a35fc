// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HullMeshes.h
 * @brief Delaunay meshes of point sets for the tests: grids, lattices, random points.
 */
#ifndef HullMeshes_h
#define HullMeshes_h

#include "Core/Meshes/MeshInvariants.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace testing_core
{
/** The Delaunay mesh of the convex hull of points, region 0. */
inline cdm::TetMesh MakeHullMesh(const std::vector<cdm::Vec3>& points)
{
  cdm::AdvancingFrontTetrahedralizerInput input;
  input.MeshPoints = &points;
  cdm::AdvancingFrontTetrahedralizerOptions options;
  options.CloseOpenBoundary = true;
  cdm::AdvancingFrontTetrahedralizerOutput output;
  const cdm::Status status = cdm::TetrahedralizeByAdvancingFront(input, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output.Mesh;
}

/**
 * The tetrahedra of the hull that getRegion gives a region by their centroids; OutsideRegion leaves
 * them out.
 */
template <typename GetRegion>
cdm::TetMesh MakeRegionMesh(const std::vector<cdm::Vec3>& points, GetRegion&& getRegion)
{
  const cdm::TetMesh hull = MakeHullMesh(points);
  cdm::TetMesh mesh;
  mesh.Points = hull.Points;
  for (const cdm::TetrahedronIds& ids : hull.Tetrahedra)
  {
    const cdm::Vec3 center = 0.25 *
      (mesh.Points[ids[0]] + mesh.Points[ids[1]] + mesh.Points[ids[2]] + mesh.Points[ids[3]]);
    const cdm::Id region = getRegion(center);
    if (region != cdm::OutsideRegion)
    {
      mesh.Tetrahedra.push_back(ids);
      mesh.Regions.push_back(region);
    }
  }
  EXPECT_TRUE(cdm::BuildNeighbors(mesh).IsOk());
  return mesh;
}

/** Random points in the unit cube. rounding: coordinates are multiples of it. */
inline std::vector<cdm::Vec3> MakeRandomPoints(int count, unsigned seed, double rounding = 0.0)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  std::vector<cdm::Vec3> points(count);
  for (cdm::Vec3& point : points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] = coordinate(random);
      if (rounding > 0.0)
      {
        point[axis] = std::rint(point[axis] / rounding) * rounding;
      }
    }
  }
  return points;
}

/** Points of a cubic grid. */
inline std::vector<cdm::Vec3> MakeGrid(int size, double spacing)
{
  std::vector<cdm::Vec3> points;
  for (int i = 0; i < size * size * size; ++i)
  {
    points.push_back(
      { spacing * (i % size), spacing * (i / size % size), spacing * (i / size / size) });
  }
  return points;
}
} // namespace testing_core

#endif
