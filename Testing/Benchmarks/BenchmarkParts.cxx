// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a part of a distributed tetrahedralization costs: the parts of points (random, graded, on a
 * sphere, or of a grid: grid, rotated) in one process, one after the other, with what they would
 * send to each other counted.
 *
 *     BenchmarkParts                          # a small case, for ctest
 *     BenchmarkParts random 1000000 1 2 4 8 27 64
 *     BenchmarkParts grid 1000000 8
 */
#include "Core/Delaunay/PartTetrahedralization.h"
#include "Core/Search/SpacePartition.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
std::vector<Vec3> MakePoints(const std::string& kind, std::size_t count)
{
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Vec3> points;
  const std::size_t side = static_cast<std::size_t>(std::lround(std::cbrt(double(count))));
  const bool isGrid = kind == "grid" || kind == "rotated";
  for (std::size_t i = 0; i < (isGrid ? side * side * side : count); ++i)
  {
    if (kind == "grid")
    {
      points.push_back(
        { 0.1 * double(i % side), 0.1 * double(i / side % side), 0.1 * double(i / side / side) });
      continue;
    }
    const double power = kind == "graded" ? 4.0 : 1.0;
    const double x = std::pow(uniform(generator), power);
    const double y = std::pow(uniform(generator), power);
    Vec3 p{ x, y, std::pow(uniform(generator), power) };
    if (kind == "sphere")
    {
      p = p - Vec3{ 0.5, 0.5, 0.5 };
      p = (1.0 / Norm(p)) * p;
    }
    points.push_back(p);
  }
  return points;
}

double GetSeconds()
{
  return double(std::clock()) / CLOCKS_PER_SEC;
}

/** The cost of one part. */
struct Cost
{
  double First = 0.0;
  double Others = 0.0;
  std::size_t Points = 0;
  std::size_t Halo = 0;
  std::size_t Queries = 0;
  double Bytes = 0.0;
  std::size_t Tetrahedra = 0;
};

void Measure(const std::string& kind, std::size_t numberOfPoints, int numberOfParts)
{
  const std::size_t count = static_cast<std::size_t>(numberOfParts);
  std::vector<std::vector<NumberedPoint>> own(count);
  std::vector<Box> bounds(count);
  std::vector<Box> cells;
  {
    const std::vector<Vec3> points = MakePoints(kind, numberOfPoints);
    std::vector<Vec3> sample;
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 20000)
    {
      sample.push_back(points[i]);
    }
    const SpacePartition partition(sample, numberOfParts);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const std::size_t part = static_cast<std::size_t>(partition.GetPart(points[i]));
      own[part].push_back({ points[i], static_cast<std::int64_t>(i) });
      bounds[part].Add(points[i]);
    }
    for (int part = 0; part < numberOfParts; ++part)
    {
      cells.push_back(partition.GetCell(part));
    }
  }
  std::vector<NumberedPoint> simplex;
  while (simplex.size() < 4)
  {
    simplex.push_back(own[0][FindIndependentPoint(own[0], simplex)]);
  }
  std::vector<Cost> costs(count);
  std::vector<PartTetrahedralization> parts;
  parts.reserve(count);
  for (std::size_t r = 0; r < count; ++r)
  {
    const double start = GetSeconds();
    costs[r].Points = own[r].size();
    parts.emplace_back(std::move(own[r]), static_cast<int>(r), bounds, cells[r]);
    costs[r].First += GetSeconds() - start;
  }
  for (std::size_t r = 0; r < count; ++r)
  {
    double start = GetSeconds();
    const auto boxes = parts[r].GetHaloBoxes();
    parts[r].AddPoints(simplex);
    costs[r].First += GetSeconds() - start;
    std::vector<HaloPoints> halo(count);
    for (std::size_t s = 0; s < count; ++s)
    {
      start = GetSeconds();
      halo[s] = parts[s].GetPointsIn(boxes[s]);
      costs[s].First += GetSeconds() - start;
      costs[r].Bytes += double(boxes[s].size() * sizeof(Box));
      costs[s].Bytes +=
        double(halo[s].IsComplete.size() + halo[s].Points.size() * sizeof(NumberedPoint));
    }
    start = GetSeconds();
    parts[r].TakeHalo(halo);
    costs[r].First += GetSeconds() - start;
  }
  int rounds = 0;
  for (bool isFinal = false; !isFinal; ++rounds)
  {
    isFinal = true;
    for (std::size_t r = 0; r < count; ++r)
    {
      const double start = GetSeconds();
      const Status status = parts[r].Update({});
      if (!status.IsOk())
      {
        std::printf("%s\n", status.Message.c_str());
        std::exit(1);
      }
      (rounds == 0 ? costs[r].First : costs[r].Others) += GetSeconds() - start;
    }
    std::vector<std::vector<ConflictAnswers>> answers(count, std::vector<ConflictAnswers>(count));
    for (std::size_t r = 0; r < count; ++r)
    {
      for (std::size_t s = 0; s < count; ++s)
      {
        const auto& queries = parts[r].GetQueries()[s];
        const double start = GetSeconds();
        const Status status = parts[s].Answer(queries, {}, answers[r][s]);
        if (!status.IsOk())
        {
          std::printf("%s\n", status.Message.c_str());
          std::exit(1);
        }
        costs[s].Others += GetSeconds() - start;
        costs[r].Queries += queries.size();
        costs[r].Bytes += double(queries.size() * sizeof(ConflictQuery));
        costs[s].Bytes += double(
          answers[r][s].HasConflict.size() + answers[r][s].Points.size() * sizeof(NumberedPoint));
      }
    }
    const bool gaveUp = std::any_of(
      parts.begin(), parts.end(), [](const PartTetrahedralization& part) { return part.GaveUp(); });
    for (std::size_t r = 0; r < count; ++r)
    {
      const double start = GetSeconds();
      if (gaveUp)
      {
        parts[r].CompareStars();
      }
      isFinal = !gaveUp && parts[r].TakeAnswers(answers[r]) && isFinal;
      costs[r].Others += GetSeconds() - start;
    }
  }
  std::size_t owned = 0;
  for (std::size_t r = 0; r < count; ++r)
  {
    costs[r].Halo = parts[r].GetPoints().size() - costs[r].Points;
    for (const TetrahedronIds& ids : parts[r].GetTetrahedra())
    {
      costs[r].Tetrahedra += parts[r].IsOwn(parts[r].GetLowest(ids));
    }
    owned += costs[r].Tetrahedra;
  }
  const auto largest = [&costs](const auto& get)
  {
    double value = 0.0;
    for (const Cost& cost : costs)
    {
      value = std::max(value, double(get(cost)));
    }
    return value;
  };
  std::printf("| %s | %zu | %d | %.0f | %zu | %.2f | %.2f | %.0f | %.0f | %.1f | %d |\n",
    kind.c_str(), numberOfPoints, numberOfParts, largest([](const Cost& c) { return c.Points; }),
    owned, largest([](const Cost& c) { return c.First; }),
    largest([](const Cost& c) { return c.Others; }), largest([](const Cost& c) { return c.Halo; }),
    largest([](const Cost& c) { return c.Queries; }),
    largest([](const Cost& c) { return c.Bytes; }) / 1e6, rounds);
  std::fflush(stdout);
}
} // namespace

int main(int argc, char** argv)
{
  const std::string kind = argc > 1 ? argv[1] : "random";
  const std::size_t numberOfPoints =
    static_cast<std::size_t>(argc > 2 ? std::strtod(argv[2], nullptr) : 20000.0);
  std::printf(
    "| input | points | parts | points of a part | tetrahedra of all | first round s | other "
    "rounds s | halo points | queries | MB sent | rounds |\n"
    "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (int i = 3; i < std::max(argc, 4); ++i)
  {
    Measure(kind, numberOfPoints, i < argc ? std::atoi(argv[i]) : 8);
  }
  return 0;
}
