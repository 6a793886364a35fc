// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGmshMeshWriter.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Reports.h"
#include "Gmsh/DevsimScript.h"
#include "Gmsh/GmshFile.h"

#include "Core/BoxMethod/ControlVolumes.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <vtksys/FStream.hxx>
#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <locale>

vtkStandardNewMacro(vtkGmshMeshWriter);

namespace
{
/** The arrays of these names; up to nine finite components. */
cdm::Status FindArrays(vtkFieldData* data, const std::vector<std::string>& names, const char* kind,
  std::vector<vtkDataArray*>& arrays)
{
  for (const std::string& name : names)
  {
    vtkDataArray* array = data->GetArray(name.c_str());
    if (!array || array->GetNumberOfComponents() > 9)
    {
      return cdm::Status::InvalidInput(std::string("The input has no ") + kind + " array " + name +
        " of numbers with up to nine components.");
    }
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      for (int j = 0; j < array->GetNumberOfComponents(); ++j)
      {
        if (!std::isfinite(array->GetComponent(i, j)))
        {
          return cdm::Status::InvalidInput(std::string("The ") + kind + " array " + name +
            " is not finite at " + kind + " " + std::to_string(i) + ".");
        }
      }
    }
    arrays.push_back(array);
  }
  return {};
}

/** Filters that hand a mesh on also hand on its points, or a copy. */
bool HasSamePoints(vtkUnstructuredGrid* grid, vtkPointSet* other)
{
  vtkPoints* const points = grid->GetPoints();
  vtkPoints* const others = other ? other->GetPoints() : nullptr;
  const auto areEqual = [&](vtkIdType i)
  {
    double a[3];
    double b[3];
    points->GetPoint(i, a);
    others->GetPoint(i, b);
    return std::equal(a, a + 3, b);
  };
  bool isSame = points && others && points->GetNumberOfPoints() == others->GetNumberOfPoints();
  for (vtkIdType i = 0; isSame && points != others && i < points->GetNumberOfPoints(); ++i)
  {
    isSame = areEqual(i);
  }
  return isSame;
}

/**
 * The contacts of a mesh that come out of the filter that made it, beside it; null if there are
 * none. Filters in between must have handed the mesh on as it was.
 */
vtkPolyData* FindContacts(vtkAlgorithm* writer, vtkUnstructuredGrid* grid)
{
  vtkAlgorithm* algorithm = writer;
  while (algorithm->GetNumberOfInputPorts() > 0 && algorithm->GetNumberOfInputConnections(0) == 1)
  {
    algorithm = algorithm->GetInputAlgorithm(0, 0);
    if (!HasSamePoints(grid, vtkPointSet::SafeDownCast(algorithm->GetOutputDataObject(0))))
    {
      return nullptr;
    }
    for (int port = 1; port < algorithm->GetNumberOfOutputPorts(); ++port)
    {
      auto* boundary = vtkPolyData::SafeDownCast(algorithm->GetOutputDataObject(port));
      if (boundary && boundary->GetCellData()->HasArray(vtkCoreBridge::ContactIdName))
      {
        return boundary;
      }
    }
  }
  return nullptr;
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkGmshMeshWriter::vtkGmshMeshWriter()
{
  this->SetNumberOfInputPorts(2);
}

//--------------------------------------------------------------------------------------------------
vtkGmshMeshWriter::~vtkGmshMeshWriter()
{
  this->SetFileName(nullptr);
}

//--------------------------------------------------------------------------------------------------
int vtkGmshMeshWriter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(
    vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::WriteData()
{
  if (!this->FileName || !this->FileName[0])
  {
    vtkErrorMacro("No file name: set FileName.");
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
    return;
  }
  auto grid = vtkUnstructuredGrid::SafeDownCast(this->GetInput());
  vtkPolyData* const contacts = this->GetNumberOfInputConnections(1) > 0
    ? vtkPolyData::SafeDownCast(this->GetExecutive()->GetInputData(1, 0))
    : FindContacts(this, grid);
  vtkGmsh::GroupedMesh mesh;
  vtkGmsh::GmshFileOptions options{ this->FileFormat == VERSION_4_1, this->Scale, {}, {} };
  cdm::ControlVolumes volumes;
  vtkDataSet* faulty = grid;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      return this->CheckOptions()
        .Then(
          [&] {
            return FindArrays(
              grid->GetPointData(), this->PointArrays, "point", options.PointArrays);
          })
        .Then([&]
          { return FindArrays(grid->GetCellData(), this->CellArrays, "cell", options.CellArrays); })
        .Then([&] { return vtkGmsh::CollectPhysicalGroups(grid, contacts, mesh, faulty); })
        .Then(
          [&]
          {
            return this->WriteDevsimScript
              ? cdm::ComputeControlVolumes(mesh.Mesh, vtkCoreBridge::MakeContext(this), volumes)
              : cdm::Status();
          });
    });
  if (!status.IsOk())
  {
    vtkCoreBridge::ReportError(this, status, faulty);
    this->SetErrorCode(vtkErrorCode::UnknownError);
    return;
  }
  using vtksys::SystemTools;
  const std::string name = this->FileName;
  const std::string device = SystemTools::GetFilenameWithoutLastExtension(name);
  const vtkGmsh::DevsimScriptOptions scriptOptions{ SystemTools::GetFilenameName(name), device,
    this->Scale, options.PointArrays };
  if (this->WriteDevsimScript)
  {
    // DEVSIM refuses files with data sections.
    options.PointArrays.clear();
  }
  const bool isWritten =
    this->WriteTo(name, [&](std::ostream& file) { vtkGmsh::WriteGmshFile(mesh, options, file); });
  if (isWritten && this->WriteDevsimScript)
  {
    const std::string path = SystemTools::GetFilenamePath(name);
    this->WriteTo((path.empty() ? path : path + "/") + device + "_devsim.py",
      [&](std::ostream& file) { vtkGmsh::WriteDevsimScript(mesh, volumes, scriptOptions, file); });
  }
}

//--------------------------------------------------------------------------------------------------
cdm::Status vtkGmshMeshWriter::CheckOptions() const
{
  if (this->WriteDevsimScript && this->FileFormat != VERSION_2_2)
  {
    return cdm::Status::InvalidInput(
      "DEVSIM reads the format 2.2 only: set FileFormat to it, or do not write a script.");
  }
  if (this->WriteDevsimScript && !this->CellArrays.empty())
  {
    return cdm::Status::InvalidInput(
      "Cell arrays are written to the Gmsh file only, and DEVSIM refuses files with data: remove "
      "them, or do not write a script.");
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
template <typename Function>
bool vtkGmshMeshWriter::WriteTo(const std::string& name, const Function& write)
{
  vtksys::ofstream file(name.c_str());
  if (!file)
  {
    vtkErrorMacro("Cannot open the file " << name << " for writing.");
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    return false;
  }
  file.imbue(std::locale::classic());
  write(file);
  file.close();
  if (!file)
  {
    vtkErrorMacro("Cannot write all of the file " << name << ": is the disk full?");
    this->SetErrorCode(vtkErrorCode::OutOfDiskSpaceError);
    return false;
  }
  return true;
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::AddPointArray(const char* name)
{
  this->PointArrays.emplace_back(name ? name : "");
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::RemoveAllPointArrays()
{
  this->PointArrays.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::AddCellArray(const char* name)
{
  this->CellArrays.emplace_back(name ? name : "");
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::RemoveAllCellArrays()
{
  this->CellArrays.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "FileFormat: " << this->FileFormat << "\n";
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "WriteDevsimScript: " << this->WriteDevsimScript << "\n";
  for (const std::string& name : this->PointArrays)
  {
    os << indent << "PointArray: " << name << "\n";
  }
  for (const std::string& name : this->CellArrays)
  {
    os << indent << "CellArray: " << name << "\n";
  }
}
