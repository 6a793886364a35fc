// SPDX-License-Identifier: BSD-3-Clause
// All stages in one run: the same as the stages one after the other, errors and warnings in cells of
// the input, limits that are said.
#include "ComplexKinds.h"
#include "Core/Meshes/SurfacePolygons.h"
#include "Core/Pipeline/ConformingMesher.h"
#include "Core/Surface/StructuralEdges.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "LayerSurfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <string>
#include <tuple>
#include <vector>

#if defined(__GLIBC__) && defined(__x86_64__)
#include <fpu_control.h>
#include <xmmintrin.h>
#endif

using namespace cdm;

namespace
{
/** The unit cube; face i is polygon i. */
PolygonSoup MakeCube()
{
  PolygonSoup soup;
  for (int i = 0; i < 8; ++i)
  {
    soup.Points.push_back({ double(i & 1), double(i >> 1 & 1), double(i >> 2) });
  }
  for (const std::vector<Id>& face : std::vector<std::vector<Id>>{ { 0, 2, 3, 1 }, { 4, 5, 7, 6 },
         { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
  {
    soup.Connectivity.insert(soup.Connectivity.end(), face.begin(), face.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  }
  return soup;
}

ConformingMesherOutput Mesh(const PolygonSoup& soup, const ConformingMesherOptions& options)
{
  ConformingMesherInput input;
  input.Polygons = &soup;
  ConformingMesherOutput output;
  const Status status = MeshPolygons(input, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}

bool Warns(const ConformingMesherOutput& output, const std::string& part)
{
  return std::any_of(output.Warnings.begin(), output.Warnings.end(),
    [&](const Warning& warning) { return warning.Message.find(part) != std::string::npos; });
}

/** Stages 0 to 3, or to 5 with Steiner points, by hand. */
TetMesh RunStages(const PolygonSoup& soup, const ConformingMesherOptions& options)
{
  BoundaryTriangulatorOutput clean;
  EXPECT_TRUE(TriangulateBoundary(soup, options.Boundary, {}, clean).IsOk());
  DelaunaySurfaceRefinerInput refinerInput;
  refinerInput.Surface = &clean.Surface;
  DelaunaySurfaceRefinerOutput refined;
  DelaunaySurfaceRefinerOptions refinerOptions = options.Surface;
  refinerOptions.Criterion = options.Choices.Criterion.value();
  EXPECT_TRUE(RefineDelaunaySurface(refinerInput, refinerOptions, {}, refined).IsOk());
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &refined.Surface;
  AdvancingFrontTetrahedralizerOutput made;
  EXPECT_TRUE(TetrahedralizeByAdvancingFront(input, {}, {}, made).IsOk());
  if (!options.Choices.AddsSteinerPoints.value())
  {
    return made.Mesh;
  }
  SteinerPointRefinerInput steinerInput;
  steinerInput.Mesh = &made.Mesh;
  steinerInput.Boundary = &made.Boundary;
  steinerInput.IsFree.assign(made.Mesh.Points.size(), 1);
  std::fill_n(steinerInput.IsFree.begin(), clean.Surface.Points.size(), 0);
  SteinerPointRefinerOptions steinerOptions;
  steinerOptions.Criterion = options.Choices.Criterion.value();
  const std::vector<Id> facets =
    NumberFacets(SortEdgeUses(refined.Surface.Triangles, refined.Surface.Points.size()),
      refined.StructuralEdges);
  for (const Id source : made.Boundary.SourceCells)
  {
    steinerOptions.StructuralEdges.Facets.push_back(facets[source]);
  }
  SteinerPointRefinerOutput steiner;
  EXPECT_TRUE(RefineBySteinerPoints(steinerInput, steinerOptions, {}, steiner).IsOk());
  return steiner.Mesh;
}
} // namespace

TEST(ConformingMesher, EqualsItsStages)
{
  for (const ComplexKind kind : { ComplexKind::GridTetrahedra, ComplexKind::Boxes })
  {
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
    {
      SCOPED_TRACE(std::to_string(static_cast<int>(kind)) + ", seed " + std::to_string(seed));
      const PolygonSoup soup = ComplexMaker(kind, seed).Make();
      if (soup.GetNumberOfPolygons() == 0)
      {
        continue;
      }
      ConformingMesherOptions options;
      options.Choices.MaximumEdgeLength = 0.0;
      options.Choices.Criterion = SurfaceCriterion::Delaunay;
      options.Choices.AddsSteinerPoints = false;
      options.Choices.RemovesSlivers = false;
      EXPECT_EQ(Mesh(soup, options).Mesh.Tetrahedra, RunStages(soup, options).Tetrahedra);
      options.Choices.RemovesSlivers = true;
      options.Choices.AddsSteinerPoints = true;
      options.Choices.Criterion = SurfaceCriterion::SmallestSphere;
      const ConformingMesherOutput output = Mesh(soup, options);
      EXPECT_TRUE(output.Certificate.IsDelaunay(1e-6)) << output.Certificate.GetText();
      const TetMesh expected = RunStages(soup, options);
      EXPECT_EQ(output.Mesh.Tetrahedra, expected.Tetrahedra);
      EXPECT_EQ(output.Mesh.Points, expected.Points);
    }
  }
}

TEST(ConformingMesher, ErrorsNamePolygonsAndPointsOfTheInput)
{
  // Open at face 4; a point that is not used comes first.
  PolygonSoup soup = MakeCube();
  soup.Points.insert(soup.Points.begin(), Vec3{ 0.5, 0.5, 0.5 });
  for (Id& id : soup.Connectivity)
  {
    ++id;
  }
  const PolygonSoup closed = soup;
  soup.Connectivity.resize(20);
  soup.Offsets.pop_back();
  ConformingMesherInput input;
  input.Polygons = &soup;
  ConformingMesherOutput output;
  Status status = MeshPolygons(input, {}, {}, output);
  EXPECT_EQ(status.Code, StatusCode::NotClosed) << status.Message;
  EXPECT_FALSE(status.Cells.empty());
  EXPECT_TRUE(std::all_of(
    status.Cells.begin(), status.Cells.end(), [](Id cell) { return cell >= 0 && cell < 5; }));
  EXPECT_FALSE(output.Problems.empty());
  EXPECT_TRUE(output.Mesh.Points.empty());

  input.Polygons = &closed;
  ConformingMesherOptions options;
  options.Choices.GeneratesMeshPoints = true;
  options.MeshPoints.Layers = { { 0, 5, 1, 0.1, 1.0 } };
  EXPECT_EQ(MeshPolygons(input, options, {}, output).Code, StatusCode::InvalidOption);
}

/** Walls and bottom 3 thick: points of the octree lie in the middle of them, but are not needed. */
// Steiner points took an open sheet beside the body for a boundary that is not in the mesh.
TEST(ConformingMesher, OpenSheetsBesideABodyAreLeftOut)
{
  PolygonSoup soup = MakeCube();
  for (const Vec3& p : { Vec3{ 2.0, 0.0, 0.0 }, Vec3{ 3.0, 0.0, 0.0 }, Vec3{ 2.0, 1.0, 0.5 } })
  {
    soup.Connectivity.push_back(static_cast<Id>(soup.Points.size()));
    soup.Points.push_back(p);
  }
  soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
  ConformingMesherOptions options;
  options.Surface.MaximumEdgeLength = 0.4;
  for (const bool addsSteinerPoints : { false, true })
  {
    options.Choices.AddsSteinerPoints = addsSteinerPoints;
    const ConformingMesherOutput output = Mesh(soup, options);
    EXPECT_TRUE(output.Certificate.IsDelaunay(1e-12)) << output.Certificate.GetText();
    const auto warning = std::find_if(output.Warnings.begin(), output.Warnings.end(),
      [](const Warning& one) { return one.Message.find("bound no") != std::string::npos; });
    ASSERT_NE(warning, output.Warnings.end());
    EXPECT_FALSE(warning->Cells.empty());
    EXPECT_EQ(std::count(warning->Cells.begin(), warning->Cells.end(), 6),
      static_cast<std::ptrdiff_t>(warning->Cells.size()));
  }
}

TEST(ConformingMesher, MeshPointsAndSteinerPointsDoNotMultiply)
{
  // An open tray: corners of the outer box, then of the cavity, by z, y, x.
  PolygonSoup tray;
  for (const auto& [side, low, high] : { std::tuple(0.0, 0.0, 20.0), std::tuple(3.0, 3.0, 20.0) })
  {
    for (int i = 0; i < 8; ++i)
    {
      tray.Points.push_back({ (i & 1) != 0 ? 100.0 - side : side, (i & 2) != 0 ? 80.0 - side : side,
        (i & 4) != 0 ? high : low });
    }
  }
  for (const std::array<Id, 4>& face :
    std::vector<std::array<Id, 4>>{ { 0, 2, 3, 1 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 },
      { 1, 3, 7, 5 }, { 8, 9, 11, 10 }, { 8, 12, 13, 9 }, { 10, 11, 15, 14 }, { 8, 10, 14, 12 },
      { 9, 13, 15, 11 }, { 4, 5, 13, 12 }, { 7, 6, 14, 15 }, { 6, 4, 12, 14 }, { 5, 7, 15, 13 } })
  {
    tray.Connectivity.insert(tray.Connectivity.end(), face.begin(), face.end());
    tray.Offsets.push_back(static_cast<Id>(tray.Connectivity.size()));
  }
  for (const double length : { 25.0, 8.0 })
  {
    ConformingMesherOptions options;
    options.Choices.MaximumEdgeLength = length;
    const std::size_t alone = Mesh(tray, options).Mesh.Tetrahedra.size();
    options.Choices.GeneratesMeshPoints = true;
    for (const PointPlacement placement :
      { PointPlacement::Octree, PointPlacement::OrthoProduct, PointPlacement::Random })
    {
      options.MeshPoints.Placement = placement;
      const ConformingMesherOutput both = Mesh(tray, options);
      EXPECT_LE(both.Mesh.Tetrahedra.size(), 1.1 * alone)
        << "length " << length << ", placement " << static_cast<int>(placement);
      EXPECT_TRUE(both.Certificate.IsClean()) << both.Certificate.GetText();
    }
  }
}

/** Inside of a body whose size is what needs points, a lattice needs half as many tetrahedra. */
TEST(ConformingMesher, SizesAreFilledByALattice)
{
  const PolygonSoup cube = MakeCube();
  ConformingMesherOptions options;
  // Cubes that do not fit the edge of the body evenly.
  options.Choices.MaximumEdgeLength = 0.07;
  const ConformingMesherOutput automatic = Mesh(cube, options);
  EXPECT_TRUE(automatic.Settings.GeneratesMeshPoints);
  options.Choices.GeneratesMeshPoints = false;
  const ConformingMesherOutput refined = Mesh(cube, options);
  EXPECT_LT(automatic.Mesh.Tetrahedra.size(), 0.8 * refined.Mesh.Tetrahedra.size());
  for (const ConformingMesherOutput* const output : { &automatic, &refined })
  {
    EXPECT_TRUE(output->Certificate.IsClean()) << output->Certificate.GetText();
    EXPECT_GE(output->Certificate.SmallestDihedralAngle, 15.0);
    for (const TetrahedronIds& ids : output->Mesh.Tetrahedra)
    {
      for (int i = 0; i < 4; ++i)
      {
        for (int j = 0; j < i; ++j)
        {
          EXPECT_LE(Distance(output->Mesh.Points[ids[i]], output->Mesh.Points[ids[j]]),
            0.07 * (1.0 + 1e-12));
        }
      }
    }
  }
}

/** The octree follows a graded sizing by halves: where it is too fine, refinement does it. */
TEST(ConformingMesher, LatticeCostsNothingInGradedSizings)
{
  const PolygonSoup cube = MakeCube();
  ConformingMesherInput input;
  input.Polygons = &cube;
  for (const double growth : { 0.05, 0.2, 0.5 })
  {
    input.Sizing = [growth](const Vec3& p) {
      return 0.05 + growth * Distance(p, { 0.3, 0.4, 0.5 });
    };
    std::size_t counts[2];
    for (const bool isGenerating : { false, true })
    {
      ConformingMesherOptions options;
      options.Choices.GeneratesMeshPoints = isGenerating;
      ConformingMesherOutput output;
      ASSERT_TRUE(MeshPolygons(input, options, {}, output).IsOk());
      EXPECT_TRUE(output.Certificate.IsClean()) << output.Certificate.GetText();
      counts[isGenerating] = output.Mesh.Tetrahedra.size();
    }
    EXPECT_LE(counts[1], 1.05 * counts[0]) << "growth " << growth;
  }
}

/**
 * Mesh points outside of smallest spheres broke surfaces that were Delaunay by other spheres: those
 * for finite elements.
 */
TEST(ConformingMesher, LatticesLeaveEverySurfaceDelaunay)
{
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
  {
    const PolygonSoup soup = ComplexMaker(ComplexKind::CubeTetrahedra, seed).Make();
    for (const SurfaceCriterion criterion :
      { SurfaceCriterion::Delaunay, SurfaceCriterion::SmallestSphere })
    {
      SCOPED_TRACE("seed " + std::to_string(seed));
      ConformingMesherInput input;
      input.Polygons = &soup;
      ConformingMesherOptions options;
      options.Choices.Criterion = criterion;
      options.Choices.MaximumEdgeLength = 0.05 * GetBoundingBoxDiagonal(soup.Points);
      ConformingMesherOutput output;
      const Status status = MeshPolygons(input, options, {}, output);
      EXPECT_TRUE(status.IsOk()) << status.Message;
      EXPECT_TRUE(output.Settings.GeneratesMeshPoints);
      EXPECT_TRUE(output.Certificate.IsDelaunay()) << output.Certificate.GetText();
    }
  }
}

/** Long narrow triangles, as CAD programs cut walls of holes into, are remeshed by default. */
TEST(ConformingMesher, StripsAreRemeshed)
{
  const TriangleMesh tube = MakeTubeSurface(100, 0.3);
  const PolygonSoup soup = MakePolygonSoup(tube);
  const ConformingMesherOutput output = Mesh(soup, {});
  EXPECT_TRUE(Warns(output, "remeshed"));
  EXPECT_TRUE(output.Certificate.IsClean()) << output.Certificate.GetText();
  EXPECT_EQ(output.Certificate.Under15Degrees.Count, 0);
  EXPECT_LT(output.Mesh.Tetrahedra.size(), 30000u);
  ConformingMesherOptions options;
  options.MaximumDeviation = 0.0;
  EXPECT_GT(Mesh(soup, options).Mesh.Tetrahedra.size(), 3 * output.Mesh.Tetrahedra.size());
}

/** Of what was not asked for no error comes: the octree cannot be so fine, or so large. */
TEST(ConformingMesher, AutomaticMeshPointsEndNothing)
{
  const PolygonSoup cube = MakeCube();
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = 0.3;
  options.MeshPoints.MaximumNumberOfPoints = 10;
  const ConformingMesherOutput output = Mesh(cube, options);
  EXPECT_FALSE(output.Settings.GeneratesMeshPoints);
  EXPECT_TRUE(output.Warnings.empty());
  EXPECT_TRUE(output.Certificate.IsClean());
  options.Choices.GeneratesMeshPoints = true;
  ConformingMesherInput input;
  input.Polygons = &cube;
  ConformingMesherOutput failed;
  EXPECT_EQ(MeshPolygons(input, options, {}, failed).Code, StatusCode::LimitReached);
  // Layers are never left out without a word.
  options.Choices.GeneratesMeshPoints = false;
  options.MeshPoints.Layers = { { 0, OutsideRegion, 1, 0.1, 1.0 } };
  EXPECT_TRUE(Warns(Mesh(cube, options), "layers are not made"));
}

/** What has ended a stage before the sizes are reached is said. */
TEST(ConformingMesher, LimitsAreSaid)
{
  const PolygonSoup cube = MakeCube();
  ConformingMesherOptions options;
  options.MeshFor = MeshPurpose::FewestPoints;
  options.Choices.MaximumEdgeLength = 0.1;
  ConformingMesherOutput output = Mesh(cube, options);
  EXPECT_FALSE(Warns(output, "larger than asked for"));
  EXPECT_FALSE(Warns(output, "MaximumNewPoints"));
  options.Surface.MaximumNewPoints = 20;
  output = Mesh(cube, options);
  EXPECT_TRUE(Warns(output, "larger than asked for"));
  EXPECT_TRUE(Warns(output, "MaximumNewPoints"));
  EXPECT_TRUE(output.Certificate.IsDelaunay());
  options.Surface.MaximumNewPoints = 0;
  options.Surface.MinimumEdgeRatio = 0.2;
  output = Mesh(cube, options);
  EXPECT_TRUE(Warns(output, "MinimumEdgeRatio"));
  EXPECT_TRUE(output.Certificate.IsDelaunay());
}

/**
 * Whatever is done when the time is over, the mesh is valid, and what it misses is said. The whole run takes
 * three seconds, and is stopped at parts of that.
 */
TEST(ConformingMesher, TheTimeLimitLeavesAMesh)
{
  const PolygonSoup cube = MakeCube();
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = 0.04;
  for (double seconds = 1e-9; seconds < 3.0; seconds = std::max(0.01, 2.0 * seconds))
  {
    SCOPED_TRACE("seconds " + std::to_string(seconds));
    options.Surface.MaximumTime = seconds;
    const ConformingMesherOutput output = Mesh(cube, options);
    EXPECT_TRUE(output.Certificate.IsDelaunay());
    EXPECT_FALSE(output.Mesh.Tetrahedra.empty());
    EXPECT_TRUE(seconds > 1e-9 || Warns(output, "MaximumTime"));
  }
}

TEST(ConformingMesher, AbortsAtAnyTimeAndNamesItsStages)
{
  const PolygonSoup cube = MakeCube();
  ConformingMesherInput input;
  input.Polygons = &cube;
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = 0.2;
  options.Choices.GeneratesMeshPoints = true;
  options.Choices.AddsSteinerPoints = true;
  double last = 0.0;
  double end = 2.0;
  std::string text;
  const ExecutionContext context(
    [&](double fraction, const char* activity)
    {
      EXPECT_GE(fraction, last);
      last = fraction;
      text += activity + std::string("\n");
    },
    [&] { return last >= end; });
  ConformingMesherOutput output;
  ASSERT_TRUE(MeshPolygons(input, options, context, output).IsOk());
  EXPECT_GT(last, 0.95);
  for (const char* const stage : { "Boundary triangulation: ", "Mesh points: ",
         "Surface refinement: ", "Tetrahedralization: ", "Steiner points: " })
  {
    EXPECT_NE(text.find(stage), std::string::npos) << stage;
  }
  for (const double at : { 0.0, 0.15, 0.3, 0.55, 0.7, 0.96 })
  {
    last = 0.0;
    end = at;
    EXPECT_TRUE(MeshPolygons(input, options, context, output).IsAborted()) << at;
    EXPECT_TRUE(output.Mesh.Points.empty());
    EXPECT_TRUE(output.Warnings.empty());
  }
}

/** Points of the input stay; others have a history that leads back to it. */
TEST(ConformingMesher, PointsHaveAHistory)
{
  const PolygonSoup cube = MakeCube();
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = 0.3;
  options.Choices.AddsSteinerPoints = true;
  const ConformingMesherOutput output = Mesh(cube, options);
  const PointHistory& history = output.Points;
  ASSERT_TRUE(history.HasBefore);
  EXPECT_EQ(history.SurfaceSources.size(), 8u);
  EXPECT_EQ(history.Before.Points.size(),
    8 + history.SurfacePoints.size() + history.RefinedPoints.size() +
      history.MeshPointSources.size());
  ASSERT_EQ(history.Sources.size(), output.Mesh.Points.size());
  for (std::size_t i = 0; i < history.Sources.size(); ++i)
  {
    if (history.Sources[i] != NoId)
    {
      EXPECT_EQ(output.Mesh.Points[i], history.Before.Points[history.Sources[i]]);
    }
  }
  for (std::size_t i = 0; i < history.RefinedPoints.size(); ++i)
  {
    const PointParents& parents = history.RefinedPoints[i];
    Vec3 sum;
    for (int k = 0; k < 3 && parents.Ids[k] != NoId; ++k)
    {
      EXPECT_LT(parents.Ids[k], static_cast<Id>(8 + i));
      sum = sum + parents.Weights[k] * history.Before.Points[parents.Ids[k]];
    }
    EXPECT_LT(Distance(sum, history.Before.Points[8 + i]), 1e-12);
  }
  EXPECT_EQ(output.Facets.size(), output.Boundary.Triangles.size());
  EXPECT_TRUE(std::all_of(output.Boundary.SourceCells.begin(), output.Boundary.SourceCells.end(),
    [](Id cell) { return cell >= 0 && cell < 6; }));
}

// Other libraries of a program change the arithmetic of the thread that loads them.
TEST(ConformingMesher, ArithmeticOfTheCallerDoesNotMatter)
{
  const PolygonSoup soup = MakeCube();
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = 0.3;
  options.Choices.AddsSteinerPoints = true;
  const ConformingMesherOutput expected = Mesh(soup, options);
  const auto check = [&](const char* what)
  {
    const ConformingMesherOutput output = Mesh(soup, options);
    EXPECT_TRUE(output.Certificate.IsDelaunay()) << what;
    EXPECT_EQ(output.Mesh.Points, expected.Mesh.Points) << what;
    EXPECT_TRUE(std::equal(output.Mesh.Tetrahedra.begin(), output.Mesh.Tetrahedra.end(),
      expected.Mesh.Tetrahedra.begin(), expected.Mesh.Tetrahedra.end()))
      << what;
  };
  for (const int mode : { FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO })
  {
    std::fesetround(mode);
    check("rounding");
    EXPECT_EQ(mode, std::fegetround()) << "the caller's is back";
    std::fesetround(FE_TONEAREST);
  }
#if defined(__GLIBC__) && defined(__x86_64__)
  // As after loading the Python module of DEVSIM 2.11.2, and code built with -ffast-math.
  fpu_control_t before = 0;
  _FPU_GETCW(before);
  fpu_control_t doubles = static_cast<fpu_control_t>((before & ~_FPU_EXTENDED) | _FPU_DOUBLE);
  _FPU_SETCW(doubles);
  check("long doubles of 53 bits");
  fpu_control_t after = 0;
  _FPU_GETCW(after);
  EXPECT_EQ(doubles, after);
  _FPU_SETCW(before);
  const unsigned int flags = _mm_getcsr();
  _mm_setcsr(flags | 0x8040U);
  check("denormal numbers are zero");
  EXPECT_EQ(0x8040U, _mm_getcsr() & 0x8040U) << "the caller's is back";
  _mm_setcsr(flags);
#endif
}
