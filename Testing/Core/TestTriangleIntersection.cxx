// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/TriangleIntersection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

using namespace cdm;

namespace
{
TriangleContact Classify(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t)
{
  const TriangleContact contact = ClassifyTriangles(points, s, t);
  // Neither the order of the triangles nor that of their vertices plays a role.
  for (int turn = 0; turn < 3; ++turn)
  {
    const TriangleIds turned{ s[turn], s[(turn + 1) % 3], s[(turn + 2) % 3] };
    const TriangleIds reversed{ s[turn], s[(turn + 2) % 3], s[(turn + 1) % 3] };
    EXPECT_EQ(contact, ClassifyTriangles(points, turned, t));
    EXPECT_EQ(contact, ClassifyTriangles(points, reversed, t));
    EXPECT_EQ(contact, ClassifyTriangles(points, t, turned));
    EXPECT_EQ(contact, ClassifyTriangles(points, t, reversed));
  }
  return contact;
}

/** (0, 1, 2) against (3, 4, 5). */
TriangleContact ClassifySeparate(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e, const Vec3& f)
{
  return Classify({ a, b, c, d, e, f }, { 0, 1, 2 }, { 3, 4, 5 });
}

/** The same question on small integers by other means: the theorem of the separating axis. */
using Vector = std::array<std::int64_t, 3>;

Vector operator-(const Vector& a, const Vector& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

Vector Product(const Vector& a, const Vector& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

std::int64_t Scalar(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool IsZero(const Vector& a)
{
  return a == Vector{ 0, 0, 0 };
}

/** Whether an axis tells two convex hulls of points or vertices of triangles apart. */
bool Separates(const Vector& axis, const std::vector<Vector>& s, const std::vector<Vector>& t)
{
  const auto less = [&axis](const Vector& a, const Vector& b)
  { return Scalar(axis, a) < Scalar(axis, b); };
  const auto boundsS = std::minmax_element(s.begin(), s.end(), less);
  const auto boundsT = std::minmax_element(t.begin(), t.end(), less);
  return less(*boundsS.second, *boundsT.first) || less(*boundsT.second, *boundsS.first);
}

bool DoHullsMeet(const std::vector<Vector>& s, const std::vector<Vector>& t)
{
  std::vector<Vector> edges[2];
  for (int k = 0; k < 2; ++k)
  {
    const std::vector<Vector>& hull = k == 0 ? s : t;
    for (std::size_t i = 0; i < hull.size(); ++i)
    {
      edges[k].push_back(hull[(i + 1) % hull.size()] - hull[i]);
    }
  }
  std::vector<Vector> axes{ { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  std::vector<Vector> normals;
  for (const std::vector<Vector>& e : edges)
  {
    normals.push_back(Product(e[0], e[1]));
  }
  for (const Vector& u : edges[0])
  {
    for (const Vector& v : edges[1])
    {
      axes.push_back(Product(u, v));
      if (IsZero(axes.back()))
      {
        // Parallel edges: the direction between them, perpendicular to both.
        const Vector w = Product(u, t[0] - s[0]);
        axes.push_back(Product(u, w));
      }
    }
  }
  axes.insert(axes.end(), normals.begin(), normals.end());
  for (const std::vector<Vector>& e : edges)
  {
    for (const Vector& u : e)
    {
      for (const Vector& normal : normals)
      {
        axes.push_back(Product(u, normal));
      }
    }
  }
  return std::none_of(axes.begin(), axes.end(),
    [&](const Vector& axis) { return !IsZero(axis) && Separates(axis, s, t); });
}

/** v + 1000 (p - v): far out on the ray. */
Vector Stretch(const Vector& v, const Vector& p)
{
  return { v[0] + 1000 * (p[0] - v[0]), v[1] + 1000 * (p[1] - v[1]), v[2] + 1000 * (p[2] - v[2]) };
}

TriangleContact ClassifyByAxes(
  const std::vector<Vector>& p, const TriangleIds& s, const TriangleIds& t)
{
  std::vector<Id> common;
  std::vector<Id> restS;
  std::vector<Id> restT;
  for (const Id id : s)
  {
    (std::find(t.begin(), t.end(), id) != t.end() ? common : restS).push_back(id);
  }
  for (const Id id : t)
  {
    if (std::find(s.begin(), s.end(), id) == s.end())
    {
      restT.push_back(id);
    }
  }
  if (common.empty())
  {
    return DoHullsMeet({ p[s[0]], p[s[1]], p[s[2]] }, { p[t[0]], p[t[1]], p[t[2]] })
      ? TriangleContact::Intersection
      : TriangleContact::Disjoint;
  }
  if (common.size() == 1)
  {
    // A common direction: the far edge of s meets t blown up from the common vertex.
    const Vector& v = p[common[0]];
    return DoHullsMeet(
             { p[restS[0]], p[restS[1]] }, { v, Stretch(v, p[restT[0]]), Stretch(v, p[restT[1]]) })
      ? TriangleContact::Intersection
      : TriangleContact::CommonVertex;
  }
  const Vector& u = p[common[0]];
  const Vector& v = p[common[1]];
  const Vector left = Product(v - u, p[restS[0]] - u);
  const Vector right = Product(v - u, p[restT[0]] - u);
  return IsZero(Product(left, right)) && Scalar(left, right) > 0 ? TriangleContact::Intersection
                                                                 : TriangleContact::CommonEdge;
}
} // namespace

TEST(TriangleIntersection, SeparateTriangles)
{
  const Vec3 a{ 0, 0, 0 };
  const Vec3 b{ 4, 0, 0 };
  const Vec3 c{ 0, 4, 0 };
  const auto classify = [&](const Vec3& d, const Vec3& e, const Vec3& f)
  { return ClassifySeparate(a, b, c, d, e, f); };
  EXPECT_EQ(TriangleContact::Disjoint, classify({ 0, 0, 1 }, { 4, 0, 1 }, { 0, 4, 1 }));
  EXPECT_EQ(TriangleContact::Intersection, classify({ 1, 1, -1 }, { 1, 1, 1 }, { 9, 9, 0 }));
  // Planes cross, triangles do not.
  EXPECT_EQ(TriangleContact::Disjoint, classify({ 3, 3, -1 }, { 3, 3, 1 }, { 9, 9, 0 }));
  // A vertex in the interior, an edge on it, a vertex on an edge, an edge through an edge.
  EXPECT_EQ(TriangleContact::Intersection, classify({ 1, 1, 0 }, { 1, 1, 1 }, { 2, 1, 1 }));
  EXPECT_EQ(TriangleContact::Intersection, classify({ 1, 1, 0 }, { 2, 1, 0 }, { 2, 1, 1 }));
  EXPECT_EQ(TriangleContact::Intersection, classify({ 2, 0, 0 }, { 2, -1, 1 }, { 3, -1, 1 }));
  EXPECT_EQ(TriangleContact::Intersection, classify({ 2, 0, -1 }, { 2, 0, 1 }, { 2, -3, 0 }));
  // Coplanar: inside, around, star of David, edges on one line, apart.
  EXPECT_EQ(TriangleContact::Intersection, classify({ 1, 1, 0 }, { 2, 1, 0 }, { 1, 2, 0 }));
  EXPECT_EQ(TriangleContact::Intersection, classify({ -9, -1, 0 }, { 20, -1, 0 }, { -9, 20, 0 }));
  EXPECT_EQ(TriangleContact::Intersection, classify({ 3, 3, 0 }, { -1, 2, 0 }, { 2, -1, 0 }));
  EXPECT_EQ(TriangleContact::Intersection, classify({ 1, 0, 0 }, { 3, 0, 0 }, { 2, -1, 0 }));
  EXPECT_EQ(TriangleContact::Disjoint, classify({ 5, 0, 0 }, { 7, 0, 0 }, { 6, -1, 0 }));
  EXPECT_EQ(TriangleContact::Disjoint, classify({ 3, 3, 0 }, { 4, 3, 0 }, { 3, 4, 0 }));
}

TEST(TriangleIntersection, CommonVertex)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 }, { -1, 0, 0 }, { 0, -1, 0 },
    { 1, 1, 0 }, { 1, 1, 1 }, { 1, 1, -1 }, { 0, 0, 1 }, { 5, 0, 0 }, { 3, 3, 5 }, { 4, 4, -1 } };
  const TriangleIds s{ 0, 1, 2 };
  EXPECT_EQ(TriangleContact::CommonVertex, Classify(points, s, { 0, 3, 4 }));
  EXPECT_EQ(TriangleContact::Intersection, Classify(points, s, { 0, 5, 4 }));
  EXPECT_EQ(TriangleContact::Intersection, Classify(points, s, { 0, 5, 8 }));
  EXPECT_EQ(TriangleContact::Intersection, Classify(points, s, { 0, 6, 7 }));
  EXPECT_EQ(TriangleContact::CommonVertex, Classify(points, s, { 0, 6, 8 }));
  // Along an edge of s, and through s far out.
  EXPECT_EQ(TriangleContact::Intersection, Classify(points, s, { 0, 9, 8 }));
  EXPECT_EQ(TriangleContact::Intersection, Classify(points, s, { 0, 10, 11 }));
}

TEST(TriangleIntersection, CommonEdge)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, -1, 0 }, { 1, 1, 0 },
    { 0, 1, 1e-300 } };
  const TriangleIds s{ 0, 1, 2 };
  EXPECT_EQ(TriangleContact::CommonEdge, Classify(points, s, { 1, 0, 3 }));
  EXPECT_EQ(TriangleContact::Intersection, Classify(points, s, { 1, 0, 4 }));
  EXPECT_EQ(TriangleContact::CommonEdge, Classify(points, s, { 1, 0, 5 }));
  EXPECT_EQ(TriangleContact::Intersection, Classify(points, s, { 1, 0, 2 }));
}

TEST(TriangleIntersection, AgreesWithSeparatingAxesOnDegeneratePositions)
{
  std::mt19937 random(7);
  int counts[4] = {};
  for (int run = 0; run < 60000; ++run)
  {
    const auto size = 3 + run % 3;
    const bool isFlat = run % 2 == 0;
    std::vector<Vector> integers;
    std::vector<Vec3> points;
    while (integers.size() < 6)
    {
      const Vector p{ static_cast<std::int64_t>(random() % size),
        static_cast<std::int64_t>(random() % size),
        isFlat ? 0 : static_cast<std::int64_t>(random() % size) };
      if (std::find(integers.begin(), integers.end(), p) == integers.end())
      {
        integers.push_back(p);
        points.push_back({ double(p[0]), double(p[1]), double(p[2]) });
      }
    }
    const Id common = static_cast<Id>(random() % 3);
    const TriangleIds s{ 0, 1, 2 };
    const TriangleIds t{ 3 - common, 4 - common, 5 - common };
    if (IsZero(Product(integers[s[1]] - integers[s[0]], integers[s[2]] - integers[s[0]])) ||
      IsZero(Product(integers[t[1]] - integers[t[0]], integers[t[2]] - integers[t[0]])))
    {
      continue;
    }
    const TriangleContact contact = Classify(points, s, t);
    ASSERT_EQ(ClassifyByAxes(integers, s, t), contact) << "run " << run;
    ++counts[static_cast<int>(contact)];
  }
  for (const int count : counts)
  {
    EXPECT_GT(count, 1000);
  }
}

TEST(TriangleIntersection, SegmentToShow)
{
  const std::vector<Vec3> points{ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 }, { 1, 1, -1 }, { 1, 1, 1 },
    { 1, 9, 0 }, { 1, 0, 0 }, { 3, 0, 0 }, { 2, -1, 0 } };
  Vec3 begin;
  Vec3 end;
  FindIntersectionSegment(points, { 0, 1, 2 }, { 3, 4, 5 }, begin, end);
  EXPECT_EQ((Vec3{ 1, 1, 0 }), std::min(begin, end));
  EXPECT_EQ((Vec3{ 1, 3, 0 }), std::max(begin, end));
  FindIntersectionSegment(points, { 0, 1, 2 }, { 6, 7, 8 }, begin, end);
  EXPECT_EQ((Vec3{ 1, 0, 0 }), std::min(begin, end));
  EXPECT_EQ((Vec3{ 3, 0, 0 }), std::max(begin, end));
}
