// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SuiteMesher.cxx
 * @brief vtkConformingDelaunayMesher on a file of polygons, measured, for Suite.py.
 *
 *     SuiteMesher INPUT.vtp OUTPUT.vtu [--OPTION VALUE]...
 *
 * Options: criterion (one of vtkConformingDelaunayMesher::Criteria, 0), steiner-points (0),
 * maximum-volume (0; above, with Steiner points), radius-edge-ratio and dihedral-angle (of these;
 * the filter's), remove-slivers (1).
 *
 * Prints one line of "name value" pairs: seconds (processor time of the filter, without reading and
 * writing), megabytes (the peak until then), start (megabytes before it), points and tetrahedra.
 * Exit status: 0 meshed, 1 refused by the filter, 2 wrong use or a file that cannot be read or
 * written.
 */
#include "Measurement.h"

#include <vtkConformingDelaunayMesher.h>

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cstdlib>
#include <ctime>
#include <iostream>
#include <map>
#include <string>

int main(int argc, char* argv[])
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  std::map<std::string, double> options{ { "--criterion", 0.0 }, { "--steiner-points", 0.0 },
    { "--maximum-volume", 0.0 }, { "--radius-edge-ratio", mesher->GetRadiusEdgeRatio() },
    { "--dihedral-angle", mesher->GetDihedralAngleTarget() }, { "--remove-slivers", 1.0 } };
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
    std::cerr << "usage: SuiteMesher INPUT.vtp OUTPUT.vtu [--OPTION VALUE]..." << std::endl;
    return 2;
  }
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(argv[1]);
  reader->Update();
  if (reader->GetOutput()->GetNumberOfPolys() == 0)
  {
    return 2;
  }
  mesher->SetInputConnection(reader->GetOutputPort());
  mesher->SetCriterion(static_cast<int>(options["--criterion"]));
  mesher->SetAddSteinerPoints(
    options["--steiner-points"] != 0.0 || options["--maximum-volume"] > 0.0);
  mesher->SetMaximumVolume(options["--maximum-volume"]);
  mesher->SetRadiusEdgeRatio(options["--radius-edge-ratio"]);
  mesher->SetDihedralAngleTarget(options["--dihedral-angle"]);
  mesher->SetRemoveSlivers(options["--remove-slivers"] != 0.0);

  const double before = GetMegabytes("VmHWM");
  const std::clock_t start = std::clock();
  mesher->Update();
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double megabytes = GetMegabytes("VmHWM");
  vtkUnstructuredGrid* mesh = mesher->GetOutput();
  std::cout << "seconds " << seconds << " megabytes " << megabytes << " start " << before
            << " points " << mesh->GetNumberOfPoints() << " tetrahedra " << mesh->GetNumberOfCells()
            << std::endl;
  if (mesh->GetNumberOfCells() == 0)
  {
    return 1;
  }
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToNone();
  writer->SetFileName(argv[2]);
  writer->SetInputData(mesh);
  return writer->Write() == 1 ? 0 : 2;
}
