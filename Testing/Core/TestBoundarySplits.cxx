// SPDX-License-Identifier: BSD-3-Clause
#include "ComplexKinds.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Improvement/BoundaryShape.h"
#include "Core/Improvement/BoundarySpheres.h"
#include "Core/Improvement/BoundarySplits.h"
#include "Core/Improvement/NegativeCouplings.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>

using namespace cdm;

namespace
{
std::vector<TriangleIds> GetSorted(const std::vector<TriangleIds>& triangles)
{
  std::vector<TriangleIds> sorted;
  for (const TriangleIds& ids : triangles)
  {
    sorted.push_back(Sorted(ids));
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/** A conforming mesh with points inside, and places for points of the surface that are to come. */
class GrowingMesh
{
public:
  GrowingMesh(const PolygonSoup& soup, SurfaceCriterion criterion, Id reserve,
    std::mt19937_64& generator, double edge = 0.4)
    : Generator(generator)
  {
    this->Options.Criterion = criterion;
    this->Options.MeshPointClearanceRatio = 0.0;
    BoundaryTriangulatorOutput boundary;
    EXPECT_TRUE(TriangulateBoundary(soup, {}, {}, boundary).IsOk());
    DelaunaySurfaceRefinerInput input;
    input.Surface = &boundary.Surface;
    DelaunaySurfaceRefinerOptions options = this->Options;
    options.MaximumEdgeLength = edge;
    DelaunaySurfaceRefinerOutput refined;
    EXPECT_TRUE(RefineDelaunaySurface(input, options, {}, refined).IsOk());
    AdvancingFrontTetrahedralizerInput front;
    front.Surface = &refined.Surface;
    AdvancingFrontTetrahedralizerOutput made;
    EXPECT_TRUE(TetrahedralizeByAdvancingFront(front, {}, {}, made).IsOk());
    this->Surface = std::move(made.Boundary);
    this->Surface.Points = refined.Surface.Points;
    this->Edges = refined.StructuralEdges;
    this->FirstInside = static_cast<Id>(made.Mesh.Points.size()) + reserve;
    made.Mesh.Points.resize(this->FirstInside);
    this->Mesh = std::make_unique<DynamicTetrahedralization>(std::move(made.Mesh));
    this->InsertPoints(60);
    this->Splits = std::make_unique<BoundarySplits>(
      *this->Mesh, this->FirstInside, this->Surface, this->Edges, this->Options, SizingField());
    this->Shape = this->MakeShape();
  }

  /** Into random tetrahedra, where they disturb nothing. */
  void InsertPoints(int tries)
  {
    BoundarySpheres spheres(this->Surface, this->Edges);
    BoundarySpheres::Encroached encroached;
    std::uniform_real_distribution<double> uniform(0.1, 1.0);
    PointCavity cavity;
    for (int i = 0; i < tries; ++i)
    {
      const Id t = this->Draw(this->Mesh->GetNumberOfTetrahedra());
      if (this->Mesh->IsDead(t))
      {
        continue;
      }
      Vec3 position;
      double sum = 0.0;
      for (Id id : this->Mesh->GetMesh().Tetrahedra[t])
      {
        const double weight = uniform(this->Generator);
        position = position + weight * this->Mesh->GetPoint(id);
        sum += weight;
      }
      position = (1.0 / sum) * position;
      spheres.Find(position, encroached);
      if (encroached.IsEmpty() &&
        this->Mesh->FindCavity(position, this->Mesh->GetNumberOfPoints(), t, cavity))
      {
        this->Mesh->Insert(position, cavity);
      }
    }
  }

  void RemovePoints(int tries)
  {
    for (int i = 0; i<tries&& this->Mesh->GetNumberOfPoints()> this->FirstInside; ++i)
    {
      const Id p =
        this->FirstInside + this->Draw(this->Mesh->GetNumberOfPoints() - this->FirstInside);
      if (this->Mesh->GetTetrahedronAt(p) != NoId)
      {
        this->Mesh->Remove(p);
      }
    }
  }

  void ReservePoints(Id count)
  {
    this->Mesh->ReservePoints(this->FirstInside, count);
    this->FirstInside += count;
    this->Splits->SetFirstInside(this->FirstInside);
  }

  /** Moves points of the surface by rounding errors; the mesh does not know of it yet. */
  void RoundPoints(int count)
  {
    for (int i = 0; i < count; ++i)
    {
      Vec3& point = this->Surface.Points[this->Draw(static_cast<Id>(this->Surface.Points.size()))];
      for (int axis = 0; axis < 3; ++axis)
      {
        point[axis] += 1e-16 * static_cast<double>(this->Draw(9) - 4);
      }
    }
  }

  /** False if the mesh has to be made anew. */
  bool Split(int numberOfTriangles, int numberOfEdges)
  {
    std::vector<Id> triangles;
    std::vector<EdgeIds> edges;
    for (int i = 0; i < numberOfTriangles; ++i)
    {
      triangles.push_back(this->Draw(static_cast<Id>(this->Surface.Triangles.size())));
    }
    for (int i = 0; i < numberOfEdges; ++i)
    {
      edges.push_back(this->Edges[this->Draw(static_cast<Id>(this->Edges.size()))].Points);
    }
    std::map<Id, Id> sourceTriangles;
    for (std::size_t t = 0; t < this->Surface.SourceCells.size(); ++t)
    {
      sourceTriangles[this->Surface.SourceCells[t]] = static_cast<Id>(t);
    }
    // Any of them may have changed.
    ChangedPoints changed;
    changed.OnSurface.resize(this->Surface.Points.size());
    std::iota(changed.OnSurface.begin(), changed.OnSurface.end(), 0);
    changed.Inside.resize(this->Mesh->GetNumberOfPoints() - this->FirstInside);
    std::iota(changed.Inside.begin(), changed.Inside.end(), this->FirstInside);
    // In turns on one thread and on two.
    this->IsThreaded = !this->IsThreaded;
    EXPECT_TRUE(
      this->Splits->Run(changed, triangles, edges, ExecutionContext(this->IsThreaded ? 2 : 1))
        .IsOk());
    BoundaryChange change{ this->Splits->GetChangedTriangles(), {}, this->Splits->GetChangedEdges(),
      this->Splits->GetSegments() };
    for (Id t : change.Triangles)
    {
      change.Parents.push_back(sourceTriangles.at(this->Surface.SourceCells[t]));
    }
    if (this->Splits->IsUsable())
    {
      this->Shape->Follow(change);
      this->Couplings.NoteTriangles(this->Surface, change.Triangles);
    }
    // What has failed is still to be done.
    EXPECT_EQ(triangles.empty() && edges.empty(), this->Splits->IsUsable());
    return this->Splits->IsUsable();
  }

  /** What is known of the boundary is what is found anew. */
  void ExpectShapeAsMadeAnew()
  {
    const std::unique_ptr<BoundaryShape> expected = this->MakeShape();
    const TetMesh& mesh = this->Mesh->GetMesh();
    NegativeCouplings couplings;
    ThreadTeam alone(1);
    EXPECT_EQ(
      this->Couplings.Update(*this->Mesh, this->Surface, this->Shape->PointTriangles, this->Team),
      couplings.Update(*this->Mesh, this->Surface, expected->PointTriangles, alone));
    for (Id p = 0; p < static_cast<Id>(this->Surface.Points.size()); ++p)
    {
      const IdLists::Range known = this->Shape->PointTriangles[p];
      const IdLists::Range all = expected->PointTriangles[p];
      EXPECT_TRUE(std::equal(known.begin(), known.end(), all.begin(), all.end())) << p;
    }
    BoundarySpheres::Encroached found;
    BoundarySpheres::Encroached wanted;
    for (Id t = 0; t < this->Mesh->GetNumberOfTetrahedra(); ++t)
    {
      if (this->Mesh->IsDead(t))
      {
        continue;
      }
      const TetrahedronIds& ids = mesh.Tetrahedra[t];
      EXPECT_EQ(this->Shape->Sharp.IsAcross(ids), expected->Sharp.IsAcross(ids));
      EXPECT_EQ(this->Shape->Layers.IsAcross(ids, mesh.Regions[t]),
        expected->Layers.IsAcross(ids, mesh.Regions[t]));
      const std::array<Vec3, 4> v = this->Mesh->GetCorners(t);
      const Vec3 position = 0.4 * v[0] + 0.3 * v[1] + 0.2 * v[2] + 0.1 * v[3];
      this->Shape->Spheres.Find(position, found);
      expected->Spheres.Find(position, wanted);
      EXPECT_EQ(found.Triangles, wanted.Triangles);
      EXPECT_EQ(found.Edges, wanted.Edges);
    }
  }

  bool HaveRunAway() const { return this->Splits->HasRunAway(); }
  std::size_t GetNumberOfSurfacePoints() const { return this->Surface.Points.size(); }

  Id GetNumberOfTetrahedra() const { return this->Mesh->GetNumberOfTetrahedra(); }
  /** Tetrahedra that the last splits have made. */
  std::int64_t CountMade() const
  {
    return static_cast<std::int64_t>(this->Splits->GetChanged().size());
  }
  /** Tetrahedra that the search for negative couplings looks at now. */
  std::int64_t CountCouplingVisits()
  {
    const std::int64_t before = this->Couplings.GetNumberOfVisits();
    this->Couplings.Update(*this->Mesh, this->Surface, this->Shape->PointTriangles, this->Team);
    return this->Couplings.GetNumberOfVisits() - before;
  }

  /** Surface and mesh are what is made anew of their points. */
  void ExpectAsMadeAnew() const
  {
    std::vector<Vec3> inside;
    std::vector<Id> numbers;
    for (Id p = this->FirstInside; p < this->Mesh->GetNumberOfPoints(); ++p)
    {
      if (this->Mesh->GetTetrahedronAt(p) != NoId)
      {
        inside.push_back(this->Mesh->GetPoint(p));
        numbers.push_back(p);
      }
    }
    AdvancingFrontTetrahedralizerInput front;
    front.Surface = &this->Surface;
    front.MeshPoints = &inside;
    AdvancingFrontTetrahedralizerOutput made;
    const Status status = TetrahedralizeByAdvancingFront(front, {}, {}, made);
    ASSERT_TRUE(status.IsOk()) << status.Message;
    EXPECT_EQ(GetSorted(made.Boundary.Triangles), GetSorted(this->Surface.Triangles));
    const Id first = static_cast<Id>(this->Surface.Points.size());
    std::map<TetrahedronIds, Id> expected;
    for (std::size_t t = 0; t < made.Mesh.Tetrahedra.size(); ++t)
    {
      TetrahedronIds ids = made.Mesh.Tetrahedra[t];
      for (Id& id : ids)
      {
        id = id < first ? id : numbers[made.MeshPointSources[id - first]];
      }
      expected[Sorted(ids)] = made.Mesh.Regions[t];
    }
    const TetMesh& mesh = this->Mesh->GetMesh();
    std::map<TetrahedronIds, Id> found;
    for (Id t = 0; t < this->Mesh->GetNumberOfTetrahedra(); ++t)
    {
      if (this->Mesh->IsDead(t))
      {
        continue;
      }
      found[Sorted(mesh.Tetrahedra[t])] = mesh.Regions[t];
      for (int i = 0; i < 4; ++i)
      {
        const Id neighbor = mesh.Neighbors[t][i];
        if (neighbor != NoId)
        {
          ASSERT_EQ(mesh.Neighbors[neighbor / 4][neighbor % 4], 4 * t + i);
          ASSERT_EQ(Sorted(GetFacet(mesh.Tetrahedra[t], i)),
            Sorted(GetFacet(mesh.Tetrahedra[neighbor / 4], neighbor % 4)));
        }
      }
    }
    EXPECT_EQ(found, expected);
  }

private:
  std::unique_ptr<BoundaryShape> MakeShape() const
  {
    return std::make_unique<BoundaryShape>(
      this->Surface, this->Edges, this->Edges, SharpPlaneAngleOfEmptySpheres, 0.0);
  }

  Id Draw(Id count) { return std::uniform_int_distribution<Id>(0, count - 1)(this->Generator); }

  std::mt19937_64& Generator;
  DelaunaySurfaceRefinerOptions Options;
  TriangleMesh Surface;
  std::vector<StructuralEdge> Edges;
  Id FirstInside = 0;
  std::unique_ptr<DynamicTetrahedralization> Mesh;
  std::unique_ptr<BoundarySplits> Splits;
  std::unique_ptr<BoundaryShape> Shape;
  NegativeCouplings Couplings;
  bool IsThreaded = false;
  ThreadTeam Team{ 2 };
};

/** Three boxes side by side and on top of each other: many points on one sphere. */
PolygonSoup MakeStraightBoxes()
{
  CellComplex complex({ 1.0, 1.0, 1.0 });
  EXPECT_TRUE(complex.Cut({ 0.0, 0.0, 1.0 }, 0.5, 1e-6));
  EXPECT_TRUE(complex.Cut({ 1.0, 0.0, 0.0 }, 0.25, 1e-6));
  return complex.GetSoup();
}
} // namespace

TEST(BoundarySplits, TheMeshIsAsMadeAnew)
{
  for (unsigned int seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const SurfaceCriterion criterion =
      seed % 3 == 0 ? SurfaceCriterion::SmallestSphereAndEdges : SurfaceCriterion::SmallestSphere;
    GrowingMesh mesh(seed % 2 == 0 ? MakeStraightBoxes()
                                   : MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 2, 0.5 * seed),
      criterion, 0, generator);
    const std::size_t before = mesh.GetNumberOfSurfacePoints();
    for (int run = 0; run < 8; ++run)
    {
      mesh.ReservePoints(2500);
      ASSERT_TRUE(mesh.Split(run, 8 - run));
      mesh.ExpectAsMadeAnew();
      mesh.ExpectShapeAsMadeAnew();
      mesh.InsertPoints(10);
      mesh.RemovePoints(5);
    }
    EXPECT_GT(mesh.GetNumberOfSurfacePoints(), before + 30);
  }
}

TEST(BoundarySplits, TheMeshFollowsPointsOfTheSurface)
{
  for (unsigned int seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    GrowingMesh mesh(seed % 2 == 0 ? MakeStraightBoxes()
                                   : MakeTurnedComplex(generator, { 1.0, 1.0, 1.0 }, 2, 0.5 * seed),
      SurfaceCriterion::SmallestSphere, 20000, generator);
    for (int run = 0; run < 8; ++run)
    {
      mesh.RoundPoints(1 + 2 * run);
      ASSERT_TRUE(mesh.Split(run % 3, run % 2));
      mesh.ExpectAsMadeAnew();
      mesh.InsertPoints(5);
    }
  }
}

TEST(BoundarySplits, WhereThereIsNoPlaceTheMeshStays)
{
  std::mt19937_64 generator(1);
  GrowingMesh mesh(MakeStraightBoxes(), SurfaceCriterion::SmallestSphere, 20, generator);
  const std::size_t before = mesh.GetNumberOfSurfacePoints();
  EXPECT_FALSE(mesh.Split(20, 20));
  mesh.ExpectAsMadeAnew();
  EXPECT_LE(mesh.GetNumberOfSurfacePoints(), before + 20);
  EXPECT_FALSE(mesh.Split(1, 1));
  mesh.ExpectAsMadeAnew();
}

TEST(BoundarySplits, TheFirstOneThatFailsIsStillToBeDone)
{
  for (const auto& [triangles, edges] : { std::pair(1, 0), std::pair(0, 1) })
  {
    std::mt19937_64 generator(1);
    GrowingMesh mesh(MakeStraightBoxes(), SurfaceCriterion::SmallestSphere, 0, generator);
    EXPECT_FALSE(mesh.Split(triangles, edges));
    mesh.ExpectAsMadeAnew();
  }
}

/**
 * Splits of stacks may lead to ever more splits. They end when they have taken far more points than they
 * are; without that limit they go on until there are no places for points any more.
 */
TEST(BoundarySplits, RunawaysEndAndTheMeshStays)
{
  for (const std::uint64_t seed : { 20, 24, 25 })
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    GrowingMesh mesh(ComplexMaker(ComplexKind::SmallSlabs, seed).Make(),
      SurfaceCriterion::SmallestSphere, 100000, generator, 0.0);
    const std::size_t before = mesh.GetNumberOfSurfacePoints();
    EXPECT_FALSE(mesh.Split(5, 5));
    EXPECT_TRUE(mesh.HaveRunAway());
    EXPECT_LE(mesh.GetNumberOfSurfacePoints(), before + 1200);
    mesh.ExpectAsMadeAnew();
  }
}

/** The work is in proportion to the tetrahedra that a split makes, whatever the size of the mesh. */
TEST(BoundarySplits, CouplingsAreLookedAtWhereTheMeshHasChanged)
{
  for (const double edge : { 0.25, 0.12, 0.06 })
  {
    std::mt19937_64 generator(1);
    GrowingMesh mesh(MakeStraightBoxes(), SurfaceCriterion::SmallestSphere, 500, generator, edge);
    EXPECT_GE(mesh.CountCouplingVisits(), 2 * mesh.GetNumberOfTetrahedra());
    EXPECT_EQ(mesh.CountCouplingVisits(), 0);
    // The first split tests all triangles.
    ASSERT_TRUE(mesh.Split(1, 1));
    mesh.CountCouplingVisits();
    std::int64_t visits = 0;
    std::int64_t made = 0;
    for (int i = 0; i < 50; ++i)
    {
      ASSERT_TRUE(mesh.Split(1, 1));
      made += mesh.CountMade();
      visits += mesh.CountCouplingVisits();
    }
    std::cout << made << " tetrahedra made and " << visits << " looked at by 50 splits, of "
              << mesh.GetNumberOfTetrahedra() << '\n';
    EXPECT_LT(visits, 12 * made);
  }
}
