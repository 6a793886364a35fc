// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Execution.h
 * @brief How filters run the engine: progress, abort and threads.
 */
#ifndef CoreBridge_Execution_h
#define CoreBridge_Execution_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/ParallelLoop.h"

#include <cstddef>

class vtkAlgorithm;
class vtkDataSet;
class vtkInformationVector;

namespace vtkCoreBridge
{
/** Progress and abort of a filter for the engine, and GetNumberOfThreads() threads. */
cdm::ExecutionContext MakeContext(vtkAlgorithm* filter);

/**
 * How many threads filters may use: as many as vtkSMPTools. The engine has threads of its own, so
 * that it needs no backend that has some, and that of Debian's ParaView has none: with the
 * sequential one it takes the number of vtkSMPTools::Initialize(), or else of VTK_SMP_MAX_THREADS,
 * or else one for each core that this process has to itself. One thread if the sequential backend
 * is asked for by VTK_SMP_BACKEND_IN_USE.
 */
int GetNumberOfThreads();

/** body(i) for all items, on so many threads; for short work, without progress. */
template <typename Body>
void ForEach(std::size_t count, const Body& body)
{
  cdm::ParallelLoop(count, { GetNumberOfThreads(), std::size_t(1) << 14 }, {}, "",
    [&body](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        body(i);
      }
    });
}

/**
 * True for an empty input on a process of a parallel run: readers that are not parallel fill the
 * first process only, and the others have nothing to do and nothing to complain about.
 */
bool IsIdleProcess(vtkDataSet* input, vtkInformationVector* outputs);
} // namespace vtkCoreBridge

#endif
