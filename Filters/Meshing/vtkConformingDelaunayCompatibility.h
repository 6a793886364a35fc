// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkConformingDelaunayCompatibility.h
 * @brief The differences between VTK 9.1 and 9.2 that the filters meet, in one place.
 *
 * VTK 9.2 has vtkAlgorithm::CheckAbort(), which also sees aborts of filters upstream. After it
 * returned true the executive empties the outputs, unless AbortOutput is taken back. VTK 9.1 has
 * the flag AbortExecute only, and leaves the outputs as the filter made them.
 */
#ifndef vtkConformingDelaunayCompatibility_h
#define vtkConformingDelaunayCompatibility_h

#include <vtkAlgorithm.h>
#include <vtkVersionMacros.h>

namespace vtkConformingDelaunayCompatibility
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20221001)
inline bool CheckAbort(vtkAlgorithm* filter)
{
  return filter->CheckAbort();
}

inline void KeepOutputsOfAbortedRun(vtkAlgorithm* filter)
{
  filter->SetAbortOutput(false);
}
#else
inline bool CheckAbort(vtkAlgorithm* filter)
{
  return filter->GetAbortExecute() != 0;
}

inline void KeepOutputsOfAbortedRun(vtkAlgorithm*) {}
#endif
} // namespace vtkConformingDelaunayCompatibility

#endif
