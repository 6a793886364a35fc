// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <utility>

namespace cdm
{
std::string MakeNmosTransistor(const NmosParameters& p, Device& device)
{
  const double field = 0.5 * p.FieldOxideThickness;
  const double cover = p.CoverOxideThickness;
  const double gateTop = p.GateOxideThickness + p.GateHeight;
  std::string problem = CheckLengths({ { "GateLength", p.GateLength },
    { "GateHeight", p.GateHeight }, { "GateOxideThickness", p.GateOxideThickness },
    { "BulkLength", p.BulkLength }, { "BulkDepth", p.BulkDepth }, { "DeviceWidth", p.DeviceWidth },
    { "ChannelWidth", p.ChannelWidth }, { "FieldOxideThickness", p.FieldOxideThickness },
    { "CoverOxideThickness", p.CoverOxideThickness } });
  const std::pair<Parameter, Parameter> orders[] = {
    { { "GateLength + 2 CoverOxideThickness", p.GateLength + 2.0 * cover },
      { "BulkLength", p.BulkLength } },
    { { "2 CoverOxideThickness", 2.0 * cover }, { "ChannelWidth", p.ChannelWidth } },
    { { "ChannelWidth", p.ChannelWidth }, { "DeviceWidth", p.DeviceWidth } },
    { { "FieldOxideThickness / 2", field }, { "BulkDepth", p.BulkDepth } },
    { { "FieldOxideThickness / 2", field }, { "GateOxideThickness + GateHeight", gateTop } }
  };
  for (const auto& [small, large] : orders)
  {
    problem = problem.empty() ? CheckLess(small, large) : problem;
  }
  const double middle = 0.5 * p.DeviceWidth;
  const double gateEdge = 0.5 * p.GateLength;
  const double channelEdge = 0.5 * p.ChannelWidth;
  const double x[6] = { -0.5 * p.BulkLength, -(gateEdge + cover), -gateEdge, gateEdge,
    gateEdge + cover, 0.5 * p.BulkLength };
  const double y[6] = { 0.0, middle - channelEdge, middle - (channelEdge - cover),
    middle + (channelEdge - cover), middle + channelEdge, p.DeviceWidth };
  std::vector<double> levels{ -field, 0.0, p.GateOxideThickness, gateTop, gateTop + cover, cover,
    field, field + cover };
  if (problem.empty())
  {
    problem = CheckAscending({ x, x + 6 }, "GateLength, CoverOxideThickness and BulkLength");
  }
  if (problem.empty())
  {
    problem = CheckAscending({ y, y + 6 }, "ChannelWidth, CoverOxideThickness and DeviceWidth");
  }
  if (problem.empty())
  {
    problem =
      CheckAscending({ -p.BulkDepth, levels[0], levels[1], levels[2], levels[3], levels[4] },
        "BulkDepth, FieldOxideThickness, GateOxideThickness, GateHeight and CoverOxideThickness");
  }
  if (problem.empty())
  {
    problem =
      CheckAscending({ levels[6], levels[7] }, "FieldOxideThickness and CoverOxideThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }

  enum Region : Id
  {
    Bulk,
    LeftFieldOxide,
    RightFieldOxide,
    GateOxide,
    Gate,
    CoverOxide
  };
  device.RegionNames = { "Bulk", "LeftFieldOxide", "RightFieldOxide", "GateOxide", "Gate",
    "CoverOxide" };
  // A grid of 5 x 5 cells: the gate is the middle column, the field oxides are the outer rows, and
  // the columns and rows between are as wide as the cover oxide on the walls that they lie at.
  GridLayout layout({ x, x + 6 }, { y, y + 6 }, -p.BulkDepth);
  const auto getRegion = [=](double u, double v, double z) -> Id
  {
    const bool isField = v < y[1] || v > y[4];
    const bool isAtField = v < y[2] || v > y[3];
    const bool isAtGate = u > x[1] && u < x[4];
    if (isField && z > -field && z < field)
    {
      return v < middle ? LeftFieldOxide : RightFieldOxide;
    }
    if (z < 0.0)
    {
      return Bulk;
    }
    if (u > x[2] && u < x[3] && z < gateTop)
    {
      return z < p.GateOxideThickness && !isField ? GateOxide : Gate;
    }
    const double covered = isAtGate ? gateTop : isAtField ? field : 0.0;
    return z < covered + cover ? CoverOxide : OutsideRegion;
  };
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  double bottom = -p.BulkDepth;
  for (const double top : levels)
  {
    const double z = bottom + 0.5 * (top - bottom);
    layout.AddLayer(top, [&](double u, double v) { return getRegion(u, v, z); });
    bottom = top;
  }
  layout.MakeBoundary(device);
  const double bulkEdge = 0.5 * p.BulkLength;
  device.Contacts = { { "SourceContact", { OutsideRegion, Bulk },
                        [=](const Vec3& v) { return v.X == -bulkEdge; } },
    { "DrainContact", { OutsideRegion, Bulk }, [=](const Vec3& v) { return v.X == bulkEdge; } },
    { "GateContact", { OutsideRegion, Gate },
      [=](const Vec3& v) { return v.Y == 0.0 || v.Y == p.DeviceWidth; } },
    { "SubstrateContact", { OutsideRegion, Bulk },
      [=](const Vec3& v) { return v.Z == -p.BulkDepth; } } };
  return {};
}
} // namespace cdm
