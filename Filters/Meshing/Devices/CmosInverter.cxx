// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
struct Interval
{
  double Low;
  double High;

  bool Contains(double place) const { return place > this->Low && place < this->High; }
};

Interval GetAround(double center, double width)
{
  return { center - 0.5 * width, center + 0.5 * width };
}

struct Rectangle
{
  Interval X;
  Interval Y;

  bool Contains(double x, double y) const { return this->X.Contains(x) && this->Y.Contains(y); }
};
} // namespace

std::string MakeCmosInverter(const CmosParameters& p, Device& device)
{
  const Parameter contact{ "ContactWidth", p.ContactWidth };
  std::string problem = CheckLengths({ { "GateLength", p.GateLength },
    { "GateHeight", p.GateHeight }, { "GateOxideThickness", p.GateOxideThickness },
    { "SpacerWidth", p.SpacerWidth }, { "BulkDepth", p.BulkDepth },
    { "ChannelWidth", p.ChannelWidth }, { "DiffusionLength", p.DiffusionLength }, contact,
    { "TrenchWidth", p.TrenchWidth }, { "TrenchDepth", p.TrenchDepth },
    { "InsulatorThickness", p.InsulatorThickness }, { "LineThickness", p.LineThickness } });
  const bool isPassivated = p.PassivationThickness != 0.0;
  if (problem.empty() && isPassivated)
  {
    problem = CheckLengths({ { "PassivationThickness", p.PassivationThickness } });
  }
  const std::pair<Parameter, Parameter> orders[] = { { { "TrenchDepth", p.TrenchDepth },
                                                       { "BulkDepth", p.BulkDepth } },
    { contact, { "GateLength", p.GateLength } },
    { contact, { "DiffusionLength", p.DiffusionLength } },
    { contact, { "ChannelWidth", p.ChannelWidth } } };
  for (const auto& [small, large] : orders)
  {
    problem = problem.empty() ? CheckLess(small, large) : problem;
  }
  if (!problem.empty())
  {
    return problem;
  }

  // Along x: the trench, a source, the gate between its spacers in the middle, a drain, the trench.
  const double gateEdge = 0.5 * p.GateLength;
  const double foot = gateEdge + p.SpacerWidth;
  const double activeEdge = foot + p.DiffusionLength;
  const double edge = activeEdge + p.TrenchWidth;
  const double drainCenter = foot + 0.5 * p.DiffusionLength;
  const Interval drainX = GetAround(drainCenter, p.ContactWidth);
  const Interval sourceX = GetAround(-drainCenter, p.ContactWidth);
  const Interval gateContactX = GetAround(0.0, p.ContactWidth);

  // Along y: the two transistors, the second one a mirror image; between them there is room for the
  // ends of both gates, with contacts.
  const double gateReach = 2.0 * p.ContactWidth;
  const double gap = 5.0 * p.ContactWidth;
  const double width = 2.0 * (p.TrenchWidth + p.ChannelWidth) + gap;
  Interval active[2], gate[2], contactY[2], gateContactY[2];
  active[0] = { p.TrenchWidth, p.TrenchWidth + p.ChannelWidth };
  gate[0] = { 0.5 * p.TrenchWidth, active[0].High + gateReach };
  contactY[0] = GetAround(p.TrenchWidth + 0.5 * p.ChannelWidth, p.ContactWidth);
  gateContactY[0] = GetAround(active[0].High + 0.5 * gateReach, p.ContactWidth);
  for (Interval* pair : { active, gate, contactY, gateContactY })
  {
    pair[1] = { width - pair[0].High, width - pair[0].Low };
  }

  // The upper level of gate and spacers, by the distance from the middle of the gate.
  const double gateTop = p.GateOxideThickness + p.GateHeight;
  std::vector<std::pair<double, double>> flank;
  for (int i = 0; i <= p.SpacerSegments; ++i)
  {
    const CosineSine direction = GetCosineSine(90.0 * i / p.SpacerSegments);
    flank.emplace_back(i == p.SpacerSegments ? foot : gateEdge + p.SpacerWidth * direction.Sine,
      p.GateOxideThickness + p.GateHeight * direction.Cosine);
  }
  flank.front().second = gateTop;
  const auto getGateLevel = [=](double u, double)
  {
    const auto reached = std::find_if(flank.begin(), flank.end(),
      [u](const std::pair<double, double>& point) { return std::abs(u) <= point.first; });
    return reached == flank.end() ? p.GateOxideThickness : reached->second;
  };

  std::vector<double> x{ -edge, edge, -activeEdge, activeEdge, -gateEdge, gateEdge };
  for (const auto& [distance, height] : flank)
  {
    x.insert(x.end(), { -distance, distance });
  }
  for (const Interval& interval : { sourceX, drainX, gateContactX })
  {
    x.insert(x.end(), { interval.Low, interval.High });
  }
  std::vector<double> y{ 0.0, width };
  for (const Interval* pair : { active, gate, contactY, gateContactY })
  {
    for (int i = 0; i < 2; ++i)
    {
      y.insert(y.end(), { pair[i].Low, pair[i].High });
    }
  }
  const double metalBottom = gateTop + p.InsulatorThickness;
  const double metalTop = metalBottom + p.LineThickness;
  std::vector<double> levels{ -p.BulkDepth, -p.TrenchDepth, 0.0 };
  for (auto point = flank.rbegin(); point != flank.rend(); ++point)
  {
    levels.push_back(point->second);
  }
  levels.insert(levels.end(), { metalBottom, metalTop });
  problem = SortLines(x, "GateLength, SpacerWidth, DiffusionLength, ContactWidth and TrenchWidth");
  if (problem.empty())
  {
    problem = SortLines(y, "ChannelWidth, ContactWidth and TrenchWidth");
  }
  if (problem.empty())
  {
    problem = CheckAscending(levels,
      "BulkDepth, TrenchDepth, GateOxideThickness, GateHeight, InsulatorThickness and "
      "LineThickness");
  }
  if (problem.empty() && isPassivated)
  {
    problem =
      CheckAscending({ metalTop, metalTop + p.PassivationThickness }, "PassivationThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }

  enum Region : Id
  {
    Silicon,
    Oxide,
    NmosGate,
    PmosGate,
    NmosSourceSpacer,
    NmosDrainSpacer,
    PmosSourceSpacer,
    PmosDrainSpacer,
    Ground,
    Supply,
    Input,
    Output,
    Passivation
  };
  device.RegionNames = { "Silicon", "Oxide", "NmosGate", "PmosGate", "NmosSourceSpacer",
    "NmosDrainSpacer", "PmosSourceSpacer", "PmosDrainSpacer", "Ground", "Supply", "Input",
    "Output" };
  if (isPassivated)
  {
    device.RegionNames.emplace_back("Passivation");
  }
  const Id cover = isPassivated ? Id(Passivation) : OutsideRegion;

  const auto isSilicon = [=](double u, double v)
  { return std::abs(u) < activeEdge && (active[0].Contains(v) || active[1].Contains(v)); };
  const std::pair<Rectangle, Id> plugs[] = { { { sourceX, contactY[0] }, Ground },
    { { sourceX, contactY[1] }, Supply }, { { drainX, contactY[0] }, Output },
    { { drainX, contactY[1] }, Output } };
  const std::pair<Rectangle, Id> gatePlugs[] = { { { gateContactX, gateContactY[0] }, Input },
    { { gateContactX, gateContactY[1] }, Input } };
  const std::pair<Rectangle, Id> conductors[] = { { { { -edge, sourceX.High }, contactY[0] },
                                                    Ground },
    { { { -edge, sourceX.High }, contactY[1] }, Supply },
    { { gateContactX, { gateContactY[0].Low, gateContactY[1].High } }, Input },
    { { drainX, { contactY[0].Low, contactY[1].High } }, Output } };
  const auto find = [](const auto& mask, double u, double v, Id other)
  {
    const auto found = std::find_if(std::begin(mask), std::end(mask),
      [=](const std::pair<Rectangle, Id>& entry) { return entry.first.Contains(u, v); });
    return found == std::end(mask) ? other : found->second;
  };
  const auto getGateRegion = [=](double u, double v) -> Id
  {
    for (int i = 0; i < 2; ++i)
    {
      if (gate[i].Contains(v) && std::abs(u) < foot)
      {
        const Id spacer = (i == 0 ? NmosSourceSpacer : PmosSourceSpacer) + (u > 0.0 ? 1 : 0);
        return std::abs(u) < gateEdge ? NmosGate + i : spacer;
      }
    }
    return cover;
  };

  GridLayout layout(x, y, -p.BulkDepth);
  layout.AddLayer(-p.TrenchDepth, [](double, double) { return Silicon; });
  layout.AddLayer(0.0, [=](double u, double v) -> Id { return isSilicon(u, v) ? Silicon : Oxide; });
  layout.AddLayer(
    p.GateOxideThickness, [&](double u, double v) { return find(plugs, u, v, Oxide); });
  layout.AddLayer(getGateLevel, getGateRegion);
  layout.AddLayer(gateTop, [&](double u, double v) { return find(plugs, u, v, cover); });
  layout.AddLayer(metalBottom,
    [&](double u, double v) { return find(plugs, u, v, find(gatePlugs, u, v, cover)); });
  layout.AddLayer(metalTop, [&](double u, double v) { return find(conductors, u, v, cover); });
  if (isPassivated)
  {
    layout.AddLayer(metalTop + p.PassivationThickness, [](double, double) { return Passivation; });
  }
  layout.MakeBoundary(device);

  const auto isNmos = [=](const Vec3& v) { return v.Y < 0.5 * width; };
  const auto isPmos = [=](const Vec3& v) { return v.Y > 0.5 * width; };
  device.Contacts = { { "NmosSourceContact", { Silicon, Ground }, isNmos },
    { "NmosDrainContact", { Silicon, Output }, isNmos },
    { "NmosGateContact", { NmosGate, Input }, isNmos },
    { "PmosSourceContact", { Silicon, Supply }, isPmos },
    { "PmosDrainContact", { Silicon, Output }, isPmos },
    { "PmosGateContact", { PmosGate, Input }, isPmos },
    { "SubstrateContact", { OutsideRegion, Silicon },
      [=](const Vec3& v) { return v.Z == -p.BulkDepth; } } };
  const std::pair<const char*, Id> terminals[] = { { "Vss", Ground }, { "Vdd", Supply },
    { "Vin", Input }, { "Vout", Output } };
  for (const auto& [name, metal] : terminals)
  {
    device.Contacts.push_back({ name, { std::min(cover, metal), std::max(cover, metal) },
      [=](const Vec3& v) { return v.Z == metalTop; } });
  }
  return {};
}
} // namespace cdm
