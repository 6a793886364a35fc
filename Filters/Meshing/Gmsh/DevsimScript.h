// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DevsimScript.h
 * @brief The text of a Python script that makes a DEVSIM device of a file of the format 2.2.
 *
 * It is the module _devsim_device.py of the Python package, and the control volumes as base64.
 */
#ifndef Gmsh_DevsimScript_h
#define Gmsh_DevsimScript_h

#include "Gmsh/PhysicalGroups.h"

#include "Core/BoxMethod/ControlVolumes.h"

#include <ostream>
#include <string>
#include <vector>

class vtkDataArray;

namespace vtkGmsh
{
struct DevsimScriptOptions
{
  /** Name of the file beside the script, and of the device. */
  std::string MeshFile;
  std::string Device;
  /** Factor of the lengths. */
  double Scale = 1.0;
  /** Node solutions, one value for each point of the grid. */
  std::vector<vtkDataArray*> PointArrays;
};

void WriteDevsimScript(const GroupedMesh& mesh, const cdm::ControlVolumes& volumes,
  const DevsimScriptOptions& options, std::ostream& file);
} // namespace vtkGmsh

#endif
