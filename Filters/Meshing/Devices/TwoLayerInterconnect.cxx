// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cdm
{
namespace
{
enum Region : Id
{
  Bulk,
  Oxide,
  LowerLine1,
  LowerLine2,
  UpperLine1,
  UpperLine2
};

/**
 * Two lines on each layer, in the middles of two strips: the lower ones along y, the others along x.
 */
struct Plan
{
  explicit Plan(const TwoLayerParameters& p);
  bool IsOnLine(double position) const { return !(this->GetDistance(position) > this->HalfWidth); }
  bool IsInFirstStrip(double position) const { return position < 0.5 * this->Size; }
  double GetDistance(double position) const
  {
    return std::min(std::abs(position - this->Centers[0]), std::abs(position - this->Centers[1]));
  }
  double GetStep(double x) const;

  double Size;
  double HalfWidth;
  double Centers[2];
  /** The oxide comes down in steps at these distances from the center of a lower line. */
  std::vector<double> Offsets;
};

Plan::Plan(const TwoLayerParameters& p)
  : Size(2.0 * p.LinePitch),
    HalfWidth(0.5 * p.LineWidth), Centers{ 0.5 * p.LinePitch, 1.5 * p.LinePitch }
{
  for (int i = 0; i <= p.ProfileSegments; ++i)
  {
    this->Offsets.push_back(this->HalfWidth + p.StepLength * i / p.ProfileSegments);
  }
}

/**
 * The height of the step that the oxide makes over a lower line, from 0 to 1. Positions on lines of
 * the layout are off by roundings: they go to the nearest of the offsets.
 */
double Plan::GetStep(double x) const
{
  const double distance = this->GetDistance(x);
  const auto nearest = std::min_element(this->Offsets.begin(), this->Offsets.end(),
    [distance](double a, double b) { return std::abs(a - distance) < std::abs(b - distance); });
  const double segments = static_cast<double>(this->Offsets.size() - 1);
  return 1.0 - GetSmoothStep(static_cast<double>(nearest - this->Offsets.begin()) / segments);
}

std::string CheckParameters(const TwoLayerParameters& p)
{
  const std::string problem =
    CheckLengths({ { "LinePitch", p.LinePitch }, { "LineWidth", p.LineWidth },
      { "LineThickness", p.LineThickness }, { "InsulatorThickness", p.InsulatorThickness },
      { "BulkDepth", p.BulkDepth }, { "StepLength", p.StepLength } });
  return problem.empty()
    ? CheckLess({ "LineWidth + 2 StepLength", p.LineWidth + 2.0 * p.StepLength },
        { "LinePitch", p.LinePitch })
    : problem;
}

/** Lines of the layout along x and y, in which all masks have their edges. */
std::string MakeLines(const Plan& plan, std::vector<double>& x, std::vector<double>& y)
{
  x = { 0.0, plan.Size };
  y = { 0.0, plan.Size };
  for (const double center : plan.Centers)
  {
    for (const double sign : { -1.0, 1.0 })
    {
      y.push_back(center + sign * plan.HalfWidth);
      for (const double offset : plan.Offsets)
      {
        x.push_back(center + sign * offset);
      }
    }
  }
  const std::string problem = SortLines(x, "LinePitch, LineWidth and StepLength");
  return problem.empty() ? SortLines(y, "LinePitch and LineWidth") : problem;
}

void AddLayers(const TwoLayerParameters& p, const Plan& plan, GridLayout& layout)
{
  const auto getOxideTop = [&](double x, double)
  { return p.InsulatorThickness + p.LineThickness * plan.GetStep(x); };
  layout.AddLayer(0.0, [](double, double) { return Bulk; });
  layout.AddLayer([&](double x, double) { return plan.GetStep(x) == 1.0 ? p.LineThickness : 0.0; },
    [&](double x, double) -> Id {
      return !plan.IsOnLine(x) ? Oxide : plan.IsInFirstStrip(x) ? LowerLine1 : LowerLine2;
    });
  layout.AddLayer(getOxideTop, [](double, double) { return Oxide; });
  layout.AddLayer([&](double x, double y) { return getOxideTop(x, y) + p.LineThickness; },
    [&](double, double y) -> Id
    {
      return !plan.IsOnLine(y) ? OutsideRegion
                               : Id(plan.IsInFirstStrip(y) ? UpperLine1 : UpperLine2);
    });
}
} // namespace

std::string MakeTwoLayerInterconnect(const TwoLayerParameters& p, Device& device)
{
  std::string problem = CheckParameters(p);
  if (!problem.empty())
  {
    return problem;
  }
  const Plan plan(p);
  std::vector<double> x;
  std::vector<double> y;
  problem = MakeLines(plan, x, y);
  const double oxideOnLine = p.LineThickness + p.InsulatorThickness;
  if (problem.empty())
  {
    problem = CheckAscending(
      { -p.BulkDepth, 0.0, p.InsulatorThickness, oxideOnLine, oxideOnLine + p.LineThickness },
      "BulkDepth, LineThickness and InsulatorThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }
  device.RegionNames = { "Bulk", "Oxide", "LowerLine1", "LowerLine2", "UpperLine1", "UpperLine2" };
  GridLayout layout(x, y, -p.BulkDepth);
  AddLayers(p, plan, layout);
  layout.MakeBoundary(device);

  const auto isAnywhere = [](const Vec3&) { return true; };
  for (const Id line : { LowerLine1, LowerLine2, UpperLine1, UpperLine2 })
  {
    device.Contacts.push_back(
      { device.RegionNames[line] + "Contact", { Oxide, line }, isAnywhere });
  }
  device.Contacts.push_back({ "SubstrateContact", { OutsideRegion, Bulk },
    [=](const Vec3& v) { return v.Z == -p.BulkDepth; } });
  return {};
}
} // namespace cdm
