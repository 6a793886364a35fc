// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeviationBound.h
 * @brief Keeps a surface that is changed within a distance of what it was, in both directions.
 *
 * The original is a list of triangles, or of segments, in groups: facets, or chains of structural
 * edges. The current one starts as its copy; some simplices at a time are replaced by others. Both
 * directions are proven, not sampled, group by group:
 *  1. from the current to the original: a new simplex is subdivided until each piece is proven. A
 *     piece lies within the bound of an original simplex if its corners do, as the distance from a
 *     convex set is a convex function; or if its center does by so much more that the rest of the
 *     piece follows, as distances grow no faster than the way;
 *  2. from the original to the current: each piece of the original has a witness, a current simplex
 *     within the bound of its corners, and so of all of it. When a witness goes its pieces find
 *     others among the new simplices and their neighbors, or are subdivided until they do.
 * Pieces are not subdivided below a sixteenth of the bound: what is not proven then is refused.
 *
 * Guarantees: after any number of replacements the Hausdorff distance of each group of the current
 * simplices from the same group of the original is at most the bound, but for rounding.
 * Cost: a replacement looks at the pieces of the simplices that go; 80 bytes per piece, of which
 * there are about as many as original simplices where these are not much larger than the bound.
 * References: H. Borouchaki, P. J. Frey, "Simplification of surface mesh using Hausdorff envelope",
 * 2005, doi:10.1016/j.cma.2004.11.016; K. Hu, D.-M. Yan, D. Bommes, P. Alliez, B. Benes,
 * "Error-bounded and feature preserving surface remeshing with minimal angle improvement", 2017,
 * doi:10.1109/TVCG.2016.2632720 (links from samples to the current surface; here pieces).
 */
#ifndef cdmDeviationBound_h
#define cdmDeviationBound_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Search/BoxTree.h"

#include <array>
#include <cstddef>
#include <utility>
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

  /** A piece of the original. */
  using Piece = std::array<Vec3, 3>;
  /** New witnesses, as places in the list of those that were offered, with their pieces. */
  using Handover = std::vector<std::pair<std::size_t, Piece>>;

  /**
   * Finds witnesses for the pieces of simplices that go. offered: the new simplices, then those
   * that stay and may help. False if there are none.
   */
  bool FindWitnesses(const std::vector<Id>& removed, const std::vector<BoundSimplex>& offered,
    Handover& handover) const;

  /**
   * ids: the current ids of the offered simplices; new ones may take those of the ones that go, or
   * any that are free.
   */
  void Replace(const std::vector<Id>& removed, const std::vector<BoundSimplex>& offered,
    const std::vector<Id>& ids, const Handover& handover);

  const BoundSimplex& GetOriginal(Id simplex) const { return this->Original[simplex]; }

private:
  bool IsPieceNear(const Piece& piece, const std::vector<Id>& candidates) const;
  bool FindWitness(const Piece& piece, const std::vector<BoundSimplex>& offered,
    const std::vector<std::size_t>& candidates, Handover& handover) const;

  std::vector<BoundSimplex> Original;
  double Bound;
  double SquaredBound;
  double SmallestPiece;
  BoxTree Tree;
  /** The pieces that each current simplex is the witness of, and their groups. */
  std::vector<std::vector<Piece>> Pieces;
  std::vector<Id> Groups;
};
} // namespace cdm

#endif
