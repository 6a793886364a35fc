// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

namespace cdm
{
namespace
{
/** Part of a grown oxide that was silicon before. */
constexpr double ConsumedRatio = 0.44;
} // namespace

std::string MakeLocos(const LocosParameters& p, Device& device)
{
  std::string problem = CheckLengths({ { "BulkLength", p.BulkLength }, { "BulkDepth", p.BulkDepth },
    { "DeviceWidth", p.DeviceWidth }, { "FieldOxideThickness", p.FieldOxideThickness },
    { "PadOxideThickness", p.PadOxideThickness }, { "NitrideThickness", p.NitrideThickness },
    { "StepLength", p.StepLength } });
  const double bulkEdge = 0.5 * p.BulkLength;
  const double grown = p.FieldOxideThickness - p.PadOxideThickness;
  const std::pair<Parameter, Parameter> orders[] = {
    { { "PadOxideThickness", p.PadOxideThickness },
      { "FieldOxideThickness", p.FieldOxideThickness } },
    { { "2 StepLength", 2.0 * p.StepLength }, { "BulkLength", p.BulkLength } },
    { { "0.44 FieldOxideThickness", ConsumedRatio * p.FieldOxideThickness },
      { "BulkDepth", p.BulkDepth } }
  };
  for (const auto& [small, large] : orders)
  {
    problem = problem.empty() ? CheckLess(small, large) : problem;
  }
  if (!problem.empty())
  {
    return problem;
  }

  // The beak begins StepLength under the mask, whose edge is at x = 0, and ends half of that
  // beyond.
  const double begin = -p.StepLength;
  const double length = 1.5 * p.StepLength;
  std::vector<double> x{ -bulkEdge, bulkEdge };
  const int beyond = (p.ProfileSegments + 1) / 2;
  for (int i = 0; i <= p.ProfileSegments; ++i)
  {
    x.push_back(begin * i / p.ProfileSegments);
  }
  for (int i = 1; i <= beyond; ++i)
  {
    x.push_back(0.5 * p.StepLength * i / beyond);
  }
  std::vector<double> y{ 0.0, p.DeviceWidth };
  problem = SortLines(x, "BulkLength and StepLength");
  const auto getGrowth = [=](double u) { return grown * GetSmoothStep((u - begin) / length); };
  const auto getInterface = [=](double u, double) { return -ConsumedRatio * getGrowth(u); };
  const auto getTop = [=](double u, double)
  { return p.PadOxideThickness + (1.0 - ConsumedRatio) * getGrowth(u); };
  const double bottom = -p.BulkDepth;
  if (problem.empty())
  {
    problem = CheckAscending({ bottom, getInterface(bulkEdge, 0.0), 0.0, p.PadOxideThickness,
                               getTop(bulkEdge, 0.0), getTop(bulkEdge, 0.0) + p.NitrideThickness },
      "BulkDepth, FieldOxideThickness, PadOxideThickness and NitrideThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }

  enum Region : Id
  {
    Bulk,
    FieldOxide,
    Nitride
  };
  device.RegionNames = { "Bulk", "FieldOxide", "Nitride" };
  GridLayout layout(x, y, bottom);
  layout.AddLayer(getInterface, [](double, double) { return Bulk; });
  layout.AddLayer(getTop, [](double, double) { return FieldOxide; });
  layout.AddLayer([=](double u, double v) { return getTop(u, v) + p.NitrideThickness; },
    [](double u, double) -> Id { return u < 0.0 ? Id(Nitride) : OutsideRegion; });
  layout.MakeBoundary(device);
  device.Contacts = { { "SubstrateContact", { OutsideRegion, Bulk },
    [=](const Vec3& v) { return v.Z == bottom; } } };
  return {};
}
} // namespace cdm
