// SPDX-License-Identifier: BSD-3-Clause
#include "ComplexWithPoints.h"
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Improvement/SliverList.h"
#include "Core/Improvement/SliverPerturbation.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <string>

using namespace cdm;

namespace
{
constexpr double Target = 15.0;

/** Tetrahedra below the target. */
std::size_t CountFlat(const RefinedMesh& mesh)
{
  return mesh.FindFlatter(Target).size();
}

void ExpectDelaunay(const TetMesh& mesh, const TriangleMesh& boundary)
{
  MeshCertificate check;
  ASSERT_TRUE(CertifyMesh(mesh, &boundary, {}, check).IsOk());
  EXPECT_TRUE(check.IsDelaunay()) << check.GetText();
}
} // namespace

/** At sharp angles what is left stays: changes that mend one and leave two would add up. */
TEST(SliverPerturbation, LeavesFewerAtSharpAngles)
{
  std::size_t before = 0;
  std::size_t after = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    ComplexWithPoints complex(generator, 1, 100000);
    RefinedMesh& mesh = complex.GetMesh();
    const std::size_t sharp = FindSlivers(Target, SliverPlace::SharpAngle, mesh).size();
    const std::size_t elsewhere = CountSlivers(Target, mesh);
    std::size_t flat = CountFlat(mesh);
    // Called after some slivers each.
    const auto count = [&](double, const char*)
    {
      EXPECT_LE(CountFlat(mesh), flat);
      flat = CountFlat(mesh);
    };
    ASSERT_TRUE(
      PerturbSharp(Target, SliverMeans::Points, ExecutionContext(count, {}), mesh).IsOk());
    EXPECT_LE(CountFlat(mesh), flat);
    EXPECT_LE(CountSlivers(Target, mesh), elsewhere);
    before += sharp;
    after += FindSlivers(Target, SliverPlace::SharpAngle, mesh).size();
    ExpectDelaunay(mesh.TakeMesh(), complex.GetBoundary());
  }
  std::cout << "slivers at sharp angles: " << before << ", then " << after << std::endl;
  EXPECT_GT(before, 100U);
  EXPECT_LT(static_cast<double>(after), 0.8 * static_cast<double>(before));
}

TEST(SliverPerturbation, MovesAloneKeepThePoints)
{
  std::mt19937_64 generator(1);
  ComplexWithPoints complex(generator, 1, 100000);
  RefinedMesh& mesh = complex.GetMesh();
  const std::size_t flat = CountFlat(mesh);
  ASSERT_TRUE(PerturbSharp(Target, SliverMeans::Moves, {}, mesh).IsOk());
  EXPECT_LT(CountFlat(mesh), flat);
  EXPECT_GT(mesh.GetReport().MovedPoints, 0);
  EXPECT_EQ(mesh.GetReport().InsertedPoints, 0);
  EXPECT_EQ(mesh.GetReport().RemovedPoints, 0);
}
