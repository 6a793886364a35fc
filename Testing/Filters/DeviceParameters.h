// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeviceParameters.h
 * @brief The sample devices: their parameters, and the volumes of their regions in closed form.
 */
#ifndef DeviceParameters_h
#define DeviceParameters_h

#include "DeviceBoundary.h"
#include "vtkTechnologyStructureSource.h"

#include <cmath>
#include <vector>

namespace testing_devices
{
struct Mos
{
  double GateLength = 0.18;
  double GateHeight = 0.2;
  double GateOxideThickness = 0.005;
  double SpacerWidth = 0.08;
  int SpacerSegments = 3;
  double BulkLength = 0.8;
  double BulkDepth = 0.5;
  double DeviceWidth = 0.3;
};

inline std::vector<ExpectedRegion> Apply(const Mos& mos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToMosTransistor();
  source->SetGateLength(mos.GateLength);
  source->SetGateHeight(mos.GateHeight);
  source->SetGateOxideThickness(mos.GateOxideThickness);
  source->SetSpacerWidth(mos.SpacerWidth);
  source->SetSpacerSegments(mos.SpacerSegments);
  source->SetBulkLength(mos.BulkLength);
  source->SetBulkDepth(mos.BulkDepth);
  source->SetDeviceWidth(mos.DeviceWidth);
  // Triangles with equal angles at the centre of an ellipse have equal areas.
  const double spacer = mos.SpacerWidth * mos.GateHeight * mos.DeviceWidth * 0.5 *
    mos.SpacerSegments * std::sin(0.5 * Pi / mos.SpacerSegments);
  return { { "Bulk", mos.BulkLength * mos.BulkDepth * mos.DeviceWidth, 2 },
    { "GateOxide",
      (mos.GateLength + 2.0 * mos.SpacerWidth) * mos.GateOxideThickness * mos.DeviceWidth, 2 },
    { "Gate", mos.GateLength * mos.GateHeight * mos.DeviceWidth, 2 }, { "LeftSpacer", spacer, 2 },
    { "RightSpacer", spacer, 2 } };
}

struct Via
{
  double ViaDiameter = 0.3;
  double ViaHeight = 0.6;
  int NumberOfSegments = 24;
  double BottomLineWidth = 0.4;
  double BottomLineThickness = 0.3;
  double TopLineWidth = 0.4;
  double TopLineThickness = 0.3;
  double BoxSize = 1.0;
};

inline std::vector<ExpectedRegion> Apply(const Via& via, vtkTechnologyStructureSource* source)
{
  source->SetStructureToViaPlug();
  source->SetViaDiameter(via.ViaDiameter);
  source->SetViaHeight(via.ViaHeight);
  source->SetNumberOfSegments(via.NumberOfSegments);
  source->SetBottomLineWidth(via.BottomLineWidth);
  source->SetBottomLineThickness(via.BottomLineThickness);
  source->SetTopLineWidth(via.TopLineWidth);
  source->SetTopLineThickness(via.TopLineThickness);
  source->SetBoxSize(via.BoxSize);
  const double plug = 0.125 * via.ViaDiameter * via.ViaDiameter * via.NumberOfSegments *
    std::sin(2.0 * Pi / via.NumberOfSegments);
  const double insulator =
    via.BottomLineThickness * via.BoxSize * (via.BoxSize - via.BottomLineWidth) +
    via.ViaHeight * (via.BoxSize * via.BoxSize - plug) +
    via.TopLineThickness * via.BoxSize * (via.BoxSize - via.TopLineWidth);
  return { { "Insulator", insulator, 0 },
    { "BottomLine", via.BottomLineThickness * via.BoxSize * via.BottomLineWidth, 2 },
    { "Plug", plug * via.ViaHeight, 2 },
    { "TopLine", via.TopLineThickness * via.BoxSize * via.TopLineWidth, 2 } };
}

struct Nmos
{
  double GateLength = 0.18;
  double GateHeight = 0.2;
  double GateOxideThickness = 0.005;
  double BulkLength = 0.8;
  double BulkDepth = 0.5;
  double DeviceWidth = 0.3;
  double ChannelWidth = 0.18;
  double FieldOxideThickness = 0.16;
  double CoverOxideThickness = 0.03;
};

inline std::vector<ExpectedRegion> Apply(const Nmos& nmos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToNmosWithFieldOxide();
  source->SetGateLength(nmos.GateLength);
  source->SetGateHeight(nmos.GateHeight);
  source->SetGateOxideThickness(nmos.GateOxideThickness);
  source->SetBulkLength(nmos.BulkLength);
  source->SetBulkDepth(nmos.BulkDepth);
  source->SetDeviceWidth(nmos.DeviceWidth);
  source->SetChannelWidth(nmos.ChannelWidth);
  source->SetFieldOxideThickness(nmos.FieldOxideThickness);
  source->SetCoverOxideThickness(nmos.CoverOxideThickness);
  const double width = nmos.DeviceWidth - nmos.ChannelWidth;
  const double field = 0.5 * nmos.FieldOxideThickness;
  const double cover = nmos.CoverOxideThickness;
  const double gateTop = nmos.GateOxideThickness + nmos.GateHeight;
  // The cover on the gate, on its two flanks, and on the field oxide and the silicon beside them.
  const double onGate = nmos.GateLength * nmos.DeviceWidth * cover;
  const double onFlanks =
    2.0 * cover * (nmos.ChannelWidth * (gateTop + cover) + width * (gateTop + cover - field));
  const double beside = (nmos.BulkLength - nmos.GateLength - 2.0 * cover) *
    (width * cover + 2.0 * cover * (field + cover) + (nmos.ChannelWidth - 2.0 * cover) * cover);
  const double oxide = nmos.GateLength * nmos.ChannelWidth * nmos.GateOxideThickness;
  return {
    { "Bulk",
      nmos.BulkLength * (nmos.ChannelWidth * nmos.BulkDepth + width * (nmos.BulkDepth - field)),
      2 },
    { "LeftFieldOxide", nmos.BulkLength * 0.5 * width * nmos.FieldOxideThickness, 2 },
    { "RightFieldOxide", nmos.BulkLength * 0.5 * width * nmos.FieldOxideThickness, 2 },
    { "GateOxide", oxide, 2 },
    { "Gate", nmos.GateLength * (nmos.ChannelWidth * nmos.GateHeight + width * (gateTop - field)),
      2 },
    { "CoverOxide", onGate + onFlanks + beside, 2 },
  };
}

struct Locos
{
  double BulkLength = 0.8;
  double BulkDepth = 0.5;
  double DeviceWidth = 0.3;
  double FieldOxideThickness = 0.16;
  double PadOxideThickness = 0.02;
  double NitrideThickness = 0.1;
  double StepLength = 0.1;
  int ProfileSegments = 6;
};

inline std::vector<ExpectedRegion> Apply(const Locos& locos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToLocos();
  source->SetBulkLength(locos.BulkLength);
  source->SetBulkDepth(locos.BulkDepth);
  source->SetDeviceWidth(locos.DeviceWidth);
  source->SetFieldOxideThickness(locos.FieldOxideThickness);
  source->SetPadOxideThickness(locos.PadOxideThickness);
  source->SetNitrideThickness(locos.NitrideThickness);
  source->SetStepLength(locos.StepLength);
  source->SetProfileSegments(locos.ProfileSegments);
  // Under the profile: trapezoids between the places where the cosine is taken, then a rectangle.
  std::vector<double> places;
  for (int i = 0; i <= locos.ProfileSegments; ++i)
  {
    places.push_back(locos.StepLength * (static_cast<double>(i) / locos.ProfileSegments - 1.0));
  }
  const int beyond = (locos.ProfileSegments + 1) / 2;
  for (int i = 1; i <= beyond; ++i)
  {
    places.push_back(0.5 * locos.StepLength * i / beyond);
  }
  const auto getProfile = [&](double x)
  { return 0.5 - 0.5 * std::cos(Pi * (x + locos.StepLength) / (1.5 * locos.StepLength)); };
  double profile = 0.5 * locos.BulkLength - places.back();
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    profile +=
      0.5 * (places[i] - places[i - 1]) * (getProfile(places[i - 1]) + getProfile(places[i]));
  }
  const double grown =
    (locos.FieldOxideThickness - locos.PadOxideThickness) * profile * locos.DeviceWidth;
  const double area = locos.BulkLength * locos.DeviceWidth;
  return { { "Bulk", area * locos.BulkDepth - 0.44 * grown, 2 },
    { "FieldOxide", area * locos.PadOxideThickness + grown, 2 },
    { "Nitride", 0.5 * area * locos.NitrideThickness, 2 } };
}

struct Dram
{
  double LinePitch = 0.4;
  double LineWidth = 0.16;
  double LineThickness = 0.2;
  double InsulatorThickness = 0.15;
  double SidewallAngle = 5.0;
  int NumberOfWordLines = 8;
  int NumberOfBitLines = 2;
};

inline std::vector<ExpectedRegion> Apply(const Dram& dram, vtkTechnologyStructureSource* source)
{
  source->SetStructureToDramInterconnect();
  source->SetLinePitch(dram.LinePitch);
  source->SetLineWidth(dram.LineWidth);
  source->SetLineThickness(dram.LineThickness);
  source->SetInsulatorThickness(dram.InsulatorThickness);
  source->SetSidewallAngle(dram.SidewallAngle);
  source->SetNumberOfWordLines(dram.NumberOfWordLines);
  source->SetNumberOfBitLines(dram.NumberOfBitLines);
  const double lengthX = dram.LinePitch * dram.NumberOfBitLines;
  const double lengthY = dram.LinePitch * dram.NumberOfWordLines;
  const double height = 3.0 * dram.InsulatorThickness + 2.0 * dram.LineThickness;
  // Trapezoids, and frustums of square pyramids.
  const double slope = std::tan(Pi / 180.0 * dram.SidewallAngle);
  const double section = dram.LineThickness * (dram.LineWidth - slope * dram.LineThickness);
  const double plugHeight = 2.0 * dram.InsulatorThickness + dram.LineThickness;
  const double narrow = dram.LineWidth - 2.0 * slope * dram.LineThickness;
  const double plug = plugHeight / 3.0 *
    (narrow * narrow + narrow * dram.LineWidth + dram.LineWidth * dram.LineWidth);
  std::vector<ExpectedRegion> regions{ { "Insulator", lengthX * lengthY * height, 2 } };
  for (int i = 1; i <= dram.NumberOfWordLines; ++i)
  {
    regions.push_back({ "WordLine" + std::to_string(i), section * lengthX, 2 });
  }
  int tunnels = dram.NumberOfWordLines + dram.NumberOfBitLines;
  for (int i = 1; i <= dram.NumberOfBitLines; ++i)
  {
    // Plugs in every other gap, beginning with the second and the first by turns.
    const int plugs = (dram.NumberOfWordLines - i % 2) / 2;
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

struct TwoLayer
{
  double LinePitch = 0.4;
  double LineWidth = 0.16;
  double LineThickness = 0.2;
  double InsulatorThickness = 0.15;
  double BulkDepth = 0.5;
  double StepLength = 0.1;
  int ProfileSegments = 6;
};

inline std::vector<ExpectedRegion> Apply(
  const TwoLayer& lines, vtkTechnologyStructureSource* source)
{
  source->SetStructureToTwoLayerInterconnect();
  source->SetLinePitch(lines.LinePitch);
  source->SetLineWidth(lines.LineWidth);
  source->SetLineThickness(lines.LineThickness);
  source->SetInsulatorThickness(lines.InsulatorThickness);
  source->SetBulkDepth(lines.BulkDepth);
  source->SetStepLength(lines.StepLength);
  source->SetProfileSegments(lines.ProfileSegments);
  const double size = 2.0 * lines.LinePitch;
  const double line = lines.LineWidth * lines.LineThickness * size;
  // A step is symmetric to its middle: it has half of the area that a full step would have.
  const double oxide =
    size * size * lines.InsulatorThickness + 2.0 * size * lines.LineThickness * lines.StepLength;
  return { { "Bulk", size * size * lines.BulkDepth, 2 }, { "Oxide", oxide, 2 },
    { "LowerLine1", line, 2 }, { "LowerLine2", line, 2 }, { "UpperLine1", line, 2 },
    { "UpperLine2", line, 2 } };
}

struct LinedVia
{
  bool HasTrench = false;
  double ViaDiameter = 0.3;
  double ViaHeight = 0.6;
  int NumberOfSegments = 24;
  double BottomLineThickness = 0.3;
  double BarrierThickness = 0.03;
  double BarrierAsymmetry = 0.0;
  double GasHeight = 0.4;
  double BoxSize = 1.0;
  double TrenchWidth = 0.5;
  double TrenchDepth = 0.3;
};

inline std::vector<ExpectedRegion> Apply(const LinedVia& via, vtkTechnologyStructureSource* source)
{
  via.HasTrench ? source->SetStructureToDamascene() : source->SetStructureToViaWithBarrier();
  source->SetViaDiameter(via.ViaDiameter);
  source->SetViaHeight(via.ViaHeight);
  source->SetNumberOfSegments(via.NumberOfSegments);
  source->SetBottomLineThickness(via.BottomLineThickness);
  source->SetBarrierThickness(via.BarrierThickness);
  source->SetBarrierAsymmetry(via.BarrierAsymmetry);
  source->SetGasHeight(via.GasHeight);
  source->SetBoxSize(via.BoxSize);
  source->SetTrenchWidth(via.TrenchWidth);
  source->SetTrenchDepth(via.TrenchDepth);
  const auto getArea = [&](double diameter)
  {
    return 0.125 * diameter * diameter * via.NumberOfSegments *
      std::sin(2.0 * Pi / via.NumberOfSegments);
  };
  const double area = via.BoxSize * via.BoxSize;
  const double depth = via.HasTrench ? via.TrenchDepth : 0.0;
  const double insulator = area * (via.ViaHeight + depth) -
    getArea(via.ViaDiameter) * via.ViaHeight - via.TrenchWidth * via.BoxSize * depth;
  // The hole that the barrier leaves is as deep as the via, the trench as deep as it was.
  const double open = getArea(via.ViaDiameter - 2.0 * via.BarrierThickness) * via.ViaHeight +
    (via.TrenchWidth - 2.0 * via.BarrierThickness) * via.BoxSize * depth;
  return { { "Insulator", insulator, 0 }, { "BottomMetal", area * via.BottomLineThickness, 2 },
    { "Barrier", area * (via.ViaHeight + depth + via.BarrierThickness) - insulator - open, 2 },
    { "Gas", open + area * via.GasHeight, 2 } };
}

struct Cmos
{
  double GateLength = 0.18;
  double GateHeight = 0.2;
  double GateOxideThickness = 0.005;
  double SpacerWidth = 0.08;
  int SpacerSegments = 3;
  double BulkDepth = 0.5;
  double ChannelWidth = 0.18;
  double DiffusionLength = 0.3;
  double ContactWidth = 0.12;
  double TrenchWidth = 0.5;
  double TrenchDepth = 0.3;
  double InsulatorThickness = 0.15;
  double LineThickness = 0.2;
  double PassivationThickness = 0.0;
};

inline std::vector<ExpectedRegion> Apply(const Cmos& cmos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToCmosInverter();
  source->SetGateLength(cmos.GateLength);
  source->SetGateHeight(cmos.GateHeight);
  source->SetGateOxideThickness(cmos.GateOxideThickness);
  source->SetSpacerWidth(cmos.SpacerWidth);
  source->SetSpacerSegments(cmos.SpacerSegments);
  source->SetBulkDepth(cmos.BulkDepth);
  source->SetChannelWidth(cmos.ChannelWidth);
  source->SetDiffusionLength(cmos.DiffusionLength);
  source->SetContactWidth(cmos.ContactWidth);
  source->SetTrenchWidth(cmos.TrenchWidth);
  source->SetTrenchDepth(cmos.TrenchDepth);
  source->SetInsulatorThickness(cmos.InsulatorThickness);
  source->SetLineThickness(cmos.LineThickness);
  source->SetPassivationThickness(cmos.PassivationThickness);
  const double contact = cmos.ContactWidth;
  const double activeLength = cmos.GateLength + 2.0 * (cmos.SpacerWidth + cmos.DiffusionLength);
  const double length = activeLength + 2.0 * cmos.TrenchWidth;
  const double width = 2.0 * (cmos.TrenchWidth + cmos.ChannelWidth) + 5.0 * contact;
  const double active = 2.0 * activeLength * cmos.ChannelWidth;
  // Gates end in the middle of the outer trench, and two contacts beyond the channel.
  const double gateWidth = 0.5 * cmos.TrenchWidth + cmos.ChannelWidth + 2.0 * contact;
  const double gate = cmos.GateLength * cmos.GateHeight * gateWidth;
  const double spacer = cmos.SpacerWidth * cmos.GateHeight * gateWidth * 0.5 * cmos.SpacerSegments *
    std::sin(0.5 * Pi / cmos.SpacerSegments);
  const double plug =
    contact * contact * (cmos.GateOxideThickness + cmos.GateHeight + cmos.InsulatorThickness);
  const double section = contact * cmos.LineThickness;
  // From the edge of the device over the trench to the far side of the contact.
  const double supply =
    plug + section * (cmos.TrenchWidth + 0.5 * cmos.DiffusionLength + 0.5 * contact);
  const double silicon =
    length * width * (cmos.BulkDepth - cmos.TrenchDepth) + active * cmos.TrenchDepth;
  const double oxide = (length * width - active) * cmos.TrenchDepth +
    (length * width - 4.0 * contact * contact) * cmos.GateOxideThickness;
  std::vector<ExpectedRegion> regions{ { "Silicon", silicon, 2 }, { "Oxide", oxide, -6 },
    { "NmosGate", gate, 2 }, { "PmosGate", gate, 2 }, { "NmosSourceSpacer", spacer, 2 },
    { "NmosDrainSpacer", spacer, 2 }, { "PmosSourceSpacer", spacer, 2 },
    { "PmosDrainSpacer", spacer, 2 }, { "Ground", supply, 2 }, { "Supply", supply, 2 },
    { "Input", 2.0 * contact * contact * cmos.InsulatorThickness + 4.0 * contact * section, 2 },
    { "Output", 2.0 * plug + (cmos.ChannelWidth + 6.0 * contact) * section, 2 } };
  if (cmos.PassivationThickness > 0.0)
  {
    double rest = length * width *
      (cmos.BulkDepth + cmos.GateOxideThickness + cmos.GateHeight + cmos.InsulatorThickness +
        cmos.LineThickness + cmos.PassivationThickness);
    for (const ExpectedRegion& region : regions)
    {
      rest -= region.Volume;
    }
    // A tunnel under each of the four metal lines.
    regions.push_back({ "Passivation", rest, -6 });
  }
  return regions;
}
} // namespace testing_devices

#endif
