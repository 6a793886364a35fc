// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace cdm
{
namespace
{
enum Region : Id
{
  Bulk,
  LeftFieldOxide,
  RightFieldOxide,
  GateOxide,
  Gate,
  CoverOxide
};

/**
 * A grid of 5 x 5 cells: the gate is the middle column, the field oxides are the outer rows, and the
 * columns and rows between are as wide as the cover oxide on the walls that they lie at.
 */
struct Plan
{
  explicit Plan(const NmosParameters& p);
  Id GetRegion(double x, double y, double z) const;

  /** How far the field oxide reaches below and above the surface of the silicon. */
  double Field;
  double Cover;
  double GateOxideTop;
  double GateTop;
  double Middle;
  std::vector<double> X;
  std::vector<double> Y;
  std::vector<double> Levels;
};

Plan::Plan(const NmosParameters& p)
  : Field(0.5 * p.FieldOxideThickness), Cover(p.CoverOxideThickness),
    GateOxideTop(p.GateOxideThickness), GateTop(p.GateOxideThickness + p.GateHeight),
    Middle(0.5 * p.DeviceWidth)
{
  const double gateEdge = 0.5 * p.GateLength;
  const double channelEdge = 0.5 * p.ChannelWidth;
  this->X = { -0.5 * p.BulkLength, -(gateEdge + this->Cover), -gateEdge, gateEdge,
    gateEdge + this->Cover, 0.5 * p.BulkLength };
  this->Y = { 0.0, this->Middle - channelEdge, this->Middle - (channelEdge - this->Cover),
    this->Middle + (channelEdge - this->Cover), this->Middle + channelEdge, p.DeviceWidth };
  this->Levels = { -this->Field, 0.0, this->GateOxideTop, this->GateTop,
    this->GateTop + this->Cover, this->Cover, this->Field, this->Field + this->Cover };
}

Id Plan::GetRegion(double x, double y, double z) const
{
  const bool isField = y < this->Y[1] || y > this->Y[4];
  const bool isAtField = y < this->Y[2] || y > this->Y[3];
  const bool isAtGate = x > this->X[1] && x < this->X[4];
  if (isField && z > -this->Field && z < this->Field)
  {
    return y < this->Middle ? LeftFieldOxide : RightFieldOxide;
  }
  if (z < 0.0)
  {
    return Bulk;
  }
  if (x > this->X[2] && x < this->X[3] && z < this->GateTop)
  {
    return z < this->GateOxideTop && !isField ? GateOxide : Gate;
  }
  const double covered = isAtGate ? this->GateTop : isAtField ? this->Field : 0.0;
  return z < covered + this->Cover ? CoverOxide : OutsideRegion;
}

std::string CheckParameters(const NmosParameters& p, const Plan& plan)
{
  std::string problem = CheckLengths({ { "GateLength", p.GateLength },
    { "GateHeight", p.GateHeight }, { "GateOxideThickness", p.GateOxideThickness },
    { "BulkLength", p.BulkLength }, { "BulkDepth", p.BulkDepth }, { "DeviceWidth", p.DeviceWidth },
    { "ChannelWidth", p.ChannelWidth }, { "FieldOxideThickness", p.FieldOxideThickness },
    { "CoverOxideThickness", p.CoverOxideThickness } });
  const std::pair<Parameter, Parameter> orders[] = {
    { { "GateLength + 2 CoverOxideThickness", p.GateLength + 2.0 * plan.Cover },
      { "BulkLength", p.BulkLength } },
    { { "2 CoverOxideThickness", 2.0 * plan.Cover }, { "ChannelWidth", p.ChannelWidth } },
    { { "ChannelWidth", p.ChannelWidth }, { "DeviceWidth", p.DeviceWidth } },
    { { "FieldOxideThickness / 2", plan.Field }, { "BulkDepth", p.BulkDepth } },
    { { "FieldOxideThickness / 2", plan.Field },
      { "GateOxideThickness + GateHeight", plan.GateTop } }
  };
  for (const auto& [small, large] : orders)
  {
    problem = problem.empty() ? CheckLess(small, large) : problem;
  }
  const std::vector<double>& z = plan.Levels;
  const std::pair<std::vector<double>, const char*> positions[] = {
    { plan.X, "GateLength, CoverOxideThickness and BulkLength" },
    { plan.Y, "ChannelWidth, CoverOxideThickness and DeviceWidth" },
    { { -p.BulkDepth, z[0], z[1], z[2], z[3], z[4] },
      "BulkDepth, FieldOxideThickness, GateOxideThickness, GateHeight and CoverOxideThickness" },
    { { z[6], z[7] }, "FieldOxideThickness and CoverOxideThickness" }
  };
  for (const auto& [ascending, parameters] : positions)
  {
    problem = problem.empty() ? CheckAscending(ascending, parameters) : problem;
  }
  return problem;
}
} // namespace

std::string MakeNmosTransistor(const NmosParameters& p, Device& device)
{
  const Plan plan(p);
  std::string problem = CheckParameters(p, plan);
  if (!problem.empty())
  {
    return problem;
  }
  device.RegionNames = { "Bulk", "LeftFieldOxide", "RightFieldOxide", "GateOxide", "Gate",
    "CoverOxide" };
  GridLayout layout(plan.X, plan.Y, -p.BulkDepth);
  std::vector<double> levels = plan.Levels;
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  double bottom = -p.BulkDepth;
  for (const double top : levels)
  {
    const double z = bottom + 0.5 * (top - bottom);
    layout.AddLayer(top, [&](double x, double y) { return plan.GetRegion(x, y, z); });
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
