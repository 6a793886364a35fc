// SPDX-License-Identifier: BSD-3-Clause
// Triangles and edges that a point encroaches on, beside the exact predicates for each of them.
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Improvement/BoundarySpheres.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
/** Small triangles near a place, of all shapes down to needles, and an edge of each. */
struct RandomBoundary
{
  RandomBoundary(const Vec3& place, double size, std::mt19937_64& generator)
  {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto pick = [&] {
      return Vec3{ uniform(generator), uniform(generator), uniform(generator) };
    };
    for (Id t = 0; t < 60; ++t)
    {
      const Vec3 corner = pick();
      const Vec3 side = 0.5 * pick();
      const double width = std::pow(10.0, 4.0 * (uniform(generator) - 1.0));
      this->Surface.Points.push_back(place + size * corner);
      this->Surface.Points.push_back(place + size * (corner + side));
      this->Surface.Points.push_back(place + size * (corner + 0.7 * side + width * pick()));
      this->Surface.Triangles.push_back({ 3 * t, 3 * t + 1, 3 * t + 2 });
      StructuralEdge edge;
      edge.Points = { 3 * t, 3 * t + 1 };
      this->Edges.push_back(edge);
    }
  }

  /** A point at a triangle's smallest sphere, or at an edge's. */
  Vec3 PickNearSphere(std::mt19937_64& generator) const
  {
    std::uniform_int_distribution<std::size_t> choose(0, this->Surface.Triangles.size() - 1);
    const TriangleIds& ids = this->Surface.Triangles[choose(generator)];
    const std::vector<Vec3>& points = this->Surface.Points;
    const bool isEdge = choose(generator) % 2 == 0;
    const Vec3 offset = isEdge
      ? 0.5 * (points[ids[1]] - points[ids[0]])
      : GetCircumcenterOffset(points[ids[0]], points[ids[1]], points[ids[2]]);
    return points[ids[0]] + offset + Norm(offset) * MakeRandomDirection(generator);
  }

  TriangleMesh Surface;
  std::vector<StructuralEdge> Edges;
};

void ExpectAllFound(
  const RandomBoundary& boundary, const Vec3& position, const BoundarySpheres::Encroached& found)
{
  const std::vector<Vec3>& points = boundary.Surface.Points;
  for (Id t = 0; t < static_cast<Id>(boundary.Surface.Triangles.size()); ++t)
  {
    const TriangleIds& ids = boundary.Surface.Triangles[t];
    EXPECT_EQ(std::count(found.Triangles.begin(), found.Triangles.end(), t),
      InEquatorialSphere(points[ids[0]], points[ids[1]], points[ids[2]], position) >= 0 ? 1 : 0)
      << "triangle " << t;
    EXPECT_EQ(std::count(found.Edges.begin(), found.Edges.end(), t),
      InDiametralSphere(points[ids[0]], points[ids[1]], position) >= 0 ? 1 : 0)
      << "edge " << t;
  }
}
} // namespace

/**
 * Centers of spheres are rounded like coordinates. Where these are a hundred million times as large as
 * the triangles, that is more than the distances between spheres and points which count.
 */
TEST(BoundarySpheres, FindWhatTheExactPredicatesFind)
{
  for (const double distance : { 0.0, 1.0, 1e4, 1e8 })
  {
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
    {
      SCOPED_TRACE("distance " + std::to_string(distance) + ", seed " + std::to_string(seed));
      std::mt19937_64 generator(seed);
      const RandomBoundary boundary(
        distance * MakeRandomDirection(generator), std::max(distance * 1e-13, 1e-13), generator);
      const BoundarySpheres spheres(boundary.Surface, boundary.Edges);
      BoundarySpheres::Encroached found;
      for (int i = 0; i < 300; ++i)
      {
        const Vec3 position = boundary.PickNearSphere(generator);
        spheres.Find(position, found);
        ExpectAllFound(boundary, position, found);
      }
    }
  }
}
