// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LayeredStructure.h
 * @brief Builds the polygon boundary of a structure that is made of layers with one common layout.
 *
 * A layout is a planar subdivision: polygonal cells over shared vertices. It is stacked along one
 * axis: between two levels lies a layer, and each layer gives each cell a region. One layer makes
 * an extruded cross-section; several make devices that are built up from the wafer, with as many
 * masks as there are cells to tell apart. A level may be a surface with a height of its own at each
 * vertex of the layout: slanted walls, films over steps.
 *
 * Method:
 *  1. a plate for each level and cell, and a wall for each layer and edge of the layout, where the
 *     regions on both sides differ: a polygon complex without T-junctions, since all of it stands
 *     on the common layout. Where a layer has no thickness the layers around it touch;
 *  2. neighbours in one plane with the same regions and contact are joined, as long as the union is a polygon
 *     without a hole; whether they are in one plane is an exact sign;
 *  3. vertices at which nothing but one straight line passes are dropped from all polygons at once.
 *
 * Outputs: each polygon once, its normal pointing from the larger region id to the smaller one (so
 * out of the structure at its outside). Polygons with the same facet id are the pieces of one
 * connected planar interface, or of the part of it in a contact; there are several only where it has
 * holes.
 *
 * Guarantees: every point is used, no point is there twice, none lies on an edge or in a polygon
 * that it is no vertex of. Walls are planar exactly, since their vertices lie over two places of
 * the layout; so are plates of one height, and of two heights over two parallels to an axis. Other
 * plates are planar if the heights that were given for them are. Deterministic.
 * Cost: O(n log n) for n plates and walls, and more for facets with many holes: 50,000 take a
 * second.
 */
#ifndef cdmLayeredStructure_h
#define cdmLayeredStructure_h

#include "Core/Meshes/PolygonSoup.h"

#include <array>
#include <map>
#include <vector>

namespace cdm
{
class LayeredStructure
{
public:
  /**
   * Stacking axis: 0, 1, 2 for x, y, z; the layout has the other two coordinates, in this order.
   * First level: where the first layer begins.
   */
  LayeredStructure(int axis, double firstLevel) : Axis(axis), FirstLevel(firstLevel) {}

  /** A vertex of the layout; no two have the same coordinates. */
  Id AddVertex(double u, double v);

  /**
   * A cell of the layout: a simple polygon, run in either direction. Cells do not overlap, and
   * neighbours share all vertices on their common border. Returns the index of the cell.
   */
  Id AddCell(std::vector<Id> outline);

  /**
   * Put a layer on top of the previous one, up to this level, or up to these heights at the
   * vertices; all vertices are there by now. Where the level lies below the previous one the layer
   * has no thickness. Regions: one for each cell, OutsideRegion where the layer leaves the cell
   * empty.
   */
  void AddLayer(double top, std::vector<Id> regions);
  void AddLayer(std::vector<double> tops, std::vector<Id> regions);

  /**
   * Make what lies at a level (0: the first one) part of contacts: one id for each cell, NoId where
   * it belongs to none.
   */
  void SetContacts(Id level, std::vector<Id> contacts);

  /** FacetIds and ContactIds: one for each polygon; NoId: in no contact. */
  PolygonSoup MakeBoundary(std::vector<Id>& facetIds, std::vector<Id>& contactIds) const;
  PolygonSoup MakeBoundary(std::vector<Id>& facetIds) const;

private:
  int Axis;
  double FirstLevel;
  std::vector<std::array<double, 2>> Vertices;
  std::vector<std::vector<Id>> Cells;
  std::vector<std::vector<double>> Tops;
  std::vector<std::vector<Id>> Regions;
  std::map<Id, std::vector<Id>> Contacts;
};
} // namespace cdm

#endif
