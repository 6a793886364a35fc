// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDistributedTetrahedralizer.h"

#include "CoreBridge/Execution.h"
#include "CoreBridge/Reports.h"
#include "Distributed/DistributedMesh.h"
#include "Distributed/ProcessGroup.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkDistributedTetrahedralizer);
vtkCxxSetObjectMacro(vtkDistributedTetrahedralizer, Controller, vtkMultiProcessController);

//--------------------------------------------------------------------------------------------------
vtkDistributedTetrahedralizer::vtkDistributedTetrahedralizer()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

//--------------------------------------------------------------------------------------------------
vtkDistributedTetrahedralizer::~vtkDistributedTetrahedralizer()
{
  this->SetController(nullptr);
}

//--------------------------------------------------------------------------------------------------
int vtkDistributedTetrahedralizer::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  if (port > 0)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkDistributedTetrahedralizer::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkDistributedTetrahedralizer::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    outputVector->GetInformationObject(port)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkDistributedTetrahedralizer::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // Any pieces do, as long as all of them together are the input.
  const bool isAlone = !this->Controller || this->Controller->GetNumberOfProcesses() < 2;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    if (vtkInformation* info = inputVector[port]->GetInformationObject(0))
    {
      info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER(),
        isAlone ? 0 : this->Controller->GetLocalProcessId());
      info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(),
        isAlone ? 1 : this->Controller->GetNumberOfProcesses());
      info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkDistributedTetrahedralizer::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPointSet* input = vtkPointSet::GetData(inputVector[0]);
  vtkInformation* info = outputVector->GetInformationObject(0);
  const auto ghostLevels = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS();
  vtkDistributed::ProcessGroup processes(this->Controller);
  const cdm::ExecutionContext context = vtkCoreBridge::MakeContext(this);
  vtkDistributed::DistributedMesh mesh(
    processes, context, info->Has(ghostLevels) ? info->Get(ghostLevels) : 0);
  cdm::Status status = mesh.Run(input, vtkPointSet::GetData(inputVector[1]));
  this->NumberOfRounds = mesh.GetNumberOfRounds();
  this->NumberOfHaloPoints = mesh.GetNumberOfHaloPoints();
  this->NumberOfUnusedMeshPoints = mesh.GetNumberOfUnusedMeshPoints();
  if (status.IsOk())
  {
    status = processes.Do(
      [&]
      {
        mesh.MakeMesh(vtkUnstructuredGrid::GetData(outputVector, 0));
        mesh.MakeBoundary(vtkPolyData::GetData(outputVector, 1));
        return cdm::Status();
      });
  }
  this->NumberOfBytesSent = processes.GetNumberOfBytesSent();
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }
  if (this->NumberOfUnusedMeshPoints > 0 && processes.GetRank() == 0)
  {
    vtkWarningMacro("Left out " << this->NumberOfUnusedMeshPoints
                                << " mesh points that lie in no meshed region or are copies.");
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkDistributedTetrahedralizer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "NumberOfRounds: " << this->NumberOfRounds << "\n";
  os << indent << "NumberOfHaloPoints: " << this->NumberOfHaloPoints << "\n";
  os << indent << "NumberOfBytesSent: " << this->NumberOfBytesSent << "\n";
  os << indent << "NumberOfUnusedMeshPoints: " << this->NumberOfUnusedMeshPoints << "\n";
}
