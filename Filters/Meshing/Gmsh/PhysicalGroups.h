// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PhysicalGroups.h
 * @brief The physical groups of a mesh: which facets they have, their numbers and names.
 *
 * vtkGmshMeshWriter.h has the rules.
 */
#ifndef Gmsh_PhysicalGroups_h
#define Gmsh_PhysicalGroups_h

#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"

#include <string>
#include <vector>

class vtkDataSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkGmsh
{
/** A triangle of a surface, and the tetrahedron that it looks out of. */
struct GroupFacet
{
  cdm::TriangleIds Points;
  cdm::Id Tetrahedron;
};

struct PhysicalGroup
{
  /** In the order of the numbers. */
  enum Kinds
  {
    Region,
    Interface,
    Side,
    Contact
  };
  int Kind = Region;
  /** Region; lower region; region; contact. */
  cdm::Id First = cdm::NoId;
  /** -; higher region; side of the bounding box, or 6 for elsewhere; first of Regions. */
  cdm::Id Second = cdm::NoId;
  int Number = 0;
  /** Those that have all facets of it, ascending: one, or two. */
  std::vector<cdm::Id> Regions;
  std::string Name;
  /** Facets, if it is a surface; they look out of the first region. */
  std::vector<GroupFacet> Facets;

  int GetDimension() const { return this->Kind == Region ? 3 : 2; }
};

struct GroupedMesh
{
  cdm::TetMesh Mesh;
  /** Ascending by number; those of surfaces have facets. */
  std::vector<PhysicalGroup> Groups;

  const PhysicalGroup& GetRegion(cdm::Id region) const;
};

/**
 * Letters, digits and _ of a text, a letter first; other characters become _: words that readers
 * of names understand.
 */
std::string MakeWord(const std::string& text);

/**
 * Makes the groups. Contacts may be null.
 * @param faulty receives the input that the status speaks of
 */
cdm::Status CollectPhysicalGroups(
  vtkUnstructuredGrid* grid, vtkPolyData* contacts, GroupedMesh& output, vtkDataSet*& faulty);
} // namespace vtkGmsh

#endif
