// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComplexWithPoints.h
 * @brief A refined mesh for the tests: a turned complex of random cells, with random points inside,
 * which are free.
 */
#ifndef cdmComplexWithPoints_h
#define cdmComplexWithPoints_h

#include "Core/Improvement/RefinedMesh.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace cdm
{
class ComplexWithPoints
{
public:
  /** @param maximumNewPoints that may be made inside */
  explicit ComplexWithPoints(
    std::mt19937_64& generator, int numberOfThreads = 1, Id maximumNewPoints = 0)
  {
    BoundaryTriangulatorOutput boundary;
    EXPECT_TRUE(
      TriangulateBoundary(MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 4, 0.1), {}, {}, boundary)
        .IsOk());
    std::uniform_real_distribution<double> coordinate(-1.0, 2.0);
    std::vector<Vec3> points(2000);
    for (Vec3& point : points)
    {
      point = { coordinate(generator), coordinate(generator), coordinate(generator) };
    }
    DelaunaySurfaceRefinerInput input;
    input.Surface = &boundary.Surface;
    input.MeshPoints = &points;
    DelaunaySurfaceRefinerOptions options;
    options.Criterion = SurfaceCriterion::SmallestSphere;
    EXPECT_TRUE(RefineDelaunaySurface(input, options, {}, this->Refined).IsOk());
    AdvancingFrontTetrahedralizerInput front;
    front.Surface = &this->Refined.Surface;
    std::vector<Vec3> kept;
    for (Id point : this->Refined.KeptMeshPoints)
    {
      kept.push_back(points[point]);
    }
    front.MeshPoints = &kept;
    AdvancingFrontTetrahedralizerOutput made;
    EXPECT_TRUE(TetrahedralizeByAdvancingFront(front, {}, {}, made).IsOk());
    this->Boundary = std::move(made.Boundary);
    this->Boundary.Points = this->Refined.Surface.Points;
    std::vector<InteriorPoint> interior;
    for (Id source : made.MeshPointSources)
    {
      interior.push_back({ kept[source], 0.0, true, source, this->Memory.MakeName() });
    }
    RefinedMeshOptions meshOptions;
    meshOptions.MaximumNewPoints = maximumNewPoints;
    meshOptions.Threads = std::make_shared<ThreadTeam>(numberOfThreads);
    const std::vector<StructuralEdge>& edges = this->Refined.StructuralEdges;
    this->Mesh = std::make_unique<RefinedMesh>(std::move(made.Mesh),
      RefinedBoundary{ this->Boundary, this->Refined.StructuralEdges, edges }, interior,
      this->Memory, meshOptions);
  }

  RefinedMesh& GetMesh() { return *this->Mesh; }
  const RefinedMesh& GetMesh() const { return *this->Mesh; }
  const TriangleMesh& GetBoundary() const { return this->Boundary; }

private:
  DelaunaySurfaceRefinerOutput Refined;
  TriangleMesh Boundary;
  SliverMemory Memory;
  std::unique_ptr<RefinedMesh> Mesh;
};
} // namespace cdm

#endif
