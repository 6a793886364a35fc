// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSliverRemover.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Certificates.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Tuples.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Improvement/SliverRemover.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

vtkStandardNewMacro(vtkSliverRemover);

namespace
{
using SortedTetrahedra = std::vector<std::pair<cdm::TetrahedronIds, vtkIdType>>;

SortedTetrahedra Sort(const cdm::RawVector<cdm::TetrahedronIds>& tetrahedra)
{
  SortedTetrahedra sorted;
  sorted.reserve(tetrahedra.size());
  for (const cdm::TetrahedronIds& ids : tetrahedra)
  {
    sorted.emplace_back(cdm::Sorted(ids), static_cast<vtkIdType>(sorted.size()));
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/** For each tetrahedron the one before that has the same points, or -1. */
std::vector<vtkIdType> FindSurvivors(const cdm::RawVector<cdm::TetrahedronIds>& before,
  const cdm::RawVector<cdm::TetrahedronIds>& after)
{
  const SortedTetrahedra sorted = Sort(before);
  std::vector<vtkIdType> sources(after.size(), -1);
  for (std::size_t i = 0; i < after.size(); ++i)
  {
    // Most tetrahedra stay where they are.
    if (i < before.size() && before[i] == after[i])
    {
      sources[i] = static_cast<vtkIdType>(i);
      continue;
    }
    const cdm::TetrahedronIds ids = cdm::Sorted(after[i]);
    const auto found =
      std::lower_bound(sorted.begin(), sorted.end(), std::make_pair(ids, vtkIdType(-1)));
    if (found != sorted.end() && found->first == ids)
    {
      sources[i] = found->second;
    }
  }
  return sources;
}

/** For each point itself, or NoId if it has moved. */
std::vector<cdm::Id> FindStayingPoints(
  vtkUnstructuredGrid* input, const std::vector<cdm::Vec3>& points)
{
  std::vector<cdm::Id> sources(points.size(), cdm::NoId);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    double x[3];
    input->GetPoint(static_cast<vtkIdType>(i), x);
    if (points[i] == cdm::Vec3{ x[0], x[1], x[2] })
    {
      sources[i] = static_cast<cdm::Id>(i);
    }
  }
  return sources;
}
} // namespace

//--------------------------------------------------------------------------------------------------
int vtkSliverRemover::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkSliverRemover::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* input = vtkUnstructuredGrid::GetData(inputVector[0]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }

  cdm::TetMesh mesh;
  cdm::RawVector<cdm::TetrahedronIds> before;
  cdm::SliverRemoverReport report;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::Status step = vtkCoreBridge::ToTetMesh(input, mesh);
      if (step.IsOk())
      {
        before = mesh.Tetrahedra;
        cdm::SliverRemoverOptions options;
        options.DihedralAngleTarget = this->DihedralAngleTarget;
        options.FlatnessRatio = this->FlatnessRatio;
        options.QualityBeforeDelaunay = this->QualityBeforeDelaunay;
        step = vtkCoreBridge::ToFlags(input, vtkCoreBridge::FreePointName, options.IsFree);
        if (!step.IsOk())
        {
          return step;
        }
        if (this->FreeInteriorPoints)
        {
          options.IsFree.assign(mesh.Points.size(), 1);
        }
        options.AreBoundaryPointsFree = this->FreeBoundaryPoints;
        step = cdm::RemoveSlivers(mesh, options, vtkCoreBridge::MakeContext(this), report);
      }
      return step;
    });
  this->NumberOfPeeledTetrahedra = report.PeeledTetrahedra;
  this->NumberOfFlips = report.Flips;
  this->NumberOfMovedPoints = report.MovedPoints;
  this->SmallestDihedralAngleBefore = report.SmallestDihedralAngleBefore;
  this->SmallestDihedralAngleAfter = report.SmallestDihedralAngleAfter;
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }

  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkCoreBridge::RemoveCertificate(output->GetFieldData());
  vtkCellData* const cellData = input->GetCellData();
  if (cellData->GetNumberOfArrays() > (cellData->HasArray(vtkCoreBridge::RegionIdName) ? 1 : 0))
  {
    vtkCoreBridge::CopyTuples(cellData, FindSurvivors(before, mesh.Tetrahedra),
      output->GetCellData(), { vtkCoreBridge::RegionIdName });
  }
  vtkCoreBridge::FromTetMesh(mesh, output);
  if (report.MovedPoints == 0)
  {
    output->GetPointData()->PassData(input->GetPointData());
    return 1;
  }
  vtkCoreBridge::InterpolateTuplesInCells(input, FindStayingPoints(input, mesh.Points), output);
  if (vtkDataArray* isFree = input->GetPointData()->GetArray(vtkCoreBridge::FreePointName))
  {
    // A property of the points, wherever they are.
    output->GetPointData()->AddArray(isFree);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkSliverRemover::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "DihedralAngleTarget: " << this->DihedralAngleTarget << "\n";
  os << indent << "FlatnessRatio: " << this->FlatnessRatio << "\n";
  os << indent << "FreeInteriorPoints: " << this->FreeInteriorPoints << "\n";
  os << indent << "FreeBoundaryPoints: " << this->FreeBoundaryPoints << "\n";
  os << indent << "QualityBeforeDelaunay: " << this->QualityBeforeDelaunay << "\n";
  os << indent << "NumberOfPeeledTetrahedra: " << this->NumberOfPeeledTetrahedra << "\n";
  os << indent << "NumberOfFlips: " << this->NumberOfFlips << "\n";
  os << indent << "NumberOfMovedPoints: " << this->NumberOfMovedPoints << "\n";
  os << indent << "SmallestDihedralAngleBefore: " << this->SmallestDihedralAngleBefore << "\n";
  os << indent << "SmallestDihedralAngleAfter: " << this->SmallestDihedralAngleAfter << "\n";
}
