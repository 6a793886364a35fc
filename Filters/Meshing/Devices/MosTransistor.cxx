// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "Devices/LayeredStructure.h"

namespace cdm
{
std::string MakeMosTransistor(const MosParameters& p, Device& device)
{
  std::string problem = CheckLengths({ { "GateLength", p.GateLength },
    { "GateHeight", p.GateHeight }, { "GateOxideThickness", p.GateOxideThickness },
    { "SpacerWidth", p.SpacerWidth }, { "BulkLength", p.BulkLength }, { "BulkDepth", p.BulkDepth },
    { "DeviceWidth", p.DeviceWidth } });
  if (problem.empty())
  {
    problem = CheckLess({ "GateLength + 2 SpacerWidth", p.GateLength + 2.0 * p.SpacerWidth },
      { "BulkLength", p.BulkLength });
  }
  if (!problem.empty())
  {
    return problem;
  }

  // The right half of the cross-section; the left one is its exact mirror image.
  const double gateEdge = 0.5 * p.GateLength;
  const double gateTop = p.GateOxideThickness + p.GateHeight;
  std::vector<double> flankX{ gateEdge };
  std::vector<double> flankZ{ gateTop };
  for (int i = 1; i < p.SpacerSegments; ++i)
  {
    const CosineSine direction = GetCosineSine(90.0 * i / p.SpacerSegments);
    flankX.push_back(gateEdge + p.SpacerWidth * direction.Sine);
    flankZ.push_back(p.GateOxideThickness + p.GateHeight * direction.Cosine);
  }
  flankX.push_back(gateEdge + p.SpacerWidth);
  flankZ.push_back(p.GateOxideThickness);
  std::vector<double> positionsX = flankX;
  positionsX.push_back(0.5 * p.BulkLength);
  problem = CheckAscending(positionsX, "GateLength, SpacerWidth and BulkLength");
  if (problem.empty())
  {
    problem =
      CheckAscending({ flankZ.rbegin(), flankZ.rend() }, "GateOxideThickness and GateHeight");
  }
  if (!problem.empty())
  {
    return problem;
  }

  enum Region : Id
  {
    Bulk,
    GateOxide,
    Gate,
    LeftSpacer,
    RightSpacer
  };
  device.RegionNames = { "Bulk", "GateOxide", "Gate", "LeftSpacer", "RightSpacer" };
  LayeredStructure structure(1, 0.0);
  const double foot = flankX.back();
  const double bulkEdge = 0.5 * p.BulkLength;
  const Id bulkFootLeft = structure.AddVertex(-foot, 0.0);
  const Id bulkFootRight = structure.AddVertex(foot, 0.0);
  std::vector<Id> bulk{ structure.AddVertex(-bulkEdge, -p.BulkDepth),
    structure.AddVertex(bulkEdge, -p.BulkDepth), structure.AddVertex(bulkEdge, 0.0), bulkFootRight,
    bulkFootLeft, structure.AddVertex(-bulkEdge, 0.0) };

  // A spacer runs from the lower corner of the gate over its foot and up the flank.
  std::vector<Id> spacers[2];
  for (int side = 0; side < 2; ++side)
  {
    const double sign = side == 0 ? -1.0 : 1.0;
    spacers[side].push_back(structure.AddVertex(sign * gateEdge, p.GateOxideThickness));
    for (std::size_t i = flankX.size(); i-- > 0;)
    {
      spacers[side].push_back(structure.AddVertex(sign * flankX[i], flankZ[i]));
    }
  }
  const std::vector<Id>& left = spacers[0];
  const std::vector<Id>& right = spacers[1];
  std::vector<Id> oxide{ bulkFootLeft, bulkFootRight, right[1], right[0], left[0], left[1] };
  std::vector<Id> gate{ left[0], right[0], right.back(), left.back() };

  structure.AddCell(std::move(bulk));
  structure.AddCell(std::move(oxide));
  structure.AddCell(std::move(gate));
  structure.AddCell(std::move(spacers[0]));
  structure.AddCell(std::move(spacers[1]));
  structure.AddLayer(p.DeviceWidth, { Bulk, GateOxide, Gate, LeftSpacer, RightSpacer });
  device.Boundary = structure.MakeBoundary(device.FacetIds);
  device.Contacts = { { "SourceContact", { OutsideRegion, Bulk },
                        [](const Vec3& v) { return v.Z == 0.0 && v.X < 0.0; } },
    { "DrainContact", { OutsideRegion, Bulk },
      [](const Vec3& v) { return v.Z == 0.0 && v.X > 0.0; } },
    { "GateContact", { OutsideRegion, Gate }, [=](const Vec3& v) { return v.Z == gateTop; } },
    { "SubstrateContact", { OutsideRegion, Bulk },
      [=](const Vec3& v) { return v.Z == -p.BulkDepth; } } };
  return {};
}
} // namespace cdm
