// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkConformingDelaunayRanges.h
 * @brief Setters that refuse values out of range, in place of those of vtkSetClampMacro().
 *
 * vtkSetClampMacro() takes the nearest value that is allowed and says nothing: a length of -5
 * became 0, which means "no limit". With vtkSetInRangeMacro() a value out of range, or one that is
 * not a number, is an error that names the property, the value, the range and the unit. The
 * property keeps its value, and the filter is not modified. Values in range are set as before.
 *
 * Wrappers read this header where a class includes it: SetX(), GetXMinValue() and GetXMaxValue() are
 * wrapped as those of vtkSetClampMacro() are. The panels in ParaView offer the same ranges
 * (Plugin/<class>.xml), which the test plugin.Help checks.
 */
#ifndef vtkConformingDelaunayRanges_h
#define vtkConformingDelaunayRanges_h

#include "cdmMeshingModule.h" // For export macro

#include <string>

namespace vtkConformingDelaunayRanges
{
/**
 * The message of an error: which value a property cannot have, which ones it can have, and which
 * one it keeps. A largest value of VTK_DOUBLE_MAX or VTK_INT_MAX stands for none, a smallest value
 * that is the smallest positive double for "above 0".
 */
CDMMESHING_EXPORT std::string Refuse(
  const char* name, double value, double kept, double smallest, double largest, const char* unit);
CDMMESHING_EXPORT std::string Refuse(
  const char* name, int value, int kept, int smallest, int largest, const char* unit);
} // namespace vtkConformingDelaunayRanges

/**
 * Makes SetX(), GetXMinValue() and GetXMaxValue() of a property X of type int or double. Both ends
 * are in the range; unit is a text for the message: a unit, what is counted, or an enumeration.
 */
#define vtkSetInRangeMacro(name, type, smallest, largest, unit)                                    \
  virtual void Set##name(type value)                                                               \
  {                                                                                                \
    vtkDebugMacro(<< " setting " #name " to " << value);                                           \
    if (!(value >= (smallest) && value <= (largest)))                                              \
    {                                                                                              \
      vtkErrorMacro(<< vtkConformingDelaunayRanges::Refuse(                                        \
                      #name, value, this->name, smallest, largest, unit));                         \
      return;                                                                                      \
    }                                                                                              \
    if (this->name != value)                                                                       \
    {                                                                                              \
      this->name = value;                                                                          \
      this->Modified();                                                                            \
    }                                                                                              \
  }                                                                                                \
  virtual type Get##name##MinValue()                                                               \
  {                                                                                                \
    return smallest;                                                                               \
  }                                                                                                \
  virtual type Get##name##MaxValue()                                                               \
  {                                                                                                \
    return largest;                                                                                \
  }

#endif
