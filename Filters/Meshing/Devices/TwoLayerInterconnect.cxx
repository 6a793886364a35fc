// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
std::string MakeTwoLayerInterconnect(const TwoLayerParameters& p, Device& device)
{
  std::string problem = CheckLengths({ { "LinePitch", p.LinePitch }, { "LineWidth", p.LineWidth },
    { "LineThickness", p.LineThickness }, { "InsulatorThickness", p.InsulatorThickness },
    { "BulkDepth", p.BulkDepth }, { "StepLength", p.StepLength } });
  if (problem.empty())
  {
    problem = CheckLess({ "LineWidth + 2 StepLength", p.LineWidth + 2.0 * p.StepLength },
      { "LinePitch", p.LinePitch });
  }
  if (!problem.empty())
  {
    return problem;
  }

  // Two lines on each layer, in the middles of two strips: the lower ones along y, the others along
  // x.
  const double size = 2.0 * p.LinePitch;
  const double halfWidth = 0.5 * p.LineWidth;
  const double centers[2] = { 0.5 * p.LinePitch, 1.5 * p.LinePitch };
  const auto getDistance = [&centers](double place)
  { return std::min(std::abs(place - centers[0]), std::abs(place - centers[1])); };
  std::vector<double> x{ 0.0, size };
  std::vector<double> y{ 0.0, size };
  // The oxide comes down in steps at these distances from the center of a lower line.
  std::vector<double> offsets;
  for (int i = 0; i <= p.ProfileSegments; ++i)
  {
    offsets.push_back(halfWidth + p.StepLength * i / p.ProfileSegments);
  }
  for (const double center : centers)
  {
    for (const double sign : { -1.0, 1.0 })
    {
      y.push_back(center + sign * halfWidth);
      for (const double offset : offsets)
      {
        x.push_back(center + sign * offset);
      }
    }
  }
  problem = SortLines(x, "LinePitch, LineWidth and StepLength");
  if (problem.empty())
  {
    problem = SortLines(y, "LinePitch and LineWidth");
  }
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

  enum Region : Id
  {
    Bulk,
    Oxide,
    LowerLine1,
    LowerLine2,
    UpperLine1,
    UpperLine2
  };
  device.RegionNames = { "Bulk", "Oxide", "LowerLine1", "LowerLine2", "UpperLine1", "UpperLine2" };
  const auto getFirst = [size](double place) { return place < 0.5 * size; };
  // Places on lines of the layout are off by roundings: they go to the nearest of the offsets.
  const auto getStep = [=](double u)
  {
    const double distance = getDistance(u);
    const auto nearest = std::min_element(offsets.begin(), offsets.end(),
      [distance](double a, double b) { return std::abs(a - distance) < std::abs(b - distance); });
    const double place = static_cast<double>(nearest - offsets.begin()) / p.ProfileSegments;
    return 1.0 - GetSmoothStep(place);
  };
  const auto getOxideTop = [=](double u, double)
  { return p.InsulatorThickness + p.LineThickness * getStep(u); };
  GridLayout layout(x, y, -p.BulkDepth);
  layout.AddLayer(0.0, [](double, double) { return Bulk; });
  layout.AddLayer([=](double u, double) { return getStep(u) == 1.0 ? p.LineThickness : 0.0; },
    [=](double u, double) -> Id {
      return getDistance(u) > halfWidth ? Oxide : getFirst(u) ? LowerLine1 : LowerLine2;
    });
  layout.AddLayer(getOxideTop, [](double, double) { return Oxide; });
  layout.AddLayer([=](double u, double v) { return getOxideTop(u, v) + p.LineThickness; },
    [=](double, double v) -> Id {
      return getDistance(v) > halfWidth ? OutsideRegion : Id(getFirst(v) ? UpperLine1 : UpperLine2);
    });
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
