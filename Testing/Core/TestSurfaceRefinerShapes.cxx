// SPDX-License-Identifier: BSD-3-Clause
// The surface refiner on the shapes that make refinement run away: thin curved and wedged layers,
// fans of facets at one edge, many edges at one vertex, needles, sheets a hair apart.
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Measures.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>

using namespace cdm;

namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr SurfaceCriterion AllCriteria[] = { SurfaceCriterion::Delaunay,
  SurfaceCriterion::SmallestSphere, SurfaceCriterion::SmallestSphereAndEdges };

TriangleMesh Triangulate(const PolygonSoup& soup)
{
  BoundaryTriangulatorOutput output;
  const Status status = TriangulateBoundary(soup, {}, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output.Surface;
}

/**
 * Refines by a criterion, meshes, and lets the checker judge. Returns the number of points added.
 */
std::size_t RefineAndCheck(const TriangleMesh& surface, DelaunaySurfaceRefinerOptions options)
{
  DelaunaySurfaceRefinerInput input;
  input.Surface = &surface;
  options.MaximumNewPoints = 50000;
  DelaunaySurfaceRefinerOutput refined;
  const Status status = RefineDelaunaySurface(input, options, {}, refined);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  EXPECT_TRUE(refined.UnresolvedTriangles.empty())
    << refined.UnresolvedTriangles.size() << " unresolved, " << refined.NewPoints.size() << " new";
  AdvancingFrontTetrahedralizerInput mesherInput;
  mesherInput.Surface = &refined.Surface;
  AdvancingFrontTetrahedralizerOutput mesh;
  const Status meshed = TetrahedralizeByAdvancingFront(mesherInput, {}, {}, mesh);
  EXPECT_TRUE(meshed.IsOk()) << meshed.Message;
  MeshCertificate report;
  EXPECT_TRUE(CertifyMesh(mesh.Mesh, &mesh.Boundary, {}, report).IsOk());
  EXPECT_TRUE(report.IsDelaunay(1e-9)) << report.GetText();
  if (options.Criterion != SurfaceCriterion::Delaunay)
  {
    EXPECT_EQ(report.GetCount(MeshFault::FacetSphere), 0);
  }
  return refined.NewPoints.size();
}

/** Fewest pieces of an edge without one of the points in a diametral sphere. */
int CountPieces(const std::vector<Vec3>& points, const EdgeIds& edge)
{
  const Vec3& begin = points[edge[0]];
  const double length = Distance(begin, points[edge[1]]);
  const Vec3 direction = (1.0 / length) * (points[edge[1]] - begin);
  double reached = 0.0;
  int pieces = 0;
  while (reached < length)
  {
    double end = length;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double foot = Dot(points[i] - begin, direction);
      if (static_cast<Id>(i) != edge[0] && static_cast<Id>(i) != edge[1] && foot > reached)
      {
        // (p - begin) (p - end) >= 0 is what keeps p outside.
        const double height = Distance(points[i], begin + foot * direction);
        end = std::min(end, foot + height * height / (foot - reached));
      }
    }
    reached = end;
    ++pieces;
  }
  return pieces;
}

/** A sphere about the origin: an octahedron whose triangles are divided into n^2. */
PolygonSoup MakeSphere(double radius, int n)
{
  PolygonSoup soup;
  const auto addPoint = [&](const Vec3& p)
  {
    soup.Points.push_back((radius / Norm(p)) * p);
    return static_cast<Id>(soup.Points.size()) - 1;
  };
  for (int octant = 0; octant < 8; ++octant)
  {
    const double x = octant & 1 ? -1.0 : 1.0;
    const double y = octant & 2 ? -1.0 : 1.0;
    const double z = octant & 4 ? -1.0 : 1.0;
    const auto getPoint = [&](int i, int j) { return addPoint({ x * i, y * j, z * (n - i - j) }); };
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; i + j < n; ++j)
      {
        for (int half = 0; half < (i + j + 1 < n ? 2 : 1); ++half)
        {
          std::vector<Id> corners{ getPoint(i + 1, j), getPoint(i, j + 1),
            half == 0 ? getPoint(i, j) : getPoint(i + 1, j + 1) };
          if ((x * y * z > 0.0) == (half == 0))
          {
            std::swap(corners[0], corners[1]);
          }
          soup.Connectivity.insert(soup.Connectivity.end(), corners.begin(), corners.end());
          soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
        }
      }
    }
  }
  return soup;
}

/** Moves points along their radius by up to a part of it, those at one place alike. */
void Roughen(std::mt19937_64& generator, double part, PolygonSoup& soup)
{
  std::uniform_real_distribution<double> uniform(-part, part);
  std::map<std::array<double, 3>, double> roughness;
  for (Vec3& p : soup.Points)
  {
    const auto place = roughness.emplace(std::array<double, 3>{ p.X, p.Y, p.Z }, 0.0);
    place.first->second = place.second ? uniform(generator) : place.first->second;
    p = (1.0 + place.first->second) * p;
  }
}

void Append(const PolygonSoup& part, PolygonSoup& soup)
{
  const Id first = static_cast<Id>(soup.Points.size());
  soup.Points.insert(soup.Points.end(), part.Points.begin(), part.Points.end());
  for (Id polygon = 0; polygon < part.GetNumberOfPolygons(); ++polygon)
  {
    for (Id i = 0; i < part.GetPolygonSize(polygon); ++i)
    {
      soup.Connectivity.push_back(first + part.GetPolygon(polygon)[i]);
    }
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
}

/** A plate of constant thickness bent about the y axis by a right angle; radius 1, width 0.5. */
PolygonSoup MakeBentPlate(double thickness, int pieces)
{
  PolygonSoup soup;
  for (int i = 0; i <= pieces; ++i)
  {
    const double angle = 0.5 * Pi * i / pieces;
    for (double y : { 0.0, 0.5 })
    {
      for (double radius : { 1.0, 1.0 + thickness })
      {
        soup.Points.push_back({ radius * std::cos(angle), y, radius * std::sin(angle) });
      }
    }
  }
  const auto addPolygon = [&soup](const std::vector<Id>& outline)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), outline.begin(), outline.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  };
  for (Id i = 0; i < pieces; ++i)
  {
    const Id a = 4 * i;
    const Id b = a + 4;
    addPolygon({ a, a + 2, b + 2, b });
    addPolygon({ a + 1, b + 1, b + 3, a + 3 });
    addPolygon({ a, b, b + 1, a + 1 });
    addPolygon({ a + 2, a + 3, b + 3, b + 2 });
  }
  addPolygon({ 0, 1, 3, 2 });
  const Id last = 4 * pieces;
  addPolygon({ last, last + 2, last + 3, last + 1 });
  return soup;
}

/**
 * Blades at random angles about the z axis, each between two planes through it: a book whose pages
 * are prisms over triangles, every second one left out.
 */
PolygonSoup MakeFan(std::mt19937_64& generator, int blades)
{
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> angles;
  for (int i = 0; i < 2 * blades; ++i)
  {
    angles.push_back(2.0 * Pi * (i + 0.98 * uniform(generator)) / (2 * blades));
  }
  PolygonSoup soup;
  soup.Points = { { 0, 0, 0 }, { 0, 0, 1 } };
  for (int i = 0; i < 2 * blades; ++i)
  {
    const double radius = 0.5 + uniform(generator);
    for (double z : { 0.0, 1.0 })
    {
      soup.Points.push_back({ radius * std::cos(angles[i]), radius * std::sin(angles[i]), z });
    }
  }
  for (Id i = 0; i < blades; ++i)
  {
    const Id a = 2 + 4 * i;
    const Id b = a + 2;
    soup.Connectivity.insert(soup.Connectivity.end(),
      { 0, b, a, 1, a + 1, b + 1, 0, a, a + 1, 1, a, b, b + 1, a + 1, b, 0, 1, b + 1 });
    for (Id size : { 3, 3, 4, 4, 4 })
    {
      soup.Offsets.push_back(soup.Offsets.back() + size);
    }
  }
  return soup;
}

/** A star of thin tetrahedra with a common vertex at the origin. */
PolygonSoup MakeStar(std::mt19937_64& generator, int rays)
{
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  PolygonSoup soup;
  soup.Points.push_back({ 0, 0, 0 });
  std::vector<Vec3> directions;
  while (static_cast<int>(directions.size()) < rays)
  {
    const Vec3 direction = MakeRandomDirection(generator);
    if (std::all_of(directions.begin(), directions.end(),
          [&](const Vec3& other) { return Dot(direction, other) < std::cos(0.25); }))
    {
      directions.push_back(direction);
    }
  }
  for (const Vec3& direction : directions)
  {
    const double length = 0.5 + uniform(generator);
    const Vec3 side = MakeRandomDirection(generator);
    Vec3 u = Cross(direction, side);
    u = (1.0 / Norm(u)) * u;
    const Vec3 v = Cross(direction, u);
    const Id a = static_cast<Id>(soup.Points.size());
    for (int corner = 0; corner < 3; ++corner)
    {
      const double angle = 2.0 * Pi * corner / 3.0;
      soup.Points.push_back(
        length * (direction + (0.1 * std::cos(angle)) * u + (0.1 * std::sin(angle)) * v));
    }
    soup.Connectivity.insert(
      soup.Connectivity.end(), { 0, a, a + 1, 0, a + 1, a + 2, 0, a + 2, a, a, a + 2, a + 1 });
    for (int i = 0; i < 4; ++i)
    {
      soup.Offsets.push_back(soup.Offsets.back() + 3);
    }
  }
  return soup;
}
} // namespace

/**
 * Shells of down to 1:1000 between concentric spheres, and bent plates. Points do not match exactly
 * here, as the facets are tilted against each other; triangles as small as the thickness would be
 * some ten millions.
 */
TEST(SurfaceRefinerShapes, CurvedLayers)
{
  for (const SurfaceCriterion criterion : AllCriteria)
  {
    SCOPED_TRACE(static_cast<int>(criterion));
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = criterion;
    for (const double thickness : { 0.1, 0.01, 0.001 })
    {
      SCOPED_TRACE(thickness);
      PolygonSoup soup = MakeSphere(1.0, 6);
      Append(MakeSphere(1.0 + thickness, 6), soup);
      EXPECT_LT(RefineAndCheck(Triangulate(soup), options), 8000u);
      EXPECT_LT(RefineAndCheck(Triangulate(MakeBentPlate(thickness, 16)), options), 1500u);
    }
  }
}

TEST(SurfaceRefinerShapes, StackedLayers)
{
  DelaunaySurfaceRefinerOptions options;
  options.MaximumEdgeLength = 0.25;
  for (const SurfaceCriterion criterion : AllCriteria)
  {
    SCOPED_TRACE(static_cast<int>(criterion));
    options.Criterion = criterion;
    CellComplex complex({ 1.0, 1.0, 1.0 });
    for (const double height : { 0.5, 0.501, 0.5011, 0.5111, 0.512, 0.5123 })
    {
      ASSERT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, height, 1e-6));
    }
    EXPECT_LT(RefineAndCheck(Triangulate(complex.GetSoup()), options), 2000u);
  }
}

/** Layers that run out at small angles. */
TEST(SurfaceRefinerShapes, LayersEndingInAWedge)
{
  for (const SurfaceCriterion criterion : AllCriteria)
  {
    SCOPED_TRACE(static_cast<int>(criterion));
    for (const double degrees : { 10.0, 1.0, 0.1, 0.01 })
    {
      SCOPED_TRACE(degrees);
      const double angle = degrees * Pi / 180.0;
      CellComplex complex({ 1.0, 1.0, 1.0 });
      ASSERT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, 0.503, 1e-9));
      // Meets the first plane at x = 0.3: the layer between them ends there.
      const Vec3 normal{ -std::sin(angle), 0.0, std::cos(angle) };
      ASSERT_TRUE(complex.Cut(normal, Dot(normal, { 0.3, 0.0, 0.503 }), 1e-9));
      DelaunaySurfaceRefinerOptions options;
      options.Criterion = criterion;
      options.MaximumEdgeLength = 0.3;
      EXPECT_LT(RefineAndCheck(Triangulate(complex.GetSoup()), options), 3000u);
    }
  }
}

TEST(SurfaceRefinerShapes, FansAtOneEdgeAndStarsAtOneVertex)
{
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    const TriangleMesh fan = Triangulate(MakeFan(generator, 2 + static_cast<int>(seed)));
    const TriangleMesh star = Triangulate(MakeStar(generator, 4 + 2 * static_cast<int>(seed)));
    for (const SurfaceCriterion criterion : AllCriteria)
    {
      SCOPED_TRACE(static_cast<int>(criterion));
      DelaunaySurfaceRefinerOptions options;
      options.Criterion = criterion;
      RefineAndCheck(fan, options);
      RefineAndCheck(star, options);
    }
  }
}

/**
 * Rough ellipsoids whose edges are smooth at the accuracy angle: in facets that bend, points that
 * mend one triangle disturb the next. It has to end all the same, and to need fewer points than if
 * all edges were structural.
 */
TEST(SurfaceRefinerShapes, CurvedFacets)
{
  for (const SurfaceCriterion criterion : AllCriteria)
  {
    SCOPED_TRACE(static_cast<int>(criterion));
    std::size_t smooth = 0;
    std::size_t exact = 0;
    for (std::uint64_t seed = 1; seed <= 24; ++seed)
    {
      SCOPED_TRACE(seed);
      std::mt19937_64 generator(seed);
      PolygonSoup soup = MakeSphere(1.0, 4 + static_cast<int>(seed % 4));
      Roughen(generator, 0.03, soup);
      for (Vec3& p : soup.Points)
      {
        p.Z *= static_cast<double>(1 + seed % 3);
      }
      const TriangleMesh surface = Triangulate(soup);
      DelaunaySurfaceRefinerOptions options;
      options.Criterion = criterion;
      exact += RefineAndCheck(surface, options);
      options.StructuralEdges.AccuracyAngle = 25.0;
      smooth += RefineAndCheck(surface, options);
    }
    std::cout << "criterion " << static_cast<int>(criterion) << ": " << smooth << " points added, "
              << exact << " with all edges structural" << std::endl;
    EXPECT_LT(smooth, exact);
  }
}

/** Two needles with a common short side, folded about it: angles down to 1e-7 degrees. */
TEST(SurfaceRefinerShapes, Needles)
{
  for (const double width : { 1e-2, 1e-4, 1e-6, 1e-8 })
  {
    SCOPED_TRACE(width);
    // A box whose upper facet holds a slot that ends in a point.
    PolygonSoup soup;
    soup.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
      { 1, 1, 1 }, { 0, 1, 1 }, { 1, 0.5, 1.0 }, { 1, 0.5 + width, 1.0 }, { 0.2, 0.5, 1.0 },
      { 1, 0.5, 0.9 }, { 1, 0.5 + width, 0.9 }, { 0.2, 0.5, 0.9 } };
    const std::vector<std::vector<Id>> polygons{ { 0, 3, 2, 1 }, { 0, 1, 5, 4 }, { 2, 3, 7, 6 },
      { 3, 0, 4, 7 }, { 1, 2, 6, 9, 12, 11, 8, 5 }, { 4, 5, 8, 10, 9, 6, 7 }, { 8, 11, 13, 10 },
      { 10, 13, 12, 9 }, { 11, 12, 13 } };
    for (const std::vector<Id>& polygon : polygons)
    {
      soup.Connectivity.insert(soup.Connectivity.end(), polygon.begin(), polygon.end());
      soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    }
    for (const double angle : { 0.0, 0.7 })
    {
      PolygonSoup turned = soup;
      Rotate(turned.Points, (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 }, angle);
      for (const SurfaceCriterion criterion : AllCriteria)
      {
        SCOPED_TRACE(static_cast<int>(criterion));
        DelaunaySurfaceRefinerOptions options;
        options.Criterion = criterion;
        EXPECT_LT(RefineAndCheck(Triangulate(turned), options), 1000u);
      }
    }
  }
}

/** Two boxes with a gap down to 1e-8 of their size, also tilted: the count must not grow. */
TEST(SurfaceRefinerShapes, SurfacesAHairApart)
{
  for (const double gap : { 1e-2, 1e-4, 1e-6, 1e-8 })
  {
    SCOPED_TRACE(gap);
    for (const double angle : { 0.0, 0.7 })
    {
      SCOPED_TRACE(angle);
      PolygonSoup soup = CellComplex({ 1.0, 0.8, 0.6 }).GetSoup();
      PolygonSoup other = CellComplex({ 0.7, 1.1, 0.5 }).GetSoup();
      for (Vec3& p : other.Points)
      {
        p = p + Vec3{ 0.13, -0.21, 0.6 + gap };
      }
      soup.Labels.clear();
      Append(other, soup);
      Rotate(soup.Points, (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 }, angle);
      for (const SurfaceCriterion criterion : AllCriteria)
      {
        SCOPED_TRACE(static_cast<int>(criterion));
        DelaunaySurfaceRefinerOptions options;
        options.Criterion = criterion;
        EXPECT_LT(RefineAndCheck(Triangulate(soup), options), 400u);
      }
    }
  }
}

/**
 * A lower bound for Criterion 3.2: no piece of a structural edge may have a point of the input in
 * its diametral sphere, and pieces as long as that allows, one after the other, are the fewest.
 */
TEST(SurfaceRefinerShapes, NotManyMorePointsThanNeeded)
{
  double points = 0.0;
  double bound = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    CellComplex complex({ 1.0, 1.0, 1.0 });
    for (std::uint64_t cut = 0; cut <= seed % 6; ++cut)
    {
      const Vec3 normal = MakeRandomDirection(generator);
      const Vec3 inside{ uniform(generator), uniform(generator), uniform(generator) };
      complex.Cut(normal, Dot(normal, inside), 1e-4);
    }
    const TriangleMesh surface = Triangulate(complex.GetSoup());
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = SurfaceCriterion::SmallestSphereAndEdges;
    points += static_cast<double>(surface.Points.size() + RefineAndCheck(surface, options));
    StructuralEdgesOutput edges;
    ASSERT_TRUE(ExtractStructuralEdges(surface, options.StructuralEdges, {}, edges).IsOk());
    bound += static_cast<double>(surface.Points.size());
    for (const StructuralEdge& edge : edges.Edges)
    {
      bound += CountPieces(surface.Points, edge.Points) - 1;
    }
  }
  std::cout << points << " points, at least " << bound << " are needed" << std::endl;
  EXPECT_LT(points, 3.0 * bound);
}

/** Several blocks of triangles for the threads, many of them to be refined. */
TEST(SurfaceRefinerShapes, TheSameForAnyNumberOfThreads)
{
  std::mt19937_64 generator(1);
  PolygonSoup soup = MakeSphere(1.0, 25);
  Roughen(generator, 0.06, soup);
  const TriangleMesh surface = Triangulate(soup);
  DelaunaySurfaceRefinerInput input;
  input.Surface = &surface;
  for (const SurfaceCriterion criterion : AllCriteria)
  {
    SCOPED_TRACE(static_cast<int>(criterion));
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = criterion;
    DelaunaySurfaceRefinerOutput first;
    ASSERT_TRUE(RefineDelaunaySurface(input, options, {}, first).IsOk());
    EXPECT_GT(first.NewPoints.size(), 100u);
    for (const int threads : { 2, 3, 8 })
    {
      DelaunaySurfaceRefinerOutput other;
      ASSERT_TRUE(RefineDelaunaySurface(input, options, ExecutionContext(threads), other).IsOk());
      EXPECT_EQ(first.Surface.Points, other.Surface.Points);
      EXPECT_EQ(first.Surface.Triangles, other.Surface.Triangles);
    }
  }
}

/** Model units of atoms and of countries: the mesh is the same. */
TEST(SurfaceRefinerShapes, Units)
{
  std::mt19937_64 generator(7);
  const PolygonSoup fan = MakeFan(generator, 5);
  for (const SurfaceCriterion criterion : AllCriteria)
  {
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = criterion;
    const double expected = static_cast<double>(RefineAndCheck(Triangulate(fan), options));
    for (const double unit : { 1e-9, 1e-6, 1e-3, 1e+3, 1e+6 })
    {
      SCOPED_TRACE(unit);
      PolygonSoup scaled = fan;
      for (Vec3& p : scaled.Points)
      {
        p = unit * p;
      }
      const double count = static_cast<double>(RefineAndCheck(Triangulate(scaled), options));
      EXPECT_NEAR(count, expected, 0.05 * expected + 3.0);
    }
  }
}
