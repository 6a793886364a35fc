// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/MovingBoundary/MovingBoundaryRemesher.h"
#include "EnclosedVolumes.h"
#include "HullMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>

using namespace cdm;

namespace
{
using Motion = std::function<Vec3(const Vec3&)>;

/**
 * The points of a grid of unit cubes, the corner at the origin, and its tetrahedra with the region
 * that a cube is given; OutsideRegion leaves it out.
 */
TetMesh MakeGrid(int nx, int ny, int nz, const std::function<Id(const Vec3&)>& getRegion)
{
  std::vector<Vec3> points;
  for (int z = 0; z <= nz; ++z)
  {
    for (int y = 0; y <= ny; ++y)
    {
      for (int x = 0; x <= nx; ++x)
      {
        points.push_back({ double(x), double(y), double(z) });
      }
    }
  }
  return testing_core::MakeRegionMesh(points, getRegion);
}

std::vector<Vec3> MakeDisplacements(const TetMesh& mesh, const Motion& motion)
{
  std::vector<Vec3> displacements;
  for (const Vec3& point : mesh.Points)
  {
    displacements.push_back(motion(point));
  }
  return displacements;
}

/** The boundary as it should be after a motion in which only points with a displacement move. */
TriangleMesh MoveBoundary(const TetMesh& mesh, const std::vector<Vec3>& displacements)
{
  TriangleMesh boundary = ExtractBoundary(mesh);
  for (std::size_t i = 0; i < boundary.Points.size(); ++i)
  {
    boundary.Points[i] = boundary.Points[i] + displacements[i];
  }
  return boundary;
}

MovingBoundaryOutput Move(
  const TetMesh& mesh, const std::vector<Vec3>& displacements, const MovingBoundaryOptions& options)
{
  MovingBoundaryOutput output;
  const Status status = RemeshMovingBoundary({ &mesh, &displacements }, options, {}, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  return output;
}

/** All that has to hold, whatever moves; the volumes of the regions. */
std::map<Id, double> CheckAll(const TetMesh& before, const MovingBoundaryOutput& output)
{
  const TriangleMesh boundary = ExtractBoundary(output.Mesh);
  MeshCertificate report;
  EXPECT_TRUE(CertifyMesh(output.Mesh, &boundary, {}, report).IsOk());
  EXPECT_TRUE(report.IsDelaunay()) << report.GetText();
  EXPECT_EQ(report.UnusedPoints, 0);
  EXPECT_EQ(output.Report.UnresolvedTriangles, 0);

  const Id numberOfInputPoints = static_cast<Id>(before.Points.size());
  EXPECT_EQ(output.Origins.size(), output.Mesh.Points.size());
  std::vector<char> isSeen(before.Points.size() + output.NewPoints.size(), 0);
  for (const Id origin : output.Origins)
  {
    EXPECT_FALSE(isSeen[origin]) << "two points from one";
    isSeen[origin] = 1;
  }
  for (std::size_t i = 0; i < output.NewPoints.size(); ++i)
  {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_LT(output.NewPoints[i].Ids[k], numberOfInputPoints + static_cast<Id>(i));
      sum += output.NewPoints[i].Weights[k];
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
  EXPECT_EQ(output.TetrahedronSources.size(), output.Mesh.Tetrahedra.size());
  for (std::size_t i = 0; i < output.TetrahedronSources.size(); ++i)
  {
    const Id source = output.TetrahedronSources[i];
    if (source != NoId)
    {
      EXPECT_EQ(before.Regions[source], output.Mesh.Regions[i]);
    }
  }
  std::map<Id, double> volumes;
  for (const RegionVolume& region : report.Regions)
  {
    volumes[region.Region] = region.Volume;
  }
  return volumes;
}

void ExpectVolumes(const std::map<Id, double>& volumes, const std::map<Id, double>& expected)
{
  EXPECT_EQ(volumes.size(), expected.size());
  for (const auto& [region, volume] : expected)
  {
    ASSERT_EQ(volumes.count(region), 1u) << "region " << region;
    EXPECT_NEAR(volumes.at(region), volume, 1e-12 * volume) << "region " << region;
  }
}

/** The new positions of points of the input. */
std::map<Id, Vec3> GetPlaces(const TetMesh& before, const MovingBoundaryOutput& output)
{
  std::map<Id, Vec3> places;
  for (std::size_t i = 0; i < output.Origins.size(); ++i)
  {
    if (output.Origins[i] < static_cast<Id>(before.Points.size()))
    {
      places[output.Origins[i]] = output.Mesh.Points[i];
    }
  }
  return places;
}

/** A box of 6 x 6 x 12 with oxide (region 1) above 8. */
TetMesh MakeOxide()
{
  return MakeGrid(6, 6, 12, [](const Vec3& center) { return center.Z > 8.0 ? 1 : 0; });
}

/** The interface moves down by 0.44, the surface up by 0.56 of the oxide that has grown. */
Vec3 Grow(const Vec3& point, double thickness)
{
  return { 0.0, 0.0,
    point.Z == 8.0      ? -0.44 * thickness
      : point.Z == 12.0 ? 0.56 * thickness
                        : 0.0 };
}
} // namespace

TEST(MovingBoundaryRemesher, NothingMoves)
{
  const TetMesh mesh = MakeOxide();
  const MovingBoundaryOutput output = Move(mesh, std::vector<Vec3>(mesh.Points.size()), {});
  ExpectVolumes(CheckAll(mesh, output), { { 0, 288.0 }, { 1, 144.0 } });
  EXPECT_EQ(output.Report.RemovedPoints, 0);
  EXPECT_EQ(output.Report.NewPoints, 0);
  EXPECT_EQ(output.Report.TopologyChanges, 0);
  for (const auto& [origin, place] : GetPlaces(mesh, output))
  {
    EXPECT_EQ(place, mesh.Points[origin]);
  }
}

TEST(MovingBoundaryRemesher, OxideGrows)
{
  const TetMesh mesh = MakeOxide();
  for (const int steps : { 1, 3 })
  {
    for (const double thickness : { 0.5, 2.5, 9.0 })
    {
      SCOPED_TRACE(std::to_string(steps) + " steps, thickness " + std::to_string(thickness));
      const std::vector<Vec3> displacements =
        MakeDisplacements(mesh, [=](const Vec3& point) { return Grow(point, thickness); });
      MovingBoundaryOptions options;
      options.NumberOfSteps = steps;
      options.FollowRatio = 2.0;
      const MovingBoundaryOutput output = Move(mesh, displacements, options);
      ExpectVolumes(CheckAll(mesh, output),
        { { 0, 36.0 * (8.0 - 0.44 * thickness) }, { 1, 36.0 * (4.0 + thickness) } });
      EXPECT_EQ(output.Report.Steps, steps);
      EXPECT_EQ(output.Report.TopologyChanges, 0);
      const auto places = GetPlaces(mesh, output);
      for (std::size_t i = 0; i < displacements.size(); ++i)
      {
        const auto place = places.find(static_cast<Id>(i));
        if (displacements[i] != Vec3{})
        {
          ASSERT_NE(place, places.end()) << "points of the input on the boundary stay";
          EXPECT_EQ(place->second, mesh.Points[i] + displacements[i]);
        }
        else if (mesh.Points[i].Z < 8.0 - (0.44 + 2.0 * 0.56) * thickness && place != places.end())
        {
          EXPECT_EQ(place->second, mesh.Points[i]) << "too far to follow";
        }
      }
    }
  }
}

TEST(MovingBoundaryRemesher, PointsFollowOrAreRunOver)
{
  const TetMesh mesh = MakeOxide();
  const std::vector<Vec3> displacements =
    MakeDisplacements(mesh, [](const Vec3& point) { return Grow(point, 4.0); });
  MovingBoundaryOptions options;
  options.FollowRatio = 4.0;
  const MovingBoundaryOutput follow = Move(mesh, displacements, options);
  CheckAll(mesh, follow);
  EXPECT_EQ(follow.Report.RemovedPoints, 0);
  EXPECT_EQ(follow.Report.NewPoints, 0);

  // Walls cannot stay when the interface passes along them: only points inside are left alone.
  const MovingBoundaryOutput stay = [&]
  {
    options.FollowRatio = 0.0;
    return Move(mesh, displacements, options);
  }();
  ExpectVolumes(CheckAll(mesh, stay), { { 0, 36.0 * (8.0 - 1.76) }, { 1, 36.0 * 8.0 } });
  EXPECT_GT(stay.Report.RemovedPoints, 0);
  for (const auto& [origin, place] : GetPlaces(mesh, stay))
  {
    EXPECT_EQ(place, mesh.Points[origin] + displacements[origin]);
  }
}

TEST(MovingBoundaryRemesher, BirdsBeak)
{
  // Growth that ends under a mask: the moved interface is curved, and volumes are those that its
  // triangles enclose.
  const TetMesh mesh = MakeOxide();
  const std::vector<Vec3> displacements = MakeDisplacements(mesh,
    [](const Vec3& point)
    { return Grow(point, 2.0 * std::max(0.0, std::min(1.0, point.X - 2.0))); });
  for (const int steps : { 1, 4 })
  {
    MovingBoundaryOptions options;
    options.NumberOfSteps = steps;
    const MovingBoundaryOutput output = Move(mesh, displacements, options);
    const std::map<Id, double> volumes = CheckAll(mesh, output);
    // Grown fully from x = 3 to 6, not before 2, linearly between.
    ExpectVolumes(volumes, { { 0, 288.0 - 0.88 * 3.5 * 6.0 }, { 1, 144.0 + 2.0 * 3.5 * 6.0 } });
    EXPECT_EQ(output.Report.TopologyChanges, 0);
  }
}

TEST(MovingBoundaryRemesher, CriteriaAreKept)
{
  const TetMesh mesh = MakeOxide();
  const std::vector<Vec3> displacements = MakeDisplacements(mesh,
    [](const Vec3& point) { return Grow(point, 1.5 + 0.5 * std::sin(point.X) * point.Y / 6.0); });
  for (const SurfaceCriterion criterion :
    { SurfaceCriterion::SmallestSphere, SurfaceCriterion::SmallestSphereAndEdges })
  {
    MovingBoundaryOptions options;
    options.Refinement.Criterion = criterion;
    const MovingBoundaryOutput output = Move(mesh, displacements, options);
    CheckAll(mesh, output);
    const TriangleMesh boundary = ExtractBoundary(output.Mesh);
    MeshCertificate report;
    ASSERT_TRUE(CertifyMesh(output.Mesh, &boundary, {}, report).IsOk());
    EXPECT_EQ(report.GetCount(MeshFault::FacetSphere), 0);
  }
}

TEST(MovingBoundaryRemesher, FrontsMeetAndMerge)
{
  // A trench of width 4 between two walls, which grow by 3: they meet in its middle.
  const TetMesh mesh = MakeGrid(10, 3, 6,
    [](const Vec3& center)
    {
      const bool isTrench = center.X > 3.0 && center.X < 7.0 && center.Z > 2.0;
      return isTrench ? OutsideRegion : center.X < 5.0 ? 4 : 9;
    });
  const std::vector<Vec3> displacements = MakeDisplacements(mesh,
    [](const Vec3& point)
    {
      const double x = point.X == 3.0 ? 3.0 : point.X == 7.0 ? -3.0 : 0.0;
      return Vec3{ point.Z > 2.0 ? x : 0.0, 0.0, 0.0 };
    });
  for (const int steps : { 1, 2 })
  {
    SCOPED_TRACE(steps);
    MovingBoundaryOptions options;
    options.NumberOfSteps = steps;
    const MovingBoundaryOutput output = Move(mesh, displacements, options);
    const std::map<Id, double> volumes = CheckAll(mesh, output);
    EXPECT_EQ(output.Report.TopologyChanges, 1);
    ASSERT_EQ(volumes.size(), 2u);
    // The walls lean over from the trench's floor; the tip between is filled from one side or the
    // other, and what both claim belongs to the lower id.
    const double lean = 3.0 * 3.0 * 1.0 / 2.0; // half of the first row of cubes, 3 x 3 x 1
    const double grown = 3.0 * 3.0 * 3.0 + lean;
    EXPECT_NEAR(volumes.at(4), 3.0 * (3.0 * 6.0 + 2.0 * 2.0) + grown, 1e-9);
    // Both walls reach the middle at two thirds of the height of the first row.
    const double claimed = 3.0 * (2.0 * 3.0 + 2.0 * (1.0 / 3.0) / 2.0);
    EXPECT_NEAR(volumes.at(9), 3.0 * (3.0 * 6.0 + 2.0 * 2.0) + grown - claimed, 1e-9);
  }
}

TEST(MovingBoundaryRemesher, LayersVanish)
{
  // The layer from 4 to 5 is 1 thick; its lower interface rises by 1.5.
  const TetMesh mesh = MakeGrid(
    4, 4, 8, [](const Vec3& center) { return center.Z < 4.0 ? 0
                                        : center.Z < 5.0    ? 1
                                                            : 2; });
  const std::vector<Vec3> displacements = MakeDisplacements(mesh,
    [](const Vec3& point) {
      return Vec3{ 0.0, 0.0, point.Z == 4.0 ? 1.5 : 0.0 };
    });
  for (const int steps : { 1, 3 })
  {
    SCOPED_TRACE(steps);
    MovingBoundaryOptions options;
    options.NumberOfSteps = steps;
    const MovingBoundaryOutput output = Move(mesh, displacements, options);
    ExpectVolumes(CheckAll(mesh, output), { { 0, 16.0 * 5.5 }, { 2, 16.0 * 2.5 } });
    EXPECT_GE(output.Report.TopologyChanges, 1);
  }
}

TEST(MovingBoundaryRemesher, BodiesAreTurnedInsideOut)
{
  // A cavity that leaves its body, and a body that is mirrored at a point.
  const TetMesh mesh = MakeGrid(4, 4, 4,
    [](const Vec3& center)
    {
      const bool isCavity = std::abs(center.X - 2.0) < 1.0 && std::abs(center.Y - 2.0) < 1.0 &&
        std::abs(center.Z - 2.0) < 1.0;
      return isCavity ? OutsideRegion : 0;
    });
  const MovingBoundaryOutput left = Move(mesh,
    MakeDisplacements(mesh,
      [](const Vec3& point)
      {
        const bool isCavity = std::abs(point.X - 2.0) < 1.5 && std::abs(point.Y - 2.0) < 1.5 &&
          std::abs(point.Z - 2.0) < 1.5;
        return Vec3{ isCavity ? 10.0 : 0.0, 0.0, 0.0 };
      }),
    {});
  ExpectVolumes(CheckAll(mesh, left), { { 0, 64.0 } });
  EXPECT_EQ(left.Report.TopologyChanges, 1);

  const std::vector<Vec3> mirrored = MakeDisplacements(mesh,
    [](const Vec3& point) {
      return -2.0 * (point - Vec3{ 2, 2, 2 });
    });
  MovingBoundaryOutput output;
  const Status status = RemeshMovingBoundary({ &mesh, &mirrored }, {}, {}, output);
  EXPECT_EQ(status.Code, StatusCode::InvalidInput) << "halfway all points are in one";
  EXPECT_TRUE(output.Mesh.Points.empty());
}

TEST(MovingBoundaryRemesher, PointsInAFacetMayPassEachOther)
{
  // The middle of the top turns by a quarter within its plane: the triangles around fold over each
  // other, unless they are flipped on the way.
  const TetMesh mesh = MakeGrid(6, 6, 3, [](const Vec3&) { return 0; });
  const std::vector<Vec3> displacements = MakeDisplacements(mesh,
    [](const Vec3& point)
    {
      const Vec3 offset = point - Vec3{ 3, 3, 3 };
      return point.Z == 3.0 && std::abs(offset.X) < 1.5 && std::abs(offset.Y) < 1.5
        ? Vec3{ -offset.X - offset.Y, offset.X - offset.Y, 0.0 }
        : Vec3{};
    });
  MovingBoundaryOptions options;
  options.FollowRatio = 0.0;
  const MovingBoundaryOutput output = Move(mesh, displacements, options);
  ExpectVolumes(CheckAll(mesh, output), { { 0, 108.0 } });
  EXPECT_GT(output.Report.Steps, 1);
  EXPECT_EQ(output.Report.TopologyChanges, 0);
}

TEST(MovingBoundaryRemesher, RandomMotionsGiveValidMeshes)
{
  for (const unsigned seed : { 1u, 2u, 3u, 4u, 5u, 6u })
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto draw = [&random] { return random() / 4294967296.0 - 0.5; };
    const TetMesh mesh =
      MakeGrid(4, 4, 4, [](const Vec3& center) { return center.X + 0.5 * center.Z < 3.0 ? 0 : 1; });
    const double size = seed % 2 == 0 ? 0.4 : 0.9;
    const std::vector<Vec3> displacements = MakeDisplacements(mesh,
      [&](const Vec3&)
      {
        const double x = draw();
        const double y = draw();
        return Vec3{ size * x, size * y, size * draw() };
      });
    const MovingBoundaryOutput output = Move(mesh, displacements, {});
    const std::map<Id, double> volumes = CheckAll(mesh, output);
    if (output.Report.TopologyChanges == 0)
    {
      const TriangleMesh boundary = MoveBoundary(mesh, displacements);
      std::map<Id, double> expected = testing_core::GetEnclosedSixVolumes(boundary);
      for (auto& [region, volume] : expected)
      {
        volume /= 6.0;
      }
      ExpectVolumes(volumes, expected);
    }
  }
}

TEST(MovingBoundaryRemesher, RefusesBadInput)
{
  TetMesh mesh = MakeGrid(1, 1, 1, [](const Vec3&) { return 0; });
  std::vector<Vec3> displacements(8);
  displacements[5].Y = std::numeric_limits<double>::quiet_NaN();
  MovingBoundaryOutput output;
  Status status = RemeshMovingBoundary({ &mesh, &displacements }, {}, {}, output);
  EXPECT_EQ(status.Code, StatusCode::InvalidInput);
  EXPECT_EQ(status.Points, std::vector<Id>{ 5 });

  displacements[5].Y = 0.0;
  std::swap(mesh.Points[0], mesh.Points[7]);
  status = RemeshMovingBoundary({ &mesh, &displacements }, {}, {}, output);
  EXPECT_EQ(status.Code, StatusCode::InvalidInput);
  EXPECT_FALSE(status.Cells.empty());
}

TEST(MovingBoundaryRemesher, StopsOnRequestAndIsDeterministic)
{
  const TetMesh mesh = MakeOxide();
  const std::vector<Vec3> displacements =
    MakeDisplacements(mesh, [](const Vec3& point) { return Grow(point, 2.0); });
  MovingBoundaryOutput output;
  int calls = 0;
  const ExecutionContext aborting(nullptr, [&calls] { return ++calls > 3; });
  EXPECT_TRUE(RemeshMovingBoundary({ &mesh, &displacements }, {}, aborting, output).IsAborted());
  EXPECT_TRUE(output.Mesh.Tetrahedra.empty());

  const MovingBoundaryOutput first = Move(mesh, displacements, {});
  const MovingBoundaryOutput second = Move(mesh, displacements, {});
  EXPECT_EQ(first.Mesh.Points, second.Mesh.Points);
  EXPECT_TRUE(std::equal(first.Mesh.Tetrahedra.begin(), first.Mesh.Tetrahedra.end(),
    second.Mesh.Tetrahedra.begin(), second.Mesh.Tetrahedra.end()));
}
