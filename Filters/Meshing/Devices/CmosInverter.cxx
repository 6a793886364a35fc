// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "GridLayout.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cdm
{
namespace
{
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

constexpr const char* RegionNames[] = { "Silicon", "Oxide", "NmosGate", "PmosGate",
  "NmosSourceSpacer", "NmosDrainSpacer", "PmosSourceSpacer", "PmosDrainSpacer", "Ground", "Supply",
  "Input", "Output", "Passivation" };

struct Interval
{
  double Low;
  double High;

  bool Contains(double position) const { return position > this->Low && position < this->High; }
};

Interval GetAround(double center, double width)
{
  return { center - 0.5 * width, center + 0.5 * width };
}

/** Rectangles with regions, the first of which counts where they overlap. */
struct MaskRectangle
{
  Interval X;
  Interval Y;
  Id Region;
};
using Mask = std::vector<MaskRectangle>;

Id FindRegion(const Mask& mask, double x, double y, Id other)
{
  const auto found = std::find_if(mask.begin(), mask.end(),
    [=](const MaskRectangle& entry) { return entry.X.Contains(x) && entry.Y.Contains(y); });
  return found == mask.end() ? other : found->Region;
}

/** Lengths that all masks and layers are made of. */
struct Plan
{
  explicit Plan(const CmosParameters& p);

  // Along x: the trench, a source, the gate between its spacers in the middle, a drain, the trench.
  double GateEdge;
  double Foot;
  double ActiveEdge;
  double Edge;
  Interval SourceX;
  Interval DrainX;
  Interval GateContactX;
  // Along y: the two transistors, the second one a mirror image; between them there is room for the
  // ends of both gates, with contacts.
  double Width;
  Interval Active[2];
  Interval Gate[2];
  Interval ContactY[2];
  Interval GateContactY[2];
  /** The upper level of gate and spacers, by the distance from the middle of the gate. */
  std::vector<std::pair<double, double>> Flank;
  double GateTop;
  double MetalBottom;
  double MetalTop;
};

Plan::Plan(const CmosParameters& p)
  : GateEdge(0.5 * p.GateLength), Foot(this->GateEdge + p.SpacerWidth),
    ActiveEdge(this->Foot + p.DiffusionLength), Edge(this->ActiveEdge + p.TrenchWidth),
    GateContactX(GetAround(0.0, p.ContactWidth)), GateTop(p.GateOxideThickness + p.GateHeight),
    MetalBottom(this->GateTop + p.InsulatorThickness), MetalTop(this->MetalBottom + p.LineThickness)
{
  const double drainCenter = this->Foot + 0.5 * p.DiffusionLength;
  this->DrainX = GetAround(drainCenter, p.ContactWidth);
  this->SourceX = GetAround(-drainCenter, p.ContactWidth);

  const double gateReach = 2.0 * p.ContactWidth;
  const double gap = 5.0 * p.ContactWidth;
  this->Width = 2.0 * (p.TrenchWidth + p.ChannelWidth) + gap;
  this->Active[0] = { p.TrenchWidth, p.TrenchWidth + p.ChannelWidth };
  this->Gate[0] = { 0.5 * p.TrenchWidth, this->Active[0].High + gateReach };
  this->ContactY[0] = GetAround(p.TrenchWidth + 0.5 * p.ChannelWidth, p.ContactWidth);
  this->GateContactY[0] = GetAround(this->Active[0].High + 0.5 * gateReach, p.ContactWidth);
  for (Interval* pair : { this->Active, this->Gate, this->ContactY, this->GateContactY })
  {
    pair[1] = { this->Width - pair[0].High, this->Width - pair[0].Low };
  }

  for (int i = 0; i <= p.SpacerSegments; ++i)
  {
    const CosineSine direction = GetCosineSine(90.0 * i / p.SpacerSegments);
    this->Flank.emplace_back(
      i == p.SpacerSegments ? this->Foot : this->GateEdge + p.SpacerWidth * direction.Sine,
      p.GateOxideThickness + p.GateHeight * direction.Cosine);
  }
  this->Flank.front().second = this->GateTop;
}

std::string CheckParameters(const CmosParameters& p)
{
  const Parameter contact{ "ContactWidth", p.ContactWidth };
  std::vector<Parameter> lengths{ { "GateLength", p.GateLength }, { "GateHeight", p.GateHeight },
    { "GateOxideThickness", p.GateOxideThickness }, { "SpacerWidth", p.SpacerWidth },
    { "BulkDepth", p.BulkDepth }, { "ChannelWidth", p.ChannelWidth },
    { "DiffusionLength", p.DiffusionLength }, contact, { "TrenchWidth", p.TrenchWidth },
    { "TrenchDepth", p.TrenchDepth }, { "InsulatorThickness", p.InsulatorThickness },
    { "LineThickness", p.LineThickness } };
  if (p.PassivationThickness != 0.0)
  {
    lengths.push_back({ "PassivationThickness", p.PassivationThickness });
  }
  std::string problem = CheckLengths(lengths);
  const std::pair<Parameter, Parameter> orders[] = { { { "TrenchDepth", p.TrenchDepth },
                                                       { "BulkDepth", p.BulkDepth } },
    { contact, { "GateLength", p.GateLength } },
    { contact, { "DiffusionLength", p.DiffusionLength } },
    { contact, { "ChannelWidth", p.ChannelWidth } } };
  for (const auto& [small, large] : orders)
  {
    problem = problem.empty() ? CheckLess(small, large) : problem;
  }
  return problem;
}

/** Lines of the layout along x and y, in which all masks have their edges. */
std::string MakeLines(const Plan& plan, std::vector<double>& x, std::vector<double>& y)
{
  x = { -plan.Edge, plan.Edge, -plan.ActiveEdge, plan.ActiveEdge, -plan.GateEdge, plan.GateEdge };
  for (const auto& [distance, height] : plan.Flank)
  {
    x.insert(x.end(), { -distance, distance });
  }
  for (const Interval& interval : { plan.SourceX, plan.DrainX, plan.GateContactX })
  {
    x.insert(x.end(), { interval.Low, interval.High });
  }
  y = { 0.0, plan.Width };
  for (const Interval* pair : { plan.Active, plan.Gate, plan.ContactY, plan.GateContactY })
  {
    for (int i = 0; i < 2; ++i)
    {
      y.insert(y.end(), { pair[i].Low, pair[i].High });
    }
  }
  const std::string problem =
    SortLines(x, "GateLength, SpacerWidth, DiffusionLength, ContactWidth and TrenchWidth");
  return problem.empty() ? SortLines(y, "ChannelWidth, ContactWidth and TrenchWidth") : problem;
}

std::string CheckLevels(const CmosParameters& p, const Plan& plan)
{
  std::vector<double> levels{ -p.BulkDepth, -p.TrenchDepth, 0.0 };
  for (auto point = plan.Flank.rbegin(); point != plan.Flank.rend(); ++point)
  {
    levels.push_back(point->second);
  }
  levels.insert(levels.end(), { plan.MetalBottom, plan.MetalTop });
  const std::string problem = CheckAscending(levels,
    "BulkDepth, TrenchDepth, GateOxideThickness, GateHeight, InsulatorThickness and "
    "LineThickness");
  return problem.empty() && p.PassivationThickness != 0.0
    ? CheckAscending(
        { plan.MetalTop, plan.MetalTop + p.PassivationThickness }, "PassivationThickness")
    : problem;
}

/** Stacks the masks. Cover: what lies beside and above the metal. */
void AddLayers(const CmosParameters& p, const Plan& plan, Id cover, GridLayout& layout)
{
  const Interval activeX{ -plan.ActiveEdge, plan.ActiveEdge };
  const Mask wells{ { activeX, plan.Active[0], Silicon }, { activeX, plan.Active[1], Silicon } };
  const Mask plugs{ { plan.SourceX, plan.ContactY[0], Ground },
    { plan.SourceX, plan.ContactY[1], Supply }, { plan.DrainX, plan.ContactY[0], Output },
    { plan.DrainX, plan.ContactY[1], Output } };
  Mask allPlugs = plugs;
  allPlugs.push_back({ plan.GateContactX, plan.GateContactY[0], Input });
  allPlugs.push_back({ plan.GateContactX, plan.GateContactY[1], Input });
  const Interval gateX{ -plan.GateEdge, plan.GateEdge };
  const Interval sourceSide{ -plan.Foot, 0.0 };
  const Interval drainSide{ 0.0, plan.Foot };
  const Mask gates{ { gateX, plan.Gate[0], NmosGate }, { gateX, plan.Gate[1], PmosGate },
    { sourceSide, plan.Gate[0], NmosSourceSpacer }, { drainSide, plan.Gate[0], NmosDrainSpacer },
    { sourceSide, plan.Gate[1], PmosSourceSpacer }, { drainSide, plan.Gate[1], PmosDrainSpacer } };
  const Interval outside{ -plan.Edge, plan.SourceX.High };
  const Mask conductors{ { outside, plan.ContactY[0], Ground },
    { outside, plan.ContactY[1], Supply },
    { plan.GateContactX, { plan.GateContactY[0].Low, plan.GateContactY[1].High }, Input },
    { plan.DrainX, { plan.ContactY[0].Low, plan.ContactY[1].High }, Output } };

  const auto getTop = [&](double top) { return [top](double, double) { return top; }; };
  const auto getGateTop = [&](double x, double)
  {
    const auto reached = std::find_if(plan.Flank.begin(), plan.Flank.end(),
      [x](const std::pair<double, double>& point) { return std::abs(x) <= point.first; });
    return reached == plan.Flank.end() ? p.GateOxideThickness : reached->second;
  };
  struct MaskLayer
  {
    GridLayout::HeightFunction Top;
    Mask Regions;
    Id Other;
  };
  std::vector<MaskLayer> layers{ { getTop(-p.TrenchDepth), {}, Silicon },
    { getTop(0.0), wells, Oxide }, { getTop(p.GateOxideThickness), plugs, Oxide },
    { getGateTop, gates, cover }, { getTop(plan.GateTop), plugs, cover },
    { getTop(plan.MetalBottom), allPlugs, cover }, { getTop(plan.MetalTop), conductors, cover } };
  if (cover == Passivation)
  {
    layers.push_back({ getTop(plan.MetalTop + p.PassivationThickness), {}, Passivation });
  }
  for (const MaskLayer& layer : layers)
  {
    layout.AddLayer(
      layer.Top, [&](double x, double y) { return FindRegion(layer.Regions, x, y, layer.Other); });
  }
}

void AddContacts(const CmosParameters& p, const Plan& plan, Id cover, Device& device)
{
  const auto isNmos = [middle = 0.5 * plan.Width](const Vec3& v) { return v.Y < middle; };
  const auto isPmos = [middle = 0.5 * plan.Width](const Vec3& v) { return v.Y > middle; };
  device.Contacts = { { "NmosSourceContact", { Silicon, Ground }, isNmos },
    { "NmosDrainContact", { Silicon, Output }, isNmos },
    { "NmosGateContact", { NmosGate, Input }, isNmos },
    { "PmosSourceContact", { Silicon, Supply }, isPmos },
    { "PmosDrainContact", { Silicon, Output }, isPmos },
    { "PmosGateContact", { PmosGate, Input }, isPmos },
    { "SubstrateContact", { OutsideRegion, Silicon },
      [bottom = -p.BulkDepth](const Vec3& v) { return v.Z == bottom; } } };
  const std::pair<const char*, Id> terminals[] = { { "Vss", Ground }, { "Vdd", Supply },
    { "Vin", Input }, { "Vout", Output } };
  for (const auto& [name, metal] : terminals)
  {
    device.Contacts.push_back({ name, { std::min(cover, metal), std::max(cover, metal) },
      [top = plan.MetalTop](const Vec3& v) { return v.Z == top; } });
  }
}
} // namespace

std::string MakeCmosInverter(const CmosParameters& p, Device& device)
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
  if (problem.empty())
  {
    problem = CheckLevels(p, plan);
  }
  if (!problem.empty())
  {
    return problem;
  }
  const Id cover = p.PassivationThickness != 0.0 ? Id(Passivation) : OutsideRegion;
  device.RegionNames.assign(std::begin(RegionNames), std::end(RegionNames));
  if (cover != Passivation)
  {
    device.RegionNames.pop_back();
  }
  GridLayout layout(x, y, -p.BulkDepth);
  AddLayers(p, plan, cover, layout);
  layout.MakeBoundary(device);
  AddContacts(p, plan, cover, device);
  return {};
}
} // namespace cdm
