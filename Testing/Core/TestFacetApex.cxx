// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/ExecutionContext.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Delaunay/FacetApex.h"
#include "Core/Meshes/TetMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>

using namespace cdm;

namespace
{
/** Random points, or some on a lattice, of which many lie on one sphere, or in one plane. */
RawVector<Vec3> MakePoints(std::mt19937_64& generator, bool isLattice, Id count)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::uniform_int_distribution<int> lattice(0, 2);
  std::set<std::array<double, 3>> points;
  while (static_cast<Id>(points.size()) < count)
  {
    points.insert(isLattice
        ? std::array<double, 3>{ 0.1 * lattice(generator), 0.1 * lattice(generator),
            0.1 * lattice(generator) }
        : std::array<double, 3>{ uniform(generator), uniform(generator), uniform(generator) });
  }
  RawVector<Vec3> result;
  for (const auto& [x, y, z] : points)
  {
    result.push_back({ x, y, z });
  }
  std::shuffle(result.begin(), result.end(), generator);
  return result;
}

TriangleIds Reverse(const TriangleIds& facet)
{
  return { facet[0], facet[2], facet[1] };
}
} // namespace

TEST(FacetApex, IsThatOfTheDelaunayTetrahedron)
{
  for (unsigned int seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const Id count = 5 + static_cast<Id>(generator() % 20);
    const RawVector<Vec3> points = MakePoints(generator, seed % 2 == 0, count);
    std::vector<Id> numbers;
    for (Id i = 0; i < count; ++i)
    {
      numbers.push_back(10 + 3 * i);
    }
    DelaunayTetrahedralization mesh;
    ASSERT_TRUE(BuildDelaunayTetrahedralization(points, numbers, GridBlock(), 1, {}, mesh).IsOk());
    FacetApex apex(points, numbers);
    std::set<TriangleIds> facets;
    for (const TetrahedronIds& ids : mesh.Tetrahedra)
    {
      if (ids[0] == NoId || *std::max_element(ids.begin(), ids.end()) == count)
      {
        continue;
      }
      for (int i = 0; i < 4; ++i)
      {
        const TriangleIds inwards = Reverse(GetFacet(ids, i));
        EXPECT_EQ(apex.Find(inwards, false), ids[i]);
        EXPECT_EQ(apex.Find(inwards, true), ids[i]);
        TriangleIds key = inwards;
        std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
        facets.insert(key);
      }
    }
    // All other facets have none, seen from either side.
    for (Id a = 0; a < count; ++a)
    {
      for (Id b = a + 1; b < count; ++b)
      {
        for (Id c = a + 1; c < count; ++c)
        {
          if (b != c && facets.count({ a, b, c }) == 0)
          {
            EXPECT_EQ(apex.Find({ a, b, c }, false), NoId) << a << " " << b << " " << c;
          }
        }
      }
    }
  }
}
