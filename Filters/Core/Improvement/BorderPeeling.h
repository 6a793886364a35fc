// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BorderPeeling.h
 * @brief Takes flat tetrahedra away from the border of their region.
 *
 * A tetrahedron that is numerically flat and has exactly two facets on the border, which bend by
 * less than a degree, is exchanged for nothing: at the outside it is peeled off, at an interface it
 * is handed to the other region if a flip there makes it vanish. The border moves by less than the
 * flatness.
 *
 * Cost: O(1) for a tetrahedron, after O(n) for the first one that may be peeled off.
 */
#ifndef cdmBorderPeeling_h
#define cdmBorderPeeling_h

#include "Core/Improvement/FlipSearch.h"
#include "Core/Improvement/FlippableMesh.h"
#include "Core/Meshes/SimplexIncidence.h"

#include <optional>

namespace cdm
{
class BorderPeeling
{
public:
  /** @param flatness model units: tetrahedra that are lower are flat */
  BorderPeeling(FlippableMesh& mesh, const FlipSearch& flips, double flatness)
    : Mesh(mesh), Flips(flips), Flatness(flatness)
  {
  }

  /**
   * Removes a flat tetrahedron at the outer boundary. Its inner edge must not lie on a border, or
   * the border would touch itself there; its outer edge must not be another tetrahedron's, or a gap
   * would open there. To be used before any flip. False if the tetrahedron stays.
   */
  bool PeelOff(Id tetrahedron);
  /**
   * Gives a flat tetrahedron at an interface to the other region if it can vanish there by a flip.
   * False if the tetrahedron stays.
   */
  bool HandOver(Id tetrahedron);

private:
  bool FindPeeledEdges(Id tetrahedron, int& outerEdge, int& innerEdge, Id& neighborRegion) const;
  bool IsOnlyTetrahedronAtEdge(Id tetrahedron, int edge);

  FlippableMesh& Mesh;
  const FlipSearch& Flips;
  const double Flatness;
  /** The points' tetrahedra before the first flip; made when the first one may be peeled off. */
  std::optional<SimplexIncidence> Incidence;
};
} // namespace cdm

#endif
