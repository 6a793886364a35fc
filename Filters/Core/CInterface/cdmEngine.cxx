// SPDX-License-Identifier: BSD-3-Clause
#include "Core/CInterface/cdmEngine.h"

#include "Core/CInterface/NamedArrays.h"
#include "Core/CInterface/Stages.h"

#include <atomic>
#include <exception>
#include <iterator>
#include <new>

namespace
{
template <class T>
int SetInput(cdmArrays* arrays, const char* name, const T* values, std::int64_t count)
{
  const cdm::Status status = cdm::RunGuarded(
    [&]() -> cdm::Status
    {
      arrays->Inputs[name] = std::vector<T>(values, values + count);
      return {};
    });
  return static_cast<int>(status.Code);
}

cdm::ExecutionContext MakeContext(const cdmCallbacks& callbacks, std::atomic<bool>& isAborted)
{
  cdm::ExecutionContext::ProgressFunction progress;
  if (callbacks.Progress)
  {
    progress = [&callbacks, &isAborted](double fraction, const char* activity)
    {
      if (callbacks.Progress(fraction, activity, callbacks.Data) != 0)
      {
        isAborted = true;
      }
    };
  }
  return { progress, [&isAborted] { return isAborted.load(); }, callbacks.NumberOfThreads };
}

cdm::SizingField MakeSizing(const cdmCallbacks& callbacks, std::atomic<bool>& isBad)
{
  if (!callbacks.Sizing)
  {
    return {};
  }
  return [&callbacks, &isBad](const cdm::Vec3& position) -> cdm::LocalSpacing
  {
    const double x[3] = { position.X, position.Y, position.Z };
    const double length = callbacks.Sizing(x, callbacks.Data);
    if (!(length > 0.0))
    {
      isBad = true;
      // Finite and out of the way: the stage ends soon.
      return 1e300;
    }
    return length;
  };
}
} // namespace

//--------------------------------------------------------------------------------------------------
const char* cdmGetVersion(void)
{
  return CDM_VERSION;
}

cdmArrays* cdmNewArrays(void)
{
  return new (std::nothrow) cdmArrays;
}

void cdmDeleteArrays(cdmArrays* arrays)
{
  delete arrays;
}

int cdmSetReals(cdmArrays* arrays, const char* name, const double* values, int64_t count)
{
  return SetInput(arrays, name, values, count);
}

int cdmSetIntegers(cdmArrays* arrays, const char* name, const int64_t* values, int64_t count)
{
  return SetInput(arrays, name, values, count);
}

int64_t cdmGetNumberOfArrays(const cdmArrays* arrays)
{
  return static_cast<int64_t>(arrays->Outputs.size());
}

const char* cdmGetName(const cdmArrays* arrays, int64_t index)
{
  return index >= 0 && index < cdmGetNumberOfArrays(arrays)
    ? std::next(arrays->Outputs.begin(), static_cast<std::ptrdiff_t>(index))->first.c_str()
    : nullptr;
}

const void* cdmGetValues(
  const cdmArrays* arrays, const char* name, int* type, int64_t* count, int* components)
{
  const auto found = arrays->Outputs.find(name);
  if (found == arrays->Outputs.end())
  {
    return nullptr;
  }
  *type = found->second.Type;
  *count = found->second.Count;
  *components = found->second.Components;
  return found->second.Values;
}

int cdmRun(
  const char* stage, const cdmArrays* input, cdmArrays* output, const cdmCallbacks* callbacks)
{
  const cdmCallbacks none = { nullptr, nullptr, nullptr, 0 };
  const cdmCallbacks& called = callbacks ? *callbacks : none;
  std::atomic<bool> isAborted{ false };
  std::atomic<bool> isSizingBad{ false };
  cdm::Status status;
  try
  {
    status = cdm::RunGuarded(
      [&]
      {
        return cdm::RunStage(
          stage, *input, MakeSizing(called, isSizingBad), MakeContext(called, isAborted), *output);
      });
    if (isSizingBad && !status.IsAborted())
    {
      status =
        cdm::Status::InvalidInput("The sizing function returned a length that is not positive.");
      output->Outputs.clear();
    }
    if (!status.IsOk())
    {
      cdm::OutputWriter writer(*output);
      writer.Write("error", status.Message);
      writer.Write("error_cells", status.Cells);
      writer.Write("error_points", status.Points);
    }
  }
  catch (const std::exception&)
  {
    // Only memory for the message itself can be missing here.
    return static_cast<int>(cdm::StatusCode::OutOfMemory);
  }
  return static_cast<int>(status.Code);
}
