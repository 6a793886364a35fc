// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"
#include "Devices/LayeredStructure.h"
#include "RoundHole.h"

#include <cmath>
#include <utility>

namespace cdm
{
std::string MakeViaPlug(const ViaPlugParameters& p, Device& device)
{
  std::string problem = CheckLengths({ { "ViaDiameter", p.ViaDiameter },
    { "ViaHeight", p.ViaHeight }, { "BottomLineWidth", p.BottomLineWidth },
    { "BottomLineThickness", p.BottomLineThickness }, { "TopLineWidth", p.TopLineWidth },
    { "TopLineThickness", p.TopLineThickness }, { "BoxSize", p.BoxSize } });
  const Parameter diameter{ "ViaDiameter", p.ViaDiameter };
  const Parameter box{ "BoxSize", p.BoxSize };
  for (const Parameter& line : { Parameter{ "BottomLineWidth", p.BottomLineWidth },
         Parameter{ "TopLineWidth", p.TopLineWidth } })
  {
    problem = problem.empty() ? CheckLess(diameter, line) : problem;
    problem = problem.empty() ? CheckLess(line, box) : problem;
  }
  const double top = p.ViaHeight + p.TopLineThickness;
  if (problem.empty())
  {
    problem = CheckAscending({ p.ViaHeight, top }, "ViaHeight and TopLineThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }

  // The layout of all layers: a grid of 3 x 3 cells, whose middle column is the top line and whose
  // middle row the bottom line; the middle cell is the plug and two cells around it.
  enum Region : Id
  {
    Insulator,
    BottomLine,
    Plug,
    TopLine
  };
  device.RegionNames = { "Insulator", "BottomLine", "Plug", "TopLine" };
  LayeredStructure structure(2, -p.BottomLineThickness);
  const double x[4] = { -0.5 * p.BoxSize, -0.5 * p.TopLineWidth, 0.5 * p.TopLineWidth,
    0.5 * p.BoxSize };
  const double y[4] = { -0.5 * p.BoxSize, -0.5 * p.BottomLineWidth, 0.5 * p.BottomLineWidth,
    0.5 * p.BoxSize };
  Id grid[4][4];
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      grid[row][column] = structure.AddVertex(x[column], y[row]);
    }
  }
  std::vector<Id> bottom, middle, upper;
  const auto addCell =
    [&](std::vector<Id> outline, bool isInBottomLine, bool isInPlug, bool isInTopLine)
  {
    structure.AddCell(std::move(outline));
    bottom.push_back(isInBottomLine ? BottomLine : Insulator);
    middle.push_back(isInPlug ? Plug : Insulator);
    upper.push_back(isInTopLine ? TopLine : Insulator);
  };
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      if (row != 1 || column != 1)
      {
        addCell({ grid[row][column], grid[row][column + 1], grid[row + 1][column + 1],
                  grid[row + 1][column] },
          row == 1, false, column == 1);
      }
    }
  }

  RoundHole hole = AddRoundHole(structure, { grid[1][1], grid[1][2], grid[2][2], grid[2][1] },
    0.5 * p.ViaDiameter, p.NumberOfSegments);
  for (std::vector<Id>& outline : hole.Surroundings)
  {
    addCell(std::move(outline), true, false, true);
  }
  addCell(std::move(hole.Circle), true, true, true);

  structure.AddLayer(0.0, std::move(bottom));
  structure.AddLayer(p.ViaHeight, std::move(middle));
  structure.AddLayer(top, std::move(upper));
  device.Boundary = structure.MakeBoundary(device.FacetIds);
  const double boxEdge = 0.5 * p.BoxSize;
  device.Contacts = { { "BottomContact", { OutsideRegion, BottomLine },
                        [=](const Vec3& v) { return std::abs(v.X) == boxEdge; } },
    { "TopContact", { OutsideRegion, TopLine },
      [=](const Vec3& v) { return std::abs(v.Y) == boxEdge; } } };
  return {};
}
} // namespace cdm
