// SPDX-License-Identifier: BSD-3-Clause
// Smoothing by the mesher: what it must not change, and what it makes better.
#include "ComplexKinds.h"
#include "Core/Pipeline/ConformingMesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <string>
#include <vector>

using namespace cdm;

namespace
{
constexpr double LongestEdge = 0.3;
constexpr int Rounds = 4;

ConformingMesherOutput Mesh(const PolygonSoup& soup, const std::vector<Vec3>& meshPoints,
  const ConformingMesherOptions& options, const ExecutionContext& context = {})
{
  ConformingMesherInput input;
  input.Polygons = &soup;
  input.MeshPoints = &meshPoints;
  ConformingMesherOutput output;
  const Status status = MeshPolygons(input, options, context, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}

/** The corners of the triangles, and their labels. */
std::vector<std::array<Vec3, 3>> GetTriangles(const TriangleMesh& surface)
{
  std::vector<std::array<Vec3, 3>> triangles;
  for (const TriangleIds& ids : surface.Triangles)
  {
    triangles.push_back({ surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]] });
  }
  return triangles;
}

double GetLongestEdge(const TetMesh& mesh)
{
  double longest = 0.0;
  for (const TetrahedronIds& ids : mesh.Tetrahedra)
  {
    for (const auto& edge : TetrahedronEdges)
    {
      longest = std::max(longest, Distance(mesh.Points[ids[edge[0]]], mesh.Points[ids[edge[1]]]));
    }
  }
  return longest;
}

/** Volume of boxes without signs that is too much, in all regions. */
double GetExcess(const MeshCertificate& certificate)
{
  double excess = 0.0;
  for (const RegionVolume& region : certificate.Regions)
  {
    excess += region.Volume * (region.UnsignedBoxRatio - 1.0);
  }
  return excess;
}

void ExpectNothingWorse(const ConformingMesherOutput& before, const ConformingMesherOutput& after)
{
  EXPECT_EQ(GetTriangles(before.Boundary), GetTriangles(after.Boundary));
  EXPECT_EQ(before.Boundary.Labels, after.Boundary.Labels);
  EXPECT_EQ(before.Facets, after.Facets);
  EXPECT_EQ(before.Mesh.Points.size(), after.Mesh.Points.size());
  const MeshCertificate& a = before.Certificate;
  const MeshCertificate& b = after.Certificate;
  EXPECT_EQ(a.GetVerdict(1e-9), b.GetVerdict(1e-9)) << b.GetText();
  for (const MeshFault fault : { MeshFault::FacetSphere, MeshFault::NegativeCoupling })
  {
    EXPECT_LE(b.GetCount(fault), a.GetCount(fault));
  }
  EXPECT_LE(b.Under15Degrees.Count, a.Under15Degrees.Count);
  EXPECT_GE(b.SmallestDihedralAngle, std::min(a.SmallestDihedralAngle, 15.0));
  EXPECT_LE(GetLongestEdge(after.Mesh), std::max(LongestEdge, GetLongestEdge(before.Mesh)));
  EXPECT_LE(GetExcess(b), GetExcess(a) * (1.0 + 1e-12));
}
} // namespace

/** Given mesh points stay, generated ones may move. */
TEST(OptimalDelaunaySmoothing, MakesNothingWorseInRandomComplexes)
{
  double before = 0.0;
  double after = 0.0;
  for (const ComplexKind kind : { ComplexKind::CubeTetrahedra, ComplexKind::GridTetrahedra,
         ComplexKind::VoronoiCells, ComplexKind::Boxes })
  {
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
    {
      SCOPED_TRACE(std::string(GetComplexKindName(kind)) + ", seed " + std::to_string(seed));
      const PolygonSoup soup = ComplexMaker(kind, seed).Make();
      if (soup.GetNumberOfPolygons() == 0)
      {
        continue;
      }
      ConformingMesherOptions options;
      options.Choices.MaximumEdgeLength = LongestEdge;
      options.Choices.Criterion =
        seed % 2 == 0 ? SurfaceCriterion::SmallestSphereAndEdges : SurfaceCriterion::SmallestSphere;
      options.Choices.GeneratesMeshPoints = seed == 1;
      const ConformingMesherOutput rough = Mesh(soup, {}, options);
      options.SmoothingRounds = Rounds;
      const ConformingMesherOutput smooth = Mesh(soup, {}, options);
      ExpectNothingWorse(rough, smooth);
      before += GetExcess(rough.Certificate);
      after += GetExcess(smooth.Certificate);
    }
  }
  std::cout << "volume of unsigned boxes too large by " << before << ", smoothed by " << after
            << "\n";
  EXPECT_LT(after, 0.9 * before);
}

TEST(OptimalDelaunaySmoothing, GivenPointsStay)
{
  const PolygonSoup soup = ComplexMaker(ComplexKind::VoronoiCells, 1).Make();
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = LongestEdge;
  const ConformingMesherOutput first = Mesh(soup, {}, options);
  std::vector<Vec3> centers;
  for (std::size_t t = 0; t < first.Mesh.Tetrahedra.size(); t += 50)
  {
    const auto [a, b, c, d] = GetCorners(first.Mesh.Points, first.Mesh.Tetrahedra[t]);
    centers.push_back(0.25 * (a + b + c + d));
  }
  const ConformingMesherOutput rough = Mesh(soup, centers, options);
  options.SmoothingRounds = Rounds;
  const ConformingMesherOutput smooth = Mesh(soup, centers, options);
  ExpectNothingWorse(rough, smooth);
  const auto holds = [](const ConformingMesherOutput& output, const Vec3& point)
  {
    const std::vector<Vec3>& points = output.Mesh.Points;
    return std::find(points.begin(), points.end(), point) != points.end();
  };
  EXPECT_GT(std::count_if(centers.begin(), centers.end(),
              [&](const Vec3& center) { return holds(rough, center); }),
    0);
  for (const Vec3& center : centers)
  {
    EXPECT_EQ(holds(rough, center), holds(smooth, center));
  }
}

TEST(OptimalDelaunaySmoothing, DoesNotDependOnThreadsAndAborts)
{
  const PolygonSoup soup = ComplexMaker(ComplexKind::Boxes, 2).Make();
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = LongestEdge;
  options.SmoothingRounds = Rounds;
  const ConformingMesherOutput one = Mesh(soup, {}, options, ExecutionContext(1));
  const ConformingMesherOutput three = Mesh(soup, {}, options, ExecutionContext(3));
  EXPECT_EQ(one.Mesh.Points, three.Mesh.Points);
  EXPECT_EQ(one.Mesh.Tetrahedra, three.Mesh.Tetrahedra);

  bool isSmoothing = false;
  const ExecutionContext aborted([&](double, const char* activity)
    { isSmoothing = isSmoothing || std::string(activity).find("Smoothing") != std::string::npos; },
    [&] { return isSmoothing; });
  ConformingMesherInput input;
  input.Polygons = &soup;
  ConformingMesherOutput output;
  EXPECT_TRUE(MeshPolygons(input, options, aborted, output).IsAborted());
  EXPECT_TRUE(isSmoothing);
  EXPECT_TRUE(output.Mesh.Tetrahedra.empty());
}
