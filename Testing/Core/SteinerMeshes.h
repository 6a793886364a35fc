// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SteinerMeshes.h
 * @brief Meshes that get Steiner points, and what has to hold for them afterwards.
 */
#ifndef cdmSteinerMeshes_h
#define cdmSteinerMeshes_h

#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/SteinerPointRefiner.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace cdm
{
struct Stage3
{
  TriangleMesh Surface;
  AdvancingFrontTetrahedralizerOutput Output;
};

/** Stages 0 to 3, with mesh points. */
inline Stage3 MakeMesh(const PolygonSoup& soup, const std::vector<Vec3>& points = {})
{
  Stage3 stage;
  BoundaryTriangulatorOutput boundary;
  EXPECT_TRUE(TriangulateBoundary(soup, {}, {}, boundary).IsOk());
  DelaunaySurfaceRefinerInput input;
  input.Surface = &boundary.Surface;
  input.MeshPoints = &points;
  DelaunaySurfaceRefinerOutput refined;
  EXPECT_TRUE(RefineDelaunaySurface(input, {}, {}, refined).IsOk());
  stage.Surface = refined.Surface;
  AdvancingFrontTetrahedralizerInput front;
  front.Surface = &stage.Surface;
  front.MeshPoints = &points;
  EXPECT_TRUE(TetrahedralizeByAdvancingFront(front, {}, {}, stage.Output).IsOk());
  return stage;
}

inline PolygonSoup MakeBox(const Vec3& size)
{
  return CellComplex(size).GetSoup();
}

/** Criteria of the mesh, its boundary with labels, and what the faults and the report say. */
inline void ExpectRight(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const SteinerPointRefinerOutput& output)
{
  MeshCertificate check;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, check).IsOk());
  EXPECT_TRUE(check.IsDelaunay()) << check.GetText();
  EXPECT_EQ(check.UnusedPoints, 0);
  // The boundary stays as it was given where the time was over before it fulfilled the criterion.
  const bool isRefined = !output.Report.IsLate || output.Report.WeakTriangles == 0;
  if (isRefined)
  {
    EXPECT_EQ(check.GetCount(MeshFault::FacetSphere), 0);
    EXPECT_EQ(output.Report.UnresolvedTriangles, 0);
  }
  // The same regions as before.
  MeshCertificate before;
  ASSERT_TRUE(CertifyMesh(*input.Mesh, nullptr, {}, before).IsOk());
  ASSERT_EQ(before.Regions.size(), check.Regions.size());
  for (std::size_t i = 0; i < check.Regions.size(); ++i)
  {
    EXPECT_EQ(before.Regions[i].Region, check.Regions[i].Region);
    EXPECT_NEAR(before.Regions[i].Volume, check.Regions[i].Volume, 1e-12);
  }

  MeshCertificate criteria;
  ASSERT_TRUE(CertifyMesh(output.Mesh, &output.Boundary, {}, criteria, FullCertificate).IsOk());
  if (isRefined)
  {
    EXPECT_EQ(
      criteria.GetCount(MeshFault::NegativeCoupling) > 0, output.Report.NegativeCouplings > 0);
  }

  Id counts[5] = { 0, 0, 0, 0, 0 };
  ASSERT_EQ(output.Faults.size(), output.Mesh.Tetrahedra.size());
  const std::vector<Vec3>& p = output.Mesh.Points;
  for (std::size_t t = 0; t < output.Faults.size(); ++t)
  {
    const TetrahedronIds& ids = output.Mesh.Tetrahedra[t];
    const std::array<Vec3, 4> v{ p[ids[0]], p[ids[1]], p[ids[2]], p[ids[3]] };
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    for (const auto& edge : TetrahedronEdges)
    {
      shortest = std::min(shortest, Distance(v[edge[0]], v[edge[1]]));
      longest = std::max(longest, Distance(v[edge[0]], v[edge[1]]));
    }
    const double radius = Distance(v[0], GetCircumcenter(v[0], v[1], v[2], v[3]));
    if (output.Faults[t] == SteinerFault::None)
    {
      EXPECT_GE(GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]), options.DihedralAngleTarget);
      EXPECT_TRUE(options.RadiusEdgeRatio == 0.0 ||
        radius <= (1.0 + 1e-12) * options.RadiusEdgeRatio * shortest);
      EXPECT_TRUE(options.MaximumEdgeLength == 0.0 || longest <= options.MaximumEdgeLength);
      EXPECT_TRUE(options.MaximumVolume == 0.0 ||
        GetSignedVolume(v[0], v[1], v[2], v[3]) <= options.MaximumVolume);
    }
    ++counts[static_cast<int>(output.Faults[t])];
  }
  EXPECT_EQ(counts[1], output.Report.TooLarge);
  EXPECT_EQ(counts[2], output.Report.BadlyShaped);
  EXPECT_EQ(counts[3], output.Report.Slivers);
  EXPECT_EQ(counts[4], output.Report.Inevitable);

  // Points that come from the input are where they were, and first.
  ASSERT_EQ(output.PointSources.size(), p.size());
  Id last = -1;
  for (std::size_t i = 0; i < p.size(); ++i)
  {
    const Id source = output.PointSources[i];
    if (source != NoId)
    {
      EXPECT_GT(source, last);
      EXPECT_EQ(p[i], input.Mesh->Points[source]);
    }
    last = source == NoId ? std::numeric_limits<Id>::max() - 1 : source;
  }
}

inline SteinerPointRefinerOutput Refine(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context = {})
{
  SteinerPointRefinerOutput output;
  const Status status = RefineBySteinerPoints(input, options, context, output);
  EXPECT_TRUE(status.IsOk()) << status.Message;
  ExpectRight(input, options, output);
  return output;
}

/** Refines the mesh of stages 0 to 3. */
inline SteinerPointRefinerOutput Refine(
  const PolygonSoup& soup, const SteinerPointRefinerOptions& options)
{
  const Stage3 mesh = MakeMesh(soup);
  SteinerPointRefinerInput input;
  input.Mesh = &mesh.Output.Mesh;
  return Refine(input, options);
}

/** Tetrahedra below 15 degrees, those that are excused as well. */
inline Id CountSlivers(const TetMesh& mesh)
{
  MeshCertificate check;
  EXPECT_TRUE(CertifyMesh(mesh, nullptr, {}, check).IsOk());
  return check.Under15Degrees.Count;
}

inline void ExpectNoFaults(const SteinerPointRefinerReport& report)
{
  EXPECT_EQ(report.TooLarge, 0);
  EXPECT_EQ(report.BadlyShaped, 0);
  EXPECT_EQ(report.Slivers, 0);
  EXPECT_EQ(report.Inevitable, 0);
  EXPECT_EQ(report.NegativeCouplings, 0);
}
} // namespace cdm

#endif
