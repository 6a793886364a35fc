// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverSchedule.h
 * @brief Decides which means are tried when against slivers and negative couplings, and when none
 * is worth another try.
 *
 * Method: a round tries these means one after the other, until one of them ends it:
 *
 * |   | means                                            | ends the round with      |
 * |---|--------------------------------------------------|--------------------------|
 * | 1 | perturb last bits of surface points              | Moved                    |
 * | 2 | move, take out and put in points inside          | -                        |
 * | 3 | move surface points                              | Moved                    |
 * | 4 | request splits of the boundary for slivers       | Requested                |
 * | 5 | refine shapes inside again                       | Requested after 4; Open  |
 * | 6 | request splits for negative couplings            | Requested                |
 * | 7 | move surface points at sharp angles              | Moved                    |
 * | 8 | last passes: 2 and 5 in turns, then sharp angles | -                        |
 * | 9 | 7 again, after the passes at sharp angles        | Moved                    |
 * |10 | 6 again, for what the last passes have made      | Requested                |
 * |11 | come closer to the points of what is left        | Requested, or else Done  |
 *
 *  - 1 (PointRounding.h) is tried unless all flat tetrahedra are among those given up on: three
 *    tries in a row left more than three quarters of them;
 *  - 2 (SliverPerturbation.h) only moves points once no more may be made. 1, 3, 4 and 7 are left out
 *    then: what they change asks for new points;
 *  - 3 (SurfacePointMoves.h) pauses once when four tries in a row have left as many slivers;
 *  - 4 waits for the splits that bad shapes request, if these can be made: they remove slivers too;
 *  - 5 ends the round if it leaves new points or requests that can be made;
 *  - 6 (NegativeCouplings.h) is given up after sixteen tries in a row that left as many couplings.
 *    Each try lets 1 to 5 begin anew, as splits make new slivers. It comes before 8, which takes
 *    long;
 *  - 7 comes once, before 8. Along with 3 it would find hardly more, and take several times as long,
 *    as what it moves starts round after round;
 *  - 8 goes over sharp angles once after each of these moves, as it would make other couplings negative each
 *    time. So 7 and 8 take turns, five at most, as long as 9 finds something to move: little is
 *    searched again, as most points are known to be immovable by then;
 *  - 11 halves the sizes there, which only keep the refinement from going on without end, and searches
 *    longer, up to five times in all: it is needed for one to three tetrahedra of a million. Where
 *    more than one in 2000 is left, it is given up after a halving that left three quarters of them:
 *    beside sharp angles each halving only makes half as many more;
 *  - 1 to 5 are left out after forty rounds in a row that moved or split the boundary for slivers
 *    in vain. They, 7 and 8 are left out if no dihedral angle is asked for.
 */
#ifndef cdmSliverSchedule_h
#define cdmSliverSchedule_h

#include "Core/Basics/Status.h"
#include "Core/Improvement/Patience.h"
#include "Core/Improvement/SliverPerturbation.h"
#include "Core/Improvement/SteinerPointRefiner.h"
#include "Core/Improvement/SteinerPointRounds.h"

#include <vector>

namespace cdm
{
/** What a round for shapes and slivers leads to. */
enum class RoundEnd
{
  /** Boundary splits that bad shapes requested are to be made. */
  Open,
  /** Boundary splits that slivers or negative couplings requested are to be made. */
  Requested,
  /** Points of the surface have been moved. */
  Moved,
  /** Nothing more can be done. */
  Done
};

/** How a round went. The end counts if nothing failed. */
struct RoundResult
{
  Status Outcome;
  RoundEnd End = RoundEnd::Open;

  /** Whether the next means are to be tried. */
  bool IsOpen() const { return this->Outcome.IsOk() && this->End == RoundEnd::Open; }
};

class SliverSchedule
{
public:
  /** All have to outlive the object. */
  SliverSchedule(const SteinerPointRefinerOptions& options, SteinerPointRounds& rounds,
    SteinerPointRefinerReport& report);

  /**
   * One round. To be called when bad shapes request few boundary splits, or none that can be made.
   */
  RoundResult Run();
  /** Perturbs slivers by interior points alone, when the boundary is final. */
  Status Finish();
  /**
   * Counts negative couplings and requests splits for them. False if there is nothing to split, or
   * if a few tries in a row have not reduced them.
   */
  bool RequestCouplings();

private:
  RoundResult MendSlivers(bool isFull);
  RoundResult PerturbMoveOrRequest(bool isFull);
  RoundResult MendCouplings();
  RoundResult MendWhatIsLeft();
  std::vector<Id> FindWhatIsLeft() const;
  bool MayHalveSizes(const std::vector<Id>& left);
  bool RoundFlatTetrahedraAway();
  bool MoveSurfacePoints();
  bool MoveSharpSurfacePoints();
  bool StartSharpTurn();
  bool TakeSurfaceMoves(SliverPlace place);
  Status RefineShapes();
  Status Perturb(SliverMeans means);
  Status PerturbLast();
  RefinedMesh& GetMesh() const { return this->Rounds.GetMesh(); }

  const SteinerPointRefinerOptions& Options;
  SteinerPointRounds& Rounds;
  SteinerPointRefinerReport& Report;
  /** Limits the tries to round flat tetrahedra away. LeftFlat are those that it gave up on. */
  Patience Roundings;
  /** Limits the moves of surface points for slivers between two splits of the boundary. */
  Patience SurfaceMoves;
  /** Limits the rounds for slivers. */
  Patience SliverRounds;
  /** Limits the rounds for negative couplings. */
  Patience Couplings;
  /** The flat tetrahedra that rounding could not remove, by their sorted points. */
  std::vector<TetrahedronIds> LeftFlat;
  /** Whether points of the surface at sharp angles have been moved, and others there. */
  bool AreSharpMoved = false;
  bool IsSharpPerturbed = false;
  /** How many turns of moves and passes at sharp angles have ended. */
  int SharpTurns = 0;
  /** Limits the halvings of sizes where they are for more than a few tetrahedra. */
  Patience ManyHalvings;
  /** How many times sizes have been halved. */
  int Halvings = 0;
};
} // namespace cdm

#endif
