// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeviationBound.h
 * @brief Keeps a surface that is changed within a distance of what it was, in both directions.
 *
 * The original is a list of triangles, or of segments, in groups: facets, or chains of structural
 * edges. The current one starts as its copy; some simplices at a time are replaced by others. Both
 * directions are proven, not sampled, group by group:
 *  1. from the current to the original: a new simplex is cut into pieces until each is proven. A
 *     piece lies within the bound of a simplex if its corners do, as the distance from a convex set
 *     is a convex function; or if its center does by so much more that the rest of the piece
 *     follows, as distances grow no faster than the way. Large pieces are cut where they leave the
 *     space above and below the simplex that is nearest to their center, others in the middle;
 *  2. from the original to the current in the same way. The current simplices that prove an original
 *     one are its witnesses: when some of them go, what lies near these is proven again, with those
 *     that are left, the new simplices and their neighbors.
 * Pieces are not cut below a sixteenth of the bound: what is not proven then is refused.
 *
 * Guarantees: after any number of replacements the Hausdorff distance of each group of the current
 * simplices from the same group of the original is at most the bound, but for rounding.
 * Cost: a replacement proves what is around it, in about as many pieces as there are pairs of
 * simplices that lie above each other there, however large the original ones are. About 300 bytes
 * per simplex.
 * References: H. Borouchaki, P. J. Frey, "Simplification of surface mesh using Hausdorff envelope",
 * 2005, doi:10.1016/j.cma.2004.11.016; K. Hu, D.-M. Yan, D. Bommes, P. Alliez, B. Benes,
 * "Error-bounded and feature preserving surface remeshing with minimal angle improvement", 2017,
 * doi:10.1109/TVCG.2016.2632720 (links from samples of the original to the current surface).
 */
#ifndef cdmDeviationBound_h
#define cdmDeviationBound_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Search/BoxTree.h"

#include <array>
#include <vector>

namespace cdm
{
/** A triangle, or a segment, whose last corner is repeated. */
struct BoundSimplex
{
  std::array<Vec3, 3> Corners;
  /** The facet or chain that it belongs to. */
  Id Group = NoId;
};

/** The point of a simplex that is nearest to a position. */
Vec3 FindNearestPoint(const std::array<Vec3, 3>& corners, const Vec3& position);

class DeviationBound
{
public:
  /** Current simplex i is original simplex i. bound: > 0, model units. */
  DeviationBound(std::vector<BoundSimplex> original, double bound);

  double GetBound() const { return this->Bound; }

  /** Whether all points of a simplex lie within the bound of the original of its group. */
  bool IsNear(const BoundSimplex& simplex) const;

  /**
   * The nearest point of the original of a group, and its simplex; false if there is none within
   * the reach.
   */
  bool FindNearest(const Vec3& position, Id group, double reach, Vec3& nearest, Id& simplex) const;

  /** New witnesses of an original simplex: current ones, or new ones by ~place in their list. */
  struct Proof
  {
    Id Original;
    std::vector<Id> Witnesses;
  };

  /**
   * Proves the original simplices that lose a witness, where they may need it. neighbors: current
   * simplices that may help. False if that fails.
   */
  bool FindWitnesses(const std::vector<Id>& removed, const std::vector<BoundSimplex>& added,
    const std::vector<Id>& neighbors, std::vector<Proof>& proofs) const;

  /**
   * ids: the numbers of the new simplices, which may be those of the ones that go, or any that are
   * free.
   */
  void Replace(const std::vector<Id>& removed, const std::vector<BoundSimplex>& added,
    const std::vector<Id>& ids, const std::vector<Proof>& proofs);

private:
  std::vector<BoundSimplex> Original;
  std::vector<BoundSimplex> Current;
  double Bound;
  BoxTree Tree;
  /** For each original simplex its witnesses, and the other way around. */
  std::vector<std::vector<Id>> Witnesses;
  std::vector<std::vector<Id>> Proven;
};
} // namespace cdm

#endif
