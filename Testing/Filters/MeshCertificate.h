// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshCertificate.h
 * @brief What tests ask of meshes of devices, by the arrays of vtkDelaunayMeshCriteria and
 * vtkSteinerPointRefiner.
 */
#ifndef MeshCertificate_h
#define MeshCertificate_h

#include <vtkCellData.h>
#include <vtkConformingDelaunayMesher.h>
#include <vtkDataArray.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkFieldData.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <vector>

namespace testing_filters
{
/** Degrees, of dihedral angles. */
constexpr double SliverAngle = 15.0;

/** Valid, Delaunay, fit for the box method, with the boundary of a criterion of the mesher. */
inline void ExpectClean(vtkDelaunayMeshCriteria* criteria, int criterion)
{
  EXPECT_TRUE(criteria->GetIsClean());
  vtkFieldData* summary = criteria->GetOutput()->GetFieldData();
  std::vector<const char*> faults{ "InvertedTetrahedra", "FlatTetrahedra", "NonDelaunayTetrahedra",
    "FacetSphereViolations", "NegativeCouplings", "OpenControlVolumes" };
  if (criterion == vtkConformingDelaunayMesher::SmallestSphereAndEdges)
  {
    faults.push_back("EdgeSphereViolations");
  }
  for (const char* name : faults)
  {
    ASSERT_NE(summary->GetArray(name), nullptr) << name;
    EXPECT_EQ(summary->GetArray(name)->GetComponent(0, 0), 0.0) << name;
  }
  EXPECT_LT(summary->GetArray("RegionVolumeErrors")->GetRange()[1], 1e-12);
}

/** Whether a tetrahedron lies across a thin layer or a sharp angle of the device. */
inline bool IsInevitable(vtkUnstructuredGrid* mesh, vtkIdType cell)
{
  constexpr double inevitable = 4.0;
  vtkDataArray* faults = mesh->GetCellData()->GetArray("RefinementFault");
  return faults && faults->GetComponent(cell, 0) == inevitable;
}

/** But for the inevitable ones. */
inline vtkIdType CountSlivers(vtkDelaunayMeshCriteria* criteria)
{
  vtkUnstructuredGrid* mesh = criteria->GetOutput();
  vtkDataArray* angles = mesh->GetCellData()->GetArray("SmallestDihedralAngle");
  vtkIdType slivers = 0;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    slivers += !IsInevitable(mesh, cell) && angles->GetComponent(cell, 0) < SliverAngle;
  }
  return slivers;
}

/** Tetrahedra that miss a size, a shape, or an angle that was asked for; not the inevitable ones. */
inline vtkIdType CountMissed(vtkUnstructuredGrid* mesh)
{
  vtkDataArray* faults = mesh->GetCellData()->GetArray("RefinementFault");
  vtkIdType missed = 0;
  for (vtkIdType cell = 0; faults && cell < mesh->GetNumberOfCells(); ++cell)
  {
    missed += faults->GetComponent(cell, 0) != 0.0 && !IsInevitable(mesh, cell);
  }
  return missed;
}
} // namespace testing_filters

#endif
