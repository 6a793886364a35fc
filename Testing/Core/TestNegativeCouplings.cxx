// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/SortedIds.h"
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Improvement/NegativeCouplings.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <string>

using namespace cdm;

namespace
{
/** Edges that the certificate finds at fault. */
std::vector<EdgeIds> FindByCertificate(const TetMesh& mesh, const TriangleMesh& boundary)
{
  MeshCertificate report;
  EXPECT_TRUE(CertifyMesh(mesh, &boundary, {}, report, FullCertificate).IsOk());
  std::vector<EdgeIds> edges;
  for (const MeshViolation& violation : report.Violations)
  {
    if (violation.Fault == MeshFault::NegativeCoupling)
    {
      edges.push_back(MakeEdge(violation.Points[0], violation.Points[1]));
    }
  }
  SortUnique(edges);
  return edges;
}

/** From each tetrahedron at each edge of the boundary. */
std::vector<EdgeIds> FindOneByOne(const TetMesh& mesh, const TriangleMesh& boundary)
{
  const DynamicTetrahedralization dynamic(mesh);
  const IdLists pointTriangles = ListTrianglesAtPoints(boundary.Triangles, boundary.Points.size());
  const Id count = static_cast<Id>(boundary.Points.size());
  std::vector<EdgeIds> edges;
  for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
  {
    for (int i = 0; i < 6; ++i)
    {
      const EdgeIds edge = MakeEdge(
        mesh.Tetrahedra[t][TetrahedronEdges[i][0]], mesh.Tetrahedra[t][TetrahedronEdges[i][1]]);
      if (edge[1] < count && IsBoundaryEdge(boundary, pointTriangles, edge) &&
        HasNegativeCoupling(dynamic, static_cast<Id>(t), i))
      {
        edges.push_back(edge);
      }
    }
  }
  SortUnique(edges);
  return edges;
}

std::vector<EdgeIds> FindAll(const TetMesh& mesh, const TriangleMesh& boundary)
{
  ThreadTeam team(2);
  return NegativeCouplings().Update(DynamicTetrahedralization(mesh), boundary,
    ListTrianglesAtPoints(boundary.Triangles, boundary.Points.size()), team);
}

/** Two of its edges, opposite to each other, have points in their smallest spheres, no facet has. */
TetMesh MakeObtuseTetrahedron()
{
  TetMesh mesh;
  mesh.Points = { { 2.0, 1.0, 0.0 }, { 3.0, 1.0, 0.0 }, { 0.0, 5.0, 0.0 }, { 4.0, 5.0, 6.0 } };
  mesh.Tetrahedra = { { 0, 1, 2, 3 } };
  mesh.Neighbors = { { NoId, NoId, NoId, NoId } };
  mesh.Regions = { 0 };
  return mesh;
}

TriangleMesh MakeBoundary(const TetMesh& tetrahedron)
{
  TriangleMesh boundary;
  boundary.Points = tetrahedron.Points;
  boundary.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  boundary.Labels.assign(4, { NoId, 0 });
  boundary.SourceCells = { 0, 1, 2, 3 };
  return boundary;
}
} // namespace

TEST(NegativeCouplings, OfATetrahedron)
{
  const TetMesh mesh = MakeObtuseTetrahedron();
  const TriangleMesh boundary = MakeBoundary(mesh);
  const std::vector<EdgeIds> edges = FindAll(mesh, boundary);
  EXPECT_EQ(edges, (std::vector<EdgeIds>{ { 0, 3 }, { 1, 2 } }));
  EXPECT_EQ(edges, FindByCertificate(mesh, boundary));
}

/** Splits come closer to other points than sizes ask for, where no other split helps. */
TEST(NegativeCouplings, AreSplitWhateverTheSizes)
{
  for (double size : { 0.0, 1000.0 })
  {
    SCOPED_TRACE(size);
    const TetMesh mesh = MakeObtuseTetrahedron();
    TriangleMesh boundary = MakeBoundary(mesh);
    StructuralEdgesOutput structural;
    ASSERT_TRUE(ExtractStructuralEdges(boundary, {}, {}, structural).IsOk());
    SliverMemory memory;
    RefinedMeshOptions options;
    options.SurfaceSizes.assign(4, size);
    RefinedMesh refined(
      mesh, { boundary, structural.Edges, structural.Edges }, {}, memory, options);
    EXPECT_EQ(refined.RequestNegativeCouplings(), 2U);
    EXPECT_EQ(refined.GetRequests().Edges.size(), size > 0.0 ? 1U : 2U);
  }
}

TEST(NegativeCouplings, AreThoseOfTheCertificate)
{
  std::size_t total = 0;
  for (unsigned int seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    BoundaryTriangulatorOutput boundary;
    ASSERT_TRUE(TriangulateBoundary(
      MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 4, 0.1 * seed), {}, {}, boundary)
                  .IsOk());
    DelaunaySurfaceRefinerInput input;
    input.Surface = &boundary.Surface;
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = SurfaceCriterion::SmallestSphere;
    DelaunaySurfaceRefinerOutput refined;
    ASSERT_TRUE(RefineDelaunaySurface(input, options, {}, refined).IsOk());
    AdvancingFrontTetrahedralizerInput front;
    front.Surface = &refined.Surface;
    AdvancingFrontTetrahedralizerOutput made;
    ASSERT_TRUE(TetrahedralizeByAdvancingFront(front, {}, {}, made).IsOk());
    made.Boundary.Points = refined.Surface.Points;
    const std::vector<EdgeIds> edges = FindAll(made.Mesh, made.Boundary);
    EXPECT_EQ(edges, FindByCertificate(made.Mesh, made.Boundary));
    EXPECT_EQ(edges, FindOneByOne(made.Mesh, made.Boundary));
    total += edges.size();
  }
  std::cout << total << " edges\n";
  EXPECT_GT(total, 0u);
}
