// SPDX-License-Identifier: BSD-3-Clause
#include "GridLayout.h"

#include <array>

namespace cdm
{
namespace
{
/** Whether a plane through these heights rises along one side of the rectangle, or not at all. */
bool IsPlane(const std::array<double, 4>& heights)
{
  return (heights[0] == heights[1] && heights[2] == heights[3]) ||
    (heights[1] == heights[2] && heights[3] == heights[0]);
}

/** The first corner of the diagonal, 0 or 1: through the corner whose height differs. */
int ChooseDiagonal(const std::array<double, 4>& heights)
{
  return heights[0] == heights[2] ? 1 : 0;
}
} // namespace

void GridLayout::AddLayer(double top, const RegionFunction& getRegion)
{
  this->AddLayer([top](double, double) { return top; }, getRegion);
}

void GridLayout::AddLayer(const HeightFunction& getTop, const RegionFunction& getRegion)
{
  Layer layer;
  for (const double y : this->Y)
  {
    for (const double x : this->X)
    {
      layer.Tops.push_back(getTop(x, y));
    }
  }
  for (std::size_t row = 0; row + 1 < this->Y.size(); ++row)
  {
    for (std::size_t column = 0; column + 1 < this->X.size(); ++column)
    {
      layer.Regions.push_back(getRegion(
        0.5 * (this->X[column] + this->X[column + 1]), 0.5 * (this->Y[row] + this->Y[row + 1])));
    }
  }
  this->Layers.push_back(std::move(layer));
}

void GridLayout::MakeBoundary(Device& device) const
{
  LayeredStructure structure(2, this->Bottom);
  for (const double y : this->Y)
  {
    for (const double x : this->X)
    {
      structure.AddVertex(x, y);
    }
  }
  // The rectangle that each cell of the layout is, or is half of.
  std::vector<std::size_t> rectangles;
  for (std::size_t row = 0; row + 1 < this->Y.size(); ++row)
  {
    for (std::size_t column = 0; column + 1 < this->X.size(); ++column)
    {
      const Id width = static_cast<Id>(this->X.size());
      const Id first = static_cast<Id>(row) * width + static_cast<Id>(column);
      const std::array<Id, 4> corners{ first, first + 1, first + 1 + width, first + width };
      int diagonal = -1;
      for (const Layer& layer : this->Layers)
      {
        std::array<double, 4> heights;
        for (int i = 0; i < 4; ++i)
        {
          heights[i] = layer.Tops[corners[i]];
        }
        diagonal = diagonal >= 0 || IsPlane(heights) ? diagonal : ChooseDiagonal(heights);
      }
      const std::size_t rectangle = row * (this->X.size() - 1) + column;
      if (diagonal < 0)
      {
        structure.AddCell({ corners.begin(), corners.end() });
        rectangles.push_back(rectangle);
        continue;
      }
      for (const int begin : { diagonal, diagonal + 2 })
      {
        structure.AddCell(
          { corners[begin % 4], corners[(begin + 1) % 4], corners[(begin + 2) % 4] });
        rectangles.push_back(rectangle);
      }
    }
  }
  for (const Layer& layer : this->Layers)
  {
    std::vector<Id> regions;
    for (const std::size_t rectangle : rectangles)
    {
      regions.push_back(layer.Regions[rectangle]);
    }
    structure.AddLayer(layer.Tops, std::move(regions));
  }
  device.Boundary = structure.MakeBoundary(device.FacetIds);
}
} // namespace cdm
