// SPDX-License-Identifier: BSD-3-Clause
#include "../Support/PointSets.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Delaunay/PartTetrahedralization.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/SpacePartition.h"
#include "Core/Search/SpatialSort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
using Numbers4 = std::array<std::int64_t, 4>;
using Numbers3 = std::array<std::int64_t, 3>;

/** The tetrahedra and hull facets of all points, as sorted numbers. */
struct Whole
{
  std::vector<Numbers4> Tetrahedra;
  std::vector<Numbers3> Hull;

  void Sort()
  {
    std::sort(this->Tetrahedra.begin(), this->Tetrahedra.end());
    std::sort(this->Hull.begin(), this->Hull.end());
  }
};

Whole MakeWhole(const std::vector<Vec3>& points)
{
  std::vector<Id> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  SortAlongHilbertCurve(points, order);
  RawVector<Vec3> vertices;
  for (Id point : order)
  {
    vertices.push_back(points[point]);
  }
  DelaunayTetrahedralization all;
  const Status status = BuildDelaunayTetrahedralization(vertices, order, {}, 1, {}, all);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  Whole whole;
  const Id infinite = static_cast<Id>(points.size());
  for (const TetrahedronIds& ids : all.Tetrahedra)
  {
    if (ids[0] == NoId)
    {
      continue;
    }
    std::vector<std::int64_t> numbers;
    for (Id id : ids)
    {
      if (id != infinite)
      {
        numbers.push_back(order[id]);
      }
    }
    std::sort(numbers.begin(), numbers.end());
    if (numbers.size() == 4)
    {
      whole.Tetrahedra.push_back({ numbers[0], numbers[1], numbers[2], numbers[3] });
    }
    else
    {
      whole.Hull.push_back({ numbers[0], numbers[1], numbers[2] });
    }
  }
  whole.Sort();
  return whole;
}

struct Traffic
{
  int Rounds = 0;
  std::size_t Halo = 0;
  std::size_t Queries = 0;
  bool ComparesStars = false;
};

/**
 * Lets parts talk to each other in turn; checks what each has, and puts together what each owns.
 */
Whole MakeParts(const std::vector<Vec3>& points, const std::vector<int>& partOf, int numberOfParts,
  const std::vector<Box>& cells, const Whole& expected, Traffic& traffic)
{
  const std::size_t count = static_cast<std::size_t>(numberOfParts);
  std::vector<std::vector<NumberedPoint>> own(count);
  std::vector<Box> bounds(count);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    own[partOf[i]].push_back({ points[i], static_cast<std::int64_t>(i) });
    bounds[partOf[i]].Add(points[i]);
  }
  std::vector<NumberedPoint> simplex;
  for (int i = 0; i < 4; ++i)
  {
    for (const auto& candidates : own)
    {
      const Id found = FindIndependentPoint(candidates, simplex);
      if (found != NoId)
      {
        simplex.push_back(candidates[found]);
        break;
      }
    }
  }
  EXPECT_EQ(simplex.size(), 4u);
  std::vector<PartTetrahedralization> parts;
  for (std::size_t r = 0; r < count; ++r)
  {
    parts.emplace_back(own[r], static_cast<int>(r), bounds, cells[r]);
  }
  std::vector<std::vector<std::vector<Box>>> boxes;
  for (PartTetrahedralization& part : parts)
  {
    boxes.push_back(part.GetHaloBoxes());
  }
  for (std::size_t r = 0; r < count; ++r)
  {
    parts[r].AddPoints(simplex);
    std::vector<HaloPoints> halo;
    for (std::size_t s = 0; s < count; ++s)
    {
      halo.push_back(parts[s].GetPointsIn(boxes[r][s]));
    }
    parts[r].TakeHalo(halo);
  }
  bool isFinished = false;
  traffic = {};
  for (; !isFinished; ++traffic.Rounds)
  {
    isFinished = true;
    for (PartTetrahedralization& part : parts)
    {
      const Status status = part.Update({});
      EXPECT_TRUE(status.IsOk()) << status.Message;
    }
    std::vector<std::vector<ConflictAnswers>> answers(count, std::vector<ConflictAnswers>(count));
    for (std::size_t r = 0; r < count; ++r)
    {
      for (std::size_t s = 0; s < count; ++s)
      {
        const auto& queries = parts[r].GetQueries()[s];
        traffic.Queries += queries.size();
        EXPECT_TRUE(parts[s].Answer(queries, {}, answers[r][s]).IsOk());
      }
    }
    const bool gaveUp = std::any_of(
      parts.begin(), parts.end(), [](const PartTetrahedralization& part) { return part.GaveUp(); });
    for (std::size_t r = 0; r < count; ++r)
    {
      if (gaveUp)
      {
        parts[r].CompareStars();
        traffic.ComparesStars = true;
      }
      isFinished = !gaveUp && parts[r].TakeAnswers(answers[r]) && isFinished;
    }
  }
  Whole whole;
  for (PartTetrahedralization& part : parts)
  {
    const auto& known = part.GetPoints();
    traffic.Halo += known.size() - part.GetNumberOfOwnPoints();
    std::set<std::int64_t> ownNumbers;
    for (Id i = 0; i < part.GetNumberOfOwnPoints(); ++i)
    {
      ownNumbers.insert(known[i].Number);
    }
    std::vector<Numbers4> star;
    for (const TetrahedronIds& ids : part.GetTetrahedra())
    {
      EXPECT_GT(Orientation(known[ids[0]].Position, known[ids[1]].Position, known[ids[2]].Position,
                  known[ids[3]].Position),
        0);
      Numbers4 numbers;
      std::transform(
        ids.begin(), ids.end(), numbers.begin(), [&](Id id) { return known[id].Number; });
      std::sort(numbers.begin(), numbers.end());
      star.push_back(numbers);
      if (part.IsOwn(part.GetLowest(ids)))
      {
        whole.Tetrahedra.push_back(numbers);
      }
    }
    // A part has all tetrahedra at its own points, each once, and no others.
    std::sort(star.begin(), star.end());
    std::vector<Numbers4> expectedStar;
    for (const Numbers4& numbers : expected.Tetrahedra)
    {
      if (std::any_of(numbers.begin(), numbers.end(),
            [&](std::int64_t number) { return ownNumbers.count(number) != 0; }))
      {
        expectedStar.push_back(numbers);
      }
    }
    EXPECT_EQ(star, expectedStar);
    for (const TriangleIds& ids : part.GetHull())
    {
      Numbers3 numbers{ known[ids[0]].Number, known[ids[1]].Number, known[ids[2]].Number };
      std::sort(numbers.begin(), numbers.end());
      if (part.IsOwn(part.GetLowest(ids)))
      {
        whole.Hull.push_back(numbers);
      }
    }
  }
  whole.Sort();
  return whole;
}

/** One, two, three and seven parts give the same tetrahedra as no parts. */
void ExpectSame(const std::vector<Vec3>& points, const char* name, bool comparesStars = false)
{
  const Whole expected = MakeWhole(points);
  for (int numberOfParts : { 1, 2, 3, 7 })
  {
    SCOPED_TRACE(std::string(name) + ", parts: " + std::to_string(numberOfParts));
    const SpacePartition partition(points, numberOfParts);
    std::vector<int> partOf;
    std::vector<Box> cells;
    for (const Vec3& point : points)
    {
      partOf.push_back(partition.GetPart(point));
    }
    for (int part = 0; part < numberOfParts; ++part)
    {
      cells.push_back(partition.GetCell(part));
    }
    Traffic traffic;
    const Whole whole = MakeParts(points, partOf, numberOfParts, cells, expected, traffic);
    EXPECT_EQ(whole.Tetrahedra, expected.Tetrahedra);
    EXPECT_EQ(whole.Hull, expected.Hull);
    EXPECT_TRUE(traffic.ComparesStars || !comparesStars || numberOfParts == 1);
    std::cout << name << ": " << points.size() << " points, " << numberOfParts
              << " parts: " << traffic.Rounds << " rounds, " << traffic.Halo
              << " points of others, " << traffic.Queries << " queries\n";
  }
}

constexpr auto MakeRandom = testing_points::MakeRandom<Vec3>;
constexpr auto MakeGrid = testing_points::MakeGrid<Vec3>;
constexpr auto MakeOnSphere = testing_points::MakeOnSphere<Vec3>;
} // namespace

TEST(PartTetrahedralization, RandomPoints)
{
  const unsigned seed = 11;
  RecordProperty("seed", static_cast<int>(seed));
  std::cout << "seed " << seed << "\n";
  ExpectSame(MakeRandom(3000, seed), "random");
  ExpectSame(MakeRandom(20, seed), "few");
  ExpectSame(MakeRandom(5, seed), "fewer than parts");
}

TEST(PartTetrahedralization, Grids)
{
  const unsigned seed = 12;
  std::cout << "seed " << seed << "\n";
  ExpectSame(MakeGrid(12, 1.0, 0.0, seed), "grid");
  ExpectSame(MakeGrid(12, 0.1, 0.0, seed), "grid, 0.1");
  ExpectSame(MakeGrid(12, 1.0, 0.17, seed), "turned grid");
}

TEST(PartTetrahedralization, Spheres)
{
  const unsigned seed = 13;
  std::cout << "seed " << seed << "\n";
  std::vector<Vec3> exact = MakeOnSphere(1105 * 9, seed);
  ASSERT_GT(exact.size(), 100u);
  ExpectSame(exact, "exactly on a sphere");
  exact.push_back({ 0.5, 0.25, 0.125 });
  ExpectSame(exact, "exactly on a sphere, and one inside");
  std::vector<Vec3> rounded;
  for (Vec3 p : MakeRandom(1000, seed))
  {
    p = p - Vec3{ 0.5, 0.5, 0.5 };
    rounded.push_back((1.0 / Norm(p)) * p);
  }
  ExpectSame(rounded, "on a sphere, rounded");
  for (const Vec3& p : MakeRandom(1000, seed + 1))
  {
    rounded.push_back(p);
  }
  ExpectSame(rounded, "on a sphere, rounded, and elsewhere");
}

TEST(PartTetrahedralization, ManyPointsOnASphere)
{
  // To test each tetrahedron against each point would take minutes.
  const unsigned seed = 18;
  std::cout << "seed " << seed << "\n";
  const std::vector<Vec3> exact = MakeOnSphere(600066, seed);
  ASSERT_EQ(exact.size(), 14112u);
  ExpectSame(exact, "exactly on a sphere", true);
  std::vector<Vec3> rounded;
  for (const Vec3& p : exact)
  {
    rounded.push_back((1.0 / Norm(p)) * p);
  }
  ExpectSame(rounded, "on a sphere, rounded", true);
  // Close to it, and on both sides of a plane that has many of them.
  std::vector<Vec3> moved;
  for (const Vec3& p : MakeRandom(4000, seed))
  {
    const Vec3 q = p - Vec3{ 0.5, 0.5, 0.5 };
    moved.push_back(((1.0 + 1e-7 * p.X) / Norm(q)) * q);
    moved.push_back({ p.X, p.Y, 0.0 });
  }
  ExpectSame(moved, "near a sphere, and in a plane");
}

TEST(PartTetrahedralization, UnevenPoints)
{
  const unsigned seed = 14;
  std::cout << "seed " << seed << "\n";
  std::vector<Vec3> graded;
  for (const Vec3& p : MakeRandom(2000, seed))
  {
    graded.push_back({ std::pow(p.X, 6.0), std::pow(p.Y, 3.0), p.Z });
  }
  ExpectSame(graded, "graded");
  std::vector<Vec3> clusters;
  const std::vector<Vec3> centers = MakeRandom(8, seed);
  std::size_t i = 0;
  for (const Vec3& p : MakeRandom(2000, seed + 1))
  {
    clusters.push_back(centers[i++ % centers.size()] + 1e-4 * p);
  }
  ExpectSame(clusters, "clusters");
  std::vector<Vec3> sheet;
  for (const Vec3& p : MakeRandom(1000, seed))
  {
    sheet.push_back({ p.X, p.Y, 0.0 });
  }
  sheet.push_back({ 0.3, 0.4, 5.0 });
  ExpectSame(sheet, "a sheet and a point");
  std::vector<Vec3> lines;
  for (int k = 0; k < 200; ++k)
  {
    lines.push_back({ double(k), 0.0, 0.0 });
    lines.push_back({ 0.0, double(k), 1000.0 });
  }
  ExpectSame(lines, "two lines");
}

TEST(PartTetrahedralization, PartsThatAreNoBoxes)
{
  // Points dealt out: each part knows nothing of its own space, and asks for all of it.
  const unsigned seed = 15;
  std::cout << "seed " << seed << "\n";
  const std::vector<Vec3> points = MakeRandom(400, seed);
  const Whole expected = MakeWhole(points);
  std::vector<int> partOf;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    partOf.push_back(static_cast<int>(i % 3));
  }
  Traffic traffic;
  const Whole whole = MakeParts(points, partOf, 4, std::vector<Box>(4), expected, traffic);
  EXPECT_EQ(whole.Tetrahedra, expected.Tetrahedra);
  EXPECT_EQ(whole.Hull, expected.Hull);
}

TEST(PartTetrahedralization, AllPointsInOnePart)
{
  const std::vector<Vec3> points = MakeGrid(6, 1.0, 0.0, 16);
  const Whole expected = MakeWhole(points);
  const Box nothing;
  Traffic traffic;
  const Whole whole = MakeParts(points, std::vector<int>(points.size(), 1), 3,
    std::vector<Box>(3, { nothing.High, nothing.Low }), expected, traffic);
  EXPECT_EQ(whole.Tetrahedra, expected.Tetrahedra);
  EXPECT_EQ(traffic.Rounds, 1);
  EXPECT_EQ(traffic.Queries, 0u);
}

TEST(PartTetrahedralization, RemovesCopies)
{
  std::vector<NumberedPoint> points{ { { 1, 0, 0 }, 7 }, { { 0, 0, 0 }, 5 }, { { 1, 0, 0 }, 2 },
    { { 0, 1, 0 }, 3 }, { { -0.0, 0, 0 }, 9 } };
  RemoveCopies(points);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].Number, 2);
  EXPECT_EQ(points[1].Number, 3);
  EXPECT_EQ(points[2].Number, 5);
}

TEST(PartTetrahedralization, StopsWhenAborted)
{
  PartTetrahedralization part({ { { 0, 0, 0 }, 0 }, { { 1, 0, 0 }, 1 }, { { 0, 1, 0 }, 2 },
                                { { 0, 0, 1 }, 3 }, { { 1, 1, 1 }, 4 } },
    0, { Box() }, {});
  const ExecutionContext aborting({}, [] { return true; });
  EXPECT_TRUE(part.Update(aborting).IsAborted());
  ConflictAnswers answers;
  EXPECT_TRUE(part.Answer(std::vector<ConflictQuery>(1), aborting, answers).IsAborted());
}

TEST(SpacePartition, CutsInEqualParts)
{
  const unsigned seed = 17;
  std::cout << "seed " << seed << "\n";
  const std::vector<Vec3> points = MakeRandom(7000, seed);
  std::vector<Vec3> shuffled(points.rbegin(), points.rend());
  const SpacePartition partition(points, 7);
  const SpacePartition other(shuffled, 7);
  std::vector<int> counts(7, 0);
  for (const Vec3& point : points)
  {
    const int part = partition.GetPart(point);
    EXPECT_EQ(part, other.GetPart(point)) << "the order of the sample does not matter";
    ASSERT_TRUE(part >= 0 && part < 7);
    EXPECT_TRUE(partition.GetCell(part).Overlaps({ point, point }));
    ++counts[part];
  }
  for (int count : counts)
  {
    EXPECT_NEAR(count, 1000, 10);
  }
  EXPECT_EQ(SpacePartition({}, 5).GetPart({ -1, 0, 0 }), 0);
  const SpacePartition alike(std::vector<Vec3>(10, { 1, 1, 1 }), 4);
  EXPECT_EQ(alike.GetPart({ 1, 1, 1 }), 3) << "points on a cut belong above it";
}
