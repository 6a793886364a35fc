// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "Devices/LayeredStructure.h"
#include "RoundHole.h"

#include <array>
#include <utility>
#include <vector>

namespace cdm
{
namespace
{
enum Region : Id
{
  Insulator,
  BottomMetal,
  Barrier,
  Gas
};

enum Zone
{
  /** Outside of the trench. */
  Field,
  TrenchWall,
  /** Floor of the trench, or all around the via where there is no trench. */
  Floor,
  ViaWall,
  Hole
};

std::string CheckParameters(const LinedViaParameters& p)
{
  const double barrier = p.BarrierThickness;
  const Parameter height{ "ViaHeight", p.ViaHeight };
  const Parameter box{ "BoxSize", p.BoxSize };
  const Parameter thickness{ "BarrierThickness", barrier };
  std::vector<Parameter> lengths{ { "ViaDiameter", p.ViaDiameter }, height,
    { "BottomLineThickness", p.BottomLineThickness }, thickness, { "GasHeight", p.GasHeight },
    box };
  std::vector<std::pair<Parameter, Parameter>> orders{ { thickness, height },
    { { "2 BarrierThickness (1 + BarrierAsymmetry)", 2.0 * barrier * (1.0 + p.BarrierAsymmetry) },
      { "ViaDiameter", p.ViaDiameter } },
    { { "BarrierAsymmetry", p.BarrierAsymmetry },
      { "cos(180 / NumberOfSegments)", GetCosineSine(180.0 / p.NumberOfSegments).Cosine } } };
  if (p.HasTrench)
  {
    const Parameter width{ "TrenchWidth", p.TrenchWidth };
    const Parameter depth{ "TrenchDepth", p.TrenchDepth };
    lengths.insert(lengths.end(), { width, depth });
    orders.insert(orders.end(),
      { { { "ViaDiameter + 2 BarrierThickness", p.ViaDiameter + 2.0 * barrier }, width },
        { width, box }, { thickness, depth } });
  }
  else
  {
    orders.push_back({ { "ViaDiameter", p.ViaDiameter }, box });
  }
  std::string problem = CheckLengths(lengths);
  for (const auto& [small, large] : orders)
  {
    problem = problem.empty() ? CheckLess(small, large) : problem;
  }
  return problem;
}

/**
 * From the landing of the via upwards; where there is a trench it ends on top of the last but two.
 */
std::vector<double> MakeLevels(const LinedViaParameters& p)
{
  const double barrier = p.BarrierThickness;
  std::vector<double> levels{ 0.0, barrier, p.ViaHeight, p.ViaHeight + barrier };
  if (p.HasTrench)
  {
    levels.push_back(p.ViaHeight + p.TrenchDepth);
    levels.push_back(levels.back() + barrier);
  }
  levels.push_back(levels.back() + p.GasHeight);
  return levels;
}

/** Whether positions made of the parameters differ. */
std::string CheckPositions(const LinedViaParameters& p, const std::vector<double>& levels)
{
  const std::string problem = CheckAscending(
    levels, "ViaHeight, BarrierThickness, TrenchDepth, GasHeight and BottomLineThickness");
  if (!problem.empty())
  {
    return problem;
  }
  const double radius = 0.5 * p.ViaDiameter;
  const double boxEdge = 0.5 * p.BoxSize;
  const double wall = 0.5 * p.TrenchWidth;
  return CheckAscending(
    { radius - p.BarrierThickness, radius, p.HasTrench ? wall - p.BarrierThickness : boxEdge,
      p.HasTrench ? wall : 2.0 * boxEdge },
    "ViaDiameter, BarrierThickness, TrenchWidth and BoxSize");
}

/** Adds the cells of the layout; the result is the zone of each. */
std::vector<Zone> AddCells(const LinedViaParameters& p, LayeredStructure& structure)
{
  const double barrier = p.BarrierThickness;
  const double boxEdge = 0.5 * p.BoxSize;
  const double wall = 0.5 * p.TrenchWidth;
  const double radius = 0.5 * p.ViaDiameter;
  std::vector<Zone> zones;
  const auto addCell = [&](std::vector<Id> outline, Zone zone)
  {
    structure.AddCell(std::move(outline));
    zones.push_back(zone);
  };
  // Strips along y.
  std::vector<double> x{ -boxEdge, boxEdge };
  if (p.HasTrench)
  {
    x = { -boxEdge, -wall, -(wall - barrier), wall - barrier, wall, boxEdge };
  }
  std::vector<std::array<Id, 2>> lines;
  for (const double position : x)
  {
    const Id first = structure.AddVertex(position, -boxEdge);
    lines.push_back({ first, structure.AddVertex(position, boxEdge) });
  }
  const std::size_t middle = lines.size() / 2 - 1;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i)
  {
    if (i != middle)
    {
      addCell({ lines[i][0], lines[i + 1][0], lines[i + 1][1], lines[i][1] },
        i == 0 || i + 2 == lines.size() ? Field : TrenchWall);
    }
  }
  const int n = p.NumberOfSegments;
  const RoundHole hole = AddRoundHole(structure,
    { lines[middle][0], lines[middle + 1][0], lines[middle + 1][1], lines[middle][1] }, radius, n);
  for (const std::vector<Id>& outline : hole.Surroundings)
  {
    addCell(outline, Floor);
  }
  // The inner side of the barrier is shifted: it is thicker at low x.
  const double shift = p.BarrierAsymmetry * barrier;
  std::vector<Id> inner;
  for (int i = 0; i < n; ++i)
  {
    const CosineSine direction = GetCosineSine(360.0 * i / n);
    inner.push_back(structure.AddVertex(
      shift + (radius - barrier) * direction.Cosine, (radius - barrier) * direction.Sine));
  }
  for (int i = 0; i < n; ++i)
  {
    const int next = (i + 1) % n;
    addCell({ hole.Circle[i], hole.Circle[next], inner[next], inner[i] }, ViaWall);
  }
  addCell(std::move(inner), Hole);
  return zones;
}

void AddLayers(
  const std::vector<double>& levels, const std::vector<Zone>& zones, LayeredStructure& structure)
{
  // For each zone the layer from which on it is barrier, and gas; it is insulator below.
  const int surface = static_cast<int>(levels.size()) - 3;
  const std::pair<int, int> begins[] = { { surface, surface + 1 }, { 2, surface + 1 }, { 2, 3 },
    { 0, 3 }, { 0, 1 } };
  structure.AddLayer(0.0, std::vector<Id>(zones.size(), BottomMetal));
  for (int layer = 0; layer + 1 < static_cast<int>(levels.size()); ++layer)
  {
    std::vector<Id> regions;
    for (const Zone zone : zones)
    {
      const auto [barrier, gas] = begins[zone];
      regions.push_back(layer < barrier ? Insulator : layer < gas ? Barrier : Gas);
    }
    structure.AddLayer(levels[layer + 1], std::move(regions));
  }
}
} // namespace

std::string MakeLinedVia(const LinedViaParameters& p, Device& device)
{
  std::string problem = CheckParameters(p);
  const std::vector<double> levels = MakeLevels(p);
  if (problem.empty())
  {
    problem = CheckPositions(p, levels);
  }
  if (!problem.empty())
  {
    return problem;
  }
  device.RegionNames = { "Insulator", "BottomMetal", "Barrier", "Gas" };
  LayeredStructure structure(2, -p.BottomLineThickness);
  const std::vector<Zone> zones = AddCells(p, structure);
  AddLayers(levels, zones, structure);
  device.Boundary = structure.MakeBoundary(device.FacetIds);
  const double top = levels.back();
  device.Contacts = { { "Inlet", { OutsideRegion, Gas },
                        [=](const Vec3& v) { return v.Z == top; } },
    { "Surface", { Barrier, Gas }, [](const Vec3&) { return true; } },
    { "BottomContact", { OutsideRegion, BottomMetal },
      [bottom = -p.BottomLineThickness](const Vec3& v) { return v.Z == bottom; } } };
  return {};
}
} // namespace cdm
