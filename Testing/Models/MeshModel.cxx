// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshModel.cxx
 * @brief Meshes a file of polygons by the stages, one filter each, for TestModels.py.
 *
 *     MeshModel INPUT.vtp OUTPUT.vtu [--OPTION VALUE]...
 *
 * Options: criterion (0 Delaunay, 1 smallest sphere, 2 smallest sphere of triangle and edges),
 * maximum-edge-length, maximum-new-points, maximum-gap-edges, facet-flatness-ratio (of the surface
 * refiner; its default), flatness-ratio (of the sliver remover; 0: nothing is peeled off), resolve
 * (1: self-intersections), merge-tolerance, accuracy-angle.
 *
 * One line of "name value" pairs goes to the standard output: open edges and points of the cleaned
 * input, points added, tetrahedra, seconds of each stage. Errors and warnings of the filters go to
 * the standard error. Exit status: 0 meshed, 1 refused by a filter, 2 wrong use or a file that
 * cannot be read or written.
 */
#include <vtkAdvancingFrontTetrahedralizer.h>
#include <vtkBoundaryTriangulator.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkSliverRemover.h>

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>

namespace
{
bool Failed = false;

void NoteError(vtkObject* caller, unsigned long event, void*, void* text)
{
  Failed = Failed || event == vtkCommand::ErrorEvent;
  std::cerr << (event == vtkCommand::ErrorEvent ? "ERROR: " : "WARNING: ") << caller->GetClassName()
            << ": " << static_cast<const char*>(text) << std::endl;
}

/** Runs a filter; its time is printed with its name. */
bool Run(vtkAlgorithm* filter, const char* name)
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(NoteError);
  filter->AddObserver(vtkCommand::ErrorEvent, observer);
  filter->AddObserver(vtkCommand::WarningEvent, observer);
  const auto start = std::chrono::steady_clock::now();
  filter->Update();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::cout << name << " " << seconds.count() << " ";
  return !Failed;
}
} // namespace

int main(int argc, char* argv[])
{
  vtkNew<vtkDelaunaySurfaceRefiner> refiner;
  vtkNew<vtkSliverRemover> remover;
  std::map<std::string, double> options{ { "--criterion", 0.0 }, { "--maximum-edge-length", 0.0 },
    { "--maximum-new-points", 0.0 }, { "--maximum-gap-edges", 0.0 }, { "--resolve", 0.0 },
    { "--merge-tolerance", 0.0 }, { "--accuracy-angle", 0.0 },
    { "--facet-flatness-ratio", refiner->GetFlatnessRatio() },
    { "--flatness-ratio", remover->GetFlatnessRatio() } };
  bool isRightUse = argc >= 3 && argc % 2 == 1;
  for (int i = 3; isRightUse && i < argc; i += 2)
  {
    const auto option = options.find(argv[i]);
    isRightUse = option != options.end();
    if (isRightUse)
    {
      option->second = std::atof(argv[i + 1]);
    }
  }
  if (!isRightUse)
  {
    std::cerr << "usage: MeshModel INPUT.vtp OUTPUT.vtu [--OPTION VALUE]..." << std::endl;
    return 2;
  }

  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(argv[1]);
  if (!Run(reader, "read"))
  {
    return 2;
  }
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetMaximumGapEdges(static_cast<int>(options["--maximum-gap-edges"]));
  triangulator->SetResolveSelfIntersections(options["--resolve"] != 0.0);
  triangulator->SetMergeTolerance(options["--merge-tolerance"]);
  triangulator->SetInputConnection(reader->GetOutputPort());
  refiner->SetFlatnessRatio(options["--facet-flatness-ratio"]);
  refiner->SetCriterion(static_cast<int>(options["--criterion"]));
  refiner->SetAccuracyAngle(options["--accuracy-angle"]);
  refiner->SetMaximumEdgeLength(options["--maximum-edge-length"]);
  refiner->SetMaximumNewPoints(static_cast<int>(options["--maximum-new-points"]));
  refiner->SetInputConnection(triangulator->GetOutputPort());
  vtkNew<vtkAdvancingFrontTetrahedralizer> tetrahedralizer;
  tetrahedralizer->SetInputConnection(refiner->GetOutputPort());
  remover->SetFlatnessRatio(options["--flatness-ratio"]);
  remover->SetInputConnection(tetrahedralizer->GetOutputPort());

  if (!Run(triangulator, "triangulate") || !Run(refiner, "refine"))
  {
    return 1;
  }
  const vtkIdType points = triangulator->GetOutput()->GetNumberOfPoints();
  std::cout << "open " << triangulator->GetNumberOfOpenEdges() << " points " << points << " new "
            << refiner->GetOutput()->GetNumberOfPoints() - points << " unresolved "
            << refiner->GetNumberOfUnresolvedTriangles() << " ";
  if (!Run(tetrahedralizer, "tetrahedralize") || !Run(remover, "remove"))
  {
    return 1;
  }
  std::cout << "tetrahedra " << remover->GetOutput()->GetNumberOfCells() << " peeled "
            << remover->GetNumberOfPeeledTetrahedra() << " ";

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToNone();
  writer->SetFileName(argv[2]);
  writer->SetInputConnection(remover->GetOutputPort());
  if (!Run(writer, "write"))
  {
    return 2;
  }
  std::cout << std::endl;
  return 0;
}
