// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeviceRegions.h
 * @brief The regions of the sample devices: what their volumes are in closed form.
 */
#ifndef DeviceRegions_h
#define DeviceRegions_h

#include "DeviceBoundary.h"
#include "vtkTechnologyStructureSource.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace testing_devices
{
/** Triangles with equal angles at the centre of an ellipse have equal areas. */
inline double GetSpacerArea(vtkTechnologyStructureSource* source)
{
  const int segments = source->GetSpacerSegments();
  return source->GetSpacerWidth() * source->GetGateHeight() * 0.5 * segments *
    std::sin(0.5 * Pi / segments);
}

/** Cross-section of a via, a regular polygon. */
inline double GetViaArea(vtkTechnologyStructureSource* source, double diameter)
{
  const int segments = source->GetNumberOfSegments();
  return 0.125 * diameter * diameter * segments * std::sin(2.0 * Pi / segments);
}

inline std::vector<ExpectedRegion> GetMosRegions(vtkTechnologyStructureSource* source)
{
  const double width = source->GetDeviceWidth();
  const double spacer = GetSpacerArea(source) * width;
  const double oxideLength = source->GetGateLength() + 2.0 * source->GetSpacerWidth();
  return { { "Bulk", source->GetBulkLength() * source->GetBulkDepth() * width, 2 },
    { "GateOxide", oxideLength * source->GetGateOxideThickness() * width, 2 },
    { "Gate", source->GetGateLength() * source->GetGateHeight() * width, 2 },
    { "LeftSpacer", spacer, 2 }, { "RightSpacer", spacer, 2 } };
}

inline std::vector<ExpectedRegion> GetViaPlugRegions(vtkTechnologyStructureSource* source)
{
  const double size = source->GetBoxSize();
  const double height = source->GetViaHeight();
  const double plug = GetViaArea(source, source->GetViaDiameter());
  const double bottom = source->GetBottomLineThickness() * size;
  const double top = source->GetTopLineThickness() * size;
  const double insulator = bottom * (size - source->GetBottomLineWidth()) +
    height * (size * size - plug) + top * (size - source->GetTopLineWidth());
  return { { "Insulator", insulator, 0 },
    { "BottomLine", bottom * source->GetBottomLineWidth(), 2 }, { "Plug", plug * height, 2 },
    { "TopLine", top * source->GetTopLineWidth(), 2 } };
}

inline std::vector<ExpectedRegion> GetNmosRegions(vtkTechnologyStructureSource* source)
{
  const double length = source->GetBulkLength();
  const double depth = source->GetBulkDepth();
  const double gateLength = source->GetGateLength();
  const double channel = source->GetChannelWidth();
  const double width = source->GetDeviceWidth() - channel;
  const double field = 0.5 * source->GetFieldOxideThickness();
  const double cover = source->GetCoverOxideThickness();
  const double gateTop = source->GetGateOxideThickness() + source->GetGateHeight();
  const double fieldOxide = length * width * field;
  const double gateSection = channel * source->GetGateHeight() + width * (gateTop - field);
  // The cover on the gate, on its two flanks, and on the field oxide and the silicon beside them.
  const double onGate = gateLength * source->GetDeviceWidth() * cover;
  const double onFlanks =
    2.0 * cover * (channel * (gateTop + cover) + width * (gateTop + cover - field));
  const double beside = (length - gateLength - 2.0 * cover) *
    (width * cover + 2.0 * cover * (field + cover) + (channel - 2.0 * cover) * cover);
  return { { "Bulk", length * (channel * depth + width * (depth - field)), 2 },
    { "LeftFieldOxide", fieldOxide, 2 }, { "RightFieldOxide", fieldOxide, 2 },
    { "GateOxide", gateLength * channel * source->GetGateOxideThickness(), 2 },
    { "Gate", gateLength * gateSection, 2 }, { "CoverOxide", onGate + onFlanks + beside, 2 } };
}

inline std::vector<ExpectedRegion> GetLocosRegions(vtkTechnologyStructureSource* source)
{
  const double pad = source->GetPadOxideThickness();
  const double step = source->GetStepLength();
  const int segments = source->GetProfileSegments();
  // Under the profile: trapezoids between the places where the cosine is taken, then a rectangle.
  std::vector<double> places;
  for (int i = 0; i <= segments; ++i)
  {
    places.push_back(step * (static_cast<double>(i) / segments - 1.0));
  }
  const int beyond = (segments + 1) / 2;
  for (int i = 1; i <= beyond; ++i)
  {
    places.push_back(0.5 * step * i / beyond);
  }
  const auto getProfile = [&](double x)
  { return 0.5 - 0.5 * std::cos(Pi * (x + step) / (1.5 * step)); };
  double profile = 0.5 * source->GetBulkLength() - places.back();
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    profile +=
      0.5 * (places[i] - places[i - 1]) * (getProfile(places[i - 1]) + getProfile(places[i]));
  }
  const double grown =
    (source->GetFieldOxideThickness() - pad) * profile * source->GetDeviceWidth();
  const double area = source->GetBulkLength() * source->GetDeviceWidth();
  return { { "Bulk", area * source->GetBulkDepth() - 0.44 * grown, 2 },
    { "FieldOxide", area * pad + grown, 2 },
    { "Nitride", 0.5 * area * source->GetNitrideThickness(), 2 } };
}

inline std::vector<ExpectedRegion> GetDramRegions(vtkTechnologyStructureSource* source)
{
  const int wordLines = source->GetNumberOfWordLines();
  const int bitLines = source->GetNumberOfBitLines();
  const double lengthX = source->GetLinePitch() * bitLines;
  const double lengthY = source->GetLinePitch() * wordLines;
  const double width = source->GetLineWidth();
  const double thickness = source->GetLineThickness();
  const double insulator = source->GetInsulatorThickness();
  // Trapezoids, and frustums of square pyramids.
  const double slope = std::tan(Pi / 180.0 * source->GetSidewallAngle());
  const double section = thickness * (width - slope * thickness);
  const double narrow = width - 2.0 * slope * thickness;
  const double plug =
    (2.0 * insulator + thickness) / 3.0 * (narrow * narrow + narrow * width + width * width);
  std::vector<ExpectedRegion> regions{ { "Insulator",
    lengthX * lengthY * (3.0 * insulator + 2.0 * thickness), 2 } };
  for (int i = 1; i <= wordLines; ++i)
  {
    regions.push_back({ "WordLine" + std::to_string(i), section * lengthX, 2 });
  }
  int tunnels = wordLines + bitLines;
  for (int i = 1; i <= bitLines; ++i)
  {
    // Plugs in every other gap, beginning with the second and the first by turns.
    const int plugs = (wordLines - i % 2) / 2;
    regions.push_back({ "BitLine" + std::to_string(i), section * lengthY + plugs * plug, 2 });
    tunnels += plugs;
  }
  for (std::size_t i = 1; i < regions.size(); ++i)
  {
    regions[0].Volume -= regions[i].Volume;
  }
  regions[0].EulerCharacteristic -= 2 * tunnels;
  return regions;
}

inline std::vector<ExpectedRegion> GetTwoLayerRegions(vtkTechnologyStructureSource* source)
{
  const double size = 2.0 * source->GetLinePitch();
  const double thickness = source->GetLineThickness();
  const double line = source->GetLineWidth() * thickness * size;
  // A step is symmetric to its middle: it has half of the area that a full step would have.
  const double oxide = size * size * source->GetInsulatorThickness() +
    2.0 * size * thickness * source->GetStepLength();
  return { { "Bulk", size * size * source->GetBulkDepth(), 2 }, { "Oxide", oxide, 2 },
    { "LowerLine1", line, 2 }, { "LowerLine2", line, 2 }, { "UpperLine1", line, 2 },
    { "UpperLine2", line, 2 } };
}

/** Via with barrier, and damascene, which has a trench above the via. */
inline std::vector<ExpectedRegion> GetLinedViaRegions(vtkTechnologyStructureSource* source)
{
  const bool hasTrench = source->GetStructure() == vtkTechnologyStructureSource::DAMASCENE;
  const double size = source->GetBoxSize();
  const double area = size * size;
  const double diameter = source->GetViaDiameter();
  const double height = source->GetViaHeight();
  const double barrier = source->GetBarrierThickness();
  const double trench = source->GetTrenchWidth();
  const double depth = hasTrench ? source->GetTrenchDepth() : 0.0;
  const double insulator =
    area * (height + depth) - GetViaArea(source, diameter) * height - trench * size * depth;
  // The hole that the barrier leaves is as deep as the via, the trench as deep as it was.
  const double open =
    GetViaArea(source, diameter - 2.0 * barrier) * height + (trench - 2.0 * barrier) * size * depth;
  return { { "Insulator", insulator, 0 },
    { "BottomMetal", area * source->GetBottomLineThickness(), 2 },
    { "Barrier", area * (height + depth + barrier) - insulator - open, 2 },
    { "Gas", open + area * source->GetGasHeight(), 2 } };
}

inline std::vector<ExpectedRegion> GetCmosRegions(vtkTechnologyStructureSource* source)
{
  const double contact = source->GetContactWidth();
  const double channel = source->GetChannelWidth();
  const double diffusion = source->GetDiffusionLength();
  const double trench = source->GetTrenchWidth();
  const double trenchDepth = source->GetTrenchDepth();
  const double thickness = source->GetLineThickness();
  const double insulator = source->GetInsulatorThickness();
  const double oxideThickness = source->GetGateOxideThickness();
  const double activeLength =
    source->GetGateLength() + 2.0 * (source->GetSpacerWidth() + diffusion);
  const double active = 2.0 * activeLength * channel;
  const double area = (activeLength + 2.0 * trench) * (2.0 * (trench + channel) + 5.0 * contact);
  // Gates end in the middle of the outer trench, and two contacts beyond the channel.
  const double gateWidth = 0.5 * trench + channel + 2.0 * contact;
  const double gate = source->GetGateLength() * source->GetGateHeight() * gateWidth;
  const double spacer = GetSpacerArea(source) * gateWidth;
  const double plugHeight = oxideThickness + source->GetGateHeight() + insulator;
  const double plug = contact * contact * plugHeight;
  const double section = contact * thickness;
  // From the edge of the device over the trench to the far side of the contact.
  const double supply = plug + section * (trench + 0.5 * diffusion + 0.5 * contact);
  const double silicon = area * (source->GetBulkDepth() - trenchDepth) + active * trenchDepth;
  const double oxide =
    (area - active) * trenchDepth + (area - 4.0 * contact * contact) * oxideThickness;
  std::vector<ExpectedRegion> regions{ { "Silicon", silicon, 2 }, { "Oxide", oxide, -6 },
    { "NmosGate", gate, 2 }, { "PmosGate", gate, 2 }, { "NmosSourceSpacer", spacer, 2 },
    { "NmosDrainSpacer", spacer, 2 }, { "PmosSourceSpacer", spacer, 2 },
    { "PmosDrainSpacer", spacer, 2 }, { "Ground", supply, 2 }, { "Supply", supply, 2 },
    { "Input", 2.0 * contact * contact * insulator + 4.0 * contact * section, 2 },
    { "Output", 2.0 * plug + (channel + 6.0 * contact) * section, 2 } };
  const double passivation = source->GetPassivationThickness();
  if (passivation > 0.0)
  {
    double rest = area * (source->GetBulkDepth() + plugHeight + thickness + passivation);
    for (const ExpectedRegion& region : regions)
    {
      rest -= region.Volume;
    }
    // A tunnel under each of the four metal lines.
    regions.push_back({ "Passivation", rest, -6 });
  }
  return regions;
}

/** The regions of the device that the source is set to make, by region id. */
inline std::vector<ExpectedRegion> GetExpectedRegions(vtkTechnologyStructureSource* source)
{
  switch (source->GetStructure())
  {
    case vtkTechnologyStructureSource::MOS_TRANSISTOR:
      return GetMosRegions(source);
    case vtkTechnologyStructureSource::VIA_PLUG:
      return GetViaPlugRegions(source);
    case vtkTechnologyStructureSource::NMOS_WITH_FIELD_OXIDE:
      return GetNmosRegions(source);
    case vtkTechnologyStructureSource::LOCOS:
      return GetLocosRegions(source);
    case vtkTechnologyStructureSource::DRAM_INTERCONNECT:
      return GetDramRegions(source);
    case vtkTechnologyStructureSource::TWO_LAYER_INTERCONNECT:
      return GetTwoLayerRegions(source);
    case vtkTechnologyStructureSource::VIA_WITH_BARRIER:
    case vtkTechnologyStructureSource::DAMASCENE:
      return GetLinedViaRegions(source);
    case vtkTechnologyStructureSource::CMOS_INVERTER:
      return GetCmosRegions(source);
    default:
      ADD_FAILURE() << "no closed form for structure " << source->GetStructure();
      return {};
  }
}
} // namespace testing_devices

#endif
