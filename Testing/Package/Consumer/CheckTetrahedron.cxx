// SPDX-License-Identifier: BSD-3-Clause
// Uses the engine alone, without VTK: the checker on a mesh of one tetrahedron.
#include <Core/Certificate/MeshChecks.h>

#include <cstdlib>
#include <iostream>

int main()
{
  cdm::TetMesh mesh;
  mesh.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  mesh.Tetrahedra = { { 0, 1, 2, 3 } };
  mesh.Regions = { 0 };
  if (!cdm::BuildNeighbors(mesh).IsOk())
  {
    return EXIT_FAILURE;
  }
  cdm::MeshCheckReport report;
  if (!cdm::CheckTetMesh(mesh, nullptr, cdm::ExecutionContext(), report).IsOk())
  {
    return EXIT_FAILURE;
  }
  std::cout << report.GetSummary() << std::endl;
  return report.IsValid() ? EXIT_SUCCESS : EXIT_FAILURE;
}
