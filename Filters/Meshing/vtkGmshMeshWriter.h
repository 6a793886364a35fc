// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGmshMeshWriter
 * @brief   Writes tetrahedra as a Gmsh 2.2 file with physical groups for a device simulator.
 *
 * Method: an ASCII file of the format 2.2 (which DEVSIM and many others read) with
 *  - a physical volume for each region;
 *  - a physical surface for each interface between two regions, <region>_<region>;
 *  - physical surfaces for the outer boundary of each region, one for each side of the bounding
 *    box that it touches, <region>_xmin to <region>_zmax, and <region>_outside for the rest;
 *  - a physical surface for each contact: <contact>, or <contact>_<region> if several regions touch
 *    it. Contacts take facets away from the outer boundary and are added to interfaces.
 * Names are unique, begin with a letter, and hold letters, digits and _ only: other characters
 * become _. Coordinates are written so that they read back the same.
 *
 * Inputs:
 *  - port 0: vtkUnstructuredGrid of VTK_TETRA only. Cell array RegionId (whole numbers from 0 on);
 *    without it all is region 0. Field array RegionNames (texts, by region id: of
 *    the sample devices, or a vtkStringArray) is optional:
 *    without it regions are called region_0, region_1, ...
 *  - port 1 (optional): vtkPolyData, the contacts: triangles that are facets of the mesh's outer
 *    boundary or interfaces (the mesher's second output has them), with the cell array ContactId
 *    (whole numbers; cells with a negative one are passed over). Its field array ContactNames
 *    (strings, by contact id) is optional: without it contacts are called contact_0, contact_1, ...
 *
 * Guarantees: deterministic; what the file says is what DEVSIM's reader asks for: positive numbers,
 * points, triangles and tetrahedra only, a physical group for each element.
 *
 * Failure: an error that names the cells, and no file, for cells of another type, arrays that are
 * wrong, contacts that are no facets of the mesh; an error code if the file cannot be written.
 *
 * Cost: O(n log n); about 60 bytes of file for each tetrahedron.
 *
 * References: Gmsh reference manual, "MSH file format version 2 (Legacy)".
 */
#ifndef vtkGmshMeshWriter_h
#define vtkGmshMeshWriter_h

#include "cdmMeshingModule.h" // For export macro
#include <vtkWriter.h>

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

protected:
  vtkGmshMeshWriter();
  ~vtkGmshMeshWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;

private:
  vtkGmshMeshWriter(const vtkGmshMeshWriter&) = delete;
  void operator=(const vtkGmshMeshWriter&) = delete;
};

#endif
