// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVoronoiControlVolumes.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"

#include "Core/BoxMethod/ControlPolyhedra.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkVoronoiControlVolumes);

namespace
{
/** The arrays of a vertex for each item, on a point of its own: copies of mesh points. */
template <typename Item>
void MakeVertices(const std::vector<Item>& items, const cdm::TetMesh& mesh, vtkPointData* pointData,
  vtkPolyData* output)
{
  const std::size_t count = items.size();
  std::vector<cdm::Vec3> positions(count);
  std::vector<vtkIdType> sources(count);
  vtkCoreBridge::ForEach(count,
    [&](std::size_t i)
    {
      sources[i] = items[i].Point;
      positions[i] = mesh.Points[items[i].Point];
    });
  output->SetPoints(vtkCoreBridge::FromPoints(positions));
  output->SetVerts(vtkCoreBridge::MakeCells(
    count, 1, [](std::size_t i, int) { return static_cast<vtkIdType>(i); }));
  vtkCoreBridge::CopyTuples(pointData, sources, output->GetPointData());
  output->GetPointData()->AddArray(vtkCoreBridge::MakeArray<vtkIdTypeArray>(
    "PointId", count, [&](std::size_t i) { return sources[i]; }));
}

template <typename Array, typename Item, typename Function>
vtkSmartPointer<Array> MakeArray(const char* name, const std::vector<Item>& items, Function&& get)
{
  return vtkCoreBridge::MakeArray<Array>(
    name, items.size(), [&](std::size_t i) { return get(items[i]); });
}

void MakeBoxVertices(const cdm::ControlVolumes& volumes, const cdm::TetMesh& mesh,
  vtkPointData* pointData, vtkPolyData* output)
{
  MakeVertices(volumes.Boxes, mesh, pointData, output);
  output->GetPointData()->AddArray(MakeArray<vtkIntArray>(vtkCoreBridge::RegionIdName,
    volumes.Boxes, [](const cdm::ControlBox& box) { return box.Region; }));
  output->GetPointData()->SetScalars(MakeArray<vtkDoubleArray>(
    "BoxVolume", volumes.Boxes, [](const cdm::ControlBox& box) { return box.Volume; }));
}

void MakeCouplings(const cdm::ControlVolumes& volumes, const cdm::TetMesh& mesh,
  vtkPointData* pointData, vtkPolyData* output)
{
  const auto& couplings = volumes.Couplings;
  output->SetPoints(vtkCoreBridge::FromPoints(mesh.Points));
  output->SetLines(vtkCoreBridge::MakeCells(
    couplings.size(), 2, [&](std::size_t i, int j) { return couplings[i].Points[j]; }));
  output->GetPointData()->PassData(pointData);
  output->GetCellData()->AddArray(MakeArray<vtkIntArray>(vtkCoreBridge::RegionIdName, couplings,
    [](const cdm::EdgeCoupling& coupling) { return coupling.Region; }));
  output->GetCellData()->SetScalars(MakeArray<vtkDoubleArray>(
    "CouplingArea", couplings, [](const cdm::EdgeCoupling& coupling) { return coupling.Area; }));
  output->GetCellData()->AddArray(MakeArray<vtkDoubleArray>(
    "EdgeLength", couplings, [](const cdm::EdgeCoupling& coupling) { return coupling.Length; }));
}

void MakeBoundaryAreas(const cdm::ControlVolumes& volumes, const cdm::TetMesh& mesh,
  vtkPointData* pointData, vtkPolyData* output)
{
  MakeVertices(volumes.BoundaryAreas, mesh, pointData, output);
  vtkNew<vtkIntArray> labels;
  labels->SetName(vtkCoreBridge::BoundaryLabelsName);
  labels->SetNumberOfComponents(2);
  for (const cdm::BoundaryArea& area : volumes.BoundaryAreas)
  {
    const int pair[2] = { area.LowRegion, area.HighRegion };
    labels->InsertNextTypedTuple(pair);
  }
  output->GetPointData()->AddArray(labels);
  output->GetPointData()->SetScalars(MakeArray<vtkDoubleArray>("BoundaryArea",
    volumes.BoundaryAreas, [](const cdm::BoundaryArea& area) { return area.Area; }));
}

void MakeBoxes(const cdm::ControlVolumes& volumes, const cdm::ControlPolyhedra& polyhedra,
  vtkPointData* pointData, vtkUnstructuredGrid* output)
{
  output->SetPoints(vtkCoreBridge::FromPoints(polyhedra.Points));
  const auto count = static_cast<vtkIdType>(volumes.Boxes.size());
  output->AllocateEstimate(count, 30);
  vtkNew<vtkIdList> faces;
  std::vector<vtkIdType> sources;
  for (vtkIdType box = 0; box < count; ++box)
  {
    faces->Reset();
    const cdm::Id begin = polyhedra.BoxOffsets[box];
    const cdm::Id end = polyhedra.BoxOffsets[box + 1];
    faces->InsertNextId(end - begin);
    for (cdm::Id i = begin; i < end; ++i)
    {
      const cdm::Id use = polyhedra.BoxPolygons[i];
      const bool isTurned = use < 0;
      const cdm::Id polygon = isTurned ? ~use : use;
      const cdm::Id first = polyhedra.Offsets[polygon];
      const cdm::Id size = polyhedra.Offsets[polygon + 1] - first;
      faces->InsertNextId(size);
      for (cdm::Id j = 0; j < size; ++j)
      {
        faces->InsertNextId(polyhedra.Connectivity[first + (isTurned ? size - 1 - j : j)]);
      }
    }
    output->InsertNextCell(VTK_POLYHEDRON, faces);
    sources.push_back(volumes.Boxes[box].Point);
  }
  vtkCellData* data = output->GetCellData();
  vtkCoreBridge::CopyTuples(pointData, sources, data);
  data->AddArray(MakeArray<vtkIdTypeArray>(
    "PointId", volumes.Boxes, [](const cdm::ControlBox& box) { return box.Point; }));
  data->SetScalars(MakeArray<vtkIntArray>(vtkCoreBridge::RegionIdName, volumes.Boxes,
    [](const cdm::ControlBox& box) { return box.Region; }));
  data->AddArray(MakeArray<vtkDoubleArray>(
    "BoxVolume", volumes.Boxes, [](const cdm::ControlBox& box) { return box.Volume; }));
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkVoronoiControlVolumes::vtkVoronoiControlVolumes()
{
  this->SetNumberOfOutputPorts(4);
}

//--------------------------------------------------------------------------------------------------
int vtkVoronoiControlVolumes::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkVoronoiControlVolumes::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 3 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//--------------------------------------------------------------------------------------------------
vtkPolyData* vtkVoronoiControlVolumes::GetCouplings()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

//--------------------------------------------------------------------------------------------------
vtkPolyData* vtkVoronoiControlVolumes::GetBoundaryAreas()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(2));
}

//--------------------------------------------------------------------------------------------------
vtkUnstructuredGrid* vtkVoronoiControlVolumes::GetBoxes()
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(3));
}

//--------------------------------------------------------------------------------------------------
int vtkVoronoiControlVolumes::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  this->NumberOfNegativeCouplings = 0;
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TetMesh mesh;
  cdm::ControlVolumes volumes;
  cdm::ControlPolyhedra polyhedra;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      const cdm::ExecutionContext context = vtkCoreBridge::MakeContext(this);
      const double share = this->GenerateBoxes ? 0.5 : 1.0;
      cdm::Status step = vtkCoreBridge::ToTetMesh(input, mesh);
      if (step.IsOk())
      {
        step = cdm::ComputeControlVolumes(mesh, context.Part(0.0, share), volumes);
      }
      if (step.IsOk() && this->GenerateBoxes)
      {
        step = cdm::MakeControlPolyhedra(mesh, volumes, context.Part(share, 1.0), polyhedra);
      }
      return step;
    });
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }
  this->NumberOfNegativeCouplings = volumes.NegativeCouplings;

  vtkPointData* pointData = input->GetPointData();
  MakeBoxVertices(volumes, mesh, pointData, vtkPolyData::GetData(outputVector, 0));
  MakeCouplings(volumes, mesh, pointData, vtkPolyData::GetData(outputVector, 1));
  MakeBoundaryAreas(volumes, mesh, pointData, vtkPolyData::GetData(outputVector, 2));
  if (this->GenerateBoxes)
  {
    MakeBoxes(volumes, polyhedra, pointData, vtkUnstructuredGrid::GetData(outputVector, 3));
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkVoronoiControlVolumes::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "GenerateBoxes: " << this->GenerateBoxes << "\n";
  os << indent << "NumberOfNegativeCouplings: " << this->NumberOfNegativeCouplings << "\n";
}
