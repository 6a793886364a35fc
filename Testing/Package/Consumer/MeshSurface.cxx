// SPDX-License-Identifier: BSD-3-Clause
// Meshes the surface of an STL file, checks the mesh, and writes it. The tutorial in
// Plugin/Documentation/tutorial_cpp.md explains it step by step.
#include <vtkConformingDelaunayMesher.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkGmshMeshWriter.h>

#include <vtkCylinderSource.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  vtkNew<vtkSTLReader> reader;
  vtkNew<vtkCylinderSource> cylinder;
  cylinder->SetResolution(24);
  vtkNew<vtkConformingDelaunayMesher> mesher;
  if (argc > 1)
  {
    reader->SetFileName(argv[1]);
    mesher->SetInputConnection(reader->GetOutputPort());
  }
  else
  {
    mesher->SetInputConnection(cylinder->GetOutputPort());
  }

  // Lengths are in the units of the surface: here a tenth of its longest side.
  mesher->GetInputAlgorithm()->Update();
  double bounds[6];
  vtkPolyData::SafeDownCast(mesher->GetInputDataObject(0, 0))->GetBounds(bounds);
  const double size =
    std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] });
  mesher->SetMaximumEdgeLength(0.1 * size);
  mesher->AddSteinerPointsOn();
  mesher->SetCriterionToSmallestSphereAndEdges();

  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputConnection(mesher->GetOutputPort());
  criteria->Update();
  std::cout << criteria->GetCertificate() << "\n";
  if (!criteria->GetIsClean())
  {
    // The second output has the tetrahedra, triangles and edges at fault.
    return EXIT_FAILURE;
  }

  vtkNew<vtkGmshMeshWriter> writer;
  writer->SetInputConnection(mesher->GetOutputPort());
  writer->SetFileName("mesh.msh");
  return writer->Write() == 1 ? EXIT_SUCCESS : EXIT_FAILURE;
}
