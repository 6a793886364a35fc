// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SharpAngles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;
/** Ids of points inside, which the surface does not have. */
constexpr Id Inside = 100;

Vec3 MakeDirection(double degrees)
{
  return { std::cos(degrees * Pi / 180.0), std::sin(degrees * Pi / 180.0), 0.0 };
}

/**
 * Two facets at the edge from 0 to 1, with the apexes 2 and 3 far away from the edge, and a point
 * of its own each in the middle, 4 and 5.
 */
SharpAngles MakeFacets(double angle)
{
  TriangleMesh surface;
  surface.Points = { { 0.0, 0.0, 0.0 }, { 0.0, 0.0, 1.0 } };
  for (double length : { 1.0, 0.3 })
  {
    for (double turn : { 0.0, angle })
    {
      surface.Points.push_back(length * MakeDirection(turn) + Vec3{ 0.0, 0.0, 0.5 });
    }
  }
  surface.Triangles = { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 0, 4 }, { 0, 1, 5 }, { 1, 3, 5 },
    { 3, 0, 5 } };
  StructuralEdge edge;
  edge.Points = { 0, 1 };
  edge.DihedralAngle = angle;
  return SharpAngles(surface, { edge });
}

/** Two edges from 0, in pieces that go straight on: to 1 and 2, and to 3 and 4. */
SharpAngles MakeArms(double angle)
{
  TriangleMesh surface;
  surface.Points = { { 0.1, 0.2, 0.3 } };
  std::vector<StructuralEdge> edges;
  for (double turn : { 0.0, angle })
  {
    for (double length : { 0.1, 2.0 })
    {
      const Id id = static_cast<Id>(surface.Points.size());
      surface.Points.push_back(surface.Points[0] + length * MakeDirection(turn));
      StructuralEdge edge;
      edge.Points = { length < 1.0 ? 0 : id - 1, id };
      edge.DihedralAngle = 120.0;
      edges.push_back(edge);
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const StructuralEdge& a, const StructuralEdge& b) { return a.Points < b.Points; });
  return SharpAngles(surface, edges);
}
} // namespace

TEST(SharpAngles, BetweenFacets)
{
  for (double angle : { 1.0, 30.0, 59.0, 61.0, 120.0 })
  {
    SCOPED_TRACE(angle);
    const bool isSharp = angle < 60.0;
    const SharpAngles angles = MakeFacets(angle);
    EXPECT_EQ(angles.IsAtCorner({ 0, Inside, Inside + 1, Inside + 2 }), isSharp);
    EXPECT_FALSE(angles.IsAtCorner({ 2, 3, 4, Inside }));
    EXPECT_EQ(angles.IsAcross({ 2, 3, Inside, Inside + 1 }), isSharp);
    EXPECT_EQ(angles.IsAcross({ Inside, 4, Inside + 1, 5 }), isSharp);
    // On one side only, with the edge, or inside.
    EXPECT_FALSE(angles.IsAcross({ 2, 4, Inside, Inside + 1 }));
    EXPECT_FALSE(angles.IsAcross({ 0, 1, 4, Inside }));
    EXPECT_FALSE(angles.IsAcross({ Inside, Inside + 1, Inside + 2, Inside + 3 }));
  }
}

TEST(SharpAngles, BetweenEdges)
{
  for (double angle : { 1.0, 29.0, 31.0, 90.0, 180.0 })
  {
    SCOPED_TRACE(angle);
    const bool isSharp = angle < 30.0;
    const SharpAngles angles = MakeArms(angle);
    EXPECT_EQ(angles.IsAtCorner({ 0, Inside, Inside + 1, Inside + 2 }), isSharp);
    EXPECT_FALSE(angles.IsAtCorner({ 1, 2, 3, 4 }));
    EXPECT_EQ(angles.IsAcross({ 1, 3, Inside, Inside + 1 }), isSharp);
    EXPECT_EQ(angles.IsAcross({ 4, Inside, Inside + 1, 1 }), isSharp);
    EXPECT_FALSE(angles.IsAcross({ 1, 2, Inside, Inside + 1 }));
    EXPECT_FALSE(angles.IsAcross({ 0, 3, 4, Inside }));
  }
}

TEST(SharpAngles, NoEdgesNoAngles)
{
  TriangleMesh surface;
  surface.Points = { { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 } };
  surface.Triangles = { { 0, 1, 2 } };
  const SharpAngles angles(surface, {});
  EXPECT_FALSE(angles.IsAtCorner({ 0, 1, 2, 3 }));
  EXPECT_FALSE(angles.IsAcross({ 0, 1, 2, 3 }));
}
