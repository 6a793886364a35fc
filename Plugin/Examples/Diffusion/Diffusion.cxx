// SPDX-License-Identifier: BSD-3-Clause
/**
 * Prints the smallest concentration that finite elements and the box method meet on the three
 * stacks of the thesis, section 3.2.3, and writes each with its final concentrations (T6.vtu, ...).
 */
#include "Diffusion.h"

#include <vtkDelaunayMeshCriteria.h>

#include <vtkDoubleArray.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <iostream>
#include <string>

namespace
{
void AddArray(vtkUnstructuredGrid* grid, const char* name, const Eigen::VectorXd& values)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (const double value : values)
  {
    array->InsertNextValue(value);
  }
  grid->GetPointData()->AddArray(array);
}
} // namespace

int main()
{
  using diffusion::Stack;
  const std::pair<Stack, std::string> stacks[] = { { Stack::T6, "T6" }, { Stack::T5, "T5" },
    { Stack::ShiftedT5, "ShiftedT5" } };
  for (const auto& [stack, name] : stacks)
  {
    const auto grid = diffusion::MakeStack(stack, 8);
    vtkNew<vtkDelaunayMeshCriteria> criteria;
    criteria->SetInputData(grid);
    criteria->Update();
    std::cout << name << ": " << criteria->GetCertificate() << "\n";

    const Eigen::VectorXd start = diffusion::MakeGaussian(grid, diffusion::Spacing);
    const double timeStep = 0.1 * diffusion::Spacing * diffusion::Spacing;
    const auto elements =
      diffusion::Diffuse(diffusion::AssembleElements(grid), start, timeStep, 20);
    const auto boxes = diffusion::Diffuse(diffusion::AssembleBoxes(grid), start, timeStep, 20);
    std::cout << "  smallest concentration: at the start " << start.minCoeff()
              << ", finite elements " << elements.Smallest << ", boxes " << boxes.Smallest << "\n";

    AddArray(grid, "FiniteElements", elements.Concentrations);
    AddArray(grid, "Boxes", boxes.Concentrations);
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    writer->SetFileName((name + ".vtu").c_str());
    writer->SetDataModeToBinary();
    writer->Write();
  }
  return 0;
}
