// SPDX-License-Identifier: BSD-3-Clause
// What a mesh is for decides what is not given, and only that; the default size.
#include "ComplexKinds.h"
#include "Core/Meshes/SurfacePolygons.h"
#include "Core/Meshes/VolumeSums.h"
#include "Core/Pipeline/ConformingMesher.h"
#include "Core/Sizing/DefaultSize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace cdm;

namespace
{
constexpr MeshPurpose AllPurposes[] = { MeshPurpose::FiniteVolumes, MeshPurpose::FiniteElements,
  MeshPurpose::FewestPoints };

/** A box as triangles, with normals outwards, and labels if it has a region. */
void AddBox(TriangleMesh& surface, const Vec3& low, const Vec3& high, Id region = NoId)
{
  const Id first = static_cast<Id>(surface.Points.size());
  for (int i = 0; i < 8; ++i)
  {
    surface.Points.push_back({ (i & 1) != 0 ? high.X : low.X, (i & 2) != 0 ? high.Y : low.Y,
      (i & 4) != 0 ? high.Z : low.Z });
  }
  constexpr int faces[6][4] = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
    { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
  for (const auto& face : faces)
  {
    surface.Triangles.push_back({ first + face[0], first + face[1], first + face[2] });
    surface.Triangles.push_back({ first + face[0], first + face[2], first + face[3] });
    if (region != NoId)
    {
      surface.Labels.insert(surface.Labels.end(), 2, { OutsideRegion, region });
    }
  }
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
} // namespace

TEST(MeshPurpose, DecidesWhatIsNotGiven)
{
  MeshSettings volumes = MakeSettings(MeshPurpose::FiniteVolumes, {});
  EXPECT_EQ(volumes.Criterion, SurfaceCriterion::SmallestSphere);
  EXPECT_TRUE(volumes.AddsSteinerPoints);
  EXPECT_TRUE(volumes.RemovesSlivers);
  MeshSettings elements = MakeSettings(MeshPurpose::FiniteElements, {});
  EXPECT_EQ(elements.Criterion, SurfaceCriterion::Delaunay);
  EXPECT_TRUE(elements.AddsSteinerPoints);
  EXPECT_GT(elements.DihedralAngleTarget, volumes.DihedralAngleTarget);
  MeshSettings fewest = MakeSettings(MeshPurpose::FewestPoints, {});
  EXPECT_EQ(fewest.Criterion, SurfaceCriterion::Delaunay);
  EXPECT_FALSE(fewest.AddsSteinerPoints);
  EXPECT_TRUE(fewest.RemovesSlivers);
  EXPECT_EQ(fewest.MaximumEdgeLength, 0.0);
  EXPECT_TRUE(volumes.GeneratesMeshPoints);
  EXPECT_TRUE(elements.GeneratesMeshPoints);
  EXPECT_FALSE(fewest.GeneratesMeshPoints);
  MeshOptionChoices withoutSteinerPoints;
  withoutSteinerPoints.AddsSteinerPoints = false;
  EXPECT_FALSE(MakeSettings(MeshPurpose::FiniteVolumes, withoutSteinerPoints).GeneratesMeshPoints);
  for (const MeshPurpose purpose : AllPurposes)
  {
    const bool isFewest = purpose == MeshPurpose::FewestPoints;
    EXPECT_EQ(NeedsDefaultSize(purpose, {}, false), !isFewest);
    EXPECT_FALSE(NeedsDefaultSize(purpose, {}, true));
    MeshOptionChoices given;
    given.MaximumEdgeLength = 0.0;
    EXPECT_FALSE(NeedsDefaultSize(purpose, given, false));
  }
}

TEST(MeshPurpose, LeavesWhatIsGiven)
{
  MeshOptionChoices given;
  given.Criterion = SurfaceCriterion::SmallestSphereAndEdges;
  given.AddsSteinerPoints = false;
  given.RemovesSlivers = false;
  given.DihedralAngleTarget = 7.0;
  given.RadiusEdgeRatio = 0.0;
  given.MaximumEdgeLength = 0.25;
  given.GeneratesMeshPoints = true;
  for (const MeshPurpose purpose : AllPurposes)
  {
    const MeshSettings settings = MakeSettings(purpose, given);
    EXPECT_EQ(settings.Criterion, SurfaceCriterion::SmallestSphereAndEdges);
    EXPECT_FALSE(settings.AddsSteinerPoints);
    EXPECT_FALSE(settings.RemovesSlivers);
    EXPECT_EQ(settings.DihedralAngleTarget, 7.0);
    EXPECT_EQ(settings.RadiusEdgeRatio, 0.0);
    EXPECT_EQ(settings.MaximumEdgeLength, 0.25);
    EXPECT_TRUE(settings.GeneratesMeshPoints);
    EXPECT_EQ(DescribeSettings(purpose, given, settings),
      std::string("Mesh for ") + GetPurposeName(purpose) +
        ": criterion smallest sphere and edges, no Steiner points, slivers are kept, maximum edge "
        "length 0.25, mesh points");
  }
  EXPECT_EQ(
    DescribeSettings(MeshPurpose::FewestPoints, {}, MakeSettings(MeshPurpose::FewestPoints, {})),
    "Mesh for fewest points: [criterion Delaunay, no Steiner points, no slivers, dihedral angle "
    "target 15, no maximum edge length, no mesh points]");
}

/** What was written before this option was there gave each value, and means the same now. */
TEST(MeshPurpose, OptionsThatAreAllGivenMeanTheSame)
{
  for (const std::uint64_t seed : { 1, 2, 3 })
  {
    const PolygonSoup soup = ComplexMaker(ComplexKind::Boxes, seed).Make();
    if (soup.GetNumberOfPolygons() == 0)
    {
      continue;
    }
    ConformingMesherOptions options;
    options.MeshFor = MeshPurpose::FewestPoints;
    const ConformingMesherOutput expected = Mesh(soup, options);
    options.Choices = { SurfaceCriterion::Delaunay, false, true, 15.0, 1.4, 0.0, false };
    for (const MeshPurpose purpose : AllPurposes)
    {
      options.MeshFor = purpose;
      const ConformingMesherOutput output = Mesh(soup, options);
      EXPECT_EQ(output.Mesh.Points, expected.Mesh.Points);
      EXPECT_EQ(output.Mesh.Tetrahedra, expected.Mesh.Tetrahedra);
    }
  }
}

/** With nothing but polygons: no slivers, no negative coupling, edges of the size that is said. */
TEST(MeshPurpose, FiniteVolumesAreTheDefault)
{
  TriangleMesh surface;
  AddBox(surface, { 0.0, 0.0, 0.0 }, { 3.0, 2.0, 1.0 });
  const ConformingMesherOutput output = Mesh(MakePolygonSoup(surface), {});
  EXPECT_TRUE(output.Certificate.IsClean()) << output.Certificate.GetText();
  EXPECT_EQ(output.Certificate.Under15Degrees.Count, 0);
  const double size = output.Settings.MaximumEdgeLength;
  EXPECT_NEAR(size, GetDefaultSize(surface), 1e-12);
  EXPECT_NE(output.Certificate.GetText().find("\nMesh for finite volumes: [criterion smallest "
                                              "sphere, Steiner points, no slivers, "),
    std::string::npos)
    << output.Certificate.GetText();
  for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
  {
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < i; ++j)
      {
        EXPECT_LE(
          Distance(output.Mesh.Points[ids[i]], output.Mesh.Points[ids[j]]), size * (1.0 + 1e-12));
      }
    }
  }
}

/** A plate of n x n squares of side 1 on either side, with waves. */
PolygonSoup MakePlate(int n, double thickness, double wave)
{
  PolygonSoup plate;
  for (int k = 0; k < 2; ++k)
  {
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; j <= n; ++j)
      {
        plate.Points.push_back({ 1.0 * i, 1.0 * j, thickness * k + wave * ((i + j) % 2) });
      }
    }
  }
  const auto point = [n](int i, int j, int k) { return (k * (n + 1) + i) * (n + 1) + j; };
  plate.Offsets.push_back(0);
  const auto add = [&](Id a, Id b, Id c, Id d)
  {
    for (const Id id : { a, b, c, a, c, d })
    {
      plate.Connectivity.push_back(id);
      if (plate.Connectivity.size() % 3 == 0)
      {
        plate.Offsets.push_back(static_cast<Id>(plate.Connectivity.size()));
      }
    }
  };
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      add(point(i, j, 0), point(i, j + 1, 0), point(i + 1, j + 1, 0), point(i + 1, j, 0));
      add(point(i, j, 1), point(i + 1, j, 1), point(i + 1, j + 1, 1), point(i, j + 1, 1));
    }
    add(point(i, 0, 0), point(i + 1, 0, 0), point(i + 1, 0, 1), point(i, 0, 1));
    add(point(i, n, 0), point(i, n, 1), point(i + 1, n, 1), point(i + 1, n, 0));
    add(point(0, i, 0), point(0, i, 1), point(0, i + 1, 1), point(0, i + 1, 0));
    add(point(n, i, 0), point(n, i + 1, 0), point(n, i + 1, 1), point(n, i, 1));
  }
  return plate;
}

/** A plate of many small triangles stays a plate: the bound is a tenth of its thickness. */
TEST(MeshPurpose, ThePlateThatIsMadeCoarserKeepsItsThickness)
{
  constexpr int n = 20;
  // Waves as high as a third of the thickness.
  const PolygonSoup plate = MakePlate(n, 0.3, 0.1);
  ConformingMesherOptions options;
  options.Choices.MaximumEdgeLength = 5.0;
  const ConformingMesherOutput output = Mesh(plate, options);
  CompensatedSum sixVolumes;
  for (const TetrahedronIds& ids : output.Mesh.Tetrahedra)
  {
    const std::vector<Vec3>& points = output.Mesh.Points;
    sixVolumes.Add(GetSixVolumes(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]]));
  }
  // No point is farther than a tenth of the thickness from where it was, on either side.
  EXPECT_NEAR(sixVolumes.Get() / 6.0 / (n * n * 0.3), 1.0, 0.2);
  EXPECT_TRUE(output.Certificate.IsDelaunay()) << output.Certificate.GetText();
}

/** Where half of the edges are shorter than the remesher leaves them: 0.64 of the longest one. */
TEST(MeshPurpose, SurfacesThatWouldGetCoarserAreMadeCoarser)
{
  // Two thirds of the edges have length 1.
  const PolygonSoup plate = MakePlate(16, 4.0, 0.0);
  for (const auto& [ratio, isRemeshed] : { std::pair(0.6, true), std::pair(0.68, false) })
  {
    ConformingMesherOptions options;
    options.MeshFor = MeshPurpose::FewestPoints;
    options.Choices.MaximumEdgeLength = 1.0 / ratio;
    bool isSaid = false;
    for (const Warning& warning : Mesh(plate, options).Warnings)
    {
      isSaid |= warning.Message.find("was remeshed to the wanted size") != std::string::npos;
    }
    EXPECT_EQ(isSaid, isRemeshed) << ratio;
  }
}

TEST(MeshPurpose, TheDefaultSizeFollowsTheThinnestRegion)
{
  // A cube: a twentieth of the diagonal is less than a third of the side.
  TriangleMesh cube;
  AddBox(cube, { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 });
  EXPECT_NEAR(GetDefaultSize(cube), 0.05 * std::sqrt(3.0), 1e-12);
  // With labels the same, and in proportion.
  TriangleMesh large;
  AddBox(large, { 100.0, 100.0, 100.0 }, { 300.0, 300.0, 300.0 }, 7);
  EXPECT_NEAR(GetDefaultSize(large), 0.05 * 200.0 * std::sqrt(3.0), 1e-9);
  // A plate: its volume is 0.04, its area 2.16; a rod beside it counts, a foil does not.
  TriangleMesh plate;
  AddBox(plate, { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 0.04 });
  const double thickness = 2.0 * 0.04 / 2.16;
  EXPECT_NEAR(GetDefaultSize(plate), thickness, 1e-12);
  EXPECT_NEAR(GetLeastThickness(plate), thickness, 1e-12);
  AddBox(plate, { 0.0, 0.0, 0.1 }, { 1.0, 0.1, 0.2 });
  EXPECT_NEAR(GetDefaultSize(plate), thickness, 1e-12);
  AddBox(plate, { 0.0, 0.0, 0.6 }, { 1.0, 1.0, 0.6001 });
  const double size = GetDefaultSize(plate);
  EXPECT_NEAR(size, thickness, 1e-12);
  EXPECT_NEAR(GetLeastThickness(plate), 2.0 * 0.0001 / 2.0004, 1e-12);
  // Nothing, and a surface that is open.
  EXPECT_EQ(GetDefaultSize({}), 0.0);
  cube.Triangles.pop_back();
  EXPECT_EQ(GetLeastThickness(cube), std::numeric_limits<double>::infinity());
  EXPECT_GT(GetDefaultSize(cube), 0.0);
  EXPECT_LE(GetDefaultSize(cube), 0.05 * std::sqrt(3.0) + 1e-12);
}
