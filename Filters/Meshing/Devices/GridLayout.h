// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GridLayout.h
 * @brief A layered structure over a rectangular grid of lines in x and y, for devices of boxes,
 * frustums and films.
 *
 * The lines are the edges of all masks. Levels are heights over the crossings of the lines; where
 * the four corners of a rectangle are not in one plane it is split along the diagonal that keeps
 * three equal heights together, as in the corner of a frustum.
 */
#ifndef cdmGridLayout_h
#define cdmGridLayout_h

#include "Device.h"
#include "Devices/LayeredStructure.h"

#include <functional>
#include <vector>

namespace cdm
{
class GridLayout
{
public:
  using HeightFunction = std::function<double(double x, double y)>;
  using RegionFunction = std::function<Id(double x, double y)>;

  /** Lines ascend strictly. */
  GridLayout(std::vector<double> x, std::vector<double> y, double bottom)
    : X(std::move(x)), Y(std::move(y)), Bottom(bottom)
  {
  }

  /**
   * Puts a layer on top of the previous one, up to a height, or one for each crossing of lines.
   * Regions are asked for at the centers of the rectangles.
   */
  void AddLayer(double top, const RegionFunction& getRegion);
  void AddLayer(const HeightFunction& getTop, const RegionFunction& getRegion);

  /** Boundary and FacetIds. */
  void MakeBoundary(Device& device) const;

private:
  struct Layer
  {
    /** Row by row. */
    std::vector<double> Tops;
    std::vector<Id> Regions;
  };

  std::vector<double> X;
  std::vector<double> Y;
  double Bottom;
  std::vector<Layer> Layers;
};
} // namespace cdm

#endif
