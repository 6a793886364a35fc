// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Predicates.h"

#include <gtest/gtest.h>

#if defined(__has_include)
#if __has_include(<CGAL/Delaunay_triangulation_3.h>)
#define CDM_HAS_CGAL_TRIANGULATION
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#endif
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>

namespace
{
using namespace cdm;

using PointSet = std::vector<Vec3>;

class Random
{
public:
  explicit Random(std::uint64_t seed) : Generator(seed) {}
  double GetUniform() { return std::ldexp(double(this->Generator() >> 11), -53); }
  int GetInteger(int count) { return static_cast<int>(this->Generator() % count); }
  Vec3 GetPoint()
  {
    const double x = this->GetUniform();
    const double y = this->GetUniform();
    return { x, y, this->GetUniform() };
  }
  Vec3 GetDirection()
  {
    for (;;)
    {
      const Vec3 p = 2.0 * this->GetPoint() - Vec3{ 1.0, 1.0, 1.0 };
      const double length = Norm(p);
      if (length < 1.0 && length > 0.01)
      {
        return (1.0 / length) * p;
      }
    }
  }
  template <typename T>
  void Shuffle(std::vector<T>& values)
  {
    for (std::size_t i = values.size(); i > 1; --i)
    {
      std::swap(values[i - 1], values[this->Generator() % i]);
    }
  }

private:
  std::mt19937_64 Generator;
};

Vec3 Rotate(const Vec3& p, const Vec3& axis, double angle)
{
  return std::cos(angle) * p + std::sin(angle) * Cross(axis, p) +
    (1.0 - std::cos(angle)) * Dot(axis, p) * axis;
}

PointSet MakeGrid(int side, double spacing)
{
  PointSet points;
  for (int i = 0; i < side; ++i)
  {
    for (int j = 0; j < side; ++j)
    {
      for (int k = 0; k < side; ++k)
      {
        points.push_back({ i * spacing, j * spacing, k * spacing });
      }
    }
  }
  return points;
}

Status MeshPointSet(const PointSet& points, AdvancingFrontTetrahedralizerOutput& output)
{
  AdvancingFrontTetrahedralizerInput input;
  input.MeshPoints = &points;
  AdvancingFrontTetrahedralizerOptions options;
  options.CloseOpenBoundary = true;
  return TetrahedralizeByAdvancingFront(input, options, {}, output);
}

/** Valid, Delaunay, and every point used but copies. */
void CheckHullMesh(const PointSet& points, const AdvancingFrontTetrahedralizerOutput& output,
  double volumeTolerance = 1e-9)
{
  MeshCertificate report;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, report).IsOk());
  EXPECT_TRUE(report.IsDelaunay(volumeTolerance)) << report.GetText();
  const std::set<std::array<double, 3>> distinct = [&points]()
  {
    std::set<std::array<double, 3>> result;
    for (const Vec3& p : points)
    {
      result.insert({ p.X, p.Y, p.Z });
    }
    return result;
  }();
  EXPECT_EQ(report.UnusedPoints, 0);
  EXPECT_EQ(output.Mesh.Points.size(), distinct.size());
  EXPECT_EQ(output.Report.UnusedMeshPoints, static_cast<Id>(points.size() - distinct.size()));
  // The hull is convex: no point beyond any of its triangles, and it is a sphere topologically.
  EXPECT_EQ(output.Boundary.Triangles.size() % 2, 0u);
  if (points.size() <= 200)
  {
    for (const TriangleIds& t : output.Boundary.Triangles)
    {
      for (const Vec3& p : output.Mesh.Points)
      {
        ASSERT_LE(Orientation(output.Mesh.Points[t[0]], output.Mesh.Points[t[1]],
                    output.Mesh.Points[t[2]], p),
          0);
      }
    }
  }
}

/** A box as surface: 12 triangles on 8 points. */
TriangleMesh MakeBox(const Vec3& low, const Vec3& high, TriangleMesh surface = {})
{
  const Id first = static_cast<Id>(surface.Points.size());
  for (int i = 0; i < 8; ++i)
  {
    surface.Points.push_back({ (i & 1) != 0 ? high.X : low.X, (i & 2) != 0 ? high.Y : low.Y,
      (i & 4) != 0 ? high.Z : low.Z });
  }
  const Id faces[6][4] = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
    { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
  for (const Id(&f)[4] : faces)
  {
    surface.Triangles.push_back({ first + f[0], first + f[1], first + f[2] });
    surface.Triangles.push_back({ first + f[0], first + f[2], first + f[3] });
  }
  return surface;
}

PointSet MakeInnerPoints(Random& random, int count, const Vec3& center, double size)
{
  PointSet points;
  for (int i = 0; i < count; ++i)
  {
    points.push_back(center + size * (random.GetPoint() - Vec3{ 0.5, 0.5, 0.5 }));
  }
  return points;
}

void CheckSurfaceMesh(const AdvancingFrontTetrahedralizerOutput& output)
{
  MeshCertificate report;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, report).IsOk());
  EXPECT_TRUE(report.IsDelaunay()) << report.GetText();
}

bool AreEqual(
  const AdvancingFrontTetrahedralizerOutput& a, const AdvancingFrontTetrahedralizerOutput& b)
{
  return a.Mesh.Points == b.Mesh.Points && a.Mesh.Tetrahedra == b.Mesh.Tetrahedra &&
    a.Mesh.Neighbors == b.Mesh.Neighbors && a.Mesh.Regions == b.Mesh.Regions;
}

TEST(PointsOnly, RejectsSetsWithoutVolume)
{
  AdvancingFrontTetrahedralizerOutput output;
  EXPECT_EQ(MeshPointSet({}, output).Code, StatusCode::InvalidInput);
  EXPECT_EQ(MeshPointSet({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 1, 0 } }, output).Code,
    StatusCode::InvalidInput);
  PointSet line;
  PointSet plane;
  Random random(3);
  for (int i = 0; i < 50; ++i)
  {
    const double t = random.GetInteger(1000);
    const double s = random.GetInteger(1000);
    line.push_back(t * Vec3{ 1.0, 2.0, 3.0 });
    plane.push_back(t * Vec3{ 1.0, 2.0, 3.0 } + s * Vec3{ -3.0, 1.0, 5.0 });
  }
  const Status onLine = MeshPointSet(line, output);
  EXPECT_EQ(onLine.Code, StatusCode::InvalidInput);
  EXPECT_NE(onLine.Message.find("line"), std::string::npos);
  const Status inPlane = MeshPointSet(plane, output);
  EXPECT_EQ(inPlane.Code, StatusCode::InvalidInput);
  EXPECT_NE(inPlane.Message.find("plane"), std::string::npos);
}

TEST(PointsOnly, MeshesGrids)
{
  for (const double spacing : { 1.0, 0.1, 1e-12, 1e12 })
  {
    const PointSet points = MakeGrid(8, spacing);
    AdvancingFrontTetrahedralizerOutput output;
    ASSERT_TRUE(MeshPointSet(points, output).IsOk());
    CheckHullMesh(points, output);
    EXPECT_EQ(output.Mesh.Tetrahedra.size(), 6u * 7u * 7u * 7u);
  }
}

TEST(PointsOnly, MeshesRotatedGrid)
{
  PointSet points = MakeGrid(12, 1.0);
  const Vec3 axis = (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 };
  for (Vec3& p : points)
  {
    p = Rotate(p, axis, 0.17453292519943295);
  }
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(MeshPointSet(points, output).IsOk());
  CheckHullMesh(points, output);
}

TEST(PointsOnly, MeshesGradedGrid)
{
  // Spacings from 1 to 10000.
  PointSet points;
  const auto place = [](int i) { return std::pow(10.0, 0.5 * i); };
  for (int i = 0; i < 9; ++i)
  {
    for (int j = 0; j < 9; ++j)
    {
      for (int k = 0; k < 9; ++k)
      {
        points.push_back({ place(i), place(j), place(k) });
      }
    }
  }
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(MeshPointSet(points, output).IsOk());
  CheckHullMesh(points, output);
  EXPECT_EQ(output.Mesh.Tetrahedra.size(), 6u * 8u * 8u * 8u);
}

TEST(PointsOnly, MeshesPointsOnASphere)
{
  Random random(5);
  PointSet points;
  for (int i = 0; i < 2000; ++i)
  {
    points.push_back(random.GetDirection());
  }
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(MeshPointSet(points, output).IsOk());
  CheckHullMesh(points, output);
}

TEST(PointsOnly, MeshesOneLargeCell)
{
  // All integer points on one sphere: a single degenerate cell.
  PointSet points;
  for (int x = -33; x <= 33; ++x)
  {
    for (int y = -33; y <= 33; ++y)
    {
      for (int z = -33; z <= 33; ++z)
      {
        if (x * x + y * y + z * z == 1089)
        {
          points.push_back({ double(x), double(y), double(z) });
        }
      }
    }
  }
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(MeshPointSet(points, output).IsOk());
  CheckHullMesh(points, output);
}

TEST(PointsOnly, DoesNotDependOnThreadsAndNumbers)
{
  Random random(29);
  for (const std::string kind : { "random", "sphere", "grid", "rotated grid", "clusters" })
  {
    PointSet points;
    if (kind == "grid" || kind == "rotated grid")
    {
      points = MakeGrid(28, 1.0);
      for (Vec3& p : points)
      {
        p = kind == "grid" ? p : Rotate(p, (1.0 / 3.0) * Vec3{ 1.0, 2.0, 2.0 }, 0.3);
      }
      random.Shuffle(points);
    }
    while (points.size() < 20000)
    {
      const Vec3 p = random.GetPoint();
      const Vec3 offset{ double(random.GetInteger(2)), double(random.GetInteger(3)), 0.0 };
      points.push_back(kind == "sphere" ? random.GetDirection()
          : kind == "clusters"          ? offset + 0.01 * p
                                        : p);
    }
    AdvancingFrontTetrahedralizerInput input;
    input.MeshPoints = &points;
    AdvancingFrontTetrahedralizerOptions options;
    options.CloseOpenBoundary = true;
    AdvancingFrontTetrahedralizerOutput expected;
    ASSERT_TRUE(TetrahedralizeByAdvancingFront(input, options, {}, expected).IsOk());
    for (const int threads : { 2, 3, 8, 61 })
    {
      AdvancingFrontTetrahedralizerOutput output;
      const ExecutionContext context(threads);
      ASSERT_TRUE(TetrahedralizeByAdvancingFront(input, options, context, output).IsOk());
      EXPECT_EQ(output.Mesh.Tetrahedra, expected.Mesh.Tetrahedra) << kind << " " << threads;
      EXPECT_EQ(output.Mesh.Neighbors, expected.Mesh.Neighbors) << kind << " " << threads;
      EXPECT_EQ(output.Boundary.Triangles, expected.Boundary.Triangles) << kind << " " << threads;
    }
    // Without cospherical points the numbers do not matter either.
    if (kind == "random" || kind == "clusters")
    {
      PointSet reversed(points.rbegin(), points.rend());
      input.MeshPoints = &reversed;
      AdvancingFrontTetrahedralizerOutput output;
      ASSERT_TRUE(TetrahedralizeByAdvancingFront(input, options, {}, output).IsOk());
      for (TetrahedronIds& ids : output.Mesh.Tetrahedra)
      {
        for (Id& id : ids)
        {
          id = static_cast<Id>(points.size()) - 1 - id;
        }
      }
      EXPECT_EQ(output.Mesh.Tetrahedra, expected.Mesh.Tetrahedra) << kind;
    }
  }
}

TEST(PointsOnly, MeshesManyPointsOnOneSphere)
{
  // One degenerate cell of 6630 points, numbered along the curve and against it: no order may make
  // it quadratic.
  constexpr int Radius = 1105;
  PointSet points;
  for (int x = -Radius; x <= Radius; ++x)
  {
    for (int y = -Radius; y <= Radius; ++y)
    {
      const int square = Radius * Radius - x * x - y * y;
      const int z = square < 0 ? -1 : static_cast<int>(std::lround(std::sqrt(square)));
      if (z >= 0 && z * z == square)
      {
        points.push_back({ double(x), double(y), double(z) });
      }
      if (z > 0 && z * z == square)
      {
        points.push_back({ double(x), double(y), double(-z) });
      }
    }
  }
  ASSERT_EQ(points.size(), 6630u);
  double volumes[2] = { 0.0, 0.0 };
  for (double& volume : volumes)
  {
    AdvancingFrontTetrahedralizerOutput output;
    ASSERT_TRUE(MeshPointSet(points, output).IsOk());
    EXPECT_EQ(output.Mesh.Points.size(), points.size());
    for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
    {
      // Pulling: each of them has the lowest point.
      ASSERT_EQ(*std::min_element(ids.begin(), ids.end()), 0);
      const auto& p = output.Mesh.Points;
      ASSERT_EQ(Orientation(p[ids[0]], p[ids[1]], p[ids[2]], p[ids[3]]), 1);
      volume +=
        Dot(Cross(p[ids[1]] - p[ids[0]], p[ids[2]] - p[ids[0]]), p[ids[3]] - p[ids[0]]) / 6.0;
    }
    std::reverse(points.begin(), points.end());
  }
  EXPECT_NEAR(volumes[0], volumes[1], 1e-9 * volumes[0]);
}

TEST(PointsOnly, MeshesNastyConfigurations)
{
  const char* const given = std::getenv("CDM_SEED");
  const std::uint64_t seed = given != nullptr ? std::strtoull(given, nullptr, 10) : 20261121u;
  std::printf("CDM_SEED=%llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int round = 0; round < 1500; ++round)
  {
    SCOPED_TRACE(round);
    PointSet points;
    const int count = 4 + random.GetInteger(56);
    const int lattice = 1 + random.GetInteger(6);
    while (static_cast<int>(points.size()) < count)
    {
      switch (random.GetInteger(6))
      {
        case 0:
          points.push_back(random.GetPoint());
          break;
        case 1: // snapped
          points.push_back({ double(random.GetInteger(lattice + 1)) / lattice,
            double(random.GetInteger(lattice + 1)) / lattice,
            double(random.GetInteger(lattice + 1)) / lattice });
          break;
        case 2: // on a sphere, exactly or nearly
          points.push_back(random.GetInteger(2) != 0
              ? random.GetDirection()
              : Vec3{ 0.6 * (2 * random.GetInteger(2) - 1), 0.0,
                  0.8 * (2 * random.GetInteger(2) - 1) });
          break;
        case 3: // in a plane
        {
          const Vec3 p = random.GetPoint();
          points.push_back({ p.X, p.Y, 0.5 });
          break;
        }
        case 4: // on a line, or nearly
          points.push_back(random.GetUniform() * Vec3{ 1.0, 1.0, 1.0 });
          break;
        default: // copies
          points.push_back(
            points.empty() ? Vec3{} : points[random.GetInteger(static_cast<int>(points.size()))]);
          break;
      }
    }
    if (random.GetInteger(3) == 0)
    {
      const Vec3 axis = random.GetDirection();
      const double angle = random.GetUniform();
      for (Vec3& p : points)
      {
        p = Rotate(p, axis, angle);
      }
    }
    const double scale =
      random.GetInteger(3) == 0 ? std::pow(10.0, random.GetInteger(25) - 12) : 1.0;
    const Vec3 shift = random.GetInteger(4) == 0 ? 100.0 * random.GetDirection() : Vec3{};
    for (Vec3& p : points)
    {
      p = scale * (p + shift);
    }
    AdvancingFrontTetrahedralizerOutput output;
    const Status status = MeshPointSet(points, output);
    if (status.Code == StatusCode::InvalidInput)
    {
      // Fewer than four points, or without volume: no four of them make a tetrahedron.
      Id a = 0;
      bool isFlat = true;
      for (std::size_t b = 1; b < points.size() && isFlat; ++b)
      {
        for (std::size_t c = b + 1; c < points.size() && isFlat; ++c)
        {
          for (std::size_t d = c + 1; d < points.size() && isFlat; ++d)
          {
            isFlat = Orientation(points[a], points[b], points[c], points[d]) == 0;
          }
        }
      }
      EXPECT_TRUE(isFlat) << status.Message;
      continue;
    }
    ASSERT_TRUE(status.IsOk()) << status.Message;
    // The volume of nearly coplanar points is a matter of rounding.
    CheckHullMesh(points, output, std::numeric_limits<double>::infinity());
    if (::testing::Test::HasFailure())
    {
      return;
    }
  }
}

#ifdef CDM_HAS_CGAL_TRIANGULATION
/** The vertices of each cell: tetrahedra that share a facet and a sphere are parts of one. */
std::set<std::vector<Id>> GetCells(
  const PointSet& points, const RawVector<TetrahedronIds>& tetrahedra)
{
  std::vector<std::size_t> parents(tetrahedra.size());
  std::iota(parents.begin(), parents.end(), 0);
  const auto getRoot = [&parents](std::size_t i)
  {
    while (parents[i] != i)
    {
      i = parents[i] = parents[parents[i]];
    }
    return i;
  };
  std::map<TriangleIds, std::size_t> open;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
  {
    const TetrahedronIds& ids = tetrahedra[t];
    for (int i = 0; i < 4; ++i)
    {
      TriangleIds facet = GetFacet(ids, i);
      std::sort(facet.begin(), facet.end());
      const auto [other, isNew] = open.insert({ facet, t });
      if (!isNew &&
        std::all_of(tetrahedra[other->second].begin(), tetrahedra[other->second].end(),
          [&](Id id)
          {
            return InSphere(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]],
                     points[id]) == 0;
          }))
      {
        parents[getRoot(t)] = getRoot(other->second);
      }
    }
  }
  std::map<std::size_t, std::set<Id>> cells;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
  {
    cells[getRoot(t)].insert(tetrahedra[t].begin(), tetrahedra[t].end());
  }
  std::set<std::vector<Id>> result;
  for (const auto& [root, vertices] : cells)
  {
    result.insert({ vertices.begin(), vertices.end() });
  }
  return result;
}

TEST(PointsOnly, EqualsCgal)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Vertex = CGAL::Triangulation_vertex_base_with_info_3<Id, Kernel>;
  using Data =
    CGAL::Triangulation_data_structure_3<Vertex, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Data>;
  // In general position the tetrahedra are equal, of degenerate sets the cells.
  for (const std::string kind : { "random", "graded", "sphere", "grid", "snapped", "rotated grid",
         "prisms", "sphere of integers" })
  {
    Random random(11);
    PointSet points;
    if (kind == "grid" || kind == "rotated grid")
    {
      points = MakeGrid(15, 0.1);
      for (Vec3& p : points)
      {
        p = kind == "grid" ? p : Rotate(p, (1.0 / 3.0) * Vec3{ 1.0, 2.0, 2.0 }, 0.3);
      }
      random.Shuffle(points);
    }
    for (int i = 0; i < 5000 && points.size() < 3000; ++i)
    {
      Vec3 p = random.GetPoint();
      p = kind == "graded" ? std::pow(1000.0, p.X) * p : p;
      // On a sphere up to rounding no five are cospherical, most likely.
      p = kind == "sphere" && i < 1500 ? random.GetDirection() : p;
      if (kind == "snapped" || kind == "sphere of integers")
      {
        p = { std::floor(16.0 * p.X), std::floor(16.0 * p.Y), std::floor(16.0 * p.Z) };
      }
      if (kind == "prisms")
      {
        const double angle = 0.3 * random.GetInteger(20);
        p = { std::cos(angle), std::sin(angle), 0.25 * random.GetInteger(40) };
      }
      const double square = SquaredNorm(p - Vec3{ 7.0, 7.0, 7.0 });
      if ((kind != "sphere of integers" || square == 41.0 || square == 49.0) &&
        std::find(points.begin(), points.end(), p) == points.end())
      {
        points.push_back(p);
      }
    }
    std::vector<std::pair<Kernel::Point_3, Id>> others;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      others.emplace_back(
        Kernel::Point_3(points[i].X, points[i].Y, points[i].Z), static_cast<Id>(i));
    }
    AdvancingFrontTetrahedralizerOutput output;
    ASSERT_TRUE(MeshPointSet(points, output).IsOk());
    const Triangulation triangulation(others.begin(), others.end());
    RawVector<TetrahedronIds> expected;
    for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end();
         ++cell)
    {
      expected.push_back({ cell->vertex(0)->info(), cell->vertex(1)->info(),
        cell->vertex(2)->info(), cell->vertex(3)->info() });
    }
    const std::set<std::vector<Id>> cells = GetCells(points, output.Mesh.Tetrahedra);
    EXPECT_TRUE(cells == GetCells(points, expected)) << kind;
    const bool isDegenerate =
      kind == "grid" || kind == "snapped" || kind == "prisms" || kind == "sphere of integers";
    EXPECT_EQ(cells.size() < output.Mesh.Tetrahedra.size(), isDegenerate) << kind;
  }
}
#endif

TEST(AdvancingFront, MeshesABoxWithPoints)
{
  const TriangleMesh surface = MakeBox({ 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 });
  Random random(1);
  PointSet points = MakeInnerPoints(random, 3000, { 0.5, 0.5, 0.5 }, 0.4);
  points.push_back({ 9.0, 0.5, 0.5 });
  points.push_back(points.front());
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(
    TetrahedralizeByAdvancingFront({ &surface, &points, nullptr }, {}, {}, output).IsOk());
  CheckSurfaceMesh(output);
  EXPECT_EQ(output.Report.NumberOfRegions, 1);
  EXPECT_EQ(output.Report.UnusedMeshPoints, 2);
  EXPECT_EQ(output.Boundary.Triangles.size(), 12u);
  EXPECT_TRUE(output.Front.empty());
}

TEST(AdvancingFront, LeavesCavitiesAndMeshesNestedRegions)
{
  // A box around a box: without labels both are meshed; with labels the inner one may stay empty.
  TriangleMesh surface =
    MakeBox({ 0.4, 0.4, 0.4 }, { 0.6, 0.6, 0.6 }, MakeBox({ 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 }));
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(
    TetrahedralizeByAdvancingFront({ &surface, nullptr, nullptr }, {}, {}, output).IsOk());
  CheckSurfaceMesh(output);
  EXPECT_EQ(output.Report.NumberOfRegions, 2);

  for (int t = 0; t < 24; ++t)
  {
    surface.Labels.push_back(
      t < 12 ? RegionPair{ OutsideRegion, 7 } : RegionPair{ 7, OutsideRegion });
  }
  ASSERT_TRUE(
    TetrahedralizeByAdvancingFront({ &surface, nullptr, nullptr }, {}, {}, output).IsOk());
  CheckSurfaceMesh(output);
  MeshCertificate report;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, report).IsOk());
  ASSERT_EQ(report.Regions.size(), 1u);
  EXPECT_EQ(report.Regions[0].Region, 7);
  EXPECT_NEAR(report.Regions[0].Volume, 1.0 - 0.008, 1e-12);

  // A seed marks one of them.
  surface.Labels.clear();
  const std::vector<RegionSeed> seeds{ { { 0.5, 0.5, 0.5 }, 3 } };
  ASSERT_TRUE(TetrahedralizeByAdvancingFront({ &surface, nullptr, &seeds }, {}, {}, output).IsOk());
  ASSERT_TRUE(CertifyMesh(output.Mesh, nullptr, {}, report).IsOk());
  ASSERT_EQ(report.Regions.size(), 1u);
  EXPECT_EQ(report.Regions[0].Region, 3);
  EXPECT_NEAR(report.Regions[0].Volume, 0.008, 1e-14);
  EXPECT_EQ(output.Boundary.Triangles.size(), 12u);
  EXPECT_TRUE(output.Warnings.empty());
}

TEST(AdvancingFront, LeavesOutTrianglesThatBoundNothing)
{
  // An open sheet beside a box: its triangles come first.
  TriangleMesh sheet;
  sheet.Points = { { 2.0, 0.0, 0.0 }, { 3.0, 0.0, 0.0 }, { 3.0, 1.0, 0.0 }, { 2.0, 1.0, 0.0 } };
  sheet.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  const TriangleMesh surface = MakeBox({ 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 }, sheet);
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(
    TetrahedralizeByAdvancingFront({ &surface, nullptr, nullptr }, {}, {}, output).IsOk());
  CheckSurfaceMesh(output);
  MeshCertificate report;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, report).IsOk());
  EXPECT_TRUE(report.IsDelaunay(1e-12)) << report.GetText();
  EXPECT_EQ(output.Boundary.Triangles.size(), 12u);
  EXPECT_EQ(output.Boundary.SourceCells.front(), 2);
  EXPECT_EQ(output.Report.UnusedTriangles, std::vector<Id>({ 0, 1 }));
  ASSERT_EQ(output.Warnings.size(), 1u);
  EXPECT_EQ(output.Warnings[0].Cells, std::vector<Id>({ 0, 1 }));
}

TEST(AdvancingFront, MeshesTouchingRegions)
{
  // Two boxes that share a face.
  TriangleMesh surface;
  for (int i = 0; i < 12; ++i)
  {
    surface.Points.push_back({ double(i % 3), double(i / 3 % 2), double(i / 6) });
  }
  const auto add = [&surface](Id a, Id b, Id c, Id d)
  {
    surface.Triangles.push_back({ a, b, c });
    surface.Triangles.push_back({ a, c, d });
  };
  add(0, 3, 4, 1);
  add(1, 4, 5, 2);
  add(6, 7, 10, 9);
  add(7, 8, 11, 10);
  add(0, 1, 7, 6);
  add(1, 2, 8, 7);
  add(3, 9, 10, 4);
  add(4, 10, 11, 5);
  add(0, 6, 9, 3);
  add(2, 5, 11, 8);
  add(1, 4, 10, 7);
  AdvancingFrontTetrahedralizerOutput output;
  ASSERT_TRUE(
    TetrahedralizeByAdvancingFront({ &surface, nullptr, nullptr }, {}, {}, output).IsOk());
  CheckSurfaceMesh(output);
  EXPECT_EQ(output.Report.NumberOfRegions, 2);
}

TEST(AdvancingFront, ClosesOpenBoundary)
{
  TriangleMesh surface = MakeBox({ 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 });
  surface.Triangles.resize(10);
  AdvancingFrontTetrahedralizerOutput output;
  EXPECT_EQ(TetrahedralizeByAdvancingFront({ &surface, nullptr, nullptr }, {}, {}, output).Code,
    StatusCode::NotClosed);
  AdvancingFrontTetrahedralizerOptions options;
  options.CloseOpenBoundary = true;
  ASSERT_TRUE(
    TetrahedralizeByAdvancingFront({ &surface, nullptr, nullptr }, options, {}, output).IsOk());
  CheckSurfaceMesh(output);
  EXPECT_EQ(output.Boundary.Triangles.size(), 12u);
  EXPECT_EQ(output.Boundary.SourceCells.back(), NoId);
}

TEST(AdvancingFront, DependsOnThePointsOnly)
{
  TriangleMesh surface = MakeBox({ 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 });
  Random random(4);
  PointSet points = MakeInnerPoints(random, 500, { 0.5, 0.5, 0.5 }, 0.4);
  for (int i = 0; i < 64; ++i)
  {
    points.push_back(
      { 0.375 + 0.0625 * (i % 4), 0.375 + 0.0625 * (i / 4 % 4), 0.375 + 0.0625 * (i / 16) });
  }
  AdvancingFrontTetrahedralizerOutput expected;
  ASSERT_TRUE(
    TetrahedralizeByAdvancingFront({ &surface, &points, nullptr }, {}, {}, expected).IsOk());
  CheckSurfaceMesh(expected);
  for (int round = 0; round < 5; ++round)
  {
    random.Shuffle(surface.Triangles);
    for (TriangleIds& t : surface.Triangles)
    {
      std::rotate(t.begin(), t.begin() + random.GetInteger(3), t.end());
    }
    AdvancingFrontTetrahedralizerOutput output;
    ASSERT_TRUE(
      TetrahedralizeByAdvancingFront({ &surface, &points, nullptr }, {}, {}, output).IsOk());
    EXPECT_TRUE(AreEqual(expected, output));
  }
}

TEST(AdvancingFront, StopsAtSnapshotsAndAborts)
{
  const TriangleMesh surface = MakeBox({ 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 });
  Random random(6);
  const PointSet points = MakeInnerPoints(random, 20000, { 0.5, 0.5, 0.5 }, 0.4);
  AdvancingFrontTetrahedralizerOutput whole;
  ASSERT_TRUE(TetrahedralizeByAdvancingFront({ &surface, &points, nullptr }, {}, {}, whole).IsOk());
  std::set<TetrahedronIds> all;
  const auto sorted = [](TetrahedronIds ids, const AdvancingFrontTetrahedralizerOutput& output)
  {
    for (Id& id : ids)
    {
      id = id < 8 ? id : 8 + output.MeshPointSources[id - 8];
    }
    std::sort(ids.begin(), ids.end());
    return ids;
  };
  for (const TetrahedronIds& ids : whole.Mesh.Tetrahedra)
  {
    all.insert(sorted(ids, whole));
  }
  const auto checkPartial = [&](const AdvancingFrontTetrahedralizerOutput& part)
  {
    MeshCertificate report;
    ASSERT_TRUE(CertifyMesh(part.Mesh, nullptr, {}, report).IsOk());
    EXPECT_EQ(report.GetCount(MeshFault::InvertedTetrahedron) +
        report.GetCount(MeshFault::FlatTetrahedron) + report.GetCount(MeshFault::OverfullFacet) +
        report.WrongNeighbors,
      0);
    for (const TetrahedronIds& ids : part.Mesh.Tetrahedra)
    {
      ASSERT_EQ(all.count(sorted(ids, part)), 1u);
    }
    // Each facet has a neighbour, is a boundary triangle, or belongs to the front.
    std::set<TriangleIds> open;
    for (TriangleIds t : part.Front)
    {
      std::sort(t.begin(), t.end());
      EXPECT_TRUE(open.insert(t).second);
    }
    std::set<TriangleIds> boundary;
    for (TriangleIds t : part.Boundary.Triangles)
    {
      std::sort(t.begin(), t.end());
      boundary.insert(t);
    }
    std::size_t count = 0;
    for (std::size_t t = 0; t < part.Mesh.Tetrahedra.size(); ++t)
    {
      for (int i = 0; i < 4; ++i)
      {
        TriangleIds facet = GetFacet(part.Mesh.Tetrahedra[t], i);
        std::sort(facet.begin(), facet.end());
        count += open.count(facet);
        EXPECT_NE(part.Mesh.Neighbors[t][i] != NoId, open.count(facet) + boundary.count(facet) > 0);
      }
    }
    EXPECT_EQ(count, open.size());
  };
  for (const Id limit : { 1, 10, 1000, 50000 })
  {
    AdvancingFrontTetrahedralizerOptions options;
    options.MaximumNumberOfTetrahedra = limit;
    AdvancingFrontTetrahedralizerOutput part;
    ASSERT_TRUE(
      TetrahedralizeByAdvancingFront({ &surface, &points, nullptr }, options, {}, part).IsOk());
    EXPECT_GE(static_cast<Id>(part.Mesh.Tetrahedra.size()), limit);
    EXPECT_LT(static_cast<Id>(part.Mesh.Tetrahedra.size()), limit + 100);
    EXPECT_FALSE(part.Front.empty());
    checkPartial(part);
    AdvancingFrontTetrahedralizerOutput onThreads;
    ASSERT_TRUE(TetrahedralizeByAdvancingFront(
      { &surface, &points, nullptr }, options, ExecutionContext(3), onThreads)
                  .IsOk());
    EXPECT_EQ(onThreads.Mesh.Tetrahedra, part.Mesh.Tetrahedra);
    EXPECT_EQ(onThreads.Front, part.Front);
  }
  // Once while the points are tetrahedralized, once when the front advances.
  for (const std::string activity : { "Tetrahedralizing the points", "Advancing the front" })
  {
    int calls = 0;
    const ExecutionContext context([&](double, const char* text)
      { calls += activity == text ? 1 : 0; },
      [&calls]() { return calls > 3; });
    AdvancingFrontTetrahedralizerOutput part;
    ASSERT_TRUE(TetrahedralizeByAdvancingFront({ &surface, &points, nullptr }, {}, context, part)
                  .IsAborted());
    EXPECT_EQ(part.Mesh.Tetrahedra.empty(), activity != "Advancing the front");
    checkPartial(part);
  }
}

TEST(AdvancingFront, NamesContradictingLabels)
{
  TriangleMesh surface = MakeBox({ 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 });
  surface.Labels.assign(12, { OutsideRegion, 1 });
  surface.Labels[5] = { OutsideRegion, 2 };
  AdvancingFrontTetrahedralizerOutput output;
  const Status status =
    TetrahedralizeByAdvancingFront({ &surface, nullptr, nullptr }, {}, {}, output);
  EXPECT_EQ(status.Code, StatusCode::NotDelaunay);
  EXPECT_FALSE(status.Cells.empty());
  EXPECT_TRUE(output.Mesh.Tetrahedra.empty());
}
} // namespace
