// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Execution.h"

#include "vtkConformingDelaunayCompatibility.h"

#include <vtkAlgorithm.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkSMPTools.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
cdm::ExecutionContext MakeContext(vtkAlgorithm* filter)
{
  // Stages may call in inner loops; observers (a GUI redraws) hear of steps that can be seen, and
  // now and then of none: they may want to abort.
  using Clock = std::chrono::steady_clock;
  constexpr double smallestStep = 0.005;
  static constexpr std::chrono::milliseconds longestSilence(200);
  double last = -1.0;
  std::string lastActivity;
  Clock::time_point lastTime;
  auto progress = [filter, last, lastActivity, lastTime](
                    double fraction, const char* activity) mutable
  {
    const Clock::time_point now = Clock::now();
    if (std::abs(fraction - last) >= smallestStep || lastActivity != activity ||
      now - lastTime >= longestSilence)
    {
      last = fraction;
      lastActivity = activity;
      lastTime = now;
      filter->SetProgressText(activity);
      filter->UpdateProgress(fraction);
    }
  };
  return { progress, [filter]() { return vtkConformingDelaunayCompatibility::CheckAbort(filter); },
    GetNumberOfThreads() };
}

//--------------------------------------------------------------------------------------------------
int GetNumberOfThreads()
{
  if (vtkSMPTools::GetBackend() != std::string("Sequential") ||
    std::getenv("VTK_SMP_BACKEND_IN_USE") != nullptr)
  {
    return vtkSMPTools::GetEstimatedNumberOfThreads();
  }
  // The sequential backend does not say which number was asked for.
  const int asked =
    vtk::detail::smp::vtkSMPToolsAPI::GetInstance().GetInternalDesiredNumberOfThread();
  const char* const most = std::getenv("VTK_SMP_MAX_THREADS");
  const int wanted = asked <= 0 && most != nullptr ? std::atoi(most) : asked;
  if (wanted > 0)
  {
    return wanted;
  }
  vtkMultiProcessController* const controller = vtkMultiProcessController::GetGlobalController();
  const int processes = controller != nullptr ? controller->GetNumberOfProcesses() : 1;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores / std::max(1, processes));
}

//--------------------------------------------------------------------------------------------------
bool IsIdleProcess(vtkDataSet* input, vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const auto pieces = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES();
  return info->Has(pieces) && info->Get(pieces) > 1 && input->GetNumberOfCells() == 0;
}
} // namespace vtkCoreBridge
