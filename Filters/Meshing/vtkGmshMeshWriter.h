// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGmshMeshWriter
 * @brief   Writes tetrahedra as a Gmsh file with physical groups for a device simulator.
 *
 * Method: an ASCII file of the format 2.2 (which DEVSIM and many others read), or 4.1, with these
 * physical groups, in this order, each with a number and a name of its own:
 *  1. a volume for each region, <region>. Its number is RegionId + 1;
 *  2. a surface for each interface between two regions, <region>_<region>, the lower RegionId first;
 *  3. surfaces for the outer boundary of each region, one for each side of the bounding box that it
 *     touches, <region>_xmin, _xmax, _ymin, _ymax, _zmin, _zmax, and <region>_outside for the rest;
 *  4. a surface for each contact, <contact>. If no region has all of a contact's triangles there is
 *     one for each region, <contact>_<region>: DEVSIM wants the contacts of a region in groups of
 *     their own.
 * Surfaces are numbered consecutively in this order, by region, by both regions, or by contact and
 * region, from the largest RegionId + 2 on, as if there were no contacts: a side that contacts take
 * completely is not written, but keeps its number. So contacts change no numbers of others.
 *
 * The outer triangles of contacts belong to no side; those on interfaces are in both groups, as two
 * elements. Names hold letters, digits and _ only, a letter first: other characters become _, and n
 * comes before another first character. If a name is taken, _2, _3, ... follows, where regions come
 * first, then contacts, interfaces, sides.
 *
 * Nodes are the points that tetrahedra use, in their order, from 1 on. Elements are the triangles
 * of the surfaces, group by group, and then the tetrahedra in their order. Coordinates are
 * multiplied by Scale, rounded once, and written so that they read back the same.
 *
 * Inputs:
 *  - port 0: vtkUnstructuredGrid of VTK_TETRA only. Cell array RegionId (whole numbers from 0 on);
 *    without it all is region 0. Field array RegionNames (texts as the sample
 *    devices have them, or a vtkStringArray, by region id) is optional: without it regions are
 *    called region_0, region_1, ...
 *  - port 1 (optional): vtkPolyData, the contacts: triangles that are facets of the mesh's outer
 *    boundary or interfaces (the mesher's second output has them), with the cell array ContactId
 *    (whole numbers; cells with a negative one are passed over). Its field array ContactNames
 *    (texts, by contact id) is optional: without it contacts are called contact_0, contact_1, ...
 *    Without this input the contacts are those that the filter upstream which made the mesh has in
 *    another output, as vtkConformingDelaunayMesher does, if all filters in between hand on its
 *    points.
 *
 * Guarantees: deterministic; what the file says is what DEVSIM's reader asks for (format 2.2, no
 * data sections): positive numbers, points, triangles and tetrahedra only, a physical group for each
 * element.
 *
 * Failure: an error that names the cells, and no file, for cells of another type, arrays that are
 * wrong, contacts that are no facets of the mesh; an error code if the file cannot be written. With
 * WriteDevsimScript also for tetrahedra that are inverted or flat.
 *
 * Cost: O(n log n); about 60 bytes of file for each tetrahedron, 30 of the script.
 *
 * References: Gmsh reference manual, "MSH file format" and "MSH file format version 2 (Legacy)".
 */
#ifndef vtkGmshMeshWriter_h
#define vtkGmshMeshWriter_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkWriter.h>

#include <limits>
#include <string>
#include <vector>

namespace cdm
{
struct Status;
} // namespace cdm
class vtkPolyData;
class vtkUnstructuredGrid;

class CDMMESHING_EXPORT vtkGmshMeshWriter : public vtkWriter
{
public:
  static vtkGmshMeshWriter* New();
  vtkTypeMacro(vtkGmshMeshWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** File to write, usually *.msh. No default. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  enum FileFormats
  {
    VERSION_2_2 = 0,
    VERSION_4_1 = 1
  };
  ///@{
  /** Version of Gmsh's format. Default VERSION_2_2, the one that DEVSIM reads. */
  vtkSetInRangeMacro(FileFormat, int, VERSION_2_2, VERSION_4_1, "one of FileFormats");
  vtkGetMacro(FileFormat, int);
  ///@}

  ///@{
  /**
   * Factor of the coordinates, such as 1e-4 from micrometers to the centimeters of DEVSIM. Default
   * 1; range above 0.
   */
  vtkSetInRangeMacro(
    Scale, double, std::numeric_limits<double>::min(), VTK_DOUBLE_MAX, "factor of the coordinates");
  vtkGetMacro(Scale, double);
  ///@}

  ///@{
  /**
   * Point and cell arrays to be written as node and element data, in their own units; two
   * components become three, more than three nine; triangles have the values of the tetrahedron that
   * they look out of. Default: none. DEVSIM refuses files that have
   * any.
   */
  void AddPointArray(const char* name);
  void RemoveAllPointArrays();
  void AddCellArray(const char* name);
  void RemoveAllCellArrays();
  ///@}

  ///@{
  /**
   * Write a Python script beside the file, <name>_devsim.py, which makes a device of it in DEVSIM
   * with the signed coupling areas and the box volumes of vtkVoronoiControlVolumes, instead of those
   * that DEVSIM computes without signs. Point arrays become its node solutions, and are not written
   * to the file. Scale has to lead to centimeters. Default off.
   */
  vtkSetMacro(WriteDevsimScript, bool);
  vtkGetMacro(WriteDevsimScript, bool);
  vtkBooleanMacro(WriteDevsimScript, bool);
  ///@}

protected:
  vtkGmshMeshWriter();
  ~vtkGmshMeshWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;
  int FileFormat = VERSION_2_2;
  double Scale = 1.0;
  std::vector<std::string> PointArrays;
  std::vector<std::string> CellArrays;
  bool WriteDevsimScript = false;

private:
  cdm::Status CheckOptions() const;
  template <typename Function>
  bool WriteTo(const std::string& name, const Function& write);

  vtkGmshMeshWriter(const vtkGmshMeshWriter&) = delete;
  void operator=(const vtkGmshMeshWriter&) = delete;
};

#endif
