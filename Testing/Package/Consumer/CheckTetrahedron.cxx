// SPDX-License-Identifier: BSD-3-Clause
// Uses the engine alone, without VTK: the checker on a mesh of one tetrahedron.
#include <Core/Certificate/MeshCertificate.h>
#include <Core/Meshes/MeshInvariants.h>

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
  cdm::MeshCertificate report;
  if (!cdm::CertifyMesh(mesh, nullptr, cdm::ExecutionContext(), report).IsOk())
  {
    return EXIT_FAILURE;
  }
  std::cout << report.GetText() << std::endl;
  return report.IsDelaunay() ? EXIT_SUCCESS : EXIT_FAILURE;
}
