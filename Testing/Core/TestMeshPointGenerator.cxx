// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/MeshPoints/MeshPointGenerator.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace cdm;

namespace
{
TriangleMesh Triangulate(const PolygonSoup& soup)
{
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output.Surface;
}

TriangleMesh MakeBox(const Vec3& size)
{
  return Triangulate(CellComplex(size).GetSoup());
}

/** A box cut into layers along z at the given heights; regions by height. */
TriangleMesh MakeStack(const Vec3& size, const std::vector<double>& heights, double angle = 0.0)
{
  CellComplex complex(size);
  for (const double height : heights)
  {
    EXPECT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, height, 1e-4));
  }
  PolygonSoup soup = complex.GetSoup();
  Rotate(soup.Points, { 0.6, 0.8, 0.0 }, angle);
  return Triangulate(soup);
}

SizingField MakeConstant(const LocalSpacing& spacing)
{
  return [spacing](const Vec3&) { return spacing; };
}

MeshPointGeneratorOutput Generate(const TriangleMesh& surface, const SizingField& sizing,
  const MeshPointGeneratorOptions& options, const ExecutionContext& context = {})
{
  const MeshPointGeneratorInput input{ &surface, sizing };
  MeshPointGeneratorOutput output;
  const Status status = GenerateMeshPoints(input, options, context, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  EXPECT_EQ(output.Regions.size(), output.Points.size());
  EXPECT_EQ(output.Layers.size(), output.Points.size());
  EXPECT_EQ(
    std::set<Vec3>(output.Points.begin(), output.Points.end()).size(), output.Points.size());
  return output;
}

std::size_t Count(const TriangleMesh& surface, PointPlacement placement, PointTemplate kind,
  const LocalSpacing& spacing)
{
  MeshPointGeneratorOptions options;
  options.Placement = placement;
  options.Template = kind;
  return Generate(surface, MakeConstant(spacing), options).Points.size();
}

double GetDistanceToSurface(const Vec3& p, const TriangleMesh& surface)
{
  double distance = std::numeric_limits<double>::infinity();
  for (const TriangleIds& ids : surface.Triangles)
  {
    distance = std::min(distance,
      GetDistanceToTriangle(
        p, surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]]));
  }
  return distance;
}

/** Distances of the nearest other point. */
std::vector<double> GetNearestDistances(const std::vector<Vec3>& points)
{
  std::vector<double> distances(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      const double distance = Distance(points[i], points[j]);
      distances[i] = std::min(distances[i], distance);
      distances[j] = std::min(distances[j], distance);
    }
  }
  return distances;
}

MeshPointGeneratorOptions MakeOptions(PointPlacement placement)
{
  MeshPointGeneratorOptions options;
  options.Placement = placement;
  return options;
}
} // namespace

TEST(MeshPointGenerator, LatticesInABoxHaveClosedFormCounts)
{
  // n unit cells along each side: (n - 1)^3 corners, n^3 centers, 3 n^2 (n - 1) centers of sides
  // lie inside; of the corners those beside the boundary are a whole cell away from it.
  const TriangleMesh box = MakeBox({ 1.0, 1.0, 1.0 });
  const PointPlacement ortho = PointPlacement::OrthoProduct;
  const double bodyEdge = 2.0 / std::sqrt(3.0);
  const double faceEdge = std::sqrt(2.0);
  for (const std::size_t n : { 2u, 5u, 8u })
  {
    const std::size_t corners = (n - 1) * (n - 1) * (n - 1);
    const std::size_t centers = n * n * n;
    const std::size_t sides = 3 * n * n * (n - 1);
    const double edge = 1.0 / n;
    EXPECT_EQ(Count(box, ortho, PointTemplate::Corners, edge), corners);
    EXPECT_EQ(Count(box, ortho, PointTemplate::Centers, edge), centers);
    EXPECT_EQ(Count(box, ortho, PointTemplate::BodyCentered, edge / bodyEdge), corners + centers);
    EXPECT_EQ(Count(box, ortho, PointTemplate::FaceCentered, edge / faceEdge), corners + sides);
  }
  // An octree with one spacing has cells of one size that fill the box.
  const PointPlacement octree = PointPlacement::Octree;
  EXPECT_EQ(Count(box, octree, PointTemplate::Corners, 0.14), 7u * 7u * 7u);
  EXPECT_EQ(Count(box, octree, PointTemplate::Centers, 0.14), 8u * 8u * 8u);
  EXPECT_EQ(Count(box, octree, PointTemplate::BodyCentered, 0.1), 343u + 512u);
  EXPECT_EQ(Count(box, octree, PointTemplate::FaceCentered, 0.1), 216u + 3u * 49u * 6u);
  // One length for each axis.
  EXPECT_EQ(Count(box, ortho, PointTemplate::Corners, LocalSpacing(Vec3{ 0.5, 0.25, 0.125 })),
    1u * 3u * 7u);
  EXPECT_EQ(
    Count(box, octree, PointTemplate::Corners, LocalSpacing(Vec3{ 0.6, 0.3, 0.14 })), 1u * 3u * 7u);
}

TEST(MeshPointGenerator, UsesGivenTicks)
{
  const TriangleMesh box = MakeBox({ 1.0, 1.0, 1.0 });
  MeshPointGeneratorOptions options = MakeOptions(PointPlacement::OrthoProduct);
  options.Template = PointTemplate::Corners;
  options.Ticks = { std::vector<double>{ 0.5, 0.0, 1.0, 0.25, 0.5, 0.125 },
    std::vector<double>{ 0.0, 0.5, 1.0 }, std::vector<double>{} };
  const MeshPointGeneratorOutput output = Generate(box, MakeConstant(0.2), options);
  std::set<double> x;
  std::set<double> z;
  for (const Vec3& p : output.Points)
  {
    x.insert(p.X);
    z.insert(p.Z);
    EXPECT_EQ(p.Y, 0.5);
  }
  EXPECT_EQ(x, (std::set<double>{ 0.125, 0.25, 0.5 }));
  EXPECT_EQ(z.size(), 4u);
  EXPECT_EQ(output.Points.size(), 12u);

  // Graded: gaps are as large as the sizing at most, and add up to the side.
  options.Ticks = {};
  const auto sizing = [](const Vec3& p) { return 0.01 + 0.2 * p.X; };
  const MeshPointGeneratorOutput graded = Generate(box, sizing, options);
  x.clear();
  for (const Vec3& p : graded.Points)
  {
    x.insert(p.X);
  }
  double last = *x.begin();
  for (auto place = std::next(x.begin()); place != x.end(); last = *place++)
  {
    const double ratio = (*place - last) / sizing({ 0.5 * (last + *place), 0.0, 0.0 });
    EXPECT_LT(ratio, 1.34);
    EXPECT_GT(ratio, 0.5);
  }
}

TEST(MeshPointGenerator, PointsLieStrictlyInsideAndClearOfTheBoundary)
{
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    const TriangleMesh surface =
      Triangulate(MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 3, 0.4));
    // The cells are convex: a point is inside of one strictly if it lies on the inner side of all
    // of its triangles, exactly.
    const auto isInside = [&surface](const Vec3& p, Id region)
    {
      for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
      {
        const TriangleIds& ids = surface.Triangles[t];
        const int side =
          Orientation(surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]], p);
        if ((surface.Labels[t].Front == region && side <= 0) ||
          (surface.Labels[t].Back == region && side >= 0))
        {
          return false;
        }
      }
      return true;
    };
    for (const PointPlacement placement :
      { PointPlacement::Octree, PointPlacement::OrthoProduct, PointPlacement::Random })
    {
      MeshPointGeneratorOptions options = MakeOptions(placement);
      options.Template = PointTemplate::Corners;
      options.SmoothingIterations = 2;
      const MeshPointGeneratorOutput output = Generate(surface, MakeConstant(0.1), options);
      EXPECT_GT(output.Points.size(), 150u);
      // Cells are all alike here: the shortest of their edges is the smallest distance.
      const std::vector<double> nearest = GetNearestDistances(output.Points);
      const double spacing = placement == PointPlacement::Random
        ? 0.1
        : *std::min_element(nearest.begin(), nearest.end());
      for (std::size_t i = 0; i < output.Points.size(); ++i)
      {
        EXPECT_TRUE(isInside(output.Points[i], output.Regions[i]));
        EXPECT_GE(GetDistanceToSurface(output.Points[i], surface), 0.5 * spacing * (1.0 - 1e-12));
      }
    }
  }
}

TEST(MeshPointGenerator, RandomPointsKeepTheirDistanceAndGetMoreEven)
{
  const TriangleMesh box = MakeBox({ 1.0, 1.0, 1.0 });
  MeshPointGeneratorOptions options = MakeOptions(PointPlacement::Random);
  constexpr double spacing = 0.1;
  // The mean square distance of places, 0.5 spacings from the boundary on, from the nearest point:
  // what Lloyd's iteration minimizes.
  const auto getEnergy = [](const std::vector<Vec3>& points)
  {
    double sum = 0.0;
    constexpr int n = 30;
    for (int i = 0; i < n * n * n; ++i)
    {
      const Vec3 place{ 0.05 + 0.9 * (i % n + 0.5) / n, 0.05 + 0.9 * (i / n % n + 0.5) / n,
        0.05 + 0.9 * (i / n / n + 0.5) / n };
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& p : points)
      {
        nearest = std::min(nearest, SquaredNorm(p - place));
      }
      sum += nearest;
    }
    return sum / (n * n * n);
  };
  double last = std::numeric_limits<double>::infinity();
  MeshPointGeneratorOutput smooth;
  std::vector<double> medians;
  for (const int iterations : { 0, 1, 3, 10 })
  {
    options.SmoothingIterations = iterations;
    smooth = Generate(box, MakeConstant(spacing), options);
    const double energy = getEnergy(smooth.Points);
    EXPECT_LT(energy, last);
    last = energy;
    std::vector<double> nearest = GetNearestDistances(smooth.Points);
    std::sort(nearest.begin(), nearest.end());
    medians.push_back(nearest[nearest.size() / 2]);
    if (iterations == 0)
    {
      EXPECT_GE(nearest.front(), 0.62 * spacing);
    }
  }
  EXPECT_GT(medians.back(), medians.front());

  // The same seed, the same points; another one, others.
  EXPECT_EQ(Generate(box, MakeConstant(spacing), options).Points, smooth.Points);
  options.Seed = 2;
  EXPECT_NE(Generate(box, MakeConstant(spacing), options).Points, smooth.Points);

  // In the metric of a tensor: short in a direction askew.
  const Vec3 direction{ 0.6, 0.8, 0.0 };
  const LocalSpacing layer(direction, 0.05, 0.2);
  const MeshPointGeneratorOutput askew = Generate(box, MakeConstant(layer), options);
  EXPECT_GT(askew.Points.size(), 200u);
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < askew.Points.size(); ++i)
  {
    Vec3 offset;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < askew.Points.size(); ++j)
    {
      const Vec3 candidate = askew.Points[j] - askew.Points[i];
      if (i != j && Norm(layer.ToUnits(candidate)) < shortest)
      {
        shortest = Norm(layer.ToUnits(candidate));
        offset = candidate;
      }
    }
    const double part = Dot(offset, direction);
    along += std::abs(part);
    across += std::sqrt(std::max(0.0, SquaredNorm(offset) - part * part));
    EXPECT_GT(shortest, 0.25);
  }
  // Of an isotropic offset in units the mean part along a line is 1/2, that across pi/4; times the
  // lengths: 1/2 0.05 to pi/4 0.2, or 1 to 2 pi.
  EXPECT_NEAR(across / along, 2.0 * 3.14159, 1.5);
}

TEST(MeshPointGenerator, LayersHaveTheirDistances)
{
  for (const double angle : { 0.0, 0.9 })
  {
    SCOPED_TRACE(angle);
    const TriangleMesh stack = MakeStack({ 1.0, 1.0, 1.0 }, { 0.5 }, angle);
    Vec3 up[1] = { { 0.0, 0.0, 1.0 } };
    std::vector<Vec3> axis(up, up + 1);
    Rotate(axis, { 0.6, 0.8, 0.0 }, angle);
    // Region 1 lies above the cut.
    MeshPointGeneratorOptions options = MakeOptions(PointPlacement::None);
    options.Layers = { { 1, 0, 6, 0.002, 1.5 }, { 0, 1, 2, 0.01, 1.0 } };
    const MeshPointGeneratorOutput output = Generate(stack, MakeConstant(0.2), options);
    std::vector<int> counts(7, 0);
    for (std::size_t i = 0; i < output.Points.size(); ++i)
    {
      const double height = Dot(output.Points[i], axis[0]) - 0.5;
      const Id layer = output.Layers[i];
      ASSERT_GT(layer, 0);
      // The sum of a geometric series.
      const double expected =
        output.Regions[i] == 1 ? 0.002 * (std::pow(1.5, layer) - 1.0) / 0.5 : -0.01 * layer;
      EXPECT_NEAR(height, expected, 1e-14);
      ++counts[layer];
    }
    EXPECT_GT(counts[6], 10);
    EXPECT_EQ(counts[3], counts[6]);
    EXPECT_EQ(counts[1], 2 * counts[6]);
    EXPECT_EQ(output.DroppedLayerPoints, 0);

    // Other points stay away from the layers.
    options.Placement = PointPlacement::Octree;
    const MeshPointGeneratorOutput both = Generate(stack, MakeConstant(0.2), options);
    EXPECT_GT(both.Points.size(), output.Points.size());
    const double last = 0.002 * (std::pow(1.5, 6) - 1.0) / 0.5;
    for (std::size_t i = 0; i < both.Points.size(); ++i)
    {
      const double height = Dot(both.Points[i], axis[0]) - 0.5;
      if (both.Layers[i] == 0)
      {
        EXPECT_GT(both.Regions[i] == 1 ? height - last : -0.02 - height, 0.04);
      }
    }
  }
}

TEST(MeshPointGenerator, LayersFollowABentInterface)
{
  // An octagonal prism of region 1 in a box of region 0: layers outside and inside of its flanks.
  constexpr int sides = 8;
  PolygonSoup soup = CellComplex({ 4.0, 4.0, 1.0 }).GetSoup();
  for (RegionPair& labels : soup.Labels)
  {
    labels = { OutsideRegion, 0 };
  }
  const Id first = static_cast<Id>(soup.Points.size());
  for (int i = 0; i < 2 * sides; ++i)
  {
    const double angle = 2.0 * 3.14159265358979323846 * (i % sides) / sides;
    soup.Points.push_back(
      { 2.0 + std::cos(angle), 2.0 + std::sin(angle), i < sides ? 0.25 : 0.75 });
  }
  const auto add = [&soup](const std::vector<Id>& ids)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), ids.begin(), ids.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    soup.Labels.push_back({ 0, 1 });
  };
  std::vector<Id> bottom;
  std::vector<Id> top;
  for (Id i = 0; i < sides; ++i)
  {
    const Id next = (i + 1) % sides;
    add({ first + i, first + next, first + sides + next, first + sides + i });
    top.push_back(first + sides + i);
    bottom.push_back(first + sides - 1 - i);
  }
  add(top);
  add(bottom);
  const TriangleMesh surface = Triangulate(soup);
  MeshPointGeneratorOptions options = MakeOptions(PointPlacement::None);
  options.Layers = { { 0, 1, 3, 0.02, 2.0 }, { 1, 0, 3, 0.02, 2.0 } };
  const MeshPointGeneratorOutput output = Generate(surface, MakeConstant(0.15), options);
  TriangleMesh interface;
  interface.Points = surface.Points;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    if (surface.Labels[t] == RegionPair{ 0, 1 })
    {
      interface.Triangles.push_back(surface.Triangles[t]);
    }
  }
  int atEdges = 0;
  EXPECT_GT(output.Points.size(), 1000u);
  for (std::size_t i = 0; i < output.Points.size(); ++i)
  {
    const double expected = 0.02 * (std::pow(2.0, output.Layers[i]) - 1.0);
    EXPECT_NEAR(GetDistanceToSurface(output.Points[i], interface), expected, 1e-9);
    const double x = output.Points[i].X - 2.0;
    const double y = output.Points[i].Y - 2.0;
    atEdges += std::abs(x) < 1e-9 || std::abs(y) < 1e-9;
  }
  // Columns stand on the edges between the flanks as well.
  EXPECT_GT(atEdges, 4 * 3);
}

TEST(MeshPointGenerator, ThinLayersAreMeshedWithoutRefinement)
{
  // An oxide of 1/50 of the spacing with three layers of points in it, and one layer above it.
  const TriangleMesh stack = MakeStack({ 1.0, 1.0, 1.0 }, { 0.5, 0.504 });
  MeshPointGeneratorOptions options = MakeOptions(PointPlacement::None);
  options.Layers = { { 1, 0, 3, 0.001, 1.0 }, { 2, 1, 4, 0.004, 2.0 } };
  const SizingField sizing = MakeConstant(0.2);
  const MeshPointGeneratorOutput output = Generate(stack, sizing, options);
  EXPECT_GT(output.Points.size(), 100u);
  DelaunaySurfaceRefinerInput input;
  input.Surface = &stack;
  input.Sizing = sizing;
  DelaunaySurfaceRefinerOutput alone;
  ASSERT_TRUE(RefineDelaunaySurface(input, {}, {}, alone).IsOk());
  input.MeshPoints = &output.Points;
  DelaunaySurfaceRefinerOptions refinerOptions;
  refinerOptions.MeshPointClearanceRatio = 0.0;
  DelaunaySurfaceRefinerOutput refined;
  ASSERT_TRUE(RefineDelaunaySurface(input, refinerOptions, {}, refined).IsOk());
  EXPECT_TRUE(refined.UnresolvedTriangles.empty());
  EXPECT_EQ(refined.KeptMeshPoints.size(), output.Points.size());
  // The layers stand on vertices: they ask for few points of the surface.
  EXPECT_LT(refined.Surface.Points.size(), 1.2 * alone.Surface.Points.size());

  AdvancingFrontTetrahedralizerInput frontInput;
  frontInput.Surface = &refined.Surface;
  frontInput.MeshPoints = &output.Points;
  AdvancingFrontTetrahedralizerOutput mesh;
  ASSERT_TRUE(TetrahedralizeByAdvancingFront(frontInput, {}, {}, mesh).IsOk());
  MeshCertificate report;
  ASSERT_TRUE(CertifyMesh(mesh.Mesh, &mesh.Boundary, {}, report).IsOk());
  EXPECT_TRUE(report.IsDelaunay(1e-10)) << report.GetText();
}

TEST(MeshPointGenerator, RefusesWhatCannotBe)
{
  const TriangleMesh box = MakeBox({ 1.0, 1.0, 1.0 });
  MeshPointGeneratorOutput output;
  const auto expect = [&](const MeshPointGeneratorOptions& options, double spacing, StatusCode code,
                        const std::string& part)
  {
    const MeshPointGeneratorInput input{ &box, MakeConstant(spacing) };
    const Status status = GenerateMeshPoints(input, options, {}, output);
    EXPECT_EQ(status.Code, code);
    EXPECT_NE(status.Message.find(part), std::string::npos) << status.Message;
  };
  MeshPointGeneratorOptions options;
  options.MaximumNumberOfPoints = 1000;
  for (const PointPlacement placement :
    { PointPlacement::Octree, PointPlacement::OrthoProduct, PointPlacement::Random })
  {
    options.Placement = placement;
    expect(options, 0.05, StatusCode::LimitReached, "1000 points");
  }
  options = MakeOptions(PointPlacement::None);
  options.Layers = { { 0, 3, 2, 0.1, 1.0 } };
  expect(options, 0.2, StatusCode::InvalidOption, "no interface");

  // A spacing larger than the body leaves no place, which is no error.
  options = {};
  EXPECT_TRUE(Generate(box, MakeConstant(100.0), options).Points.size() <= 1);
}

TEST(MeshPointGenerator, ReportsProgressAndAborts)
{
  const TriangleMesh stack = MakeStack({ 1.0, 1.0, 1.0 }, { 0.5 });
  for (const PointPlacement placement :
    { PointPlacement::Octree, PointPlacement::OrthoProduct, PointPlacement::Random })
  {
    MeshPointGeneratorOptions options = MakeOptions(placement);
    options.Layers = { { 0, 1, 2, 0.01, 1.0 } };
    options.SmoothingIterations = 2;
    const MeshPointGeneratorInput input{ &stack, MakeConstant(0.05) };
    double last = 0.0;
    double abortAt = 2.0;
    const ExecutionContext context(
      [&last](double fraction, const char*)
      {
        EXPECT_GE(fraction, last);
        last = fraction;
      },
      [&last, &abortAt] { return last >= abortAt; });
    MeshPointGeneratorOutput output;
    ASSERT_TRUE(GenerateMeshPoints(input, options, context, output).IsOk());
    EXPECT_GT(last, 0.7);
    for (const double at : { 0.1, 0.25, 0.4, 0.7 })
    {
      last = 0.0;
      abortAt = at;
      EXPECT_TRUE(GenerateMeshPoints(input, options, context, output).IsAborted()) << at;
    }
  }
}

TEST(MeshPointGenerator, TheSameForAnyNumberOfThreads)
{
  const TriangleMesh stack = MakeStack({ 1.0, 1.0, 1.0 }, { 0.5 }, 0.3);
  const SizingField graded = [](const Vec3& p) {
    return 0.02 + 0.1 * Distance(p, { 0.3, 0.2, 0.1 });
  };
  const SizingField flat = [](const Vec3& p) {
    return LocalSpacing(Vec3{ 0.05 + 0.1 * p.X, 0.1, 0.03 + 0.05 * p.Y });
  };
  struct Case
  {
    PointPlacement Placement;
    bool HasLayers;
  };
  for (const SizingField& sizing : { graded, flat })
  {
    for (const Case& one : { Case{ PointPlacement::Octree, false },
           Case{ PointPlacement::OrthoProduct, true }, Case{ PointPlacement::Random, false },
           Case{ PointPlacement::Random, true }, Case{ PointPlacement::None, true } })
    {
      MeshPointGeneratorOptions options = MakeOptions(one.Placement);
      options.SmoothingIterations = 2;
      if (one.HasLayers)
      {
        options.Layers = { { 0, 1, 3, 0.01, 1.2 } };
      }
      const MeshPointGeneratorOutput expected = Generate(stack, sizing, options);
      EXPECT_GT(expected.Points.size(), one.Placement == PointPlacement::None ? 100u : 3000u);
      for (const int threads : { 2, 3, 8 })
      {
        const MeshPointGeneratorOutput output =
          Generate(stack, sizing, options, ExecutionContext(threads));
        EXPECT_EQ(output.Points, expected.Points) << threads;
        EXPECT_EQ(output.Regions, expected.Regions) << threads;
        EXPECT_EQ(output.Layers, expected.Layers) << threads;
        EXPECT_EQ(output.DroppedLayerPoints, expected.DroppedLayerPoints) << threads;
      }
    }
  }
}
