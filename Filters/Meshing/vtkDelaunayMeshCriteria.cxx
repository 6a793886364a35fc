// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDelaunayMeshCriteria.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Certificates.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"

#include "Core/Certificate/MeshCertificate.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkDelaunayMeshCriteria);

namespace
{
/** Polygons as fans: the volume that they enclose is the same, convex or not. */
cdm::Status ToFans(vtkPolyData* input, cdm::TriangleMesh& boundary)
{
  cdm::PolygonSoup soup;
  std::vector<vtkIdType> cells;
  cdm::Status status = vtkCoreBridge::ToPolygonSoup(input, soup, cells);
  if (!status.IsOk())
  {
    return status;
  }
  if (soup.Labels.empty())
  {
    return cdm::Status::InvalidInput(
      "The boundary (port 1) has no cell array BoundaryLabels: the volumes of its regions are not "
      "known. Take it away, or give it labels.");
  }
  boundary.Points = std::move(soup.Points);
  for (cdm::Id polygon = 0; polygon < soup.GetNumberOfPolygons(); ++polygon)
  {
    const cdm::Id* ids = soup.GetPolygon(polygon);
    for (cdm::Id i = 2; i < soup.GetPolygonSize(polygon); ++i)
    {
      boundary.Triangles.push_back({ ids[0], ids[i - 1], ids[i] });
      boundary.Labels.push_back(soup.Labels[polygon]);
    }
  }
  return {};
}

template <typename Array, typename Function>
void AddArray(vtkFieldData* data, const char* name, std::size_t count, const Function& getValue)
{
  data->AddArray(vtkCoreBridge::MakeArray<Array>(name, count, getValue));
}

void AddQualities(const cdm::MeshCertificate& report, vtkCellData* data)
{
  const auto& qualities = report.Qualities;
  const auto add = [&](const char* name, auto&& getValue)
  {
    AddArray<vtkDoubleArray>(
      data, name, qualities.size(), [&](std::size_t i) { return getValue(qualities[i]); });
  };
  constexpr const char* Names[] = { "Q1", "Q2", "Q3", "Q4", "Q5" };
  for (int i = 0; i < 5; ++i)
  {
    add(Names[i], [i](const cdm::TetrahedronQuality& quality) { return quality.Q[i]; });
  }
  add("AspectRatio", [](const cdm::TetrahedronQuality& quality) { return quality.AspectRatio; });
  add("RadiusEdgeRatio",
    [](const cdm::TetrahedronQuality& quality) { return quality.RadiusEdgeRatio; });
  add("SmallestDihedralAngle",
    [](const cdm::TetrahedronQuality& quality) { return quality.SmallestDihedralAngle; });
  add("LargestDihedralAngle",
    [](const cdm::TetrahedronQuality& quality) { return quality.LargestDihedralAngle; });
  add("UnsignedBoxRatio",
    [](const cdm::TetrahedronQuality& quality) { return quality.UnsignedBoxRatio; });
  AddArray<vtkUnsignedCharArray>(data, "MakesUnsignedBoxesLarge",
    report.MakesUnsignedBoxesLarge.size(),
    [&](std::size_t i) { return report.MakesUnsignedBoxesLarge[i]; });

  std::vector<unsigned char> isDelaunay(qualities.size(), 1);
  std::vector<unsigned char> isOpen(qualities.size(), 0);
  for (const cdm::MeshViolation& violation : report.Violations)
  {
    if (violation.Fault == cdm::MeshFault::NonDelaunayTetrahedron ||
      violation.Fault == cdm::MeshFault::FlatTetrahedron)
    {
      isDelaunay[violation.Tetrahedron] = 0;
    }
    else if (violation.Fault == cdm::MeshFault::OpenControlVolume)
    {
      isOpen[violation.Tetrahedron] = 1;
    }
  }
  AddArray<vtkUnsignedCharArray>(
    data, "IsDelaunay", isDelaunay.size(), [&](std::size_t i) { return isDelaunay[i]; });
  AddArray<vtkUnsignedCharArray>(
    data, "IsOpen", isOpen.size(), [&](std::size_t i) { return isOpen[i]; });
}

/** Lines, triangles and tetrahedra on the points that they use. */
void MakeViolations(const cdm::MeshCertificate& report, const std::vector<cdm::Vec3>& points,
  const std::vector<vtkIdType>& cells, vtkUnstructuredGrid* output)
{
  vtkNew<vtkPoints> usedPoints;
  usedPoints->SetDataTypeToDouble();
  std::vector<vtkIdType> newIds(points.size(), -1);
  vtkNew<vtkIntArray> faults;
  faults->SetName("Fault");
  vtkNew<vtkIntArray> regions;
  regions->SetName(vtkCoreBridge::RegionIdName);
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("CellId");
  output->AllocateEstimate(static_cast<vtkIdType>(report.Violations.size()), 4);
  for (const cdm::MeshViolation& violation : report.Violations)
  {
    vtkIdType ids[4];
    int size = 0;
    for (; size < 4 && violation.Points[size] != cdm::NoId; ++size)
    {
      const cdm::Id point = violation.Points[size];
      if (newIds[point] < 0)
      {
        newIds[point] =
          usedPoints->InsertNextPoint(points[point].X, points[point].Y, points[point].Z);
      }
      ids[size] = newIds[point];
    }
    output->InsertNextCell(size == 2 ? VTK_LINE : size == 3 ? VTK_TRIANGLE : VTK_TETRA, size, ids);
    faults->InsertNextValue(static_cast<int>(violation.Fault));
    regions->InsertNextValue(violation.Region);
    cellIds->InsertNextValue(
      violation.Tetrahedron == cdm::NoId ? -1 : cells[violation.Tetrahedron]);
  }
  output->SetPoints(usedPoints);
  output->GetCellData()->SetScalars(faults);
  output->GetCellData()->AddArray(regions);
  output->GetCellData()->AddArray(cellIds);
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkDelaunayMeshCriteria::vtkDelaunayMeshCriteria()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

//--------------------------------------------------------------------------------------------------
int vtkDelaunayMeshCriteria::FillInputPortInformation(int port, vtkInformation* info)
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
int vtkDelaunayMeshCriteria::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  vtkPolyData* surface = vtkPolyData::GetData(inputVector[1]);
  this->Certificate.clear();
  this->IsClean = false;
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TetMesh mesh;
  std::vector<vtkIdType> cells;
  cdm::TriangleMesh boundary;
  cdm::MeshCertificate report;
  vtkDataSet* faulty = input;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTetrahedra(input, mesh, cells);
      if (step.IsOk() && surface)
      {
        step = ToFans(surface, boundary);
        faulty = step.IsOk() ? input : static_cast<vtkDataSet*>(surface);
      }
      if (step.IsOk())
      {
        step = cdm::CertifyMesh(mesh, surface ? &boundary : nullptr,
          vtkCoreBridge::MakeContext(this), report, cdm::FullCertificate);
      }
      return step;
    });
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, faulty);
  }
  this->Certificate = report.GetText();
  this->IsClean = report.IsClean();

  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  if (static_cast<vtkIdType>(cells.size()) == input->GetNumberOfCells())
  {
    output->CopyStructure(input);
    output->GetCellData()->PassData(input->GetCellData());
  }
  else
  {
    vtkCoreBridge::CopyTuples(
      input->GetCellData(), cells, output->GetCellData(), { vtkCoreBridge::RegionIdName });
    vtkCoreBridge::FromTetMesh(mesh, output);
  }
  output->GetPointData()->PassData(input->GetPointData());
  AddQualities(report, output->GetCellData());
  vtkCoreBridge::AddCertificate(report, output->GetFieldData());
  MakeViolations(report, mesh.Points, cells, vtkUnstructuredGrid::GetData(outputVector, 1));
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkDelaunayMeshCriteria::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Certificate: " << this->Certificate << "\n";
  os << indent << "IsClean: " << this->IsClean << "\n";
}
