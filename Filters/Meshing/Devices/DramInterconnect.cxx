// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
/** Parallel lines in the middles of strips of equal width. */
struct Comb
{
  double Pitch;
  int Number;

  int GetStrip(double place) const
  {
    return std::clamp(static_cast<int>(std::floor(place / this->Pitch)), 0, this->Number - 1);
  }
  double GetCenter(int strip) const { return (strip + 0.5) * this->Pitch; }
  double GetDistance(double place) const
  {
    return std::abs(place - this->GetCenter(this->GetStrip(place)));
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
} // namespace

std::string MakeDramInterconnect(const DramParameters& p, Device& device)
{
  std::string problem = CheckLengths({ { "LinePitch", p.LinePitch }, { "LineWidth", p.LineWidth },
    { "LineThickness", p.LineThickness }, { "InsulatorThickness", p.InsulatorThickness } });
  if (problem.empty() && !(p.SidewallAngle >= 0.1 && p.SidewallAngle <= 45.0))
  {
    problem = "SidewallAngle has to be in the range from 0.1 to 45 degrees.";
  }
  // Levels: word lines stand on z1, bit lines on z3, plugs on 0.
  const double z1 = p.InsulatorThickness;
  const double z2 = z1 + p.LineThickness;
  const double z3 = z2 + p.InsulatorThickness;
  const double z4 = z3 + p.LineThickness;
  const double z5 = z4 + p.InsulatorThickness;
  const CosineSine slant = GetCosineSine(p.SidewallAngle);
  const double slope = slant.Sine / slant.Cosine;
  const double halfWidth = 0.5 * p.LineWidth;
  // Lines are narrower at the top, plugs as much at the bottom, so that the masks have common
  // edges.
  const Flank flank{ halfWidth - slope * p.LineThickness, halfWidth };
  if (problem.empty())
  {
    problem = CheckLess({ "2 LineWidth", 2.0 * p.LineWidth }, { "LinePitch", p.LinePitch });
  }
  if (problem.empty())
  {
    problem = CheckLess({ "2 tan(SidewallAngle) LineThickness", 2.0 * slope * p.LineThickness },
      { "LineWidth", p.LineWidth });
  }
  if (!problem.empty())
  {
    return problem;
  }

  const Comb wordLines{ p.LinePitch, p.NumberOfWordLines };
  const Comb bitLines{ p.LinePitch, p.NumberOfBitLines };
  const double lengthX = p.NumberOfBitLines * p.LinePitch;
  const double lengthY = p.NumberOfWordLines * p.LinePitch;
  std::vector<double> x{ 0.0, lengthX };
  std::vector<double> y{ 0.0, lengthY };
  for (int i = 0; i < p.NumberOfBitLines; ++i)
  {
    AddFlankLines(x, bitLines.GetCenter(i), flank);
  }
  for (int i = 0; i < p.NumberOfWordLines; ++i)
  {
    AddFlankLines(y, wordLines.GetCenter(i), flank);
    if (i > 0)
    {
      AddFlankLines(y, i * p.LinePitch, flank);
    }
  }
  problem = SortLines(x, "LinePitch, LineWidth, LineThickness and InsulatorThickness");
  if (problem.empty())
  {
    problem = SortLines(y, "LinePitch, LineWidth, LineThickness and InsulatorThickness");
  }
  if (problem.empty())
  {
    problem = CheckAscending({ 0.0, z1, z2, z3, z4, z5 }, "LineThickness and InsulatorThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }

  constexpr Id insulator = 0;
  device.RegionNames = { "Insulator" };
  for (int i = 0; i < p.NumberOfWordLines; ++i)
  {
    device.RegionNames.push_back("WordLine" + std::to_string(i + 1));
  }
  for (int i = 0; i < p.NumberOfBitLines; ++i)
  {
    device.RegionNames.push_back("BitLine" + std::to_string(i + 1));
  }
  const auto getWordLine = [=](double v) -> Id { return 1 + wordLines.GetStrip(v); };
  const auto getBitLine = [=](double u) -> Id
  { return 1 + p.NumberOfWordLines + bitLines.GetStrip(u); };

  // Between the word lines each bit line has a plug in every other gap.
  const auto getPlugDistance = [=](double u, double v)
  {
    const double gap = std::round(v / p.LinePitch);
    const bool isPlug = gap > 0.0 && gap < p.NumberOfWordLines &&
      (static_cast<int>(gap) + bitLines.GetStrip(u)) % 2 == 0;
    return isPlug ? std::max(bitLines.GetDistance(u), std::abs(v - gap * p.LinePitch)) : lengthY;
  };
  // Places on the outline of a plug count as inside, whatever was rounded.
  const double outline = halfWidth * (1.0 + 1e-9);
  const auto getPlugRegion = [=](double u, double v, Id other)
  { return getPlugDistance(u, v) < outline ? getBitLine(u) : other; };

  GridLayout layout(x, y, 0.0);
  layout.AddLayer(
    [=](double u, double v)
    {
      const double distance = getPlugDistance(u, v);
      return distance < outline && !flank.IsInner(distance) ? z3 : 0.0;
    },
    [](double, double) { return insulator; });
  layout.AddLayer(z1, [=](double u, double v) { return getPlugRegion(u, v, insulator); });
  layout.AddLayer([=](double, double v)
    { return flank.IsInner(wordLines.GetDistance(v)) ? z2 : z1; },
    [=](double, double v) { return getWordLine(v); });
  layout.AddLayer(z2, [=](double u, double v) { return getPlugRegion(u, v, insulator); });
  layout.AddLayer(z3, [=](double u, double v) { return getPlugRegion(u, v, insulator); });
  layout.AddLayer([=](double u, double)
    { return flank.IsInner(bitLines.GetDistance(u)) ? z4 : z3; },
    [=](double u, double) { return getBitLine(u); });
  layout.AddLayer(z4, [](double, double) { return insulator; });
  layout.AddLayer(z5, [](double, double) { return insulator; });
  layout.MakeBoundary(device);

  for (std::size_t region = 1; region < device.RegionNames.size(); ++region)
  {
    device.Contacts.push_back({ device.RegionNames[region] + "Contact",
      { insulator, static_cast<Id>(region) }, [](const Vec3&) { return true; } });
  }
  device.Contacts.push_back(
    { "SubstrateContact", { OutsideRegion, insulator }, [](const Vec3& v) { return v.Z == 0.0; } });
  return {};
}
} // namespace cdm
