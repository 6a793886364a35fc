// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LayerThickness.h
 * @brief How thick the layers are in which a position lies.
 *
 * A layer is what lies between two parts of the boundary of a region that face each other: plates
 * and films, but also the bulk of a box. If no tetrahedron is higher, from side to side, than a part
 * of the thickness, at least so many lie on each way through the layer. They may be wider than high.
 *
 * Method: of each boundary triangle on which the position has its foot, the straight line through
 * both is followed until it meets the boundary again. The way between is a thickness if the triangle
 * there faces the first one (their planes differ by less than 32 degrees), and if the surface
 * facets of both have no point in common: layers that end in a sharp edge are thinner and thinner
 * towards it, and could not be filled. Thin layers (ThinLayers.h) are none here, for the same reason
 * for which tetrahedra across them may be flat.
 *
 * Cost: O(n log n) to build, 250 bytes per triangle; a query visits the triangles within half of its
 * limit, and takes some ten microseconds if these are few. Thread safe.
 */
#ifndef cdmLayerThickness_h
#define cdmLayerThickness_h

#include "Core/Basics/IdLists.h"
#include "Core/Improvement/ThinLayers.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Search/BoxTree.h"
#include "Core/Surface/FacetPoints.h"

#include <array>
#include <vector>

namespace cdm
{
class LayerThickness
{
public:
  /**
   * @param surface with labels
   * @param facets the surface facet of each triangle, as from NumberFacets()
   * @param aspectRatio see ThinLayers
   */
  LayerThickness(TriangleMesh surface, std::vector<Id> facets, double aspectRatio);
  LayerThickness(const LayerThickness&) = delete;
  LayerThickness& operator=(const LayerThickness&) = delete;

  struct Layer
  {
    double Thickness;
    /** From side to side, of length 1. */
    Vec3 Direction;
  };
  /** The layers that a position inside of a region lies in, and that are thinner than the limit. */
  std::vector<Layer> Find(const Vec3& position, double limit) const;

  /**
   * Whether so many tetrahedra like this one would be higher than the layer is thick.
   * @param longest length of its longest edge
   */
  bool IsTooThick(const std::array<Vec3, 4>& vertices, double longest, int across) const;

private:
  /** The foot of a position's perpendicular on a triangle. */
  struct Foot
  {
    /** The triangle's face that looks at the position, numbered as in ThinLayers. */
    Id Face;
    /** How high the position is above the triangle. */
    double Height;
    /** The unit vector from the foot to the position. */
    Vec3 Direction;
  };
  Id FindFirst(const Vec3& position, const Vec3& way, double& share) const;
  std::vector<Foot> ListFeet(const Vec3& position, double reach) const;

  const TriangleMesh Surface;
  const std::vector<Id> Facets;
  const FacetPoints Contacts;
  const IdLists PointTriangles;
  const ThinLayers Thin;
  const BoxTree Tree;
};
} // namespace cdm

#endif
