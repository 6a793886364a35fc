// SPDX-License-Identifier: BSD-3-Clause
// Facets whose points a file has rounded, without Steiner points: they need no more points than those
// that are plane, and no coupling is negative in them. Seeds are printed.
#include "Core/Pipeline/ConformingMesher.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
constexpr double TwoPi = 6.283185307179586;

void AddTriangle(PolygonSoup& soup, const TriangleIds& ids)
{
  soup.Connectivity.insert(soup.Connectivity.end(), ids.begin(), ids.end());
  soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
}

/** A cylinder, as wide as high, whose ends are oblique by a slope. */
PolygonSoup MakeCylinder(Id sides, double slope)
{
  PolygonSoup soup;
  for (const double z : { -0.5, 0.5 })
  {
    for (Id i = 0; i < sides; ++i)
    {
      const double angle = TwoPi * static_cast<double>(i) / static_cast<double>(sides);
      soup.Points.push_back({ 0.5 * std::cos(angle), 0.5 * std::sin(angle), z });
    }
  }
  soup.Points.push_back({ 0.0, 0.0, -0.5 });
  soup.Points.push_back({ 0.0, 0.0, 0.5 });
  for (Id i = 0; i < sides; ++i)
  {
    const Id next = (i + 1) % sides;
    AddTriangle(soup, { i, next, sides + next });
    AddTriangle(soup, { i, sides + next, sides + i });
    AddTriangle(soup, { 2 * sides, next, i });
    AddTriangle(soup, { 2 * sides + 1, sides + i, sides + next });
  }
  for (Vec3& point : soup.Points)
  {
    point.Z += slope * point.X;
  }
  return soup;
}

/** The same, turned about a random axis; coordinates in single precision. */
PolygonSoup MakeRoundedCylinder(Id sides, double slope, std::uint64_t seed)
{
  PolygonSoup soup = MakeCylinder(sides, slope);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(0.0, TwoPi);
  Rotate(soup.Points, MakeRandomDirection(random), angle(random));
  RoundToSinglePrecision(soup.Points);
  return soup;
}

/** A random tetrahedron whose faces are divided in four, again and again, and then rounded. */
PolygonSoup MakeRoundedTetrahedron(int levels, double noise, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  PolygonSoup soup;
  for (int i = 0; i < 4; ++i)
  {
    soup.Points.push_back({ uniform(random), uniform(random), uniform(random) });
  }
  std::vector<TriangleIds> triangles{ { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 } };
  for (int level = 0; level < levels; ++level)
  {
    std::map<EdgeIds, Id> middles;
    const auto getMiddle = [&](Id a, Id b)
    {
      const auto [found, isNew] =
        middles.emplace(MakeEdge(a, b), static_cast<Id>(soup.Points.size()));
      if (isNew)
      {
        soup.Points.push_back(0.5 * (soup.Points[a] + soup.Points[b]));
      }
      return found->second;
    };
    std::vector<TriangleIds> finer;
    for (const auto& [a, b, c] : triangles)
    {
      const Id ab = getMiddle(a, b);
      const Id bc = getMiddle(b, c);
      const Id ca = getMiddle(c, a);
      finer.insert(finer.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
    }
    triangles = std::move(finer);
  }
  for (Vec3& point : soup.Points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] += noise * (2.0 * uniform(random) - 1.0);
    }
  }
  for (const TriangleIds& ids : triangles)
  {
    AddTriangle(soup, ids);
  }
  return soup;
}

ConformingMesherOutput Mesh(const PolygonSoup& soup, SurfaceCriterion criterion)
{
  ConformingMesherInput input;
  input.Polygons = &soup;
  ConformingMesherOptions options;
  options.MeshFor = MeshPurpose::FewestPoints;
  options.Choices.Criterion = criterion;
  ConformingMesherOutput output;
  const Status status = MeshPolygons(input, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}
} // namespace

TEST(FacetCouplings, RoundedCylindersNeedNoPoints)
{
  for (const SurfaceCriterion criterion :
    { SurfaceCriterion::SmallestSphere, SurfaceCriterion::SmallestSphereAndEdges })
  {
    for (const Id sides : { 20, 50, 250 })
    {
      for (std::uint64_t seed = 1; seed <= 3; ++seed)
      {
        SCOPED_TRACE(std::to_string(sides) + " sides, seed " + std::to_string(seed));
        const PolygonSoup soup = MakeRoundedCylinder(sides, 0.0, seed);
        const ConformingMesherOutput output = Mesh(soup, criterion);
        EXPECT_EQ(output.Mesh.Points.size(), soup.Points.size());
        EXPECT_TRUE(output.Certificate.IsClean()) << output.Certificate.GetReasons();
      }
    }
  }
}

TEST(FacetCouplings, RoundedObliqueCylindersNeedNoMorePoints)
{
  for (const SurfaceCriterion criterion :
    { SurfaceCriterion::SmallestSphere, SurfaceCriterion::SmallestSphereAndEdges })
  {
    for (const Id sides : { 100, 250 })
    {
      for (std::uint64_t seed = 1; seed <= 2; ++seed)
      {
        SCOPED_TRACE(std::to_string(sides) + " sides, seed " + std::to_string(seed));
        const std::size_t exact = Mesh(MakeCylinder(sides, 0.1), criterion).Mesh.Points.size();
        const ConformingMesherOutput output =
          Mesh(MakeRoundedCylinder(sides, 0.1, seed), criterion);
        EXPECT_LE(output.Mesh.Points.size(), exact + exact / 5);
        // Criterion 3.1 allows negative couplings at the structural edges between the sides.
        EXPECT_TRUE(criterion == SurfaceCriterion::SmallestSphere || output.Certificate.IsClean())
          << output.Certificate.GetReasons();
      }
    }
  }
}

TEST(FacetCouplings, NoneIsNegativeInRoundedFacets)
{
  for (int levels = 1; levels <= 2; ++levels)
  {
    for (std::uint64_t seed = 1; seed <= 40; ++seed)
    {
      SCOPED_TRACE(std::to_string(levels) + " levels, seed " + std::to_string(seed));
      const ConformingMesherOutput output =
        Mesh(MakeRoundedTetrahedron(levels, 1e-7, seed), SurfaceCriterion::SmallestSphereAndEdges);
      EXPECT_TRUE(output.UnresolvedTriangles.empty());
      EXPECT_EQ(output.Certificate.GetCount(MeshFault::NegativeCoupling), 0);
    }
  }
}
