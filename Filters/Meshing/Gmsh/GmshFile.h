// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GmshFile.h
 * @brief The text of Gmsh's formats 2.2 and 4.1.
 *
 * Both have the same numbers: nodes from 1 on, in the order of the points that tetrahedra use;
 * elements from 1 on, first the facets of surfaces, group by group, then the tetrahedra in the order
 * of the cells. The entities of 4.1 are the groups, with their numbers; a node belongs to the lowest
 * of its regions.
 */
#ifndef Gmsh_GmshFile_h
#define Gmsh_GmshFile_h

#include "Gmsh/PhysicalGroups.h"

#include <ostream>
#include <vector>

class vtkDataArray;

namespace vtkGmsh
{
struct GmshFileOptions
{
  /** Format 4.1 instead of 2.2. */
  bool IsVersion4 = false;
  /** Factor of the coordinates. */
  double Scale = 1.0;
  /** Arrays of the points and of the cells of the grid; up to nine components. */
  std::vector<vtkDataArray*> PointArrays;
  std::vector<vtkDataArray*> CellArrays;
};

/** The number of the node of each point; 0: no tetrahedron uses it. */
std::vector<std::size_t> NumberNodes(const cdm::TetMesh& mesh);

void WriteGmshFile(const GroupedMesh& mesh, const GmshFileOptions& options, std::ostream& file);
} // namespace vtkGmsh

#endif
