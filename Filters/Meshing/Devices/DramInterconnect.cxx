// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace cdm
{
namespace
{
constexpr Id Insulator = 0;

/** Parallel lines in the middles of strips of equal width. */
struct Comb
{
  double Pitch;
  int Number;

  int GetStrip(double position) const
  {
    return std::clamp(static_cast<int>(std::floor(position / this->Pitch)), 0, this->Number - 1);
  }
  double GetCenter(int strip) const { return (strip + 0.5) * this->Pitch; }
  double GetDistance(double position) const
  {
    return std::abs(position - this->GetCenter(this->GetStrip(position)));
  }
};

/** Half widths of a line or plug at the two ends of its slanted sides. */
struct Flank
{
  double Inner;
  double Outer;

  /**
   * Whether a position on a line of the layout is at the inner distance; it is at one of the two,
   * or beyond.
   */
  bool IsInner(double distance) const { return distance < 0.5 * (this->Inner + this->Outer); }
};

void AddFlankLines(std::vector<double>& lines, double center, const Flank& flank)
{
  for (const double halfWidth : { flank.Inner, flank.Outer })
  {
    lines.push_back(center - halfWidth);
    lines.push_back(center + halfWidth);
  }
}
/** Lines, plugs and levels of the device. */
struct Plan
{
  explicit Plan(const DramParameters& p);
  Id GetWordLine(double y) const { return 1 + this->WordLines.GetStrip(y); }
  Id GetBitLine(double x) const { return 1 + this->WordLines.Number + this->BitLines.GetStrip(x); }
  double GetPlugDistance(double x, double y) const;

  /** Word lines stand on the first level, bit lines on the third, plugs on 0. */
  double Levels[6];
  /** By how much the sides of lines come in from bottom to top, for each unit of height. */
  double Slope;
  /**
   * Lines are narrower at the top, plugs as much at the bottom, so that the masks have common
   * edges.
   */
  Flank Sides;
  Comb WordLines;
  Comb BitLines;
};

Plan::Plan(const DramParameters& p)
  : WordLines{ p.LinePitch, p.NumberOfWordLines }, BitLines{ p.LinePitch, p.NumberOfBitLines }
{
  this->Levels[0] = 0.0;
  for (int i = 1; i < 6; ++i)
  {
    this->Levels[i] = this->Levels[i - 1] + (i % 2 == 0 ? p.LineThickness : p.InsulatorThickness);
  }
  const CosineSine slant = GetCosineSine(p.SidewallAngle);
  this->Slope = slant.Sine / slant.Cosine;
  const double halfWidth = 0.5 * p.LineWidth;
  this->Sides = { halfWidth - this->Slope * p.LineThickness, halfWidth };
}

/**
 * The distance from the axis of a plug, along x or y, the larger one; or one beyond all plugs.
 * Between the word lines each bit line has a plug in every other gap.
 */
double Plan::GetPlugDistance(double x, double y) const
{
  const double pitch = this->WordLines.Pitch;
  const double gap = std::round(y / pitch);
  const bool isPlug = gap > 0.0 && gap < this->WordLines.Number &&
    (static_cast<int>(gap) + this->BitLines.GetStrip(x)) % 2 == 0;
  return isPlug ? std::max(this->BitLines.GetDistance(x), std::abs(y - gap * pitch))
                : this->WordLines.Number * pitch;
}

std::string CheckParameters(const DramParameters& p, const Plan& plan)
{
  std::string problem = CheckLengths({ { "LinePitch", p.LinePitch }, { "LineWidth", p.LineWidth },
    { "LineThickness", p.LineThickness }, { "InsulatorThickness", p.InsulatorThickness } });
  if (problem.empty() && !(p.SidewallAngle >= 0.1 && p.SidewallAngle <= 45.0))
  {
    problem = "SidewallAngle has to be in the range from 0.1 to 45 degrees.";
  }
  if (problem.empty())
  {
    problem = CheckLess({ "2 LineWidth", 2.0 * p.LineWidth }, { "LinePitch", p.LinePitch });
  }
  if (problem.empty())
  {
    problem =
      CheckLess({ "2 tan(SidewallAngle) LineThickness", 2.0 * plan.Slope * p.LineThickness },
        { "LineWidth", p.LineWidth });
  }
  return problem;
}

/** Lines of the layout along x and y, in which all masks have their edges. */
std::string MakeLines(const Plan& plan, std::vector<double>& x, std::vector<double>& y)
{
  const double pitch = plan.WordLines.Pitch;
  x = { 0.0, plan.BitLines.Number * pitch };
  y = { 0.0, plan.WordLines.Number * pitch };
  for (int i = 0; i < plan.BitLines.Number; ++i)
  {
    AddFlankLines(x, plan.BitLines.GetCenter(i), plan.Sides);
  }
  for (int i = 0; i < plan.WordLines.Number; ++i)
  {
    AddFlankLines(y, plan.WordLines.GetCenter(i), plan.Sides);
    if (i > 0)
    {
      AddFlankLines(y, i * pitch, plan.Sides);
    }
  }
  constexpr const char* parameters = "LinePitch, LineWidth, LineThickness and InsulatorThickness";
  std::string problem = SortLines(x, parameters);
  if (problem.empty())
  {
    problem = SortLines(y, parameters);
  }
  return problem.empty() ? CheckAscending({ std::begin(plan.Levels), std::end(plan.Levels) },
                             "LineThickness and InsulatorThickness")
                         : problem;
}

void AddLayers(const Plan& plan, GridLayout& layout)
{
  const Flank& flank = plan.Sides;
  const double* const z = plan.Levels;
  // Positions on the outline of a plug count as inside, whatever was rounded.
  const double outline = flank.Outer * (1.0 + 1e-9);
  const auto getInsulator = [](double, double) { return Insulator; };
  const auto getPlug = [&plan, outline](double x, double y)
  { return plan.GetPlugDistance(x, y) < outline ? plan.GetBitLine(x) : Insulator; };
  layout.AddLayer(
    [&](double x, double y)
    {
      const double distance = plan.GetPlugDistance(x, y);
      return distance < outline && !flank.IsInner(distance) ? z[3] : 0.0;
    },
    getInsulator);
  layout.AddLayer(z[1], getPlug);
  layout.AddLayer([&](double, double y)
    { return flank.IsInner(plan.WordLines.GetDistance(y)) ? z[2] : z[1]; },
    [&](double, double y) { return plan.GetWordLine(y); });
  layout.AddLayer(z[2], getPlug);
  layout.AddLayer(z[3], getPlug);
  layout.AddLayer([&](double x, double)
    { return flank.IsInner(plan.BitLines.GetDistance(x)) ? z[4] : z[3]; },
    [&](double x, double) { return plan.GetBitLine(x); });
  layout.AddLayer(z[4], getInsulator);
  layout.AddLayer(z[5], getInsulator);
}
} // namespace

std::string MakeDramInterconnect(const DramParameters& p, Device& device)
{
  const Plan plan(p);
  std::string problem = CheckParameters(p, plan);
  std::vector<double> x;
  std::vector<double> y;
  if (problem.empty())
  {
    problem = MakeLines(plan, x, y);
  }
  if (!problem.empty())
  {
    return problem;
  }

  device.RegionNames = { "Insulator" };
  for (int i = 0; i < p.NumberOfWordLines; ++i)
  {
    device.RegionNames.push_back("WordLine" + std::to_string(i + 1));
  }
  for (int i = 0; i < p.NumberOfBitLines; ++i)
  {
    device.RegionNames.push_back("BitLine" + std::to_string(i + 1));
  }
  GridLayout layout(x, y, 0.0);
  AddLayers(plan, layout);
  layout.MakeBoundary(device);

  for (std::size_t region = 1; region < device.RegionNames.size(); ++region)
  {
    device.Contacts.push_back({ device.RegionNames[region] + "Contact",
      { Insulator, static_cast<Id>(region) }, [](const Vec3&) { return true; } });
  }
  device.Contacts.push_back(
    { "SubstrateContact", { OutsideRegion, Insulator }, [](const Vec3& v) { return v.Z == 0.0; } });
  return {};
}
} // namespace cdm
