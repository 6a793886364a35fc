// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "Devices/LayeredStructure.h"
#include "RoundHole.h"

#include <utility>

namespace cdm
{
std::string MakeLinedVia(const LinedViaParameters& p, Device& device)
{
  const bool hasTrench = p.HasTrench;
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
  if (hasTrench)
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

  // From the landing of the via upwards; where there is a trench it ends on top of the last but
  // two.
  std::vector<double> levels{ 0.0, barrier, p.ViaHeight, p.ViaHeight + barrier };
  if (hasTrench)
  {
    levels.push_back(p.ViaHeight + p.TrenchDepth);
    levels.push_back(levels.back() + barrier);
  }
  levels.push_back(levels.back() + p.GasHeight);
  const double boxEdge = 0.5 * p.BoxSize;
  const double wall = 0.5 * p.TrenchWidth;
  const double radius = 0.5 * p.ViaDiameter;
  if (problem.empty())
  {
    problem = CheckAscending(
      levels, "ViaHeight, BarrierThickness, TrenchDepth, GasHeight and BottomLineThickness");
  }
  if (problem.empty())
  {
    problem = CheckAscending({ radius - barrier, radius, hasTrench ? wall - barrier : boxEdge,
                               hasTrench ? wall : 2.0 * boxEdge },
      "ViaDiameter, BarrierThickness, TrenchWidth and BoxSize");
  }
  if (!problem.empty())
  {
    return problem;
  }

  enum Region : Id
  {
    Insulator,
    BottomMetal,
    Barrier,
    Gas
  };
  device.RegionNames = { "Insulator", "BottomMetal", "Barrier", "Gas" };
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
  LayeredStructure structure(2, -p.BottomLineThickness);
  std::vector<Zone> zones;
  const auto addCell = [&](std::vector<Id> outline, Zone zone)
  {
    structure.AddCell(std::move(outline));
    zones.push_back(zone);
  };
  // Strips along y.
  std::vector<double> x{ -boxEdge, boxEdge };
  if (hasTrench)
  {
    x = { -boxEdge, -wall, -(wall - barrier), wall - barrier, wall, boxEdge };
  }
  std::vector<std::array<Id, 2>> lines;
  for (const double place : x)
  {
    const Id first = structure.AddVertex(place, -boxEdge);
    lines.push_back({ first, structure.AddVertex(place, boxEdge) });
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

  // From which level on a zone is barrier, and gas; insulator below.
  const int surface = static_cast<int>(levels.size()) - 3;
  const auto getRegion = [=](Zone zone, int layer) -> Id
  {
    const int barrierBegins = zone == Field ? surface : zone > Floor ? 0 : 2;
    const int gasBegins = zone == Hole ? 1 : zone > TrenchWall ? 3 : surface + 1;
    return layer < barrierBegins ? Insulator : layer < gasBegins ? Barrier : Gas;
  };
  structure.AddLayer(0.0, std::vector<Id>(zones.size(), BottomMetal));
  for (int layer = 0; layer + 1 < static_cast<int>(levels.size()); ++layer)
  {
    std::vector<Id> regions;
    for (const Zone zone : zones)
    {
      regions.push_back(getRegion(zone, layer));
    }
    structure.AddLayer(levels[layer + 1], std::move(regions));
  }
  device.Boundary = structure.MakeBoundary(device.FacetIds);
  const double top = levels.back();
  device.Contacts = { { "Inlet", { OutsideRegion, Gas },
                        [=](const Vec3& v) { return v.Z == top; } },
    { "Surface", { Barrier, Gas }, [](const Vec3&) { return true; } },
    { "BottomContact", { OutsideRegion, BottomMetal },
      [=](const Vec3& v) { return v.Z == -p.BottomLineThickness; } } };
  return {};
}
} // namespace cdm
