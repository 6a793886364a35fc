// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SharpAngles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

/** A surface, and what is sharp in it. */
struct Sharp
{
  Sharp(const TriangleMesh& surface, std::vector<StructuralEdge> edges,
    double planeAngle = UsualSharpPlaneAngle)
    : Surface(surface), Edges(std::move(edges)),
      Angles(this->Surface, this->Edges,
        ListTrianglesAtPoints(this->Surface.Triangles, this->Surface.Points.size()), planeAngle)
  {
  }

  TriangleMesh Surface;
  std::vector<StructuralEdge> Edges;
  SharpAngles Angles;
};

/**
 * Two facets at the edge from 0 to 1, with the apexes 2 and 3 far away from the edge, and a point
 * of its own each in the middle, 4 and 5.
 */
Sharp MakeFacets(double angle)
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
  return { surface, { edge } };
}

/** Two edges from 0, in pieces that go straight on: to 1 and 2, and to 3 and 4. */
Sharp MakeArms(double angle)
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
  return { surface, edges };
}

/**
 * From 0, an edge to 1 with the facets to 2 and 3, and below it a facet with the corners 4 and 5;
 * each two edges are at least 31 degrees apart.
 */
Sharp MakeTip(double angle)
{
  TriangleMesh surface;
  surface.Points = { { 0.0, 0.0, 0.0 }, MakeDirection(angle), { 1.0, 2.0, -1.0 }, { 1.0, 2.0, 1.0 },
    { 1.0, 0.0, -0.8 }, { 1.0, 0.0, 0.8 } };
  surface.Triangles = { { 0, 1, 2 }, { 0, 3, 1 }, { 0, 4, 5 } };
  std::vector<StructuralEdge> edges;
  for (Id end = 1; end < 6; ++end)
  {
    StructuralEdge edge;
    edge.Points = { 0, end };
    edge.DihedralAngle = 90.0;
    edges.push_back(edge);
  }
  return { surface, edges };
}

/**
 * From 0, edges to 1 and 2 with a plane angle between them, in a facet or not; at the first edge a
 * facet with the apex 3, turned by an angle about the edge from where 2 is. Its point 4 is seen
 * from 0 at a given angle from the first edge.
 */
Sharp MakeShadow(double angle, bool isFacet, double turn, double pointAngle)
{
  const Vec3 along{ 1.0, 0.0, 0.0 };
  const Vec3 across = MakeDirection(turn);
  const Vec3 height{ 0.0, across.X, across.Y };
  const Vec3 seen = MakeDirection(pointAngle);
  TriangleMesh surface;
  surface.Points = { { 0.0, 0.0, 0.0 }, along, MakeDirection(angle), 0.5 * along + height,
    0.4 * (seen.X * along + seen.Y * height), { 0.0, 0.0, -1.0 } };
  const Id last = isFacet ? 1 : 5;
  surface.Triangles = { { 0, 2, last }, { 1, 0, 4 }, { 3, 1, 4 }, { 0, 3, 4 } };
  std::vector<StructuralEdge> edges;
  for (Id end : { 1, 2, 3, 5 })
  {
    StructuralEdge edge;
    edge.Points = { 0, end };
    edge.DihedralAngle = 90.0;
    edges.push_back(edge);
  }
  return { surface, edges };
}
} // namespace

TEST(SharpAngles, BetweenFacets)
{
  for (double angle : { 1.0, 30.0, 59.0, 61.0, 120.0 })
  {
    SCOPED_TRACE(angle);
    const bool isSharp = angle < 60.0;
    const Sharp sharp = MakeFacets(angle);
    EXPECT_FALSE(sharp.Angles.IsAcross({ 0, Inside, Inside + 1, Inside + 2 }));
    EXPECT_EQ(sharp.Angles.IsAcross({ 2, 3, Inside, Inside + 1 }), isSharp);
    EXPECT_EQ(sharp.Angles.IsAcross({ Inside, 4, Inside + 1, 5 }), isSharp);
    // On one side only, with the edge, or inside.
    EXPECT_FALSE(sharp.Angles.IsAcross({ 2, 4, Inside, Inside + 1 }));
    EXPECT_FALSE(sharp.Angles.IsAcross({ 0, 1, 4, Inside }));
    EXPECT_FALSE(sharp.Angles.IsAcross({ Inside, Inside + 1, Inside + 2, Inside + 3 }));
  }
}

TEST(SharpAngles, BetweenEdges)
{
  for (double angle : { 1.0, 29.0, 31.0, 90.0, 180.0 })
  {
    SCOPED_TRACE(angle);
    const bool isSharp = angle < 30.0;
    const Sharp sharp = MakeArms(angle);
    EXPECT_FALSE(sharp.Angles.IsAcross({ 0, Inside, Inside + 1, Inside + 2 }));
    EXPECT_EQ(sharp.Angles.IsAcross({ 1, 3, Inside, Inside + 1 }), isSharp);
    EXPECT_EQ(sharp.Angles.IsAcross({ 4, Inside, Inside + 1, 1 }), isSharp);
    EXPECT_FALSE(sharp.Angles.IsAcross({ 1, 2, Inside, Inside + 1 }));
    EXPECT_FALSE(sharp.Angles.IsAcross({ 0, 3, 4, Inside }));
  }
}

TEST(SharpAngles, ForSliversOnlySmallPlaneAnglesAreSharp)
{
  for (double angle : { 1.0, 11.0, 13.0, 29.0 })
  {
    SCOPED_TRACE(angle);
    for (double limit : { UsualSharpPlaneAngle, SharpPlaneAngleOfEmptySpheres })
    {
      const Sharp made = MakeArms(angle);
      const Sharp sharp(made.Surface, made.Edges, limit);
      EXPECT_TRUE(sharp.Angles.IsAcross({ 1, 3, Inside, Inside + 1 }));
      EXPECT_EQ(sharp.Angles.IsAcross({ 1, 3, Inside, Inside + 1 }, SharpAngleUse::Sliver),
        angle < SharpPlaneAngleOfSlivers);
    }
    EXPECT_EQ(MakeShadow(angle, true, 80.0, 0.5 * angle)
                .Angles.IsAcross({ 1, 4, Inside, Inside + 1 }, SharpAngleUse::Sliver),
      angle < SharpPlaneAngleOfSlivers);
  }
  // Dihedral angles are sharp for both.
  EXPECT_TRUE(
    MakeFacets(40.0).Angles.IsAcross({ 2, 3, Inside, Inside + 1 }, SharpAngleUse::Sliver));
}

TEST(SharpAngles, LimitsOfPlaneAnglesAreNotSharp)
{
  for (double limit : { UsualSharpPlaneAngle, SharpPlaneAngleOfEmptySpheres })
  {
    // As they are and a little smaller than rounding leaves them.
    for (double less : { 0.0, 1e-13, 1.0 })
    {
      const Sharp made = MakeArms(limit - less);
      const Sharp sharp(made.Surface, made.Edges, limit);
      EXPECT_EQ(sharp.Angles.IsAcross({ 1, 3, Inside, Inside + 1 }), less == 1.0) << limit;
    }
  }
  EXPECT_FALSE(MakeFacets(60.0).Angles.IsAcross({ 2, 3, Inside, Inside + 1 }));
  EXPECT_FALSE(MakeFacets(60.0 - 1e-13).Angles.IsAcross({ 2, 3, Inside, Inside + 1 }));
}

TEST(SharpAngles, BetweenAnEdgeAndAFacetAtAPoint)
{
  for (double angle : { 1.0, 29.0, 31.0, 40.0 })
  {
    SCOPED_TRACE(angle);
    Sharp sharp = MakeTip(angle);
    EXPECT_FALSE(sharp.Angles.IsAcross({ 0, Inside, Inside + 1, Inside + 2 }));
    // From the edge to the corners of the facet it is more than 30 degrees.
    EXPECT_FALSE(sharp.Angles.IsAcross({ 1, 4, 5, Inside }));
    // Points of the edge and of the facet, at the foot of the first one.
    sharp.Surface.Points.push_back(0.5 * MakeDirection(angle));
    sharp.Surface.Points.push_back({ 0.5, 0.0, 0.0 });
    sharp.Surface.Triangles = { { 0, 6, 2 }, { 6, 1, 2 }, { 0, 3, 6 }, { 6, 3, 1 }, { 0, 4, 7 },
      { 4, 5, 7 }, { 5, 0, 7 } };
    sharp.Edges[0].Points = { 0, 6 };
    sharp.Edges.push_back(sharp.Edges[0]);
    sharp.Edges.back().Points = { 1, 6 };
    const Sharp refined(sharp.Surface, sharp.Edges);
    EXPECT_EQ(refined.Angles.IsAcross({ 6, 7, Inside, Inside + 1 }), angle < 30.0);
    EXPECT_EQ(refined.Angles.IsAcross({ 1, Inside, Inside + 1, 7 }), angle < 30.0);
    // On one side only, with the corner, or far apart.
    EXPECT_FALSE(refined.Angles.IsAcross({ 1, 6, 2, 3 }));
    EXPECT_FALSE(refined.Angles.IsAcross({ 0, 7, 4, 5 }));
    EXPECT_FALSE(refined.Angles.IsAcross({ 2, 3, 7, Inside }));
  }
}

TEST(SharpAngles, EdgesCastShadowsOnFacetsOfOthers)
{
  for (double angle : { 1.0, 20.0, 40.0 })
  {
    for (double turn : { 80.0, 100.0 })
    {
      for (double part : { 0.1, 1.0, 1.1 })
      {
        for (bool isFacet : { true, false })
        {
          SCOPED_TRACE(testing::Message()
            << angle << " " << turn << " " << part << (isFacet ? " in a facet" : ""));
          const Sharp sharp = MakeShadow(angle, isFacet, turn, part * angle);
          const bool isAcross = angle < 30.0 && turn < 90.0 && part <= 1.0;
          EXPECT_EQ(sharp.Angles.IsAcross({ 1, 4, Inside, Inside + 1 }), isAcross);
          EXPECT_EQ(sharp.Angles.IsAcross({ Inside, 4, Inside + 1, 1 }), isAcross);
          // The facet's apex is far from the edge; a point needs another one on the edge.
          EXPECT_FALSE(sharp.Angles.IsAcross({ 1, 3, Inside, Inside + 1 }));
          EXPECT_FALSE(sharp.Angles.IsAcross({ 3, 4, Inside, Inside + 1 }));
        }
      }
    }
  }
}

TEST(SharpAngles, NoEdgesNoAngles)
{
  TriangleMesh surface;
  surface.Points = { { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 } };
  surface.Triangles = { { 0, 1, 2 } };
  const Sharp sharp(surface, {});
  EXPECT_FALSE(sharp.Angles.IsAcross({ 0, 1, 2, 3 }));
}
