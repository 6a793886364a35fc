// SPDX-License-Identifier: BSD-3-Clause
// All sample devices, as they are and turned, meshed for the box method: the certificate is clean.
#include "FilterTesting.h"
#include "MeshCertificate.h"

#include <vtkBoundaryTriangulator.h>
#include <vtkConformingDelaunayMesher.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkMath.h>
#include <vtkSmartPointer.h>
#include <vtkTechnologyStructureSource.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

using namespace testing_filters;

namespace
{
constexpr int SmallestSphere = vtkConformingDelaunayMesher::SmallestSphere;
constexpr int SmallestSphereAndEdges = vtkConformingDelaunayMesher::SmallestSphereAndEdges;

double GetShortestEdge(vtkPolyData* surface)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    vtkPoints* points = surface->GetCell(cell)->GetPoints();
    for (int i = 0; i < 3; ++i)
    {
      double p[3];
      points->GetPoint(i, p);
      shortest =
        std::min(shortest, vtkMath::Distance2BetweenPoints(p, points->GetPoint((i + 1) % 3)));
    }
  }
  return std::sqrt(shortest);
}

class DeviceMeshes : public testing::TestWithParam<int>
{
public:
  struct Limits
  {
    int Criterion;
    double MaximumEdgeLength;
    double RadiusEdgeRatio;
  };

  /** The mesh of the device turned by an angle, with the arrays of the certificate. */
  vtkUnstructuredGrid* MakeMesh(double angle, const Limits& limits)
  {
    this->Turn(angle);
    this->Mesher->SetInputConnection(this->Source->GetOutputPort());
    this->Mesher->SetCriterion(limits.Criterion);
    this->Mesher->SetMaximumEdgeLength(limits.MaximumEdgeLength);
    this->Mesher->AddSteinerPointsOn();
    this->Mesher->SetRadiusEdgeRatio(limits.RadiusEdgeRatio);
    this->Mesher->SetDihedralAngleTarget(SliverAngle);
    this->Criteria->SetInputConnection(0, this->Mesher->GetOutputPort());
    this->Criteria->SetInputConnection(1, this->Source->GetOutputPort());
    this->Criteria->Update();
    std::cout << this->Source->GetStructureAsString() << " turned by " << angle << ", criterion "
              << limits.Criterion << ": " << this->Criteria->GetCertificate() << "\n";
    return this->Criteria->GetOutput();
  }

  /** The refined surface of the device turned by an angle. */
  vtkSmartPointer<vtkPolyData> MakeSurface(double angle, int criterion)
  {
    this->Turn(angle);
    vtkNew<vtkBoundaryTriangulator> triangulator;
    triangulator->SetInputConnection(this->Source->GetOutputPort());
    vtkNew<vtkDelaunaySurfaceRefiner> refiner;
    refiner->SetInputConnection(triangulator->GetOutputPort());
    refiner->SetCriterion(criterion);
    refiner->Update();
    return refiner->GetOutput();
  }

  vtkDelaunayMeshCriteria* GetCriteria() { return this->Criteria; }

private:
  void Turn(double angle)
  {
    this->Source->SetStructure(GetParam());
    this->Source->SetRotationAngle(angle);
    this->Source->SetRotationAxis(1.0, 2.0, 3.0);
  }

  vtkNew<vtkTechnologyStructureSource> Source;
  vtkNew<vtkConformingDelaunayMesher> Mesher;
  vtkNew<vtkDelaunayMeshCriteria> Criteria;
};

TEST_P(DeviceMeshes, AreClean)
{
  for (const double angle : { 0.0, 33.0, 77.0 })
  {
    ASSERT_GT(this->MakeMesh(angle, { SmallestSphereAndEdges, 0.2, 2.0 })->GetNumberOfCells(), 0);
    ExpectClean(this->GetCriteria(), SmallestSphereAndEdges);
    EXPECT_TRUE(angle != 0.0 || CountSlivers(this->GetCriteria()) == 0);
  }
}

/** The limits as they come, and no size. */
TEST_P(DeviceMeshes, AreCleanWithoutSliversWithEitherCriterion)
{
  for (const int criterion : { SmallestSphere, SmallestSphereAndEdges })
  {
    for (const double angle : { 0.0, 10.0, 33.0, 77.0 })
    {
      ASSERT_GT(this->MakeMesh(angle, { criterion, 0.0, 1.4 })->GetNumberOfCells(), 0);
      ExpectClean(this->GetCriteria(), criterion);
      EXPECT_EQ(CountSlivers(this->GetCriteria()), 0);
    }
  }
}

/**
 * No position is special: as it is drawn, a device has decimal coordinates, whose rounding decides
 * about the many points on common spheres, and does so for all symmetric parts alike.
 */
TEST_P(DeviceMeshes, TurnedSurfacesAreAsFine)
{
  for (const int criterion : { 0, 1, 2 })
  {
    double shortest = 0.0;
    std::vector<vtkIdType> counts;
    for (const double angle : { 0.0, 1e-3, 10.0, 33.0, 45.0, 66.0, 77.0 })
    {
      const auto surface = this->MakeSurface(angle, criterion);
      counts.push_back(surface->GetNumberOfPoints());
      shortest = angle == 0.0 ? GetShortestEdge(surface) : shortest;
      // A point that rounding puts into a sphere splits nothing close to an end.
      EXPECT_GT(GetShortestEdge(surface), 0.99 * shortest) << angle;
    }
    const vtkIdType drawn = counts.front();
    std::sort(counts.begin(), counts.end());
    const vtkIdType median = counts[counts.size() / 2];
    std::cout << "criterion " << criterion << ": " << counts.front() << " to " << counts.back()
              << " points, median " << median << "\n";
    EXPECT_LE(counts.back(), 1.05 * drawn);
    EXPECT_LE(counts.back(), 1.05 * median);
    EXPECT_GE(counts.front(), 0.95 * median);
  }
}

INSTANTIATE_TEST_SUITE_P(All, DeviceMeshes,
  testing::Range<int>(
    vtkTechnologyStructureSource::MOS_TRANSISTOR, vtkTechnologyStructureSource::CMOS_INVERTER + 1));
} // namespace
