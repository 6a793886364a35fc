// SPDX-License-Identifier: BSD-3-Clause
#include "vtkConformingDelaunayRanges.h"

#include "vtkConformingDelaunayCompatibility.h"

#include <vtkType.h>

#include <limits>

namespace
{
std::string Describe(const char* name, const std::string& value, const std::string& range,
  const char* unit, const std::string& kept)
{
  return std::string(name) + " cannot be " + value + ": give a " + range + " (" + unit +
    "). It stays " + kept + ".";
}
} // namespace

namespace vtkConformingDelaunayRanges
{
//--------------------------------------------------------------------------------------------------
std::string Refuse(
  const char* name, double value, double kept, double smallest, double largest, const char* unit)
{
  using vtkConformingDelaunayCompatibility::ToText;
  std::string range;
  if (largest < VTK_DOUBLE_MAX)
  {
    range = "number from " + ToText(smallest) + " to " + ToText(largest);
  }
  else if (smallest == std::numeric_limits<double>::min())
  {
    range = "finite number above 0";
  }
  else
  {
    range = "finite number from " + ToText(smallest) + " on";
  }
  return Describe(name, ToText(value), range, unit, ToText(kept));
}

//--------------------------------------------------------------------------------------------------
std::string Refuse(
  const char* name, int value, int kept, int smallest, int largest, const char* unit)
{
  const std::string range = "whole number from " + std::to_string(smallest) +
    (largest < VTK_INT_MAX ? " to " + std::to_string(largest) : " on");
  return Describe(name, std::to_string(value), range, unit, std::to_string(kept));
}
} // namespace vtkConformingDelaunayRanges
