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
 * Pieces are not cut below a sixteenth of the bound: what is not proven then is refused. Nothing is
 * cut where simplices lie in a plane or on a line, and cover the same part of it as those that go:
 * they prove what these did, and more is not searched than which of them are close (BoundSimplex.h).
 *
 * Guarantees: after any number of replacements the Hausdorff distance of each group of the current
 * simplices from the same group of the original is at most the bound, but for rounding.
 * Deterministic: the same for any number of threads.
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

#include "Core/Basics/ThreadTeam.h"
#include "Core/Search/BoxTree.h"
#include "Core/Surface/BoundSimplex.h"

#include <vector>

namespace cdm
{
/** Simplices that take the place of others. */
struct BoundChange
{
  /** Numbers of those that go. */
  std::vector<Id> Removed;
  std::vector<BoundSimplex> Added;
  /** Current simplices that may help to prove it. */
  std::vector<Id> Neighbors;
  /** How far the border of those that go moves, if they lie in a plane. Infinity: not known. */
  double BorderShift = 0.0;
};

class DeviationBound
{
public:
  /** Current simplex i is original simplex i. bound: > 0, model units. threads: for the proofs. */
  DeviationBound(std::vector<BoundSimplex> original, double bound, ThreadTeam& threads);

  double GetBound() const { return this->Bound; }

  /**
   * The nearest point of the original of a group, and its simplex; false if there is none within
   * the reach.
   */
  bool FindNearest(const Vec3& position, Id group, double reach, Vec3& nearest, Id& simplex) const;

  /**
   * An original simplex that loses witnesses, and what it gets: current simplices, or new ones by
   * ~place in their list.
   */
  struct Proof
  {
    Id Original = NoId;
    std::vector<Id> NewWitnesses;
  };

  /** What Replace() has to know of a change. */
  struct ChangeProof
  {
    std::vector<Proof> Originals;
    /** The largest shift: new simplices are so much farther from the original than those that go. */
    double Shift = 0.0;
    /** Whether all new simplices shift. */
    bool IsShift = false;
  };

  /**
   * Whether a change keeps all within the bound.
   *
   * Simplices of a group shift if they cover the same part of a plane or line as those that go, but
   * for rounding (GetShift()). Nothing has to be searched for these. What all shifts may add up to
   * is taken off the bound; once it is used up, everything is searched.
   */
  bool Prove(const BoundChange& change, ChangeProof& proof) const;

  /**
   * ids: the numbers of the new simplices, which may be those of the ones that go, or any that are
   * free.
   */
  void Replace(
    const BoundChange& change, const std::vector<Id>& ids, const ChangeProof& changeProof);

private:
  struct Offer;

  double GetGroupShift(const BoundChange& change, Id group) const;
  bool IsNear(const BoundSimplex& simplex) const;
  std::vector<Id> FindAffected(const std::vector<Id>& removed) const;
  Proof MakeShiftProof(Id original, const BoundChange& change, const std::vector<Box>& boxes) const;
  bool Search(const BoundChange& change, const std::vector<Id>& added,
    const std::vector<Id>& affected, std::vector<Proof>& proofs) const;
  Offer MakeOffer(const BoundChange& change, const std::vector<Id>& affected) const;
  bool FindWitnesses(const Offer& offer, Proof& proof) const;

  std::vector<BoundSimplex> Original;
  std::vector<BoundSimplex> Current;
  ThreadTeam& Threads;
  double Bound;
  double AllShifts = 0.0;
  BoxTree Tree;
  /** For each original simplex its witnesses, and the other way around. */
  std::vector<std::vector<Id>> Witnesses;
  std::vector<std::vector<Id>> Proven;
};
} // namespace cdm

#endif
