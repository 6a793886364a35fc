// SPDX-License-Identifier: BSD-3-Clause
// Meshes a cube through the installed filters and checks that the tetrahedra fill it.
#include <vtkConformingDelaunayMesher.h>

#include <vtkCell.h>
#include <vtkCubeSource.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkTetra.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

int main()
{
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetInputConnection(cube->GetOutputPort());
  mesher->Update();
  vtkUnstructuredGrid* mesh = vtkUnstructuredGrid::SafeDownCast(mesher->GetOutputDataObject(0));

  double volume = 0.0;
  bool positive = true;
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    vtkPoints* points = mesh->GetCell(i)->GetPoints();
    double p[4][3];
    for (int j = 0; j < 4; ++j)
    {
      points->GetPoint(j, p[j]);
    }
    const double v = vtkTetra::ComputeVolume(p[0], p[1], p[2], p[3]);
    positive = positive && v > 0.0;
    volume += v;
  }
  std::cout << mesh->GetNumberOfCells() << " tetrahedra, volume " << volume << std::endl;
  return positive && std::abs(volume - 1.0) < 1e-12 ? EXIT_SUCCESS : EXIT_FAILURE;
}
