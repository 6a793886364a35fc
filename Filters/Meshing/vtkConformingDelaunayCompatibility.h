// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkConformingDelaunayCompatibility.h
 * @brief The differences between VTK 9.1, 9.2 and 9.3 that the filters meet, in one place.
 *
 * VTK 9.2 has vtkAlgorithm::CheckAbort(), which also sees aborts of filters upstream. After it
 * returned true the executive empties the outputs, unless AbortOutput is taken back. VTK 9.1 has
 * the flag AbortExecute only, and leaves the outputs as the filter made them.
 *
 * In VTK 9.3 vtkNumberToString makes strings; before, it could be written to streams only.
 */
#ifndef vtkConformingDelaunayCompatibility_h
#define vtkConformingDelaunayCompatibility_h

#include <vtkAlgorithm.h>
#include <vtkNumberToString.h>
#include <vtkVersionMacros.h>

#include <sstream>
#include <string>

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

/** The shortest text that is read as the same number. */
inline std::string ToText(double number)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  vtkNumberToString converter;
  return converter.Convert(number);
#else
  const vtkNumberToString converter;
  std::ostringstream text;
  text << converter(number);
  return text.str();
#endif
}
} // namespace vtkConformingDelaunayCompatibility

#endif
